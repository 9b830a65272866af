#!/usr/bin/env python3
"""README's first table and picture: measured recordings, their published models, scipy and stiction.

    cargo xtask front        # or, with STICTION_WHEEL: python3 bench/front/front.py

Every model is fitted to the first half of a recording, but for what was published, and predicts the second. The three models
of an axis get the same velocity and acceleration, so that only laws, constants and a delay of the force differ, which stiction
finds and the others have not; the residual is that of the force as logged, and of its part below 10 Hz. stiction runs without
options, but for gravity where the axis has it. Prints the table and writes
docs/front.svg.
"""

import math
import os
import subprocess
import sys
import warnings
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[k]) for k in (1, 0)]
import environment

environment.enter(environment.WORK / "venv-front", Path(__file__).with_name("requirements.txt"))
if "STICTION_WHEEL" in os.environ:
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps"]
    subprocess.check_call([*install, "--force-reinstall", os.environ["STICTION_WHEEL"]])

import arm
import figure
import numpy as np
import peers
import scipy.signal as signal
import stiction
from recordings import AXES, servo

# Hz: what a compensator can follow on these axes.
BAND = 10.0
# s, at each end of the second half, where filters are not settled.
EDGE = 0.5
# Speeds at which the repeats are compared, from the least to the largest that stiction states for all.
SPEEDS = 10


class Stiction:
    """The constants of `stiction.identify`, along the same velocity and acceleration as those of the peers."""

    def __init__(self, log):
        self.fit = stiction.identify(log.columns(), {"terms": {"gravity": True}} if log.gravity else None)
        self.values = {row.name: row.value for row in self.fit.parameters.rows}

    def predict(self, log):
        """Force at the samples of a log."""
        value = self.values.get
        v, a = peers.derivatives(log)
        force = self.fit.law.record(log.time, v) + value("mass") * a + value("offset", 0.0)
        force += value("gravity_sin", 0.0) * np.sin(log.position) + value("gravity_cos", 0.0) * np.cos(log.position)
        return np.interp(log.time - value("delay", 0.0), log.time, force)


def residuals(log, force):
    """Of the second half: as logged, and below the band."""
    rate = (len(log.time) - 1) / (log.time[-1] - log.time[0])
    inner = slice(int(EDGE * rate), -int(EDGE * rate))
    off = force - log.force
    slow = signal.sosfiltfilt(signal.butter(4, BAND, fs=rate, output="sos"), off)
    return [np.sqrt(np.mean(x[inner] ** 2)) for x in (off, slow)]


def axis(log):
    """A row of the table, and the fit of stiction."""
    first, second = log.part(0.0, 0.5), log.part(0.5, 1.0)
    models = [peers.Published(first), peers.Stribeck(first), Stiction(first)]
    found = np.array([residuals(second, model.predict(second)) for model in models])
    return f"| {log.name}, {log.units[1]} | {' | '.join(marked(found, ' / ', 3))} |", models


def marked(found, between, digits):
    """A cell for each row of numbers; the least of each column is bold."""
    least = found.min(axis=0)
    texts = [[f"**{x:#.{digits}g}**" if x == m else f"{x:#.{digits}g}" for x, m in zip(row, least)] for row in found]
    return [between.join(row) for row in texts]


def held(values, halves):
    """How many of the intervals of each run hold what another run found, of how many."""
    n = len(values)
    pairs = [(i, j) for i in range(n) for j in range(n) if i != j]
    return sum(abs(values[i] - values[j]) <= halves[i] for i, j in pairs), len(pairs)


def repeats():
    """Friction of seven repeats at ten speeds, with intervals: of scipy, and of stiction for the same test on another day."""
    logs = servo()
    curves = [stiction.identify(log.columns()).result["friction_curve"] for log in logs]
    ends = [max(curve["speed"][0] for curve in curves), min(curve["speed"][-1] for curve in curves)]
    speeds = np.linspace(*ends, SPEEDS)
    scipys, ours = [], []
    for log, curve in zip(logs, curves):
        law = peers.Stribeck(log)
        scipys.append([law.friction(v) for v in speeds])
        both = curve["both"]
        ours.append([[np.interp(v, curve["speed"], both[k]) for k in ("force", "repeat")] for v in speeds])
    return speeds, np.array(scipys), np.array(ours)


def main():
    warnings.simplefilter("ignore")
    print(environment.described("numpy", "scipy", "pin", "stiction", is_timed=False) + ".\n")
    print("| error on samples that were not fitted | published | scipy | stiction |\n|---|---|---|---|")
    drawn = None
    for make in AXES:
        log = make()
        row, models = axis(log)
        print(row)
        drawn = drawn or (log, models)
    theirs, joints = arm.by_pinocchio(), arm.by_stiction()
    cells = marked(np.array([theirs, joints]), ", ", 2)
    print(f"| UR10, six joints, N m, below {arm.COMMON:.0f} Hz | – | {cells[0]} (with Pinocchio) | {cells[1]} |")
    speeds, scipys, ours = repeats()
    n = len(speeds)
    counts = [sum(np.array([held(x[:, k, 0], x[:, k, 1]) for k in range(n)])) for x in (scipys, ours)]
    cells = [f"{100.0 * hit / pairs:.0f} %" for hit, pairs in counts]
    # Both runs scatter: of normal ones a right interval of one holds the other so often.
    right = 100.0 * math.erf(0.5 * 1.96)
    print(f"| servo, seven runs of one test, ten speeds: 95 % intervals that hold another run's friction (of a right one: {right:.0f} %) | – | {cells[0]} | {cells[1]} |")
    figure.draw(drawn, (theirs, joints), (speeds, scipys, ours), environment.ROOT / "docs/front.svg")


if __name__ == "__main__":
    main()
