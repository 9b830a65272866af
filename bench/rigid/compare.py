#!/usr/bin/env python3
"""The regressor of a robot beside Pinocchio's, in C++ compiled against the headers of its wheel.

    python3 bench/rigid/compare.py [ROUNDS]

Runs both in turn on the UR10 of example-robot-data, 10 000 states, and prints the least time of each in ns per state, on one
core. g++ with -O3, stiction as `cargo build --release` makes it, both for any x86-64: with -march=native Eigen aligns its
matrices in another way than the library of the wheel, and the program crashes.
"""

import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter(
    environment.WORK / "venv-rigid", environment.ROOT / "crates/rigid/tests/pinocchio/requirements.txt"
)

import pinocchio

ROUNDS = int(sys.argv[1]) if len(sys.argv) > 1 else 5
SAMPLES = 10_000
PREFIX = Path(pinocchio.__file__).parents[4]
UR10 = PREFIX / "share/example-robot-data/robots/ur_description/urdf/ur10_robot.urdf"
# What its CMake target asks for: it has more kinds of joints than Boost's lists by default.
DEFINITIONS = [
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
    "-DPINOCCHIO_WITH_URDFDOM",
]


def compiled():
    """Pinocchio's program."""
    program = environment.WORK / "pinocchio-regressor"
    library = PREFIX / "lib"
    subprocess.check_call(
        ["g++", "-std=c++17", "-O3", "-DNDEBUG", "-w", *DEFINITIONS, "-o", program]
        + [Path(__file__).with_name("regressor.cpp")]
        + [f"-isystem{PREFIX}/include{part}" for part in ("", "/eigen3", "/urdfdom_headers")]
        + [f"-L{library}", f"-Wl,-rpath,{library}", "-lpinocchio_parsers", "-lpinocchio_default"]
    )
    return program


programs = {
    "stiction": environment.example("regressor"),
    "Pinocchio": compiled(),
}
times = {name: float("inf") for name in programs}
for _ in range(ROUNDS):
    for name, program in programs.items():
        time = float(subprocess.check_output([program, UR10, str(SAMPLES)]))
        times[name] = min(times[name], time)
print(environment.described("pin") + ".\n")
print("| regressor of the UR10 | ns a state |\n|---|---:|")
for name, time in times.items():
    print(f"| {name} | {time:.0f} |")
