"""pymoo, on until the evaluations are used up."""

from pymoo.algorithms.soo.nonconvex.de import DE
from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.algorithms.soo.nonconvex.pso import PSO
from pymoo.core.problem import ElementwiseProblem
from pymoo.optimize import minimize


class _Six(ElementwiseProblem):
    def __init__(self, problem):
        super().__init__(n_var=6, n_obj=1, xl=0.0, xu=1.0)
        self.problem = problem

    def _evaluate(self, x, out, *_, **__):
        out["F"] = self.problem.cost(x)


def _run(problem, seed, algorithm):
    minimize(_Six(problem), algorithm, ("n_eval", problem.left), seed=seed, verbose=False)


def ga(problem, seed):
    _run(problem, seed, GA())


def de(problem, seed):
    _run(problem, seed, DE())


def pso(problem, seed):
    _run(problem, seed, PSO())
