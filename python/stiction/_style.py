"""How pictures look: sizes of a page of two columns, ink that is readable in grey, and which axes a figure has."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ._errors import StictionError, argument
from ._types import ColumnWidth

WIDTHS = {"single": 3.5, "double": 7.16}
"""Width of a figure, in: a column, and both columns, of a page of IEEE (88.9 and 181.9 mm)."""
HEIGHTS = {1: 2.4, 2: 3.2}
"""Height by the number of axes above each other, in."""

INK: dict[Any, Any] = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.0,
    # A small velocity is a power of ten at the end of its axis.
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "savefig.dpi": 300.0,
    # Text stays text: TrueType in PDF, letters in SVG.
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
    # The same file from the same figure.
    "svg.hashsalt": "stiction",
}
"""Of matplotlib."""

# Light and thick behind, dark and thin before: told apart in grey too.
MEASURED = {"color": "0.62", "linewidth": 1.4}
MODEL = {"color": "#8c1c13", "linewidth": 0.8}
RESIDUAL = {"color": "0.35", "linewidth": 0.6}
POINTS = {"color": "0.62", "linestyle": "none", "marker": ".", "markersize": 1.6, "markeredgewidth": 0.0, "rasterized": True}
POINTS_OF_MODEL = {**POINTS, "color": MODEL["color"], "markersize": 1.1}
ZERO = {"color": "0.0", "linewidth": 0.4}


@contextmanager
def style() -> Iterator[None]:
    """The look of the pictures, for figures of your own: `with stiction.style(): ...`. Needs matplotlib.

    Saved within it, text stays text (TrueType in PDF), which publishers ask for, and the dots are 300 an inch.
    """
    try:
        from matplotlib import rc_context
    except ImportError as error:
        raise missing() from error
    with rc_context(INK):
        yield


def missing() -> StictionError:
    """Without matplotlib."""
    return StictionError("usage", "plot", "matplotlib is not installed", "pip install stiction[plot]")


def panels(figure: Any, rows: int, width: ColumnWidth, share: bool = False) -> tuple[Any, list[Any]]:
    """Axes of a figure, of a new one where none is given."""
    if width not in WIDTHS:
        raise argument("width", repr(width), f"one of {', '.join(WIDTHS)}")
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise missing() from error
    if figure is None:
        # In a notebook or a window where one is open already; else a figure that nobody has to close.
        pyplot = sys.modules.get("matplotlib.pyplot")
        make = Figure if pyplot is None else pyplot.figure
        figure = make(figsize=(WIDTHS[width], HEIGHTS[rows]), layout="constrained")
    if not hasattr(figure, "subplots"):
        raise argument("figure", f"a {type(figure).__name__}", "a figure of matplotlib")
    ratios = [2.0, 1.0] if rows == 2 else [1.0]
    return figure, list(figure.subplots(rows, 1, squeeze=False, sharex=share, height_ratios=ratios)[:, 0])


def label(name: str, unit: str) -> str:
    """A name with its unit: `force, N`."""
    return name if unit in ("", "1") else f"{name}, {printed(unit)}"


def printed(unit: str) -> str:
    """A unit as it is printed: `N·s/m`."""
    return unit.replace("*", "\N{MIDDLE DOT}")
