"""Whatever arrays come in: accepted as they are meant, or refused with the name of the argument."""

from __future__ import annotations

import datetime
import decimal
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction
from conftest import quietly
from stiction import StictionError

Compensator: Any = stiction.Compensator
Draws: Any = stiction.Draws
Procedures: Any = stiction.Procedures
Run: Any = stiction.Run
Search: Any = stiction.Search
# Any: values of other types are what is tested.

T = numpy.arange(4000) * 1e-3
GOOD: dict[str, Any] = {
    "time [s]": T,
    "position [mm]": 50 * numpy.sin(6 * T),
    "force [N]": 20 * numpy.sign(numpy.cos(6 * T)) + 18 * numpy.cos(6 * T) - 16.2 * numpy.sin(6 * T),
}


def refused(data: Any, **options: Any) -> StictionError:
    with pytest.raises(StictionError) as caught:
        quietly(stiction.read_log, data, **options)
    error = caught.value
    assert error.code
    assert error.found
    assert str(error).startswith(f"[{error.code}]")
    return error


def other(values: Any, column: str = "position [mm]") -> dict[str, Any]:
    return {**GOOD, column: values}


@pytest.mark.parametrize(
    ("values", "found"),
    [
        (GOOD["position [mm]"].reshape(2, -1), "shape (2, 2000)"),
        (numpy.float64(3.0), "a float64"),
        ("1.0", "a str"),
        ((x for x in (1.0, 2.0)), "a generator"),
        (GOOD["position [mm]"].astype(object), "objects"),
        ([decimal.Decimal(1)] * 4000, "a Decimal in row 1"),
        ([1.0, None] * 2000, "None in row 2"),
        ([datetime.time(3)] * 4000, "a time in row 1"),
        (numpy.array([[1.0], "a"] * 2000, dtype=object), "a list in row 1"),
        (GOOD["position [mm]"].astype(complex), "complex128"),
        (numpy.array(["1"] * 4000), "<U1"),
        (numpy.zeros(4000, dtype=[("a", float)]), "[('a', '<f8')]"),
        ([[1.0], [1.0, 2.0]], "no array"),
        (["a"] * 4000, "<U1"),
        (None, "None"),
        ((GOOD["position [mm]"], "mm", 3), "a tuple of 3"),
        ((GOOD["position [mm]"], 3), "a tuple of 2"),
        (GOOD["position [mm]"][:-1], "3999 samples"),
    ],
)
def test_a_column_that_cannot_be_taken_is_named(values: Any, found: str) -> None:
    error = refused(other(values))
    assert error.place == "log['position [mm]']"
    assert error.code == "usage"
    assert found in error.found
    assert error.allowed


def test_integers_that_would_lose_digits_are_refused() -> None:
    stamps = 1_700_000_000_000_000_000 + numpy.arange(4000) * 1_000_000
    error = refused({**GOOD, "time [s]": stamps})
    assert (error.place, "2**53" in error.found) == ("log['time [s]']", True)
    assert "subtract" in error.allowed


@pytest.mark.parametrize(
    ("data", "found"),
    [
        ({}, "no column"),
        ({3: T}, "a column called 3"),
        ({" ": T}, "a column called ' '"),
        ({"a\udc80": T}, "a column called 'a\\udc80'"),
    ],
)
def test_a_table_that_is_none_is_refused(data: Any, found: str) -> None:
    assert found in refused(data).found


@pytest.mark.parametrize("data", [3, 2.5, T, [1, 2], object(), "", None])
def test_what_is_no_log_is_refused_with_what_is_one(data: Any) -> None:
    error = refused(data)
    assert error.place == "log"
    assert "DataFrame" in error.allowed


@pytest.mark.parametrize(
    ("values", "advice"),
    [
        ([None] * 4000, "NaN"),
        ([datetime.time(3)] * 4000, "seconds"),
        (["1.5"] * 4000, "astype(float)"),
        (numpy.array(["1.5"] * 4000, dtype=object), "astype(float)"),
        (["2026-01-01T00:00:00.5"] * 4000, "to_datetime"),
        (["on"] * 4000, "leave columns of text out"),
        (GOOD["time [s]"].astype(object), "astype(float)"),
    ],
)
def test_an_array_of_objects_is_refused_with_what_makes_it_one_of_numbers(values: Any, advice: str) -> None:
    assert advice in refused(other(values)).allowed


START = datetime.datetime(2026, 3, 1, 6, 30)
STAMPS = [START + datetime.timedelta(seconds=t) for t in T]


@pytest.mark.parametrize(
    "times",
    [
        STAMPS,
        [stamp.replace(tzinfo=datetime.timezone.utc) for stamp in STAMPS],
        [stamp - START for stamp in STAMPS],
        numpy.array(STAMPS, dtype="M8[ns]"),
        numpy.array(STAMPS, dtype="M8[us]") - numpy.datetime64(START),
    ],
)
@pytest.mark.parametrize("header", ["time", "time [s]", "t [ms]"])
def test_times_are_seconds_from_the_first(times: Any, header: str) -> None:
    columns = {header: times, **{name: values for name, values in GOOD.items() if name != "time [s]"}}
    log = quietly(stiction.read_log, columns)
    assert (log.samples, log.rate_hz) == (4000, 1000.0)
    assert numpy.allclose(log.time, T, rtol=0.0, atol=1e-9)
    assert "unit s" in " ".join(log.detected)


def test_times_are_no_position_and_have_no_other_unit() -> None:
    assert "position or velocity" in refused(other(numpy.array(STAMPS, dtype="M8[ns]"))).found
    error = refused({**GOOD, "time [s]": (STAMPS, "ms")})
    assert error.place == "log['time [s]']" and "'ms'" in error.found
    missing = [*STAMPS[:10], None, *STAMPS[11:]]
    log = quietly(stiction.read_log, {**GOOD, "time [s]": missing})
    assert log.time[-1] == pytest.approx(T[-1], abs=1e-9)


def test_a_torque_in_nanometres_is_told_that_it_is_one() -> None:
    columns = {"time [s]": T, "q [rad]": GOOD["position [mm]"], "tau [nm]": GOOD["force [N]"]}
    with pytest.warns(stiction.StictionWarning, match=r'\[no-force\].*"tau \[nm\]".*nanometres.*newton metres are Nm'):
        stiction.read_log(columns)
    columns["tau [Nm]"] = columns.pop("tau [nm]")
    assert quietly(stiction.read_log, columns).force_unit == "N*m"


@pytest.mark.parametrize("name", [None, 3, "", "a\nb"])
def test_a_name_that_is_none_is_refused(name: Any) -> None:
    assert refused(GOOD, name=name).place == "name"


def test_a_law_is_given_numbers(fit: stiction.Fit) -> None:
    law = fit.law
    calls: list[tuple[Any, str]] = [
        (lambda: law("a", 1e-3), "velocity"),  # type: ignore[arg-type]
        (lambda: law(T, 1e-3), "velocity"),  # type: ignore[arg-type]
        (lambda: law(0.1, None), "dt"),  # type: ignore[arg-type]
        (lambda: law.steps(T, "fast"), "dt"),  # type: ignore[arg-type]
        *((lambda dt=dt: law(0.1, dt), "dt") for dt in (-1.0, 0.0, float("nan"), float("inf"))),
        *((lambda dt=dt: law.steps(T, dt), "dt") for dt in (-1.0, 0.0, float("nan"), float("inf"))),
        (lambda: law.steps(0.1, 1e-3), "velocity"),
    ]
    for call, place in calls:
        with pytest.raises(StictionError) as caught:
            call()
        assert caught.value.place == place


def test_a_log_that_cannot_be_predicted_is_told_why(fit: stiction.Fit) -> None:
    slow = quietly(stiction.read_log, {name: values[::10] for name, values in GOOD.items()})
    still = quietly(stiction.read_log, {name: values for name, values in GOOD.items() if "force" not in name})
    for log, found in [(slow, "100 samples a second"), (still, "without a force")]:
        with pytest.raises(StictionError, match=found):
            fit.predict(log)


@pytest.mark.parametrize("most", [float("nan"), float("inf"), 0, -1, "many"])
def test_a_number_of_samples_that_is_none_is_named(fit: stiction.Fit, most: Any) -> None:
    with pytest.raises(StictionError) as caught:
        fit.simulate(max_samples=most)
    assert caught.value.place == "max_samples"


@pytest.mark.parametrize(("samples", "found"), [(0, "no sample"), (1, "1 sample")])
def test_records_without_a_length_are_refused(samples: int, found: str) -> None:
    error = refused({name: values[:samples] for name, values in GOOD.items()})
    assert (error.place, error.found) == ("log", found)


def test_few_samples_are_read_and_not_identified() -> None:
    short = quietly(stiction.read_log, {name: values[:40] for name, values in GOOD.items()})
    assert any(finding.code == "few-samples" for finding in short.findings)
    with pytest.raises(StictionError) as caught:
        quietly(stiction.identify, short)
    assert caught.value.code in {"too-few-samples", "no-motion"}


@pytest.mark.parametrize("key", GOOD)
def test_a_missing_key_is_named(key: str) -> None:
    rest = {name: values for name, values in GOOD.items() if name != key}
    with pytest.raises(StictionError) as caught:
        quietly(stiction.identify, rest, law="coulomb-viscous", run=stiction.Run(compare_laws=False))
    error = caught.value
    assert error.place.startswith("logs")
    assert key.split(" ")[0] in f"{error.found} {error.allowed}"


def test_units_that_are_missing_are_assumed_as_of_a_file_and_named() -> None:
    plain = {name.split(" ")[0]: values for name, values in GOOD.items()}
    with pytest.warns(stiction.StictionWarning, match=r"\[unit-assumed\].*position m") as caught:
        assumed = stiction.read_log(plain)
    assert caught[0].filename == __file__
    assert assumed.position is not None
    assert numpy.array_equal(assumed.position, plain["position"])
    # In the axis, or with the array, they are as good as in the name.
    given = {"time": (plain["time"], "s"), "position": (plain["position"], "mm"), "force": (plain["force"], "N")}
    axis = {
        "kind": "linear",
        "columns": {
            "time": {"column": "time", "unit": "s"},
            "position": {"column": "position", "unit": "mm"},
            "force": {"column": "force", "unit": "N"},
        },
    }
    same = quietly(stiction.read_log, GOOD)
    for log in (quietly(stiction.read_log, given), quietly(stiction.read_log, plain, axis)):
        assert numpy.array_equal(log.position, same.position)
        assert numpy.array_equal(log.force, same.force)


@pytest.mark.parametrize("unit", ["parsec", "N", ""])
def test_a_unit_that_does_not_fit_is_refused(unit: str) -> None:
    error = refused(other((GOOD["position [mm]"], unit)))
    assert error.place.startswith("log")


@pytest.mark.parametrize(
    "values",
    [
        numpy.asfortranarray(numpy.stack([GOOD["position [mm]"]] * 2, axis=1))[:, 0],
        numpy.stack([GOOD["position [mm]"]] * 2, axis=1)[:, 0],
        numpy.repeat(GOOD["position [mm]"], 2)[::2],
        GOOD["position [mm]"][::-1].copy()[::-1],
        GOOD["position [mm]"].astype(">f8"),
        GOOD["position [mm]"].astype(numpy.longdouble),
        list(GOOD["position [mm]"]),
        numpy.ma.masked_array(GOOD["position [mm]"]),
    ],
    ids=["fortran", "column", "strided", "reversed", "big-endian", "long-double", "list", "masked-nothing"],
)
def test_any_layout_gives_the_same_log(values: Any) -> None:
    same = quietly(stiction.read_log, GOOD)
    log = quietly(stiction.read_log, other(values))
    assert log.sha256 == same.sha256
    assert numpy.array_equal(log.position, same.position)


@pytest.mark.parametrize("kind", ["f4", "f2", "i4", "u2", "i8"])
def test_other_numbers_are_taken_for_what_they_are(kind: str) -> None:
    values = numpy.round(20 + 10 * numpy.sin(6 * T)).astype(kind)
    log = quietly(stiction.read_log, other(values))
    assert numpy.allclose(log.position, values.astype(float) * 1e-3, rtol=1e-15)


def test_missing_samples_are_as_empty_cells() -> None:
    gaps = GOOD["position [mm]"].copy()
    gaps[1000:1003] = numpy.nan
    log = quietly(stiction.read_log, other(gaps))
    assert any(finding.code == "missing-cells" for finding in log.findings)
    mask = numpy.isnan(gaps)
    masked = numpy.ma.masked_array(GOOD["position [mm]"], mask)
    assert quietly(stiction.read_log, other(masked)).sha256 == log.sha256


@pytest.mark.parametrize("column", GOOD)
@pytest.mark.parametrize("value", [numpy.nan, numpy.inf])
def test_a_column_without_a_number_is_refused_or_found(column: str, value: float) -> None:
    with pytest.raises(StictionError) as caught:
        quietly(stiction.identify, other(numpy.full(4000, value), column), law="coulomb-viscous", run=stiction.Run(compare_laws=False))
    assert column.split(" ")[0] in str(caught.value)


@pytest.mark.parametrize(
    ("axis", "code"),
    [
        ({"kind": "round"}, "bad-config"),
        ({"kidn": "linear"}, "bad-config"),
        ({"mass": object()}, "usage"),
        ({"mass": float("nan")}, "usage"),
        ({"columns": {"time": None}}, "usage"),
        ({"name": b"X"}, "usage"),
        ([1], "usage"),
        ({"mass": None}, "usage"),
        ("no/such/axis.toml", "bad-config"),
        (3, "usage"),
    ],
)
def test_an_axis_that_is_none_is_refused(axis: Any, code: str) -> None:
    error = refused(GOOD, axis=axis)
    assert error.code == code
    assert "axis" in error.place


@pytest.mark.parametrize(
    ("options", "place"),
    [
        ({"law": "lugree"}, "law"),
        ({"method": "magic"}, "method"),
        ({"method": "ga", "search": Search(cost="cheap")}, "search.cost"),
        ({"method": "static", "search": Search("x")}, "search.name"),
        ({"split": 0.5, "validate": GOOD}, "split"),
        ({"split": 2.0}, "split"),
        ({"run": Run(compare_laws=False)}, "one law"),
        ({"law": "auto", "asymmetric": True}, "asymmetric"),
        ({"axis": "axis.toml"}, "axis"),
        ({"procedures": Procedures(model=3)}, "procedures.model"),
        ({"procedures": Procedures(statics=3)}, "procedures.statics"),
        ({"procedures": Procedures(break_away=None)}, "procedures.break_away"),
        ({"procedures": Procedures(statics="levels.csv")}, "static-then-dynamic"),
    ],
)
def test_an_option_that_is_none_is_named(options: dict[str, Any], place: str) -> None:
    log = quietly(stiction.read_log, GOOD)
    with pytest.raises(StictionError) as caught:
        quietly(stiction.identify, log, **options)
    assert place in str(caught.value)


@pytest.mark.parametrize(
    ("options", "place"),
    [
        ({"run": Run(seed=-1)}, "run.seed"),
        ({"run": Run(seed=1.5)}, "run.seed"),
        ({"run": Run(seed=2**70)}, "run.seed"),
        ({"run": Run(seed=True)}, "run.seed"),
        ({"run": 3}, "run"),
        ({"search": "ga"}, "search"),
        ({"procedures": {}}, "procedures"),
        ({"split": "half"}, "split"),
        ({"run": Run(threads=-1)}, "run.threads"),
        ({"run": Run(threads=0)}, "run.threads"),
        ({"run": Run(threads=10**6)}, "run.threads"),
        ({"asymmetric": 3}, "asymmetric"),
        ({"search": Search(evaluations=1.5)}, "search.evaluations"),
        ({"law": None}, "law"),
        ({"method": 3}, "method"),
        ({"search": Search(target=[1])}, "search.target"),
        ({"run": Run(progress=3)}, "run.progress"),
    ],
)
def test_an_option_of_another_type_is_named(options: dict[str, Any], place: str) -> None:
    with pytest.raises(StictionError) as caught:
        quietly(stiction.identify, GOOD, **options)
    assert caught.value.place == place


@pytest.mark.parametrize(
    ("options", "place"),
    [
        ({"target": "cobol"}, "target"),
        ({"target": "c", "compensator": Compensator(gain="x")}, "gain"),
        ({"target": "c", "feedforward": ["x"]}, "feedforward"),
        ({"target": "c", "feedforward": [3]}, "feedforward"),
        ({"target": "c", "cycle_time": None}, "cycle_time"),
        ({"target": "c", "compensator": Compensator(gain=7.0)}, "gain"),
        ({"target": "domain-json", "draws": Draws(0)}, "draws.number"),
        ({"target": "domain-json", "draws": Draws(3, width="wide")}, "draws.width"),
        ({"target": "c", "draws": 3}, "draws"),
    ],
)
def test_an_option_of_an_export_is_named(fit: stiction.Fit, tmp_path: Path, options: dict[str, Any], place: str) -> None:
    with pytest.raises(StictionError) as caught:
        quietly(fit.export, out=tmp_path / "out", **options)
    assert place in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_files_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    for path, content in [("empty.csv", b""), ("noise.csv", bytes(range(256)) * 40)]:
        file = tmp_path / path
        file.write_bytes(content)
        assert path in refused(file).place
    assert refused(tmp_path / "none.csv").code == "log-io"


def test_a_folder_that_is_no_fit_is_refused(tmp_path: Path, fit: stiction.Fit) -> None:
    with pytest.raises(StictionError) as caught:
        stiction.load(tmp_path)
    assert "result.json" in caught.value.place
    fit.save(tmp_path / "fit")
    for file in ("model.toml", "result.json"):
        with pytest.raises(StictionError) as caught:
            stiction.load(tmp_path / "fit" / file)
        assert caught.value.place == "folder" and repr(str(tmp_path / "fit")) in caught.value.allowed
    for damaged in (b"", b"{}", b"[1", b'{"schema": "stiction.result/9"}'):
        (tmp_path / "fit" / "result.json").write_bytes(damaged)
        with pytest.raises(StictionError) as caught:
            stiction.load(tmp_path / "fit")
        assert "result.json" in caught.value.place


@pytest.mark.parametrize(("key", "value"), [("seed", "0"), ("seed", -1), ("law", "glue"), ("asymmetric", 3)])
def test_a_result_that_was_changed_is_refused(fit: stiction.Fit, tmp_path: Path, key: str, value: Any) -> None:
    import json

    fit.save(tmp_path / "fit")
    assert key in fit.result
    (tmp_path / "fit" / "result.json").write_text(json.dumps({**fit.result, key: value}))
    with pytest.raises(StictionError) as caught:
        stiction.load(tmp_path / "fit")
    assert "result.json: " in caught.value.place


@pytest.mark.parametrize("split", [0.0, 2.0, float("nan")])
def test_the_option_that_is_wrong_is_the_place(split: float) -> None:
    with pytest.raises(StictionError) as caught:
        quietly(stiction.identify, GOOD, split=split)
    assert caught.value.place == "split"


@pytest.mark.parametrize("time", [0.0, -1.0, float("nan")])
def test_a_time_to_record_is_above_nothing(tmp_path: Path, time: float) -> None:
    with pytest.raises(StictionError, match="above 0"):
        stiction.record("rtde://127.0.0.1:1", tmp_path / "log.csv", time=time)
    assert not (tmp_path / "log.csv").exists()


def test_a_folder_that_holds_something_is_left_alone(tmp_path: Path, fit: stiction.Fit) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(StictionError) as caught:
        fit.save(tmp_path)
    assert caught.value.code == "output"
    assert "force" in caught.value.allowed
    fit.save(tmp_path, force=True)
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_errors_pickle_and_have_their_parts() -> None:
    import pickle

    error = refused({})
    again = pickle.loads(pickle.dumps(error))
    assert (again.code, again.place, again.found, again.allowed, str(again)) == (
        error.code,
        error.place,
        error.found,
        error.allowed,
        str(error),
    )
    warning = stiction.StictionWarning("gap", "two samples")
    assert str(pickle.loads(pickle.dumps(warning))) == "[gap] two samples"
