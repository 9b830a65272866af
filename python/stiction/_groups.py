"""Options that belong together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

from ._errors import argument, kind_of
from ._types import CostName, PathLike, SearchName, Watcher, WidthName

Group = TypeVar("Group")


class Run(NamedTuple):
    """How a call runs."""

    seed: int = 0
    """Of whatever is drawn: searches, axes that a plan is made for. No effect where nothing is."""
    compare_laws: bool = True
    """`identify`: whether simpler laws are fitted beside one that is named; `auto` has to compare."""
    threads: int | None = None
    """Threads of this call alone, 1 to 1024; None takes those of the process. No result depends on it."""
    progress: Watcher = None
    """True for a line on standard error, or a function of a `Progress`; where it returns False the work stops."""


class Procedures(NamedTuple):
    """Recordings and files of the procedures of docs/procedures.md, for `identify`."""

    statics: PathLike | Sequence[PathLike] = ()
    """Logs of constant velocities."""
    model: PathLike | None = None
    """Model file for what is not identified here."""
    break_away: PathLike | Sequence[PathLike] = ()
    """Logs of force ramps."""
    plan: PathLike | None = None
    """The plan.toml that a log was recorded by."""


class Search(NamedTuple):
    """The search of an identification (docs/searches.md)."""

    name: SearchName | None = None
    """Methods `static` and `static-then-dynamic`: the search of each step; None: least squares alone."""
    no_finish: bool = False
    """Leaves out the least squares after the search, and with them the intervals."""
    cost: CostName | None = None
    """What is minimised; None takes that of the method."""
    evaluations: int | None = None
    """Most evaluations; None: 20000."""
    target: float | None = None
    """Cost at which it stops: the square of the relative error, 1e-4 for 1 %."""
    time: float | None = None
    """Time after which it stops, s; what is found then depends on the machine."""
    checkpoint: PathLike | None = None
    """File in which its state is kept."""
    resume: PathLike | None = None
    """State to go on from."""


class Compensator(NamedTuple):
    """What an exported compensator may do; what is None follows from the law (docs/export.md)."""

    limit: float | None = None
    """Largest force, in the unit of the model's force; None: twice static friction and offset."""
    gain: float | None = None
    """Share of the friction that is compensated, 0 to 1; None: 0.75."""
    ramp: float | None = None
    """Time in which it comes in and goes, s; None: 0.05."""
    dead_zone: float | None = None
    """Speed that counts as standstill, m/s (rad/s)."""
    slew: float | None = None
    """Fastest change of the force, in the unit of the model's force per second."""
    window: float | None = None
    """Moving time that the watchdog compares, s: a cycle of the motion; 0: no watchdog; None: 2."""
    adapt: bool = False
    """Whether levels of friction follow the machine while it runs, from the force of the drive."""
    rated_force: float | None = None
    """Rated force of the motor, in the unit of the model's force; for `tf5200`."""


class Draws(NamedTuple):
    """Draws of what a simulator takes: for `domain-json`, `mujoco`, `isaaclab`, `newton`, `bam`."""

    number: int
    """How many, 1 to 100000."""
    seed: int = 0
    """The same seed gives the same bytes."""
    width: WidthName = "transfer"
    """Intervals that they are from: another day, or another motion."""


def group(value: Any, kind: type[Group], place: str) -> Group:
    """A group of options."""
    if not isinstance(value, kind):
        raise argument(place, kind_of(value), f"a stiction.{kind.__name__}")
    return value
