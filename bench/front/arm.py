"""A whole robot: the UR10 of the recordings by inverse dynamics and weighted least squares, as Pinocchio's regressor and numpy
give it, beside `stiction.robot`. First half fitted, second half tested, torques below 5 Hz."""

import sqlite3
import struct
from pathlib import Path

import numpy as np
import pinocchio
import scipy.signal as signal
import stiction
from recordings import DATA

BAG = DATA / "robots/ur10_panda/ur10.db3"
ROBOTS = Path(pinocchio.__file__).parents[4] / "share/example-robot-data/robots"
URDF = ROBOTS / "ur_description/urdf/ur10_robot.urdf"
# Hz, of the motion and of torques and regressor.
MOTION, COMMON = 20.0, 5.0
# Of 125 Hz: one sample for each period of what is left.
EVERY = 10


def joint_states():
    """Times and the joints' positions, velocities and efforts, in the order of the URDF."""
    with sqlite3.connect(f"file:{BAG}?mode=ro", uri=True) as bag:
        rows = [row for (row,) in bag.execute("select data from messages order by timestamp")]
    names = list(pinocchio.buildModelFromUrdf(str(URDF)).names)[1:]
    return np.array([message(row, names) for row in rows])


def message(data, order):
    """Stamp and three lists of one sensor_msgs/JointState in CDR, little endian."""
    place = 4

    def take(form):
        nonlocal place
        size = struct.calcsize(form)
        place += -(place - 4) % min(size, 8)
        value = struct.unpack_from("<" + form, data, place)[0]
        place += size
        return value

    def text():
        nonlocal place
        n = take("I")
        place += n
        return data[place - n : place - 1].decode()

    seconds, nanoseconds = take("i"), take("I")
    text()
    names = [text() for _ in range(take("I"))]
    lists = []
    for _ in range(3):
        values = [take("d") for _ in range(take("I"))]
        lists += [values[names.index(name)] for name in order]
    return [seconds + 1e-9 * nanoseconds, *lists]


def regressor(model, q, v, a):
    """Rigid body, armature, Coulomb and viscous friction and offset: samples x joints x parameters."""
    data = model.createData()
    n = model.nv
    rows = []
    for sample in zip(q, v, a):
        rigid = pinocchio.computeJointTorqueRegressor(model, data, *sample)
        own = [np.diag(x) for x in (sample[2], np.sign(sample[1]), sample[1], np.ones(n))]
        rows.append(np.hstack([rigid, *own]))
    return np.array(rows)


def by_pinocchio():
    """Residual of each joint on the second half, rms, N m."""
    model = pinocchio.buildModelFromUrdf(str(URDF))
    log = joint_states()
    n = model.nv
    t = log[:, 0] - log[0, 0]
    rate = (len(t) - 1) / t[-1]
    motion = signal.butter(4, MOTION, fs=rate, output="sos")
    common = signal.butter(4, COMMON, fs=rate, output="sos")
    even = np.arange(len(t)) / rate
    q, v, torque = (
        np.column_stack([np.interp(even, t, log[:, 1 + k * n + j]) for j in range(n)]) for k in range(3)
    )
    q = signal.sosfiltfilt(motion, q, axis=0)
    v = signal.sosfiltfilt(motion, v, axis=0)
    a = np.gradient(v, 1.0 / rate, axis=0)
    y = signal.sosfiltfilt(common, regressor(model, q, v, a), axis=0)[::EVERY]
    torque = signal.sosfiltfilt(common, torque, axis=0)[::EVERY]
    half = len(y) // 2
    weights = np.ones(n)
    # Weighted by the residuals of the fit before.
    for _ in range(3):
        x = np.linalg.lstsq(
            (y[:half] * weights[:, None]).reshape(-1, y.shape[2]), (torque[:half] * weights).ravel(), rcond=1e-6
        )[0]
        weights = 1.0 / np.sqrt(np.mean((y[:half] @ x - torque[:half]) ** 2, axis=0))
    return np.sqrt(np.mean((y[half:] @ x - torque[half:]) ** 2, axis=0))


def by_stiction():
    """The same of `stiction.robot` without options."""
    found = stiction.robot(BAG, urdf=URDF, split=0.5).result
    assert found["conditioning"]["common_cutoff_hz"] == COMMON
    return np.array([joint["fit"]["held_out_rms"] for joint in found["joints"]])
