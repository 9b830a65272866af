#!/usr/bin/env python3
"""Time and peak of memory of `stiction check` on small files that claim or unpack to gigabytes, and on long texts.

    python3 bench/hostile/measure.py [MILLION_ROWS]

Makes the files in target/bench/hostile afresh, and removes the long ones. `--max-memory 200MB` for the hostile ones; a long text may
take what it needs.
"""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

# What the tests read with.
environment.enter(environment.ROOT / ".venv", environment.ROOT / "xtask/requirements.txt")

HERE = Path(__file__).parent
FILES = environment.WORK / "hostile"


def run(command):
    """Seconds, peak in MB, exit code and the code of the error."""
    begun = time.monotonic()
    child = subprocess.Popen(command, cwd=FILES, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
    said = child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    code = said.partition("[")[2].partition("]")[0]
    return time.monotonic() - begun, usage.ru_maxrss / 1e3, child.returncode, code


def main():
    rows = int(1e6 * float(sys.argv[1] if len(sys.argv) > 1 else 14))
    check = [environment.program(), "check", "--threads", "1"]
    # Whatever a run that was ended left there would count as hostile.
    shutil.rmtree(FILES, ignore_errors=True)
    FILES.mkdir(parents=True, exist_ok=True)
    subprocess.check_call([sys.executable, HERE / "make.py", FILES])
    ends = [(file.name, *run([*check, file.name, "--max-memory", "200MB"])) for file in sorted(FILES.iterdir())]
    print(environment.described("numpy", "pyarrow", "h5py") + ".\n\n| log | file, MB | time, s | peak of memory, MB | ends with |\n|---|---:|---:|---:|---|")
    slowest, largest = (max(ends, key=lambda end: end[k]) for k in (1, 2))
    codes = sorted({f"`{end[4]}`" if end[3] else "exit code 0" for end in ends})
    print(f"| {len(ends)} hostile files with `--max-memory 200MB`, the worst of each | {sum(f.stat().st_size for f in FILES.iterdir()) / 1e6:.1f} in all | {slowest[1]:.1f} ({slowest[0]}) | {largest[2]:.0f} ({largest[0]}) | {', '.join(codes)} |")
    for name, script, arguments, words in [
        ("text, 4 of 8 columns used", "long_text.py", [FILES / "long.csv", str(rows)], ["long.csv"]),
        ("text, 3 of 12 columns used", "wide_text.py", [FILES, str(rows // 4)], ["wide.csv", "--axis", "axis.toml"]),
    ]:
        subprocess.check_call([sys.executable, HERE / script, *arguments])
        size = (FILES / words[0]).stat().st_size / 1e6
        seconds, peak, code, error = run([*check, *words])
        print(f"| {name} | {size:.0f} | {seconds:.1f} | {peak:.0f} | {error or f'exit code {code}'} |")
        (FILES / words[0]).unlink()


if __name__ == "__main__":
    main()
