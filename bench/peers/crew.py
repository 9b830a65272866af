"""Runs of the peers, two at a time, each in a process of its own."""

import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

# Evaluations of a run that only imports and compiles, before the clock runs.
WARM = 300

problems = {}
warm = set()


def prepare(logs, most):
    """Makes the problems of one process."""
    from problem import Problem

    for name, (file, box, truth) in logs.items():
        problems[name] = Problem(file, box, truth, most)


def run(log, index, seed, deadline):
    """One method with one seed; `None` when it is too late to begin."""
    from methods import METHODS
    from problem import Spent

    if time.time() > deadline:
        return None
    _, method, _ = METHODS[index]
    problem = problems[log]
    if index not in warm:
        warm.add(index)
        problem.begin(WARM)
        try:
            method(problem, seed)
        except Spent:
            pass
    problem.begin()
    try:
        method(problem, seed)
    except Spent:
        pass
    success = problem.found_at is not None
    return {
        "success": success,
        "excess": problem.best / problem.optimum - 1.0,
        "seconds": problem.found_at if success else problem.seconds(),
        "evaluations": problem.found_after if success else problem.count,
    }


def optimum(log):
    return problems[log].optimum


def work(logs, most, minutes):
    """Optimum of every log, and runs by log and method: short ones first, then in turn, so that a deadline cuts all of
    the long ones."""
    from methods import METHODS

    deadline = time.time() + 60.0 * minutes
    tasks = [
        (log, index, seed)
        for index, (_, _, count) in enumerate(METHODS)
        for seed in range(count)
        for log in logs
    ]
    tasks.sort(key=lambda task: (-METHODS[task[1]][2], task[2]))
    pool = ProcessPoolExecutor(
        min(2, os.cpu_count()), mp_context=get_context("spawn"), initializer=prepare, initargs=(logs, most)
    )
    with pool:
        least = {log: pool.submit(optimum, log) for log in logs}
        futures = [(task, pool.submit(run, *task, deadline)) for task in tasks]
        found = {log: {name: [] for name, _, _ in METHODS} for log in logs}
        for done, ((log, index, _), future) in enumerate(futures):
            result = future.result()
            if result is not None:
                found[log][METHODS[index][0]].append(result)
            if done % 20 == 19:
                print(f"    {done + 1} of {len(futures)} runs", file=sys.stderr)
    return {log: future.result() for log, future in least.items()}, found
