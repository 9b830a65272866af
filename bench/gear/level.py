"""Which parts of the level of friction of a gear gain on a recording that was not fitted: the published M2 to M6 (Duclusaud,
Passault and Ly 2025, arXiv 2410.08650) with the torque that the load asks for, on the two recordings of an XL330.

    python3 bench/gear/level.py ../shared/data/xl330

Force = inertia + viscous + offset + weight + sign(v) level, the weight as it is stated; all but the Stribeck velocity and the delay
of the force is linear, and those are searched on a grid. The richer recording is fitted and held against the other, whose slow
motion does not determine the inertia; then halves of the richer one against each other. Prints the rms of what is left, in mN m.
"""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import interp1d
from scipy.signal import butter, sosfiltfilt

CURRENT, RESISTANCE, FULL_DUTY, GRAVITY = 0.3867, 4.017, 885.0, 9.81
RATE, CUTOFF, SLOWEST = 200.0, 20.0, 0.15


def recording(path, delay):
    """Velocity, acceleration, torque of the motor and of the weight at a uniform rate, filtered alike."""
    data = json.loads(Path(path).read_text())
    of = lambda key: np.array([entry[key] for entry in data["entries"]], float)
    time, position = of("timestamp"), of("position")
    duty = np.where(of("load") < 32768, of("load"), of("load") - 65536)
    volts = duty / FULL_DUTY * of("input_volts")
    torque = CURRENT * (volts - CURRENT * of("speed")) / RESISTANCE
    keep = np.concatenate([[True], np.diff(time) > 0])
    even = np.arange(time[0], time[-1], 1 / RATE)
    at = lambda x: interp1d(time[keep], x[keep])(even)
    filtered = lambda x: sosfiltfilt(butter(4, CUTOFF, fs=RATE, output="sos"), x)
    later = interp1d(time[keep] - delay, torque[keep], fill_value="extrapolate")(even)
    x, u = filtered(at(position)), filtered(later)
    v = np.gradient(x, 1 / RATE)
    weight = data["mass"] * GRAVITY * data["length"] * np.sin(x)
    inside = slice(30, -30)
    x, v, a, u, weight = (y[inside] for y in (x, v, np.gradient(v, 1 / RATE), u, weight))
    moves = np.abs(v) > SLOWEST
    return v[moves], a[moves], u[moves], weight[moves]


def columns(recorded, speed, parts):
    v, a, _, weight = recorded
    sign, size = np.sign(v), np.abs(weight)
    driven = (weight * v < 0).astype(float)
    stribeck = np.exp(-((v / speed) ** 2))
    level = {
        "Fc": np.ones_like(v),
        "Fcs": stribeck,
        "Kt": size,
        "Kd": size * driven,
        "Kts": stribeck * size,
        "Kds": stribeck * size * driven,
        "Kq": stribeck * size**2 * driven,
    }
    return np.column_stack([a, v, np.ones_like(v)] + [sign * level[part] for part in parts])


def rms(recorded, speed, parts, solution):
    return np.sqrt(np.mean((recorded[2] - recorded[3] - columns(recorded, speed, parts) @ solution) ** 2))


def left(pairs, parts):
    """rms of what is left of a pair of a fitted and an unseen recording, of pairs at several delays, at the delay and the Stribeck
    velocity that leave the least of the fitted one."""
    best = (np.inf,)
    for delay, (fitted, unseen) in pairs.items():
        for speed in np.geomspace(0.1, 5.0, 40):
            solution = np.linalg.lstsq(columns(fitted, speed, parts), fitted[2] - fitted[3], rcond=None)[0]
            seen = rms(fitted, speed, parts, solution)
            if seen < best[0]:
                best = (seen, rms(unseen, speed, parts, solution), speed, delay)
    return best


MODELS = {
    "M2": ["Fc", "Fcs"],
    "with Kt": ["Fc", "Fcs", "Kt"],
    "with Kt and Kd": ["Fc", "Fcs", "Kt", "Kd"],
    "M4: with Kt and a Stribeck part of it": ["Fc", "Fcs", "Kt", "Kts"],
    "M5: with Kt, Kd, a Stribeck part of each": ["Fc", "Fcs", "Kt", "Kd", "Kts", "Kds"],
    "M6: and squares where the load drives": ["Fc", "Fcs", "Kt", "Kd", "Kts", "Kds", "Kq"],
}

folder = Path(sys.argv[1])
delays = [1e-3 * k for k in range(-10, 21)]
both = {d: [recording(folder / name, d) for name in ("sin_sin.json", "up_and_down.json")] for d in delays}
halves = {}
for d, (rich, _) in both.items():
    middle = len(rich[0]) // 2
    halves[d] = [tuple(y[:middle] for y in rich), tuple(y[middle:] for y in rich)]
turned = {d: pair[::-1] for d, pair in halves.items()}
for what, pairs in (("sin_sin, then up_and_down", both), ("first half of sin_sin", halves), ("second half of sin_sin", turned)):
    print(what)
    for name, parts in MODELS.items():
        seen, unseen, speed, delay = left(pairs, parts)
        print(f"  {name:41s} fitted {1e3 * seen:6.2f}  unseen {1e3 * unseen:6.2f}  Stribeck velocity {speed:.2f} rad/s, delay {1e3 * delay:.0f} ms")
