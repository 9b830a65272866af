#!/usr/bin/env python3
"""The library's identification beside what a Python user would write: scipy's least_squares, the six LuGre parameters
by their logarithms, exact sensitivities.

    python3 bench/peers/identify.py [ROUNDS]

Builds the Rust example, and runs both in turn on one record (30 001 samples, 3 s at 10 kHz, the velocity a sine, 1 %
noise on the force). scipy starts at random points of a box one decade to each side of the truth; stiction is told
neither start nor box. Prints the least time of each part over all rounds, what they found, and how two threads do on a
batch.
"""

import machine  # first: it enters the environment and sets the threads

import subprocess
import sys
import time

import by_mujoco
import numpy as np
from model import NAMES, Model
from scipy.optimize import least_squares

STEP = 1e-4
SAMPLES = 30001
# sigma0, sigma1, sigma2, Fc, Fs - Fc, vs
TRUTH = np.array([1.2e5, 600.0, 60.0, 20.0, 10.0, 5e-3])
AMPLITUDE = 0.05
STARTS = 20
# A start has found the optimum if its cost is above the least by no more than this part.
FOUND = 1e-4
TIMES = ("search", "estimate", "intervals", "batch-1", "batch-2", "apart-2")


def record():
    """Velocity and noisy force: the law stepped 50 times a sample."""
    fine = 50
    t = np.arange((SAMPLES - 1) * fine + 1) * (STEP / fine)
    v = AMPLITUDE * np.sin(2 * np.pi * t)
    force = Model(v, STEP / fine).force(TRUTH)[::fine].copy()
    noise = np.random.default_rng(1).normal(0.0, 0.01 * np.abs(force).max(), SAMPLES)
    return v[::fine].copy(), force + noise


class Peer:
    """scipy on the record, and what each of its starts came to."""

    def __init__(self, velocity, force):
        model = Model(velocity, STEP)
        model.check(TRUTH)
        centre = np.log(TRUTH)
        low, high = centre - np.log(10.0), centre + np.log(10.0)
        draws = np.random.default_rng(7).uniform(low, high, (STARTS, 6))
        self.starts, self.bounds = draws, [low, high]
        self.solve = lambda i: least_squares(
            lambda x: model.force(np.exp(x)) - force,
            draws[i],
            jac=lambda x: model.slopes(np.exp(x)),
            bounds=(low, high),
        )
        self.ms = [float("inf")] * STARTS
        self.results = [None] * STARTS

    def round(self):
        for i in range(STARTS):
            start = time.perf_counter()
            self.results[i] = self.solve(i)
            self.ms[i] = min(self.ms[i], 1e3 * (time.perf_counter() - start))

    def found(self):
        """The starts that found the optimum, the fastest first."""
        least = min(r.cost for r in self.results)
        hits = [i for i in range(STARTS) if self.results[i].cost <= least * (1 + FOUND)]
        return sorted(hits, key=lambda i: self.ms[i])


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    program = machine.environment.example("record")
    velocity, force = record()
    file = machine.WORK / "record.bin"
    np.column_stack([velocity, force]).astype("<f8").tofile(file)
    peer = Peer(velocity, force)
    ours = {}
    for _ in range(rounds):
        peer.round()
        example = [program, file, "40"]
        for line in subprocess.check_output(example, text=True).splitlines():
            name, value = line.split()
            ours[name] = min(ours.get(name, float("inf")), float(value)) if name in TIMES else float(value)

    mujoco, cost = by_mujoco.identify(AMPLITUDE, STEP, force, peer.starts, peer.bounds)
    print(machine.described("scipy", "numba", "numpy", "mujoco") + ".\n")
    hits = peer.found()
    best, middle = peer.ms[hits[0]], peer.ms[hits[len(hits) // 2]]
    whole = ours["search"] + ours["estimate"] + ours["intervals"]
    rows = [
        ("stiction, search", ours["search"]),
        ("stiction, search, estimate and intervals", whole),
        ("scipy, one start, the fastest of those that find the optimum", best),
        (f"scipy, one start, the median of those ({len(hits)} of {STARTS})", middle),
        (f"mujoco.minimize over mujoco.rollout, the best of {by_mujoco.STARTS} starts", mujoco),
    ]
    print("| what | ms | times the search |\n|---|---:|---:|")
    for name, ms in rows:
        print(f"| {name} | {ms:.{0 if ms >= 1000 else 2}f} | {ms / ours['search']:.1f} |")
    print(f"\nTwo threads on a batch: {ours['batch-1'] / ours['batch-2']:.2f} times the throughput of one.", end=" ")
    found = 2 * peer.results[hits[0]].cost
    print(f"Least cost: scipy {found:.6g}, stiction {ours['cost']:.6g}, MuJoCo {cost:.6g}.")


if __name__ == "__main__":
    main()
