"""Time and peak of resident memory of `stiction check` on every file of a folder: `measure.py STICTION DIR [OPTION ..]`.

One row a file, for docs/performance.md.
"""

import os
import subprocess
import sys
import time
from pathlib import Path


def run(command):
    """Seconds, peak in MB, exit code and what was said last."""
    begun = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
    said = child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    lines = [line for line in said.splitlines() if line]
    return time.monotonic() - begun, usage.ru_maxrss / 1e3, os.waitstatus_to_exitcode(status), lines


def main():
    program, folder, options = sys.argv[1], Path(sys.argv[2]), sys.argv[3:]
    print("| file | size, kB | time, s | peak, MB | exit code | said |\n|---|---|---|---|---|---|")
    for file in sorted(folder.iterdir()):
        command = [program, "check", "--threads", "1", file.name, *options]
        os.chdir(folder)
        seconds, peak, code, lines = run(command)
        said = lines[0][:230] if lines else ""
        print(f"| {file.name} | {file.stat().st_size / 1e3:.1f} | {seconds:.2f} | {peak:.0f} | {code} | {said} |", flush=True)


if __name__ == "__main__":
    main()
