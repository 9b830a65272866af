"""What is known of an axis: a file, or the same keys in a dict."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping
from typing import Any

from . import _native
from ._errors import argument, kind_of
from ._types import AxisLike


AXIS = "the path of an axis file, or a dict with its keys"
"""What an axis may be."""


def axis_of(axis: AxisLike) -> _native.Axis:
    """The axis as the library has it."""
    if axis is None:
        return _native.Axis()
    if isinstance(axis, Mapping):
        return _native.Axis.of_json(text_of(axis))
    return _native.Axis.read(path_of(axis, "axis", AXIS))


def text_of(axis: Mapping[str, Any]) -> str:
    """The keys of a dict as JSON."""
    return json.dumps(_plain(axis, "axis"))


def _plain(value: Any, place: str) -> Any:
    """A value that an axis file may have; numbers and arrays of numpy and paths as what they stand for."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each, f"{place}[{key!r}]") for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each, f"{place}[{k}]") for k, each in enumerate(value)]
    if hasattr(value, "tolist"):
        return _plain(value.tolist(), place)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if value is None:
        raise argument(place, "None", "a value; leave out what is not known")
    if not isinstance(value, (str, bool, int, float)):
        raise argument(place, kind_of(value), "text, numbers, booleans, lists and dicts")
    if isinstance(value, float) and not math.isfinite(value):
        raise argument(place, repr(value), "a finite number")
    return value


def path_of(path: Any, place: str, allowed: str = "a path") -> str:
    """A path as text."""
    try:
        text = os.fspath(path)
    except TypeError:
        raise argument(place, kind_of(path), allowed) from None
    if not isinstance(text, str) or not text or "\0" in text:
        raise argument(place, repr(text), allowed)
    return text


def some_path(path: Any, place: str) -> str | None:
    """A path as text, or none."""
    return None if path is None else path_of(path, place)


def paths_of(paths: Any, place: str) -> list[str]:
    """Paths as text; one alone is a list of one."""
    if isinstance(paths, (str, os.PathLike)) or not isinstance(paths, Iterable):
        return [path_of(paths, place, "a path, or a list of paths")]
    return [path_of(path, place) for path in paths]
