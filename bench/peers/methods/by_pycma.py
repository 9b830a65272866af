"""pycma, a first deviation of 0.3 of the box about a point drawn at random."""

import cma
import numpy as np


def fmin2(problem, seed):
    start = np.random.default_rng(seed).random(6)
    # A seed of zero would be the clock.
    cma.fmin2(problem.cost, start, 0.3, {"bounds": [0, 1], "seed": seed + 1, "verbose": -9})
