#!/usr/bin/env python3
"""An identification beside what a Python user would write: scipy's least_squares, the six LuGre parameters by their
logarithms, exact sensitivities in a compiled numba loop.

    python3 bench/peers/identify.py [ROUNDS]

Makes its own virtual environment in target/bench-peers, builds the Rust example, and runs both in turn on one record
(30 001 samples, 3 s at 10 kHz, the velocity a sine, 1 % noise on the force). scipy starts at random points of a box one
decade to each side of the truth; stiction is told neither start nor box. Prints the least time of each part over all
rounds, what they found, and how two threads do on a batch.
"""

import datetime
import os
import platform
import subprocess
import sys
import time
import venv
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "target" / "bench-peers"
PYTHON = WORK / "venv" / "bin" / "python"
WANTED = ["numpy", "scipy", "numba"]
STEP = 1e-4
SAMPLES = 30001
NAMES = ["sigma0", "sigma1", "sigma2", "coulomb", "static", "stribeck_velocity"]
TRUTH = (1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3)
AMPLITUDE = 0.05
STARTS = 20
# A start has found the optimum if its cost is above the least by no more than this part.
FOUND = 1e-4


def in_environment():
    """Starts again inside the environment, made if it is not there."""
    if Path(sys.prefix) == WORK / "venv":
        return
    if not PYTHON.exists():
        venv.create(WORK / "venv", with_pip=True)
        subprocess.check_call([PYTHON, "-m", "pip", "install", "--quiet", *WANTED])
    os.execv(PYTHON, [str(PYTHON), __file__, *sys.argv[1:]])


def model():
    """Force along a velocity, and its derivatives by the logarithms of the six parameters: each interval exactly, its
    velocity held at the mean."""
    import numba
    import numpy as np

    @numba.njit(error_model="numpy")
    def run(p, velocity, step, force, slopes, sensitive):
        s0, s1, s2, fc, fs, vs = p
        z = 0.0
        dz = np.zeros(6)
        for k in range(velocity.shape[0]):
            v = velocity[k]
            if k > 0:
                m = 0.5 * (velocity[k - 1] + v)
                e = np.exp(-((m / vs) ** 2))
                g = fc + (fs - fc) * e
                length = step * s0 * abs(m) / g
                keep = np.exp(-length)
                steady = np.copysign(g / s0, m)
                far = z - steady
                if sensitive:
                    # By the logarithm: each derivative times its parameter.
                    fall = (fs - fc) * e * 2.0 * (m / vs) ** 2
                    for i in range(6):
                        dg = 0.0
                        if i == 3:
                            dg = fc * (1.0 - e)
                        elif i == 4:
                            dg = fs * e
                        elif i == 5:
                            dg = fall
                        rise = steady * dg / g
                        longer = -length * dg / g
                        if i == 0:
                            rise -= steady
                            longer += length
                        dz[i] = rise + (dz[i] - rise) * keep - far * keep * longer
                z = steady + far * keep
            e = np.exp(-((v / vs) ** 2))
            g = fc + (fs - fc) * e
            pull = s0 * abs(v) / g
            rate = v - pull * z
            force[k] = s0 * z + s1 * rate + s2 * v
            if sensitive:
                fall = (fs - fc) * e * 2.0 * (v / vs) ** 2
                for i in range(6):
                    dg = 0.0
                    if i == 3:
                        dg = fc * (1.0 - e)
                    elif i == 4:
                        dg = fs * e
                    elif i == 5:
                        dg = fall
                    d = (s0 - s1 * pull) * dz[i] + s1 * pull * z * dg / g
                    if i == 0:
                        d += s0 * z - s1 * pull * z
                    elif i == 1:
                        d += s1 * rate
                    elif i == 2:
                        d += s2 * v
                    slopes[k, i] = d

    return run


def record(run):
    """Velocity and noisy force: the law stepped 50 times a sample."""
    import numpy as np

    fine = 50
    t = np.arange((SAMPLES - 1) * fine + 1) * (STEP / fine)
    v = AMPLITUDE * np.sin(2 * np.pi * t)
    force = np.empty(len(v))
    run(np.array(TRUTH), v, STEP / fine, force, np.empty((1, 6)), False)
    v, force = v[::fine].copy(), force[::fine].copy()
    noise = np.random.default_rng(1).normal(0.0, 0.01 * np.abs(force).max(), SAMPLES)
    return v, force + noise


def check(run, velocity):
    """The derivatives against central differences."""
    import numpy as np

    force, slopes = np.empty(SAMPLES), np.empty((SAMPLES, 6))
    p = np.array(TRUTH)
    run(p, velocity, STEP, force, slopes, True)
    for i in range(6):
        ends = []
        for h in (1e-6, -1e-6):
            q = p.copy()
            q[i] *= np.exp(h)
            run(q, velocity, STEP, force, np.empty((1, 6)), False)
            ends.append(force.copy())
        numeric = (ends[0] - ends[1]) / 2e-6
        off = np.abs(slopes[:, i] - numeric).max() / np.abs(numeric).max()
        assert off < 1e-6, f"derivative by {NAMES[i]} is off by {off}"


class Peer:
    """scipy on the record, and what each of its starts came to."""

    def __init__(self, run, velocity, force):
        import numpy as np
        from scipy.optimize import least_squares

        centre = np.log(TRUTH)
        low, high = centre - np.log(10.0), centre + np.log(10.0)
        model, slopes = np.empty(SAMPLES), np.empty((SAMPLES, 6))

        def residual(x):
            run(np.exp(x), velocity, STEP, model, slopes, False)
            return model - force

        def jacobian(x):
            run(np.exp(x), velocity, STEP, model, slopes, True)
            return slopes

        draws = np.random.default_rng(7).uniform(low, high, (STARTS, 6))
        self.solve = lambda i: least_squares(residual, draws[i], jac=jacobian, bounds=(low, high))
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
    import numba
    import numpy as np
    import scipy

    build = ["cargo", "build", "--quiet", "--release", "-p", "stiction-identify", "--example", "record"]
    subprocess.check_call(build, cwd=ROOT)
    run = model()
    velocity, force = record(run)
    check(run, velocity)
    np.column_stack([velocity, force]).astype("<f8").tofile(WORK / "record.bin")
    peer = Peer(run, velocity, force)
    ours = {}
    for _ in range(rounds):
        peer.round()
        example = [ROOT / "target/release/examples/record", WORK / "record.bin", "40"]
        for line in subprocess.check_output(example, text=True).splitlines():
            name, value = line.split()
            is_time = name in ("search", "estimate", "intervals", "batch-1", "batch-2")
            ours[name] = min(ours.get(name, float("inf")), float(value)) if is_time else float(value)

    cpu = next((l.split(":")[1].strip() for l in open("/proc/cpuinfo") if "model name" in l), "?")
    load = " ".join(f"{x:.1f}" for x in os.getloadavg())
    print(f"{datetime.date.today()}, {cpu}, {os.cpu_count()} cores, {platform.system()}, load {load}")
    print(f"scipy {scipy.__version__}, numba {numba.__version__}, numpy {np.__version__},", end=" ")
    print(subprocess.check_output(["rustc", "--version"], text=True).strip())
    hits = peer.found()
    best, middle = peer.ms[hits[0]], peer.ms[hits[len(hits) // 2]]
    whole = ours["search"] + ours["estimate"]
    print(f"scipy: {len(hits)} of {STARTS} starts find the optimum; the fastest of them {best:.1f} ms, the middle one {middle:.1f} ms")
    print(f"stiction: search {ours['search']:.2f} ms, estimate {ours['estimate']:.2f} ms, intervals {ours['intervals']:.2f} ms;", end=" ")
    print(f"{ours['evaluations']:.0f} evaluations, {ours['thinned']:.0f} of them on a thinned record")
    print(f"scipy's middle start takes {middle / ours['search']:.1f} times the search, {middle / whole:.1f} times search and estimate")
    print(f"scipy's fastest start takes {best / ours['search']:.1f} times the search, {best / whole:.1f} times search and estimate")
    print(f"two threads on a batch: {ours['batch-1'] / ours['batch-2']:.2f} times the throughput of one")
    x = np.exp(peer.results[hits[0]].x)
    print(f"cost: scipy {2 * peer.results[hits[0]].cost:.6g}, stiction {ours['cost']:.6g}")
    for name, truth, theirs in zip(NAMES, TRUTH, x):
        print(f"{name:18} truth {truth:<10.5g} scipy {theirs:<12.6g} stiction {ours[name]:<12.6g}")


if __name__ == "__main__":
    in_environment()
    main()
