"""The library, and recording: what the command line prints and writes."""

from __future__ import annotations

import json
import socket
import struct
import threading
from pathlib import Path
from typing import Any

import pytest
import stiction
from conftest import quietly


def test_the_library_is_that_of_the_command_line(command: Any, tmp_path: Path) -> None:
    theirs = json.loads(command("library", "--json").stdout)
    library = stiction.library()
    assert [machine.result for machine in library.values()] == theirs["machines"]
    assert "xl330" in library and len(library) > 3
    with pytest.raises(KeyError, match="it has .*xl330"):
        library["none"]
    command("library", "xl330", "--out", tmp_path / "theirs")
    written = library["xl330"].write(tmp_path / "ours")
    assert sorted(path.name for path in written) == sorted(path.name for path in (tmp_path / "theirs").iterdir())
    for path in written:
        assert path.read_bytes() == (tmp_path / "theirs" / path.name).read_bytes()
    assert library["xl330"].files["model.toml"] == (tmp_path / "ours" / "model.toml").read_text()
    code = quietly(stiction.export, tmp_path / "ours" / "model.toml", "c", tmp_path / "c")
    assert any(path.suffix == ".c" for path in code.files)


def test_a_robot_of_the_library_says_which_urdf_it_needs(tmp_path: Path) -> None:
    robot = next(machine for machine in stiction.library().values() if machine.result["kind"] == "robot")
    robot.write(tmp_path / "robot")
    with pytest.raises(stiction.StictionError) as caught:
        stiction.export(tmp_path / "robot" / "robot.toml", "urdf", tmp_path / "out")
    assert "urdf" in str(caught.value)
    with pytest.raises(stiction.StictionError) as caught:
        stiction.export(tmp_path / "robot" / "machine.json", "c", tmp_path / "out", urdf="arm.urdf")
    assert caught.value.place == "urdf"


JOINTS = ["actual_q", "actual_qd", "actual_current", "target_q", "target_moment", "joint_temperatures"]


def server(samples: int) -> tuple[str, threading.Thread]:
    """A controller that sends so many samples at 125 Hz in the form of RTDE, version 2, as fast as they are taken."""
    listener = socket.create_server(("127.0.0.1", 0))

    def package(kind: int, payload: bytes) -> bytes:
        return struct.pack(">HB", 3 + len(payload), kind) + payload

    def serve() -> None:
        connection, _ = listener.accept()
        stream = connection.makefile("rb")
        while True:
            size, kind = struct.unpack(">HB", stream.read(3))
            payload = stream.read(size - 3)
            if kind == ord("V"):
                connection.sendall(package(kind, b"\x01"))
            elif kind == ord("v"):
                connection.sendall(package(kind, struct.pack(">IIII", 5, 11, 0, 0)))
            elif kind == ord("O"):
                names = payload[8:].decode().split(",")
                kinds = ["DOUBLE" if name == "timestamp" else "VECTOR6D" for name in names]
                connection.sendall(package(kind, b"\x01" + ",".join(kinds).encode()))
                numbers = sum(1 if kind == "DOUBLE" else 6 for kind in kinds)
                first = sum(1 if kind == "DOUBLE" else 6 for kind in kinds[: names.index("timestamp")])
            elif kind == ord("S"):
                connection.sendall(package(kind, b"\x01"))
                for k in range(samples):
                    values = [0.1 * k + place for place in range(numbers)]
                    values[first] = 100.0 + 0.008 * k
                    connection.sendall(package(ord("U"), b"\x01" + struct.pack(f">{numbers}d", *values)))
                return

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    return f"rtde://127.0.0.1:{listener.getsockname()[1]}", thread


def test_a_device_is_recorded(tmp_path: Path) -> None:
    url, _ = server(500)
    told: list[stiction.Progress] = []
    found = stiction.record(url, tmp_path / "log.csv", time=2.0, run=stiction.Run(progress=told.append))
    assert (found.path, found.samples, found.seconds, found.rate_hz) == (tmp_path / "log.csv", 251, 2.0, 125.0)
    assert found.complete and found.fault is None and (found.lost, found.gaps) == (0, 0)
    assert len((tmp_path / "log.csv").read_text().splitlines()) == 252
    assert told and told[-1].stage == "recording"
    # What is there is kept.
    with pytest.raises(stiction.StictionError):
        stiction.record(url, tmp_path / "log.csv", time=1.0)


def test_a_recording_that_is_stopped_is_kept(tmp_path: Path) -> None:
    url, _ = server(500)
    found = stiction.record(url, tmp_path / "log.csv", run=stiction.Run(progress=lambda p: False))
    assert not found.complete and found.fault is None


@pytest.mark.parametrize("device", ["rtde://127.0.0.1:1", "modbus://1.2.3.4", ["ads://x"]])
def test_a_device_that_is_not_there_is_named(device: Any, tmp_path: Path) -> None:
    with pytest.raises(stiction.StictionError) as caught:
        stiction.record(device, tmp_path / "log.csv", time=1.0)
    assert caught.value.code
    assert not (tmp_path / "log.csv").exists()
