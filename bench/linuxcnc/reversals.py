#!/usr/bin/env python3
"""The figures and the picture of docs/deploy/hal.md: LinuxCNC without and with the compensator.

    python3 bench/linuxcnc/reversals.py

Runs the tests of the example `examples/linuxcnc`, which print the figures, and draws their logs: the following error over the
same program, and about one reversal with the forces, to `docs/deploy/hal-reversals.svg`. Takes about four minutes.
"""

import datetime
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter()

import matplotlib
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt

LOGS = environment.WORK / "linuxcnc"
# columns of a log
SPEED, ERROR, FORCE, COMPENSATOR = 4, 5, 3, 6
WITHOUT, WITH = "#D55E00", "#0072B2"


def figures():
    command = "cargo test -p stiction-cli --test suite linuxcnc -- --include-ignored --nocapture --test-threads=1"
    kept = os.environ | {"STICTION_LINUXCNC": str(LOGS)}
    said = subprocess.run(command.split(), cwd=environment.ROOT, env=kept, stdout=subprocess.PIPE, text=True, check=True).stdout
    cpu = next((l.split(":")[1].strip() for l in open("/proc/cpuinfo") if "model name" in l), "?")
    print(f"{datetime.date.today()}, {cpu}, {os.cpu_count()} cores under a load of {os.getloadavg()[0]:.0f}")
    print(said)


def log(name):
    """The rows of a log from the first motion on, and their times."""
    lines = (LOGS / name).read_text().splitlines()
    rows = numpy.array([[float(cell) for cell in line.split()] for line in lines if line != "overrun"])
    rows = rows[numpy.flatnonzero(rows[:, SPEED])[0] :]
    return rows, numpy.arange(len(rows)) / 1000.0


def reversal(rows):
    """The third turn of the circles."""
    turns = numpy.flatnonzero(numpy.diff(numpy.sign(rows[:, SPEED])))
    return turns[turns > 1000][0]


def draw():
    plt.rcParams.update({"svg.hashsalt": "linuxcnc", "svg.fonttype": "none", "font.size": 10})
    figure, ((whole, whole_with), (error, force)) = plt.subplots(2, 2, figsize=(9, 5.2), layout="constrained")
    for name, axes, color, label in [
        ("without.txt", whole, WITHOUT, "without"),
        ("with.txt", whole_with, WITH, "with compensation"),
    ]:
        rows, time = log(name)
        axes.plot(time[::3], 1e3 * rows[::3, ERROR], color=color, linewidth=0.6)
        axes.set(xlabel="s", ylabel="following error, µm", ylim=(-70, 70), title=label)
        at = reversal(rows)
        near = slice(at - 40, at + 160)
        late = 1e3 * (time[near] - time[at])
        error.plot(late, 1e3 * rows[near, ERROR], color=color, label=label)
        force.plot(late, rows[near, FORCE], color=color, label=f"drive, {label}")
        if name == "with.txt":
            force.plot(late, rows[near, COMPENSATOR], "--", color="black", linewidth=0.8, label="compensator's part")
    error.set(xlabel="ms after a reversal of a circle at 20 mm/s", ylabel="following error, µm")
    force.set(xlabel="ms after a reversal of a circle at 20 mm/s", ylabel="force, N")
    for axes in (error, force):
        axes.legend(frameon=False, fontsize=9)
    for axes in figure.axes:
        axes.grid(color="#e0e0e0")
    figure.savefig(environment.ROOT / "docs/deploy/hal-reversals.svg", metadata={"Date": None})


figures()
draw()
