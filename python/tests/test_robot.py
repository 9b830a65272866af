"""A robot: an arm of two links whose torque is known in closed form."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction

from conftest import quietly
from test_same_bits import without_times

URDF = """<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 -0.25"/><mass value="5"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.02"/></inertial></link>
<link name="lower"><inertial><origin xyz="0 0 -0.2"/><mass value="3"/>
  <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.01"/></inertial></link>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
<joint name="elbow" type="continuous"><origin xyz="0 0 -0.5"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/></joint>
</robot>
"""
COULOMB = {"shoulder": 4.0, "elbow": 1.5}
"""N m."""


def columns() -> dict[str, Any]:
    """Half a minute of the arm at 200 Hz: a double pendulum with Coulomb and viscous friction."""
    t = numpy.arange(0, 30, 5e-3)

    def motion(sines: list[tuple[float, float]]) -> tuple[Any, Any, Any]:
        q = sum(size * numpy.sin(w * t) for size, w in sines)
        v = sum(size * w * numpy.cos(w * t) for size, w in sines)
        a = sum(-size * w * w * numpy.sin(w * t) for size, w in sines)
        return q, v, a

    q1, v1, a1 = motion([(0.7, 0.9), (0.25, 2.3), (0.1, 4.1)])
    q2, v2, a2 = motion([(0.6, 1.3), (0.3, 1.9), (0.12, 3.7)])
    both = 0.05 + 3 * (0.04 + 0.1 * numpy.cos(q2))
    first = 0.1 + 5 * 0.0625 + 0.05 + 3 * (0.25 + 0.04 + 0.2 * numpy.cos(q2))
    h = 3 * 0.1 * numpy.sin(q2)
    lower = 3 * 0.2 * 9.81 * numpy.sin(q1 + q2)
    upper = (5 * 0.25 + 3 * 0.5) * 9.81 * numpy.sin(q1)
    noise = numpy.random.default_rng(1).normal(0, 0.1, (2, len(t)))
    shoulder = first * a1 + both * a2 - h * (2 * v1 * v2 + v2**2) + upper + lower
    shoulder += 4 * numpy.tanh(v1 / 1e-3) + 6 * v1 + noise[0]
    elbow = both * a1 + 0.17 * a2 + h * v1**2 + lower + 1.5 * numpy.tanh(v2 / 1e-3) + 2 * v2 + noise[1]
    return {
        "time [s]": t,
        "shoulder_position [rad]": q1,
        "shoulder_torque [N*m]": shoulder,
        "elbow_position [rad]": q2,
        "elbow_torque [N*m]": elbow,
    }


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A log and a URDF."""
    folder = tmp_path_factory.mktemp("arm")
    named = columns()
    table = numpy.column_stack(list(named.values()))
    log, urdf = folder / "run.csv", folder / "arm.urdf"
    numpy.savetxt(log, table, fmt="%.6f", delimiter=",", header=",".join(named), comments="")
    urdf.write_text(URDF)
    return log, urdf


@pytest.fixture(scope="module")
def arm(files: tuple[Path, Path]) -> stiction.Robot:
    log, urdf = files
    found: stiction.Robot = quietly(stiction.robot, log, urdf=urdf, split=0.6)
    return found


def test_the_friction_of_each_joint_is_a_fit(arm: stiction.Robot) -> None:
    assert arm.trustworthy, arm.reasons
    assert arm.verdict == "trustworthy"
    assert list(arm.joints) == ["shoulder", "elbow"]
    for name, coulomb in COULOMB.items():
        joint = arm.joints[name]
        assert joint.trustworthy
        found = joint.fit
        assert isinstance(found, stiction.Fit)
        assert found.result["law"] == joint.result["fit"]["law"]
        assert abs(joint.result["fit"]["coulomb"]["value"] / coulomb - 1) < 0.1
        assert len(found.series["residual"]) > 100


def test_the_files_are_those_of_the_command_line(
    arm: stiction.Robot, files: tuple[Path, Path], command: Any, tmp_path: Path
) -> None:
    log, urdf = files
    written = arm.write(tmp_path / "here")
    command("robot", log, "--urdf", urdf, "--split", "0.6", "--out", tmp_path / "there", "--quiet")
    for path in written:
        other = tmp_path / "there" / path.relative_to(tmp_path / "here")
        if path.name == "report.html":
            # Its commands name the folder.
            assert other.is_file()
        elif path.name == "result.json":
            one, two = (without_times(json.loads(file.read_text())) for file in (path, other))
            assert one == two, path
        else:
            assert path.read_bytes() == other.read_bytes(), path
    assert json.loads((tmp_path / "here" / "robot.json").read_text()) == arm.result


def test_a_fit_of_a_joint_does_not_predict_without_its_robot(arm: stiction.Robot) -> None:
    found = arm.joints["elbow"].fit
    assert found is not None
    log = {name: values for name, values in columns().items() if not name.startswith("shoulder")}
    with pytest.raises(stiction.StictionError, match="no force from outside"):
        quietly(found.predict, log)


def test_what_is_missing_is_refused(files: tuple[Path, Path]) -> None:
    log, urdf = files
    with pytest.raises(stiction.StictionError, match="URDF"):
        stiction.robot(log)
    with pytest.raises(stiction.StictionError, match="one of the two"):
        stiction.robot(log, urdf=urdf, validate=[log], split=0.5)
    with pytest.raises(stiction.StictionError):
        stiction.robot(log, urdf=urdf.with_name("gone.urdf"))
