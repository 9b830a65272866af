"""What arguments may be."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple, TypedDict, Union

PathLike = Union[str, "os.PathLike[str]"]
"""A path of a file or folder."""

AxisLike = Union[str, "os.PathLike[str]", Mapping[str, Any], None]
"""What is known of an axis: the path of an axis file, or its keys in a dict."""

Columns = Any
"""Columns in memory: a dict of arrays, a DataFrame of pandas or polars, a table of pyarrow."""

LawName = Literal["auto", "coulomb-viscous", "stribeck", "dahl", "lugre", "elasto-plastic", "maxwell-slip", "gms"]
"""A friction law; `auto` lets the data choose."""

PlannedLawName = Literal["lugre", "maxwell-slip", "gms"]
"""A law that a motion is planned for."""

SearchName = Literal[
    "ga", "adaptive-ga", "annealing-ga", "niched-ga", "de", "cma-es", "pso", "annealing", "nelder-mead", "lm"
]
"""A search of docs/searches.md."""

MethodName = Union[
    Literal["separable", "static", "static-then-dynamic", "presliding-step", "output-error"], SearchName
]
"""How parameters are found."""

CostName = Literal["six", "separable"]
"""What a search minimises: six parameters of LuGre at once, or three with everything linear solved."""

TargetName = Literal[
    "c", "cpp", "ros2", "st", "tcpou", "plcopen", "rust", "mujoco", "modelica", "urdf", "sdf", "isaaclab", "newton",
    "bam", "domain-json", "hal", "fmu", "matlab", "tf5200", "drive-table", "cogging-map", "backlash",
]  # fmt: skip
"""A form in which a compensator is exported (docs/export.md)."""

FeedforwardName = Literal["friction", "mass", "gravity", "cogging", "rigid"]
"""A force that is fed forward; `rigid` of a robot alone."""

WidthName = Literal["repeatability", "transfer"]
"""Intervals that draws are from: the same motion on another day, or another motion."""

StageName = Literal["probe", "whole"]
"""A first, careful motion, or all that the limits allow."""

FormatName = Literal["csv", "st", "cam", "csp", "feed", "ros2", "halstreamer", "gcode"]
"""A form of the set points of a plan (docs/plan.md); `csv` is always there."""

FrameName = Literal["pandas", "polars"]
"""A library of DataFrames."""

ColumnWidth = Literal["single", "double"]
"""Width of a picture: one column of a page, 3.5 in, or both, 7.16 in."""

BandName = Literal["at_once", "repeat", "transfer"]
"""A 95 % interval: the same test again, now; on another day; another motion."""

Verdict = Literal["trustworthy", "not-trustworthy", "interrupted"]
"""What a result is worth: the exit codes 0, 1 and 130 of the command line."""


class Progress(NamedTuple):
    """How far work is."""

    stage: str
    """What is being done, such as `searching`."""
    fraction: float
    """Part of the stage that is done, 0 to 1; 0 where it is not known."""
    error: float | None
    """Least relative error so far; None before there is one."""


Watcher = Union[bool, Callable[[Progress], Any], None]
"""Who is told of the progress: True for a line on standard error, a function, or nobody."""


class IdentifyOptions(TypedDict):
    """Every option of an identification, as Rust takes them."""

    law: str
    asymmetric: bool
    compare_laws: bool
    split: float | None
    seed: int
    method: str
    statics: list[str]
    model: str | None
    break_away: list[str]
    plan: str | None
    search: str | None
    no_finish: bool
    cost: str | None
    evaluations: int | None
    target: float | None
    time: float | None
    checkpoint: str | None
    resume: str | None


class ExportOptions(TypedDict):
    """Every option of an export."""

    target: str
    name: str | None
    cycle_time: float
    limit: float | None
    rated_force: float | None
    gain: float | None
    ramp: float | None
    dead_zone: float | None
    slew: float | None
    window: float | None
    adapt: bool
    feedforward: list[str]
    draws: tuple[int, int, str] | None


class PlanOptions(TypedDict):
    """Every option of a plan."""

    known: str | None
    probe: bool
    time: float | None
    seed: int
    wants: list[str]
    formats: list[str]
    start: str | None
    asymmetric: bool
    law: str | None


class RowLog(TypedDict):
    """A log of a fleet, as Rust takes it."""

    file: str
    path: str | None
    machine: str | None
    time: float | None
    temperature: float | None
    axis_file: str | None
    axis: str | None
