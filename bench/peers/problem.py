"""What every peer works on: six parameters in a box, by their logarithms, a counted cost and a clock."""

import time

import numpy as np
from model import Model
from scipy.optimize import least_squares

# A cost counts as the optimum if it is above it by no more than this part.
FOUND = 1e-4


class Spent(Exception):
    """The evaluations are used up."""


class Problem:
    """One log with a box. Points are in the unit cube; the cost is the square of the relative error."""

    def __init__(self, log, box, truth, most):
        time_s, velocity, self.force = np.loadtxt(log, delimiter=",", skiprows=1, unpack=True)
        self.model = Model(velocity, time_s[1] - time_s[0])
        self.energy = float(self.force @ self.force)
        low, high = np.log(np.array(box).T)
        self.low, self.width = low, high - low
        self.most = most
        self.optimum = None
        self.begin()
        self.model.check(truth)
        start = (np.log(truth) - self.low) / self.width
        best = least_squares(
            self.residual, start, jac=self.jacobian, bounds=(0.0, 1.0), xtol=1e-14, ftol=1e-14, gtol=1e-14
        )
        self.optimum = 2.0 * best.cost

    def begin(self, most=None):
        """Starts the clock, processor time of this process, and counts from nothing."""
        self.left = self.most if most is None else most
        self.count = 0
        self.best, self.where = np.inf, None
        self.found_after = self.found_at = None
        self.clock = time.process_time()

    def seconds(self):
        return time.process_time() - self.clock

    def parameters(self, point):
        return np.exp(self.low + np.clip(point, 0.0, 1.0) * self.width)

    def _take(self):
        if self.optimum is None:
            return
        if self.count >= self.left:
            raise Spent
        self.count += 1

    def _note(self, cost, point):
        if cost < self.best:
            self.best, self.where = cost, np.array(point)
            if self.found_at is None and self.optimum is not None and cost <= self.optimum * (1.0 + FOUND):
                self.found_at, self.found_after = self.seconds(), self.count

    def cost(self, point):
        self._take()
        cost = self.model.cost(self.parameters(point), self.force) / self.energy
        self._note(cost, point)
        return cost

    def residual(self, point):
        """Counts as one evaluation; its sum of squares is the cost."""
        self._take()
        out = (self.model.force(self.parameters(point)) - self.force) / np.sqrt(self.energy)
        self._note(float(out @ out), point)
        return out

    def jacobian(self, point):
        """Counts as one evaluation too."""
        self._take()
        return self.model.slopes(self.parameters(point)) * (self.width / np.sqrt(self.energy))
