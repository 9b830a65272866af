"""The package itself: what it loads, how large it is, what it says of itself."""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
import stiction

LARGEST = 8_000_000
"""Of a wheel, bytes."""


def run(line: str) -> str:
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_importing_loads_neither_numpy_nor_what_is_optional() -> None:
    """What takes long is loaded where it is used: of its own, stiction has 17 small modules and one library; the fleet is not of them."""
    line = "import sys; before = set(sys.modules); import stiction; print(*sorted(set(sys.modules) - before))"
    loaded = run(line).split()
    heavy = {"numpy", "pandas", "polars", "pyarrow", "matplotlib", "distributed", "fsspec", "asyncio", "unittest", "http", "ssl"}
    assert not heavy & {name.split(".")[0] for name in loaded}
    assert sum(name.startswith("stiction") for name in loaded) <= 18
    assert len(loaded) < 80, loaded


def test_importing_is_a_small_part_of_importing_numpy() -> None:
    """As a ratio, the least of several on each side: 60 ms where numpy takes 100."""
    def least(module: str) -> float:
        line = f"import time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
        return min(float(run(line)) for _ in range(5))

    assert least("stiction") < least("numpy")


def test_the_version_is_that_of_the_library() -> None:
    assert stiction.__version__ == metadata.version("stiction")
    assert [line for line in metadata.requires("stiction") or [] if "extra" not in line] == ["numpy>=1.23"]


def test_everything_public_is_described() -> None:
    for name in stiction.__all__:
        thing = getattr(stiction, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            assert thing.__doc__, name
        if inspect.isclass(thing):
            for method, value in vars(thing).items():
                if not method.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert value.__doc__ or getattr(value, "fget", None).__doc__, f"{name}.{method}"


def test_the_wheel_is_small() -> None:
    wheel = os.environ.get("STICTION_WHEEL")
    if not wheel:
        pytest.skip("set STICTION_WHEEL to the wheel of a release")
    assert Path(wheel).stat().st_size <= LARGEST


def test_types_come_with_the_package() -> None:
    folder = Path(stiction.__file__).parent
    assert (folder / "py.typed").exists()
    assert (folder / "_native.pyi").exists()
