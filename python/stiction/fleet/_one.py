"""One log of a fleet: a pure function from its address to the row that a batch would write."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from .. import _native
from .._axis import path_of, text_of
from .._errors import argument
from .._options import maybe, seconds, truth, whole
from .._types import AxisLike, IdentifyOptions, RowLog
from ._fetch import Fetched, Unfetched, is_address

SCHEMA = "stiction.batch/1"
IN_A_DICT = "dict"
"""What a row calls an axis that is no file."""


class Log(NamedTuple):
    """A log of a fleet, and what is known of it beside its bytes."""

    uri: str
    """Path or address."""
    machine: str | None = None
    """Whose it is; without it the name in the axis file."""
    time: float | None = None
    """When it was recorded, s since 1970 UTC."""
    temperature: float | None = None
    """Temperature of the machine."""
    axis: str | None = None
    """Its axis file, path or address; or the text of one, beginning with a line break."""


class Label(NamedTuple):
    """What a row says of a log beside what its bytes say."""

    machine: str | None
    """Whose it is."""
    time: float | None
    """When it was recorded, s."""
    temperature: float | None
    """Temperature of the machine."""
    axis: str | None
    """Its axis file."""


class Known(NamedTuple):
    """What an earlier call has of a log."""

    key: str
    """Hash of all that its row depends on."""
    label: Label
    """What the row says of it."""


class How(NamedTuple):
    """How every log is identified."""

    options: IdentifyOptions
    """Options of the identification."""
    storage: dict[str, Any]
    """Options of the store that addresses are in."""
    retries: int
    """How often a store that fails is asked again."""
    memory: int | None
    """Bytes that reading a log may take."""


def identify_uri(
    uri: Any,
    axis: AxisLike = None,
    *,
    law: str = "auto",
    asymmetric: bool = False,
    method: str = "separable",
    split: float | None = None,
    seed: int = 0,
    machine: str | None = None,
    time: Any = None,
    temperature: float | None = None,
    storage_options: Mapping[str, Any] | None = None,
    retries: int = 3,
    max_memory: int | None = None,
) -> dict[str, Any]:
    """What `stiction batch` writes of one log: the same names and bits, whatever process or machine it runs in.

    uri: path of a log, or its address in a store that fsspec knows (`s3://bucket/log.parquet`).
    axis: axis file, path or address, or its keys in a dict. law, asymmetric, method, split, seed: as of `identify`.
    machine, time, temperature: what is known of the log, as the columns of a list (docs/fleet.md); time in s since 1970 UTC,
    as ISO 8601 text, or of datetime, numpy or pandas.
    storage_options: of the store of an address, as fsspec takes them. retries: how often a store that fails is asked again.
    max_memory: bytes that reading the log may take; a quarter of the machine's if it is not given.

    Returns the columns of results.parquet that are the same for all parameters of a log, and `parameters`, a list with those
    that are not (`parameter`, `value`, `unit`, `low`, `high`, `std`, `identifiable`, `origin`). `warnings` is a list.
    A log that cannot be read or identified is a row with `error` and `message`, and no exception; those are for arguments.
    """
    how = settings(law, asymmetric, method, split, seed, storage_options, retries, max_memory)
    log = Log(
        text_of_uri(uri, "uri"),
        None if machine is None else str(machine),
        None if time is None else seconds(time, "time"),
        maybe(temperature, "temperature"),
        axis_text(axis),
    )
    with Fetched(how.storage, how.retries) as fetched:
        row = row_of(log, how, None, fetched)
    assert isinstance(row, str)
    found: dict[str, Any] = json.loads(row)
    found["schema"] = SCHEMA
    return found


def settings(
    law: str,
    asymmetric: bool,
    method: str,
    split: float | None,
    seed: int,
    storage_options: Mapping[str, Any] | None,
    retries: int,
    max_memory: int | None,
) -> How:
    """Arguments, checked as far as that can be done before a log is read."""
    for name, value in (("law", law), ("method", method)):
        allowed = _native.choices(name)
        if value not in allowed:
            raise argument(name, repr(value), f"one of {', '.join(allowed)}")
    if storage_options is not None and not isinstance(storage_options, Mapping):
        raise argument("storage_options", f"a {type(storage_options).__name__}", "a dict, as fsspec takes it")
    options: IdentifyOptions = {
        "law": law,
        "asymmetric": truth(asymmetric, "asymmetric"),
        "compare_laws": True,
        "split": maybe(split, "split"),
        "seed": whole(seed, "seed"),
        "method": method,
        "statics": [],
        "model": None,
        "break_away": [],
        "plan": None,
        "search": None,
        "no_finish": False,
        "cost": None,
        "evaluations": None,
        "target": None,
        "time": None,
        "checkpoint": None,
        "resume": None,
    }
    memory = None if max_memory is None else whole(max_memory, "max_memory", 1_000_000)
    return How(options, dict(storage_options or {}), whole(retries, "retries", 0, 20), memory)


def text_of_uri(uri: Any, place: str) -> str:
    """A path or address as text."""
    text = path_of(uri, place)
    return text.removeprefix("file://") if text.startswith("file:///") else text


def axis_text(axis: AxisLike) -> str | None:
    """An axis as text: path or address, or after a line break the file itself."""
    if axis is None:
        return None
    if isinstance(axis, Mapping):
        text = _native.Axis.of_json(text_of(axis)).text
        return f"\n{text}"
    return text_of_uri(axis, "axis")


def row_of(log: Log, how: How, known: Known | None, fetched: Fetched) -> str | Label:
    """The row of a log as JSON; where the one that is known is still its row, what that is to say of the log now."""
    given = given_of(log)
    place = log.uri
    try:
        if log.axis is not None and log.axis.startswith("\n"):
            given["axis_file"] = str(fetched.write(log.axis, "axis.toml"))
        elif log.axis is not None and is_address(log.axis):
            place = log.axis
            given["axis_file"] = str(fetched.once(log.axis))
        place = log.uri
        if is_address(log.uri):
            copy = fetched.copy(log.uri)
            given["file"] = str(copy)
    except Unfetched as error:
        row = _native.unread_row(given, how.options, "log-io", f"{place}: {error}")
        return unless_known(row, known)
    try:
        row = _native.identify_row(given, how.options, None if known is None else known.key, how.memory)
    finally:
        if given["file"] != log.uri:
            Path(given["file"]).unlink(missing_ok=True)
    # One that still cannot be read has been identified in vain.
    return unless_known(row, known)


def unless_known(row: str, known: Known | None) -> str | Label:
    """A row; only what it says of the log where it has the key that is known."""
    if known is None:
        return row
    found = json.loads(row)
    if found["key"] != known.key:
        return row
    temperature = found["temperature"]
    # Without one that is given it is the mean of the log's own, as before.
    return Label(found["machine"], found["time"], known.label.temperature if temperature is None else temperature, found["axis"])


def lost_row(log: Log, how: How, message: str) -> str:
    """The row of a log of which nothing came back."""
    return _native.unread_row(given_of(log), how.options, "internal", f"{log.uri}: {message}")


def given_of(log: Log) -> RowLog:
    """As Rust takes it: with what rows call files, before any of them is fetched."""
    in_a_dict = log.axis is not None and log.axis.startswith("\n")
    return {
        "file": log.uri,
        "path": log.uri if is_address(log.uri) else None,
        "machine": log.machine,
        "time": log.time,
        "temperature": log.temperature,
        "axis_file": None if in_a_dict else log.axis,
        "axis": IN_A_DICT if in_a_dict else log.axis if log.axis and is_address(log.axis) else None,
    }
