"""A fleet on this machine against `stiction batch`: measure.py PROGRAM [LOGS], the built command line and how many small logs.

Prints throughput of both on two cores, in turn, so that what else the machine does falls on both; the memory of a worker and
of the process that it hands logs to, over the run; time and peak memory of `batch` over a tenth of the logs and all; what a
second call costs, which takes everything; and what a million logs a day would be at these costs. Run it with the Python that
the wheel and the extra `fleet` are installed in, on a machine that does nothing else.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "python" / "tests"))

LAW = "coulomb-viscous"
ROUNDS = 3
SAMPLES = 1000
"""Of a log of the comparison; as it is in the fleet tests."""
PRICE = 0.05
"""Of a core for an hour, USD: an assumption."""
DAY = 86_400.0


def batch(program: str, logs: Path, out: Path) -> tuple[float, float]:
    """Time, s, and peak memory, MB, of the command on two threads."""
    words = [program, "batch", str(logs), "--law", LAW, "--threads", "2", "--quiet", "--out", str(out)]
    start = time.perf_counter()
    child = os.posix_spawn(program, words, os.environ)
    _, status, used = os.wait4(child, 0)
    assert os.waitstatus_to_exitcode(status) in (0, 1)
    return time.perf_counter() - start, used.ru_maxrss / 1e3


def resident(pid: int) -> float:
    """Memory of a process, MB."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def children(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def main(program: str, count: int) -> None:
    import distributed
    from fleet_logs import good
    from stiction.fleet import run

    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None)
    with tempfile.TemporaryDirectory() as name, cluster, distributed.Client(cluster) as client:
        folder = Path(name)
        good(folder / "warm", 20)
        run(folder / "warm", folder / "nothing", client=client, law=LAW)
        compared(program, client, good, run, folder)
        many(program, client, cluster, good, run, folder, count)


def compared(program: str, client: Any, good: Any, run: Any, folder: Path) -> None:
    """Throughput of both, in turn."""
    logs = 200
    good(folder / "logs", logs, SAMPLES)
    ours, theirs = [], []
    for k in range(ROUNDS):
        theirs.append(batch(program, folder / "logs", folder / f"batch{k}")[0])
        start = time.perf_counter()
        run(folder / "logs", folder / f"out{k}", client=client, law=LAW)
        ours.append(time.perf_counter() - start)
        print(f"{logs} logs of {SAMPLES} samples: batch {theirs[-1]:.2f} s, Dask {ours[-1]:.2f} s, {theirs[-1] / ours[-1]:.0%}")
    each = 2.0 * min(ours) / logs
    print(f"throughput of the fleet over that of batch: {min(theirs) / min(ours):.0%}; {1e3 * each:.1f} ms of a core for a log")
    for cost in (each, 30.0):
        hours = 1e6 * cost / 3600.0
        print(
            f"1e6 logs a day at {1e3 * cost:.0f} ms of a core: {1e6 * cost / DAY:.2f} cores, {hours:.0f} core-hours, "
            f"{PRICE * hours:.1f} USD at {PRICE} USD a core-hour"
        )


def many(program: str, client: Any, cluster: Any, good: Any, run: Any, folder: Path, count: int) -> None:
    """Memory over many logs, and what a second call costs."""
    good(folder / "few", count // 10)
    good(folder / "many", count)
    for logs in ("few", "many"):
        took, peak = batch(program, folder / logs, folder / f"of-{logs}")
        number = len(os.listdir(folder / logs))
        print(f"batch of {number} logs of 500 samples: {number / took:.0f} logs/s, {peak:.0f} MB")
    seen: list[tuple[float, float]] = []
    asked = time.process_time()

    def watch(progress: Any) -> None:
        if progress.fraction * 10.0 >= len(seen):
            of_worker = [nanny.pid for nanny in cluster.workers.values()]
            below = [child for pid in of_worker for child in children(pid)]
            seen.append((max(map(resident, of_worker)), max(map(resident, below), default=0.0)))

    start = time.perf_counter()
    run(folder / "many", folder / "out", client=client, law=LAW, progress=watch)
    took, asked = time.perf_counter() - start, time.process_time() - asked
    print(f"Dask: {count / took:.0f} logs/s; caller and scheduler {1e3 * asked / count:.2f} ms of a core for a log")
    print("memory of a worker and its process at each tenth, MB: " + ", ".join(f"{a:.0f}+{b:.0f}" for a, b in seen))
    size = sum(path.stat().st_size for path in (folder / "out").glob("*.parquet"))
    print(f"tables: {size / count:.0f} bytes for a log")
    start = time.perf_counter()
    taken = run(folder / "many", folder / "out", client=client, law=LAW).taken
    print(f"a second call takes {taken} logs in {time.perf_counter() - start:.1f} s")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 10_000)
