"""Frozen figures for reference.rs from implementations that are not ours.

    pip install numpy==2.4.6 scipy==1.17.1 cma==4.5.0 pygmo==2.20.0
    python reference.py > reference.txt

The functions, box and target are those of ../common/mod.rs. One line each: method, function, seeds, hits,
median evaluations of the hits until the cost is at most 1e-8.
"""
import warnings

import cma
import numpy as np
import pygmo as pg
from scipy import optimize as so

N, LOW, HIGH, TARGET, BUDGET = 6, -3.1, 5.3, 1e-8, 20000
warnings.filterwarnings("ignore")


def sphere(x):
    return float(np.sum(x * x))


def ellipsoid(x):
    return float(np.sum(10.0 ** (6 * np.arange(N) / (N - 1)) * x * x))


def rosenbrock(x):
    return float(np.sum(100 * (x[1:] - x[:-1] ** 2) ** 2 + (1 - x[:-1]) ** 2))


def rastrigin(x):
    return float(np.sum(x * x + 10 * (1 - np.cos(2 * np.pi * x))))


class Done(Exception):
    pass


class Count:
    def __init__(self, f):
        self.f, self.n, self.hit = f, 0, None

    def __call__(self, x):
        if self.n >= BUDGET:
            raise Done
        self.n += 1
        c = self.f(np.asarray(x, float))
        if c <= TARGET:
            self.hit = self.n
            raise Done
        return c


def de(f, seed):
    so.differential_evolution(f, [(LOW, HIGH)] * N, seed=seed, updating="deferred", polish=False, tol=0, atol=0, maxiter=100000)


def cma_es(f, seed):
    # one run, no restart; the unit cube, as ours
    g = lambda u: f(LOW + np.asarray(u) * (HIGH - LOW))
    cma.fmin2(g, np.full(N, 0.5), 0.3, {"bounds": [0, 1], "seed": seed + 1, "verbose": -9, "maxfevals": BUDGET, "tolfun": 0, "tolfunhist": 0})


class Udp:
    def __init__(self, f):
        self.f = f

    def fitness(self, x):
        return [self.f(x)]

    def get_bounds(self):
        return [LOW] * N, [HIGH] * N

    def __deepcopy__(self, _):
        return self


def pso(f, seed):
    # variant 5: constriction; neighb_type 2, parameter 2: a ring with one neighbour to each side
    population = pg.population(pg.problem(Udp(f)), 50, seed=seed)
    algorithm = pg.algorithm(pg.pso_gen(gen=10000, omega=0.7298437881, eta1=2.05, eta2=2.05, max_vel=1.0, variant=5, neighb_type=2, neighb_param=2, memory=False, seed=seed))
    algorithm.evolve(population)


for name, method, seeds in [("de", de, 20), ("cma-es", cma_es, 100), ("pso", pso, 20)]:
    for function in [sphere, ellipsoid, rosenbrock, rastrigin]:
        hits = []
        for seed in range(seeds):
            f = Count(function)
            try:
                method(f, seed)
            except Done:
                pass
            except Exception as error:  # pygmo wraps what the function raises
                if "Done" not in repr(error) and f.hit is None and f.n < BUDGET:
                    raise
            if f.hit:
                hits.append(f.hit)
        hits.sort()
        print(name, function.__name__, seeds, len(hits), hits[len(hits) // 2] if hits else 0, flush=True)

# No chance in it, so one seed. One simplex from the same corners (the first point of the scrambled Sobol
# sequence of seed 0, edges towards the middle of the box), with the coefficients of Gao and Han.
start = np.array([0.26215362548828125, 0.5368943214416504, 0.7156022787094116, 0.8166725635528564, 0.6779556274414062, 0.9033248424530029])
edges = np.where(start > 0.5, -0.2, 0.2)
corners = np.vstack([start] + [start + edges[j] * np.eye(N)[j] for j in range(N)])
for function in [sphere, ellipsoid, rosenbrock]:
    f = Count(lambda u: function(LOW + u * (HIGH - LOW)))
    try:
        so.minimize(f, start, method="Nelder-Mead", bounds=[(0, 1)] * N, options=dict(adaptive=True, initial_simplex=corners, xatol=0, fatol=0, maxfev=BUDGET))
    except Done:
        pass
    print("nelder-mead", function.__name__, 1, int(f.hit is not None), f.hit or 0)
