"""Pictures of a fit with matplotlib, the extra `plot`: axes have names and units, and belong to whoever asked for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from ._errors import argument
from ._style import MEASURED, MODEL, POINTS, POINTS_OF_MODEL, RESIDUAL, ZERO, label, panels, printed, style
from ._types import BandName, ColumnWidth

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    from ._fit import Fit
    from ._log import Log
    from ._types import Columns, PathLike

WIDEST = 50.0
"""Half of an interval that is drawn whole at most, % of the value; wider ones end in an arrow."""
LOOPS = 6.0
"""How far a presliding loop is shown after a reversal, in deflections at which the axis breaks away."""
BANDS = {"at_once": "the same test again, now", "repeat": "another day", "transfer": "another motion"}
"""The intervals of a friction curve."""
FINE = 200
"""Speeds at which a friction curve is drawn."""


class _Friction(NamedTuple):
    """Friction along a log: what the law has, and that with the residual, which is what was measured of it."""

    time: NDArray[numpy.float64]
    position: NDArray[numpy.float64]
    velocity: NDArray[numpy.float64]
    model: NDArray[numpy.float64]
    residual: NDArray[numpy.float64]


class Plots:
    """Pictures of a fit: `figure, axes = fit.plot.force()`.

    Each returns a matplotlib figure and its axes, of one column of a page (`width="single"`, 3.5 in) or of both (`"double"`,
    7.16 in), without a title, readable in grey: `figure.savefig("force.pdf")`. figure: one of your own to draw into.
    """

    def __init__(self, fit: Fit) -> None:
        self._fit = fit

    def force(self, figure: Any = None, *, width: ColumnWidth = "single") -> tuple[Any, list[Any]]:
        """What was fitted over time: measured and model, and below it the residual."""
        with style():
            figure, (above, below) = panels(figure, 2, width, share=True)
            series = self._fit.series
            names = list(series)
            over, unit = series[names[0]], self._fit.quality["unit"]
            above.plot(over, series["measured"], label="measured", **MEASURED)
            above.plot(over, series["model"], label="model", **MODEL)
            above.set_ylabel(label(self._fit.quality["signal"], unit))
            _legend(above)
            below.plot(over, series["residual"], **RESIDUAL)
            below.axhline(0.0, **ZERO)
            below.set_ylabel(label("residual", unit))
            below.set_xlabel(label(names[0], self._unit(names[0])))
            figure.align_ylabels()
        return figure, [above, below]

    def intervals(self, figure: Any = None, *, width: ColumnWidth = "single") -> tuple[Any, list[Any]]:
        """Each parameter with its 95 % interval, over its value. One that the log does not determine is hollow, an open end an arrow."""
        rows = [row for row in self._fit.parameters.rows if row.flag != "given"]
        with style():
            figure, (axes,) = panels(figure, 1, width)
            names = []
            halves = [100.0 * abs(end - row.value) / (abs(row.value) or 1.0) for row in rows for end in (row.low, row.high) if end is not None]
            widest = 1.2 * max((half for half in halves if half <= WIDEST), default=WIDEST)
            axes.axvline(0.0, **ZERO)
            for place, row in enumerate(rows):
                color = "0.6" if row.flag else MODEL["color"]
                size = abs(row.value) or 1.0
                for end, side in ((row.low, -1.0), (row.high, 1.0)):
                    reach = widest if end is None else min(100.0 * abs(end - row.value) / size, widest)
                    axes.plot([0.0, side * reach], [place, place], color=color, linewidth=1.0)
                    beyond = end is None or reach == widest
                    axes.plot([side * reach], [place], color=color, marker=("<" if side < 0 else ">") if beyond else "|", markersize=5.0)
                inside = "white" if row.flag else color
                axes.plot([0.0], [place], marker="o", color=color, markerfacecolor=inside, markersize=4.0)
                unit = "" if row.unit == "1" else f" {printed(row.unit)}"
                names.append(f"{row.symbol} = {row.value:.4g}{unit}")
            axes.set_yticks(range(len(rows)), names)
            axes.invert_yaxis()
            axes.set_xlabel("95 % interval, % of the value")
        return figure, [axes]

    def map(self, log: Log | PathLike | Columns, figure: Any = None, *, width: ColumnWidth = "single") -> tuple[Any, list[Any]]:
        """Friction over velocity along a log, measured and as the law has it, and below it the residual. log: as of `predict`."""
        log = self._fit._log(log)
        found = self._friction(log)
        with style():
            figure, (above, below) = panels(figure, 2, width, share=True)
            unit = self._force_unit
            above.plot(found.velocity, found.model + found.residual, label="measured", **POINTS)
            above.plot(found.velocity, found.model, label=self._fit.result["law"], **POINTS_OF_MODEL)
            above.set_ylabel(label("friction", unit))
            _legend(above, markerscale=4.0)
            below.plot(found.velocity, found.residual, **{**POINTS, "color": RESIDUAL["color"]})
            below.axhline(0.0, **ZERO)
            below.set_ylabel(label("residual", unit))
            below.set_xlabel(label("velocity", self._speed_unit))
            figure.align_ylabels()
        return figure, [above, below]

    def friction(
        self, band: BandName | None = "transfer", figure: Any = None, *, width: ColumnWidth = "single"
    ) -> tuple[Any, list[Any]]:
        """Friction in steady sliding by velocity, whatever the law, with a 95 % band: `at_once`, `repeat`, `transfer`, or None."""
        import numpy

        if band is not None and band not in BANDS:
            raise argument("band", repr(band), f"one of {', '.join(BANDS)}, or None")
        entry = self._fit.result.get("friction_curve")
        if entry is None:
            raise argument("fit", "an axis that does not slide", "a fit with a friction_curve")
        knots = numpy.array(entry["speed"])
        speed = numpy.unique(numpy.concatenate([knots, numpy.linspace(knots[0], knots[-1], FINE)]))
        has_both = entry.get("forward") is not None and entry.get("back") is not None
        signs = (-1.0, 1.0) if has_both else (1.0,) if entry.get("back") is None else (-1.0,)
        with style():
            figure, (axes,) = panels(figure, 1, width)
            for sign in signs:
                at = self._fit.friction(sign * speed)
                named = sign == signs[0]
                if band is not None:
                    half = getattr(at, band)
                    interval = f"95 %, {BANDS[band]}" if named else None
                    axes.fill_between(at.velocity, at.force - half, at.force + half, color="0.8", linewidth=0.0, label=interval)
                axes.plot(at.velocity, at.force, label="friction" if named else None, **MODEL)
            if has_both:
                axes.axhline(0.0, **ZERO)
                axes.axvline(0.0, **ZERO)
            axes.set_xlabel(label("velocity", entry["speed_unit"]))
            axes.set_ylabel(label("friction", entry["unit"]))
            _legend(axes)
        return figure, [axes]

    def presliding(self, log: Log | PathLike | Columns, figure: Any = None, *, width: ColumnWidth = "single") -> tuple[Any, list[Any]]:
        """Friction over the displacement since the last reversal, from one to the next: the loops of the bristles before the axis
        slides. log: as of `predict`.
        """
        import numpy

        log = self._fit._log(log)
        found = self._friction(log)
        turns = numpy.flatnonzero(numpy.diff(numpy.signbit(found.velocity))) + 1
        if len(turns) == 0:
            raise argument("log", "no reversal", "a log in which the axis turns back")
        reach = self._deflection(found)
        with style():
            figure, (axes,) = panels(figure, 1, width)
            for k, (first, last) in enumerate(zip(turns, [*turns[1:], len(found.position)])):
                way = found.position[first:last] - found.position[first]
                near = numpy.abs(way) <= reach
                # Until it is further away for the first time.
                near = numpy.logical_and.accumulate(near)
                measured = (found.model + found.residual)[first:last]
                axes.plot(1e6 * way[near], measured[near], label="measured" if k == 0 else None, **MEASURED)
                axes.plot(1e6 * way[near], found.model[first:last][near], label=self._fit.result["law"] if k == 0 else None, **MODEL)
            small = "µm" if log.kind == "linear" else "µrad"
            axes.set_xlabel(label("displacement since the reversal", small))
            axes.set_ylabel(label("friction", self._force_unit))
            _legend(axes)
        return figure, [axes]

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

    @property
    def _force_unit(self) -> str:
        return str(self._fit.result["axis"]["force_unit"])

    @property
    def _speed_unit(self) -> str:
        return "m/s" if self._fit.result["axis"]["kind"] == "linear" else "rad/s"

    def _unit(self, name: str) -> str:
        units = {column: unit for column, unit, _ in self._fit._native.series()}
        return units.get(name) or ""


def _legend(axes: Any, **options: Any) -> None:
    """Above the axes, where it hides nothing."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, borderaxespad=0.1, **options)
