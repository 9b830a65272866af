"""Options that are numbers, checked where they can still be named."""

from __future__ import annotations

import datetime
import operator
from collections.abc import Iterable
from typing import Any

from . import _native
from ._errors import StictionError, argument

LARGEST = 2**64 - 1
"""Of a seed."""
MOST_THREADS = 1024
"""As on the command line."""
TIME = "a number of seconds, ISO 8601 text as 2026-03-01T06:30:00Z, or a date or time of datetime, numpy or pandas"
"""What a time may be."""


def whole(value: Any, place: str, least: int = 0, most: int = LARGEST) -> int:
    """A whole number."""
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if isinstance(value, bool) or not least <= number <= most:
        raise argument(place, repr(value), f"a whole number from {least} to {most}")
    return number


def real(value: Any, place: str) -> float:
    """A number."""
    try:
        if isinstance(value, (str, bytes, bool)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise argument(place, repr(value), "a number") from None


def seconds(value: Any, place: str) -> float:
    """Seconds of a time: a number as it stands, since 1970 UTC of a date; one without a time zone is UTC."""
    if isinstance(value, str):
        found = _native.seconds_of(value)
        if found is None:
            raise argument(place, repr(value), TIME)
        return found
    if getattr(getattr(value, "dtype", None), "kind", None) == "M":  # numpy
        value = value.astype("M8[us]").item()
    if isinstance(value, datetime.datetime):
        return (value if value.tzinfo else value.replace(tzinfo=datetime.timezone.utc)).timestamp()
    if isinstance(value, datetime.date):
        return datetime.datetime(value.year, value.month, value.day, tzinfo=datetime.timezone.utc).timestamp()
    try:
        number = real(value, place)
    except StictionError:
        raise argument(place, repr(value), TIME) from None
    if abs(number) == float("inf") or number != number:
        raise argument(place, repr(value), TIME)
    return number


def samples(value: Any, place: str) -> int:
    """A number of samples, which may be written as 2e9."""
    number = real(value, place)
    if not 1.0 <= number <= LARGEST:
        raise argument(place, repr(value), f"a number from 1 to {LARGEST}")
    return int(value)


def maybe(value: Any, place: str) -> float | None:
    """A number, or none."""
    return None if value is None else real(value, place)


def truth(value: Any, place: str) -> bool:
    """Yes or no."""
    if not isinstance(value, bool) and type(value).__name__ not in ("bool", "bool_"):
        raise argument(place, repr(value), "True or False")
    return bool(value)


def some_threads(value: Any) -> int | None:
    """Threads of a call, or those of the process."""
    return None if value is None else whole(value, "run.threads", 1, MOST_THREADS)


def choice(value: Any, place: str, kind: str | None = None) -> str:
    """One of the names that an argument may have; those of the kind, or of the argument itself."""
    names = _native.choices(kind or place.rpartition(".")[2])
    if value not in names:
        raise argument(place, repr(value), f"one of {', '.join(names)}")
    return str(value)


def words(value: Any, place: str) -> list[str]:
    """Names; one alone is a list of one."""
    names = [value] if isinstance(value, str) or not isinstance(value, Iterable) else list(value)
    if not all(isinstance(name, str) for name in names):
        raise argument(place, repr(value), "names")
    return names
