"""What to do next with a fit, as a line of Python."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ._types import AxisLike

AXIS_FILE = "axis.toml"
"""An axis file that is still to be written."""
ANOTHER_LOG = "another.csv"
"""A log that is still to be recorded."""


def call_of(action: Mapping[str, Any], result: Mapping[str, Any], axis: AxisLike) -> str:
    """The call of an action on a result; `axis` as it was given to `identify`."""
    known = [] if axis is None else ["axis" if isinstance(axis, Mapping) else repr(str(axis))]
    if axis is None and result["axis"].get("file"):
        known = [repr(result["axis"]["file"])]
    own = [] if result["axis"].get("listed") else [entry["path"] for entry in result["inputs"]]
    asked = _law(result["law"], result["asymmetric"]) if result["law_chosen_by"] == "user" else []
    if result["method"] != "separable":
        asked = [*asked, f"method={result['method']!r}"]

    def identify(logs: Iterable[str], options: Iterable[str], axis: list[str] = known) -> str:
        return f"stiction.identify({', '.join([*_inputs(logs, axis), *options])})"

    name = action["action"]
    if name == "export":
        cycle = result["inputs"][0]["rate_hz"] if result["inputs"] else 1e3
        return f'fit.export("c", "c", cycle_time={1.0 / cycle:.6g})'
    if name == "check":
        return f"print(stiction.check({', '.join(_inputs(action['logs'] or own, known))}))"
    if name == "law":
        return identify(own, _law(action["law"], action["asymmetric"]))
    if name == "let-the-data-choose":
        return identify(own, [])
    if name == "simulate":
        return identify(own, ['method="output-error"'])
    if name == "identify":
        return identify(action["logs"] or own, asked)
    if name == "first-log":
        return identify(own[:1], asked)
    if name == "record":
        return identify([ANOTHER_LOG], asked)
    if name == "line":
        table, key, value = action["table"], action["key"], action["value"]
        if known and known != ["axis"]:
            return f"{identify(own, asked)}  # with {action['line']} under [{table}] of {known[0]}"
        if known:
            return identify(own, asked, [f'{{**axis, {table!r}: {{**axis.get({table!r}, {{}}), {key!r}: {value!r}}}}}'])
        return identify(own, asked, [f"{{{table!r}: {{{key!r}: {value!r}}}}}"])
    if name == "remove":
        return f"{identify(own, asked)}  # without {action['line']} under [{action['table']}] of {known[0] if known else AXIS_FILE}"
    # The same again: to the end, or with the axis file corrected as the reasons say.
    return identify(own, asked)


def _law(law: str, asymmetric: bool) -> list[str]:
    return [f"law={law!r}", *(["asymmetric=True"] if asymmetric else [])]


def _inputs(logs: Iterable[str], axis: list[str]) -> list[str]:
    """Logs and axis; without logs those that the axis lists."""
    each = _logs(logs)
    return [*each, *(axis if each else [f"axis={own}" for own in axis])]


def _logs(paths: Iterable[str]) -> list[str]:
    each = [repr(path) for path in paths]
    return each if len(each) < 2 else [f"[{', '.join(each)}]"]
