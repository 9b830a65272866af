"""Which logs a fleet has: local ones as `stiction batch` finds them, and those of stores by the same rules."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from .. import _native
from .._columns import is_missing
from .._errors import argument
from .._options import maybe, seconds
from .._types import AxisLike
from ._fetch import Fetched, Unfetched, is_address, store
from ._one import Log, axis_text, text_of_uri

KEYS = ("path", "machine", "time", "temperature", "axis")
"""Of a log in a dict, as the columns of a list."""
LISTS = (".csv", ".tsv", ".txt")
"""Ends of addresses of lists."""
MOST_OF_A_LIST = 1 << 30
"""Bytes of a list in a store that are fetched to look at it."""


def logs_of(logs: Any, axis: AxisLike, out: str, storage: Mapping[str, Any]) -> list[Log]:
    """The logs, each once, in their order."""
    common = axis_text(axis)
    if isinstance(logs, (str, os.PathLike)):
        found = _of_one(text_of_uri(logs, "logs"), _local(common), out, storage)
    elif isinstance(logs, Iterable) and not isinstance(logs, Mapping):
        found = _of_several(logs, _local(common), out, storage)
    else:
        raise argument("logs", f"a {type(logs).__name__}", "a folder, a pattern, a list.csv, or a list of logs")
    once: dict[str, Log] = {}
    for log in found:
        once.setdefault(log.uri, log if log.axis is not None else log._replace(axis=common))
    if not once:
        raise argument("logs", "no log", "at least one log")
    return list(once.values())


def _of_several(logs: Iterable[Any], axis: str | None, out: str, storage: Mapping[str, Any]) -> Iterator[Log]:
    """Paths, addresses and dicts, one after the other."""
    given: dict[str, int] = {}
    for k, each in enumerate(logs):
        place = f"logs[{k}]"
        if isinstance(each, Mapping):
            log = _of_dict(each, place)
            before = given.setdefault(log.uri, k)
            if before != k:
                raise argument(f"{place}['path']", f"{log.uri!r}, which logs[{before}] is already", "each log once")
            yield log
            continue
        text = text_of_uri(each, place)
        if _names_several(text) or (not is_address(text) and os.path.isdir(text)):
            yield from _of_one(text, axis, out, storage)
        else:
            # A log that is not there, or no longer, has a row that says so.
            yield Log(text)


def _local(axis: str | None) -> str | None:
    """An axis file that can be read here."""
    return None if axis is None or axis.startswith("\n") or is_address(axis) else axis


def _names_several(text: str) -> bool:
    if not is_address(text):
        return any(c in text for c in "*?[") and not os.path.lexists(text)
    return text.endswith("/") or any(c in text for c in "*?[")


def _of_dict(given: Mapping[str, Any], place: str) -> Log:
    unknown = [key for key in given if key not in KEYS]
    if unknown or "path" not in given:
        raise argument(place, f"the keys {', '.join(map(str, given))}", f"path, and where they are known {', '.join(KEYS[1:])}")
    known = {key: None if is_missing(value) else value for key, value in given.items()}
    machine, time = known.get("machine"), known.get("time")
    return Log(
        text_of_uri(known["path"], f"{place}['path']"),
        None if machine is None else str(machine),
        None if time is None else seconds(time, f"{place}['time']"),
        _number(known.get("temperature"), f"{place}['temperature']"),
        axis_text(known.get("axis")),
    )


def _number(value: Any, place: str) -> float | None:
    number = maybe(value, place)
    if number is not None and abs(number) == float("inf"):
        raise argument(place, repr(value), "a finite number")
    return number


def _of_one(text: str, axis: str | None, out: str, storage: Mapping[str, Any]) -> Iterator[Log]:
    """The logs of a folder, a pattern, a list, or a log; what the axis file joins to a log is none."""
    if not is_address(text):
        # Where results are local they are no logs.
        own = "" if is_address(out) else out
        for file, machine, time, temperature, listed in _native.find_logs([text], axis, own or os.devnull):
            yield Log(str(file), machine, time, temperature, None if listed is None else str(listed))
        return
    fs, path = store(text, storage)
    fs.invalidate_cache()
    if any(c in path for c in "*?["):
        names = fs.glob(path)
    elif text.endswith("/") or fs.isdir(path):
        names = fs.find(path)
    else:
        yield from _of_file(text, fs, path, storage)
        return
    inside = None if not is_address(out) else out.rstrip("/") + "/"
    for name in sorted(names):
        uri = str(fs.unstrip_protocol(name))
        below = name[len(path) :] if name.startswith(path) else name
        hidden = any(part.startswith(".") for part in below.split("/"))
        if hidden or name.lower().endswith(".toml") or name.endswith("/") or (inside and uri.startswith(inside)):
            continue
        yield Log(uri)


def _of_file(text: str, fs: Any, path: str, storage: Mapping[str, Any]) -> Iterator[Log]:
    """A log, or the logs of a list, whose paths are from its place on."""
    if not text.lower().endswith(LISTS) or not fs.exists(path) or fs.size(path) > MOST_OF_A_LIST:
        yield Log(text)
        return
    with Fetched(storage, 3) as fetched:
        try:
            copy = fetched.copy(text)
        except Unfetched as error:
            raise argument("logs", f"{text}: {error}", "a list or a log that can be read") from error
        found = _native.find_logs([str(copy)], None, os.devnull)
    if [each for each, *_ in found] == [copy]:
        yield Log(text)
        return
    here = str(copy.parent) + os.sep
    scheme, place = text.rsplit("/", 1)[0].split("://", 1)

    def there(local: Path | None) -> str | None:
        if local is None or not str(local).startswith(here):
            return None if local is None else str(local)
        # Stores know no "..".
        return f"{scheme}://{posixpath.normpath(f'{place}/{str(local)[len(here) :]}')}"

    for local, machine, time, temperature, axis in found:
        yield Log(there(local) or "", machine, time, temperature, there(axis))
