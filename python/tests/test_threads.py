"""Threads that share what the package gives them; on a free-threaded Python they are at it at the same time."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy
import stiction
from conftest import quietly

THREADS = 4
FREE = os.environ.get("STICTION_FREE_THREADED") == "1"
"""Whether the tests are to run without the lock of the interpreter."""


def together(work: Callable[[], Any]) -> list[Any]:
    """What each of several threads gets that begin at the same moment; an error of one is raised."""
    begin = threading.Barrier(THREADS, timeout=60)
    found: list[Any] = []
    failed: list[BaseException] = []

    def one() -> None:
        try:
            begin.wait()
            found.append(work())
        except BaseException as error:  # noqa: BLE001: it is raised below
            failed.append(error)

    def all_of_them() -> None:
        threads = [threading.Thread(target=one) for _ in range(THREADS)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    # Warnings are those of the whole process: silenced around all, not within.
    quietly(all_of_them)
    if failed:
        raise failed[0]
    return found


def same(a: stiction.Fit, b: stiction.Fit) -> bool:
    """Whether two fits agree in every bit."""
    return a.parameters.rows == b.parameters.rows and numpy.array_equal(a.residual, b.residual)


def locked() -> bool:
    """Whether the interpreter runs one thread at a time."""
    return bool(getattr(sys, "_is_gil_enabled", lambda: True)())


def test_importing_leaves_the_lock_of_the_interpreter_as_it_is() -> None:
    """A native half that does not say that it needs none would bring it back, for the whole process."""
    line = (
        "import sys; lock = getattr(sys, '_is_gil_enabled', lambda: True); before = lock(); "
        "import numpy, stiction; print(before, lock())"
    )
    done = subprocess.run([sys.executable, "-W", "error", "-c", line], capture_output=True, text=True, check=True)
    before, after = done.stdout.split()
    assert before == after
    assert not (FREE and locked())


def test_a_log_is_identified_by_several_threads_at_once(run_csv: Path, arrays: dict[str, Any], fit: stiction.Fit) -> None:
    options: Any = {"law": "lugre", "run": stiction.Run(compare_laws=False, threads=1)}
    log = quietly(stiction.read_log, run_csv)
    assert all(same(found, fit) for found in together(lambda: stiction.identify(log, **options)))
    # Columns that are read by all of them.
    alone = quietly(stiction.identify, arrays, **options)
    assert all(same(found, alone) for found in together(lambda: stiction.identify(arrays, **options)))


def test_a_fit_is_used_by_several_threads_at_once(run_csv: Path, tmp_path: Path) -> None:
    log = quietly(stiction.read_log, run_csv)
    shared: stiction.Fit = quietly(stiction.identify, log, law="lugre", run=stiction.Run(compare_laws=False))
    folders: list[Path] = []

    def use() -> tuple[Any, ...]:
        folder = tmp_path / str(threading.get_ident())
        folders.append(folder)
        shared.save(folder)
        again: stiction.Fit = pickle.loads(pickle.dumps(shared))
        predicted = shared.predict(log)
        study = shared.simulate(run=stiction.Run(threads=1))
        code = shared.export("c", folder / "code", cycle_time=250e-6)
        return (
            shared.result,
            again.result,
            predicted.residual.tobytes(),
            shared.residual.tobytes(),
            study.rows,
            [file.read_bytes() for file in code.files],
        )

    first, *others = together(use)
    assert all(other == first for other in others)
    assert len(set(folders)) == THREADS
    assert len({(folder / "model.toml").read_bytes() for folder in folders}) == 1


def test_a_law_that_threads_share_takes_their_samples_one_after_the_other(fit: stiction.Fit) -> None:
    """Whichever comes first: samples of the same velocity, so that their order says nothing."""
    shared, alone = fit.law, fit.law
    samples = 5000

    def step() -> None:
        for _ in range(samples):
            shared(1e-4, 1e-4)

    together(step)
    for _ in range(THREADS * samples):
        alone(1e-4, 1e-4)
    assert (shared.force, shared.state) == (alone.force, alone.state)


def test_an_array_goes_through_a_shared_law_in_one_piece(fit: stiction.Fit) -> None:
    """Each array ends in a long slide, so that each finds the law as the one before it did."""
    shared, alone = fit.law, fit.law
    velocity = numpy.concatenate([0.05 * numpy.sin(numpy.arange(3000) * 5e-3), numpy.full(20_000, 0.2)])
    alone.steps(velocity, 1e-3)
    expected = alone.steps(velocity, 1e-3)
    shared.steps(velocity, 1e-3)
    for forces in together(lambda: [shared.steps(velocity, 1e-3) for _ in range(20)]):
        for force in forces:
            numpy.testing.assert_array_equal(force, expected)


def test_a_law_is_looked_at_while_it_runs(fit: stiction.Fit) -> None:
    """Force and state that are of one sample, resets and pickles: nothing is refused because another thread has the law."""
    shared = fit.law
    time = numpy.arange(1000) * 1e-3
    velocity = 0.05 * numpy.sin(40.0 * time)
    along = shared.record(time, velocity)
    doings: list[Callable[[], Any]] = [
        lambda: shared(0.01, 1e-3),
        lambda: shared.steps(velocity, 1e-3),
        lambda: (shared.force, shared.state),
        lambda: pickle.loads(pickle.dumps(shared)),
        shared.reset,
    ]

    def look() -> bool:
        for _ in range(100):
            for doing in doings:
                doing()
        return numpy.array_equal(shared.record(time, velocity), along)

    assert together(look) == [True] * THREADS
