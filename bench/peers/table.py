"""From runs to a table.

A run has `success`, `seconds` and `evaluations` until then, or all of them if it failed, and `excess`, its least cost
over the optimum less 1.
"""

from statistics import median

# Ours; the first is what times are set beside.
OURS = ("niched-ga", "lm", "annealing-ga", "separable")


def expected(runs, key):
    """What a success costs: everything spent, on runs that failed too, over the successes."""
    successes = sum(run["success"] for run in runs)
    return sum(run[key] for run in runs) / successes if successes else None


def number(x):
    """Three digits."""
    if x >= 100.0:
        return f"{x:,.0f}".replace(",", " ")
    return f"{x:.1f}" if x >= 10.0 else f"{x:.2f}"


def time_of(seconds):
    return f"{number(seconds)} s" if seconds >= 1.0 else f"{number(1e3 * seconds)} ms"


def ratio(runs, ours):
    """How many times as long a success takes; a bound where there was none."""
    mine = expected(ours, "seconds")
    if mine is None:
        return "–"
    theirs = expected(runs, "seconds")
    if theirs is None:
        return f"> {number(sum(run['seconds'] for run in runs) / mine)}"
    return number(theirs / mine)


def row(name, runs, ours):
    counts, seconds = expected(runs, "evaluations"), expected(runs, "seconds")
    cells = [
        name,
        f"{sum(run['success'] for run in runs)} of {len(runs)}",
        "–" if counts is None else number(counts),
        "–" if seconds is None else time_of(seconds),
        f"{median(max(run['excess'], 0.0) for run in runs):.0e}",
        "" if name == f"**{OURS[0]}**" else ratio(runs, ours[OURS[0]]),
    ]
    return f"| {' | '.join(cells)} |"


def table(ours, peers):
    """Ours first, then the peers, by the time of a success."""
    head = ["", "optimum found", "evaluations", "time", "excess", f"of {OURS[0]}"]
    lines = [f"| {' | '.join(head)} |", "|---|" + "---:|" * (len(head) - 1)]
    lines += [row(f"**{name}**", ours[name], ours) for name in OURS]
    last = float("inf")
    ordered = sorted(peers.items(), key=lambda item: expected(item[1], "seconds") or last)
    lines += [row(name, runs, ours) for name, runs in ordered if runs]
    return "\n".join(lines)
