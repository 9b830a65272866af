"""Friction over time: what the command line finds, from tables in files and in memory."""

from __future__ import annotations

import datetime
import json
import pickle
from pathlib import Path
from typing import Any

import drift_rows
import numpy
import pytest
import stiction

LIMITS = ["coulomb > 1.2", "coulomb > 26 N"]


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return drift_rows.table(tmp_path_factory.mktemp("drift") / "results.parquet")


@pytest.fixture(scope="module")
def found(table: Path) -> stiction.Drift:
    return stiction.drift(table, limit=LIMITS)


def test_a_table_gives_what_the_command_line_gives(table: Path, found: stiction.Drift, command: Any, tmp_path: Path) -> None:
    typed = [word for limit in LIMITS for word in ("--limit", limit)]
    assert command("drift", table, *typed).stdout == str(found)
    command("drift", table, *typed, "--out", tmp_path / "typed", "--quiet")
    saved = found.save(tmp_path / "saved")
    assert sorted(path.name for path in saved) == ["drift.json", "report.html"]
    for path in saved:
        assert path.read_bytes() == (tmp_path / "typed" / path.name).read_bytes()
    assert found.result == json.loads((tmp_path / "typed" / "drift.json").read_text())


def test_the_machine_that_changed_is_named(found: stiction.Drift) -> None:
    assert found.changed
    assert {alarm["machine"] for alarm in found.alarms} == {drift_rows.STEPS}
    assert {alarm["kind"] for alarm in found.alarms} == {"step", "limit"}
    [noise] = found.noise
    assert noise["parameter"] == "coulomb" and len(noise["limits"]) == 3
    assert noise["by_temperature"] == pytest.approx(-0.005, abs=0.001)
    assert "m3" in found.report() and "iframe" in found._repr_html_()


def test_a_course_has_a_number_for_each_log(found: stiction.Drift) -> None:
    [course] = found.courses
    given = [row for row in drift_rows.rows() if row["machine"] == drift_rows.STEPS]
    assert (course.machine, course.parameter, course.law, course.unit) == (drift_rows.STEPS, "coulomb", "coulomb-viscous", "N")
    assert course.logs == [row["path"] for row in given]
    numpy.testing.assert_array_equal(course.time, [row["time"] for row in given])
    numpy.testing.assert_array_equal(course.value, [row["parameters"][0]["value"] for row in given])
    numpy.testing.assert_array_equal(course.temperature, [row["temperature"] for row in given])
    assert numpy.all((course.low < course.corrected) & (course.corrected < course.high))
    assert course.reference == pytest.approx(20.0, rel=0.02)


def test_a_table_in_memory_gives_the_same(found: stiction.Drift) -> None:
    of_rows = stiction.drift(drift_rows.rows(), limit=LIMITS)
    of_columns = stiction.drift(drift_rows.columns(), limit=LIMITS)
    for other in (of_rows, of_columns):
        assert other.alarms == found.alarms and other.noise == found.noise
        numpy.testing.assert_array_equal(other.courses[0].corrected, found.courses[0].corrected)
        assert other.result["input"]["path"] == "results"


def test_a_folder_of_tables_does_as_well(table: Path, found: stiction.Drift) -> None:
    assert stiction.drift(table.parent, limit=LIMITS).alarms == found.alarms


def test_it_can_be_pickled(found: stiction.Drift, tmp_path: Path) -> None:
    again: stiction.Drift = pickle.loads(pickle.dumps(found))
    assert str(again) == str(found) and again.result == found.result
    numpy.testing.assert_array_equal(again.courses[0].low, found.courses[0].low)
    assert again.save(tmp_path / "out")[0].exists()


def test_without_a_limit_and_a_change_nothing_is_alarmed() -> None:
    quiet = stiction.drift([row for row in drift_rows.rows() if row["machine"] != drift_rows.STEPS])
    assert not quiet.changed and quiet.courses == []


def test_times_may_be_stamps_and_dates(found: stiction.Drift) -> None:
    """As in a list of logs; without a zone they are in UTC."""
    columns = drift_rows.columns()
    zone = datetime.timezone(datetime.timedelta(hours=5))
    for times in (
        [datetime.datetime.fromtimestamp(t, zone) for t in columns["time"]],
        [datetime.datetime.fromtimestamp(t, datetime.timezone.utc).replace(tzinfo=None) for t in columns["time"]],
        (numpy.array(columns["time"]) * 1e9).astype("M8[ns]"),
        [datetime.datetime.fromtimestamp(t, zone).isoformat() for t in columns["time"]],
    ):
        assert stiction.drift({**columns, "time": times}, limit=LIMITS).alarms == found.alarms
    days = [datetime.datetime.fromtimestamp(t, datetime.timezone.utc).date() for t in columns["time"]]
    midnight = stiction.drift({**columns, "time": days}).courses[0].time
    assert numpy.all(midnight % drift_rows.DAY == 0.0)


def test_rows_may_come_from_a_data_frame(found: stiction.Drift) -> None:
    """Which has NaN where nothing is known."""
    rows = [{**row, "error": float("nan"), "message": float("nan")} for row in drift_rows.rows()]
    assert stiction.drift(rows, limit=LIMITS).alarms == found.alarms


def without(key: str) -> dict[str, Any]:
    return {name: cells for name, cells in drift_rows.columns().items() if name != key}


@pytest.mark.parametrize(
    ("results", "limit", "place", "found"),
    [
        (drift_rows.columns(), "coulomb", "", "the limit"),
        (drift_rows.columns(), "stribeck > 2", "", "no log determines stribeck"),
        (drift_rows.columns(), "coulomb > 3 m", "", "is not in m"),
        (drift_rows.columns(), 5, "limit", "5"),
        (without("key"), [], "column key", "is not there"),
        (without("schema"), [], "column schema", "is not there"),
        ({**drift_rows.columns(), "value": ["much"] * 240}, [], "row 1, column value", "much"),
        ({**drift_rows.columns(), "identifiable": [1.0] * 240}, [], "row 1, column identifiable", "1"),
        ({**drift_rows.columns(), "machine": numpy.arange(240)}, [], "row 1, column machine", "0"),
        ({**drift_rows.columns(), "time": [1.0, "late"] * 120}, [], "results['time'], row 2", "'late'"),
        ({**drift_rows.columns(), "time": [b""] * 240}, [], "results['time'], row 1", "b''"),
        ({**drift_rows.columns(), "unit": ["N"]}, [], "results['unit']", "1 rows"),
        (drift_rows.rows()[0], [], "results['path']", "a str"),
        ([], [], "", "0 logs"),
        ([{"path": "a"}], [], "results[0]", "missing field"),
        (["a"], [], "results[0]", "a str"),
        (7, [], "results", "an int"),
        (None, [], "results", "None"),
        ([{**drift_rows.rows()[0], "time": "late"}], [], "results[0]", "invalid type: string \"late\", expected f64"),
        ("nowhere.parquet", [], "nowhere.parquet", "cannot be read"),
    ],
)
def test_what_cannot_be_taken_is_named(results: Any, limit: Any, place: str, found: str) -> None:
    with pytest.raises(stiction.StictionError) as error:
        stiction.drift(results, limit=limit)
    assert place in error.value.place and found in error.value.found, error.value
    assert error.value.allowed or place == "nowhere.parquet"
