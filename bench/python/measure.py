"""What the Python package costs over the library: measure.py TIMED [WHEEL], the built example `timed` of crates/stiction.

Prints import time, identification of 30 001 samples against the same call in Rust (in turn, the least of all), two threads
against one, in Rust and in Python, the memory of many calls and the size of the wheel, and ends with exit code 1 where one
misses its bar.
Run it with the Python that the wheel is installed in, on a machine that does nothing else: `cargo xtask wheel` does, and
`cargo xtask performance python` without its tests.
"""

from __future__ import annotations

import os
import platform
import resource
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

BUILT = environment.target() / "python"
if len(sys.argv) == 1:
    # What `cargo xtask performance` has built and installed; a wheel for another machine may stand beside it.
    wheel = next((BUILT / "release").glob(f"*{platform.machine()}.whl"), None)
    if wheel is None:
        sys.exit("no wheel is built: `cargo xtask performance python`")
    python = BUILT / "venv/bin/python"
    os.execv(python, [str(python), __file__, str(environment.target() / "dist/examples/timed"), str(wheel)])

import stiction

SAMPLES = 30_001
ROUNDS = 7
ALONE = stiction.Run(compare_laws=False, threads=1)


def importing(module: str) -> float:
    """Least time of an import, s."""
    line = f"import time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
    words = [sys.executable, "-c", line]
    return min(float(subprocess.run(words, capture_output=True, text=True, check=True).stdout) for _ in range(20))


def identified(log: stiction.Log) -> float:
    """Time of one identification on one thread, s."""
    start = time.perf_counter()
    stiction.identify(log, law="lugre", run=ALONE)
    return time.perf_counter() - start


def with_the_interpreter(log: stiction.Log) -> float:
    """Part of the processor time of an identification that the calling thread takes: all that Python adds, and the most in
    which others have to wait for the interpreter. Other work on the machine does not change it."""
    thread, process = time.thread_time(), time.process_time()
    identified(log)
    thread, process = time.thread_time() - thread, time.process_time() - process
    return thread / (process - thread)


def at_once(work: Callable[[], object], count: int) -> float:
    """Time of as many threads that each do some work, s."""
    all_of_them = [threading.Thread(target=work) for _ in range(count)]
    start = time.perf_counter()
    for thread in all_of_them:
        thread.start()
    for thread in all_of_them:
        thread.join()
    return time.perf_counter() - start


def stepped(fit: stiction.Fit) -> None:
    """A law of its own called from Python, sample by sample."""
    law = fit.law
    for _ in range(300_000):
        law(1e-3, 1e-4)


def kept(calls: int) -> float:
    """Growth of the memory over so many identifications of a short log, MB."""
    import numpy

    t = numpy.arange(1000) * 1e-3
    velocity = 0.06 * numpy.cos(12.0 * t)
    force = 20.0 * numpy.sign(velocity) + 60.0 * velocity
    data: Any = {"time [s]": t, "position [m]": 5e-3 * numpy.sin(12.0 * t), "force [N]": force}

    def run(n: int) -> int:
        for _ in range(n):
            stiction.identify(data, law="coulomb-viscous", run=ALONE).residual
        return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

    first = run(calls // 10)
    return (run(calls) - first) / 1e6


class Bars:
    """What is measured against what is allowed."""

    def __init__(self) -> None:
        self.missed: list[str] = []

    def hold(self, name: str, is_held: bool) -> None:
        if not is_held:
            self.missed.append(name)


def main(timed: str, wheel: str | None) -> list[str]:
    """The bars that are missed."""
    bars = Bars()
    print(environment.described("numpy") + ".\n\n| what | measured |\n|---|---|")
    if wheel:
        size = Path(wheel).stat().st_size / 1e6
        print(f"| size of the wheel | {size:.2f} MB |")
        bars.hold("a wheel of at most 8 MB", size <= 8.0)
    own = importing("stiction")
    print(f"| `import stiction`; of that numpy | {1e3 * own:.0f}; {1e3 * importing('numpy'):.0f} ms |")
    bars.hold("an import within 60 ms", own < 0.06)
    with tempfile.TemporaryDirectory() as folder:
        whole = stiction.write_demo_log(Path(folder) / "whole.csv", seed=1)
        path = Path(folder) / "run.csv"
        path.write_text("".join(whole.read_text().splitlines(keepends=True)[: SAMPLES + 1]))
        log = stiction.read_log(path)
        ours, theirs = [], []
        for _ in range(ROUNDS):
            ours += [identified(log) for _ in range(3)]
            theirs.append(float(subprocess.run([timed, path, "3"], capture_output=True, text=True, check=True).stdout))
        python, rust = min(ours), min(theirs)
        print(f"| `identify`, {SAMPLES} samples; the same in Rust | {python:.4f}; {rust:.4f} s |")
        bars.hold("identify at most 5 % over Rust", python <= 1.05 * rust)
        held = min(with_the_interpreter(log) for _ in range(ROUNDS))
        print(f"| processor time of the calling thread | {100 * held:.2f} % of that of the search |")
        one = min(at_once(lambda: identified(log), 1) for _ in range(ROUNDS))
        two = min(at_once(lambda: identified(log), 2) for _ in range(ROUNDS))
        print(f"| two threads with a search each | {2 * one / two:.2f} times the work of one |")
        bars.hold("two threads 1.8 times one", 2 * one >= 1.8 * two)
        fit = stiction.identify(log, law="lugre", run=stiction.Run(compare_laws=False))
        one = min(at_once(lambda: stepped(fit), 1) for _ in range(ROUNDS))
        two = min(at_once(lambda: stepped(fit), 2) for _ in range(ROUNDS))
        print(f"| two threads that call a law | {2 * one / two:.2f} times the work of one |")
        is_free = not getattr(sys, "_is_gil_enabled", lambda: True)()
        bars.hold("without a lock of the interpreter they do 1.6 times", not is_free or 2 * one >= 1.6 * two)
    growth = kept(10_000)
    print(f"| memory after 10 000 identifications | {growth:+.1f} MB |")
    bars.hold("no growth over 10 000 calls", growth < 10.0)
    return bars.missed


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    missed = main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None)
    if missed:
        sys.exit("missed: " + "; ".join(missed))
