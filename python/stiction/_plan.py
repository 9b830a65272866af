"""The motion to record."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Any

from . import _native
from ._axis import AXIS, path_of, some_path, text_of
from ._errors import StictionError
from ._frames import Rows, Series
from ._groups import Run, group
from ._log import _warn
from ._options import choice, maybe, some_threads, truth, whole, words
from ._progress import Told, finish, teller
from ._study import STOPPED
from ._types import FormatName, PathLike, PlannedLawName, PlanOptions, StageName

OWN_FILE = "axis.toml"
"""What a plan calls an axis that is no file."""


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
    def setpoints(self) -> Series:
        """The motion at the rate of the log: `t` s, `x` m (rad), `v`, `a`; `plan.setpoints.to_frame()`."""
        return Series({name: values for name, _, values in self._native.setpoints()})

    @property
    def expected(self) -> Rows:
        """What a log of it can be expected to show of each parameter."""
        return Rows(self.result["parameter"])

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
    axis: PathLike | Mapping[str, Any],
    *,
    known: PathLike | None = None,
    stage: StageName = "whole",
    time: float | None = None,
    wants: str | Sequence[str] = (),
    formats: FormatName | Sequence[FormatName] = (),
    start: str | None = None,
    asymmetric: bool = False,
    law: PlannedLawName | None = None,
    run: Run = Run(),
) -> Plan:
    """The motion to record, within the limits of an axis: as `stiction plan axis.toml`.

    axis: path of an axis file with [limits], or its keys in a dict.
    known: a first model (model.toml) or log of the axis; the motion is planned for what it leaves open. See `Fit.plan`.
    stage: `probe` for a first, careful motion. time: longest motion, s; 9 s, and 3 s of a probe, if it is not given.
    wants: how well parameters are to be known, such as `sigma0 < 2 %`: the shortest motion that is enough.
    formats: further forms of the set points, which `save` writes. start: where the axis stands when the motion starts, with its
    unit, such as `120 mm`. asymmetric: plan for parameters of each direction of motion. law: the law that is fitted, `lugre` if
    neither it, the model nor the axis file says; `maxwell-slip` and `gms` need a first log or model. run: seed, threads, progress.
    """
    run = group(run, Run, "run")
    options: PlanOptions = {
        "known": some_path(known, "known"),
        "probe": choice(stage, "stage") == "probe",
        "time": maybe(time, "time"),
        "seed": whole(run.seed, "run.seed"),
        "wants": words(wants, "wants"),
        "formats": words(formats, "formats"),
        "start": None if start is None else str(start),
        "asymmetric": truth(asymmetric, "asymmetric"),
        "law": None if law is None else choice(law, "law", "planned_law"),
    }
    tell, own = teller(run.progress), some_threads(run.threads)
    try:
        if isinstance(axis, Mapping):
            native, stopped = _of_keys(axis, options, tell, own)
        else:
            native, stopped = _native.plan(path_of(axis, "axis", AXIS), options, tell, own)
    finally:
        finish(run.progress)
    if native is None:
        raise KeyboardInterrupt("stopped before there was a motion")
    if stopped:
        _warn([STOPPED], 2)
    return Plan(native)


def _of_keys(axis: Mapping[str, Any], options: PlanOptions, tell: Told | None, threads: int | None) -> tuple[_native.Plan | None, bool]:
    """The motion for an axis in a dict, through a file that nothing of the plan names."""
    import tempfile

    text = _native.Axis.of_json(text_of(axis)).text or ""
    with tempfile.TemporaryDirectory(prefix="stiction-") as folder:
        path = os.path.join(folder, OWN_FILE)
        Path(path).write_text(text, encoding="utf-8")
        try:
            native, stopped = _native.plan(path, options, tell, threads)
        except StictionError as error:
            place, found, allowed = (said.replace(path, "axis") for said in (error.place, error.found, error.allowed))
            raise StictionError(error.code, place, found, allowed) from None
    if native is None:
        return None, stopped
    files, result, said, inputs, rest = native.parts()
    files = [(name, content.replace(path.encode(), OWN_FILE.encode())) for name, content in files]
    inputs = [each for each in inputs if str(each) != path]
    parts = (files, result.replace(path, OWN_FILE), said.replace(path, OWN_FILE), inputs, rest)
    return _native.Plan.of_parts(parts), stopped
