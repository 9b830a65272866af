#!/usr/bin/env python3
"""The batch kernels beside the scalar law and beside what a Python user would write: numba, the population in SIMD lanes.

    python3 bench/lanes/compare.py [ROUNDS]

Builds the Rust example, and runs both in turn on one record (3 s at 10 kHz, the velocity a sine, 1 % noise on the force) with
the same random candidates. Prints the least time of each in ns per candidate and sample.
"""

import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter()

WORK = environment.WORK / "lanes"
LANES = 32
STEP = 1e-4
# sigma0, sigma1, sigma2, Fc, Fs, vs
TRUTH = (1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3)
CANDIDATES = 64
# What the table tells of that which is timed; the rest is for whoever works on the kernels.
ROWS = {
    "cost": "cost of 64 candidates",
    "cost-pair": "the same on two threads",
    "numba": "the same by numba, one thread",
    "cost-alone": "cost of one candidate",
    "scalar-cost": "the same by the scalar law",
    "midpoint": "mass and LuGre under a given force, 64 axes, implicit midpoint",
    "semi-implicit": "the same, semi-implicit",
    "scalar-plant": "the same by the scalar plant, one axis, implicit midpoint",
}


def kernels():
    """numba's kernel: cost of a population, each interval's velocity held at its mean."""
    # Left to itself, LLVM keeps to 256 bits on this kind of processor, which is slower here.
    if "avx512f" in Path("/proc/cpuinfo").read_text():
        os.environ["NUMBA_CPU_NAME"] = "generic"
        os.environ["NUMBA_CPU_FEATURES"] = "+avx,+avx2,+fma,+avx512f,+avx512dq,+avx512vl"
    import numba
    import numpy as np
    from llvmlite import ir
    from numba.core import types
    from numba.extending import intrinsic

    @intrinsic
    def as_float(context, bits):
        def generate(ctx, builder, signature, arguments):
            return builder.bitcast(arguments[0], ir.DoubleType())

        return types.float64(types.int64), generate

    # numba from PyPI has no vector exp, so it gets one: Taylor of degree 12 after taking powers of two out.
    @numba.njit(inline="always")
    def fast_exp(x):
        x = max(x, -700.0)
        n = np.floor(x * 1.4426950408889634 + 0.5)
        r = (x - n * 0.6931471803691238) - n * 1.9082149292705877e-10
        p = 1.0 / 479001600.0
        p = p * r + 1.0 / 39916800.0
        p = p * r + 1.0 / 3628800.0
        p = p * r + 1.0 / 362880.0
        p = p * r + 1.0 / 40320.0
        p = p * r + 1.0 / 5040.0
        p = p * r + 1.0 / 720.0
        p = p * r + 1.0 / 120.0
        p = p * r + 1.0 / 24.0
        p = p * r + 1.0 / 6.0
        p = p * r + 0.5
        p = p * r + 1.0
        p = p * r + 1.0
        return p * as_float((np.int64(n) + 1023) << 52)

    @numba.njit(fastmath=True, error_model="numpy")
    def group(candidates, velocity, force, step, first, out):
        stiff = np.empty(LANES)
        damping = np.empty(LANES)
        viscous = np.empty(LANES)
        level = np.empty(LANES)
        drop = np.empty(LANES)
        inverse = np.empty(LANES)
        z = np.zeros(LANES)
        cost = np.zeros(LANES)
        for j in range(LANES):
            c = candidates[first + j]
            stiff[j] = c[0]
            damping[j] = c[1]
            viscous[j] = c[2]
            level[j] = c[3]
            drop[j] = c[4] - c[3]
            inverse[j] = 1.0 / c[5]
        for k in range(velocity.shape[0] - 1):
            v = velocity[k]
            speed = abs(v)
            u = force[k]
            mean = 0.5 * (v + velocity[k + 1])
            mean_speed = abs(mean)
            sign = np.copysign(1.0, mean)
            for j in range(LANES):
                x = v * inverse[j]
                g = level[j] + drop[j] * fast_exp(-x * x)
                rate = v - stiff[j] * speed * z[j] / g
                e = u - (stiff[j] * z[j] + damping[j] * rate + viscous[j] * v)
                cost[j] += e * e
                x = mean * inverse[j]
                g = level[j] + drop[j] * fast_exp(-x * x)
                keep = fast_exp(-step * stiff[j] * mean_speed / g)
                steady = sign * g / stiff[j]
                z[j] = steady + (z[j] - steady) * keep
        for j in range(LANES):
            out[first + j] = cost[j]

    @numba.njit
    def population(candidates, velocity, force, step, out):
        for first in range(0, candidates.shape[0], LANES):
            group(candidates, velocity, force, step, first, out)

    return population


def record():
    """Velocity and noisy force: the law stepped 50 times a sample, the velocity exact."""
    import numba
    import numpy as np

    s0, s1, s2, fc, fs, vs = TRUTH
    samples, fine = 30001, 50
    t = np.arange((samples - 1) * fine + 1) * (STEP / fine)
    v = 0.05 * np.sin(2 * np.pi * t)

    @numba.njit
    def run(v, h):
        z = np.zeros(v.shape[0])
        for k in range(v.shape[0] - 1):
            m = 0.5 * (v[k] + v[k + 1])
            g = fc + (fs - fc) * np.exp(-((m / vs) ** 2))
            steady = np.copysign(g / s0, m)
            z[k + 1] = steady + (z[k] - steady) * np.exp(-h * s0 * abs(m) / g)
        return z

    z = run(v, STEP / fine)
    g = fc + (fs - fc) * np.exp(-((v / vs) ** 2))
    force = (s0 * z + s1 * (v - s0 * np.abs(v) * z / g) + s2 * v)[::fine]
    noise = np.random.default_rng(1).normal(0.0, 0.01 * np.abs(force).max(), samples)
    return v[::fine].copy(), force + noise


def main():
    import time

    population = kernels()
    import llvmlite
    import numba
    import numpy as np

    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    program = environment.example("throughput")
    WORK.mkdir(parents=True, exist_ok=True)
    velocity, force = record()
    spread = 10 ** np.random.default_rng(0).uniform(-1.0, 1.0, (CANDIDATES, 6))
    candidates = np.array(TRUTH) * spread
    candidates[:, 4] = candidates[:, 3] * (1.0 + 0.5 * spread[:, 4])
    np.column_stack([velocity, force]).astype("<f8").tofile(WORK / "record.bin")
    candidates.astype("<f8").tofile(WORK / "candidates.bin")

    out = np.empty(CANDIDATES)
    population(candidates, velocity, force, STEP, out)
    least = {"numba": float("inf")}
    for _ in range(rounds):
        for _ in range(5):
            start = time.perf_counter()
            population(candidates, velocity, force, STEP, out)
            spent = time.perf_counter() - start
            least["numba"] = min(least["numba"], spent * 1e9 / (CANDIDATES * len(velocity)))
        lines = subprocess.check_output(
            [
                program,
                WORK / "record.bin",
                WORK / "candidates.bin",
                "5",
            ],
            text=True,
        ).splitlines()
        for line in lines:
            if line.startswith("#"):
                head = line
                continue
            name, ns = line.split()
            least[name] = min(least.get(name, float("inf")), float(ns))
    print(f"{environment.described('numba', 'llvmlite', 'numpy')}; {head[2:]}.\n")
    print("| what | ns per candidate and sample |\n|---|---:|")
    for name, words in ROWS.items():
        print(f"| {words} | {least[name]:.2f} |")


if __name__ == "__main__":
    main()
