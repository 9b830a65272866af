"""Tables of pandas, polars and pyarrow, where they are installed."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import drift_rows
import numpy
import pytest
import stiction
from conftest import quietly
from fleet_logs import good
from stiction import _native
from stiction.fleet import identify_uri
from test_bad_input import GOOD, refused


@pytest.fixture(params=["pandas", "polars", "pyarrow"])
def frame(request: pytest.FixtureRequest) -> Any:
    """What makes a table of a dict of arrays."""
    library = pytest.importorskip(request.param)
    return library.table if request.param == "pyarrow" else library.DataFrame


def test_a_table_is_read_as_its_arrays(frame: Any) -> None:
    same = quietly(stiction.read_log, GOOD)
    log = quietly(stiction.read_log, frame(GOOD))
    assert log.sha256 == same.sha256
    assert numpy.array_equal(log.force, same.force)


def test_units_that_a_table_lacks_are_named(frame: Any) -> None:
    with pytest.warns(stiction.StictionWarning, match=r"\[unit-assumed\].*position m"):
        stiction.read_log(frame({name.split(" ")[0]: values for name, values in GOOD.items()}))


def test_columns_of_text_are_refused_by_name(frame: Any) -> None:
    error = refused(frame({**GOOD, "note": ["a"] * 4000}))
    assert error.place == "log['note']"


def test_an_empty_table_is_refused(frame: Any) -> None:
    assert refused(frame({name: values[:0] for name, values in GOOD.items()})).place == "log"


def test_cells_that_are_missing_are_found(frame: Any) -> None:
    cells = [None if 1000 <= k < 1003 else float(x) for k, x in enumerate(GOOD["position [mm]"])]
    log = quietly(stiction.read_log, frame({**GOOD, "position [mm]": cells}))
    assert any(finding.code == "missing-cells" for finding in log.findings)


def test_pandas_of_its_own_types() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(GOOD)
    same = quietly(stiction.read_log, table)
    for kind in ("Float64", "float64[pyarrow]"):
        if "pyarrow" in kind:
            pytest.importorskip("pyarrow")
        assert quietly(stiction.read_log, table.astype(kind)).sha256 == same.sha256, kind
    # A part of a table has gaps in its index, which is not looked at.
    assert quietly(stiction.read_log, table[table["time [s]"] > 1.0]).samples == 2999


def test_two_columns_of_one_name_are_refused() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(GOOD)
    table.columns = ["time [s]", "force [N]", "force [N]"]
    assert "two columns" in refused(table).found


def others() -> dict[str, Any]:
    """All but the time."""
    return {name: values for name, values in GOOD.items() if name != "time [s]"}


def stamps(zone: str | None = None) -> Any:
    pandas = pytest.importorskip("pandas")
    return pandas.date_range("2026-01-01", periods=4000, freq="ms").tz_localize(zone)


@pytest.mark.parametrize("zone", [None, "Europe/Berlin"])
def test_times_of_tables_are_seconds_from_the_first(zone: str | None) -> None:
    pandas, polars, pyarrow = (pytest.importorskip(name) for name in ("pandas", "polars", "pyarrow"))
    table = pandas.DataFrame({"time": stamps(zone), **others()})
    tables = [table, polars.from_pandas(table), pyarrow.Table.from_pandas(table)]
    tables.append(table.astype({"time": pandas.ArrowDtype(pyarrow.timestamp("ns", zone))}))
    for each in tables:
        log = quietly(stiction.read_log, each)
        assert (log.samples, log.rate_hz) == (4000, 1000.0), type(each)
        assert numpy.allclose(log.time, GOOD["time [s]"], rtol=0.0, atol=1e-9)


def test_an_index_of_pandas_is_the_time_where_no_column_is() -> None:
    pandas = pytest.importorskip("pandas")
    t = GOOD["time [s]"]
    for time in (pandas.Index(t, name="t [s]"), pandas.Index(t, name="time"), stamps(), stamps("UTC"), pandas.to_timedelta(t, unit="s")):
        log = quietly(stiction.read_log, pandas.DataFrame(others(), index=time))
        assert (log.samples, log.rate_hz) == (4000, 1000.0), time
        assert pickle.loads(pickle.dumps(log)).sha256 == log.sha256
    # Where a column is, it is left alone; so is one that is no time.
    same = quietly(stiction.read_log, GOOD).sha256
    assert quietly(stiction.read_log, pandas.DataFrame(GOOD, index=stamps())).sha256 == same
    for no_time in (None, pandas.Index(t[::-1], name="time"), pandas.Index(t), pandas.Index(list(map(str, t)), name="time")):
        assert "no time column" in refused(pandas.DataFrame(others(), index=no_time)).found


def test_arrow_arrays_may_lack_samples() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    cells = pyarrow.array([None if 1000 <= k < 1003 else float(x) for k, x in enumerate(GOOD["position [mm]"])])
    log = quietly(stiction.read_log, {**GOOD, "position [mm]": cells})
    assert any(finding.code == "missing-cells" for finding in log.findings)
    error = refused({**GOOD, "position [mm]": pyarrow.array(["a"] * 4000).dictionary_encode()})
    assert "a str in row 1" in error.found


def test_a_table_that_is_not_computed_yet_is_refused_with_what_computes_it() -> None:
    polars = pytest.importorskip("polars")
    error = refused(polars.DataFrame(GOOD).lazy())
    assert (error.place, error.allowed) == ("log", "a table that is there: .collect()")


def test_any_table_that_passes_on_arrow_is_read() -> None:
    pyarrow = pytest.importorskip("pyarrow")

    class Foreign:
        """As duckdb, nanoarrow and others have it."""

        def __init__(self, table: Any) -> None:
            self._table = table

        def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
            return self._table.__arrow_c_stream__(requested_schema)

    same = quietly(stiction.read_log, GOOD)
    assert quietly(stiction.read_log, Foreign(pyarrow.table(GOOD))).sha256 == same.sha256
    # Two columns of one name, and one column alone, which is no table.
    twice = pyarrow.Table.from_arrays([pyarrow.array([1.0, 2.0])] * 2, names=["force [N]"] * 2)
    assert "two columns" in refused(Foreign(twice)).found
    assert "no table" in refused(Foreign(pyarrow.chunked_array([[1.0, 2.0]]))).found


def test_the_tables_of_a_fleet_are_one_data_set(tmp_path: Path) -> None:
    """As `stiction.fleet` leaves them: pandas and pyarrow read the folder, polars its tables."""
    pandas, dataset, polars = (pytest.importorskip(name) for name in ("pandas", "pyarrow.dataset", "polars"))
    logs = good(tmp_path / "logs", 3)
    found = [json.dumps(identify_uri(path, law="coulomb-viscous", time=86_400.0 * k)) for k, path in enumerate(logs)]
    found.append(json.dumps(identify_uri(tmp_path / "gone.csv", law="coulomb-viscous")))
    out = tmp_path / "out"
    out.mkdir()
    _native.write_rows(str(out / "part-000001.parquet"), found[:2])
    _native.write_rows(str(out / "part-000002.parquet"), found[2:])
    (out / ".stiction-fleet").touch()
    table = pandas.read_parquet(out)
    coulomb = table.query("parameter == 'coulomb' and identifiable == True")
    assert list(coulomb.path) == [str(path) for path in logs] and list(coulomb.time) == [0.0, 86_400.0, 172_800.0]
    assert coulomb.value.between(19.0, 23.0).all()
    assert table[table.error.notna()].path.to_list() == [str(tmp_path / "gone.csv")]
    assert dataset.dataset(out).to_table().num_rows == len(table)
    assert polars.read_parquet(out / "*.parquet").shape == table.shape


def test_drift_of_a_table_is_that_of_its_file(frame: Any, tmp_path: Path) -> None:
    found = stiction.drift(drift_rows.table(tmp_path / "results.parquet"))
    other = stiction.drift(frame(drift_rows.columns()))
    assert found.changed and other.alarms == found.alarms and other.noise == found.noise


def test_drift_of_what_pandas_reads(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    table = drift_rows.table(tmp_path / "results.parquet")
    found = stiction.drift(table)
    stamped = pandas.read_parquet(table)
    stamped["time"] = pandas.to_datetime(stamped["time"], unit="s", utc=True).dt.tz_convert("Europe/Berlin")
    assert stiction.drift(stamped).alarms == found.alarms
    for frame in (pandas.read_parquet(table), pandas.read_parquet(table, dtype_backend="pyarrow")):
        assert stiction.drift(frame).alarms == found.alarms
        untimed = stiction.drift(frame.assign(time=None, temperature=numpy.nan))
        assert not untimed.result["timed"] and untimed.noise[0]["by_temperature"] is None


@pytest.fixture(params=["pandas", "polars"])
def library(request: pytest.FixtureRequest) -> Any:
    """Which DataFrames are asked for."""
    pytest.importorskip(request.param)
    return request.param


def same(frame: Any, columns: dict[str, Any]) -> None:
    assert list(frame.columns) == list(columns)
    for name, values in columns.items():
        given = frame[name].to_list()
        assert len(given) == len(values)
        for got, wanted in zip(given, values):
            lacks = got is None or got != got
            assert lacks == (wanted is None or wanted != wanted), name
            assert lacks or got == wanted, name


def test_results_are_frames(fit: stiction.Fit, library: Any) -> None:
    frame = fit.parameters.to_frame(library)
    assert type(frame).__module__.split(".")[0] == library
    same(frame, fit.parameters.to_dict())
    curve = fit.friction_curve
    assert curve is not None
    same(curve.to_frame(library), curve._asdict())
    same(fit.series.to_frame(library), fit.series)
    names, matrix = fit.covariance
    same(fit.covariance.to_frame(library), {"name": names, **{name: matrix[:, k] for k, name in enumerate(names)}})
    study = quietly(fit.simulate).rows
    frame = study.to_frame(library)
    assert len(frame) == len(study)
    assert frame["controller"].to_list() == [row["controller"] for row in study]
    with pytest.raises(stiction.StictionError) as caught:
        fit.series.to_frame("arrow")  # type: ignore[arg-type]
    assert caught.value.place == "library"


def test_what_drifts_is_a_frame(library: Any) -> None:
    found = stiction.drift(drift_rows.rows(), limit=drift_rows_limits())
    frame = found.alarms.to_frame(library)
    assert frame["machine"].to_list() == [alarm["machine"] for alarm in found.alarms]
    course = found.courses[0].to_frame(library)
    assert course["log"].to_list() == found.courses[0].logs
    assert numpy.array_equal(course["value"].to_list(), found.courses[0].value)


def drift_rows_limits() -> list[str]:
    from test_drift import LIMITS

    return LIMITS


def test_the_library_is_a_frame(library: Any) -> None:
    frame = stiction.library().to_frame(library)
    assert frame["name"].to_list() == list(stiction.library())


def test_nested_rows_have_names_with_dots(library: Any) -> None:
    rows = stiction.Rows([{"a": 1.0, "b": {"c": 2.0}}, {"a": 3.0, "d": 4.0}])
    same(rows.to_frame(library), {"a": [1.0, 3.0], "b.c": [2.0, None], "d": [None, 4.0]})


def test_without_a_library_of_frames_it_says_what_to_install(fit: stiction.Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    for name in ("pandas", "polars"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(stiction.StictionError) as caught:
        fit.parameters.to_frame()
    assert (caught.value.place, caught.value.allowed) == ("library", "pip install pandas")
