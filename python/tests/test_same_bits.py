"""The package gives the bits of the command line."""

from __future__ import annotations

import json
import pickle
import tomllib
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction
from conftest import quietly


def without_times(result: dict[str, Any]) -> dict[str, Any]:
    """A result without the time that its search took."""
    out = json.loads(json.dumps(result))
    for key in ("search", "searched"):
        if isinstance(out.get(key), dict):
            out[key] = {k: v for k, v in out[key].items() if "seconds" not in k and not k.endswith("_s")}
    return dict(out)


def test_an_identification_is_that_of_the_command_line(run_csv: Path, command: Any, tmp_path: Path) -> None:
    command("identify", run_csv, "--out", tmp_path / "theirs")
    fit = quietly(stiction.identify, run_csv)
    fit.save(tmp_path / "ours")
    for name in ("model.toml", "fit.csv", "study.toml"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    theirs = json.loads((tmp_path / "theirs" / "result.json").read_text())
    assert without_times(fit.result) == without_times(theirs)
    # Of the folder of the command line the same fit is loaded.
    loaded = stiction.load(tmp_path / "theirs")
    assert loaded.parameters.rows == fit.parameters.rows
    assert loaded.verdict == fit.verdict
    assert numpy.array_equal(loaded.residual, fit.residual)
    assert numpy.array_equal(loaded.covariance.matrix, fit.covariance.matrix)
    assert loaded.save(tmp_path / "again")
    for name in ("result.json", "model.toml", "fit.csv", "report.html"):
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name


def test_an_axis_file_and_options_do_the_same(run_csv: Path, command: Any, tmp_path: Path) -> None:
    axis = tmp_path / "axis.toml"
    axis.write_text('name = "X"\nkind = "linear"\n[conditioning]\ndecimate = 6\n')
    command(
        "identify", run_csv, "--axis", axis, "--law", "stribeck", "--asymmetric", "--split", "0.7", "--seed", "5",
        "--out", tmp_path / "theirs",
    )
    options: Any = {"law": "stribeck", "asymmetric": True, "split": 0.7, "run": stiction.Run(5)}
    fit = quietly(stiction.identify, run_csv, axis, **options)
    fit.save(tmp_path / "ours")
    same = (tmp_path / "theirs" / "model.toml").read_bytes()
    assert (tmp_path / "ours" / "model.toml").read_bytes() == same
    # The same keys in a dict, and logs that were read before.
    known = {"name": "X", "kind": "linear", "conditioning": {"decimate": 6}}
    again = quietly(stiction.identify, quietly(stiction.read_log, run_csv, known), **options)
    assert again.parameters.rows == fit.parameters.rows


def test_arrays_are_read_as_a_file_with_these_columns(run_csv: Path, arrays: dict[str, Any], fit: stiction.Fit) -> None:
    of_file = quietly(stiction.read_log, run_csv)
    of_arrays = quietly(stiction.read_log, arrays)
    for channel in ("time", "position", "force", "reference"):
        assert numpy.array_equal(getattr(of_file, channel), getattr(of_arrays, channel)), channel
    again = quietly(stiction.identify, of_arrays, law="lugre", run=stiction.Run(compare_laws=False))
    assert again.parameters.rows == fit.parameters.rows


def test_threads_do_not_change_a_bit(run_csv: Path, fit: stiction.Fit) -> None:
    alone = quietly(stiction.identify, run_csv, law="lugre", run=stiction.Run(compare_laws=False, threads=1))
    assert alone.parameters.rows == fit.parameters.rows


def test_a_check_is_that_of_the_command_line(run_csv: Path, arrays: dict[str, Any], command: Any) -> None:
    theirs = json.loads(command("check", run_csv, "--json").stdout)
    ours = quietly(stiction.check, run_csv)
    assert ours.result == theirs
    assert str(ours) == command("check", run_csv, "--verbose").stdout
    of_arrays = quietly(stiction.check, arrays)
    assert of_arrays.logs[0]["parameters"] == theirs["logs"][0]["parameters"]


def test_code_is_that_of_the_command_line(fit: stiction.Fit, command: Any, tmp_path: Path) -> None:
    fit.save(tmp_path / "fit")
    model = tmp_path / "fit" / "model.toml"
    command("export", model, "--target", "c", "--cycle-time", "0.00025", "--gain", "0.5", "--out", tmp_path / "theirs")
    ours = quietly(fit.export, "c", tmp_path / "ours", cycle_time=250e-6, compensator=stiction.Compensator(gain=0.5))
    of_file = quietly(stiction.export, model, "c", tmp_path / "of-file", cycle_time=250e-6, compensator=stiction.Compensator(gain=0.5))
    names = sorted(path.name for path in (tmp_path / "theirs").iterdir())
    assert sorted(path.name for path in ours.files) == names
    for name in names:
        theirs = (tmp_path / "theirs" / name).read_bytes()
        assert (tmp_path / "ours" / name).read_bytes() == theirs, name
        assert (of_file.folder / name).read_bytes() == theirs, name


def test_a_study_is_that_of_the_command_line(fit: stiction.Fit, command: Any, tmp_path: Path) -> None:
    fit.save(tmp_path / "fit")
    study = tmp_path / "fit" / "study.toml"
    command("simulate", study, "--out", tmp_path / "theirs")
    theirs = json.loads((tmp_path / "theirs" / "study.json").read_text())
    # Of a fit that is in no folder.
    unsaved = pickle.loads(pickle.dumps(fit))
    unsaved._folder = None
    ours = quietly(unsaved.simulate)
    assert ours.rows == theirs["results"]
    written = ours.save(tmp_path / "ours")
    again = pickle.loads(pickle.dumps(ours))
    assert (again.result, again.verdict, again.report()) == (ours.result, ours.verdict, ours.report())
    assert sorted(p.name for p in written) == sorted(p.name for p in (tmp_path / "theirs").iterdir())


LIMITED = """kind = "linear"
rate = "1 kHz"
[limits]
stroke = ["-100 mm", "100 mm"]
speed = "0.2 m/s"
acceleration = "6 m/s2"
jerk = "1500 m/s3"
rated_force = "150 N"
peak_force = "200 N"
mass = "10 kg"
[log]
resolution = "50 nm"
[controller]
bandwidth = "60 Hz"
"""


def test_a_plan_is_that_of_the_command_line(fit: stiction.Fit, command: Any, tmp_path: Path) -> None:
    axis = tmp_path / "axis.toml"
    axis.write_text(LIMITED)
    fit.save(tmp_path / "fit")
    model = tmp_path / "fit" / "model.toml"
    command("plan", axis, "--model", model, "--time", "2", "--out", tmp_path / "theirs")
    plan = quietly(fit.plan, axis, time=2.0)
    plan.save(tmp_path / "ours")
    for name in ("plan.toml", "setpoints.csv"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    # The same keys in a dict give the same motion.
    of_keys = quietly(fit.plan, tomllib.loads(LIMITED), time=2.0)
    assert all(numpy.array_equal(of_keys.setpoints[name], column) for name, column in plan.setpoints.items())
    assert of_keys.result["inputs"][0]["path"] == "axis.toml" and "--axis axis.toml" in str(of_keys)
    with pytest.raises(stiction.StictionError) as caught:
        quietly(stiction.plan, {"kind": "linear"})
    assert str(caught.value).startswith("[bad-config] axis: limits.stroke: is missing")
    theirs = tmp_path / "each"
    command("plan", axis, "--asymmetric", "--time", "2", "--out", theirs)
    sides = quietly(stiction.plan, axis, asymmetric=True, time=2.0)
    sides.save(tmp_path / "both")
    for name in ("plan.toml", "setpoints.csv"):
        assert (tmp_path / "both" / name).read_bytes() == (theirs / name).read_bytes()
    assert "coulomb_neg" in {row["name"] for row in sides.result["parameter"]}
    with pytest.raises(stiction.StictionError, match="law gms"):
        quietly(stiction.plan, axis, law="gms")
    with pytest.raises(stiction.StictionError, match="law"):
        quietly(stiction.plan, axis, law="coulomb")

    motion = plan.setpoints
    assert list(motion) == ["t", "x", "v", "a"]
    assert motion["v"][0] == motion["v"][-1] == 0.0
    assert plan.expected
    again = pickle.loads(pickle.dumps(plan))
    assert (again.result, str(again), again.report()) == (plan.result, str(plan), plan.report())
