"""The package itself: what it loads, how large it is, what it says of itself."""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from typing import Any, get_args

import pytest
import stiction
from stiction import _native

LARGEST = 8_000_000
"""Of a wheel, bytes."""


def run(line: str) -> str:
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_importing_loads_neither_numpy_nor_what_is_optional() -> None:
    """What takes long is loaded where it is used: of its own, stiction has 25 small modules and one library; the fleet is not of them."""
    line = "import sys; before = set(sys.modules); import stiction; print(*sorted(set(sys.modules) - before))"
    loaded = run(line).split()
    heavy = {"numpy", "pandas", "polars", "pyarrow", "matplotlib", "distributed", "fsspec", "asyncio", "unittest", "http", "ssl"}
    assert not heavy & {name.split(".")[0] for name in loaded}
    assert sum(name.startswith("stiction") for name in loaded) <= 26
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


def names(alias: Any) -> set[str]:
    """The names of a Literal, or of a union of them."""
    return {name for part in get_args(alias) for name in ([part] if isinstance(part, str) else names(part))}


@pytest.mark.parametrize(
    ("alias", "kind"),
    [
        (stiction.LawName, "law"),
        (stiction.PlannedLawName, "planned_law"),
        (stiction.MethodName, "method"),
        (stiction.SearchName, "search"),
        (stiction.CostName, "cost"),
        (stiction.TargetName, "target"),
        (stiction.FeedforwardName, "feedforward"),
        (stiction.WidthName, "width"),
        (stiction.StageName, "stage"),
        (stiction.FormatName, "formats"),
    ],
)
def test_the_names_of_a_type_are_those_of_the_library(alias: Any, kind: str) -> None:
    assert names(alias) == set(_native.choices(kind))
    assert len(_native.choices(kind)) > 1


@pytest.mark.parametrize("name", [name for name in stiction.__all__ if inspect.isfunction(getattr(stiction, name))])
def test_a_function_has_ten_arguments_at_most(name: str) -> None:
    assert len(inspect.signature(getattr(stiction, name)).parameters) <= 10


@pytest.mark.parametrize("method", [method for method in vars(stiction.Fit) if not method.startswith("_")])
def test_a_method_has_ten_arguments_at_most(method: str) -> None:
    value = inspect.getattr_static(stiction.Fit, method)
    if inspect.isfunction(value):
        assert len(inspect.signature(value).parameters) <= 10
