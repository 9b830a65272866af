#!/usr/bin/env python3
"""stiction beside the searches that a Python user would take, on the same logs, in the same box, for the same optimum.

    python3 bench/peers/compare.py [EVALUATIONS MINUTES]
"""

import sys

import machine  # before what is not in the standard library: it enters the environment and sets the threads

import crew
import stiction
from methods import METHODS
from problem import FOUND
from table import expected, number, table

AXES = ("C95", "machine")
RATE = 2000
# Evaluations of a run, the same for all.
MOST = 20_000
# No run of a peer begins later than this.
MINUTES = 7.0
# Optima of two models of the same law may differ by this part, far less than what counts as found.
AGREE = 1e-5


def section(log, ours, file, theirs, optimum, minutes):
    """Heading, table and remarks of one axis."""
    off = abs(optimum / file["reference"]["cost"] - 1.0)
    assert off < AGREE, f"{log}: the optima differ by {off}"
    annealing = ours["annealing-ga"]
    remarks = [
        f"Optima of both models: the same to {off:.0e}.",
        f"annealing-ga without its least squares: {sum(run['alone'] for run in annealing)} of {len(annealing)}.",
    ]
    thinned = expected(ours["separable"], "thinned")
    if thinned:
        remarks.append(f"separable: {number(thinned)} evaluations of a thinned record besides.")
    if any(len(theirs[name]) < wanted for name, _, wanted in METHODS):
        remarks.append(f"No run of a peer was begun after {minutes:g} minutes.")
    return f"{log}, {file['samples']} samples:\n\n{table(ours, theirs)}\n\n{' '.join(remarks)}"


def main():
    most = int(sys.argv[1]) if len(sys.argv) > 1 else MOST
    minutes = float(sys.argv[2]) if len(sys.argv) > 2 else MINUTES
    programs = stiction.build()
    logs = {name: stiction.Log(name, RATE, programs) for name in AXES}
    ours, files = {}, {}
    for name, log in logs.items():
        ours[name], files[name] = log.searches(most)
        ours[name]["separable"] = log.commands(files[name]["reference"]["cost"], FOUND)
    given = {name: (log.file, files[name]["bounds"], log.truth) for name, log in logs.items()}
    optima, theirs = crew.work(given, most, minutes)
    about = machine.described("numpy", "numba", "scipy", "cma", "pymoo", "deap")
    parts = [section(name, ours[name], files[name], theirs[name], optima[name], minutes) for name in AXES]
    text = "\n\n".join([f"{about}.", *parts])
    print(text)


if __name__ == "__main__":
    main()
