"""Reference motion of the 1995 stick-slip experiment, by an implicit Runge-Kutta method that is not this crate's.

    python crates/servo/tests/radau/stick_slip.py > crates/servo/tests/radau/stick_slip.txt

Canudas de Wit, Olsson, Astrom, Lischinsky 1995, doi 10.1109/9.376053: a block of 1 kg pulled by a spring of 2 N/m whose
end moves at .1 m/s, for 20 s. scipy's Radau at a relative tolerance of 1e-10, a line for each .1 s: the position in m with
all its digits. The second run at 1e-11 is there to see how far the first can be trusted (printed to stderr).
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp

S0, S1, S2, FC, FS, VS, M = 1e5, 1e5**0.5, 0.4, 1.0, 1.5, 1e-3, 1.0
K, PULL = 2.0, 0.1


def rate(t, y):
    x, v, z = y
    g = FC + (FS - FC) * np.exp(-((v / VS) ** 2))
    dz = v - S0 * abs(v) / g * z
    return [v, (K * (PULL * t - x) - S0 * z - S1 * dz - S2 * v) / M, dz]


def jacobian(t, y):
    x, v, z = y
    w = (FS - FC) * np.exp(-((v / VS) ** 2))
    g, dg = FC + w, -2 * v / VS**2 * w
    a = S0 * abs(v) / g
    da = S0 * np.sign(v) / g - a * dg / g
    zv, zz = 1 - da * z, -a
    return [[0, 1, 0], [-K / M, -(S1 * zv + S2) / M, -(S0 + S1 * zz) / M], [0, zv, zz]]


def run(rtol):
    times = np.linspace(0, 20, 201)
    y = solve_ivp(rate, (0, 20), [0, 0, 0], method="Radau", jac=jacobian, rtol=rtol, atol=[1e-14, 1e-14, 1e-18], t_eval=times)
    assert y.success
    return y.y[0]


positions = run(1e-10)
finer = run(1e-11)
print("1e-10 against 1e-11:", np.max(abs(positions - finer)), "m", file=sys.stderr)
for x in positions:
    print(repr(float(x)))
