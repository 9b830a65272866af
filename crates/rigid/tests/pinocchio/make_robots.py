#!/usr/bin/env python3
"""Writes the robots of the tests, URDFs of our own: arm6, arm7 and tree. Run once:

    python3 crates/rigid/tests/pinocchio/make_robots.py
"""

import math
import pathlib
import random

HERE = pathlib.Path(__file__).parent


def words(numbers):
    return " ".join(f"{x:.4g}" for x in numbers)


def link(rng, name, mass=None, size=0.1):
    """A link of a box of that size about a centre off its frame, turned; without mass, an empty one."""
    if mass is None:
        return [f'  <link name="{name}"/>']
    a, b, c = (size * rng.uniform(0.4, 1.6) for _ in range(3))
    moments = [mass / 12 * s for s in (b * b + c * c, a * a + c * c, a * a + b * b)]
    # Off the diagonal, small enough to stay physical.
    off = [0.05 * min(moments) * rng.uniform(-1, 1) for _ in range(3)]
    centre = [size * rng.uniform(-0.5, 0.5) for _ in range(3)]
    turn = [rng.uniform(-1, 1) for _ in range(3)]
    return [
        f'  <link name="{name}">',
        "    <inertial>",
        f'      <origin xyz="{words(centre)}" rpy="{words(turn)}"/>',
        f'      <mass value="{mass}"/>',
        f'      <inertia ixx="{moments[0]:.6g}" ixy="{off[0]:.4g}" ixz="{off[1]:.4g}" iyy="{moments[1]:.6g}"'
        f' iyz="{off[2]:.4g}" izz="{moments[2]:.6g}"/>',
        "    </inertial>",
        "  </link>",
    ]


def joint(name, kind, parent, child, xyz, rpy, axis=None, *more):
    return [
        f'  <joint name="{name}" type="{kind}">',
        f'    <parent link="{parent}"/>',
        f'    <child link="{child}"/>',
        f'    <origin xyz="{words(xyz)}" rpy="{words(rpy)}"/>',
        *([f'    <axis xyz="{words(axis)}"/>'] if axis else []),
        '    <limit lower="-3" upper="3" effort="100" velocity="3"/>',
        '    <dynamics damping="0.5" friction="0.2"/>',
        *(f"    {m}" for m in more),
        "  </joint>",
    ]


def write(name, parts):
    lines = [f'<robot name="{name}">', *(line for part in parts for line in part), "</robot>", ""]
    (HERE / f"{name}.urdf").write_text("\n".join(lines))


def arm6():
    """Six axes with offsets: mixed and oblique axes, one of another length than 1, and none stated."""
    rng = random.Random(6)
    half = math.pi / 2
    axes = [(0, 0, 1), (0, 1, 0), (0, -2, 0), None, (1, 1, 0), (0.3, -0.4, 1.2)]
    turns = [(0, 0, 0), (0, half, 0), (0, 0, 0.3), (-half, 0, 0), (0.1, 0.2, 0.3), (half, 0, -half)]
    parts = [link(rng, "base", 4.0)]
    for i, (axis, turn) in enumerate(zip(axes, turns), 1):
        place = [rng.uniform(-0.4, 0.4) for _ in range(3)]
        parent = "base" if i == 1 else f"link{i - 1}"
        kind = "continuous" if i == 4 else "revolute"
        parts.append(link(rng, f"link{i}", 8.0 / i, 0.4 / i))
        parts.append(joint(f"joint{i}", kind, parent, f"link{i}", place, turn, axis))
    write("arm6", parts)


def arm7():
    """Seven axes with fixed links: a stand below, a massless flange, a camera, and a tool of two links."""
    rng = random.Random(7)
    half = math.pi / 2
    parts = [link(rng, "world"), link(rng, "stand", 20.0, 0.5)]
    parts.append(joint("bolted", "fixed", "world", "stand", (0.1, 0, 0.5), (0, 0, 0.4)))
    for i in range(1, 8):
        parent = "stand" if i == 1 else f"link{i - 1}"
        parts.append(link(rng, f"link{i}", None if i == 7 else 5.0 - 0.5 * i, 0.2))
        turn = (0, 0, 0) if i == 1 else (half * (-1) ** i, 0, 0)
        place = (0.05 * (i % 3), 0.2 * (i % 2), 0.15)
        parts.append(joint(f"joint{i}", "revolute", parent, f"link{i}", place, turn, (0, 0, 1)))
    for name, parent, mass, place in [
        ("camera", "link4", 0.3, (0.1, 0, 0.05)),
        ("flange", "link7", None, (0, 0, 0.1)),
        ("hand", "flange", 0.7, (0, 0.02, 0.05)),
        ("finger", "hand", 0.1, (0.03, 0, 0.1)),
    ]:
        parts.append(link(rng, name, mass, 0.08))
        turn = [rng.uniform(-1, 1) for _ in range(3)]
        parts.append(joint(f"{name}_mount", "fixed", parent, name, place, turn))
    write("arm7", parts)


def tree():
    """A carriage with two arms: prismatic joints, an oblique one too, and a gripper whose fingers mimic."""
    rng = random.Random(8)
    mimic = '<mimic joint="left_finger" multiplier="-1.5" offset="0.01"/>'
    joints = [
        ("rail", "prismatic", "base", "carriage", (0, 1, 0)),
        ("left_shoulder", "revolute", "carriage", "left_upper", (0, 0, 1)),
        ("right_shoulder", "continuous", "carriage", "right_upper", (1, 0, 0)),
        ("left_elbow", "revolute", "left_upper", "left_lower", (0, 1, 0)),
        ("right_slide", "prismatic", "right_upper", "right_lower", (1, 2, -2)),
        ("left_finger", "prismatic", "left_lower", "left_tip", (1, 0, 0)),
        ("left_thumb", "prismatic", "left_lower", "left_thumb_tip", (-1, 0, 0), mimic),
        ("right_wrist", "revolute", "right_lower", "right_hand", (0, 0, -1)),
    ]
    parts = [link(rng, "base")]
    for name, kind, parent, child, axis, *more in joints:
        place = [rng.uniform(-0.3, 0.3) for _ in range(3)]
        turn = [rng.uniform(-2, 2) for _ in range(3)]
        parts.append(link(rng, child, round(rng.uniform(0.2, 6), 2), 0.2))
        parts.append(joint(name, kind, parent, child, place, turn, axis, *more))
    write("tree", parts)


arm6()
arm7()
tree()
