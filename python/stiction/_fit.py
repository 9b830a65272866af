"""What an identification found."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _native
from ._axis import path_of
from ._errors import argument
from ._export import Exported, options_of, write_code
from ._friction import Friction, FrictionCurve, friction_at, mean_curve
from ._frames import Series, frame
from ._groups import Compensator, Draws, Run
from ._law import Law
from ._log import Log, _read, _warn
from ._next import call_of
from ._parameters import Parameters
from ._plan import Plan, plan
from ._study import Study, simulate
from ._types import AxisLike, Columns, FeedforwardName, FrameName, PathLike, TargetName, Verdict

if TYPE_CHECKING:
    from tempfile import TemporaryDirectory

    import numpy
    from numpy.typing import ArrayLike, NDArray

    from ._plot import Plots


class Covariance(NamedTuple):
    """Covariance of the identified parameters, in the squares and products of their units."""

    names: list[str]
    """Names of rows and columns."""
    matrix: NDArray[numpy.float64]
    """Row by row; zero rows for parameters that the data do not determine at all."""

    def to_frame(self, library: FrameName | None = None) -> Any:
        """As a DataFrame, as of `Series.to_frame`: the column `name`, and one for each parameter."""
        return frame({"name": self.names, **dict(zip(self.names, self.matrix.T))}, library)


class Prediction(NamedTuple):
    """What a law makes of a log that it was not fitted to."""

    time: NDArray[numpy.float64]
    """Time, s."""
    position: NDArray[numpy.float64]
    """Position, m or rad."""
    velocity: NDArray[numpy.float64]
    """Velocity, m/s or rad/s."""
    measured: NDArray[numpy.float64]
    """Measured force, filtered as for the fit."""
    model: NDArray[numpy.float64]
    """Predicted force."""
    residual: NDArray[numpy.float64]
    """Measured minus predicted."""
    quality: dict[str, Any]
    """How well it predicts: the keys of `fit` in docs/result.md."""

    def to_frame(self, library: FrameName | None = None) -> Any:
        """All but `quality` as a DataFrame, as of `Series.to_frame`."""
        return frame({name: values for name, values in self._asdict().items() if name != "quality"}, library)


class Fit:
    """An identified law with everything that is known of it. Made by `identify`, or `Fit.load` from a folder."""

    def __init__(self, native: _native.Fit, folder: Path | None = None, axis: AxisLike = None) -> None:
        self._native = native
        self._folder = folder
        self._axis = axis

    @cached_property
    def result(self) -> dict[str, Any]:
        """Everything that was found: `result.json`, described in docs/result.md."""
        result: dict[str, Any] = json.loads(self._native.result_json())
        return result

    @property
    def parameters(self) -> Parameters:
        """The parameters with units, intervals and flags."""
        return Parameters(self.result["parameters"])

    @property
    def friction_curve(self) -> FrictionCurve | None:
        """Friction by speed as a table; None where the axis does not slide."""
        entry = self.result.get("friction_curve")
        return None if entry is None else mean_curve(entry)

    def friction(self, velocity: float | ArrayLike) -> Friction:
        """Friction in steady sliding at a velocity or an array of them, m/s (rad/s), whatever the law.

        Linear between the speeds of `friction_curve`, of the direction of the velocity; NaN outside the speeds of the log and for a
        direction that it does not have.
        """
        entry = self.result.get("friction_curve")
        if entry is None:
            raise argument("fit", "an axis that does not slide", "a fit with a friction_curve")
        return friction_at(entry, velocity)

    @property
    def covariance(self) -> Covariance:
        """Covariance of the identified parameters."""
        import numpy

        entry = self.result["covariance"]
        names: list[str] = entry["names"]
        return Covariance(names, numpy.array(entry["matrix"], dtype=numpy.float64).reshape(len(names), len(names)))

    @property
    def verdict(self) -> Verdict:
        """`trustworthy`, `not-trustworthy` or `interrupted`; `reasons` says why."""
        if self.result["search"]["status"] == "interrupted":
            return "interrupted"
        return "trustworthy" if self.is_trustworthy else "not-trustworthy"

    @property
    def is_trustworthy(self) -> bool:
        """Whether the law may be used to compensate."""
        return bool(self.result["trust"]["trustworthy"])

    @property
    def reasons(self) -> list[str]:
        """Why it may not be used; empty if it may."""
        reasons: list[str] = self.result["trust"]["reasons"]
        return reasons

    @property
    def warnings(self) -> list[tuple[str, str]]:
        """What to know although the identification went on: code and message. The same were Python warnings."""
        return [(warning["code"], warning["message"]) for warning in self.result["warnings"]]

    @property
    def quality(self) -> dict[str, Any]:
        """How well the law fits the samples that it was fitted to: `fit` in docs/result.md."""
        quality: dict[str, Any] = self.result["fit"]
        return quality

    @cached_property
    def series(self) -> Series:
        """The columns of `fit.csv`: time, measured, model, residual, and mostly position, velocity and other, at the samples that were
        fitted; `fit.series.to_frame()`."""
        return Series({name: values for name, _, values in self._native.series()})

    @property
    def residual(self) -> NDArray[numpy.float64]:
        """Measured minus model, in the unit of what was fitted."""
        return self.series["residual"]

    @property
    def law(self) -> Law:
        """The friction law at rest, to be called sample by sample or along a record."""
        model = self.result
        return Law(self._native.law(), model["law"], model["axis"]["force_unit"])

    def predict(self, log: Log | PathLike | Columns) -> Prediction:
        """What the law makes of another log, conditioned in the same way; nothing is fitted again.

        log: what `read_log` read; or its path or columns in memory, which are read with the axis of the fit.
        A fit that was loaded or unpickled has no filters of a record and refuses: identify again, which gives the same bits.
        """
        signals, quality = self._native.predict(self._log(log)._native)
        return Prediction(**dict(signals), quality=json.loads(quality))

    def _log(self, log: Log | PathLike | Columns) -> Log:
        """A log of the axis of the fit."""
        return log if isinstance(log, Log) else _read(log, self._axis, "log")

    def save(self, folder: PathLike, *, force: bool = False) -> list[Path]:
        """Writes `result.json`, `model.toml`, `report.html`, `fit.csv` and `study.toml`, the files of `stiction identify --out`.

        Whole or not at all. A folder that holds something else is left alone unless `force`; what was stopped early goes
        beside a complete result. Returns what was written.
        """
        written = self._native.save(path_of(folder, "folder"), force)
        self._folder = written[-1].parent if written else None
        return written

    @classmethod
    def load(cls, folder: PathLike) -> Fit:
        """Reads the folder that `save` or `stiction identify --out` wrote."""
        path = path_of(folder, "folder")
        file = Path(path)
        if file.is_file():
            instead = f": {str(file.parent)!r}" if (file.parent / "result.json").is_file() else ""
            allowed = f"the folder that save or stiction identify --out wrote{instead}"
            raise argument("folder", f"{path!r}, a file", allowed)
        return cls(_native.Fit.load(path), Path(path))

    def simulate(
        self,
        study: PathLike | None = None,
        *,
        max_samples: float | None = None,
        run: Run = Run(),
    ) -> Study:
        """What compensation with this law does on this axis, simulated: as `stiction simulate study.toml`.

        study: a study file (docs/study.md); that of the fit if it is not given. max_samples: as of `simulate`.
        """
        if study is not None:
            return simulate(study, max_samples=max_samples, run=run)
        with _Files(self, ["study.toml", "model.toml"]) as folder:
            if not (folder / "study.toml").exists():
                raise argument("study", "none, and this law has no study of its own", "the path of a study file")
            own = folder / "study.toml"
            return simulate(own, max_samples=max_samples, run=run)

    def plan(
        self,
        axis: PathLike | Mapping[str, Any],
        *,
        time: float | None = None,
        run: Run = Run(),
    ) -> Plan:
        """The motion to record for what this fit leaves open: as `stiction plan axis.toml --model model.toml`.

        axis: path of an axis file with [limits], or its keys in a dict. time: longest motion, s.
        """
        with _Files(self, ["model.toml"]) as folder:
            model = folder / "model.toml"
            return plan(axis, known=model, time=time, run=run)

    def export(
        self,
        target: TargetName,
        out: PathLike,
        *,
        cycle_time: float = 1e-3,
        feedforward: FeedforwardName | Iterable[FeedforwardName] = ("friction",),
        compensator: Compensator = Compensator(),
        draws: Draws | None = None,
        name: str | None = None,
        force: bool = False,
    ) -> Exported:
        """Writes the compensator as code for a target: as `stiction export model.toml`.

        target: see docs/export.md. out: folder for the files. cycle_time: time between two calls, s.
        feedforward: friction, and what else is fed forward. compensator: force limit, gain, watchdog. draws: for simulators.
        name: what names in the code begin with. force: writes into a folder that holds something else.
        """
        options = options_of(target, cycle_time, feedforward, compensator, draws, name)
        exported = write_code(self._native.model_toml(), None, None, options, out, force)
        _warn(exported.warnings, 2)
        return exported

    @property
    def next(self) -> str:
        """What to do next, as a line of Python: the command that `stiction identify` prints behind `next:`."""
        told = self._native.next()
        return "" if told is None else call_of(json.loads(told), self.result, self._axis)

    @property
    def plot(self) -> Plots:
        """Pictures with matplotlib: `plot.force()`, `plot.intervals()`, `plot.friction()`, `plot.map(log)`, `plot.presliding(log)`."""
        from ._plot import Plots

        return Plots(self)

    def report(self) -> str:
        """The report: one HTML document without scripts."""
        return self._native.report()

    def __str__(self) -> str:
        return self._native.text() or str(self.parameters)

    def __repr__(self) -> str:
        error = self.quality["relative_error_percent"]
        return f"<stiction.Fit {self.result['law']}, {self.verdict}, relative error {error:.3g} %>"

    def _repr_html_(self) -> str:
        document = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{document}" style="width: 100%; height: 40em; border: 0"></iframe>'

    def __reduce__(self) -> tuple[Any, ...]:
        return _of_files, (str(self._folder or ""), self._native.files())


def _of_files(folder: str, files: list[tuple[str, bytes]]) -> Fit:
    """A fit of its files, as when it is unpickled."""
    return Fit(_native.Fit.of_files(folder, files), Path(folder) if folder else None)


class _Files:
    """Files of a fit in a folder: where it was saved, as long as they are there, else one that is taken away again."""

    def __init__(self, fit: Fit, names: list[str]) -> None:
        self._fit = fit
        self._names = names
        self._made: TemporaryDirectory[str] | None = None

    def __enter__(self) -> Path:
        import tempfile

        files = dict(self._fit._native.files())
        saved = self._fit._folder
        wanted = [name for name in self._names if name in files]
        if saved is not None and all(_holds(saved / name, files[name]) for name in wanted):
            return saved
        self._made = tempfile.TemporaryDirectory(prefix="stiction-")
        folder = Path(self._made.name)
        for name in wanted:
            (folder / name).write_bytes(files[name])
        return folder

    def __exit__(self, *_: object) -> None:
        if self._made is not None:
            self._made.cleanup()


def _holds(file: Path, content: bytes) -> bool:
    try:
        return file.read_bytes() == content
    except OSError:
        return False
