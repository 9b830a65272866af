#!/usr/bin/env python3
"""Processor time and memory of whole commands, `stiction identify LOG --axis AXIS --threads 1` from reading to report, on the
measured recordings, and of `stiction robot` on the UR10.

    python3 bench/commands/measure.py [ROUNDS]

Builds the program, runs each command so often and prints the least.
"""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter(
    environment.WORK / "venv-rigid", environment.ROOT / "crates/rigid/tests/pinocchio/requirements.txt"
)

DATA = Path(os.environ.get("STICTION_DATA", environment.ROOT.parent / "shared/data"))
# Where its package is, not imported: the peak of a child counts the memory of this process from before it became a program.
ROBOTS = Path(importlib.util.find_spec("pinocchio").origin).parents[4] / "share/example-robot-data/robots"
LOGS = (
    ("EMPS", "emps/DATA_EMPS.mat", "emps"),
    ("UR10e joint 1", "ur10e/joint_1.csv", "ur10e_joint_1"),
    ("UR10e joint 4", "ur10e/joint_4.csv", "ur10e_joint_4"),
    ("Tribometer", "tribometer/presliding.tsv", "tribometer"),
    ("Servo, sliding", "servo/sliding_1.txt", "servo"),
    ("Damiao motor 1", "damiao/motor_1.npz", "damiao"),
    ("Robot joint", "robot_joint/slow.csv", "robot_joint"),
)


def run(command):
    """Processor time, s, and peak of memory, MB."""
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode in (0, 1), command
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3


def samples(out):
    """Of the logs that a result was found from."""
    return sum(entry["samples"] for entry in json.loads(out.read_text())["inputs"])


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    program = environment.program()
    print(environment.described() + ".\n\n| log | samples | processor time, s | memory, MB |\n|---|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        run([program, "demo", "--out", folder / "demo"])
        commands = [("the demo", [folder / "demo/demo.csv"], "identify")]
        commands += [(name, [DATA / log, "--axis", DATA / f"axes/{axis}.toml"], "identify") for name, log, axis in LOGS]
        urdf = ROBOTS / "ur_description/urdf/ur10_robot.urdf"
        commands.append(("UR10, six joints (`robot`)", [DATA / "robots/ur10_panda/ur10.db3", "--urdf", urdf], "robot"))
        for name, words, command in commands:
            out = folder / "out"
            whole = [program, command, *words, "--threads", "1", "--quiet", "--force", "--out", out / name.split()[0]]
            figures = [run(whole) for _ in range(rounds)]
            result = out / name.split()[0] / {"identify": "result.json", "robot": "robot.json"}[command]
            least = [min(column) for column in zip(*figures)]
            print(f"| {name} | {samples(result)} | {least[0]:.2f} | {least[1]:.0f} |", flush=True)


if __name__ == "__main__":
    main()
