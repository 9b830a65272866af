"""What is known of an axis: a file, or the same keys in a dict."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from . import _native
from ._errors import argument
from ._types import AxisLike


def axis_of(axis: AxisLike) -> _native.Axis:
    """The axis as the library has it."""
    if axis is None:
        return _native.Axis()
    if isinstance(axis, Mapping):
        return _native.Axis.of_json(text_of(axis))
    return _native.Axis.read(path_of(axis, "axis"))


def text_of(axis: Mapping[str, Any]) -> str:
    """The keys of a dict as JSON."""
    try:
        return json.dumps(axis, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise argument("axis", f"a value that is none ({error})", "text, numbers, booleans, lists and dicts") from error


def _plain(value: Any) -> Any:
    """Numbers of numpy, and paths."""
    if hasattr(value, "item"):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a {type(value).__name__}")


def path_of(path: Any, place: str) -> str:
    """A path as text."""
    try:
        text = os.fspath(path)
    except TypeError:
        raise argument(place, f"a {type(path).__name__}", "a path") from None
    if not isinstance(text, str) or not text or "\0" in text:
        raise argument(place, repr(text), "a path")
    return text
