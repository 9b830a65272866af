"""Replays the second half of a recording in MuJoCo over short windows, driven by the measured torques.

    python replay.py BAG.db3 EXPORT NAME URDF

EXPORT is a folder of `stiction export --target mujoco`, NAME that of its files. Prints the position error, rad rms over all joints and
windows, with what was identified, with the URDF as it was given, and with what was identified but no friction.
"""
import importlib
import os
import sqlite3
import struct
import sys
import xml.etree.ElementTree as ElementTree
import mujoco
import numpy

BAG, EXPORT, NAME, URDF = sys.argv[1:]
WINDOW = 0.1  # s
STEPS = 4  # of a sample


class Reader:
    """Values of a message in CDR, little endian, aligned from behind its header of four bytes."""

    def __init__(self, data):
        self.data, self.at = data, 4

    def take(self, form, size):
        self.at = 4 + -(-(self.at - 4) // size) * size
        (value,) = struct.unpack_from("<" + form, self.data, self.at)
        self.at += size
        return value

    def text(self):
        length = self.take("I", 4)
        found = self.data[self.at : self.at + length - 1].decode()
        self.at += length
        return found

    def numbers(self):
        return [self.take("d", 8) for _ in range(self.take("I", 4))]


def state(data):
    own = Reader(data)
    time = own.take("i", 4) + 1e-9 * own.take("I", 4)
    own.text()
    names = [own.text() for _ in range(own.take("I", 4))]
    return time, names, own.numbers(), own.numbers(), own.numbers()


def bare(path):
    """The text of a URDF without shapes, whose files may be elsewhere."""
    tree = ElementTree.parse(path)
    for link in tree.getroot().iter("link"):
        for shape in link.findall("visual") + link.findall("collision"):
            link.remove(shape)
    return ElementTree.tostring(tree.getroot(), encoding="unicode")


rows = sqlite3.connect(BAG).execute(
    "select data from messages join topics on topics.id = topic_id where name = '/joint_states' order by timestamp"
)
states = [state(data) for (data,) in rows]
names = states[0][1]
time, q, v, torque = (numpy.array([own[k] for own in states]) for k in (0, 2, 3, 4))
step = float(numpy.median(numpy.diff(time)))
sys.path.insert(0, EXPORT)
export = importlib.import_module(NAME + "_mujoco")


def error(model):
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.opt.timestep = step / STEPS
    dofs = [model.joint(name).dofadr[0] for name in names]
    places = [model.joint(name).qposadr[0] for name in names]
    count = round(WINDOW / step)
    squares = []
    for start in range(len(time) // 2, len(time) - count - 1, count):
        data = mujoco.MjData(model)
        data.qpos[places], data.qvel[dofs] = q[start], v[start]
        for k in range(start, start + count):
            for part in range(STEPS):
                share = part / STEPS
                data.qfrc_applied[dofs] = (1 - share) * torque[k] + share * torque[k + 1]
                mujoco.mj_step(model, data)
            squares.append((data.qpos[places] - q[k + 1]) ** 2)
    return float(numpy.sqrt(numpy.mean(squares)))


identified = export.load(text=bare(os.path.join(EXPORT, NAME + ".urdf"))).compile()
print("identified", error(identified))
given = mujoco.MjSpec.from_string(bare(URDF))
given.option.gravity = export.GRAVITY
print("nominal", error(given.compile()))
identified.dof_frictionloss[:] = identified.dof_damping[:] = 0
print("zero", error(identified))
