"""What a reader must find in a recording, written beside it.

`x.mat` gets a file `x.mat.truth`: records of kind (0 column, 1 scalar, 2 left out), length of the
name, name, number of samples, samples as 64-bit floats; integers little-endian, in the order in
which the reader must give them. Samples are random bit patterns with the special values in front,
so that every bit of every float is tried; the seed is fixed. The folder is the argument of the script.
"""

import pathlib
import struct
import sys

import numpy as np

folder = pathlib.Path(sys.argv[1])
rng = np.random.default_rng(20260801)

SPECIAL = np.array(
    [0.0, -0.0, np.inf, -np.inf, np.nan, 5e-324, -5e-324, 2.2250738585072014e-308,
     1.7976931348623157e308, 0.1, 1 / 3]
)
SIGNALLING = np.array([0x7FF0000000000001, 0xFFF4000000000000], dtype=np.uint64).view(np.float64)


def bits(n):
    """n floats of random bit patterns, with the special ones in front."""
    wild = rng.integers(0, 2**64, size=n, dtype=np.uint64).view(np.float64)
    front = np.concatenate([SPECIAL, SIGNALLING])[:n]
    wild[: len(front)] = front
    return wild


def whole(dtype, n):
    """n integers over the whole range of the type, its ends in front."""
    info = np.iinfo(dtype)
    out = rng.integers(info.min, info.max, size=n, dtype=dtype, endpoint=True)
    out[:2] = info.min, info.max
    return out


def single(n):
    return rng.integers(0, 2**32, size=n, dtype=np.uint32).view(np.float32)


def half(n):
    """Every half-precision number; of the NaNs one, since their payloads are widened differently."""
    every = np.arange(n, dtype=np.uint16)
    every[(every & 0x7C00 == 0x7C00) & (every & 0x3FF != 0)] = 0x7E00
    return every.view(np.float16)


class Truth:
    def __init__(self, name):
        self.path = folder / name
        self.records = []

    def add(self, kind, name, values):
        with np.errstate(invalid="ignore"):
            values = np.atleast_1d(np.asarray(values)).astype("<f8").ravel()
        text = name.encode()
        self.records.append(struct.pack("<II", kind, len(text)) + text
                            + struct.pack("<Q", values.size) + values.tobytes())

    def column(self, name, values):
        self.add(0, name, values)

    def scalar(self, name, value):
        self.add(1, name, value)

    def skipped(self, *names):
        for name in names:
            self.add(2, name, [])

    def matrix(self, name, values):
        for j in range(values.shape[1]):
            self.column(f"{name}(:,{j + 1})" if name else "", values[:, j])

    def write(self):
        pathlib.Path(f"{self.path}.truth").write_bytes(b"".join(self.records))


INTEGERS = [np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64]
