"""Studies: an axis with and without compensation."""

from __future__ import annotations

import json
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Any

from . import _native
from ._axis import path_of
from ._frames import Rows
from ._groups import Run, group
from ._log import _warn
from ._options import samples, some_threads
from ._progress import finish, teller
from ._types import PathLike, Verdict

STOPPED = ("interrupted", "the work was stopped; this is what was found until then")
"""The warning where Ctrl-C ended work early."""


class Study:
    """What came out of a study. Made by `simulate`."""

    def __init__(self, native: _native.Study) -> None:
        self._native = native

    @cached_property
    def result(self) -> dict[str, Any]:
        """Everything that was found: `study.json`, described in docs/study.md."""
        result: dict[str, Any] = json.loads(self._native.result_json())
        return result

    @property
    def rows(self) -> Rows:
        """One row for each path, controller, compensator and kind of parameters; `study.rows.to_frame()`."""
        return Rows(self.result["results"])

    @property
    def verdict(self) -> Verdict:
        """Whether runs were made: `trustworthy`, `not-trustworthy` or `interrupted`."""
        return self._native.verdict

    @property
    def warnings(self) -> list[tuple[str, str]]:
        """What to beware of: code and message. The same were Python warnings."""
        told = [(warning["code"], warning["message"]) for warning in self.result["warnings"]]
        return [*told, STOPPED] if self.result["status"] == STOPPED[0] else told

    def save(self, folder: PathLike, *, force: bool = False) -> list[Path]:
        """Writes `study.json`, `report.html` and the courses of the runs, as `stiction simulate --out`."""
        return self._native.save(path_of(folder, "folder"), force)

    def report(self) -> str:
        """The report: one HTML document without scripts."""
        return self._native.file("report.html") or ""

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._native.parts(),)

    def __str__(self) -> str:
        return self._native.text()

    def __repr__(self) -> str:
        return f"<stiction.Study {self.result['name']!r}: {len(self.rows)} rows>"

    def _repr_html_(self) -> str:
        document = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{document}" style="width: 100%; height: 40em; border: 0"></iframe>'


def _again(parts: Any) -> Study:
    """A study of its parts, as when it is unpickled."""
    native = _native.Study.of_parts(parts)
    assert native is not None
    return Study(native)


def simulate(
    study: PathLike,
    *,
    max_samples: float | None = None,
    run: Run = Run(),
) -> Study:
    """Simulates an axis with and without compensation: as `stiction simulate study.toml` (docs/study.md).

    max_samples: samples that may be simulated, 2e9 if it is not given; a study with more is refused before it begins.
    run: threads and progress.
    """
    run = group(run, Run, "run")
    most = None if max_samples is None else samples(max_samples, "max_samples")
    try:
        native, _ = _native.simulate(path_of(study, "study"), most, teller(run.progress), some_threads(run.threads))
    finally:
        finish(run.progress)
    out = Study(native)
    _warn(out.warnings, 2)
    return out
