"""Machines that were identified from licensed public recordings."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from . import _native
from ._axis import path_of
from ._frames import Rows
from ._types import FrameName, PathLike


class Machine:
    """A machine of the library."""

    def __init__(self, row: dict[str, Any]) -> None:
        self.result = row
        """Its row of the index: title, kind, source, licence, recordings, command, found."""

    @property
    def name(self) -> str:
        """Name in the library."""
        return str(self.result["name"])

    @property
    def usable(self) -> bool:
        """Whether its model may be used for compensation, of a robot for feedforward."""
        return bool(self.result["found"]["usable"])

    @property
    def files(self) -> dict[str, str]:
        """Its files by path: `model.toml` (of a robot `robot.toml` and a model for each joint), the axis file, `machine.json`."""
        return dict(_native.machine_files(self.name))

    def write(self, folder: PathLike, *, force: bool = False) -> list[Path]:
        """Writes its files, as `stiction library NAME --out`; a model there is one for `stiction.export`."""
        return _native.write_machine(self.name, path_of(folder, "folder"), force)

    def __repr__(self) -> str:
        return f"<stiction.Machine {self.name!r}: {self.result['title']}>"


class Library(Mapping[str, Machine]):
    """The machines by name. Made by `library`."""

    def __init__(self) -> None:
        rows = json.loads(_native.library())
        self._machines = {row["name"]: Machine(row) for row in rows}

    def __getitem__(self, name: str) -> Machine:
        try:
            return self._machines[name]
        except KeyError:
            raise KeyError(f"{name!r} is no machine of the library; it has {', '.join(self._machines)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._machines)

    def __len__(self) -> int:
        return len(self._machines)

    def to_frame(self, library: FrameName | None = None) -> Any:
        """Name, title, kind, licence, law and held-out error of each, as a DataFrame as of `Series.to_frame`."""
        names = ("law", "held_out_error_percent", "usable")
        rows = [machine.result for machine in self.values()]
        return Rows(
            {**{name: row[name] for name in ("name", "title", "kind", "licence")}, **{name: row["found"][name] for name in names}}
            for row in rows
        ).to_frame(library)

    def __repr__(self) -> str:
        return f"<stiction.Library of {len(self)} machines: {', '.join(self)}>"


def library() -> Library:
    """The machines that come with stiction, as `stiction library` lists them (docs/library.md)."""
    return Library()
