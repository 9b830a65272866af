"""A fleet on Dask: logs to workers in batches, rows back, tables in the order of the logs."""

from __future__ import annotations

import json
import time as clock
from collections import Counter
from collections.abc import Mapping
from typing import Any, NamedTuple

from .._errors import StictionError, argument
from .._options import whole
from .._progress import Told, finish, teller
from .._types import AxisLike, Watcher
from ._logs import logs_of
from ._one import How, Label, Log, lost_row, settings, text_of_uri
from ._parts import Kept, Parts
from ._work import Row, Task, identify_batch

ASKED = 0.5
"""Time that a batch is to take, s: far more than Dask needs for a task, far less than a worker's life."""
LARGEST = 512
"""Most logs of a batch: what a worker that is killed begins anew."""
AHEAD = 3
"""Batches for each thread that are with the scheduler, so that no worker waits."""
MOST_LOST = 5
"""How often Dask may give up a batch, each time after several workers that ended."""


class Summary(NamedTuple):
    """What became of the logs of a call."""

    logs: int
    """How many there are."""
    identified: int
    """Of these, identified."""
    trustworthy: int
    """Of the identified, trustworthy."""
    taken: int
    """Of all, with the same bytes, axis, options and version in the data set already."""
    failed: dict[str, int]
    """Of the others, how many failed with which code."""
    complete: bool
    """Whether all were looked at, and none is missing since the work was stopped."""


def run(
    logs: Any,
    out: Any,
    axis: AxisLike = None,
    *,
    client: Any = None,
    law: str = "auto",
    asymmetric: bool = False,
    method: str = "separable",
    split: float | None = None,
    seed: int = 0,
    storage_options: Mapping[str, Any] | None = None,
    part_logs: int = 500,
    retries: int = 3,
    max_memory: int | None = None,
    progress: Watcher = None,
) -> Summary:
    """Identifies many logs on a Dask cluster, each as `stiction batch` does, into a data set that `stiction drift` reads.

    logs: a folder, a pattern, a list.csv, or a list of these, of paths and addresses, and of dicts with `path` and where they are
        known `machine`, `time` (s since 1970 UTC, ISO 8601 text, or of datetime, numpy or pandas), `temperature`, `axis`; each log
        once. Addresses are those of fsspec, as `s3://bucket/2026-03/`.
    out: folder or address of the data set: `part-000001.parquet` and so on, as results.parquet. What it holds already with the
        same bytes, axis, options and version is not identified again; rows of logs that have changed are replaced. What rows say
        of machine, time and temperature is what this call says.
    axis: axis file of the logs that have none of their own, as path or address that the workers can read, or its keys in a dict.
    client: of dask.distributed; the current one if it is not given. law, asymmetric, method, split, seed: as of `identify`.
    storage_options: of the store that addresses are in. part_logs: logs of a table. retries: how often a store that fails is
        asked again. max_memory: bytes that reading a log may take; half of the worker's for a thread if it is not given.
    progress: True for a line on standard error, or a function of a `Progress`; where it returns False the work stops.

    What is wrong with a log is its row, also where it ends the process that reads it. Workers may end at any time. Tables appear
    whole, in the order of the logs, so that the same logs give the same bytes. Ctrl-C keeps what is done.
    """
    how = settings(law, asymmetric, method, split, seed, storage_options, retries, max_memory)
    most = whole(part_logs, "part_logs", 1, 1_000_000)
    place = text_of_uri(out, "out")
    tell = teller(progress)
    cluster = _Cluster(client)
    listed = logs_of(logs, axis, place, how.storage)
    parts = Parts(place, how.storage, how.retries)
    try:
        with parts.held():
            work = _Work(listed, how, parts, parts.known(), most)
            stopped = cluster.spread(work, tell)
            return work.end(stopped)
    finally:
        finish(progress)


class _Work:
    """The logs, and what is known of them so far."""

    def __init__(self, logs: list[Log], how: How, parts: Parts, known: dict[str, Kept], most: int) -> None:
        self.logs = logs
        self.how = how
        self._parts = parts
        self._known = known
        self._most = most
        self._found: dict[int, Row] = {}
        self._written = 0
        self._rows: list[str] = []
        self._older: dict[str, set[str]] = {}
        self._labels: dict[str, dict[str, Label]] = {}
        self._taken = 0
        self._counts: Counter[str] = Counter()
        self.done = 0

    def task(self, place: int) -> Task:
        """A log for a worker."""
        log = self.logs[place]
        kept = self._known.get(log.uri)
        return log, None if kept is None else kept.known

    def take(self, place: int, row: Row) -> None:
        """What was found of a log. Tables are written as soon as all logs before are known."""
        self._found[place] = row
        self.done += 1
        while self._written in self._found:
            self._append(self.logs[self._written], self._found.pop(self._written))
            self._written += 1

    def _append(self, log: Log, row: Row) -> None:
        kept = self._known.get(log.uri)
        if isinstance(row, Label):
            assert kept is not None
            if row != kept.known.label:
                self._labels.setdefault(kept.part, {})[log.uri] = row
            self._taken += 1
            self._count(kept.error, kept.trustworthy)
            return
        found = json.loads(row)
        self._count(found["error"], found["trustworthy"])
        if kept is not None:
            self._older.setdefault(kept.part, set()).add(log.uri)
        self._rows.append(row)
        if len(self._rows) >= self._most:
            self._flush()

    def _count(self, error: str | None, trustworthy: bool | None) -> None:
        self._counts[error or ("trustworthy" if trustworthy else "doubtful")] += 1

    def _flush(self) -> None:
        if self._rows:
            self._parts.add(self._rows)
            self._rows = []
        # After the table with the rows of today: a log is twice there for a moment, and never missing.
        for part, paths in self._older.items():
            self._parts.without(part, paths)
        self._older = {}

    def end(self, stopped: bool) -> Summary:
        """Writes what is left."""
        self._flush()
        for part, labels in self._labels.items():
            self._parts.relabel(part, labels)
        self._labels = {}
        identified = self._counts["trustworthy"] + self._counts["doubtful"]
        own = ("trustworthy", "doubtful")
        failed = {code: count for code, count in self._counts.most_common() if code not in own}
        complete = not stopped or self._written == len(self.logs)
        return Summary(self._written, identified, self._counts["trustworthy"], self._taken, failed, complete)


class _Cluster:
    """Workers of Dask, which may come and go."""

    _client: Any

    def __init__(self, client: Any) -> None:
        try:
            import distributed
        except ImportError as error:
            found = "dask.distributed is not installed"
            raise StictionError("usage", "client", found, "pip install stiction[fleet]") from error
        self._dask = distributed
        if client is None:
            try:
                client = distributed.get_client()
            except ValueError:
                allowed = "a Client of dask.distributed: Client() for this machine"
                raise argument("client", "none, and there is no current one", allowed) from None
        if not isinstance(client, distributed.Client) or client.asynchronous:
            raise argument("client", repr(client), "a Client of dask.distributed that is not asynchronous")
        self._client = client
        self._threads = 1
        self._lost: Counter[int] = Counter()
        self._looked = float("-inf")

    def spread(self, work: _Work, tell: Told | None) -> bool:
        """Has the workers do it; whether it was stopped."""
        waiting = iter(range(len(work.logs)))
        self._of: dict[Any, list[int]] = {}
        self._queue = self._dask.as_completed([], raise_errors=False)
        seconds = None
        try:
            self._fill(work, waiting, ASKED)
            while self._of:
                future = next(self._queue)
                places = self._of.pop(future)
                found = self._found(future)
                if found is not None:
                    rows, took = found
                    each = took / len(places)
                    # Slowly, so that one long log does not make the next batches small.
                    seconds = each if seconds is None else seconds + 0.3 * (each - seconds)
                    for place, row in zip(places, rows):
                        work.take(place, row)
                else:
                    self._again(work, places)
                future.release()
                if tell is not None and tell("identifying", work.done / len(work.logs), None) is False:
                    return True
                self._fill(work, waiting, seconds or ASKED)
            return False
        except BaseException:
            # What is done is kept.
            work.end(True)
            raise
        finally:
            if self._of:
                self._client.cancel(list(self._of), force=True)

    def _fill(self, work: _Work, waiting: Any, seconds: float) -> None:
        """Gives out batches until the workers have enough."""
        now = clock.monotonic()
        if now - self._looked > 5.0:
            self._looked = now
            threads: dict[str, int] = self._client.nthreads()
            self._threads = max(sum(threads.values()), 1)
        size = min(max(round(ASKED / max(seconds, 1e-6)), 1), LARGEST)
        while len(self._of) < AHEAD * self._threads + 1:
            batch: list[int] = []
            for place in waiting:
                batch.append(place)
                if len(batch) == size:
                    break
            if not batch:
                return
            self._submit(work, batch)

    def _submit(self, work: _Work, places: list[int]) -> None:
        tasks = [work.task(place) for place in places]
        # Not pure for Dask, so that a batch that is given out again is not the one that was lost.
        future = self._client.submit(identify_batch, tasks, work.how, pure=False)
        self._of[future] = places
        self._queue.add(future)

    def _found(self, future: Any) -> tuple[list[Row], float] | None:
        """What a batch has found; None where Dask gave it up after several workers, also while what it found was fetched."""
        try:
            found: tuple[list[Row], float] = future.result()
            return found
        except self._dask.KilledWorker:
            return None

    def _again(self, work: _Work, places: list[int]) -> None:
        """A batch of which nothing came back: it is given out again. That workers end is not the doing of its logs."""
        self._lost.update(places)
        lasting = [place for place in places if self._lost[place] < MOST_LOST]
        for place in set(places) - set(lasting):
            row = lost_row(work.logs[place], work.how, f"the workers that were to identify it ended, {MOST_LOST} times")
            work.take(place, row)
        if lasting:
            self._submit(work, lasting)
