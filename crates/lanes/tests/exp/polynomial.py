"""Coefficients of (exp(r) - 1 - r)/r^2 on |r| <= ln2/2, as in src/exp.rs: interpolation at Chebyshev points.

Run with any Python 3; prints the coefficients, lowest power first, and the largest relative error.
"""

import math
from decimal import Decimal, getcontext

getcontext().prec = 70
POINTS = 10
EDGE = Decimal("0.3466")


def exact(r):
    total, term, k = Decimal(0), Decimal(1) / 2, 3
    while abs(term) > Decimal(10) ** -60:
        total += term
        term = term * r / k
        k += 1
    return total


def coefficients():
    x = [EDGE * Decimal(math.cos(math.pi * (2 * i + 1) / (2 * POINTS))) for i in range(POINTS)]
    newton = [exact(v) for v in x]
    for j in range(1, POINTS):
        for i in range(POINTS - 1, j - 1, -1):
            newton[i] = (newton[i] - newton[i - 1]) / (x[i] - x[i - j])
    power = [newton[-1]] + [Decimal(0)] * (POINTS - 1)
    for i in range(POINTS - 2, -1, -1):
        shifted = [Decimal(0)] + power[:-1]
        power = [a - b * x[i] for a, b in zip(shifted, power)]
        power[0] += newton[i]
    return [float(c) for c in power]


if __name__ == "__main__":
    found = coefficients()
    for c in found:
        print(repr(c))
    worst = Decimal(0)
    for i in range(2000):
        r = EDGE * ((i + Decimal("0.5")) / 1000 - 1)
        value = sum(Decimal(c) * r**k for k, c in enumerate(found))
        worst = max(worst, abs(value / exact(r) - 1))
    print(f"largest relative error {worst:.2e}")
