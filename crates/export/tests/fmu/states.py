"""States, resets, instances and refusals of the FMUs in the working folder, through FMPy."""

import math
import shutil
import fmpy
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

CYCLE = 1e-3


class Axis:
    """An instance of either version with the same calls."""

    def __init__(self, path, folder, settings=()):
        about = fmpy.read_model_description(path)
        self.two = about.fmiVersion == "2.0"
        self.where = {v.name: v.valueReference for v in about.modelVariables}
        slave = FMU2Slave if self.two else FMU3Slave
        self.fmu = slave(guid=about.guid, unzipDirectory=folder, modelIdentifier=about.coSimulation.modelIdentifier, instanceName="x")
        self.fmu.instantiate()
        self.settings = dict(settings)
        self.start()

    def start(self):
        if self.two:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        for name, value in self.settings.items():
            self.set(name, value)
        self.fmu.exitInitializationMode()
        self.fmu.setBoolean([self.where["enable"]], [True])
        self.k = 0

    def set(self, name, value):
        (self.fmu.setReal if self.two else self.fmu.setFloat64)([self.where[name]], [value])

    def get(self, name):
        return (self.fmu.getReal if self.two else self.fmu.getFloat64)([self.where[name]])[0]

    def step(self, velocity, cycles=1):
        self.set("reference_velocity", velocity)
        self.fmu.doStep(currentCommunicationPoint=self.k * CYCLE, communicationStepSize=cycles * CYCLE)
        self.k += cycles
        return self.get("force"), self.get("deflection")

    def run(self, count):
        return [self.step(0.005 * math.sin(0.05 * k)) for k in range(count)]


def refused(call, *arguments):
    try:
        call(*arguments)
    except Exception:
        return True
    return False


for version in (2, 3):
    path = f"x_axis_friction_fmi{version}.fmu"
    folder = fmpy.extract(path)
    on = {"watchdog_window": 0.0, "ramp": 0.0}
    a, b = Axis(path, folder, on), Axis(path, folder, {**on, "gain": 0.25})
    # Two instances do not see each other.
    first, other = a.run(100), b.run(100)
    assert max(abs(f) for f, z in first) > 5.0
    assert all(math.isclose(f, 3.0 * g, rel_tol=1e-12, abs_tol=1e-12) and z == y for (f, z), (g, y) in zip(first, other))
    # Gone back to, a state goes on as it did.
    state = a.fmu.getFMUState()
    bytes_ = a.fmu.serializeFMUState(state)
    at = a.k
    onward = a.run(100)
    a.fmu.setFMUState(state)
    a.k = at
    assert a.run(100) == onward
    # So it does from bytes, in another instance, whose own settings it replaces.
    again = b.fmu.deserializeFMUState(bytes_)
    b.fmu.setFMUState(again)
    b.k = at
    assert b.run(100) == onward
    a.fmu.freeFMUState(state)
    b.fmu.freeFMUState(again)
    assert refused(a.fmu.deserializeFMUState, bytes(len(bytes_)))
    assert refused(a.fmu.deserializeFMUState, bytes_[:-1])
    # A reset forgets.
    a.fmu.reset()
    a.start()
    assert a.run(100) == first
    # A step of many cycles is as many steps, and one of a part takes the samples that are due.
    for instance in (a, b):
        instance.fmu.reset()
        instance.settings = on
        instance.start()
    once = [a.step(0.004) for k in range(12)][-1]
    assert b.step(0.004, 12) == once
    half = b.step(0.004, 0.5)
    assert half == a.step(0.004) and b.step(0.004, 0.5) == half
    # While it is reset there is no force, enabled or not.
    a.fmu.setBoolean([a.where["reset"]], [True])
    assert [a.step(0.004)[0] for k in range(5)] == [0.0] * 5
    a.fmu.setBoolean([a.where["reset"]], [False])
    assert a.step(0.004)[0] > 0.0
    # What is refused: steps, parameters of the law while it runs, numbers out of range.
    for step in (-1.0, math.nan, math.inf, 1e9):
        assert refused(a.fmu.doStep, 0.0, step), step
    assert refused(a.set, "sigma0", 1e5)
    assert refused(a.set, "force", 1.0)
    assert refused(Axis, path, folder, {"coulomb_pos": 1e3})
    a.set("gain", 1.5)
    assert a.step(0.01)[0] == 0.0 and not a.fmu.getBoolean([a.where["valid"]])[0]
    for instance in (a, b):
        instance.fmu.terminate()
        instance.fmu.freeInstance()
    shutil.rmtree(folder, ignore_errors=True)
    print("ok", f"{version}.0")
