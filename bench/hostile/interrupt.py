"""How long `stiction identify` takes to end once it is interrupted: `interrupt.py STICTION LOG SECONDS ..`.

One row for each number of seconds after which it is interrupted.
"""

import signal
import subprocess
import sys
import tempfile
import time


def main():
    program, log, *waits = sys.argv[1:]
    print("| interrupted after, s | ended after, s | exit code | peak till then, MB |\n|---|---|---|---|")
    for wait in map(float, waits):
        with tempfile.TemporaryDirectory() as folder:
            command = [program, "identify", log, "--out", f"{folder}/out", "--quiet"]
            child = subprocess.Popen(command, stderr=subprocess.DEVNULL)
            time.sleep(wait)
            status = open(f"/proc/{child.pid}/status").read()
            peak = int(status.split("VmHWM:")[1].split()[0]) / 1e3
            child.send_signal(signal.SIGINT)
            begun = time.monotonic()
            try:
                code = child.wait(300)
            except subprocess.TimeoutExpired:
                code = "none"
                child.kill()
            print(f"| {wait:g} | {time.monotonic() - begun:.3f} | {code} | {peak:.0f} |", flush=True)


if __name__ == "__main__":
    main()
