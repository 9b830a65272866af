"""Who is told of the progress."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from ._errors import argument
from ._types import Progress, Watcher

Told = Callable[[str, float, "float | None"], Any]


def teller(progress: Watcher) -> Told | None:
    """The function that Rust calls."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _line if _is_shown() else None
    if not callable(progress):
        raise argument("run.progress", repr(progress), "True, or a function of a Progress")
    watch = progress
    return lambda stage, fraction, error: watch(Progress(stage, fraction, error))


def _is_shown() -> bool:
    """Whether standard error is a terminal or a notebook, where a line can be written over."""
    return sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel")


def _line(stage: str, fraction: float, error: float | None) -> None:
    """One line that is written over, on a terminal and in a notebook."""
    best = "" if error is None else f", error {100 * error:.3g} %"
    sys.stderr.write(f"\r{stage:>18} {int(100 * fraction):3d} %{best}".ljust(60))
    sys.stderr.flush()


def finish(progress: Watcher) -> None:
    """Ends that line."""
    if progress is True and _is_shown():
        sys.stderr.write("\r".ljust(61) + "\r")
        sys.stderr.flush()
