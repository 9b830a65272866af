"""Files that lie elsewhere, for as long as they are read."""

from __future__ import annotations

import re
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .._errors import StictionError

ADDRESS = re.compile(r"[A-Za-z0-9+.:-]+://")
"""How an address begins, as Rust has it too."""
FIRST_WAIT = 0.2
"""Before a store is asked again, s; twice as long each time."""


class Unfetched(Exception):
    """A file that could not be fetched: why, in words."""


def is_address(uri: str) -> bool:
    """Whether this is an address, and not a path."""
    return ADDRESS.match(uri) is not None


def store(uri: str, options: Mapping[str, Any]) -> tuple[Any, str]:
    """The store of an address, and the path in it."""
    try:
        import fsspec
    except ImportError as error:
        raise StictionError("usage", uri, "an address, and fsspec is not installed", "pip install stiction[fleet]") from error
    try:
        found: tuple[Any, str] = fsspec.core.url_to_fs(uri, **options)
    except ImportError as error:
        allowed = "install it here and on the workers: stiction[s3] for s3://"
        raise StictionError("usage", uri, f"an address whose store needs a package that is missing ({error})", allowed) from error
    except ValueError as error:
        raise StictionError("usage", uri, str(error), "an address of a store that fsspec knows, as s3://bucket/log.csv") from error
    return found


class Fetched:
    """A folder of copies, which is taken away at the end. An axis file is fetched once."""

    def __init__(self, options: Mapping[str, Any], retries: int) -> None:
        self._options = options
        self._retries = retries
        self._folder = tempfile.TemporaryDirectory(prefix="stiction-", dir=_place())
        self._kept: dict[str, Path] = {}
        self._count = 0

    def __enter__(self) -> Fetched:
        return self

    def __exit__(self, *_: object) -> None:
        self._folder.cleanup()

    def once(self, uri: str) -> Path:
        """The copy of a file that several logs need."""
        if uri not in self._kept:
            self._kept[uri] = self.copy(uri)
        return self._kept[uri]

    def write(self, text: str, name: str) -> Path:
        """A file with this text, written once."""
        if text not in self._kept:
            path = self._next() / name
            path.write_text(text, encoding="utf-8")
            self._kept[text] = path
        return self._kept[text]

    def _next(self) -> Path:
        """A folder for one file, which keeps its name."""
        folder = Path(self._folder.name) / str(self._count)
        self._count += 1
        folder.mkdir()
        return folder

    def copy(self, uri: str) -> Path:
        """A copy under the name that the file has there, since names tell formats."""
        fs, path = store(uri, self._options)
        target = self._next() / _name(path)
        for left in range(self._retries, -1, -1):
            try:
                _get(fs, path, target)
                return target
            except FileNotFoundError:
                raise Unfetched("is not there; a log that is there") from None
            except (PermissionError, IsADirectoryError) as error:
                raise Unfetched(f"cannot be read ({_said(error)}); a log that these credentials may read") from error
            except (Unfetched, ImportError):
                raise
            except Exception as error:  # noqa: BLE001: each store has exceptions of its own
                if left == 0:
                    raise Unfetched(f"cannot be read ({_said(error)}), {self._retries + 1} times") from error
                time.sleep(FIRST_WAIT * 2 ** (self._retries - left))
        raise AssertionError("unreachable")


def _get(fs: Any, path: str, target: Path) -> None:
    fs.invalidate_cache()
    before = fs.info(path)
    if before.get("type") == "directory":
        raise IsADirectoryError("a folder")
    fs.get_file(path, str(target))
    # What a store gives at once is one state of the object; others are asked again.
    after = before if before.get("ETag") else _again(fs, path)
    size = before.get("size")
    changed = size is not None and target.stat().st_size != size
    if changed or any(before.get(key) != after.get(key) for key in ("size", "mtime", "modified", "LastModified")):
        raise Unfetched("the file changed while it was read; a recording that is closed, or a copy of it")


def _again(fs: Any, path: str) -> Any:
    fs.invalidate_cache()
    return fs.info(path)


def _name(path: str) -> str:
    name = path.rstrip("/").rsplit("/", 1)[-1].replace("\0", "")
    # Longer names than a file system takes keep their end, which tells the format.
    return name[-100:] if name not in ("", ".", "..") else "log"


def _said(error: BaseException) -> str:
    """What an exception says, in one line."""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said}" if said else type(error).__name__


def _place() -> str | None:
    """Where copies go: on a worker into its own folder, which Dask takes away also after a kill."""
    import sys

    distributed = sys.modules.get("distributed")
    if distributed is None:
        return None
    try:
        place: str = distributed.get_worker().local_directory
        return place
    except (ValueError, AttributeError):
        return None
