#!/usr/bin/env python3
"""Writes what Pinocchio 4.1 computes for the robots beside this file, for tests/suite/pinocchio.rs, and of log-Cholesky
coordinates for tests/suite/consistency.rs. Run with it installed:

    python3 -m pip install pin==4.1.0
    python3 crates/rigid/tests/pinocchio/make_reference.py

A line for each value: its name, then numbers that round-trip, joints in the order of `joints`.
"""

import pathlib

import numpy
import pinocchio

HERE = pathlib.Path(__file__).parent
STATES = 3


def positions(model, q):
    """Pinocchio's position vector: a continuous joint is a cosine and a sine."""
    full = numpy.zeros(model.nq)
    for j in model.joints:
        if j.id == 0:
            continue
        if j.nq == 2:
            full[j.idx_q : j.idx_q + 2] = numpy.cos(q[j.idx_v]), numpy.sin(q[j.idx_v])
        else:
            full[j.idx_q] = q[j.idx_v]
    return full


def reference(path):
    model = pinocchio.buildModelFromUrdf(str(path))
    data = model.createData()
    rng = numpy.random.default_rng(5)
    yield "joints", list(model.names)[1:]
    yield "parameters", numpy.concatenate([i.toDynamicParameters() for i in list(model.inertias)[1:]])
    for _ in range(STATES):
        q, v, a = rng.uniform(-3, 3, (3, model.nv))
        full = positions(model, q)
        yield "q", q
        yield "v", v
        yield "a", a
        yield "torque", pinocchio.rnea(model, data, full, v, a)
        yield "regressor", pinocchio.computeJointTorqueRegressor(model, data, full, v, a)
        pinocchio.computeRNEADerivatives(model, data, full, v, a)
        yield "by_position", data.dtau_dq
        yield "by_speed", data.dtau_dv
        mass = pinocchio.crba(model, data, full)
        yield "mass", numpy.triu(mass) + numpy.triu(mass, 1).T


def main():
    for path in sorted(HERE.glob("*.urdf")):
        with open(path.with_suffix(".txt"), "w") as out:
            for name, values in reference(path):
                if name != "joints":
                    values = [repr(float(x)) for x in numpy.ravel(values)]
                print(name, *values, file=out)

    with open(HERE / "log_cholesky.txt", "w") as out:
        rng = numpy.random.default_rng(6)
        for _ in range(5):
            theta = rng.uniform(-1.5, 1.5, 10)
            coordinates = pinocchio.LogCholeskyParameters(theta)
            for values in theta, coordinates.toDynamicParameters(), coordinates.calculateJacobian():
                print(*(repr(float(x)) for x in numpy.ravel(values)), file=out)


if __name__ == "__main__":
    main()
