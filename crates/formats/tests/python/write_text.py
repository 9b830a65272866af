"""Writes random logs in the ways Python programs do, each with its values as raw f64 in a .bin
(one byte: the number of columns; then column after column, little endian)."""

import csv
import random
import struct
import sys
from pathlib import Path

import numpy as np
import pandas as pd

OUT = Path(sys.argv[1])
RNG = random.Random(20240501)


def any_float():
    """Any finite bit pattern: subnormals, huge, negative zero."""
    while True:
        value = struct.unpack("<d", RNG.getrandbits(64).to_bytes(8, "little"))[0]
        if np.isfinite(value):
            return value


def plain_float():
    return RNG.choice([RNG.gauss(0, 1), RNG.randint(-9, 9) / 8, RNG.uniform(-1, 1) * 1e-5, 0.1 + 0.2])


# Values halfway between two floats, or a hair beside; they are written with more digits than repr.
HALFWAY = ["9007199254740993.0", "9007199254740992.99999999999999999999", "2.2250738585072011e-308",
           "1.00000000000000011102230246251565404236316680908203125", "1.7976931348623158e308",
           "4.9406564584124654e-324", "2.4703282292062328e-324", "0.1e-1", "+1.5E+0003", "-0.0", "5."]


def save(name, columns):
    rows = np.array(columns, dtype="<f8")
    (OUT / name).with_suffix(".bin").write_bytes(bytes([len(columns)]) + rows.tobytes())


def main():
    wild = [[any_float() for _ in range(20000)] for _ in range(3)]
    tame = [[plain_float() for _ in range(20000)] for _ in range(4)]

    for name, columns, sep in [("wild.csv", wild, ","), ("tame.tsv", tame, "\t"), ("tame.txt", tame, " ")]:
        with open(OUT / name, "w") as f:
            for row in zip(*columns):
                f.write(sep.join(map(repr, row)) + "\n")
        save(name, columns)

    with open(OUT / "comma.csv", "w") as f:
        f.write("a;b;c\n")
        for row in zip(*wild):
            f.write(";".join(repr(v).replace(".", ",") for v in row) + "\n")
    save("comma.csv", wild)

    with open(OUT / "halfway.csv", "w") as f:
        f.write("t,x\n" + "".join(f"{i}.5,{h}\n" for i, h in enumerate(HALFWAY)))
    save("halfway.csv", [[i + 0.5 for i in range(len(HALFWAY))], [float(h) for h in HALFWAY]])

    array = np.array(wild).T
    np.savetxt(OUT / "numpy.txt", array)
    save("numpy.txt", wild)
    np.savetxt(OUT / "numpy_header.csv", array, delimiter=",", header="t,x,F", fmt="%.17g")
    save("numpy_header.csv", wild)

    names = ["time [s]", "position [mm]", "torque [Nm]"]
    frame = pd.DataFrame(dict(zip(names, wild)))
    frame.to_csv(OUT / "pandas.csv", index=False)
    save("pandas.csv", wild)
    frame.to_csv(OUT / "pandas_german.csv", index=False, sep=";", decimal=",", encoding="utf-16")
    save("pandas_german.csv", wild)
    frame.to_csv(OUT / "pandas_index.csv", encoding="utf-8-sig", lineterminator="\r\n")
    save("pandas_index.csv", [list(range(20000))] + wild)
    frame.to_csv(OUT / "pandas_quoted.csv", index=False, quoting=csv.QUOTE_ALL)
    save("pandas_quoted.csv", wild)

    holes = frame.mask(np.random.default_rng(1).random(frame.shape) < 0.2)
    holes["phase"] = "hold, please"
    holes["moving"] = np.arange(len(holes)) % 2 == 0
    holes.to_csv(OUT / "pandas_holes.csv", index=False, na_rep="NaN")
    save("pandas_holes.csv", [holes[n] for n in names] + [holes["moving"].astype(float)])

    start = pd.Timestamp("2024-02-28 23:59:58")
    steps = np.cumsum(np.random.default_rng(2).integers(1, 2_000_000, 5000)) * 1000
    times = pd.DataFrame({"time": start + pd.to_timedelta(steps, "ns"), "x": tame[0][:5000]})
    times.to_csv(OUT / "pandas_dates.csv", index=False)
    # Nanoseconds are exact in a float; one division rounds once.
    save("pandas_dates.csv", [(steps - steps[0]) / 1e9, tame[0][:5000]])


main()
