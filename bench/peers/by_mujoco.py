"""MuJoCo's own way: LuGre of its dcmotor along the same velocity by mujoco.rollout, fitted by mujoco.minimize.least_squares, which
is what mujoco.sysid calls. The velocity comes of a mass of 1e6 kg on a spring, which friction does not move."""

import copy
import time

import mujoco
import numpy as np
from mujoco import minimize, rollout

MASS = 1e6
OMEGA = 2 * np.pi
# Starts; one takes seconds.
STARTS = 3

XML = f"""<mujoco><option timestep="{{step}}" gravity="0 0 0" integrator="implicitfast"><flag contact="disable" constraint="disable"/></option>
<worldbody><body><joint name="x" type="slide" axis="1 0 0" stiffness="{MASS * OMEGA**2}"/><geom type="sphere" size=".01" mass="{MASS}"/></body></worldbody>
<actuator><dcmotor name="f" joint="x" input="none" motorconst="0" resistance="1" damping="0" lugre="1e5 600 20 30 5e-3"/></actuator>
<sensor><actuatorfrc actuator="f"/><jointvel joint="x"/></sensor></mujoco>"""


class Slider:
    """Force along the sine for parameters in the order of `model.NAMES`; sigma2 is not among those of dcmotor."""

    def __init__(self, amplitude, step, samples):
        self.model = mujoco.MjModel.from_xml_string(XML.format(step=step))
        self.data = [mujoco.MjData(self.model)]
        self.data[0].qpos[0] = -amplitude / OMEGA
        kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
        self.start = np.empty(mujoco.mj_stateSize(self.model, kind))
        mujoco.mj_getState(self.model, self.data[0], self.start, kind)
        self.samples = samples
        self.rollouts = 0

    def force(self, p):
        """Force at each sample."""
        s0, s1, s2, level, drop, vs = p
        model = copy.copy(self.model)
        model.actuator_dynprm[0, 5:7] = s0, s1
        model.actuator_biasprm[0, 3:6] = level, level + drop, vs
        _, sensors = rollout.rollout(model, self.data, self.start[None], nstep=self.samples)
        self.rollouts += 1
        sensors = np.asarray(sensors)[0]
        return -sensors[:, 0] + s2 * sensors[:, 1]


def identify(amplitude, step, force, starts, bounds):
    """Least ms of a start and how it ended, beside the others."""
    slider = Slider(amplitude, step, len(force))

    def residual(x):
        columns = np.atleast_2d(np.asarray(x).T)
        return np.array([slider.force(np.exp(c)) - force for c in columns]).T

    runs = []
    for start in starts[:STARTS]:
        before = time.perf_counter()
        found, _ = minimize.least_squares(start, residual, bounds=bounds, verbose=minimize.Verbosity.SILENT, max_iter=100)
        runs.append((time.perf_counter() - before, float(np.sum(residual(np.ravel(found))[:, 0] ** 2))))
    least = min(cost for _, cost in runs)
    seconds, cost = min(run for run in runs if run[1] <= least * 1.001)
    return 1e3 * seconds, cost
