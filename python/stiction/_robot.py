"""A robot: logs of all its joints and a URDF in, its rigid body and the friction of each joint out."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cached_property
from html import escape
from pathlib import Path
from types import MappingProxyType
from typing import Any

from . import _native
from ._axis import path_of, paths_of
from ._errors import argument
from ._fit import Fit
from ._frames import Rows
from ._groups import Run, group
from ._log import _warn
from ._options import maybe, some_threads, whole
from ._progress import finish, teller
from ._study import STOPPED
from ._types import PathLike, Verdict


class Joint:
    """A joint of a robot."""

    def __init__(self, native: _native.Robot, entry: dict[str, Any]) -> None:
        self._native = native
        self.result = entry
        """What was found of it: an entry of `joints` in `robot.json`."""

    @property
    def name(self) -> str:
        """Its name in the URDF."""
        return str(self.result["name"])

    @property
    def trustworthy(self) -> bool:
        """Whether the model predicts its torque on samples that were not fitted."""
        return bool(self.result.get("fit", {}).get("trustworthy", False))

    @cached_property
    def fit(self) -> Fit | None:
        """Its friction as `identify` returns that of an axis; None where it could not be fitted. The torque of the rigid body acts on
        it from outside, so another log is predicted with the whole robot: `robot(..., validate=...)`."""
        native = self._native.fit(self.name)
        return None if native is None else Fit(native)

    def __repr__(self) -> str:
        state = "trustworthy" if self.trustworthy else "not trustworthy"
        return f"<stiction.Joint {self.name!r}, {state}>"


class Robot:
    """What was identified of a robot. Made by `robot`."""

    def __init__(self, native: _native.Robot) -> None:
        self._native = native

    @cached_property
    def result(self) -> dict[str, Any]:
        """Everything that was found: `robot.json`."""
        result: dict[str, Any] = json.loads(self._native.result_json())
        return result

    @cached_property
    def joints(self) -> Mapping[str, Joint]:
        """The joints that were logged, by name, in the order of the URDF."""
        return MappingProxyType({entry["name"]: Joint(self._native, entry) for entry in self.result["joints"]})

    @property
    def rows(self) -> Rows:
        """A row for each joint: name, unit, law, friction, armature, errors; `robot.rows.to_frame()`."""
        joints = self.result["joints"]
        return Rows(
            {name: value for name, value in {**entry, **entry.get("fit", {})}.items() if name != "fit" and not isinstance(value, list)}
            for entry in joints
        )

    @property
    def base_parameters(self) -> Rows:
        """A row for each combination of masses and inertias that the motion determines: name, unit, value, half width, that of the URDF."""
        return Rows(self.result["base"])

    @property
    def bodies(self) -> Rows:
        """A row for each body: joint, link, mass kg, centre m, inertia kg m^2, and those of the URDF."""
        return Rows(self.result["bodies"])

    @property
    def trustworthy(self) -> bool:
        """Whether the model predicts the torque of every fitted joint on samples that were not fitted."""
        return bool(self.result["trust"]["trustworthy"])

    @property
    def reasons(self) -> list[str]:
        """Why it may not be used; empty if it may."""
        reasons: list[str] = self.result["trust"]["reasons"]
        return reasons

    @property
    def verdict(self) -> Verdict:
        """`trustworthy`, `not-trustworthy` or `interrupted`."""
        return self._native.verdict

    @property
    def warnings(self) -> list[tuple[str, str]]:
        """What to beware of: code and message. The same were Python warnings."""
        return [(warning["code"], warning["message"]) for warning in self.result["warnings"]]

    def write(self, folder: PathLike, *, force: bool = False) -> list[Path]:
        """Writes `robot.json`, `robot.toml`, `report.html` and a folder for each joint, as `stiction robot --out`.

        Whole or not at all. A folder that holds something else is left alone unless `force`. Returns what was written.
        """
        return self._native.write(path_of(folder, "folder"), force)

    def report(self) -> str:
        """The report: one HTML document without scripts."""
        return self._native.report()

    def __str__(self) -> str:
        return self._native.text()

    def __repr__(self) -> str:
        return f"<stiction.Robot {self.result['name']!r}: {len(self.joints)} joints, {self.verdict}>"

    def _repr_html_(self) -> str:
        document = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{document}" style="width: 100%; height: 40em; border: 0"></iframe>'


def robot(
    logs: PathLike | Sequence[PathLike],
    *,
    urdf: PathLike | None = None,
    robot: PathLike | None = None,
    validate: PathLike | Sequence[PathLike] = (),
    split: float | None = None,
    run: Run = Run(),
) -> Robot:
    """Identifies a robot from logs of all its joints: as `stiction robot`, the same options, defaults and bits.

    logs: paths of one log or several, fitted together. urdf: the URDF; that of the robot file if it is not given.
    robot: path of a robot file (`--axis`): what is known of the robot, its joints and their columns.
    validate: logs to validate on, which are not fitted. split: or the share of the time of each log that is fitted, 0 to 1.
    run: seed, threads and progress.

    Ctrl-C ends the searches and keeps the best, as of `identify`.
    """
    run = group(run, Run, "run")
    held_out = paths_of(validate, "validate")
    if split is not None and held_out:
        raise argument("split", "split together with validate", "one of the two")
    try:
        native, stopped = _native.robot(
            paths_of(logs, "logs"),
            None if urdf is None else path_of(urdf, "urdf"),
            None if robot is None else path_of(robot, "robot"),
            held_out,
            maybe(split, "split"),
            whole(run.seed, "run.seed"),
            teller(run.progress),
            some_threads(run.threads),
        )
    finally:
        finish(run.progress)
    out = Robot(native)
    _warn([*out.warnings, STOPPED] if stopped else out.warnings, 2)
    return out
