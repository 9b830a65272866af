"""A long text log of a simulated axis with columns that nobody asked for: `python long_text.py FILE ROWS`."""

import sys

import numpy as np
import pyarrow as pa
import pyarrow.csv

BLOCK = 1 << 20


def main():
    file, rows = sys.argv[1], int(sys.argv[2])
    random = np.random.default_rng(0)
    names = ["time [s]", "position [mm]", "velocity [mm/s]", "force [N]", "bus [V]", "cpu [%]", "spare 1", "spare 2"]
    schema = pa.schema([(name, pa.float64()) for name in names])
    with pyarrow.csv.CSVWriter(file, schema) as out:
        for start in range(0, rows, BLOCK):
            n = np.arange(start, min(start + BLOCK, rows))
            t = n / 1000
            x, v = 50 * np.sin(t), 50 * np.cos(t)
            force = 8 * np.sign(v) + 0.02 * v + 0.1 * random.standard_normal(len(n))
            others = 100 * random.standard_normal((4, len(n)))
            columns = [t, np.round(x, 6), np.round(v, 6), np.round(force, 5), *np.round(others, 5)]
            out.write_table(pa.Table.from_arrays([pa.array(c) for c in columns], schema=schema))


if __name__ == "__main__":
    main()
