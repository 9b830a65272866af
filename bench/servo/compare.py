#!/usr/bin/env python3
"""The simulated axis beside what a Python user would write: a closed loop with friction in one compiled numba loop.

    python3 bench/servo/compare.py [ROUNDS]

Builds the Rust example `loops` and runs both in turn: a 10 kHz cascade (P in position, PI in
speed, acceleration fed forward) on a mass with LuGre friction along a sine of 20 mm and 1 Hz for 3 s, with one plant
step a control step; no encoder steps, delay or lag. numba holds z exactly and takes semi-implicit Euler for the
motion, of first order; stiction's step is implicit and of second order. Both compute the sine of the reference in the
loop; with `-shared` in the name stiction reads it from samples, as the runs of a study do. Prints the least time of each
in ns per control step, on one core, and what 1000 runs of a study take.

Then both take more and more plant steps in a control step of the first loop: ns per control step, and the rms of the difference
of the tracking error from that with very many steps, of each its own, in parts of it; the curve goes to
`docs/servo-accuracy.svg`.
"""

import math
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter()

import matplotlib
import numba
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt

LOOPS = {
    "cascade": "cascade, 10 kHz",
    "compensated": "with compensator",
    "everything": "4 kHz, three plant steps, with encoder, delay, current loop and compensator",
}
RATE, SECONDS, MASS = 10_000, 3, 10.0
STEPS = RATE * SECONDS
# sigma0, sigma1, sigma2, Fc, Fs, vs
LAW = (1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3)


@numba.njit
def level(v, law):
    x = v / law[5]
    return law[3] + (law[4] - law[3]) * math.exp(-min(x * x, 700.0))


@numba.njit
def moved(z, v, g, h, law):
    """The bristles after a step at a held velocity."""
    steady = math.copysign(g / law[0], v)
    return steady + (z - steady) * math.exp(-law[0] * abs(v) / g * h)


@numba.njit
def bristle_force(z, v, g, law):
    return law[0] * z + law[1] * (v - law[0] * abs(v) / g * z) + law[2] * v


@numba.njit
def loop(steps, h, mass, law, compensated):
    x = v = z = integral = ahead = squares = 0.0
    omega = 2.0 * math.pi
    for k in range(steps):
        t = k * h
        s, c = math.sin(omega * t), math.cos(omega * t)
        wanted, speed, acceleration = 0.02 * (1.0 - c), 0.02 * omega * s, 0.02 * omega * omega * c
        error = wanted - x
        squares += error * error
        slip = speed + 47.0 * error - v
        integral += 71_000.0 * slip * h
        force = 1885.0 * slip + integral + mass * acceleration
        if compensated:
            g = level(speed, law)
            force += bristle_force(ahead, speed, g, law)
            ahead = moved(ahead, speed, g, h, law)
        force = min(max(force, -1000.0), 1000.0)
        g = level(v, law)
        friction = bristle_force(z, v, g, law)
        z = moved(z, v, g, h, law)
        v += h * (force - friction) / mass
        x += h * v
    return math.sqrt(squares / steps)


@numba.njit
def tracked(errors, parts, h, mass, law):
    """The loop with `parts` plant steps in each control step; the tracking error of each into `errors`, where there is room."""
    x = v = z = integral = squares = 0.0
    omega = 2.0 * math.pi
    wide = 2.0 * math.pi * 30.0
    short = h / parts
    for k in range(STEPS):
        t = k * h
        s, c = math.sin(omega * t), math.cos(omega * t)
        wanted, speed, acceleration = 0.02 * (1.0 - c), 0.02 * omega * s, 0.02 * omega * omega * c
        error = wanted - x
        squares += error * error
        if len(errors) > 0:
            errors[k] = error
        slip = speed + 0.25 * wide * error - v
        integral += 0.2 * wide * wide * mass * slip * h
        force = wide * mass * slip + integral + mass * acceleration
        force = min(max(force, -1000.0), 1000.0)
        for _ in range(parts):
            g = level(v, law)
            friction = bristle_force(z, v, g, law)
            z = moved(z, v, g, short, law)
            v += short * (force - friction) / mass
            x += short * v
    return math.sqrt(squares / STEPS)


def numba_accuracy(rounds):
    """Plant steps, ns per control step, and the rms of what they get wrong of the tracking error in parts of it."""

    def errors(parts):
        found = numpy.zeros(STEPS)
        tracked(found, parts, 1.0 / RATE, MASS, LAW)
        return found

    right, none, points = errors(1 << 14), numpy.zeros(0), []
    for parts in [1 << i for i in range(10)]:
        spent = math.inf
        for _ in range(rounds):
            start = time.perf_counter()
            tracked(none, parts, 1.0 / RATE, MASS, LAW)
            spent = min(spent, time.perf_counter() - start)
        off = numpy.sqrt(numpy.mean((errors(parts) - right) ** 2) / numpy.mean(right**2))
        points.append((parts, 1e9 * spent / STEPS, off))
    return points


def accuracy(rounds):
    command = [environment.example("loops"), str(rounds), "accuracy"]
    lines = subprocess.check_output(command, text=True).splitlines()
    ours = [(int(n), float(ns), float(off)) for n, ns, off in map(str.split, lines)]
    numbas = numba_accuracy(rounds)
    print("| plant steps | stiction, ns | error | numba, ns | error |\n|---:|---:|---:|---:|---:|")
    known = {n: f"{ns:.1f} | {off:.1e}" for n, ns, off in ours}
    for n, ns, off in numbas:
        print(f"| {n} | {known.get(n, ' | ')} | {ns:.1f} | {off:.1e} |")
    figure([("stiction, implicit, second order", "#0072B2", ours), ("numba, semi-implicit Euler", "#D55E00", numbas)])


def figure(curves):
    """Accuracy over time."""
    plt.rcParams.update({"svg.hashsalt": "servo", "svg.fonttype": "none", "font.size": 10})
    figure, axes = plt.subplots(figsize=(6.4, 3.4), layout="constrained")
    for name, color, points in curves:
        _, spent, off = zip(*points)
        axes.loglog(spent, off, "o-", color=color, markersize=4, label=name)
    axes.set(xlabel="ns per control step", ylabel="error of the tracking error,\nin parts of it")
    axes.grid(True, which="both", color="#e0e0e0")
    axes.legend(frameon=False)
    figure.savefig(environment.ROOT / "docs/servo-accuracy.svg", metadata={"Date": None})


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    program = environment.example("loops")
    least = {}
    for turn in range(rounds):
        for name, compensated in [("numba-cascade", False), ("numba-compensated", True)]:
            loop(10, 1.0 / RATE, MASS, LAW, compensated)
            for _ in range(50):
                start = time.perf_counter()
                loop(STEPS, 1.0 / RATE, MASS, LAW, compensated)
                spent = (time.perf_counter() - start) * 1e9 / STEPS
                least[name] = min(least.get(name, math.inf), spent)
        study = ["study"] if turn == 0 else []
        command = [program, "30", *study]
        for line in subprocess.check_output(command, text=True).splitlines():
            name, value = line.split()
            least[name] = min(least.get(name, math.inf), float(value))
    print(environment.described("numba") + ".\n")
    print("| ns per control step | stiction | the sine read from samples | numba |\n|---|---:|---:|---:|")
    for name, words in LOOPS.items():
        times = [least.get(column) for column in (name, f"{name}-shared", f"numba-{name}")]
        print(f"| {words} | " + " | ".join("" if time is None else f"{time:.1f}" for time in times) + " |")
    one, two = least["study-1"], least["study-2"]
    print(f"\n1000 runs of a study, 3 s each of the last: {one:.2f} s on one thread, {two:.2f} s on two.\n")
    accuracy(rounds)


if __name__ == "__main__":
    main()
