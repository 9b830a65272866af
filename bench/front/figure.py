"""The picture: friction of a ball screw over velocity, residuals of a robot's joints, friction of repeated runs."""

import matplotlib.pyplot as plt
import numpy as np
import peers

OURS, THEIRS, POINTS = "#0072B2", "#D55E00", "#909090"
BINS = 120


def draw(axis, joints, runs, to):
    """Writes an SVG that is the same for the same numbers."""
    plt.rcParams.update({"svg.hashsalt": "front", "svg.fonttype": "none", "font.size": 9, "axes.spines.top": False})
    plt.rcParams.update({"axes.spines.right": False, "legend.frameon": False, "legend.fontsize": 8})
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(10.0, 3.1), layout="constrained")
    ball_screw(left, *axis)
    bars(middle, *joints)
    repeats(right, *runs)
    figure.savefig(to, metadata={"Date": None})


def ball_screw(axes, log, models):
    """Force less inertia by velocity, medians of bins; the published law; the curve of stiction with its band."""
    published, _, ours = models
    velocity, acceleration = peers.derivatives(log)
    value = ours.values
    inner = slice(peers.EDGE, -peers.EDGE)
    velocity, force = velocity[inner], (log.force - value["mass"] * acceleration)[inner]
    # The recording itself is not the project's to hand on.
    edges = np.quantile(velocity, np.linspace(0.0, 1.0, BINS + 1))
    inside = [(velocity >= low) & (velocity <= high) for low, high in zip(edges, edges[1:])]
    middles = np.array([[np.median(x[k]) for x in (velocity, force)] for k in inside])
    axes.plot(1e3 * middles[:, 0], middles[:, 1], ".", color=POINTS, markersize=4, label="measured, medians")
    curve = ours.fit.result["friction_curve"]
    speed = np.array(curve["speed"])
    for side, name in ((1.0, "forward"), (-1.0, "back")):
        own = curve[name]
        f, band = side * np.abs(np.array(own["force"])), np.array(own["repeat"])
        v = side * 1e3 * speed
        axes.fill_between(v, f - band, f + band, color=OURS, alpha=0.3, linewidth=0)
        axes.plot(v, f, color=OURS, linewidth=1.5, label="stiction, 95 %" if side > 0 else None)
        line = published.friction(side * speed) + published.beside[1]
        axes.plot(v, line, "--", color=THEIRS, linewidth=1.2, label="published law" if side > 0 else None)
    axes.set(xlabel="velocity, mm/s", ylabel="friction, N", title="EMPS ball screw")
    axes.legend(loc="upper left")


def bars(axes, theirs, ours):
    """Residual of each joint on the half that was not fitted."""
    at = np.arange(len(ours))
    axes.bar(at - 0.2, theirs, 0.38, color=THEIRS, label="least squares with Pinocchio")
    axes.bar(at + 0.2, ours, 0.38, color=OURS, label="stiction")
    axes.set(xlabel="joint", ylabel="residual, N m rms", title="UR10, half that was not fitted")
    axes.set_xticks(at, [str(k + 1) for k in at])
    axes.legend(loc="upper right")


def repeats(axes, speeds, theirs, ours):
    """Friction at half of the top speed in each run, with intervals."""
    k = len(speeds) // 2
    run = 1 + np.arange(len(ours))
    for values, shift, color, name in ((theirs, -0.12, THEIRS, "scipy"), (ours, 0.12, OURS, "stiction")):
        axes.errorbar(
            run + shift, 1e3 * values[:, k, 0], 1e3 * values[:, k, 1], fmt="o", color=color, markersize=3, capsize=2, label=name
        )
    axes.set(xlabel="run of the same test", ylabel="friction, mN m", title=f"servo at {speeds[k]:.0f} rad/s, 95 % intervals")
    axes.margins(y=0.35)
    axes.legend(loc="upper right", ncols=2)
