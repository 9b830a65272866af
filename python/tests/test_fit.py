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
        found = stiction.identify(short, law="lugre", run=stiction.Run(compare_laws=False))
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
    found = quietly(stiction.identify, run_csv, law=kind, run=stiction.Run(compare_laws=False))
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
    friction = fit.friction_curve
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


def test_friction_at_a_velocity_is_that_of_its_direction(fit: stiction.Fit) -> None:
    entry = fit.result["friction_curve"]
    speed = numpy.array(entry["speed"])
    for sign, side in ((1.0, entry["forward"]), (-1.0, entry["back"])):
        found = fit.friction(sign * speed)
        assert numpy.array_equal(found.force, sign * numpy.array(side["force"]))
        for name in ("at_once", "repeat", "transfer"):
            assert numpy.array_equal(getattr(found, name), side[name])
        between = fit.friction(sign * (speed[:-1] + speed[1:]) / 2.0)
        force = numpy.array(side["force"])
        assert numpy.allclose(between.force, sign * (force[:-1] + force[1:]) / 2.0)
    outside = fit.friction([0.0, 0.99 * speed[0], 1.01 * speed[-1], -1.01 * speed[-1], numpy.nan])
    assert all(numpy.isnan(column).all() for column in outside[1:])
    one = fit.friction(float(speed[2]))
    assert isinstance(one.force, float) and one.force == entry["forward"]["force"][2]
    assert fit.friction(numpy.full((2, 3), speed[1])).repeat.shape == (2, 3)
    with pytest.raises(stiction.StictionError) as caught:
        fit.friction("fast")
    assert caught.value.place == "velocity"


def test_friction_of_one_direction_is_its_own(fit: stiction.Fit) -> None:
    other = pickle.loads(pickle.dumps(fit))
    curve = {name: value for name, value in fit.result["friction_curve"].items() if name not in ("forward", "both")}
    other.result["friction_curve"] = curve
    speed = curve["speed"][1]
    assert other.friction(-speed).force == -curve["back"]["force"][1]
    assert all(numpy.isnan(column) for column in other.friction(speed)[1:])
    del other.result["friction_curve"]
    assert other.friction_curve is None
    with pytest.raises(stiction.StictionError, match="does not slide"):
        other.friction(speed)


def test_what_to_do_next_is_a_line_of_python(fit: stiction.Fit, run_csv: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from stiction._next import call_of

    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"fit": fit, "stiction": stiction}
    assert fit.next == 'fit.export("c", "c", cycle_time=0.00025)'
    assert pickle.loads(pickle.dumps(fit)).next == fit.next
    quietly(exec, fit.next, names)
    assert (tmp_path / "c").is_dir()

    def call(action: dict[str, Any], axis: Any = None, listed: bool = False) -> str:
        return call_of(action, {**fit.result, "axis": {"file": None, "listed": listed}}, axis)

    log = repr(fit.result["inputs"][0]["path"])
    gravity = {"action": "line", "table": "terms", "line": "gravity = true", "key": "gravity", "value": True}
    assert call(gravity) == f"stiction.identify({log}, {{'terms': {{'gravity': True}}}}, law='lugre')"
    own = {"kind": "rotary", "terms": {"cogging": ["1 mm"]}}
    line = call(gravity, own)
    with_gravity = eval(line.split(", ", 1)[1].removesuffix(", law='lugre')"), {"axis": own})
    assert with_gravity == {"kind": "rotary", "terms": {"cogging": ["1 mm"], "gravity": True}}
    assert "gravity = true under [terms] of 'axis.toml'" in call(gravity, "axis.toml")
    assert call({"action": "law", "law": "gms", "asymmetric": True}) == f"stiction.identify({log}, law='gms', asymmetric=True)"
    assert call({"action": "simulate"}) == f'stiction.identify({log}, method="output-error")'
    assert call({"action": "check", "logs": []}, "axis.toml") == f"print(stiction.check({log}, 'axis.toml'))"
    assert call({"action": "listed"}, "a.toml", listed=True) == "stiction.identify(axis='a.toml', law='lugre')"
    assert call({"action": "record"}) == "stiction.identify('another.csv', law='lugre')"
    for action in ("let-the-data-choose", "first-log", "again", "finish", "axis-file"):
        compile(call({"action": action}), action, "eval")


def test_a_warning_of_an_export_names_arguments(fit: stiction.Fit, tmp_path: Path) -> None:
    with pytest.warns(stiction.StictionWarning, match=r"export with cycle_time=0\.00025$"):
        fit.export("c", tmp_path / "c", cycle_time=1e-3)


def test_an_error_names_arguments_as_they_are_written(run_csv: Path) -> None:
    refused: list[tuple[dict[str, Any], str]] = [
        ({"method": "static", "search": stiction.Search("lm", evaluations=0)}, "search=Search(evaluations=0)"),
        ({"law": "auto", "asymmetric": True}, 'law="auto" with asymmetric=True'),
        ({"procedures": stiction.Procedures(statics="levels.csv")}, 'procedures.statics together with method="separable"'),
        ({"split": 2.0}, "split=2"),
    ]
    for options, words in refused:
        with pytest.raises(stiction.StictionError) as caught:
            quietly(stiction.identify, run_csv, **options)
        assert words in str(caught.value)
        assert "--" not in str(caught.value)
