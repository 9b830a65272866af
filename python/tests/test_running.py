"""While Rust works: other threads run, Ctrl-C stops it, progress is told."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import tomllib
import warnings
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction
from conftest import quietly
from stiction import Progress, Run, StictionWarning
from test_same_bits import LIMITED

LONG: dict[str, Any] = {
    "law": "lugre",
    "method": "ga",
    "search": stiction.Search(cost="separable", evaluations=10**9, target=1e-30),
}
"""A search that does not end by itself."""


def test_progress_is_told(run_csv: Path) -> None:
    seen: list[Progress] = []
    quietly(stiction.identify, run_csv, law="lugre", run=stiction.Run(compare_laws=False, progress=seen.append))
    assert seen
    assert all(0.0 <= p.fraction <= 1.0 and p.stage for p in seen)


def test_progress_that_says_false_stops_and_keeps_the_best(run_csv: Path, tmp_path: Path) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        fit = stiction.identify(run_csv, run=Run(progress=lambda p: p.error is None), **LONG)
    assert "interrupted" in [w.message.code for w in caught if isinstance(w.message, StictionWarning)]
    assert fit.parameters["coulomb"].value > 0.0
    assert fit.verdict == "interrupted"
    # It does not take the place of a complete one.
    complete = quietly(stiction.identify, run_csv, law="stribeck", run=stiction.Run(compare_laws=False))
    complete.save(tmp_path / "fit")
    written = fit.save(tmp_path / "fit")
    assert {path.parent.name for path in written} == {"fit-interrupted"}
    assert stiction.load(tmp_path / "fit").parameters.rows == complete.parameters.rows


def test_an_error_of_the_one_who_is_told_comes_back(run_csv: Path) -> None:
    def fails(_: Progress) -> None:
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        quietly(stiction.identify, run_csv, run=Run(progress=fails), **LONG)


def test_two_threads_are_at_work_at_once(run_csv: Path) -> None:
    """Each search goes on until it has seen the other one at work: with the interpreter held neither would end."""
    both = threading.Barrier(2, timeout=120)
    found: list[str] = []

    def work() -> None:
        met = False

        def told(p: Progress) -> bool:
            nonlocal met
            if not met and p.error is not None:
                both.wait()
                met = True
            return not met

        fit = stiction.identify(run_csv, run=Run(progress=told, threads=1), **LONG)
        found.append(fit.verdict)

    threads = [threading.Thread(target=work) for _ in range(2)]
    # Warnings are those of the whole process: silenced around both, not within.
    def together() -> None:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    quietly(together)
    assert found == ["interrupted"] * 2


def test_python_runs_while_rust_works(run_csv: Path) -> None:
    """Another thread ends the search, which it could not with the interpreter held and nobody told."""
    counted = 0
    go_on = True

    def told(_: Progress) -> bool:
        return go_on

    def count() -> None:
        nonlocal counted, go_on
        while counted < 100_000:
            counted += 1
        go_on = False

    thread = threading.Thread(target=count)
    thread.start()
    quietly(stiction.identify, run_csv, run=Run(progress=told), **LONG)
    thread.join()
    assert counted == 100_000


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
def test_a_process_that_was_forked_works(run_csv: Path, fit: stiction.Fit) -> None:
    """It has none of the threads that the first one has."""
    with quietly(concurrent.futures.ProcessPoolExecutor, 1, mp_context=multiprocessing.get_context("fork")) as pool:
        done = quietly(pool.submit, forked, run_csv)
        assert done.result(timeout=120) == fit.parameters.rows


def forked(path: Path) -> list[stiction.Parameter]:
    found: stiction.Fit = quietly(stiction.identify, path, law="lugre", run=stiction.Run(compare_laws=False))
    return found.parameters.rows


INTERRUPTED = """
import signal, sys, warnings
import stiction
warnings.simplefilter("ignore")
# Where it is started in the background signals are ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
said = False
def told(p):
    global said
    if p.error is not None and not said:
        said = True
        print("searching", flush=True)
search = stiction.Search(cost="separable", evaluations=10**9, target=1e-30)
fit = stiction.identify(sys.argv[1], law="lugre", method="ga", search=search, run=stiction.Run(progress=told))
print(fit.verdict, fit.parameters["coulomb"].value > 0.0)
"""


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_stops_and_keeps_the_best(run_csv: Path) -> None:
    words = [sys.executable, "-c", INTERRUPTED, str(run_csv)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "searching\n"
        process.send_signal(signal.SIGINT)
        assert process.stdout.read() == "interrupted True\n"
    assert process.returncode == 0


def test_a_study_that_is_stopped_says_so(fit: stiction.Fit, tmp_path: Path) -> None:
    with pytest.warns(StictionWarning, match=r"\[interrupted\]"):
        study = fit.simulate(run=Run(progress=lambda p: False))
    assert study.verdict == "interrupted" and "interrupted" in [code for code, _ in study.warnings]
    assert "interrupted" in [code for code, _ in pickle.loads(pickle.dumps(study)).warnings]
    study.save(tmp_path / "study")
    assert '"status": "interrupted"' in (tmp_path / "study" / "study.json").read_text()


def test_a_plan_that_is_stopped_before_there_is_a_motion_is_a_keyboard_interrupt() -> None:
    with pytest.raises(KeyboardInterrupt):
        stiction.plan(tomllib.loads(LIMITED), run=Run(progress=lambda p: False))


def test_a_line_of_progress_is_for_terminals(run_csv: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    how: dict[str, Any] = {"law": "lugre", "run": Run(compare_laws=False, progress=True)}
    quietly(stiction.identify, run_csv, **how)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    quietly(stiction.identify, run_csv, **how)
    assert "%" in capsys.readouterr().err


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_where_there_is_nothing_to_keep_is_a_keyboard_interrupt(run_csv: Path) -> None:
    script = """
import os, signal, sys
import stiction
signal.signal(signal.SIGINT, signal.default_int_handler)
told = lambda p: os.kill(os.getpid(), signal.SIGINT)
try:
    stiction.check(sys.argv[1], run=stiction.Run(progress=told))
except KeyboardInterrupt:
    print("stopped")
"""
    words = [sys.executable, "-c", script, str(run_csv)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout == "stopped\n"


FOLLOWED = """
import os, signal, sys, threading, time
import drift_rows, stiction
signal.signal(signal.SIGINT, signal.default_int_handler)
# A log every ten minutes: quiet machines of a thousand logs are simulated, for each of five parameters.
drift_rows.DAY = 600.0
rows = drift_rows.rows()
for row in rows:
    [only] = row["parameters"]
    row["parameters"] = [{**only, "parameter": f"p{k}"} for k in range(5)]
threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
begin = time.monotonic()
try:
    stiction.drift(rows)
except KeyboardInterrupt:
    print("stopped", time.monotonic() - begin < 1.3)
"""


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_ends_what_is_followed_at_once() -> None:
    """Which takes more than ten seconds else."""
    here = dict(os.environ, PYTHONPATH=str(Path(__file__).parent))
    done = subprocess.run([sys.executable, "-c", FOLLOWED], capture_output=True, text=True, check=True, env=here)
    assert done.stdout == "stopped True\n"


def test_nothing_is_kept_of_many_calls(arrays: dict[str, Any]) -> None:
    """The memory of the process does not grow with the number of calls."""
    resource = pytest.importorskip("resource")
    log = quietly(stiction.read_log, {name: values[:4000] for name, values in arrays.items()})
    law = quietly(stiction.identify, log, law="coulomb-viscous", run=stiction.Run(compare_laws=False)).law
    velocity = numpy.zeros(20_000)

    def peak() -> int:
        for _ in range(200):
            _ = log.force
            law.steps(velocity, 1e-3)
        return int(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)

    first = peak()
    assert peak() - first < 8_000, "kB; each round makes 38 MB of arrays"
