"""Writes recordings in every binary format that NumPy, SciPy, h5py and pyarrow write, and beside each one the truth.

Usage: python write_binary.py FOLDER
"""

import datetime
import decimal
import struct

import h5py
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io
import scipy.sparse

from truth import INTEGERS, Truth, bits, folder, half, rng, single, whole


def matlab5(name, column, compress):
    n = 4001
    truth = Truth(name)
    variables = {}

    def vector(key, values):
        variables[key] = values
        truth.column(key, values)

    vector("t", bits(n))
    vector("single", single(n))
    for dtype in INTEGERS:
        vector("i_" + np.dtype(dtype).name, whole(dtype, 37))
    vector("flag", rng.integers(0, 2, size=19).astype(bool))
    variables["gtau"] = 35.1507
    truth.scalar("gtau", 35.1507)
    variables["count"] = np.int32(-7)
    truth.scalar("count", -7)
    variables["m"] = bits(3 * 500).reshape(500, 3)
    truth.matrix("m", variables["m"])
    variables["comment"] = "a drive"
    variables["z"] = np.array([1 + 2j, 3.0, 4.0])
    variables["sparse"] = scipy.sparse.csc_matrix(np.eye(4))
    variables["cube"] = np.zeros((3, 4, 5))
    variables["none"] = np.zeros((0, 0))
    truth.skipped("comment", "z", "sparse", "cube", "none")
    deep = {"torque": bits(50), "kt": 0.25, "inner": {"q": bits(51), "name": "axis"}}
    variables["drive"] = deep
    truth.column("drive.torque", deep["torque"])
    truth.scalar("drive.kt", 0.25)
    truth.column("drive.inner.q", deep["inner"]["q"])
    truth.skipped("drive.inner.name")
    runs = np.zeros((2,), dtype=[("v", object), ("load", object)])
    for i in range(2):
        runs[i] = (bits(60 + i), float(i) + 0.5)
        truth.column(f"runs({i + 1}).v", runs[i]["v"])
        truth.scalar(f"runs({i + 1}).load", i + 0.5)
    variables["runs"] = runs
    cell = np.empty((3,), dtype=object)
    cell[0], cell[1], cell[2] = bits(20), "text", whole(np.int16, 9)
    variables["cell"] = cell
    truth.column("cell{1}", cell[0])
    truth.skipped("cell{2}")
    truth.column("cell{3}", cell[2])
    large = bits(200_000).reshape(100_000, 2)
    variables["large"] = large
    truth.matrix("large", large)
    scipy.io.savemat(truth.path, variables, do_compression=compress, oned_as=column)
    truth.write()


def matlab5_big_endian(name):
    """SciPy reads big-endian files but writes none; it has to agree with what is written here."""
    truth = Truth(name)
    q, count = bits(33), whole(np.int16, 12)

    def element(kind, content):
        return struct.pack(">II", kind, len(content)) + content + bytes(-len(content) % 8)

    def variable(key, code, kind, values):
        body = element(6, struct.pack(">II", code, 0))
        body += element(5, struct.pack(">ii", values.size, 1))
        # A short name as a small element: size and type share one word.
        text = key.encode()
        body += struct.pack(">HH", len(text), 1) + text.ljust(4, b"\0")
        body += element(kind, values.astype(values.dtype.newbyteorder(">")).tobytes())
        return element(14, body)

    head = b"MATLAB 5.0 MAT-file, big-endian".ljust(124) + struct.pack(">H", 0x0100) + b"MI"
    truth.path.write_bytes(head + variable("q", 6, 9, q) + variable("n", 10, 3, count))
    read = scipy.io.loadmat(truth.path)
    assert read["q"].astype("<f8").tobytes() == q.tobytes()
    assert np.array_equal(read["n"].ravel(), count)
    truth.column("q", q)
    truth.column("n", count)
    truth.write()


def matlab4(name):
    truth = Truth(name)
    variables = {"t": bits(300), "single": single(20), "i": whole(np.int32, 30), "k": 2.5,
                 "m": bits(40).reshape(20, 2), "text": "hello", "z": np.array([1 + 1j, 2.0])}
    scipy.io.savemat(truth.path, variables, format="4", oned_as="column")
    truth.column("t", variables["t"])
    truth.column("single", variables["single"])
    truth.column("i", variables["i"])
    truth.scalar("k", 2.5)
    truth.matrix("m", variables["m"])
    truth.skipped("text", "z")
    truth.write()


def hdf5(name, libver):
    truth = Truth(name)
    with h5py.File(truth.path, "w", libver=libver) as file:
        def column(path, values, **options):
            file.create_dataset(path, data=values, **options)
            truth.column(path.replace("/", "."), values)

        # In the order of their names.
        column("a_plain", bits(3000))
        column("b_gzip", bits(50_000), chunks=(1000,), compression="gzip", shuffle=True)
        column("c_lzf", bits(5000), chunks=(512,), compression="lzf", fletcher32=True)
        column("d_big", bits(100).astype(">f8"))
        column("e_single", single(700))
        column("f_half", half(65536))
        column("g/inner/q", bits(40))
        column("g/torque", bits(41))
        file["g/torque"].attrs["unit"] = "N m"
        for dtype in sorted(INTEGERS, key=lambda t: np.dtype(t).name):
            column("i_" + np.dtype(dtype).name, whole(dtype, 33))
        column("j_bool", rng.integers(0, 2, size=21).astype(bool))
        matrix = bits(600).reshape(200, 3)
        file.create_dataset("k_matrix", data=matrix, chunks=(64, 2), compression="gzip")
        truth.matrix("k_matrix", matrix)
        file["l_scalar"] = 4.75
        truth.scalar("l_scalar", 4.75)
        record = np.zeros(70, dtype=[("t", "<f8"), ("n", ">i2"), ("tag", "S3")])
        record["t"], record["n"] = bits(70), whole(np.int16, 70)
        file["m_record"] = record
        truth.column("m_record.t", record["t"])
        truth.column("m_record.n", record["n"])
        truth.skipped("m_record.tag")
        file["n_text"] = "hello"
        file.create_dataset("o_words", data=["a", "bc"], dtype=h5py.string_dtype())
        ragged = file.create_dataset("p_ragged", (2,), dtype=h5py.vlen_dtype(np.float64))
        ragged[0] = [1.0, 2.0]
        file.create_dataset("q_empty", (0,), maxshape=(None,), dtype="f8")
        file.create_dataset("r_cube", data=np.zeros((2, 3, 4)))
        truth.skipped("n_text", "o_words", "p_ragged", "q_empty", "r_cube")
        grown = file.create_dataset("s_grown", (0,), maxshape=(None,), chunks=(100,), dtype="f8")
        values = bits(950)
        for start in range(0, 950, 190):
            grown.resize((start + 190,))
            grown[start:] = values[start : start + 190]
        truth.column("s_grown", values)
    truth.write()


def matlab73(name):
    """As MATLAB lays it out: a user block, reversed axes, classes in attributes, cells by reference."""
    truth = Truth(name)
    with h5py.File(truth.path, "w", userblock_size=512) as file:
        def put(group, key, values, kind="double", **options):
            data = np.asarray(values)
            data = data.reshape(-1, 1) if data.ndim < 2 else data
            made = group.create_dataset(key, data=data.T, **options)
            made.attrs["MATLAB_class"] = np.bytes_(kind)
            return made

        drive = file.create_group("drive")
        drive.attrs["MATLAB_class"] = np.bytes_("struct")
        torque = bits(80)
        put(drive, "kt", 0.125)
        put(drive, "torque", torque)
        truth.scalar("drive.kt", 0.125)
        truth.column("drive.torque", torque)
        flag = rng.integers(0, 2, size=9).astype(np.uint8)
        put(file, "flag", flag, "logical")
        truth.column("flag", flag)
        matrix = bits(400).reshape(100, 4)
        put(file, "m", matrix, chunks=(2, 50), compression="gzip")
        truth.matrix("m", matrix)
        put(file, "name", np.frombuffer(b"axis", dtype=np.uint8).astype(np.uint16), "char")
        truth.skipped("name")
        put(file, "nothing", np.zeros(2, dtype=np.uint64)).attrs["MATLAB_empty"] = np.uint8(1)
        truth.skipped("nothing")
        row = bits(70).reshape(1, 70)
        put(file, "row", row)
        truth.column("row", row)
        store = file.create_group("#refs#")
        first, second = bits(11), whole(np.int32, 12)
        one, two = put(store, "a", first), put(store, "b", second, "int32")
        cell = np.array([[one.ref], [two.ref]], dtype=h5py.ref_dtype)
        file.create_dataset("runs", data=cell, dtype=h5py.ref_dtype)
        file["runs"].attrs["MATLAB_class"] = np.bytes_("cell")
        truth.column("runs{1}", first)
        truth.column("runs{2}", second)
        z = np.zeros((1, 5), dtype=[("real", "f8"), ("imag", "f8")])
        file.create_dataset("z", data=z).attrs["MATLAB_class"] = np.bytes_("double")
        truth.skipped("z")
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM"
    with open(truth.path, "r+b") as file:
        file.write(head.ljust(512, b"\0"))
    truth.write()


def npz(name, save):
    truth = Truth(name)
    arrays = {}

    def column(key, values):
        arrays[key] = values
        truth.column(key, values)

    column("t", bits(5000))
    column("big", bits(500).astype(">f8"))
    column("single", single(300))
    column("half", half(65536))
    for dtype in INTEGERS:
        column("i_" + np.dtype(dtype).name, whole(dtype, 44))
        column("b_" + np.dtype(dtype).name, whole(dtype, 44).astype(np.dtype(dtype).newbyteorder(">")))
    column("flag", rng.integers(0, 2, size=19).astype(bool))
    arrays["zero"] = np.float64(9.81)
    truth.scalar("zero", 9.81)
    c, fortran = bits(90).reshape(30, 3), np.asfortranarray(bits(90).reshape(30, 3))
    arrays["c"], arrays["fortran"] = c, fortran
    truth.matrix("c", c)
    truth.matrix("fortran", fortran)
    arrays["words"] = np.array(["hold", "ramp"])
    arrays["bytes"] = np.array([b"x", b"yz"])
    arrays["json"] = np.array('{"kt": 1.0}')
    arrays["z"] = np.array([1 + 2j, 3])
    arrays["cube"] = np.zeros((2, 3, 4))
    arrays["none"] = np.zeros(0)
    arrays["objects"] = np.array([{"a": 1}, None], dtype=object)
    truth.skipped("words", "bytes", "json", "z", "cube", "none", "objects")
    ticks = np.datetime64("2026-08-01T12:00:00.000000001", "ns") + np.arange(6).astype("m8[us]")
    ticks[4] = np.datetime64("NaT")
    arrays["stamp"] = ticks
    seconds = (ticks - ticks[0]).astype(np.int64) / 1e9
    seconds[4] = np.nan
    truth.column("stamp", seconds)
    arrays["lag"] = np.arange(7).astype("m8[10ms]")
    truth.column("lag", np.arange(7) * 10 / 1000)
    if np.finfo(np.longdouble).bits != 64:
        arrays["long"] = np.zeros(3, dtype=np.longdouble)
        truth.skipped("long")
    save(truth.path, **arrays)
    truth.write()


def npy(name, values, describe):
    truth = Truth(name)
    np.save(truth.path, values)
    describe(truth)
    truth.write()


def structured(name):
    truth = Truth(name)
    inner = np.dtype([("x", "<f8"), ("y", ">f4")])
    kind = np.dtype([("t", "<f8"), ("pad", "i1"), ("pose", inner), ("v", "<f8", (2,)), ("tag", "U3"),
                     ("z", "c16")], align=True)
    rows = np.zeros(1234, dtype=kind)
    rows["t"], rows["pad"] = bits(1234), whole(np.int8, 1234)
    rows["pose"]["x"], rows["pose"]["y"] = bits(1234), single(1234)
    rows["v"] = bits(2468).reshape(-1, 2)
    np.save(truth.path, rows)
    truth.column("t", rows["t"])
    truth.column("pad", rows["pad"])
    truth.column("pose.x", rows["pose"]["x"])
    truth.column("pose.y", rows["pose"]["y"])
    truth.matrix("v", rows["v"])
    truth.skipped("tag", "z")
    truth.write()


def parquet(name, **options):
    truth = Truth(name)
    n = 2500
    columns = {}

    def column(key, values, array=None):
        columns[key] = pa.array(values) if array is None else array
        truth.column(key, values)

    column("t", bits(n))
    column("repeated", np.tile(bits(25), n // 25))
    column("single", single(n))
    column("half", half(n))
    for dtype in INTEGERS:
        column("i_" + np.dtype(dtype).name, whole(dtype, n))
    column("flag", rng.integers(0, 2, size=n).astype(bool))
    holes = rng.integers(0, 3, size=n) == 0
    values = bits(n)
    missing = values.copy()
    missing[holes] = np.nan
    # NumPy's NaN has the bits that a missing value is given.
    column("holes", missing, pa.array(values, mask=holes))
    columns["words"] = pa.array(["hold", None] * (n // 2))
    truth.skipped("words")
    lists = bits(3 * n).reshape(n, 3)
    rows = lists.tolist()
    for row in range(0, n, 7):
        rows[row], lists[row] = None if row % 2 else [], np.nan
    rows[1][2], lists[1][2] = None, np.nan
    columns["list"] = pa.array(rows)
    truth.matrix("list", lists)
    state = single(2 * n)
    columns["observation.state"] = pa.FixedSizeListArray.from_arrays(pa.array(state), 2)
    truth.matrix("observation.state", state.reshape(n, 2))
    columns["one"] = pa.array([[float(i)] for i in range(n)])
    truth.column("one", np.arange(n))
    columns["ragged"] = pa.array([[1.0] * (1 + i % 3) for i in range(n)])
    columns["nested"] = pa.array([[[1.0], [2.0]]] * n)
    columns["texts"] = pa.array([["a"]] * n)
    columns["points"] = pa.array([[{"x": 1.0}]] * n)
    truth.skipped("ragged", "nested.list.element.list.element", "texts", "points.list.element.x")
    x = bits(n)
    columns["pose"] = pa.StructArray.from_arrays([pa.array(x), pa.array(["a"] * n)], ["x", "name"])
    truth.column("pose.x", x)
    truth.skipped("pose.name")
    start = 1_785_585_600_123_456_789
    offsets = np.cumsum(rng.integers(1, 2_000_000, size=n))
    offsets[0] = 0
    for unit, divide in [("ns", 1), ("us", 10**3), ("ms", 10**6)]:
        ticks = (start + offsets) // divide
        seconds = (ticks - ticks[0]) / (10**9 // divide)
        column("stamp_" + unit, seconds, pa.array(ticks, pa.timestamp(unit)))
    column("clock", offsets / 1e9, pa.array(offsets, pa.time64("ns")))
    column("day", np.full(n, 20_000), pa.array([datetime.date(2024, 10, 4)] * n))
    cents = whole(np.int32, n)
    exact = [decimal.Decimal(int(c)).scaleb(-2) for c in cents]
    column("cents", np.array([float(d) for d in exact]), pa.array(exact, pa.decimal128(12, 2)))
    pq.write_table(pa.table(columns), truth.path, row_group_size=700, data_page_size=4096, **options)
    truth.write()


def int96(name):
    truth = Truth(name)
    ticks = 1_785_585_600_123_456_789 + np.cumsum(rng.integers(1, 2_000_000, size=500))
    table = pa.table({"stamp": pa.array(ticks, pa.timestamp("ns"))})
    pq.write_table(table, truth.path, use_deprecated_int96_timestamps=True)
    truth.column("stamp", (ticks - ticks[0]) / 1e9)
    truth.write()


def encodings(name, **options):
    truth = Truth(name)
    t, q, n, m = bits(3000), single(3000), whole(np.int64, 3000), np.cumsum(whole(np.int8, 3000), dtype=np.int32)
    table = pa.table({"t": t, "q": q, "n": n, "m": m})
    pq.write_table(table, truth.path, use_dictionary=False, data_page_version="2.0", column_encoding={
        "t": "BYTE_STREAM_SPLIT", "q": "BYTE_STREAM_SPLIT", "n": "DELTA_BINARY_PACKED",
        "m": "DELTA_BINARY_PACKED"}, **options)
    for key, values in [("t", t), ("q", q), ("n", n), ("m", m)]:
        truth.column(key, values)
    truth.write()


def pandas(name, compression):
    truth = Truth(name)
    frame = pd.DataFrame({"t": bits(900), "n": whole(np.int32, 900), "phase": ["a", "b", "c"] * 300})
    frame.to_parquet(truth.path, compression=compression)
    # pandas writes every NaN as a missing value.
    t = frame["t"].to_numpy().copy()
    t[np.isnan(t)] = np.nan
    truth.column("t", t)
    truth.column("n", frame["n"])
    truth.skipped("phase")
    truth.write()


matlab5("v5_plain.mat", "column", False)
matlab5("v5_compressed.mat", "row", True)
matlab5_big_endian("v5_big_endian.mat")
matlab4("v4.mat")
hdf5("plain.h5", "earliest")
# HDF5 2.0 writes chunked data in a layout (version 5) that the reader does not know yet.
hdf5("v114.h5", "v114")
matlab73("v73.mat")
npz("stored.npz", np.savez)
npz("deflated.npz", np.savez_compressed)
vector = bits(777)
npy("vector.npy", vector, lambda truth: truth.column("", vector))
matrix = np.asfortranarray(bits(600).reshape(200, 3))
npy("matrix.npy", matrix, lambda truth: truth.matrix("", matrix))
structured("structured.npy")
parquet("none.parquet", compression="none")
parquet("snappy.parquet", compression="snappy")
parquet("plain.parquet", compression="snappy", use_dictionary=False, data_page_version="2.0")
for packing in ["zstd", "gzip", "lz4"]:
    parquet(f"{packing}.parquet", compression=packing)
    parquet(f"{packing}_2.parquet", compression=packing, data_page_version="2.0")
    encodings(f"encodings_{packing}.parquet", compression=packing)
encodings("encodings.parquet", compression="none")
encodings("encodings_snappy.parquet", compression="snappy")
int96("int96.parquet")
pandas("pandas_snappy.parquet", "snappy")
pandas("pandas_none.parquet", None)
pq.write_table(pa.table({"t": bits(100)}), folder / "refused.parquet", compression="brotli")
