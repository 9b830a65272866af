"""Reference of the 1995 positioning experiment with the friction observer, by scipy's Radau.

    python crates/servo/tests/radau/hunting.py

Canudas de Wit, Olsson, Astrom, Lischinsky 1995, doi 10.1109/9.376053: a mass of 1 kg with friction under a PID (Kv 6, Kp 3,
Ki 4) told to go to 1 m, with the estimated friction added. The values printed are those in c95.rs: overshoot, and the error
at 10, 20 and 30 s, for the observer gains 0 and 10.
"""

import numpy as np
from scipy.integrate import solve_ivp

S0, S1, S2, FC, FS, VS = 1e5, 1e5**0.5, 0.4, 1.0, 1.5, 1e-3


def run(gain):
    def rate(t, y):
        x, v, z, integral, guess = y
        error = x - 1
        a = S0 * abs(v) / (FC + (FS - FC) * np.exp(-((v / VS) ** 2)))
        dz, dguess = v - a * z, v - a * guess - gain * error
        friction = S0 * z + S1 * dz + S2 * v
        estimate = S0 * guess + S1 * dguess + S2 * v
        return [v, -6 * v - 3 * error - 4 * integral + estimate - friction, dz, error, dguess]

    times = np.linspace(0, 31, 3101)
    tolerances = {"rtol": 1e-9, "atol": [1e-13, 1e-13, 1e-17, 1e-13, 1e-17]}
    x = solve_ivp(rate, (0, 31), np.zeros(5), method="Radau", t_eval=times, **tolerances).y[0]
    return x.max(), [x[100 * s] - 1 for s in (10, 20, 30)]


for gain in (0, 10):
    overshoot, errors = run(gain)
    print(gain, "overshoot %.6f" % overshoot, "errors", " ".join("%.6g" % e for e in errors))
