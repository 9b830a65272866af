"""What a user of scipy would write: zero-phase filter, derivatives, a static law by least squares, intervals from its
covariance."""

import numpy as np
import scipy.signal as signal
from scipy.optimize import least_squares

# Hz, of the recipe that was published with EMPS.
CUTOFF = 100.0
# Samples at each end where that filter is not settled, as in the same recipe.
EDGE = 49


def derivatives(log):
    """Filtered velocity and acceleration at the samples of a log."""
    rate = (len(log.time) - 1) / (log.time[-1] - log.time[0])
    sections = signal.butter(4, min(CUTOFF, 0.2 * rate), fs=rate, output="sos")
    if log.velocity is None:
        velocity = np.gradient(signal.sosfiltfilt(sections, log.position), log.time)
    else:
        velocity = signal.sosfiltfilt(sections, log.velocity)
    return velocity, np.gradient(velocity, log.time)


def linear(log, acceleration):
    """Columns beside friction: inertia, offset, gravity."""
    columns = [acceleration, np.ones_like(acceleration)]
    if log.gravity:
        columns += [np.sin(log.position), np.cos(log.position)]
    return np.column_stack(columns)


class Published:
    """Published friction; what was not published beside it is fitted."""

    def __init__(self, log):
        law = log.published
        velocity, acceleration = derivatives(log)
        self.friction = lambda v: law.coulomb * np.sign(v) + law.viscous * v
        if law.inertia is None:
            left = log.force - self.friction(velocity)
            self.beside = np.linalg.lstsq(linear(log, acceleration), left, rcond=None)[0]
        else:
            self.beside = np.array([law.inertia, law.offset])

    def predict(self, log):
        """Force at the samples of a log."""
        velocity, acceleration = derivatives(log)
        return self.friction(velocity) + linear(log, acceleration) @ self.beside


class Stribeck:
    """Coulomb, Stribeck and viscous friction by scipy's least_squares: nonlinear in the Stribeck velocity alone to begin
    with, from several starts, the best of them kept."""

    STARTS = (0.01, 0.03, 0.1, 0.3)

    def __init__(self, log):
        velocity, acceleration = derivatives(log)
        beside = linear(log, acceleration)
        inner = slice(EDGE, -EDGE)
        v, beside, force = velocity[inner], beside[inner], log.force[inner]
        top = np.abs(v).max()

        def columns(p):
            return np.column_stack([self.shapes(v, p), beside])

        def residual(p):
            c = columns(p)
            return c @ np.linalg.lstsq(c, force, rcond=None)[0] - force

        bounds = ([np.log(1e-3 * top)], [np.log(top)])
        runs = [least_squares(residual, [np.log(s * top)], bounds=bounds) for s in self.STARTS]
        self.p = min(runs, key=lambda run: run.cost).x
        c = columns(self.p)
        self.x = np.linalg.lstsq(c, force, rcond=None)[0]
        # The textbook's covariance: white residuals.
        variance = np.mean(residual(self.p) ** 2)
        self.covariance = variance * np.linalg.inv(c.T @ c)

    @staticmethod
    def shapes(v, p):
        """Coulomb, Stribeck, viscous."""
        sign = np.sign(v)
        return np.column_stack([sign, np.exp(-((v / np.exp(p[0])) ** 2)) * sign, v])

    def friction(self, speed):
        """Friction at a speed, and half of its 95 % interval."""
        row = self.shapes(np.array([speed]), self.p)[0]
        n = len(row)
        return row @ self.x[:n], 1.96 * np.sqrt(row @ self.covariance[:n, :n] @ row)

    def predict(self, log):
        """Force at the samples of a log."""
        velocity, acceleration = derivatives(log)
        return np.column_stack([self.shapes(velocity, self.p), linear(log, acceleration)]) @ self.x
