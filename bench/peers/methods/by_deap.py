"""DEAP, which has no defaults: its (mu + lambda) algorithm, 100 of each, with bounded simulated binary crossover
(eta 15), bounded polynomial mutation (eta 20) and tournaments of three, on until the evaluations are used up."""

import random

from deap import algorithms, base, creator, tools

SIZE = 100

creator.create("Least", base.Fitness, weights=(-1.0,))
creator.create("Six", list, fitness=creator.Least)


def ga(problem, seed):
    random.seed(seed)
    box = base.Toolbox()
    box.register("six", tools.initRepeat, creator.Six, random.random, 6)
    box.register("evaluate", lambda six: (problem.cost(six),))
    box.register("mate", tools.cxSimulatedBinaryBounded, eta=15.0, low=0.0, up=1.0)
    box.register("mutate", tools.mutPolynomialBounded, eta=20.0, low=0.0, up=1.0, indpb=1.0 / 6.0)
    box.register("select", tools.selTournament, tournsize=3)
    population = [box.six() for _ in range(SIZE)]
    algorithms.eaMuPlusLambda(
        population, box, mu=SIZE, lambda_=SIZE, cxpb=0.7, mutpb=0.3, ngen=problem.left, verbose=False
    )
