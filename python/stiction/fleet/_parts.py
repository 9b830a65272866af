"""The results of a fleet: a data set of numbered tables, each written whole or not at all, by one process at a time."""

from __future__ import annotations

import contextlib
import os
import re
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from .. import _native
from .._errors import StictionError
from ._fetch import Fetched, Unfetched, is_address, store
from ._one import Known, Label

PART = re.compile(r"part-(\d{6,})\.parquet")
LOCK = ".stiction-fleet"
"""A file of the folder that is locked while a call works on it."""


class Kept(NamedTuple):
    """A log that an earlier call has left."""

    known: Known
    """Key and label of its row."""
    error: str | None
    """Code, where it failed."""
    trustworthy: bool | None
    """Whether its law may be used."""
    part: str
    """The table that it is in."""


class Parts:
    """A data set, in a local folder or in a store."""

    def __init__(self, out: str, storage: Mapping[str, Any], retries: int) -> None:
        self.out = out
        self._storage = storage
        self._retries = retries
        self._fs: Any = None
        self._path = out
        if is_address(out):
            self._fs, self._path = store(out, storage)
        else:
            try:
                os.makedirs(out, exist_ok=True)
            except OSError as error:
                raise StictionError("output", out, str(error), "a folder that can be written") from error
        self._next = 1

    @contextlib.contextmanager
    def held(self) -> Iterator[None]:
        """No other call works on a local folder meanwhile. A store has no lock: see to it that one call works there."""
        if self._fs is not None:
            yield
            return
        with open(os.path.join(self.out, LOCK), "w", encoding="utf-8") as lock:
            try:
                import fcntl

                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except ImportError:
                pass
            except OSError as error:
                raise StictionError("output", self.out, "another call is at work in it", "one call at a time") from error
            yield

    def names(self) -> list[str]:
        """The tables, in the order in which they were written."""
        if self._fs is None:
            found = os.listdir(self.out)
        else:
            self._fs.invalidate_cache()
            try:
                found = [name.rsplit("/", 1)[-1] for name in self._fs.ls(self._path, detail=False)]
            except FileNotFoundError:
                found = []
        numbered = [(int(match.group(1)), name) for name in found if (match := PART.fullmatch(name))]
        if numbered:
            self._next = max(number for number, _ in numbered) + 1
        return [name for _, name in sorted(numbered)]

    def known(self) -> dict[str, Kept]:
        """Every log that is there; where a call was killed between its last two steps, as the later table has it."""
        known: dict[str, Kept] = {}
        older: dict[str, set[str]] = {}
        for name in self.names():
            with self._local(name) as table:
                for path, key, error, trustworthy, label in _native.read_rows(str(table)):
                    before = known.get(path)
                    if before is not None:
                        older.setdefault(before.part, set()).add(path)
                    known[path] = Kept(Known(key, Label(*label)), error, trustworthy, name)
        for name, paths in older.items():
            self.without(name, paths)
        return known

    def add(self, rows: list[str]) -> None:
        """Writes the next table."""
        name = f"part-{self._next:06}.parquet"
        self._put(name, lambda table: _native.write_rows(table, rows))
        self._next += 1

    def without(self, name: str, paths: set[str]) -> None:
        """Takes logs out of a table; one that has no other goes."""
        with self._local(name) as table:
            left = len({path for path, *_ in _native.read_rows(str(table))} - paths)
            if left:
                self._put(name, lambda out: _native.keep_rows(str(table), out, paths, {}))
        if not left:
            self._remove(name)

    def relabel(self, name: str, labels: Mapping[str, Label]) -> None:
        """Has the rows of a table say what is known of their logs now."""
        with self._local(name) as table:
            self._put(name, lambda out: _native.keep_rows(str(table), out, set(), dict(labels)))

    def _put(self, name: str, write: Any) -> None:
        if self._fs is None:
            write(os.path.join(self.out, name))
            return
        with tempfile.TemporaryDirectory(prefix="stiction-") as folder:
            table = os.path.join(folder, name)
            write(table)
            # An object appears in a store when all of it is there.
            self._fs.put_file(table, f"{self._path.rstrip('/')}/{name}")

    def _remove(self, name: str) -> None:
        if self._fs is None:
            os.remove(os.path.join(self.out, name))
        else:
            self._fs.rm_file(f"{self._path.rstrip('/')}/{name}")

    @contextlib.contextmanager
    def _local(self, name: str) -> Iterator[Path]:
        if self._fs is None:
            yield Path(self.out) / name
            return
        uri = f"{self.out.rstrip('/')}/{name}"
        with Fetched(self._storage, self._retries) as fetched:
            try:
                copy = fetched.copy(uri)
            except Unfetched as error:
                raise StictionError("output", uri, str(error), "a data set that can be read") from error
            yield copy
