"""Where things are, and what they were measured on. Imported first: it enters the environment."""

import datetime
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter()

# One core for everybody; to be set before numpy is imported.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"

ROOT = environment.ROOT
WORK = environment.WORK / "peers"
WORK.mkdir(parents=True, exist_ok=True)


def described(*packages):
    """Date, machine and versions, in a line."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    processor = next((line.split(":")[1].strip() for line in lines if "model name" in line), "unknown processor")
    rustc = subprocess.check_output(["rustc", "--version"], text=True).split()[1]
    load = os.getloadavg()[1]
    versions = ", ".join(f"{name} {version(name)}" for name in packages)
    return (
        f"{datetime.date.today()}, {processor}, {os.cpu_count()} cores under a load of {load:.0f}; "
        f"Python {sys.version.split()[0]}, {versions}, rustc {rustc}"
    )
