"""The motion to record."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from . import _native
from ._axis import path_of
from ._errors import StictionError, argument
from ._log import _warn
from ._options import maybe, some_threads, whole, words
from ._progress import finish, teller
from ._study import STOPPED
from ._types import PathLike, PlanOptions, Watcher

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray


class Plan:
    """A planned motion. Made by `plan`."""

    def __init__(self, native: _native.Plan) -> None:
        self._native = native

    @cached_property
    def result(self) -> dict[str, Any]:
        """Everything that was planned: the keys of `plan.toml`, described in docs/plan.md."""
        result: dict[str, Any] = json.loads(self._native.result_json())
        return result

    @cached_property
    def setpoints(self) -> dict[str, NDArray[numpy.float64]]:
        """The motion at the rate of the log: `t` s, `x` m (rad), `v`, `a`."""
        return {name: values for name, _, values in self._native.setpoints()}

    @property
    def expected(self) -> list[dict[str, Any]]:
        """What a log of it can be expected to show of each parameter."""
        expected: list[dict[str, Any]] = self.result["parameter"]
        return expected

    def save(self, folder: PathLike, *, force: bool = False) -> list[Path]:
        """Writes `plan.toml`, `setpoints.csv`, its other forms and `report.html`, as `stiction plan --out`."""
        return self._native.save(path_of(folder, "folder"), force)

    def report(self) -> str:
        """The report: one HTML document without scripts."""
        return self._native.file("report.html") or ""

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._native.parts(),)

    def __str__(self) -> str:
        return self._native.text()

    def __repr__(self) -> str:
        return f"<stiction.Plan of {self.result['duration']:.4g} s>"

    def _repr_html_(self) -> str:
        document = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{document}" style="width: 100%; height: 40em; border: 0"></iframe>'


def _again(parts: Any) -> Plan:
    """A plan of its parts, as when it is unpickled."""
    return Plan(_native.Plan.of_parts(parts))


def plan(
    axis: PathLike,
    *,
    model: PathLike | None = None,
    log: PathLike | None = None,
    stage: Literal["probe", "whole"] = "whole",
    time: float | None = None,
    seed: int = 0,
    wants: str | Sequence[str] = (),
    formats: str | Sequence[str] = (),
    start: str | None = None,
    progress: Watcher = None,
    threads: int | None = None,
) -> Plan:
    """The motion to record, within the limits of an axis: as `stiction plan axis.toml`.

    axis: an axis file with [limits]. model, log: a first model or log of the axis; the motion is planned for what it leaves
    open. stage: `probe` for a first, careful motion. time: longest motion, s; 9 s, and 3 s of a probe, if it is not given.
    wants: how well parameters are to be known, such as `sigma0 < 2 %`: the shortest motion that is enough.
    formats: further forms of the set points, which `save` writes: `st`, `cam`, `csp`, `ros2`, `halstreamer`, `gcode`. start: where
    the axis stands when the motion starts, with its unit, such as `120 mm`.
    """
    if stage not in ("probe", "whole"):
        raise argument("stage", repr(stage), "one of probe, whole")
    if model is not None and log is not None:
        raise argument("log", "a log together with a model", "one of the two")
    options: PlanOptions = {
        "model": None if model is None else path_of(model, "model"),
        "log": None if log is None else path_of(log, "log"),
        "probe": stage == "probe",
        "time": maybe(time, "time"),
        "seed": whole(seed, "seed"),
        "wants": words(wants, "wants"),
        "formats": words(formats, "formats"),
        "start": None if start is None else str(start),
    }
    try:
        native, stopped = _native.plan(path_of(axis, "axis"), options, teller(progress), some_threads(threads))
    finally:
        finish(progress)
    if native is None:
        raise StictionError("interrupted", "", "stopped before there was a motion", "")
    if stopped:
        _warn([STOPPED], 2)
    return Plan(native)
