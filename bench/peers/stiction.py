"""Our side: the logs of known axes, and the stiction binary on them, one thread each."""

import json
import os
import subprocess
import time

import machine

AXIS = """kind = "linear"
mass = "none"
[terms]
offset = false
delay = "none"
"""
# Searches of `stiction compare`, with the seeds of each.
SEARCHES = (("lm", 30), ("niched-ga", 30), ("annealing-ga", 10))
# The whole command is repeated, to take the middle.
COMMANDS = 9


def build():
    """Builds the command and what writes the logs; gives both."""
    return machine.environment.program(), machine.environment.example("known_log")


class Log:
    """A log whose parameters are known, with the axis file that says what it holds."""

    def __init__(self, name, rate, programs):
        self.program, maker = programs
        folder = machine.WORK / name
        folder.mkdir(parents=True, exist_ok=True)
        self.name, self.folder = name, folder
        self.file, self.axis = folder / "log.csv", folder / "axis.toml"
        self.axis.write_text(AXIS)
        lines = subprocess.check_output([maker, name, str(rate), self.file], text=True).splitlines()
        known = {key: float(value) for key, value in map(str.split, lines)}
        drop = known["static"] - known["coulomb"]
        self.truth = [
            *(known[key] for key in ("sigma0", "sigma1", "sigma2", "coulomb")),
            drop,
            known["stribeck_velocity"],
        ]

    def _stiction(self, command, out, *options):
        """Runs it; gives the file it wrote, its processor time and the share of a core it had."""
        out = self.folder / out
        words = [self.program, command, self.file, "--axis", self.axis, "--threads", "1", "--quiet", "--force"]
        start, before = time.perf_counter(), os.times()
        subprocess.check_call([*words, "--out", out, *options], stdout=subprocess.DEVNULL)
        after, wall = os.times(), time.perf_counter() - start
        used = after.children_user + after.children_system - before.children_user - before.children_system
        name = {"identify": "result.json", "compare": "compare.json"}[command]
        return json.loads((out / name).read_text()), used, used / wall

    def searches(self, most):
        """What `stiction compare` makes of each method: rows of the table, and the last of the files."""
        runs = {}
        for method, seeds in SEARCHES:
            options = ["--methods", method, "--seeds", str(seeds), "--evaluations", str(most), "--box", "1"]
            file, _, share = self._stiction("compare", method, *options)
            runs[method] = rows(file, share)
        return runs, file

    def commands(self, optimum, found):
        """Runs of `stiction identify` as rows of the table, the least cost being `optimum`."""
        runs = []
        for _ in range(COMMANDS):
            result, used, _ = self._stiction("identify", "identify")
            cost = (result["fit"]["relative_error_percent"] / 100.0) ** 2
            search = result["search"]
            runs.append(
                {
                    "success": cost <= optimum * (1.0 + found),
                    "excess": cost / optimum - 1.0,
                    "seconds": used,
                    "evaluations": search["evaluations"] - search["thinned"],
                    "thinned": search["thinned"],
                }
            )
        return runs


def rows(file, share):
    """Runs of a method of `stiction compare`. Their clock is wall time; the share of a core that the process had makes
    it processor time."""
    (method,) = file["methods"]
    optimum = file["reference"]["cost"]
    return [
        {
            "success": run["success"],
            "alone": run["success_own"],
            "excess": run["cost"] / optimum - 1.0,
            "seconds": share * (run["seconds_to_success"] if run["success"] else run["seconds"]),
            "evaluations": run["evaluations_to_success"] if run["success"] else run["evaluations"]["full_records"],
        }
        for run in method["runs"]
    ]
