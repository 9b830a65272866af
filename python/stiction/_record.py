"""Samples of a device into a log, read-only."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from . import _native
from ._axis import path_of
from ._groups import Run, group
from ._log import _warn
from ._options import maybe, words
from ._progress import finish, teller
from ._types import PathLike


class Recorded(NamedTuple):
    """What was recorded. Made by `record`."""

    path: Path | None
    """The log; None where there is no sample."""
    samples: int
    """Samples in it."""
    seconds: float
    """Time from the first to the last sample, s."""
    rate_hz: float
    """Rate that the device has, Hz; 0 where there are too few samples to tell."""
    lost: int
    """Samples that are missing in the gaps."""
    gaps: int
    """Gaps between time stamps."""
    reconnects: int
    """Connections that were made anew."""
    repeated: int
    """Samples left out because their time stamp was there already."""
    incomplete: int
    """Samples left out because a column was missing."""
    unwritten: int
    """Samples that came and could not be written."""
    complete: bool
    """Whether the time was over; else Ctrl-C or a fault ended it."""
    fault: tuple[str, str] | None
    """Why the device was lost: code and message. The same was a Python warning."""


def record(
    device: str | Sequence[str],
    out: PathLike,
    *,
    rate: float | None = None,
    time: float | None = None,
    run: Run = Run(),
) -> Recorded:
    """Records a device into a log, as `stiction record`: it reads, and never writes to the device (docs/record.md).

    device: `"rtde://192.168.0.5"`, or `["ads://5.12.34.56.1.1:851/MAIN.fActPos=mm", "MAIN.fActTorque=%"]`.
    out: new file, `.csv` or `.parquet`.
    rate: samples per second, Hz; that of the device if it is not given. time: time to record, s; None until Ctrl-C.
    run: progress.

    The first Ctrl-C, and a progress function that returns False, end the recording and keep the log. A device that gives no first
    sample is a StictionError.
    """
    run = group(run, Run, "run")
    asked = words(device, "device")
    try:
        path, numbers, complete, fault = _native.record(
            asked, path_of(out, "out"), maybe(rate, "rate"), maybe(time, "time"), teller(run.progress)
        )
    finally:
        finish(run.progress)
    named = dict(numbers)
    whole = {name: int(value) for name, value in named.items() if name not in ("seconds", "rate_hz")}
    if fault is not None:
        _warn([fault], 2)
    return Recorded(
        path=path, seconds=named["seconds"], rate_hz=named["rate_hz"], complete=complete, fault=fault, **whole
    )
