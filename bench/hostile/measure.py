#!/usr/bin/env python3
"""Time and peak of memory of `stiction check` on small files that claim or unpack to gigabytes, and on long texts.

    python3 bench/hostile/measure.py [MILLION_ROWS]

Makes the files in target/bench/hostile afresh, and removes the long ones. `--max-memory 200MB` for the hostile ones; of a long
text so much that it is read and inspected, and its fit, 1 kB a sample, refused.
"""

import os
import re
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
    """Seconds, peak in MB, and how it ended: the code of the error, else of the program."""
    begun = time.monotonic()
    child = subprocess.Popen(command, cwd=FILES, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    said = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    code = re.search(r"[\[ ](log-[a-z]+)[\]:]", said)
    end = f"`{code[1]}`" if code else f"exit code {child.returncode}"
    return time.monotonic() - begun, usage.ru_maxrss / 1e3, end


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
    codes = sorted({end[3] for end in ends})
    print(f"| {len(ends)} hostile files with `--max-memory 200MB`, the worst of each | {sum(f.stat().st_size for f in FILES.iterdir()) / 1e6:.1f} in all | {slowest[1]:.1f} ({slowest[0]}) | {largest[2]:.0f} ({largest[0]}) | {', '.join(codes)} |")
    for name, script, arguments, words, limit in [
        ("4 of 8 columns used", "long_text.py", [FILES / "long.csv", str(rows)], ["long.csv"], "2GB"),
        ("3 of 12 columns used", "wide_text.py", [FILES, str(rows // 4)], ["wide.csv", "--axis", "axis.toml"], "1GB"),
    ]:
        subprocess.check_call([sys.executable, HERE / script, *arguments])
        size = (FILES / words[0]).stat().st_size / 1e6
        seconds, peak, end = run([*check, *words, "--max-memory", limit])
        print(f"| text with {name}, `--max-memory {limit}` | {size:.0f} | {seconds:.1f} | {peak:.0f} | {end} |", flush=True)
        (FILES / words[0]).unlink()


if __name__ == "__main__":
    main()
