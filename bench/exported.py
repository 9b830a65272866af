#!/usr/bin/env python3
"""What a step of the exported compensator takes: `cargo bench -p stiction-export` as a table, ns.

    python3 bench/exported.py
"""

import subprocess

import environment


def main():
    bench = ["cargo", "bench", "--quiet", "-p", "stiction-export"]
    lines = subprocess.check_output(bench, cwd=environment.ROOT, text=True).splitlines()
    rows = [line.split("\t") for line in lines if line.count("\t") == 3]
    motions = list(dict.fromkeys(motion for _, _, motion, _ in rows))
    print(environment.described() + ".\n\n| law | code | " + " | ".join(motions) + " |\n|---|---|" + "---:|" * len(motions))
    times = {(law, code, motion): float(ns) for law, code, motion, ns in rows}
    for law, code in dict.fromkeys((law, code) for law, code, _, _ in rows):
        print(f"| {law} | {code} | " + " | ".join(f"{times[law, code, motion]:.1f}" for motion in motions) + " |")


if __name__ == "__main__":
    main()
