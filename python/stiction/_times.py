"""When something was recorded: seconds, as a list of logs has them (docs/fleet.md)."""

from __future__ import annotations

import datetime
from typing import Any

from . import _native
from ._errors import StictionError, argument
from ._options import real

TIME = "a number of seconds, ISO 8601 text as 2026-03-01T06:30:00Z, or a date or time of datetime, numpy or pandas"
"""What a time may be."""


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
