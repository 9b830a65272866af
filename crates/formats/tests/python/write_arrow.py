"""Writes recordings as Arrow IPC files, streams and Feather with pyarrow and pandas, and beside each one the truth.

Usage: python write_arrow.py FOLDER

The truth is what pyarrow reads from the file.
"""

import datetime
import decimal

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.feather
import pyarrow.ipc

from truth import INTEGERS, Truth, bits, folder, half, rng, single, whole

N = 2500


def table():
    holes = pa.array(bits(N), mask=rng.integers(0, 3, size=N) == 0)
    start = 1_785_585_600_123_456_789
    ticks = start + np.cumsum(rng.integers(1, 2_000_000, size=N))
    late = rng.integers(0, 2, size=N).astype(bool)
    x, y = pa.array(bits(N)), pa.array(["a"] * N)
    columns = {"words": pa.array(["hold", None] * (N // 2)), "t": pa.array(bits(N)), "single": pa.array(single(N)),
               "half": pa.array(half(N)), "empty": pa.nulls(N), "view": pa.array(["some", "text"] * (N // 2), pa.string_view())}
    for dtype in INTEGERS:
        columns["i_" + np.dtype(dtype).name] = pa.array(whole(dtype, N))
    columns |= {
        "flag": pa.array(rng.integers(0, 2, size=N).astype(bool), mask=late),
        "list": pa.array([None, [1.0, 2.0], []] * (N // 3) + [[3.0, None]] * (N % 3)),
        "long_list": pa.array([[i, 7 - i, 2] for i in range(N)], pa.large_list(pa.int32())),
        "ragged": pa.array([[1.0] * (1 + i % 3) for i in range(N)]),
        "lists": pa.array([[["a"]], []] * (N // 2), pa.list_(pa.list_(pa.string_view()))),
        "map": pa.array([[("a", 1.0)]] * N, pa.map_(pa.string(), pa.float64())),
        "kinds": pa.array(["x", "y"] * (N // 2)).dictionary_encode(),
        "raw": pa.array([b"ab"] * N, pa.binary(2)),
        "holes": holes,
        "pose": pa.StructArray.from_arrays([x, y, pa.StructArray.from_arrays([pa.array(single(N))], ["w"])],
                                           ["x", "name", "deep"], mask=pa.array(late)),
        "joints": pa.FixedSizeListArray.from_arrays(pa.array(bits(3 * N)), 3),
        "some": pa.FixedSizeListArray.from_arrays(pa.array(bits(2 * N)), 2, mask=pa.array(late)),
        "stamp_ns": pa.array(ticks, pa.timestamp("ns")),
        "stamp_us": pa.array(ticks // 10**3, pa.timestamp("us", "UTC"), mask=late),
        "stamp_s": pa.array(ticks // 10**9, pa.timestamp("s")),
        "clock": pa.array((ticks % 86_400_000).astype(np.int32), pa.time32("ms")),
        "lag": pa.array(ticks - start, pa.duration("ns")),
        "day": pa.array([datetime.date(2024, 10, 4)] * N),
        "cents": pa.array([decimal.Decimal(int(c)).scaleb(-2) for c in whole(np.int32, N)], pa.decimal128(12, 2)),
        "runs": pa.RunEndEncodedArray.from_arrays([N], [1.0]),
        "last": pa.array(bits(N)),
    }
    return pa.table(columns)


def number(truth, name, array):
    """What pyarrow has at the place, in the units that the reader has to give."""
    kind = array.type
    if pa.types.is_struct(kind):
        for i in range(kind.num_fields):
            child = pa.array(array.flatten()[i])
            number(truth, f"{name}.{kind.field(i).name}", child)
    elif pa.types.is_fixed_size_list(kind):
        size = kind.list_size
        rows = [[np.nan] * size if row is None else row for row in array.to_pylist()]
        flat = array.values.to_numpy(zero_copy_only=False).reshape(-1, size).copy()
        flat[array.is_null().to_numpy(zero_copy_only=False)] = np.nan
        assert np.array_equal(flat, np.array(rows), equal_nan=True)
        truth.matrix(name, flat)
    elif name in ("list", "long_list"):
        size = 3 if name == "long_list" else 2
        rows = [[np.nan if x is None else x for x in row or [None] * size] for row in array.to_pylist()]
        truth.matrix(name, np.array(rows, dtype=float))
    elif pa.types.is_timestamp(kind) or pa.types.is_duration(kind) or pa.types.is_time(kind):
        over = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}[kind.unit]
        wide = pa.int32() if pa.types.is_time32(kind) else pa.int64()
        counts = array.cast(wide).to_pylist()
        first = next(c for c in counts if c is not None) if pa.types.is_timestamp(kind) else 0
        truth.column(name, [np.nan if c is None else (c - first) / over for c in counts])
    elif pa.types.is_date32(kind):
        truth.column(name, array.cast(pa.int32()).to_numpy())
    elif pa.types.is_decimal(kind):
        truth.column(name, [float(value) for value in array.to_pylist()])
    elif pa.types.is_boolean(kind):
        truth.column(name, [np.nan if value is None else float(value) for value in array.to_pylist()])
    elif pa.types.is_floating(kind) or pa.types.is_integer(kind):
        missing = array.is_null().to_numpy(zero_copy_only=False)
        values = np.frombuffer(array.buffers()[1], kind.to_pandas_dtype())[array.offset:][: len(array)]
        with np.errstate(invalid="ignore"):
            values = values.astype(float)
        values[missing] = np.nan
        truth.column(name, values)
    else:
        truth.skipped(name)


def written(name, write, read):
    truth = Truth(name)
    write(truth.path)
    table = read(truth.path).combine_chunks()
    for column in table.column_names:
        chunks = table[column].chunks
        assert len(chunks) == 1
        number(truth, column, chunks[0])
    truth.write()


def opened(path):
    return pa.ipc.open_file(path).read_all()


def streamed(path):
    return pa.ipc.open_stream(path.read_bytes()).read_all()


def ipc(new, compression, rows):
    def write(path):
        options = pa.ipc.IpcWriteOptions(compression=compression)
        with new(path, whole_table.schema, options=options) as writer:
            writer.write_table(whole_table, max_chunksize=rows)
    return write


whole_table = table()
for compression in [None, "lz4", "zstd"]:
    for rows in [700, N]:
        written(f"file_{compression}_{rows}.arrow", ipc(pa.ipc.new_file, compression, rows), opened)
        written(f"stream_{compression}_{rows}.arrows", ipc(pa.ipc.new_stream, compression, rows), streamed)
plain = whole_table.select(["t", "i_int16", "flag", "holes", "words"])
for compression in ["uncompressed", "lz4", "zstd"]:
    written(f"{compression}.feather", lambda path: pyarrow.feather.write_feather(plain, path, compression),
            lambda path: pyarrow.feather.read_table(path))
frame = pd.DataFrame({"t": np.linspace(0, 1, 900), "phase": ["a", "b", "c"] * 300})
written("pandas.feather", frame.to_feather, lambda path: pyarrow.feather.read_table(path))
units = pa.schema([pa.field("q", pa.float64(), metadata={"unit": "mm"}), pa.field("n", pa.int16())])


def one_row(path):
    with pa.ipc.new_file(path, units) as writer:
        writer.write_table(pa.table([[1.5], [2]], schema=units))


written("one_row.arrow", one_row, opened)
