"""LuGre along a known velocity, as fast as a Python user is likely to get it: exponentials by numpy, which takes many
at once, the recursion in a compiled numba loop. On our machine twice as fast as all of it in one numba loop.

Each interval is exact for its mean velocity. The parameters are sigma0, sigma1, sigma2, Fc, Fs - Fc, vs, in SI.
"""

import numba
import numpy as np

NAMES = ("sigma0", "sigma1", "sigma2", "coulomb", "drop", "stribeck_velocity")


@numba.njit(error_model="numpy", fastmath=True)
def _cost(keep, steady, pull, velocity, measured, s0, s1, s2):
    z = 0.0
    total = 0.0
    for k in range(velocity.shape[0]):
        if k > 0:
            z = steady[k - 1] + (z - steady[k - 1]) * keep[k - 1]
        v = velocity[k]
        e = s0 * z + s1 * (v - pull[k] * z) + s2 * v - measured[k]
        total += e * e
    return total


@numba.njit(error_model="numpy", fastmath=True)
def _force(keep, steady, pull, velocity, s0, s1, s2, out):
    z = 0.0
    for k in range(velocity.shape[0]):
        if k > 0:
            z = steady[k - 1] + (z - steady[k - 1]) * keep[k - 1]
        v = velocity[k]
        out[k] = s0 * z + s1 * (v - pull[k] * z) + s2 * v


@numba.njit(error_model="numpy", fastmath=True)
def _slopes(keep, steady, length, pull, level, bell, between, bell_between, velocity, p, out):
    """Derivatives by the logarithms; `bell` is the Stribeck factor, `level` what it gives, at each sample and between."""
    s0, s1, s2, fc, drop, vs = p
    z = 0.0
    dz = np.zeros(6)
    share = np.zeros(6)
    for k in range(velocity.shape[0]):
        v = velocity[k]
        if k > 0:
            # Relative change of the level by Fc, by the drop, by vs.
            m = 0.5 * (velocity[k - 1] + v) / vs
            share[3] = fc / between[k - 1]
            share[4] = drop * bell_between[k - 1] / between[k - 1]
            share[5] = share[4] * 2.0 * m * m
            # sigma0 moves the steady deflection and the length the other way.
            share[0] = -1.0
            far = (z - steady[k - 1]) * keep[k - 1]
            for i in (0, 3, 4, 5):
                rise = steady[k - 1] * share[i]
                dz[i] = rise + (dz[i] - rise) * keep[k - 1] + far * length[k - 1] * share[i]
            z = steady[k - 1] + far
        x = v / vs
        rate = v - pull[k] * z
        share[3] = fc / level[k]
        share[4] = drop * bell[k] / level[k]
        share[5] = share[4] * 2.0 * x * x
        share[0] = -1.0
        for i in (0, 3, 4, 5):
            out[k, i] = (s0 - s1 * pull[k]) * dz[i] + s1 * pull[k] * z * share[i]
        out[k, 0] += s0 * z
        out[k, 1] = s1 * rate
        out[k, 2] = s2 * v


class Model:
    """The law along one velocity."""

    def __init__(self, velocity, step):
        mean = 0.5 * (velocity[1:] + velocity[:-1])
        self.velocity = velocity
        self.square, self.square_between = -velocity * velocity, -mean * mean
        self.speed, self.way = np.abs(velocity), -step * np.abs(mean)
        self.sign = np.sign(mean)

    def _parts(self, p):
        s0, _, _, fc, drop, vs = p
        bell = np.exp(self.square * vs**-2)
        bell_between = np.exp(self.square_between * vs**-2)
        level, between = fc + drop * bell, fc + drop * bell_between
        length = s0 * self.way / between
        keep = np.exp(length)
        steady = between * self.sign * (1.0 / s0)
        pull = s0 * self.speed / level
        return keep, steady, -length, pull, level, bell, between, bell_between

    def cost(self, p, measured):
        """Sum of squares of the residual."""
        keep, steady, _, pull, *_ = self._parts(p)
        return _cost(keep, steady, pull, self.velocity, measured, p[0], p[1], p[2])

    def force(self, p):
        keep, steady, _, pull, *_ = self._parts(p)
        out = np.empty(len(self.velocity))
        _force(keep, steady, pull, self.velocity, p[0], p[1], p[2], out)
        return out

    def slopes(self, p):
        """Derivatives of the force by the logarithms of the parameters, a column each."""
        out = np.empty((len(self.velocity), 6))
        _slopes(*self._parts(p), self.velocity, np.asarray(p, float), out)
        return out

    def check(self, p):
        """The derivatives against central differences."""
        slopes = self.slopes(p)
        for i, name in enumerate(NAMES):
            ends = []
            for h in (1e-6, -1e-6):
                q = np.array(p)
                q[i] *= np.exp(h)
                ends.append(self.force(q))
            numeric = (ends[0] - ends[1]) / 2e-6
            off = np.abs(slopes[:, i] - numeric).max() / np.abs(numeric).max()
            assert off < 1e-6, f"derivative by {name} is off by {off}"
