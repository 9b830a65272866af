"""Pictures of a fit with matplotlib, the extra `plot`: axes have names and units, and belong to whoever asked for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from ._errors import StictionError, argument

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    from ._fit import Fit
    from ._log import Log
    from ._types import Columns, PathLike

MEASURED = {"color": "0.55", "linewidth": 1.0}
MODEL = {"color": "#c0392b", "linewidth": 1.2}
POINTS = {"color": "0.55", "linestyle": "none", "marker": ".", "markersize": 2.0}
WIDEST = 50.0
"""Half of an interval that is drawn whole at most, % of the value; wider ones end in an arrow."""
LOOPS = 6.0
"""How far a presliding loop is shown after a reversal, in deflections at which the axis breaks away."""


class _Friction(NamedTuple):
    """Friction along a log: what the law has, and that with the residual, which is what was measured of it."""

    time: NDArray[numpy.float64]
    position: NDArray[numpy.float64]
    velocity: NDArray[numpy.float64]
    model: NDArray[numpy.float64]
    residual: NDArray[numpy.float64]


class Plots:
    """Pictures of a fit: `fit.plot.force()`, `fit.plot.map(log)`. Each returns its matplotlib figure."""

    def __init__(self, fit: Fit) -> None:
        self._fit = fit

    def force(self, figure: Any = None) -> Any:
        """What was fitted over time: measured and model, and below it the residual. figure: to draw into."""
        figure, (above, below) = _axes(figure, 2, share=True)
        series = self._fit.series
        names = list(series)
        over, label = series[names[0]], _label(names[0], self._unit(names[0]))
        quality = self._fit.quality
        above.plot(over, series["measured"], label="measured", **MEASURED)
        above.plot(over, series["model"], label="model", **MODEL)
        above.set_ylabel(_label(quality["signal"], quality["unit"]))
        above.legend(loc="best")
        above.set_title(f"{self._fit.result['law']}, relative error {quality['relative_error_percent']:.3g} %")
        below.plot(over, series["residual"], **MEASURED)
        below.axhline(0.0, **MODEL)
        below.set_ylabel(_label("residual", quality["unit"]))
        below.set_xlabel(label)
        return figure

    def intervals(self, figure: Any = None) -> Any:
        """Each parameter with its 95 % interval, over its value. One that the log does not determine is grey, an open end an arrow."""
        rows = [row for row in self._fit.parameters.rows if row.flag != "given"]
        figure, (axes,) = _axes(figure, 1)
        names = []
        halves = [100.0 * abs(end - row.value) / (abs(row.value) or 1.0) for row in rows for end in (row.low, row.high) if end is not None]
        widest = 1.2 * max((half for half in halves if half <= WIDEST), default=WIDEST)
        for place, row in enumerate(rows):
            color = "0.6" if row.flag else MODEL["color"]
            size = abs(row.value) or 1.0
            axes.plot([0.0], [place], marker="o", color=color)
            for end, side in ((row.low, -1.0), (row.high, 1.0)):
                reach = widest if end is None else min(100.0 * abs(end - row.value) / size, widest)
                axes.plot([0.0, side * reach], [place, place], color=color)
                beyond = end is None or reach == widest
                axes.plot([side * reach], [place], color=color, marker=("<" if side < 0 else ">") if beyond else "|")
            unit = "" if row.unit == "1" else f" {row.unit}"
            names.append(f"{row.symbol} = {row.value:.4g}{unit}")
        axes.set_yticks(range(len(rows)), names)
        axes.invert_yaxis()
        axes.set_xlabel("95 % interval, % of the value")
        return figure

    def map(self, log: Log | PathLike | Columns, figure: Any = None) -> Any:
        """Friction over velocity along a log, measured and as the law has it, and below it the residual. log: as of `predict`."""
        log = self._fit._log(log)
        found = self._friction(log)
        figure, (above, below) = _axes(figure, 2, share=True)
        force, velocity = self._fit.result["axis"]["force_unit"], _speed(log)
        above.plot(found.velocity, found.model + found.residual, label="measured", **POINTS)
        above.plot(found.velocity, found.model, label=self._fit.result["law"], **{**POINTS, "color": MODEL["color"]})
        above.set_ylabel(_label("friction", force))
        above.legend(loc="best")
        below.plot(found.velocity, found.residual, **POINTS)
        below.axhline(0.0, **MODEL)
        below.set_ylabel(_label("residual", force))
        below.set_xlabel(_label("velocity", velocity))
        return figure

    def presliding(self, log: Log | PathLike | Columns, figure: Any = None) -> Any:
        """Friction over the way since the last reversal, from one to the next: the loops of the bristles before the axis slides.

        log: as of `predict`.
        """
        import numpy

        log = self._fit._log(log)
        found = self._friction(log)
        figure, (axes,) = _axes(figure, 1)
        turns = numpy.flatnonzero(numpy.diff(numpy.signbit(found.velocity))) + 1
        if len(turns) == 0:
            raise argument("log", "no reversal", "a log in which the axis turns back")
        reach = self._deflection(found)
        color = MODEL["color"]
        for first, last in zip(turns, [*turns[1:], len(found.position)]):
            way = found.position[first:last] - found.position[first]
            near = numpy.abs(way) <= reach
            # Until it is further away for the first time.
            near = numpy.logical_and.accumulate(near)
            measured = (found.model + found.residual)[first:last]
            axes.plot(1e6 * way[near], measured[near], **MEASURED)
            axes.plot(1e6 * way[near], found.model[first:last][near], color=color, linewidth=1.0)
        small = "µm" if log.kind == "linear" else "µrad"
        axes.set_xlabel(_label("way since the reversal", small))
        axes.set_ylabel(_label("friction", self._fit.result["axis"]["force_unit"]))
        axes.plot([], [], label="measured", **MEASURED)
        axes.plot([], [], label=self._fit.result["law"], color=color)
        axes.legend(loc="best")
        return figure

    def _friction(self, log: Log) -> _Friction:
        found = self._fit.predict(log)
        law = self._fit.law.record(found.time, found.velocity)
        return _Friction(found.time, found.position, found.velocity, law, found.residual)

    def _deflection(self, found: _Friction) -> float:
        """How far loops are shown, m (rad)."""
        values = {row.name.removesuffix("_pos"): row.value for row in self._fit.parameters.rows}
        stiffness = values.get("sigma0", 0.0)
        highest = values.get("static", values.get("coulomb", 0.0))
        travel = float(found.position.max() - found.position.min())
        return LOOPS * highest / stiffness if stiffness > 0.0 else 0.01 * travel

    def _unit(self, name: str) -> str:
        units = {column: unit for column, unit, _ in self._fit._native.series()}
        return units.get(name) or ""


def _axes(figure: Any, rows: int, share: bool = False) -> tuple[Any, list[Any]]:
    """Axes of a figure, of a new one where none is given."""
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise StictionError("usage", "plot", "matplotlib is not installed", "pip install stiction[plot]") from error
    if figure is None:
        import sys

        # In a notebook or a window where one is open already; else a figure that nobody has to close.
        pyplot = sys.modules.get("matplotlib.pyplot")
        figure = Figure(layout="constrained") if pyplot is None else pyplot.figure(layout="constrained")
    if not hasattr(figure, "subplots"):
        raise argument("figure", f"a {type(figure).__name__}", "a figure of matplotlib")
    ratios = [2.0, 1.0] if rows == 2 else [1.0]
    return figure, list(figure.subplots(rows, 1, squeeze=False, sharex=share, height_ratios=ratios)[:, 0])


def _label(name: str, unit: str) -> str:
    return name if unit in ("", "1") else f"{name}, {unit}"


def _speed(log: Log) -> str:
    return "m/s" if log.kind == "linear" else "rad/s"
