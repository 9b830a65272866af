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
from ._export import Exported, write_code
from ._law import Law
from ._log import Log, _read, _warn
from ._options import maybe, real, truth, words
from ._parameters import Parameters
from ._plan import Plan, plan
from ._study import Study, simulate
from ._types import AxisLike, Columns, ExportOptions, PathLike, Verdict, Watcher

if TYPE_CHECKING:
    from tempfile import TemporaryDirectory

    import numpy
    from numpy.typing import NDArray

    from ._plot import Plots


class Covariance(NamedTuple):
    """Covariance of the identified parameters, in the squares and products of their units."""

    names: list[str]
    """Names of rows and columns."""
    matrix: NDArray[numpy.float64]
    """Row by row; zero rows for parameters that the data do not determine at all."""


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


class Friction(NamedTuple):
    """Friction in steady sliding by speed, whatever the law: half of the sum of both directions, of a log with one direction its own,
    with half widths of 95 % intervals."""

    speed: NDArray[numpy.float64]
    """Speed, m/s or rad/s."""
    force: NDArray[numpy.float64]
    """Force against the motion, in the unit of the log."""
    at_once: NDArray[numpy.float64]
    """Half width for the same test again, now."""
    repeat: NDArray[numpy.float64]
    """Half width for another day."""
    transfer: NDArray[numpy.float64]
    """Half width for another motion."""


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
    def friction(self) -> Friction | None:
        """Friction by speed; None where the axis does not slide. Both directions apart: `friction_curve` in docs/result.md."""
        import numpy

        curve = self.result.get("friction_curve")
        if curve is None:
            return None
        own = curve.get("both") or curve.get("forward") or curve["back"]
        fields = ("force", "at_once", "repeat", "transfer")
        return Friction(numpy.array(curve["speed"]), *(numpy.array(own[field]) for field in fields))

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
    def series(self) -> dict[str, NDArray[numpy.float64]]:
        """The columns of `fit.csv`: time, measured, model, residual, and mostly position, velocity and other, at the samples that were
        fitted."""
        return {name: values for name, _, values in self._native.series()}

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
        progress: Watcher = None,
        threads: int | None = None,
    ) -> Study:
        """What compensation with this law does on this axis, simulated: as `stiction simulate study.toml`.

        study: a study file (docs/study.md); that of the fit if it is not given. max_samples: as of `simulate`.
        """
        if study is not None:
            return simulate(study, max_samples=max_samples, progress=progress, threads=threads)
        with _Files(self, ["study.toml", "model.toml"]) as folder:
            if not (folder / "study.toml").exists():
                raise argument("study", "none, and this law has no study of its own", "the path of a study file")
            own = folder / "study.toml"
            return simulate(own, max_samples=max_samples, progress=progress, threads=threads)

    def plan(
        self,
        axis: PathLike | Mapping[str, Any],
        *,
        time: float | None = None,
        seed: int = 0,
        progress: Watcher = None,
        threads: int | None = None,
    ) -> Plan:
        """The motion to record for what this fit leaves open: as `stiction plan axis.toml --model model.toml`.

        axis: path of an axis file with [limits], or its keys in a dict. time: longest motion, s.
        """
        with _Files(self, ["model.toml"]) as folder:
            model = folder / "model.toml"
            return plan(axis, model=model, time=time, seed=seed, progress=progress, threads=threads)

    def export(
        self,
        target: str,
        out: PathLike,
        *,
        cycle_time: float = 1e-3,
        limit: float | None = None,
        gain: float | None = None,
        ramp: float | None = None,
        dead_zone: float | None = None,
        slew: float | None = None,
        window: float | None = None,
        adapt: bool = False,
        feedforward: Iterable[str] = ("friction",),
        rated_force: float | None = None,
        name: str | None = None,
        force: bool = False,
    ) -> Exported:
        """Writes the compensator as code for a target: as `stiction export model.toml`, whose options these are.

        target: `c`, `cpp`, `st`, ... (docs/export.md). out: folder for the files. cycle_time: time between two calls, s.
        What is not given follows from the law.
        """
        options: ExportOptions = {
            "target": str(target),
            "name": None if name is None else str(name),
            "cycle_time": real(cycle_time, "cycle_time"),
            "limit": maybe(limit, "limit"),
            "rated_force": maybe(rated_force, "rated_force"),
            "gain": maybe(gain, "gain"),
            "ramp": maybe(ramp, "ramp"),
            "dead_zone": maybe(dead_zone, "dead_zone"),
            "slew": maybe(slew, "slew"),
            "window": maybe(window, "window"),
            "adapt": truth(adapt, "adapt"),
            "feedforward": words(feedforward, "feedforward"),
        }
        exported = write_code(self._native.model_toml(), None, options, out, force)
        _warn(exported.warnings, 2)
        return exported

    @property
    def plot(self) -> Plots:
        """Pictures with matplotlib: `plot.force()`, `plot.intervals()`, `plot.map(log)`, `plot.presliding(log)`."""
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
