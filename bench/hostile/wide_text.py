"""A long text log of a simulated axis with twelve columns, and an axis file that maps three: `python wide_text.py DIR ROWS`."""

import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv

BLOCK = 1 << 20
AXIS = """kind = "linear"

[columns]
time     = "time"
position = "position"
force    = "force"
"""


def main():
    folder, rows = Path(sys.argv[1]), int(sys.argv[2])
    random = np.random.default_rng(0)
    names = ["time [s]", "position [mm]", "force [N]", *(f"spare {n}" for n in range(1, 10))]
    schema = pa.schema([(name, pa.float64()) for name in names])
    with pyarrow.csv.CSVWriter(folder / "wide.csv", schema) as out:
        for start in range(0, rows, BLOCK):
            n = np.arange(start, min(start + BLOCK, rows))
            t = n / 1000
            x, v = 50 * np.sin(t), 50 * np.cos(t)
            force = 8 * np.sign(v) + 0.02 * v + 0.1 * random.standard_normal(len(n))
            others = 100 * random.standard_normal((9, len(n)))
            columns = [t, np.round(x, 6), np.round(force, 5), *np.round(others, 3)]
            out.write_table(pa.Table.from_arrays([pa.array(c) for c in columns], schema=schema))
    (folder / "axis.toml").write_text(AXIS)


if __name__ == "__main__":
    main()
