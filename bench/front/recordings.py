"""The measured recordings behind README's first table, as columns in SI, and what was published with them."""

import os
from pathlib import Path
from typing import NamedTuple

import environment
import numpy as np
import scipy.io

DATA = Path(os.environ.get("STICTION_DATA", environment.ROOT.parent / "shared/data"))


class Published(NamedTuple):
    """Coulomb and viscous friction, with inertia and offset where they were published too."""

    coulomb: float
    viscous: float
    inertia: float | None
    offset: float | None


class Recording(NamedTuple):
    """A log of one axis; the unit of the force is that of its log."""

    name: str
    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray | None
    force: np.ndarray
    units: tuple[str, str]
    # The force of gravity follows sine and cosine of the position.
    gravity: bool
    published: Published | None

    def part(self, first, last):
        """The samples from one share of the log to another."""
        a, b = (int(share * len(self.time)) for share in (first, last))
        cut = [None if x is None else x[a:b] for x in self[1:5]]
        return self._replace(time=cut[0] - cut[0][0], position=cut[1], velocity=cut[2], force=cut[3])

    def columns(self):
        """As stiction takes them."""
        length, force = self.units
        named = {"t [s]": self.time, f"position [{length}]": self.position, f"force [{force}]": self.force}
        if self.velocity is not None:
            named[f"velocity [{length}/s]"] = self.velocity
        return named


def emps():
    """Ball screw axis; Janot, Gautier, Brunot 2019. The force is the voltage times a published gain."""
    log = scipy.io.loadmat(DATA / "emps/DATA_EMPS.mat")
    t, x, u = (log[name].ravel() for name in ("t", "qm", "vir"))
    force = float(log["gtau"].item()) * u
    published = Published(20.3935, 203.5034, 95.1089, -3.1648)
    return Recording("EMPS ball screw", t, x, None, force, ("m", "N"), False, published)


def ur10e(joint, crop, coulomb, viscous, gain):
    """A joint of a UR10e without approach and rest; Mamedov and Mikhel 2020. Friction was published in N m, beside the gain
    of the current."""
    log = np.loadtxt(DATA / f"ur10e/joint_{joint}.csv", delimiter=",")
    log[:, 0] -= log[0, 0]
    log = log[(log[:, 0] >= crop[0]) & (log[:, 0] <= crop[1])]
    t, x, v, i = (log[:, k] for k in (0, joint, 6 + joint, 12 + joint))
    published = Published(coulomb / gain, viscous / gain, None, None)
    return Recording(f"UR10e joint {joint}", t, x, v, i, ("rad", "A"), joint == 4, published)


def servo():
    """Seven repeats of one test of an AC servo axis."""
    def repeat(k):
        log = np.loadtxt(DATA / f"servo/sliding_{k}.txt")
        t = 1e-3 * np.arange(len(log))
        return Recording(f"servo, run {k}", t, log[:, 0], None, log[:, 4], ("rad", "N m"), False, None)

    return [repeat(k) for k in range(1, 8)]


AXES = (
    emps,
    lambda: ur10e(1, (3.0, 60.0), 12.548, 21.256, 10.0),
    lambda: ur10e(4, (6.4, 61.4), 1.998, 3.575, 9.0029),
)
