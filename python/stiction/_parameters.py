"""The parameters of a fit as a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import Any, NamedTuple

from ._frames import frame
from ._types import FrameName


class Parameter(NamedTuple):
    """One parameter, in SI units; a force that the log has in A or V stays in it."""

    name: str
    """Name, such as `sigma0`, `coulomb`, `static`; with `_pos` or `_neg` where each direction has its own."""
    symbol: str
    """Symbol for people, such as `σ₀`."""
    value: float
    """Value in `unit`. Look at `flag` before it is used."""
    unit: str
    """SI unit."""
    std: float | None
    """Standard deviation of the same test on another day; None where the data say nothing, or where the value was given."""
    low: float | None
    """Lower end of the 95 % interval; None where the data do not bound the value there."""
    high: float | None
    """Upper end."""
    flag: str
    """Empty; `given`; or `NOT IDENTIFIABLE`: a value that is not to be used."""
    reason: str
    """Why it is not identifiable."""
    advice: str
    """What to record so that it becomes identifiable."""
    at_once: float | None
    """Half width of the 95 % interval for the same test again, now; None where only one interval is known."""
    repeat: float | None
    """The same for another day, which `low` and `high` are the ends of."""
    transfer: float | None
    """The same for another motion."""


COLUMNS = ("name", "symbol", "value", "unit", "std", "low", "high", "flag")
"""What a table of them shows."""


class Parameters(Mapping[str, Parameter]):
    """The parameters in the order of tables: `parameters["coulomb"].value`, `list(parameters.values())`."""

    def __init__(self, entries: list[dict[str, Any]]) -> None:
        self._rows = {entry["name"]: _row(entry) for entry in entries}

    def __getitem__(self, name: str) -> Parameter:
        try:
            return self._rows[name]
        except KeyError:
            raise KeyError(f"{name!r} is no parameter of this law; it has {', '.join(self._rows)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    @property
    def rows(self) -> list[Parameter]:
        """The rows of the table."""
        return list(self._rows.values())

    def to_dict(self) -> dict[str, list[Any]]:
        """Column by column."""
        return {field: [getattr(row, field) for row in self.rows] for field in Parameter._fields}

    def to_frame(self, library: FrameName | None = None) -> Any:
        """As a DataFrame, as of `Series.to_frame`."""
        return frame(self.to_dict(), library)

    def __str__(self) -> str:
        table = [COLUMNS, *(tuple(_shown(getattr(row, c)) for c in COLUMNS) for row in self.rows)]
        widths = [max(len(line[k]) for line in table) for k in range(len(COLUMNS))]
        return "\n".join("  ".join(cell.ljust(w) for cell, w in zip(line, widths)).rstrip() for line in table)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{c}</th>" for c in COLUMNS)
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(_shown(getattr(row, c)))}</td>" for c in COLUMNS) + "</tr>"
            for row in self.rows
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _row(entry: dict[str, Any]) -> Parameter:
    low, high = entry["ci95"] or (None, None)
    given = entry["origin"] == "given"
    flag = "given" if given else "" if entry["identifiable"] else "NOT IDENTIFIABLE"
    return Parameter(
        name=entry["name"],
        symbol=entry["symbol"],
        value=entry["value"],
        unit=entry["unit"],
        std=entry["std"],
        low=low,
        high=high,
        flag=flag,
        reason=entry["reason"],
        advice=entry.get("advice", ""),
        **_half_widths(entry),
    )


def _shown(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _half_widths(entry: dict[str, Any]) -> dict[str, float | None]:
    half = entry.get("half_width") or {}
    return {name: half.get(name) for name in ("at_once", "repeat", "transfer")}
