#!/usr/bin/env python3
"""Draws the pictures of docs/residual.md: closed-form effects, less what friction, mass and offset of a law take of them."""

from math import exp, hypot, pi, sin, tanh
from pathlib import Path

PERIOD, HALF_STROKE, N = 4.0, 0.02, 4000  # s, m, samples of two periods
STEP = 2 * PERIOD / N
COULOMB, MASS = 20.0, 60.0  # N, kg
DARK, LIGHT, RED = "#777", "#999", "#d1601f"  # read on white and on black


def scaled(values, factor, plus=0.0):
    return [factor * value + plus for value in values]


time = [i * STEP for i in range(N)]
velocity = [tanh(3 * sin(2 * pi * s / PERIOD)) for s in time]
position = [0.0]
for v in velocity[1:]:
    position.append(position[-1] + STEP * v)
size = 2 * HALF_STROKE / max(position)
velocity, position = scaled(velocity, size), scaled(position, size, -HALF_STROKE)
acceleration = [(velocity[(i + 1) % N] - velocity[i - 1]) / (2 * STEP) for i in range(N)]
way = [tanh(v / 1e-3) for v in velocity]
force = [COULOMB * s + MASS * a for s, a in zip(way, acceleration)]
LAW = [way, velocity, acceleration, [1.0] * N]
OFFSET = [[1.0] * N]
reversals = [0.0, 2.0, 4.0, 6.0]


def left(effect, columns):
    """Subtracts what least squares takes of an effect with the columns of a law."""
    rows = [[sum(p * q for p, q in zip(a, b)) for b in [*columns, effect]] for a in columns]
    for i, row in enumerate(rows):
        for j, other in enumerate(rows):
            if i != j:
                part = other[i] / row[i]
                rows[j] = [q - part * p for p, q in zip(row, other)]
    factors = [row[-1] / row[i] for i, row in enumerate(rows)]
    return [e - sum(f * c[n] for f, c in zip(factors, columns)) for n, e in enumerate(effect)]


def low_passed(values, constant):
    out = [values[-1]]
    for value in values * 2:
        out.append(out[-1] + (value - out[-1]) * STEP / constant)
    return out[-len(values) :]


def noise(seed=1):
    values = []
    for _ in range(N):
        seed = (1103515245 * seed + 12345) % 2**31
        values.append(seed / 2**31 - 0.5)
    return low_passed(values, 0.01)


def ringing(s):
    starts = [r + d for r in [*reversals, 8.0] for d in (-0.25, 0.25)]
    return sum((3 if r % 4 < 1 else -3) * exp((r - s) / 0.15) * sin(50 * (s - r)) for r in starts if s >= r)


def blow(s):
    """Lost inertia while a gap is crossed after the acceleration changed its sign, then the blow at its end."""
    turn, since = (1 if s % 4 < 2 else -1), s % 2 - 1.45
    return turn * (8 * since if 0 <= since < 0.2 else -12 * exp((0.2 - since) / 0.02) if since >= 0.2 else 0.0)


late = round(0.05 / STEP)
long = [s + 8 * k for k in range(5) for s in time]
ARM = 60.0  # rad/m
COUNT = 2e-3  # m
steps = [sin(2 * pi * x / COUNT) / (1 + (v / 0.008) ** 2) for x, v in zip(position, velocity)]
CAUSES = {
    "good": scaled(noise(), 8),
    "stribeck": left([10 * exp(-((v / 4e-3) ** 2)) * s for v, s in zip(velocity, way)], LAW),
    "gravity": left([5 * sin(ARM * x + 0.5) for x in position], LAW),
    "cogging": left([2 * sin(2 * pi * x / 7e-3) for x in position], LAW),
    "late": left([force[i - late] - f for i, f in enumerate(force)], LAW),
    "low-pass": left([g - f for g, f in zip(low_passed(force, 0.05), force)], LAW),
    "mass": left(scaled(acceleration, 0.4 * MASS), OFFSET),
    "sign": left(scaled(force, -1.0), OFFSET),
    "gap": left([blow(s) for s in time], LAW),
    "spring": left([ringing(s) for s in time], LAW),
    "warmth": left([8 * exp(-s / 10) * w for s, w in zip(long, way * 5)], [c * 5 for c in LAW]),
    "encoder": left(scaled(steps, 14.0), LAW),
}
AXES = {  # factor and unit of time, position, velocity; unit of the force
    "gravity": (1, "s", ARM, "rad", ARM, "rad/s", "N m"),
    "warmth": (0.25, "min", 1e3, "mm", 1e3, "mm/s", "N"),
    "encoder": (1, "s", 1 / COUNT, "steps", 1 / COUNT, "steps/s", "N"),
}


def thinned(points, tolerance):
    """Leaves out points that lie within the tolerance of the line (Douglas and Peucker)."""
    kept, stack = {0, len(points) - 1}, [(0, len(points) - 1)]
    while stack:
        i, j = stack.pop()
        (x, y), (u, w) = points[i], points[j]
        length = hypot(u - x, w - y) or 1.0
        off = [abs((u - x) * (y - q) - (x - p) * (w - y)) / length for p, q in points[i + 1 : j]]
        if u == x and w == y:
            off = [hypot(p - x, q - y) for p, q in points[i + 1 : j]]
        if off and max(off) > tolerance:
            k = i + 1 + off.index(max(off))
            kept.add(k)
            stack += [(i, k), (k, j)]
    return [points[k] for k in sorted(kept)]


def panel(edge, quantity, residual, top, name, side, tolerance):
    low, high = min(quantity), max(quantity)
    points = [(edge + 260 * (q - low) / (high - low), 114 - 90 * r / top) for q, r in zip(quantity, residual)]
    line = " ".join(f"{x:.0f} {y:.0f}" for x, y in thinned(points, tolerance))

    def text(x, y, words, anchor):
        return f'<text x="{x}" y="{y}" text-anchor="{anchor}">{words}</text>'

    words = text(edge, 226, f"{low:.3g}", "start") + text(edge + 260, 226, f"{high:.3g}", "end")
    words += text(edge + 130, 250, name, "middle")
    if side:
        words += text(edge - 8, 38, top, "end") + text(edge - 8, 204, -top, "end")
        words += f'<text transform="translate(24 114) rotate(-90)" text-anchor="middle">{side}</text>'
    return f'<path class="f" d="M{edge} 114h260M{edge} 24h260v180h-260z"/><path class="r" d="M{line}"/>{words}'


def picture(name, residual, tolerance=0.7):
    ft, ut, fx, ux, fv, uv, un = AXES.get(name, (1, "s", 1e3, "mm", 1e3, "mm/s", "N"))
    n = len(residual)
    shown = n if name in ("warmth", "good") else n // 2
    repeats = n // N
    top = next(s for s in (5, 8, 10, 15, 20, 30, 50) if s >= max(map(abs, residual)))
    body = panel(88, scaled((time if n == N else long), ft), residual, top, f"time / {ut}", f"residual / {un}", tolerance)
    for edge, channel, factor, title in ((384, position, fx, f"position / {ux}"), (680, velocity, fv, f"velocity / {uv}")):
        body += panel(edge, scaled(channel * repeats, factor)[:shown], residual[:shown], top, title, "", tolerance)
    style = f"text{{font:18px sans-serif;fill:{DARK}}}path{{fill:none}}.f{{stroke:{LIGHT}}}.r{{stroke:{RED};stroke-width:2}}"
    head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 960 260" width="720" height="195" role="img">'
    return f"{head}<title>Residual: {name}</title><style>{style}</style>{body}</svg>\n"


for name, residual in CAUSES.items():
    tolerances = (0.7 * 1.3**k for k in range(20))
    text = next(t for t in (picture(name, residual, s) for s in tolerances) if len(t) < 5800)
    Path(__file__).with_name(f"{name}.svg").write_text(text)
