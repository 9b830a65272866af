"""scipy.optimize. Least squares have exact derivatives; a start is drawn at random in the box."""

import numpy as np
from scipy.optimize import differential_evolution, dual_annealing, least_squares

BOX = [(0.0, 1.0)] * 6
# Two descents have come to the same cost within this part.
SAME = 1e-6


def _descend(problem, start):
    return least_squares(problem.residual, start, jac=problem.jacobian, bounds=(0.0, 1.0)).cost


def one_start(problem, seed):
    _descend(problem, np.random.default_rng(seed).random(6))


def starts(problem, seed):
    """One start after the other until the least cost has been found twice."""
    draw = np.random.default_rng(seed)
    best, times = np.inf, 0
    while times < 2:
        cost = _descend(problem, draw.random(6))
        if cost < best * (1.0 - SAME):
            best, times = cost, 1
        elif cost < best * (1.0 + SAME):
            times += 1


def evolution(problem, seed):
    differential_evolution(problem.cost, BOX, rng=seed)


def evolution_then_least_squares(problem, seed):
    """What many end up with by hand."""
    differential_evolution(problem.cost, BOX, rng=seed, maxiter=15, polish=False)
    _descend(problem, problem.where)


def annealing(problem, seed):
    dual_annealing(problem.cost, BOX, rng=seed)
