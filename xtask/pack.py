"""Packs folders, and sums files: the same files and time give the same bytes, on every system.

pack.py FOLDER TIME    FOLDER.tar.gz beside it, of Windows programs FOLDER.zip; TIME in seconds since 1970
pack.py --sums FOLDER  SHA256SUMS of the files in it
"""

from __future__ import annotations

import gzip
import hashlib
import sys
import tarfile
import time
import zipfile
from pathlib import Path


def pack(folder: Path, seconds: int) -> Path:
    """Writes the archive in the order of names, with that time and nobody's name, and returns its path."""
    files = sorted((path for path in folder.rglob("*") if path.is_file()), key=lambda path: path.as_posix())
    names = [path.relative_to(folder.parent).as_posix() for path in files]
    modes = [0o755 if path.parent.name == "bin" else 0o644 for path in files]
    if "-windows-" in folder.name:
        out = folder.parent / f"{folder.name}.zip"
        date = time.gmtime(seconds)[:6]
        with zipfile.ZipFile(out, "w") as archive:
            for path, name, mode in zip(files, names, modes):
                about = zipfile.ZipInfo(name, date)
                about.create_system, about.external_attr = 3, mode << 16
                archive.writestr(about, path.read_bytes(), zipfile.ZIP_DEFLATED, 9)
        return out
    out = folder.parent / f"{folder.name}.tar.gz"
    with (
        out.open("wb") as raw,
        gzip.GzipFile("", "wb", 9, raw, mtime=0) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.USTAR_FORMAT) as archive,
    ):
        for path, name, mode in zip(files, names, modes):
            about = tarfile.TarInfo(name)
            about.size, about.mode, about.mtime = path.stat().st_size, mode, seconds
            with path.open("rb") as content:
                archive.addfile(about, content)
    return out


def sums(folder: Path) -> Path:
    """Writes the sums as `sha256sum` does and returns their path."""
    out = folder / "SHA256SUMS"
    files = sorted(path for path in folder.iterdir() if path.is_file() and not path.name.startswith("SHA256SUMS"))
    lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files]
    out.write_text("".join(lines), newline="\n")
    return out


if __name__ == "__main__":
    if sys.argv[1] == "--sums":
        print(sums(Path(sys.argv[2])))
    else:
        print(pack(Path(sys.argv[1]), int(sys.argv[2])))
