"""The command line that the wheel brings: the script of the environment and `python -m stiction`, against the program."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

import pytest

SCRIPT = [str(Path(sysconfig.get_path("scripts")) / "stiction")]
MODULE = [sys.executable, "-m", "stiction"]


def run(command: list[str], *words: Any, folder: Path | None = None) -> tuple[int, str, str]:
    done = subprocess.run([*command, *map(str, words)], capture_output=True, text=True, check=False, cwd=folder)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize("command", [SCRIPT, MODULE], ids=["script", "module"])
@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--version"], 0),
        (["--help"], 0),
        (["identify", "--help"], 0),
        (["library"], 0),
        (["completions", "bash"], 0),
        ([], 2),
        (["identify"], 2),
        (["identify", "none.csv", "--out", "out"], 2),
        (["identfy", "none.csv"], 2),
        (["check", "none.csv", "--json"], 2),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_it_says_what_the_program_says(program: Path, tmp_path: Path, command: list[str], words: list[str], code: int) -> None:
    theirs = run([str(program)], *words, folder=tmp_path)
    assert run(command, *words, folder=tmp_path) == theirs
    assert theirs[0] == code


def test_the_demo_is_the_same_bytes(program: Path, tmp_path: Path) -> None:
    said = {}
    for name, command in [("theirs", [str(program)]), ("ours", SCRIPT)]:
        (tmp_path / name).mkdir()
        code, out, err = run(command, "demo", "--out", "demo", "--threads", "1", folder=tmp_path / name)
        assert (code, err) == (0, "")
        said[name] = out
    assert said["ours"] == said["theirs"]
    files = sorted(path.relative_to(tmp_path / "theirs") for path in (tmp_path / "theirs").rglob("*") if path.is_file())
    assert len(files) > 4
    assert files == sorted(path.relative_to(tmp_path / "ours") for path in (tmp_path / "ours").rglob("*") if path.is_file())
    for file in files:
        pair = [(tmp_path / name / file).read_bytes() for name in ("ours", "theirs")]
        if file.name == "result.json":
            ours, theirs = map(json.loads, pair)
            for result in (ours, theirs):
                result["search"]["wall_s"] = 0.0
            assert ours == theirs
        elif file.suffix != ".html":  # which states the time that the search took
            assert pair[0] == pair[1], file


def test_a_result_that_is_not_to_be_used_is_exit_code_1(program: Path, tmp_path: Path, run_csv: Path) -> None:
    words = ["identify", run_csv, "--law", "coulomb-viscous", "--quiet", "--out"]
    assert [run(command, *words, tmp_path / name)[0] for name, command in [("a", [str(program)]), ("b", SCRIPT)]] == [1, 1]


def test_a_reader_that_goes_away_is_no_fault(program: Path) -> None:
    for command in ([str(program)], SCRIPT, MODULE):
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([*command, "--help"], stdout=writer, stderr=subprocess.PIPE, check=False)
        os.close(writer)
        assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.skipif(os.name != "posix", reason="closes its output")
def test_a_closed_output_is_not_a_file_of_the_result(tmp_path: Path) -> None:
    words = " ".join(f"'{word}'" for word in SCRIPT)
    subprocess.run(["sh", "-c", f"{words} library xl330 --out machine >&- 2>&-"], check=True, cwd=tmp_path)
    assert (tmp_path / "machine" / "model.toml").read_text().startswith(("#", "schema", "["))


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_keeps_the_best(tmp_path: Path, run_csv: Path) -> None:
    words = ["identify", run_csv, "--law", "lugre", "--method", "ga", "--cost", "separable", "--evaluations", 10**9, "--target", 1e-30]
    kept = tmp_path / "state"
    with subprocess.Popen(
        [*SCRIPT, *map(str, words), "--checkpoint", kept, "--out", tmp_path / "out"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Where the tests are started in the background signals are ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    ) as process:
        while not kept.exists():
            assert process.poll() is None
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
    assert process.returncode == 130, err
    assert "Traceback" not in err
    assert json.loads((tmp_path / "out" / "result.json").read_text())["search"]["status"] == "interrupted"


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_the_studio_is_there_and_ends_with_ctrl_c(tmp_path: Path) -> None:
    with subprocess.Popen([*SCRIPT, "studio", tmp_path, "--no-open"], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("http://127.0.0.1:")
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 0


def test_the_command_needs_no_numpy() -> None:
    line = "import sys; sys.argv = ['stiction', '--version']; from stiction._command import main; main(); print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[1] == "False"
