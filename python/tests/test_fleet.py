"""`identify_uri` and the fleet on Dask against `stiction batch`: the same table, byte for byte, whatever happens meanwhile."""

from __future__ import annotations

import datetime
import json
import multiprocessing
import os
import pickle
import random
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction
from fleet_logs import AXIS, bad, good, odd_store, text
from stiction import _native
from stiction.fleet import Summary, identify_uri, run

distributed = pytest.importorskip("distributed")
fsspec = pytest.importorskip("fsspec")

LAW = "coulomb-viscous"
SOAK = os.environ.get("STICTION_SOAK") == "1"
"""Whether there is time for more."""
LOGS = 400 if SOAK else 30
KILLS = 20 if SOAK else 3
SAMPLES = 1000
"""Of a log of the fleet: long enough for a worker to be killed while it is identified."""


class Fleet:
    """A folder of good and bad logs, and what `stiction batch` makes of them."""

    def __init__(self, folder: Path, command: Any) -> None:
        self.logs = folder / "logs"
        self.axis = folder / "axis.toml"
        self.axis.write_text(AXIS)
        self.paths = sorted([*good(self.logs, LOGS, SAMPLES), *bad(self.logs)])
        command("batch", self.logs, "--axis", self.axis, "--law", LAW, "--out", folder / "batch")
        self.table = (folder / "batch" / "results.parquet").read_bytes()
        about = json.loads((folder / "batch" / "batch.json").read_text())
        failed = {each["code"]: each["logs"] for each in about["failed"]}
        self.summary = Summary(about["logs"], about["identified"], about["trustworthy"], 0, failed, True)


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory, program: Path) -> Fleet:
    def command(*arguments: Any) -> None:
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
        assert done.returncode in (0, 1), done.stderr

    return Fleet(tmp_path_factory.mktemp("fleet"), command)


@pytest.fixture(scope="module")
def odd(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A store with odd logs, here and on the workers."""
    folder = odd_store(tmp_path_factory.mktemp("odd"))
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(folder), before]))
    sys.path.insert(0, str(folder))
    fsspec.register_implementation("odd", "odd_store.Odd")
    yield folder
    sys.path.remove(str(folder))
    os.environ["PYTHONPATH"] = before or ""


class Workers:
    """Processes of Dask workers with one thread each, on this machine; one that is killed is replaced, as a service does it."""

    def __init__(self, address: str, folder: Path, count: int) -> None:
        words = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--no-nanny", "--nthreads", "1"]
        self._words = [*words, "--host", "127.0.0.1", "--no-dashboard", "--local-directory", str(folder)]
        self._processes = [self._begun() for _ in range(count)]

    def _begun(self) -> subprocess.Popen[bytes]:
        return subprocess.Popen(self._words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def pids(self) -> list[int]:
        return [process.pid for process in self._processes if process.poll() is None]

    def kill(self, dice: random.Random) -> None:
        """Kills one at random."""
        place = dice.randrange(len(self._processes))
        self._processes[place].send_signal(signal.SIGKILL)
        self._processes[place].wait()
        self._processes[place] = self._begun()

    def end(self) -> None:
        for process in self._processes:
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def workers(odd: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Any, Workers]]:
    """A client of two workers."""
    del odd
    os.environ.update(AWS_ACCESS_KEY_ID="test", AWS_SECRET_ACCESS_KEY="test", AWS_DEFAULT_REGION="us-east-1")
    with distributed.LocalCluster(n_workers=0, host="127.0.0.1", dashboard_address=None) as cluster:
        there = Workers(cluster.scheduler_address, tmp_path_factory.mktemp("workers"), 2)
        try:
            with distributed.Client(cluster) as client:
                yield client, there
        finally:
            there.end()


@pytest.fixture
def client(workers: tuple[Any, Workers]) -> Any:
    return workers[0]


def whole(out: Any, folder: Path) -> bytes:
    """A data set as one table."""
    table = folder / "whole.parquet"
    _native.keep_rows(str(out), str(table), set(), {})
    return table.read_bytes()


def rows(out: Any) -> dict[str, tuple[str, str | None]]:
    """Key and error of each log; each must be there once."""
    found = _native.read_rows(str(out))
    assert len({path for path, *_ in found}) == len(found)
    return {path: (key, error) for path, key, error, *_ in found}


def test_a_row_is_that_of_a_batch(fleet: Fleet, tmp_path: Path) -> None:
    found = [identify_uri(path, fleet.axis, law=LAW) for path in fleet.paths]
    _native.write_rows(str(tmp_path / "table.parquet"), [json.dumps(row) for row in found])
    assert (tmp_path / "table.parquet").read_bytes() == fleet.table
    first = found[fleet.paths.index(fleet.logs / "run000.csv")]
    assert (first["machine"], first["law"], first["error"]) == ("Z", LAW, None)
    named = {row["parameter"]: row for row in first["parameters"]}
    assert 18.0 < named["coulomb"]["low"] < named["coulomb"]["value"] < named["coulomb"]["high"] < 22.0
    assert abs(named["coulomb"]["value"] - 20.0) < 0.5
    assert [row["error"] for row in found if row["error"]] == ["log-format"] * 3 + ["log-io"]


def test_any_engine_maps_it(fleet: Fleet) -> None:
    """Processes that are started afresh, as those of Ray and joblib: the function is found by its name, the row is plain."""
    some = fleet.paths[-4:]
    assert pickle.loads(pickle.dumps(identify_uri)) is identify_uri
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.map(identify_uri, map(str, some))
    assert there == [identify_uri(path) for path in some]


def test_workers_that_are_killed_change_nothing(fleet: Fleet, workers: tuple[Any, Workers], tmp_path: Path) -> None:
    client, there = workers
    dice = random.Random(7)
    moments = sorted(dice.uniform(0.02, 0.95) for _ in range(KILLS))
    killed = 0

    def kill(progress: stiction.Progress) -> None:
        nonlocal killed
        while killed < KILLS and progress.fraction >= moments[killed]:
            # In the middle of something.
            time.sleep(dice.uniform(0.0, 0.2))
            there.kill(dice)
            killed += 1

    summary = run(fleet.logs, tmp_path / "out", fleet.axis, client=client, law=LAW, part_logs=15, progress=kill)
    assert killed == KILLS
    assert summary == fleet.summary and summary.identified == LOGS
    assert len(rows(tmp_path / "out")) == LOGS + 4
    assert whole(tmp_path / "out", tmp_path) == fleet.table
    names = sorted(os.listdir(tmp_path / "out"))
    assert names[0].startswith(".") and all(name.startswith("part-") for name in names[1:])


def test_a_second_run_does_what_is_new(fleet: Fleet, client: Any, command: Any, tmp_path: Path) -> None:
    logs, out = tmp_path / "logs", tmp_path / "out"
    paths = good(logs, 5)
    (logs / "empty.csv").write_bytes(b"")

    def again() -> Summary:
        return run(logs, out, fleet.axis, client=client, law=LAW, part_logs=4)

    assert again() == Summary(6, 5, 5, 0, {"log-format": 1}, True)
    before = {name: (out / name).stat().st_mtime_ns for name in os.listdir(out) if name.endswith(".parquet")}
    assert again() == Summary(6, 5, 5, 6, {"log-format": 1}, True)
    assert before == {name: (out / name).stat().st_mtime_ns for name in os.listdir(out) if name.endswith(".parquet")}
    # A log that has changed, one that is new, one that is mended.
    paths[1].write_text(text(70.0))
    (logs / "run100.csv").write_text(text(80.0))
    (logs / "empty.csv").write_text(text(90.0))
    assert again() == Summary(7, 7, 7, 4, {}, True)
    command("batch", logs, "--axis", fleet.axis, "--law", LAW, "--out", tmp_path / "batch")
    assert rows(out) == rows(tmp_path / "batch" / "results.parquet")
    # Other options are other rows.
    assert run(logs, out, client=client, law=LAW).taken == 0
    assert len(rows(out)) == 7
    # The command line reads it.
    said = command("drift", out, "--json").stdout
    assert json.loads(said)["input"]["logs"] == 7


def test_what_is_known_of_a_log_is_that_of_the_last_call(client: Any, tmp_path: Path) -> None:
    """Also of one that failed, and without identifying any of them again."""
    out = tmp_path / "out"
    paths = [*map(str, good(tmp_path / "logs", 2)), str(tmp_path / "gone.csv")]
    (tmp_path / "axis.toml").write_text(AXIS)

    def labelled(*labels: dict[str, Any]) -> tuple[int, list[Any]]:
        listed = [dict(label, path=path) for label, path in zip(labels, paths)]
        taken = run(listed, out, tmp_path / "axis.toml", client=client, law=LAW, part_logs=2).taken
        found = {path: label[:3] for path, *_, label in _native.read_rows(str(out))}
        return taken, [found[path] for path in paths]

    first: dict[str, Any] = dict(machine="A", time=1.0, temperature=20.0)
    assert labelled(first, first, first) == (0, [("A", 1.0, 20.0)] * 3)
    before = (out / "part-000001.parquet").read_bytes()
    assert labelled(first, first, first) == (3, [("A", 1.0, 20.0)] * 3)
    assert (out / "part-000001.parquet").read_bytes() == before
    mended: dict[str, Any] = dict(machine="B", time=2e9, temperature=30.0)
    assert labelled(mended, first, mended) == (3, [("B", 2e9, 30.0), ("A", 1.0, 20.0), ("B", 2e9, 30.0)])
    # Without a machine it is the name in the axis file again.
    assert labelled(dict(temperature=30.0), mended, mended)[1] == [("Z", None, 30.0), ("B", 2e9, 30.0), ("B", 2e9, 30.0)]
    # What was identified is untouched.
    last: list[dict[str, Any]] = [dict(temperature=30.0), mended, mended]
    rows_now = [identify_uri(path, tmp_path / "axis.toml", law=LAW, **known) for path, known in zip(paths, last)]
    _native.write_rows(str(tmp_path / "now.parquet"), [json.dumps(row) for row in rows_now])
    assert whole(out, tmp_path) == (tmp_path / "now.parquet").read_bytes()


def test_a_call_that_was_killed_between_two_steps_is_mended(client: Any, tmp_path: Path) -> None:
    logs, out = tmp_path / "logs", tmp_path / "out"
    good(logs, 3)
    run(logs, out, client=client, law=LAW)
    twice = (out / "part-000001.parquet").read_bytes()
    (out / "part-000002.parquet").write_bytes(twice)
    assert run(logs, out, client=client, law=LAW).taken == 3
    assert len(rows(out)) == 3


def test_no_log_ends_the_run(odd: Path, workers: tuple[Any, Workers], tmp_path: Path) -> None:
    """One that kills every process that reads it, one that grows, one that is gone, and a store that breaks down."""
    client, there = workers
    folder = tmp_path / "logs"
    for path in good(folder, 4):
        path.rename(folder / f"{['good', 'deadly', 'growing', 'broken'][int(path.stem[3:])]}.csv")
    names = ["deadly", "good", "growing", "vanished", "broken"]
    logs = [f"odd://{folder}/{name}.csv" for name in names]
    pids = there.pids()
    summary = run(logs, tmp_path / "out", client=client, law=LAW, retries=1)
    assert (summary.logs, summary.identified, summary.complete) == (5, 1, True)
    assert summary.failed == {"log-io": 3, "internal": 1}
    found = rows(tmp_path / "out")
    assert [found[uri][1] for uri in logs] == ["internal", None, "log-io", "log-io", "log-io"]
    assert there.pids() == pids and len(pids) == 2
    # The next call tries them again.
    assert run(logs, tmp_path / "out", client=client, law=LAW, retries=0).taken == 5
    for name, said in (
        ("growing", "changed while it was read"),
        ("vanished", "is not there"),
        ("broken", "no route to the store), 2 times"),
    ):
        row = identify_uri(f"odd://{folder}/{name}.csv", law=LAW, retries=1)
        assert said in row["message"] and str(folder) + "/" + name in row["message"], row["message"]


def test_a_stop_keeps_what_is_done(fleet: Fleet, client: Any, tmp_path: Path) -> None:
    def stop(progress: stiction.Progress) -> bool:
        # The first batches are of one log each, later ones of many.
        return progress.fraction < 0.1

    first = run(fleet.logs, tmp_path / "out", fleet.axis, client=client, law=LAW, progress=stop)
    assert not first.complete and 0 < len(rows(tmp_path / "out")) == first.logs < LOGS
    rest = run(fleet.logs, tmp_path / "out", fleet.axis, client=client, law=LAW)
    assert rest.complete and rest.taken == first.logs - sum(first.failed.get(code, 0) for code in ("log-io",))
    assert whole(tmp_path / "out", tmp_path) == fleet.table


@pytest.fixture(scope="module")
def bucket() -> Iterator[tuple[str, dict[str, Any]]]:
    """A bucket on a server of its own process that speaks S3, and how to get there."""
    pytest.importorskip("moto.server")
    s3fs = pytest.importorskip("s3fs")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    words = [sys.executable, "-c", "from moto.server import main; main()", "-H", "127.0.0.1", "-p", str(port)]
    server = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    options = {"endpoint_url": f"http://127.0.0.1:{port}", "key": "test", "secret": "test"}
    try:
        deadline = time.monotonic() + 60.0
        while True:
            try:
                with socket.create_connection(("127.0.0.1", port), timeout=1.0):
                    break
            except OSError:
                assert server.poll() is None and time.monotonic() < deadline
                time.sleep(0.05)
        s3fs.S3FileSystem(**options).mkdir("fleet")
        yield "s3://fleet", options
    finally:
        server.kill()
        server.wait()


def test_logs_and_results_in_a_store(bucket: tuple[str, dict[str, Any]], client: Any, command: Any, tmp_path: Path) -> None:
    root, options = bucket
    folder = tmp_path / "logs"
    good(folder, 6)
    bad(folder)
    (folder / "vanished.csv").unlink()
    (folder / "list.csv").write_text("path,machine,axis\n" + "".join(f"run{k:03}.csv,M{k % 2},../z.toml\n" for k in range(6)))
    (tmp_path / "z.toml").write_text(AXIS)
    store, _ = fsspec.core.url_to_fs(root, **options)
    store.put(f"{folder}/", f"{root}/logs/", recursive=True)
    store.put_file(tmp_path / "z.toml", f"{root}/z.toml")
    command("batch", folder / "list.csv", "--law", LAW, "--out", tmp_path / "batch")
    of_batch = rows(tmp_path / "batch" / "results.parquet")

    def again() -> Summary:
        return run(f"{root}/logs/list.csv", f"{root}/out", client=client, law=LAW, storage_options=options, part_logs=4)

    assert again() == Summary(6, 6, 6, 0, {}, True)
    assert again().taken == 6
    store.invalidate_cache()
    store.get(f"{root}/out/", f"{tmp_path}/out/", recursive=True)
    assert sorted(os.listdir(tmp_path / "out")) == ["part-000001.parquet", "part-000002.parquet"]
    # The key is that of the same bytes elsewhere, and so is all but the names.
    found = rows(tmp_path / "out")
    assert {uri.replace(f"{root}/logs", str(folder)): row for uri, row in found.items()} == of_batch
    # The axis is known by its bytes, its path may be any: as in the table, with ".." in it.
    there = identify_uri(f"{root}/logs/run001.csv", f"{root}/z.toml", law=LAW, storage_options=options)
    here = identify_uri(folder / "run001.csv", tmp_path / "z.toml", law=LAW)
    assert there["path"] == f"{root}/logs/run001.csv" and there["axis"] == f"{root}/z.toml"
    for row in (here, there):
        del row["path"], row["axis"]
    assert here == there
    # A folder with everything in it: the bad logs have rows that name their address.
    everything = run(f"{root}/logs/", tmp_path / "all", client=client, law=LAW, storage_options=options)
    assert (everything.logs, everything.identified) == (10, 6)
    gone = identify_uri(f"{root}/logs/gone.csv", storage_options=options)
    assert gone["error"] == "log-io" and gone["message"].startswith(f"{root}/logs/gone.csv: is not there")


def refused(work: Any, *arguments: Any, **options: Any) -> stiction.StictionError:
    with pytest.raises(stiction.StictionError) as caught:
        work(*arguments, **options)
    return caught.value


def test_arguments_are_named(client: Any, tmp_path: Path) -> None:
    out = tmp_path / "out"
    wrong: dict[str, dict[str, Any]] = {
        "uri": {"uri": 3},
        "law": {"uri": "a.csv", "law": "lugree"},
        "method": {"uri": "a.csv", "method": "guess"},
        "seed": {"uri": "a.csv", "seed": -1},
        "split": {"uri": "a.csv", "split": "half"},
        "time": {"uri": "a.csv", "time": "today"},
        "temperature": {"uri": "a.csv", "temperature": []},
        "retries": {"uri": "a.csv", "retries": 1000},
        "max_memory": {"uri": "a.csv", "max_memory": 5},
        "storage_options": {"uri": "a.csv", "storage_options": "key"},
        "axis": {"uri": "a.csv", "axis": 4.0},
    }
    for place, arguments in wrong.items():
        error = refused(identify_uri, **arguments)
        assert (error.code, error.place) == ("usage", place)
    assert "fsspec knows" in refused(identify_uri, "nowhere://a.csv").allowed
    for place, logs in {
        "logs": [],
        "logs[0]": [4],
        "logs[1]": ["a.csv", {"machine": "M"}],
        "logs[0]['time']": [{"path": "a.csv", "time": "noon"}],
        "logs[0]['path']": [{"path": None}],
    }.items():
        assert refused(run, logs, out, client=client).place == place
    assert refused(run, 5, out, client=client).place == "logs"
    assert refused(run, ["a.csv"], out, client="tcp://127.0.0.1:1").place == "client"
    assert refused(run, ["a.csv"], out, client=client, part_logs=0).place == "part_logs"
    assert refused(run, tmp_path / "no", out, client=client).code == "log-io"
    (tmp_path / "file").write_text("")
    assert refused(run, ["a.csv"], tmp_path / "file", client=client).code == "output"


@pytest.mark.parametrize(
    "when",
    [
        "2026-03-01T06:30:00+01:00",
        "2026-03-01 05:30",
        "1772343000",
        1772343000,
        datetime.datetime(2026, 3, 1, 5, 30),
        datetime.datetime(2026, 3, 1, 6, 30, tzinfo=datetime.timezone(datetime.timedelta(hours=1))),
        numpy.datetime64("2026-03-01T05:30"),
        numpy.float64(1772343000.0),
    ],
)
def test_a_time_is_what_a_list_may_have(when: Any, tmp_path: Path) -> None:
    from stiction.fleet._logs import logs_of

    path = str(tmp_path / "gone.csv")
    assert [log.time for log in logs_of([{"path": path, "time": when}], None, "out", {})] == [1772343000.0]
    assert identify_uri(path, time=when)["time"] == 1772343000.0


def test_what_is_no_time_is_refused_with_what_is_one(client: Any, tmp_path: Path) -> None:
    none: list[Any] = ["noon", "01.03.2026", float("inf"), [], True, datetime.time(3)]
    for when in none:
        error = refused(run, [{"path": "a.csv", "time": when}], tmp_path, client=client)
        assert error.place == "logs[0]['time']" and "ISO 8601" in error.allowed, error
    twice = refused(run, ["a.csv", {"path": "b.csv"}, {"path": "b.csv", "machine": "M"}], tmp_path, client=client)
    assert twice.place == "logs[2]['path']" and "logs[1]" in twice.found


def test_one_call_at_a_time(client: Any, tmp_path: Path) -> None:
    from stiction.fleet._parts import Parts

    with Parts(str(tmp_path), {}, 0).held():
        assert "another call" in refused(run, ["a.csv"], tmp_path, client=client).found
