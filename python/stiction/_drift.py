"""Friction over time: what changed on which machine."""

from __future__ import annotations

import datetime
import json
from collections.abc import Iterable, Mapping
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _native
from ._axis import path_of
from ._columns import is_columns, is_missing, items
from ._errors import argument, kind_of
from ._frames import Rows, frame
from ._options import seconds, words
from ._types import FrameName, PathLike

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

WHAT = "a table of batch or of stiction.fleet: its path, a DataFrame or Arrow table, or rows of identify_uri"
"""What results may be."""
NAME = "results"
"""What a table in memory is called."""

KINDS = {bool: "True or False", float: "a number", str: "text"}
"""What stands in a column of a table; in each the same, or nothing."""


class Course(NamedTuple):
    """A parameter of a machine over time, of which something is alarmed; a number for each log."""

    machine: str
    """Machine; empty where the table names none."""
    parameter: str
    """Parameter."""
    law: str
    """Law that it is of."""
    unit: str
    """SI unit of all but times and temperatures."""
    time: NDArray[numpy.float64]
    """When it was recorded, s; without times in the table a day from each log to the next."""
    value: NDArray[numpy.float64]
    """What was identified."""
    std: NDArray[numpy.float64]
    """Standard deviation of it."""
    temperature: NDArray[numpy.float64]
    """Temperature of the machine; NaN where it is not known."""
    corrected: NDArray[numpy.float64]
    """What was identified, without what temperature does."""
    low: NDArray[numpy.float64]
    """Lower end of the 95 % interval of that, with the scatter between logs."""
    high: NDArray[numpy.float64]
    """Upper end of it."""
    reference: float
    """Level of the first logs."""
    logs: list[str]
    """The logs."""

    def to_frame(self, library: FrameName | None = None) -> Any:
        """A row for each log as a DataFrame, as of `Series.to_frame`."""
        names = ("time", "value", "std", "temperature", "corrected", "low", "high")
        return frame({"log": self.logs, **{name: getattr(self, name) for name in names}}, library)


class Drift:
    """What changed on which machine. Made by `drift`."""

    def __init__(self, native: _native.Drift) -> None:
        self._native = native

    @cached_property
    def result(self) -> dict[str, Any]:
        """Everything that was found: `drift.json`, described in docs/fleet.md."""
        result: dict[str, Any] = json.loads(self._native.result_json())
        return result

    @property
    def changed(self) -> bool:
        """Whether something changed, or is beyond a limit: exit code 1 of the command line."""
        return bool(self.alarms)

    @property
    def alarms(self) -> Rows:
        """What changed and what is beyond a limit, the largest over its limit first; `drift.alarms.to_frame()`."""
        return Rows(self.result["alarms"])

    @property
    def noise(self) -> Rows:
        """What each parameter does where nothing changes, and the `limits` beyond which it has changed."""
        return Rows(self.result["noise"])

    @cached_property
    def courses(self) -> list[Course]:
        """The courses of what is alarmed, in the order of the alarms."""
        found = []
        for names, columns, reference, logs in self._native.courses():
            named: dict[str, Any] = dict(columns)
            found.append(Course(*names, **named, reference=reference, logs=logs))
        return found

    def save(self, folder: PathLike, *, force: bool = False) -> list[Path]:
        """Writes `drift.json` and `report.html`, as `stiction drift --out`."""
        return self._native.save(path_of(folder, "folder"), force)

    def report(self) -> str:
        """The report: one HTML document without scripts."""
        return self._native.report()

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._native.parts(),)

    def __str__(self) -> str:
        return self._native.text()

    def __repr__(self) -> str:
        found, count = self.result, len(self.alarms)
        logs, machines = _counted(found["input"]["logs"], "log"), _counted(found["machines"], "machine")
        return f"<stiction.Drift of {logs}, {machines}: {_counted(count, 'alarm')}>"

    def _repr_html_(self) -> str:
        document = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{document}" style="width: 100%; height: 40em; border: 0"></iframe>'


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


def _again(parts: Any) -> Drift:
    """What it was before it was pickled."""
    return Drift(_native.Drift.of_parts(parts))


def drift(results: Any, *, limit: str | Iterable[str] = (), times: str | None = None) -> Drift:
    """What changed on which machine: as `stiction drift RESULTS.parquet` (docs/fleet.md).

    results: table that `stiction batch` wrote, or the folder of tables that `stiction.fleet.run` wrote; such a table in memory, as
    a DataFrame of pandas or polars, an Arrow table or a dict of columns; or a list of rows of `stiction.fleet.identify_uri`.
    limit: levels that are alarms too, such as "coulomb > 1.3" for 1.3 times the first logs, or "coulomb > 25 N".
    times: "names" for dates in the names of the logs, "files" for when they were written; else the times of the table.
    """
    limits = words(limit, "limit")
    if is_columns(results):
        return Drift(_native.drift_of_columns(NAME, _columns(results), limits, times))
    if isinstance(results, Iterable) and not isinstance(results, (str, bytes)):
        return Drift(_native.drift_of_rows(NAME, _rows(results), limits, times))
    return Drift(_native.drift(path_of(results, NAME, WHAT), limits, times))


def _columns(table: Any) -> list[tuple[str, list[Any]]]:
    """The columns, with None where nothing is known."""
    out: list[tuple[str, list[Any]]] = []
    for name, values in items(table, NAME):
        cells = _cells(values, f"{NAME}[{name!r}]", of_times=name == "time")
        if out and len(cells) != len(out[0][1]):
            raise argument(f"{NAME}[{name!r}]", f"{len(cells)} rows, where {out[0][0]} has {len(out[0][1])}", "as many in every column")
        out.append((str(name), cells))
    return out


def _known(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row with None where nothing is known, also after it was one of a DataFrame."""
    return {key: None if isinstance(value, float) and value != value else value for key, value in row.items()}


def _cells(values: Any, place: str, of_times: bool) -> list[Any]:
    # As numbers a column of times would count nanoseconds.
    if type(values).__module__ == "numpy" and values.dtype.kind == "M":
        values = values.astype("M8[us]")
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise argument(place, kind_of(values), "a cell for each row")
    for to_list in ("to_pylist", "to_list", "tolist"):
        if hasattr(values, to_list):
            values = getattr(values, to_list)()
            break
    cells = [None if is_missing(value) else value for value in values]
    times = (str, datetime.date) if of_times else datetime.date
    cells = [seconds(value, f"{place}, row {k + 1}") if isinstance(value, times) else value for k, value in enumerate(cells)]
    kind = None
    for k, value in enumerate(cells):
        if value is None:
            continue
        own = next((kind for kind in KINDS if isinstance(value, (float, int) if kind is float else kind)), None)
        if own is None or own is not (kind := kind or own):
            allowed = ", ".join(KINDS.values()) if kind is None else f"{KINDS[kind]}, as above"
            raise argument(f"{place}, row {k + 1}", repr(value), allowed)
    return cells


def _rows(rows: Iterable[Any]) -> list[str]:
    out: list[str] = []
    for k, row in enumerate(rows):
        place = f"{NAME}[{k}]"
        if not isinstance(row, Mapping):
            raise argument(place, kind_of(row), WHAT)
        try:
            out.append(json.dumps(_known(row), allow_nan=False))
        except (TypeError, ValueError) as error:
            raise argument(place, str(error), "a row that identify_uri gives") from error
    return out
