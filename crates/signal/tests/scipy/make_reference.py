"""What scipy and numpy make of the same signals: input and expected output of the tests.

    python make_reference.py TOPIC > reference.json

Each topic is a list of cases; every array is a list of the 64-bit patterns of its numbers, so that
nothing is lost on the way. The tests run this by themselves.
"""

import json
import sys
from fractions import Fraction
from math import factorial, fsum

import numpy as np
from scipy import signal

RNG = np.random.default_rng(20240611)


def bits(values):
    return np.ascontiguousarray(values, dtype=np.float64).ravel().view(np.uint64).tolist()


def motion(count):
    """A drive's position in shape: a sine with a ramp, encoder noise and a step."""
    k = np.arange(count)
    smooth = 0.3 * np.sin(0.013 * k) + 1e-3 * k
    return smooth + 1e-3 * RNG.standard_normal(count) + 0.05 * (k > 0.6 * count)


def designs():
    for band in ("lowpass", "highpass"):
        for order in range(1, 9):
            for cutoff in (0.01, 0.05, 0.1, 0.37, 0.5, 0.71, 0.95):
                yield band, order, cutoff


def butterworth():
    for band, order, cutoff in designs():
        sos = signal.butter(order, cutoff, band, output="sos")
        frequency, response = signal.freqz_sos(sos, worN=200)
        yield {
            "band": band,
            "order": order,
            "cutoff": cutoff,
            "sos": bits(sos),
            "frequency": bits(frequency / (2 * np.pi)),
            "gain": bits(np.abs(response)),
        }


def low_cutoff():
    for order in range(1, 9):
        for cutoff in (1e-3, 1e-4):
            sos = signal.butter(order, cutoff, output="sos")
            yield {"order": order, "cutoff": cutoff, "sos": bits(sos)}


def filtering():
    for band, order, cutoff in designs():
        sos = signal.butter(order, cutoff, band, output="sos")
        for count in (60, 2000):
            x = motion(count)
            yield {
                "band": band,
                "order": order,
                "cutoff": cutoff,
                "sos": bits(sos),
                "state": bits(signal.sosfilt_zi(sos)),
                "x": bits(x),
                "causal": bits(signal.sosfilt(sos, x)),
                "zero_phase": bits(signal.sosfiltfilt(sos, x)),
            }


def shortest():
    """The shortest signal that sosfiltfilt accepts."""
    for band, order, cutoff in designs():
        sos = signal.butter(order, cutoff, band, output="sos")
        for count in range(1, 100):
            try:
                signal.sosfiltfilt(sos, np.zeros(count))
                break
            except ValueError:
                pass
        yield {"band": band, "order": order, "cutoff": cutoff, "shortest": count}


def savitzky_golay():
    for window in (1, 3, 5, 7, 11, 21):
        for degree in (0, 1, 2, 3, 4, 5):
            for derivative in (0, 1, 2, 3):
                if degree >= window:
                    continue
                x = motion(400)
                y = signal.savgol_filter(x, window, degree, derivative, 2.5e-4, mode="interp")
                weights = signal.savgol_coeffs(window, degree, derivative, 2.5e-4)
                yield {
                    "window": window,
                    "degree": degree,
                    "derivative": derivative,
                    "step": 2.5e-4,
                    "x": bits(x),
                    "y": bits(y),
                    # The largest output that a signal of this size can have.
                    "scale": bits([np.abs(weights).sum() * np.abs(x).max()]),
                }


def polynomial_weights(window, degree, derivative):
    """Weights that give the derivative of the fitted polynomial at each place of the window, from
    the normal equations in rational numbers: exact up to the final rounding."""
    half = window // 2
    places = [Fraction(i) for i in range(-half, half + 1)]
    size = degree + 1
    rows = [[sum(i ** (j + k) for i in places) for k in range(size)] for j in range(size)]
    for j in range(size):
        rows[j] += [Fraction(j == k) for k in range(size)]
    for j in range(size):
        pivot = rows[j][j]
        rows[j] = [value / pivot for value in rows[j]]
        for other in range(size):
            if other != j:
                factor = rows[other][j]
                rows[other] = [a - factor * b for a, b in zip(rows[other], rows[j])]
    inverse = [row[size:] for row in rows]
    powers = [[i**k for i in places] for k in range(size)]
    columns = [
        [sum(inverse[j][k] * powers[k][i] for k in range(size)) for i in range(window)]
        for j in range(size)
    ]
    weights = []
    for place in places:
        falling = [
            Fraction(factorial(j), factorial(j - derivative)) * place ** (j - derivative)
            for j in range(derivative, size)
        ]
        weights.append(
            [
                float(sum(f * columns[j + derivative][i] for j, f in enumerate(falling)))
                for i in range(window)
            ]
        )
    return weights


def savitzky_golay_exact():
    for window, degree in ((5, 4), (11, 7), (13, 12), (21, 3), (21, 12), (41, 5), (101, 2), (101, 7)):
        for derivative in (0, 1, 2, 3):
            x = motion(window + 3)
            half = window // 2
            weights = polynomial_weights(window, degree, derivative)
            y = []
            for n in range(x.size):
                start = min(max(n - half, 0), x.size - window)
                y.append(fsum(w * v for w, v in zip(weights[n - start], x[start:])))
            yield {
                "window": window,
                "degree": degree,
                "derivative": derivative,
                "step": 1.0,
                "x": bits(x),
                "y": bits(y),
                "scipy": bits(signal.savgol_filter(x, window, degree, derivative)),
            }


def gradient():
    for count in (3, 4, 500):
        x = motion(count)
        times = 7.0 + np.cumsum(RNG.uniform(0.2, 1.8, count)) * 1e-3
        yield {
            "step": 2.5e-4,
            "x": bits(x),
            "times": bits(times),
            "regular": bits(np.gradient(x, 2.5e-4, edge_order=2)),
            "irregular": bits(np.gradient(x, times, edge_order=2)),
        }


def interpolation():
    for count in (1, 2, 3, 500):
        x = motion(count)
        times = 7.0 + np.cumsum(RNG.uniform(0.2, 1.8, count)) * 1e-3
        rising = np.linspace(times[0] - 0.01, times[-1] + 0.01, 1234)
        at = np.concatenate((rising, times, RNG.permutation(rising)))
        yield {
            "x": bits(x),
            "times": bits(times),
            "at": bits(at),
            "y": bits(np.interp(at, times, x)),
        }


def correlation():
    for rho in (0.0, 0.5, 0.9, 0.98, -0.5):
        x = 3.0 + signal.lfilter([1.0], [1.0, -rho], RNG.standard_normal(40_000))
        centred = x - x.mean()
        sums = [np.dot(centred[: x.size - lag], centred[lag:]) for lag in range(101)]
        yield {"rho": rho, "x": bits(x), "y": bits(np.array(sums) / sums[0])}


TOPICS = [
    butterworth,
    low_cutoff,
    filtering,
    shortest,
    savitzky_golay,
    savitzky_golay_exact,
    gradient,
    interpolation,
    correlation,
]

if __name__ == "__main__":
    topics = {topic.__name__: topic for topic in TOPICS}
    if len(sys.argv) != 2 or sys.argv[1] not in topics:
        sys.exit(f"usage: make_reference.py TOPIC, one of {', '.join(topics)}")
    json.dump(list(topics[sys.argv[1]]()), sys.stdout)
