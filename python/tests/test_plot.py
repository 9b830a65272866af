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
    figure, axes = fit.plot.force()
    assert axes == figure.axes
    assert labels(figure) == [("", "force, N"), ("time, s", "residual, N")]
    measured, model = lines(figure, 0)
    assert numpy.array_equal(measured.get_ydata(), fit.series["measured"])
    assert numpy.array_equal(model.get_ydata(), fit.series["model"])
    assert numpy.array_equal(lines(figure, 1)[0].get_ydata(), fit.residual)


def test_every_parameter_has_its_interval(fit: stiction.Fit) -> None:
    figure, _ = fit.plot.intervals()
    assert labels(figure) == [("95 % interval, % of the value", "")]
    named = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    wanted = [row for row in fit.parameters.rows if row.flag != "given"]
    assert [name.split(" = ")[0] for name in named] == [row.symbol for row in wanted]
    assert any(name.endswith(" N/m") for name in named) and any(name.endswith(" N·s/m") for name in named)


def test_friction_over_velocity_and_loops(fit: stiction.Fit, run_csv: Path, tmp_path: Path) -> None:
    log = quietly(stiction.read_log, run_csv)
    figure, _ = fit.plot.map(log)
    assert labels(figure) == [("", "friction, N"), ("velocity, m/s", "residual, N")]
    measured, model = lines(figure, 0)
    predicted = fit.predict(log)
    assert numpy.array_equal(measured.get_xdata(), predicted.velocity)
    assert numpy.allclose(measured.get_ydata() - model.get_ydata(), predicted.residual, atol=1e-12)
    assert numpy.array_equal(lines(quietly(fit.plot.map, run_csv)[0], 0)[0].get_ydata(), measured.get_ydata())
    assert quietly(fit.plot.presliding, run_csv)[0].axes
    loops, _ = fit.plot.presliding(log)
    assert labels(loops) == [("displacement since the reversal, µm", "friction, N")]
    assert all(line.get_xdata()[0] == 0.0 for line in lines(loops, 0) if len(line.get_xdata()))
    loops.savefig(tmp_path / "loops.png")
    assert "matplotlib.pyplot" not in sys.modules


def test_a_figure_of_ones_own_is_drawn_into(fit: stiction.Fit) -> None:
    from matplotlib.figure import Figure

    own = Figure()
    assert fit.plot.force(own)[0] is own
    with pytest.raises(stiction.StictionError) as caught:
        fit.plot.force("figure")
    assert caught.value.place == "figure"


def test_friction_with_its_band(fit: stiction.Fit) -> None:
    figure, (axes,) = fit.plot.friction("repeat")
    assert labels(figure) == [("velocity, m/s", "friction, N")]
    back, forward = axes.get_lines()[:2]
    assert (back.get_xdata() < 0.0).all() and (back.get_ydata() < 0.0).all()
    assert numpy.array_equal(forward.get_ydata(), fit.friction(forward.get_xdata()).force)
    band = axes.collections[1].get_paths()[0].get_extents()
    at = fit.friction(forward.get_xdata())
    assert band.y1 == pytest.approx((at.force + at.repeat).max())
    assert not fit.plot.friction(None)[1][0].collections
    with pytest.raises(stiction.StictionError) as caught:
        fit.plot.friction("wide")  # type: ignore[arg-type]
    assert caught.value.place == "band"


@pytest.mark.parametrize(("width", "inches"), [("single", 3.5), ("double", 7.16)])
def test_a_figure_has_the_width_of_a_column_and_no_title(fit: stiction.Fit, width: Any, inches: float, tmp_path: Path) -> None:
    for figure, each in (fit.plot.force(width=width), fit.plot.intervals(width=width), fit.plot.friction(width=width)):
        assert figure.get_size_inches()[0] == inches
        assert all(axes.get_title() == "" for axes in each)
        assert all(label.get_fontsize() == 8.0 for axes in each for label in [axes.xaxis.label, axes.yaxis.label])
        with stiction.style():
            figure.savefig(tmp_path / "figure.svg")
        assert "<text" in (tmp_path / "figure.svg").read_text()
    with pytest.raises(stiction.StictionError) as caught:
        fit.plot.force(width="wide")  # type: ignore[arg-type]
    assert caught.value.place == "width"


def test_inks_are_told_apart_in_grey(fit: stiction.Fit) -> None:
    from matplotlib.colors import to_rgb

    def grey(color: Any) -> float:
        return float(numpy.dot(to_rgb(color), (0.2126, 0.7152, 0.0722)))

    _, (above, _) = fit.plot.force()
    measured, model = above.get_lines()
    assert grey(measured.get_color()) - grey(model.get_color()) > 0.4


def test_the_style_is_for_figures_of_ones_own() -> None:
    before = matplotlib.rcParams["font.size"]
    with stiction.style():
        assert matplotlib.rcParams["font.size"] == 8.0
    assert matplotlib.rcParams["font.size"] == before
