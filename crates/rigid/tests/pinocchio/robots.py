#!/usr/bin/env python3
"""Pinocchio's numbers for URDFs, for tests/suite/robots.rs.

    python3 crates/rigid/tests/pinocchio/robots.py list
    python3 crates/rigid/tests/pinocchio/robots.py URDF STATES

The first prints the paths of the URDFs of example-robot-data. The second writes a line with the names of the joints, then
little-endian doubles: the parameters of the bodies, and for each of the random states q, v, a, torque, regressor, and the
derivatives of the torque with respect to q and v.
"""

import pathlib
import sys

import numpy
import pinocchio

from make_reference import positions


def robots():
    prefix = pathlib.Path(pinocchio.__file__).parents[4]
    return sorted(prefix.glob("share/example-robot-data/robots/**/*.urdf"))


def write(path, states):
    model = pinocchio.buildModelFromUrdf(path)
    data = model.createData()
    rng = numpy.random.default_rng(1)
    out = sys.stdout.buffer
    out.write("\t".join(list(model.names)[1:]).encode() + b"\n")
    inertias = [i.toDynamicParameters() for i in list(model.inertias)[1:]]

    def numbers(values):
        out.write(numpy.ascontiguousarray(values, dtype="<f8").tobytes())

    numbers(inertias)
    for _ in range(states):
        q, v, a = rng.uniform(-3, 3, (3, model.nv))
        full = positions(model, q)
        for values in (q, v, a, pinocchio.rnea(model, data, full, v, a)):
            numbers(values)
        numbers(pinocchio.computeJointTorqueRegressor(model, data, full, v, a))
        pinocchio.computeRNEADerivatives(model, data, full, v, a)
        numbers(data.dtau_dq)
        numbers(data.dtau_dv)


if sys.argv[1] == "list":
    print(*robots(), sep="\n")
else:
    write(sys.argv[1], int(sys.argv[2]))
