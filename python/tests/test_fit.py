"""What a fit has: a table, a law, files, a report; and what it warns of."""

from __future__ import annotations

import pickle
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction
from conftest import quietly
from stiction import StictionError, StictionWarning


def test_parameters_are_a_table_with_names(fit: stiction.Fit) -> None:
    table = fit.parameters
    coulomb = table["coulomb"]
    assert (coulomb.symbol, coulomb.unit, coulomb.flag) == ("Fc", "N", "")
    assert coulomb.low is not None
    assert coulomb.high is not None
    assert coulomb.value == pytest.approx(20.0, rel=0.01), "the axis of the demo has 20 N"
    assert coulomb.low < coulomb.value < coulomb.high
    assert list(table) == [row.name for row in table.rows]
    assert table["stribeck_exponent"].flag == "given"
    assert "coulomb" in str(table)
    assert "coulomb" in table._repr_html_()
    assert table.to_dict()["name"] == list(table)
    with pytest.raises(KeyError, match="sigma0"):
        table["sigma7"]


def test_covariance_has_the_names_of_its_rows(fit: stiction.Fit) -> None:
    names, matrix = fit.covariance
    assert matrix.shape == (len(names), len(names))
    scale = numpy.sqrt(numpy.outer(numpy.diag(matrix), numpy.diag(matrix)))
    assert numpy.all(numpy.abs(matrix - matrix.T) <= 1e-9 * scale)
    assert set(names) < set(fit.parameters)


def test_a_flag_is_a_row_and_a_warning(arrays: dict[str, Any]) -> None:
    """A slow motion to and fro says nothing of viscous friction."""
    short = {name: values[:3000] for name, values in arrays.items()}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = stiction.identify(short, law="lugre", compare_laws=False)
    told = [w for w in caught if issubclass(w.category, StictionWarning)]
    assert told
    assert all(w.filename == __file__ for w in told), "a warning names the line of the user"
    codes = [w.message.code for w in told if isinstance(w.message, StictionWarning)]
    assert codes == [code for code, _ in found.warnings]
    flagged = [row for row in found.parameters.rows if row.flag == "NOT IDENTIFIABLE"]
    assert flagged
    assert "not-identifiable" in codes
    assert all(row.reason and row.advice for row in flagged)


def test_findings_are_warnings_that_can_be_silenced(arrays: dict[str, Any]) -> None:
    gap = {name: numpy.delete(values, slice(500, 900)) for name, values in arrays.items()}
    with pytest.warns(StictionWarning, match=r"^\[gap\] 1 gap with 400 samples missing"):
        log = stiction.read_log(gap)
    assert [f.severity for f in log.findings if f.code == "gap"] == ["warning"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", r"\[gap\]", StictionWarning)
        stiction.read_log(gap)


def test_a_fit_is_the_same_after_pickling(fit: stiction.Fit, tmp_path: Path) -> None:
    again = pickle.loads(pickle.dumps(fit))
    assert again.result == fit.result
    assert again.verdict == fit.verdict
    assert numpy.array_equal(again.residual, fit.residual)
    again.save(tmp_path / "again")
    fit.save(tmp_path / "fit")
    for name in ("model.toml", "fit.csv", "study.toml"):
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "fit" / name).read_bytes()
    velocity = numpy.linspace(-0.1, 0.1, 50)
    assert numpy.array_equal(again.law.steps(velocity, 1e-3), fit.law.steps(velocity, 1e-3))


def test_a_log_is_the_same_after_pickling(run_csv: Path, arrays: dict[str, Any]) -> None:
    for data in (run_csv, arrays):
        log = quietly(stiction.read_log, data)
        again = pickle.loads(pickle.dumps(log))
        assert again.sha256 == log.sha256
        assert numpy.array_equal(again.force, log.force)


def test_a_file_that_changed_is_not_unpickled(run_csv: Path, tmp_path: Path) -> None:
    copy = tmp_path / "run.csv"
    lines = run_csv.read_text().splitlines(keepends=True)
    copy.write_text("".join(lines))
    pickled = pickle.dumps(quietly(stiction.read_log, copy))
    copy.write_text("".join(lines[:-1]))
    with pytest.raises(StictionError, match="pickled"):
        pickle.loads(pickled)


def test_a_prediction_of_the_fitted_log_is_the_fit(fit: stiction.Fit, run_csv: Path) -> None:
    predicted = fit.predict(quietly(stiction.read_log, run_csv))
    assert numpy.array_equal(predicted.residual, predicted.measured - predicted.model)
    error = predicted.quality["relative_error_percent"]
    assert error == pytest.approx(fit.quality["relative_error_percent"], rel=1e-6)
    assert numpy.array_equal(quietly(fit.predict, run_csv).residual, predicted.residual)
    with pytest.raises(StictionError, match="DataFrame"):
        fit.predict(3)
    with pytest.raises(StictionError, match="again"):
        pickle.loads(pickle.dumps(fit)).predict(quietly(stiction.read_log, run_csv))


def test_what_is_predicted_is_read_with_the_axis_of_the_fit(arrays: dict[str, Any]) -> None:
    """Whose columns have names that nothing but the axis tells."""
    columns = {f"c{k}": values for k, values in enumerate(arrays.values())}
    names = dict(zip(arrays, columns))
    units = {"Time": "s", "Position": "mm", "Force": "N"}
    roles = {role.lower(): {"column": names[f"{role} [{unit}]"], "unit": unit} for role, unit in units.items()}
    axis = {"kind": "linear", "columns": roles}
    log = quietly(stiction.read_log, columns, axis)
    for fit in (quietly(stiction.identify, log, law="stribeck"), quietly(stiction.identify, columns, axis, law="stribeck")):
        assert numpy.array_equal(quietly(fit.predict, columns).residual, quietly(fit.predict, log).residual)


def test_the_law_is_called_sample_by_sample(fit: stiction.Fit) -> None:
    law = fit.law
    assert law.kind == "lugre"
    for _ in range(4000):
        force = law(0.1, 250e-6)  # 1 s at 0.1 m/s
    at = fit.parameters
    steady = at["coulomb"].value + at["sigma2"].value * 0.1 + at["offset"].value
    assert force == pytest.approx(steady, abs=0.05)
    assert law.force == force
    assert len(law.state) == 1
    # An array at once is the same, from where the law is.
    other = fit.law
    velocity = numpy.full(4000, 0.1)
    assert other.steps(velocity, 250e-6)[-1] == force
    law.reset()
    assert law.state == [0.0]
    # What is not finite leaves the law as it is.
    law(0.01, 1e-3)
    assert law(float("nan"), 1e-3) == law.force


def test_the_law_runs_along_a_record(fit: stiction.Fit) -> None:
    law = fit.law
    t = numpy.arange(4000) * 250e-6
    force = law.record(t, numpy.full(4000, 0.1))
    assert force[-1] == pytest.approx(fit.law.steps(numpy.full(4000, 0.1), 250e-6)[-1], abs=0.05)
    assert law.state == [0.0], "a record leaves the state alone"
    for time, velocity in [(t, t[:-1]), (t[::-1], t), (t, numpy.full(4000, numpy.nan))]:
        with pytest.raises(StictionError):
            law.record(time, velocity)


@pytest.mark.parametrize("kind", ["coulomb-viscous", "stribeck", "dahl", "elasto-plastic", "maxwell-slip", "gms"])
def test_every_law_runs(run_csv: Path, kind: str) -> None:
    found = quietly(stiction.identify, run_csv, law=kind, compare_laws=False)
    law = found.law
    law.steps([0.01] * 50, 1e-3)
    again = pickle.loads(pickle.dumps(law))
    assert again.state == law.state
    assert [again(-0.01, 1e-3) for _ in range(9)] == [law(-0.01, 1e-3) for _ in range(9)], "it goes on where it was"
    law.reset()
    velocity = 0.05 * numpy.sin(numpy.arange(2000) * 5e-3)
    along = law.record(numpy.arange(2000) * 1e-3, velocity)
    step = law.steps(velocity, 1e-3)
    assert numpy.all(numpy.isfinite(along))
    # Both are the same law: where it slides they agree but for the sampling.
    assert numpy.sqrt(numpy.mean((along - step) ** 2)) < 0.1 * numpy.sqrt(numpy.mean(along**2))


def test_a_notebook_shows_the_report(fit: stiction.Fit) -> None:
    html = fit._repr_html_()
    assert html.startswith("<iframe srcdoc=")
    assert "&lt;svg" in html
    assert "<svg" not in html
    assert fit.report().startswith("<!DOCTYPE html>") or "<html" in fit.report()


def test_a_saved_fit_is_read_by_another_process(fit: stiction.Fit, tmp_path: Path) -> None:
    fit.save(tmp_path / "fit")
    line = f"import stiction; print(stiction.load({str(tmp_path / 'fit')!r}).parameters['coulomb'].value.hex())"
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == fit.parameters["coulomb"].value.hex()


def test_friction_by_speed_and_half_widths(fit: stiction.Fit) -> None:
    friction = fit.friction
    assert friction is not None
    assert (numpy.diff(friction.speed) > 0.0).all()
    assert (friction.force > 0.0).all()
    assert (friction.at_once <= friction.repeat).all() and (friction.repeat <= friction.transfer).all()
    coulomb = fit.parameters["coulomb"]
    at_once, repeat, transfer = coulomb.at_once, coulomb.repeat, coulomb.transfer
    assert at_once is not None
    assert repeat is not None
    assert transfer is not None
    assert 0.0 < at_once <= repeat <= transfer
