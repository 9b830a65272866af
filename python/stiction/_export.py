"""The compensator as code."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from . import _native
from ._axis import path_of, some_path
from ._groups import Compensator, Draws, group
from ._log import _warn
from ._options import choice, maybe, real, truth, whole, words
from ._types import ExportOptions, FeedforwardName, PathLike, TargetName

MOST_DRAWS = 100_000
"""As on the command line."""


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


def options_of(
    target: str,
    cycle_time: float,
    feedforward: FeedforwardName | Iterable[FeedforwardName],
    compensator: Compensator,
    draws: Draws | None,
    name: str | None,
) -> ExportOptions:
    """The options as Rust takes them."""
    compensator = group(compensator, Compensator, "compensator")
    drawn = None if draws is None else group(draws, Draws, "draws")
    return {
        "target": choice(target, "target"),
        "name": None if name is None else str(name),
        "cycle_time": real(cycle_time, "cycle_time"),
        "limit": maybe(compensator.limit, "compensator.limit"),
        "rated_force": maybe(compensator.rated_force, "compensator.rated_force"),
        "gain": maybe(compensator.gain, "compensator.gain"),
        "ramp": maybe(compensator.ramp, "compensator.ramp"),
        "dead_zone": maybe(compensator.dead_zone, "compensator.dead_zone"),
        "slew": maybe(compensator.slew, "compensator.slew"),
        "window": maybe(compensator.window, "compensator.window"),
        "adapt": truth(compensator.adapt, "compensator.adapt"),
        "feedforward": words(feedforward, "feedforward"),
        "draws": None
        if drawn is None
        else (
            whole(drawn.number, "draws.number", 1, MOST_DRAWS),
            whole(drawn.seed, "draws.seed"),
            choice(drawn.width, "draws.width"),
        ),
    }


def write_code(model: str, file: str | None, urdf: str | None, options: ExportOptions, out: PathLike, force: bool) -> Exported:
    """Writes a model as code."""
    folder = path_of(out, "out")
    return Exported(json.loads(_native.export(model, file, urdf, options, folder, force)), Path(folder))


def export(
    model: PathLike,
    target: TargetName,
    out: PathLike,
    *,
    cycle_time: float = 1e-3,
    feedforward: FeedforwardName | Iterable[FeedforwardName] = ("friction",),
    compensator: Compensator = Compensator(),
    draws: Draws | None = None,
    urdf: PathLike | None = None,
    name: str | None = None,
    force: bool = False,
) -> Exported:
    """Writes the compensator of a model.toml, or of all joints of a robot.toml, as code: as `stiction export`.

    urdf: that of a robot in place of the one that robot.toml names. The others: as of `Fit.export`.
    """
    options = options_of(target, cycle_time, feedforward, compensator, draws, name)
    exported = write_code("", path_of(model, "model"), some_path(urdf, "urdf"), options, out, force)
    _warn(exported.warnings, 2)
    return exported
