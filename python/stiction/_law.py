"""A friction law that is run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _native
from ._columns import array
from ._errors import argument
from ._options import real

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray


FOREVER = float("inf")
SPAN = "a finite time above 0, s: that between two samples"
"""What `dt` may be."""


class Law:
    """A friction law with its state. Made by `Fit.law`, at rest; every look at `Fit.law` gives another one.

    In real time, one call a sample: `force = law(velocity, dt)`. The state goes on from call to call; sigma1 is limited so
    that no sample creates energy, and the force is finite whatever comes in.

    Along a record, from rest and with the velocity linear between samples, as an identification takes it:
    `force = law.record(time, velocity)`. This neither uses nor changes the state.

    Threads that share a law step it one after the other, an array in one piece; let each have a law of its own.
    """

    def __init__(self, native: _native.Law, kind: str, unit: str) -> None:
        self._native = native
        self.kind = kind
        """Family of the law, such as `lugre`."""
        self.unit = unit
        """Unit of the force."""

    def __call__(self, velocity: float, dt: float) -> float:
        """One sample in real time: `dt` s at `velocity` m/s (rad/s); the force, positive against positive velocities."""
        try:
            if not 0.0 < dt < FOREVER:
                raise argument("dt", repr(dt), SPAN)
            return self._native.step(velocity, dt)
        except TypeError:
            real(velocity, "velocity")
            real(dt, "dt")
            raise

    def steps(self, velocity: Any, dt: float) -> NDArray[numpy.float64]:
        """The same sample after sample for an array of velocities, in one call."""
        span = real(dt, "dt")
        if not 0.0 < span < FOREVER:
            raise argument("dt", repr(dt), SPAN)
        return self._native.steps(array(velocity, "velocity"), span)

    def record(self, time: Any, velocity: Any) -> NDArray[numpy.float64]:
        """The force along a record: time in s, velocity in m/s (rad/s)."""
        t, v = array(time, "time"), array(velocity, "velocity")
        if len(t) != len(v):
            raise argument("velocity", f"{len(v)} samples, where time has {len(t)}", "as many of both")
        return self._native.record(t, v)

    @property
    def force(self) -> float:
        """Force of the last sample in real time."""
        return self._native.force

    @property
    def state(self) -> list[float]:
        """Deflection of the bristle, m (rad), or the spring forces of elements; empty for a law without memory."""
        return self._native.state

    def reset(self) -> None:
        """Back to rest."""
        self._native.reset()

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._native.model, self._native.memory(), self.kind, self.unit)

    def __repr__(self) -> str:
        return f"<stiction.Law {self.kind}, force {self.force:.6g} {self.unit}>"


def _again(model: str, memory: list[float], kind: str, unit: str) -> Law:
    """A law as it was, as when it is unpickled."""
    return Law(_native.Law.of_model(model, memory), kind, unit)
