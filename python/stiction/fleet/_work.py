"""What a worker does: it hands logs to a process of its own, so that one that ends the process leaves the worker alone."""

from __future__ import annotations

import os
import pickle
import struct
import subprocess
import sys
import threading
import time
from typing import IO, Any, Union

from .._errors import StictionError
from ._fetch import Fetched
from ._one import How, Known, Label, Log, lost_row, row_of, unless_known

DEATHS = 3
"""How often a process may die of a log before the log has a row that says so."""
CHILD = "from stiction.fleet._work import serve; serve()"
Task = tuple[Log, "Known | None"]
"""A log, and what is known of it already."""
Row = Union[str, Label]
"""A row as JSON; where the one that is known is still the row of the log, what that is to say of it now."""
LENGTH = struct.Struct("<Q")


def identify_batch(tasks: list[Task], how: How) -> tuple[list[Row], float]:
    """The rows of some logs, in their order, and the time that took, s."""
    start = time.perf_counter()
    how = how._replace(memory=how.memory or _share())
    rows = [_row(log, how, known) for log, known in tasks]
    return rows, time.perf_counter() - start


class _Ended(Exception):
    """The process ended; how."""


class _Child:
    """A process that identifies one log after the other, for one thread of a worker. It ends with the worker."""

    def __init__(self) -> None:
        paths = os.pathsep.join(path for path in sys.path if path)
        words = [sys.executable, "-c", CHILD]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(words, stdin=pipe, stdout=pipe, env=dict(os.environ, PYTHONPATH=paths))

    def ask(self, question: Any) -> Any:
        """Its answer."""
        assert self._process.stdin is not None and self._process.stdout is not None
        try:
            _put(self._process.stdin, question)
            return _get(self._process.stdout)
        except (OSError, EOFError):
            raise _Ended(_ended(self._process.wait())) from None

    def end(self) -> None:
        """Ends it, whatever it is doing."""
        self._process.kill()
        self._process.communicate()


_OF_THREAD = threading.local()


def _row(log: Log, how: How, known: Known | None) -> Row:
    said = ""
    for _ in range(DEATHS):
        child: _Child | None = getattr(_OF_THREAD, "child", None)
        if child is None:
            child = _OF_THREAD.child = _Child()
        try:
            answer = child.ask((log, known, how))
        except _Ended as ended:
            said = str(ended)
            _OF_THREAD.child = None
            continue
        except BaseException:
            # Its answer would be taken for that of the next log.
            child.end()
            _OF_THREAD.child = None
            raise
        if isinstance(answer, BaseException):
            raise answer
        row: Row = answer
        return row
    lost = lost_row(log, how, f"the process that identified it was ended {DEATHS} times ({said})")
    return unless_known(lost, known)


def serve() -> None:
    """The process of a thread: asked on standard input, answers on standard output."""
    answers = os.fdopen(os.dup(1), "wb")
    # What a library prints must not be in them.
    os.dup2(2, 1)
    while True:
        try:
            log, known, how = _get(sys.stdin.buffer)
        except EOFError:
            return
        try:
            _put(answers, _tried(log, known, how))
        except BrokenPipeError:
            # The worker was ended.
            os._exit(1)


def _tried(log: Log, known: Known | None, how: How) -> Row | BaseException:
    """A row whatever happens, but for a package that is missing here and for arguments, which are the same for all logs."""
    try:
        with Fetched(how.storage, how.retries) as fetched:
            return row_of(log, how, known, fetched)
    except (ImportError, StictionError) as error:
        return error
    except Exception as error:  # noqa: BLE001: no log ends the run
        return lost_row(log, how, f"stiction itself failed on this log ({type(error).__name__}: {error})")


def _put(pipe: IO[bytes], thing: Any) -> None:
    content = pickle.dumps(thing)
    pipe.write(LENGTH.pack(len(content)) + content)
    pipe.flush()


def _get(pipe: IO[bytes]) -> Any:
    (length,) = LENGTH.unpack(_exactly(pipe, LENGTH.size))
    return pickle.loads(_exactly(pipe, length))


def _exactly(pipe: IO[bytes], length: int) -> bytes:
    content = pipe.read(length)
    if len(content) < length:
        raise EOFError
    return content


def _ended(status: int) -> str:
    """How a process ended."""
    if status >= 0:
        return f"exit code {status}"
    import signal

    try:
        return signal.Signals(-status).name
    except ValueError:
        return f"signal {-status}"


def _share() -> int | None:
    """Bytes that a log may take on this worker: half of what it has for a thread, since what reads it needs some as well."""
    distributed: Any = sys.modules.get("distributed")
    if distributed is None:
        return None
    try:
        worker = distributed.get_worker()
        limit = worker.memory_manager.memory_limit
        return int(limit / worker.state.nthreads / 2) if limit else None
    except (ValueError, AttributeError):
        return None
