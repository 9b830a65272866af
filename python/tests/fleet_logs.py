"""Logs of a fleet for the tests: small good ones, and every kind of bad one."""

from __future__ import annotations

import os
from pathlib import Path

import numpy

AXIS = 'name = "Z"\nkind = "linear"\n'


def text(coulomb: float, samples: int = 500) -> str:
    """A log of an axis of 9 kg with that Coulomb and 60 N s/m of viscous friction, with some noise."""
    t = 1e-3 * numpy.arange(samples)
    x, v = 0.05 * numpy.sin(6.0 * t), 0.3 * numpy.cos(6.0 * t)
    noise = numpy.random.default_rng(int(coulomb)).normal(0.0, 0.1, samples)
    force = coulomb * numpy.tanh(v / 0.002) + 60.0 * v - 324.0 * x + noise
    rows = (f"{a:.3f},{1e3 * b:.6f},{c:.4f}\n" for a, b, c in zip(t, x, force))
    return "Time [s],Position [mm],Force [N]\n" + "".join(rows)


def good(folder: Path, count: int, samples: int = 500) -> list[Path]:
    """So many logs."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"run{k:03}.csv" for k in range(count)]
    for k, path in enumerate(paths):
        path.write_text(text(20.0 + k, samples))
    return paths


def bad(folder: Path) -> list[Path]:
    """Empty, foreign, cut, and not there."""
    (folder / "empty.csv").write_bytes(b"")
    (folder / "foreign.txt").write_text("see the other folder\n")
    (folder / "cut.parquet").write_bytes(b"PAR1\0\0\0PAR1")
    os.symlink("nowhere", folder / "vanished.csv")
    return [folder / name for name in ("cut.parquet", "empty.csv", "foreign.txt", "vanished.csv")]


STORE = '''
import os, signal, fsspec, shutil

class Odd(fsspec.AbstractFileSystem):
    """Files of a folder; what it does with one is in its name."""
    protocol = "odd"
    cachable = False

    def info(self, path, **_):
        path = self._strip_protocol(path)
        if "vanished" in path:
            raise FileNotFoundError(path)
        about = os.stat(path)
        return {"name": path, "size": about.st_size, "type": "file", "mtime": about.st_mtime_ns}

    def get_file(self, rpath, lpath, **_):
        path = self._strip_protocol(rpath)
        if "deadly" in path:
            os.kill(os.getpid(), signal.SIGKILL)
        if "broken" in path:
            raise ConnectionError("no route to the store")
        shutil.copyfile(path, lpath)
        if "growing" in path:
            with open(path, "a") as more:
                more.write("9.0,1.0,1.0\\n")
'''


def odd_store(folder: Path) -> Path:
    """A package with a store for fsspec, `odd://`, in which logs grow, break, vanish and kill: a folder for PYTHONPATH."""
    about = folder / "odd_store-1.dist-info"
    about.mkdir(parents=True)
    (folder / "odd_store.py").write_text(STORE)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: odd-store\nVersion: 1\n")
    (about / "entry_points.txt").write_text("[fsspec.specs]\nodd = odd_store:Odd\n")
    return folder
