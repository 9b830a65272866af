"""The compensator as code."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from . import _native
from ._axis import path_of
from ._log import _warn
from ._options import maybe, real, truth, words
from ._types import ExportOptions, PathLike


class Exported:
    """What `export` wrote."""

    def __init__(self, result: dict[str, Any], folder: Path) -> None:
        self.result = result
        """As `stiction export --json` prints it: target, name, law, limit, written, warnings."""
        self.folder = folder
        """Where the files are."""

    @property
    def files(self) -> list[Path]:
        """The files that were written."""
        return [self.folder / name for name in self.result["written"]]

    @property
    def warnings(self) -> list[tuple[str, str]]:
        """What to know before it runs: code and message. The same were Python warnings."""
        return [(warning["code"], warning["message"]) for warning in self.result["warnings"]]

    def __repr__(self) -> str:
        return f"<stiction.Exported {self.result['target']} in {str(self.folder)!r}>"


def write_code(
    model: str, file: str | None, options: ExportOptions, out: PathLike, force: bool
) -> Exported:
    """Writes a model as code."""
    folder = path_of(out, "out")
    return Exported(json.loads(_native.export(model, file, options, folder, force)), Path(folder))


def export(
    model: PathLike,
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
    """Writes the compensator of a model file as code: as `stiction export`, whose options these are. See `Fit.export`."""
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
    exported = write_code("", path_of(model, "model"), options, out, force)
    _warn(exported.warnings, 2)
    return exported
