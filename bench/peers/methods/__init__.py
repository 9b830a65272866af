"""The peers, each with the settings of its library unless its description says otherwise."""

from . import by_deap, by_pycma, by_pymoo, by_scipy

# Name in the table, what runs it (problem, seed), how many seeds; more where a run is short.
METHODS = (
    ("scipy least_squares, one start", by_scipy.one_start, 30),
    ("scipy least_squares, until two starts agree", by_scipy.starts, 30),
    ("scipy DE, 15 generations, then least_squares", by_scipy.evolution_then_least_squares, 30),
    ("scipy differential_evolution", by_scipy.evolution, 10),
    ("scipy dual_annealing", by_scipy.annealing, 10),
    ("pycma fmin2", by_pycma.fmin2, 10),
    ("pymoo GA", by_pymoo.ga, 10),
    ("pymoo DE", by_pymoo.de, 10),
    ("pymoo PSO", by_pymoo.pso, 10),
    ("DEAP GA", by_deap.ga, 10),
)
