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


class PlanOptions(TypedDict):
    """Every option of a plan."""

    model: str | None
    log: str | None
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
