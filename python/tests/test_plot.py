"""Pictures of a fit: what they show, and that their axes say what it is and in which unit."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy
import pytest
import stiction
from conftest import quietly

matplotlib = pytest.importorskip("matplotlib")


def labels(figure: Any) -> list[tuple[str, str]]:
    return [(axes.get_xlabel(), axes.get_ylabel()) for axes in figure.axes]


def lines(figure: Any, place: int) -> list[Any]:
    return list(figure.axes[place].get_lines())


def test_force_over_time_is_that_of_the_fit(fit: stiction.Fit) -> None:
    figure = fit.plot.force()
    assert labels(figure) == [("", "force, N"), ("time, s", "residual, N")]
    measured, model = lines(figure, 0)
    assert numpy.array_equal(measured.get_ydata(), fit.series["measured"])
    assert numpy.array_equal(model.get_ydata(), fit.series["model"])
    assert numpy.array_equal(lines(figure, 1)[0].get_ydata(), fit.residual)


def test_every_parameter_has_its_interval(fit: stiction.Fit) -> None:
    figure = fit.plot.intervals()
    assert labels(figure) == [("95 % interval, % of the value", "")]
    named = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    wanted = [row for row in fit.parameters.rows if row.flag != "given"]
    assert [name.split(" = ")[0] for name in named] == [row.symbol for row in wanted]
    assert any(name.endswith(" N/m") for name in named)


def test_friction_over_velocity_and_loops(fit: stiction.Fit, run_csv: Path, tmp_path: Path) -> None:
    log = quietly(stiction.read_log, run_csv)
    figure = fit.plot.map(log)
    assert labels(figure) == [("", "friction, N"), ("velocity, m/s", "residual, N")]
    measured, model = lines(figure, 0)
    predicted = fit.predict(log)
    assert numpy.array_equal(measured.get_xdata(), predicted.velocity)
    assert numpy.allclose(measured.get_ydata() - model.get_ydata(), predicted.residual, atol=1e-12)
    assert numpy.array_equal(lines(quietly(fit.plot.map, run_csv), 0)[0].get_ydata(), measured.get_ydata())
    assert quietly(fit.plot.presliding, run_csv).axes
    loops = fit.plot.presliding(log)
    assert labels(loops) == [("way since the reversal, µm", "friction, N")]
    assert all(line.get_xdata()[0] == 0.0 for line in lines(loops, 0) if len(line.get_xdata()))
    loops.savefig(tmp_path / "loops.png")
    assert "matplotlib.pyplot" not in sys.modules


def test_a_figure_of_ones_own_is_drawn_into(fit: stiction.Fit) -> None:
    from matplotlib.figure import Figure

    own = Figure()
    assert fit.plot.force(own) is own
    with pytest.raises(stiction.StictionError) as caught:
        fit.plot.force("figure")
    assert caught.value.place == "figure"
