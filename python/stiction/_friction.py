"""Friction in steady sliding by speed."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _native
from ._errors import argument, kind_of
from ._frames import frame
from ._types import FrameName

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

FIELDS = ("force", "at_once", "repeat", "transfer")
"""Keys of a curve in result.json."""


class Friction(NamedTuple):
    """Friction at velocities, with half widths of 95 % intervals; NaN outside the speeds of the log. Floats for a number."""

    velocity: Any
    """Velocity, m/s (rad/s)."""
    force: Any
    """Friction in the unit of the log, positive against positive velocities; with the constant force, such as a weight, where both
    directions are known."""
    at_once: Any
    """Half width for the same test again, now."""
    repeat: Any
    """Half width for another day."""
    transfer: Any
    """Half width for another motion."""


class FrictionCurve(NamedTuple):
    """Friction by speed, whatever the law: half of the sum of both directions, of a log with one direction its own, with half
    widths of 95 % intervals. Both directions apart: `friction_curve` in docs/result.md."""

    speed: NDArray[numpy.float64]
    """Speed, m/s or rad/s."""
    force: NDArray[numpy.float64]
    """Force against the motion, in the unit of the log."""
    at_once: NDArray[numpy.float64]
    """Half width for the same test again, now."""
    repeat: NDArray[numpy.float64]
    """Half width for another day."""
    transfer: NDArray[numpy.float64]
    """Half width for another motion."""

    def to_frame(self, library: FrameName | None = None) -> Any:
        """The curve as a DataFrame, as of `Series.to_frame`."""
        return frame(self._asdict(), library)


def mean_curve(entry: dict[str, Any]) -> FrictionCurve:
    """The curve of both directions together."""
    import numpy

    own = entry.get("both") or entry.get("forward") or entry["back"]
    return FrictionCurve(numpy.array(entry["speed"]), *(numpy.array(own[field]) for field in FIELDS))


def friction_at(entry: dict[str, Any], velocity: Any) -> Friction:
    """Linear between the speeds of the curve, of the direction of the velocity; NaN for one that the log does not have."""
    import numpy

    try:
        v = numpy.asarray(velocity, dtype=numpy.float64)
    except (TypeError, ValueError):
        raise argument("velocity", kind_of(velocity), "a number or an array of numbers, m/s (rad/s)") from None
    columns = [v.copy(), *_native.friction_at(json.dumps(entry), v)]
    return Friction(*(column if column.ndim else float(column) for column in columns))
