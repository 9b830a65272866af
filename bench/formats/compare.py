"""How long reading a log takes in each format, beside the reader of Python that the tests compare with.

    python3 bench/formats/compare.py

One log of 200 000 rows (time, position, torque, and a reference) is written in every format; each reader takes all columns as
64-bit floats, the least of five rounds. SVB is written by the layout in `crates/log/tests/python/write_svb.py`: no reader of
Python knows it. Prints the table of docs/performance.md.
"""

import json
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

# What the tests read with.
environment.enter(environment.ROOT / ".venv", environment.ROOT / "xtask/requirements.txt")

import h5py
import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.csv
import pyarrow.feather
import pyarrow.parquet
import scipy.io
from asammdf import MDF, Signal
from mcap_ros2.reader import read_ros2_messages
from mcap_ros2.writer import Writer
from nptdms import ChannelObject, TdmsFile, TdmsWriter

ROWS, ROUNDS = 200_000, 5
SLOW_ROWS = 20_000  # of formats whose Python readers and writers take a second for this much
NAMES = ("time", "position", "torque", "reference")


def log(rows):
    t = np.arange(rows) / 4000
    return {"time": t, "position": 0.1 * np.sin(7 * t), "torque": np.cos(7 * t) + 0.01 * np.sin(900 * t), "reference": 0.1 * np.sin(7 * t + 0.01)}


def text(file, data):
    np.savetxt(file, np.column_stack(list(data.values())), delimiter=",", header=",".join(NAMES), comments="", fmt="%.9g")


def lines(file, data):
    rows = zip(*(column.tolist() for column in data.values()))
    file.write_text("".join(json.dumps(dict(zip(NAMES, row))) + "\n" for row in rows))


def hdf5(file, data):
    with h5py.File(file, "w") as out:
        for name, column in data.items():
            out[name] = column


def tdms(file, data):
    with TdmsWriter(file) as out:
        out.write_segment([ChannelObject("log", name, column) for name, column in data.items()])


def mdf(compression):
    def write(file, data):
        signals = [Signal(samples=column, timestamps=data["time"], name=name) for name, column in data.items() if name != "time"]
        with MDF(version="4.10") as out:
            out.append(signals)
            out.save(file, overwrite=True, compression=compression)

    return write


def from_mdf(file):
    with MDF(file) as given:
        return [given.get(name).samples for name in NAMES]


def workbook(file, data):
    book = openpyxl.Workbook(write_only=True)
    sheet = book.create_sheet("log")
    sheet.append(NAMES)
    for row in zip(*(column.tolist() for column in data.values())):
        sheet.append(row)
    book.save(file)


def mcap(file, data):
    with open(file, "wb") as out:
        writer = Writer(out)
        schema = writer.register_msgdef("bench/Log", "\n".join(f"float64 {name}" for name in NAMES))
        for k, row in enumerate(zip(*(column.tolist() for column in data.values()))):
            writer.write_message("/log", schema, dict(zip(NAMES, row)), log_time=250_000 * k, publish_time=250_000 * k)
        writer.finish()


def scope(file, data):
    def words(value):
        return struct.pack("<i", len(value)) + value.encode()

    rows = len(data["time"])
    stamps = (2500 * np.arange(rows)).astype("<u4")
    channels = {name: column for name, column in data.items() if name != "time"}

    def headers(at):
        out = b""
        for name in channels:
            rest = (words(name) + words("5.1") + struct.pack("<iq?", 851, 2500, True) + words(f"MAIN.{name}") + words("")
                    + struct.pack("<qq", 16448, 608) + words("REAL64")
                    + struct.pack("<iiqqqddq", 5, 8, rows, 12 * rows, at, 0.0, 1.0, -1))
            out += struct.pack("<q", 8 + len(rest)) + rest
            at += 12 * rows
        return out

    main = words("YT Scope Project") + struct.pack("<qqi", 132_959_733_843_760_000, 132_959_734_843_760_000, len(channels))
    length = 8 + len(main) + len(headers(0))
    with open(file, "wb") as out:
        out.write(struct.pack("<q", length) + main + headers(length))
        for column in channels.values():
            pairs = np.zeros(rows, dtype=[("t", "<u4"), ("v", "<f8")])
            pairs["t"], pairs["v"] = stamps, column
            out.write(pairs.tobytes())


def from_workbook(file):
    sheet = openpyxl.load_workbook(file, read_only=True, data_only=True)["log"]
    return np.array(list(sheet.iter_rows(min_row=2, values_only=True)), dtype=float)


def from_mcap(file):
    return np.array([[getattr(m.ros_msg, name) for name in NAMES] for m in read_ros2_messages(file)])


def from_lines(file):
    return np.array([list(json.loads(line).values()) for line in open(file)])


def from_hdf5(file):
    with h5py.File(file) as given:
        return [given[name][:] for name in NAMES]


FORMATS = [
    # Name, file, rows, how it is written, the other reader and its name.
    ("text", "log.csv", ROWS, text, lambda f: pyarrow.csv.read_csv(f), "pyarrow.csv, threads"),
    ("NumPy", "log.npz", ROWS, lambda f, d: np.savez(f, **d), lambda f: {k: v for k, v in np.load(f).items()}, "numpy"),
    ("MATLAB v7", "log.mat", ROWS, lambda f, d: scipy.io.savemat(f, d, do_compression=True), scipy.io.loadmat, "scipy"),
    ("HDF5", "log.h5", ROWS, hdf5, from_hdf5, "h5py"),
    ("Parquet", "log.parquet", ROWS, lambda f, d: pyarrow.parquet.write_table(pa.table(d), f), pyarrow.parquet.read_table, "pyarrow, threads"),
    ("Arrow, LZ4", "log.feather", ROWS, lambda f, d: pyarrow.feather.write_feather(pa.table(d), f), pyarrow.feather.read_table, "pyarrow, threads"),
    ("TDMS", "log.tdms", ROWS, tdms, lambda f: TdmsFile.read(f).as_dataframe(), "nptdms"),
    ("MDF 4", "log.mf4", ROWS, mdf(0), from_mdf, "asammdf"),
    ("MDF 4, transposed", "packed.mf4", ROWS, mdf(2), from_mdf, "asammdf"),
    ("TwinCAT SVB", "log.svb", ROWS, scope, None, "none known"),
    ("JSON lines", "log.jsonl", SLOW_ROWS, lines, from_lines, "json"),
    ("MCAP", "log.mcap", SLOW_ROWS, mcap, from_mcap, "mcap_ros2"),
    ("xlsx", "log.xlsx", SLOW_ROWS, workbook, from_workbook, "openpyxl"),
]


def least(read, file):
    times = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        read(file)
        times.append(time.perf_counter() - begun)
    return 1e3 * min(times)


def main():
    program = environment.example("speed")
    print(environment.described("numpy", "pyarrow", "scipy", "h5py", "nptdms", "asammdf", "openpyxl") + ".\n")
    print("| format | numbers | file, MB | stiction, ms | million numbers a second | beside, ms | reader |\n|---|---:|---:|---:|---:|---:|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, file, rows, write, read, reader in FORMATS:
            file = Path(folder) / file
            write(file, log(rows))
            own = subprocess.run([program, str(ROUNDS), file], check=True, capture_output=True, text=True)
            _, milliseconds, numbers = own.stdout.split("\t")
            milliseconds, numbers = float(milliseconds), int(numbers)
            other = f"{least(read, file):.1f}" if read else "-"
            rate = numbers / milliseconds / 1e3
            print(f"| {name} | {numbers} | {file.stat().st_size / 1e6:.1f} | {milliseconds:.1f} | {rate:.1f} | {other} | {reader} |", flush=True)


if __name__ == "__main__":
    main()
