"""Tables as DataFrames of pandas or polars, whichever there is."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ._errors import argument
from ._types import FrameName

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

FRAMES = ("pandas", "polars")
"""In the order in which they are looked for."""


def frame(columns: Mapping[str, Any], library: FrameName | None) -> Any:
    """A DataFrame of columns; of pandas, or polars where there is no pandas, unless one is asked for."""
    if library is not None and library not in FRAMES:
        raise argument("library", repr(library), f"one of {', '.join(FRAMES)}")
    for name in FRAMES if library is None else (library,):
        try:
            return importlib.import_module(name).DataFrame(dict(columns))
        except ModuleNotFoundError as error:
            if error.name != name:
                raise
    raise argument("library", f"no {library or 'pandas and no polars'}", f"pip install {library or 'pandas'}")


class Series(dict[str, "NDArray[numpy.float64]"]):
    """Columns of equal length by name: a dict of arrays."""

    def to_frame(self, library: FrameName | None = None) -> Any:
        """The columns as a DataFrame: of pandas, or polars where there is no pandas, unless `library` names one."""
        return frame(self, library)


class Rows(list[dict[str, Any]]):
    """Rows of a table: a list of dicts."""

    def to_frame(self, library: FrameName | None = None) -> Any:
        """The rows as a DataFrame, as of `Series.to_frame`; what is nested has names with dots, what a row lacks is missing."""
        flat = [dict(_flat(row)) for row in self]
        names = dict.fromkeys(name for row in flat for name in row)
        return frame({name: [row.get(name) for row in flat] for name in names}, library)


def _flat(row: Mapping[str, Any], before: str = "") -> Iterable[tuple[str, Any]]:
    for name, value in row.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{name}.")
        else:
            yield before + name, value
