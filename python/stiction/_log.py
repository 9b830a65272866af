"""Logs: read, and looked at."""

from __future__ import annotations

import json
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Union

from . import _native
from ._axis import AXIS, axis_of, path_of
from ._columns import WHAT, columns, index, is_columns
from ._errors import StictionError, StictionWarning, argument
from ._groups import Run, group
from ._options import some_threads, whole
from ._progress import finish, teller
from ._types import AxisLike, Columns, PathLike

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray


class Finding(NamedTuple):
    """What is wrong with a log or worth knowing."""

    code: str
    """What it is; each code has a page in docs/codes."""
    severity: Literal["note", "warning"]
    """A warning is also given as a Python warning."""
    message: str
    """What was seen, with numbers."""


class Log:
    """A recording in SI units, checked. Made by `read_log`."""

    def __init__(self, native: _native.Log, axis: _native.Axis, origin: tuple[Any, ...]) -> None:
        self._native = native
        self._axis = axis
        self._origin = origin

    @property
    def path(self) -> Path:
        """Path, or the name of a log in memory."""
        return Path(self._native.path)

    @property
    def sha256(self) -> str:
        """SHA-256 of the file, or of the columns in memory."""
        return self._native.sha256

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self._native.samples

    @property
    def rate_hz(self) -> float:
        """Sampling rate, Hz."""
        return self._native.rate_hz

    @property
    def kind(self) -> str:
        """`linear` (m, m/s) or `rotary` (rad, rad/s)."""
        return self._native.kind

    @property
    def force_unit(self) -> str:
        """Unit of the force: `N`, `N*m`, `A`, `V`, or `1` for a share of the rated force."""
        return self._native.force_unit

    @property
    def time(self) -> NDArray[numpy.float64]:
        """Time from the first sample, s."""
        time = self._native.channel("time")
        assert time is not None
        return time

    @property
    def position(self) -> NDArray[numpy.float64] | None:
        """Position, m (rad); None where it was not recorded."""
        return self._native.channel("position")

    @property
    def velocity(self) -> NDArray[numpy.float64] | None:
        """Velocity as recorded, m/s (rad/s)."""
        return self._native.channel("velocity")

    @property
    def force(self) -> NDArray[numpy.float64] | None:
        """Force in `force_unit`, positive towards positive positions."""
        return self._native.channel("force")

    @property
    def reference(self) -> NDArray[numpy.float64] | None:
        """Position that was asked for, m (rad)."""
        return self._native.channel("reference")

    @property
    def findings(self) -> list[Finding]:
        """What is wrong with the log or worth knowing."""
        return [Finding(*told) for told in self._native.findings]

    @property
    def detected(self) -> list[str]:
        """How file and columns were understood."""
        return self._native.detected

    def __len__(self) -> int:
        return self.samples

    def __repr__(self) -> str:
        return f"<stiction.Log {str(self.path)!r}: {self.samples} samples at {self.rate_hz:.6g} Hz>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._origin, self.sha256)


def _again(origin: tuple[Any, ...], sha256: str) -> Log:
    """Reads a log once more, as when it is unpickled."""
    log = _read(*origin)
    if log.sha256 != sha256:
        raise StictionError(
            "log-io", str(log.path), "not what it was when the log was pickled", "a log that does not change"
        )
    return log


def _read(data: Any, axis: AxisLike, name: str) -> Log:
    known = axis_of(axis)
    if not isinstance(name, str) or not name or not name.isprintable():
        raise argument("name", repr(name), "text that a log in memory is called")
    if is_columns(data):
        given = columns(data, name)
        try:
            native = _native.Log.of_columns(name, given, known)
        except StictionError:
            # The time of pandas is often the index, which is no column.
            time = index(data, name)
            if time is None:
                raise
            given = [time, *given]
            native = _native.Log.of_columns(name, given, known)
        kept = {header: values if unit is None else (values, unit) for header, unit, values in given}
        return Log(native, known, (kept, axis, name))
    path = path_of(data, name, WHAT)
    return Log(_native.Log.read(path, known), known, (path, axis, name))


def read_log(log: PathLike | Columns, axis: AxisLike = None, *, name: str = "log") -> Log:
    """Reads a recording: a file, or columns in memory.

    log: path of a file of any format of docs/formats.md; or a dict of arrays, a DataFrame of pandas or polars, or a table
        of pyarrow, whose columns are named as in a file: `position [mm]`, or `{"position": (values, "mm")}`.
        Times (of numpy, datetime, pandas, polars, Arrow, with or without a zone) are seconds from the first. The index of a pandas
        DataFrame is taken where no column is the time. NaN, infinite and masked samples count as missing, as an empty cell of a
        file does.
    axis: what is known of the axis and its columns: path of an axis file, or its keys in a dict (docs/axis.md).
    name: what a log in memory is called in messages and results.

    What is wrong with the log is a StictionWarning; what cannot be read is a StictionError.
    """
    out = _read(log, axis, name)
    _warn(((f.code, f.message) for f in out.findings if f.severity == "warning" or f.code == ASSUMED), 2)
    return out


ASSUMED = "unit-assumed"
"""A note that is a warning here: every number rests on it, and in memory there is no file to look into."""


def _warn(told: Any, level: int) -> None:
    """Python warnings, at the line of the user's call."""
    for code, message in told:
        warnings.warn(StictionWarning(code, message), stacklevel=level + 1)


class Check:
    """What logs can and cannot determine. Made by `check`."""

    def __init__(self, found: dict[str, Any], text: str, trustworthy: bool) -> None:
        self.result = found
        """Everything that was found, as `stiction check --json` prints it."""
        self.is_trustworthy = trustworthy
        """Whether each log determines a law that may be trusted."""
        self._text = text

    @property
    def logs(self) -> list[dict[str, Any]]:
        """What was found, log by log."""
        logs: list[dict[str, Any]] = self.result["logs"]
        return logs

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<stiction.Check of {len(self.logs)} log{'s' if len(self.logs) != 1 else ''}>"


Logs = Union["Log", PathLike, Columns, "Sequence[Log | PathLike | Columns]"]
"""One log or several: read already, paths, or columns in memory."""


def several(logs: Any, place: str) -> list[Any]:
    """One log or several, as a list."""
    if isinstance(logs, (list, tuple)):
        return list(logs)
    if logs is None:
        raise argument(place, "None", "at least one log")
    return [logs]


def some_paths(logs: list[Any], place: str) -> list[str]:
    """The paths of logs that are all files."""
    return [path_of(log, place, f"a log that was read, {WHAT}, or a list of these") for log in logs]


def all_paths(logs: list[Any]) -> bool:
    """Whether these are files that are read as the command line reads them."""
    return not any(isinstance(log, Log) or is_columns(log) for log in logs)


def read_all(logs: list[Any], axis: AxisLike, place: str) -> list[Log]:
    """Reads those that are not read yet, with the axis of those that are."""
    out: list[Log] = []
    for k, log in enumerate(logs):
        if isinstance(log, Log):
            if axis is not None:
                raise argument("axis", f"an axis beside {place}[{k}], which was read with one", "read_log(..., axis)")
            out.append(log)
        else:
            name = place if len(logs) == 1 else f"{place}[{k}]"
            out.append(_read(log, axis, name))
    return out


def one_axis(logs: list[Log]) -> _native.Axis:
    """The axis that all of them were read with."""
    first = logs[0]
    for log in logs[1:]:
        if log._origin[1] != first._origin[1]:
            raise argument("logs", "logs that were read with different axes", "one axis: logs of one machine")
    return first._axis


def check(logs: Logs, axis: AxisLike = None, *, run: Run = Run()) -> Check:
    """What was read of logs, and what they can and cannot determine, as `stiction check`.

    logs, axis: as of `identify`. run: threads and progress.
    """
    run = group(run, Run, "run")
    each = several(logs, "logs")
    try:
        if all_paths(each) and not isinstance(axis, dict):
            if not each and axis is None:
                raise argument("logs", "no log", "at least one log, here or under [[log]] of the axis file")
            paths = some_paths(each, "logs")
            known = None if axis is None else path_of(axis, "axis", AXIS)
            found = _native.check_files(paths, known, teller(run.progress), some_threads(run.threads))
        else:
            read = read_all(each, axis, "logs")
            found = _native.check([log._native for log in read], one_axis(read), teller(run.progress), some_threads(run.threads))
    finally:
        finish(run.progress)
    return Check(json.loads(found[0]), found[1], found[2])


def write_demo_log(path: PathLike, seed: int = 0) -> Path:
    """Writes the log of a known, simulated axis: 9 s at 4 kHz, with encoder steps and noise, as `stiction demo`."""
    _native.write_demo_log(path_of(path, "path"), whole(seed, "seed"))
    return Path(path)


def write_procedure_logs(folder: PathLike, seed: int = 0) -> list[Path]:
    """Writes logs of the same axis for docs/procedures.md, as `stiction demo --procedures`: constant velocities, motion, force
    steps and ramps. Returns what was written."""
    return _native.write_procedure_logs(path_of(folder, "folder"), whole(seed, "seed"))


def allow_memory(size: int) -> None:
    """Memory that reading a log may take, bytes; a quarter of the machine's if it is not set."""
    _native.allow_memory(whole(size, "size", 1_000_000))
