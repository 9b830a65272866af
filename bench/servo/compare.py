#!/usr/bin/env python3
"""The simulated axis beside what a Python user would write: a closed loop with friction in one compiled numba loop.

    python3 bench/servo/compare.py [ROUNDS]

Builds the Rust example `loops` and runs both in turn: a 10 kHz cascade (P in position, PI in
speed, acceleration fed forward) on a mass with LuGre friction along a sine of 20 mm and 1 Hz for 3 s, with one plant
step a control step; no encoder steps, delay or lag. numba holds z exactly and takes semi-implicit Euler for the
motion, of first order; stiction's step is implicit and of second order. Both compute the sine of the reference in the
loop; with `-shared` in the name stiction reads it from samples, as the runs of a study do. Prints the least time of each
in ns per control step, on one core, and with `study` as second argument what 1000 runs of a study take.
"""

import datetime
import math
import os
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter()

import numba

RATE, SECONDS, MASS = 10_000, 3, 10.0
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


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    program = environment.example("loops")
    steps = RATE * SECONDS
    least = {}
    for turn in range(rounds):
        for name, compensated in [("numba-cascade", False), ("numba-compensated", True)]:
            loop(10, 1.0 / RATE, MASS, LAW, compensated)
            for _ in range(50):
                start = time.perf_counter()
                loop(steps, 1.0 / RATE, MASS, LAW, compensated)
                spent = (time.perf_counter() - start) * 1e9 / steps
                least[name] = min(least.get(name, math.inf), spent)
        study = sys.argv[2:3] if turn == 0 else []
        command = [program, "30", *study]
        for line in subprocess.check_output(command, text=True).splitlines():
            name, value = line.split()
            least[name] = min(least.get(name, math.inf), float(value))
    cpu = next((l.split(":")[1].strip() for l in open("/proc/cpuinfo") if "model name" in l), "?")
    print(f"{datetime.date.today()}, {cpu}, {os.cpu_count()} cores under a load of {os.getloadavg()[0]:.0f};", end=" ")
    print(f"numba {numba.__version__}")
    for name, value in least.items():
        print(f"{name} {value:.1f}")


if __name__ == "__main__":
    main()
