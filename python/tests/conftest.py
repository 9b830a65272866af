"""A log to work on, fits of it, and the command line to compare with."""

from __future__ import annotations

import os
import shutil
import subprocess
import warnings
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction

SAMPLES = 12000
"""Of the 36 001 of the demo: 3 s at 4 kHz, quick to identify."""


def quietly(work: Any, *arguments: Any, **options: Any) -> Any:
    """Without warnings, which have tests of their own."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return work(*arguments, **options)


@pytest.fixture(scope="session")
def run_csv(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The beginning of the log of the demo."""
    folder = tmp_path_factory.mktemp("log")
    whole = stiction.write_demo_log(folder / "whole.csv", seed=3)
    lines = whole.read_text().splitlines(keepends=True)
    path = folder / "run.csv"
    path.write_text("".join(lines[: SAMPLES + 1]))
    return path


@pytest.fixture(scope="session")
def arrays(run_csv: Path) -> dict[str, Any]:
    """The same as arrays under the headers of the file."""
    header, *rows = run_csv.read_text().splitlines()
    table = numpy.array([[float(cell) for cell in row.split(",")] for row in rows])
    return {name: table[:, k].copy() for k, name in enumerate(header.split(","))}


@pytest.fixture(scope="session")
def fit(run_csv: Path) -> stiction.Fit:
    """LuGre of that log."""
    found: stiction.Fit = quietly(stiction.identify, run_csv, law="lugre", run=stiction.Run(compare_laws=False))
    return found


@pytest.fixture(scope="session")
def program() -> Path:
    """The command line, built from the same sources."""
    path = os.environ.get("STICTION_PROGRAM") or shutil.which("stiction")
    if not path:
        if os.environ.get("CI") == "true":
            pytest.fail("STICTION_PROGRAM does not name the built command line")
        pytest.skip("set STICTION_PROGRAM to the built command line")
    return Path(path)


@pytest.fixture
def command(program: Path) -> Any:
    """Runs the command line, which must not find its input bad."""

    def run(*arguments: Any) -> subprocess.CompletedProcess[str]:
        words = [str(program), *map(str, arguments)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        assert done.returncode in (0, 1), done.stderr
        return done

    return run
