"""Writes one small recording for every format and storage form, to be damaged by the tests.

Usage: python write_small.py FOLDER

Small files, so that most damage hits the structure of the file and not its samples.
"""

import json
import pathlib
import shutil
import sqlite3
import struct
import sys

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.ipc
import pyarrow.parquet as pq
import scipy.io
from asammdf import MDF, Signal
from mcap.writer import CompressionType
from mcap_ros2.writer import Writer
from nptdms import ChannelObject, RootObject, TdmsWriter
from openpyxl import Workbook
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer as Bag
from rosbags.typesys import Stores, get_typestore

from mdf import Blocks, linear

folder = pathlib.Path(sys.argv[1])
t = np.linspace(0.0, 1.0, 40)
q = np.sin(9 * t)
matrix = np.column_stack([t, q])
count = np.arange(40, dtype=np.int16)

cell = np.empty((2,), dtype=object)
cell[0], cell[1] = q, "text"
runs = np.zeros((2,), dtype=[("v", object), ("load", object)])
for i in range(2):
    runs[i] = (q + i, float(i))
variables = {"t": t, "m": matrix, "n": count, "k": 2.0, "drive": {"q": q, "deep": {"n": count}},
             "runs": runs, "cell": cell, "name": "axis"}
scipy.io.savemat(folder / "plain.mat", variables)
scipy.io.savemat(folder / "compressed.mat", variables, do_compression=True)
scipy.io.savemat(folder / "four.mat", {"t": t, "m": matrix, "n": count, "k": 2.0}, format="4")

record = np.zeros(40, dtype=[("t", "f8"), ("n", "i2"), ("tag", "S3"), ("v", "f4", (2,))])
np.save(folder / "vector.npy", t)
np.save(folder / "record.npy", record)
arrays = {"t": t, "m": matrix, "n": count, "k": np.float64(2.0), "record": record,
          "stamp": np.arange(5).astype("M8[ns]"), "words": np.array(["a", "b"])}
np.savez(folder / "stored.npz", **arrays)
np.savez_compressed(folder / "deflated.npz", **arrays)


def fill(file):
    file["t"] = t
    file.create_dataset("chunked", data=matrix, chunks=(8, 2), compression="gzip", shuffle=True)
    file.create_dataset("lzf", data=q, chunks=(16,), compression="lzf", fletcher32=True)
    file.create_dataset("drive/q", data=q, maxshape=(None,), chunks=(7,)).attrs["unit"] = "rad"
    file["drive/deep/n"] = count
    file["record"] = record
    file["k"] = 2.0
    file["name"] = "axis"
    stored = file.create_group("#refs#").create_dataset("a", data=q.reshape(1, -1))
    stored.attrs["MATLAB_class"] = np.bytes_("double")
    cells = file.create_dataset("cell", data=np.array([[stored.ref]]), dtype=h5py.ref_dtype)
    cells.attrs["MATLAB_class"] = np.bytes_("cell")


with h5py.File(folder / "earliest.h5", "w") as file:
    fill(file)
    file["hard"] = file["drive"]
    file["soft"] = h5py.SoftLink("/t")
with h5py.File(folder / "v114.h5", "w", libver="v114") as file:
    fill(file)
    file["soft"] = h5py.SoftLink("/t")
    file["loop"] = h5py.SoftLink("/")
with h5py.File(folder / "block.h5", "w", userblock_size=512) as file:
    fill(file)
with h5py.File(folder / "refused_loop.h5", "w") as file:
    file["drive/q"] = q
    file["drive/again"] = file["drive"]

table = pa.table({
    "t": t, "n": count, "flag": count > 9, "holes": pa.array([None, 1.0] * 20),
    "stamp": pa.array(np.arange(40) + 10**15, pa.timestamp("us")),
    "words": pa.array(["a", "b"] * 20), "list": pa.array([[1.0]] * 40),
    "pose": pa.StructArray.from_arrays([pa.array(q)], ["x"]),
})
pq.write_table(table, folder / "snappy.parquet", row_group_size=17)
pq.write_table(table, folder / "none.parquet", compression="none", data_page_version="2.0")
for packing in ["zstd", "gzip", "lz4"]:
    pq.write_table(table, folder / f"{packing}.parquet", compression=packing)
flat = table.select(["t", "n"])
pq.write_table(flat, folder / "encoded.parquet", use_dictionary=False, column_encoding={
    "t": "BYTE_STREAM_SPLIT", "n": "DELTA_BINARY_PACKED"})

samples = [{"t": float(a), "yaw": {"q": float(b), "v": [1, 2.5]}, "at": "2026-08-01T12:00:00Z", "name": "x"}
           for a, b in zip(t, q)]
(folder / "records.json").write_text(json.dumps({"kt": 2.0, "entries": samples}))
(folder / "columns.json").write_text(json.dumps({"t": t.tolist(), "m": matrix.tolist(), "runs": [{"q": [1, 2]}, {"q": [3]}]}))
(folder / "lines.json").write_text("\n".join(map(json.dumps, samples)))

for compression in [None, "lz4", "zstd"]:
    options = pa.ipc.IpcWriteOptions(compression=compression)
    for end, new in [("arrow", pa.ipc.new_file), ("arrows", pa.ipc.new_stream)]:
        with new(folder / f"{compression}.{end}", table.schema, options=options) as writer:
            writer.write_table(table, max_chunksize=17)

joint_state = """std_msgs/Header header
string[] name
float64[] position
float64[] effort
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
for compression in CompressionType:
    with open(folder / f"{compression.name}.mcap", "wb") as file:
        writer = Writer(file, chunk_size=700, compression=compression)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", joint_state)
        for i in range(20):
            message = {"header": {"stamp": {"sec": 5, "nanosec": 1000 * i}, "frame_id": ""}, "name": ["a", "b"],
                       "position": [float(q[i]), 1.0], "effort": [2.0, float(i)]}
            writer.write_message("/joint_states", schema, message, log_time=5 * 10**9 + 1000 * i)
        writer.finish()



def rosbag(name, mode, plugin, bare=False):
    """A recording of rosbag2 with a message on pages of its own, and one of a type that is not read."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    state, some = "sensor_msgs/msg/JointState", "std_msgs/msg/Float64MultiArray"
    types = store.types
    writer = Bag(folder / "bag.d", version=8, storage_plugin=plugin)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connections = [writer.add_connection(f"/{i}", kind, typestore=store) for i, kind in enumerate([state, some, "std_msgs/msg/String"])]
        for i in range(20):
            header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](5, 1000 * i), "")
            message = types[state](header, ["a", "b"], np.array([q[i], 1.0]), np.array([]), np.array([2.0, i]))
            writer.write(connections[0], 1000 * i, store.serialize_cdr(message, state))
        layout = types["std_msgs/msg/MultiArrayLayout"]([], 0)
        writer.write(connections[1], 20_000, store.serialize_cdr(types[some](layout, np.arange(300.0)), some))
    (made,) = [path for path in (folder / "bag.d").iterdir() if path.name != "metadata.yaml"]
    shutil.move(made, folder / name)
    shutil.rmtree(folder / "bag.d")
    if bare:
        with sqlite3.connect(folder / name) as file:
            file.execute("DROP TABLE message_definitions")
            file.execute("PRAGMA page_size = 512")
        file.execute("VACUUM")
        file.close()


rosbag("bare.db3", CompressionMode.NONE, StoragePlugin.SQLITE3, bare=True)
rosbag("defined.db3", CompressionMode.NONE, StoragePlugin.SQLITE3)
rosbag("messages.db3", CompressionMode.MESSAGE, StoragePlugin.SQLITE3)
rosbag("whole.db3.zstd", CompressionMode.FILE, StoragePlugin.SQLITE3)
rosbag("whole.mcap.zstd", CompressionMode.FILE, StoragePlugin.MCAP)

with TdmsWriter(folder / "small.tdms") as writer:
    channels = [ChannelObject("g", "t", t, {"unit_string": "s", "wf_increment": 0.5}), ChannelObject("g", "n", count),
                ChannelObject("g", "at", np.arange(4).astype("M8[us]")), ChannelObject("g", "words", ["a", "b"])]
    writer.write_segment([RootObject({"kt": 2.0, "name": "axis"}), *channels])
    writer.write_segment([ChannelObject("g", "t", t[:7])])

for version, compression, columns in [("4.00", 0, False), ("4.10", 1, False), ("4.20", 2, True)]:
    signals = [Signal(samples=q, timestamps=t, name="q", unit="rad"), Signal(samples=count, timestamps=t, name="n", conversion=linear(0.5, 1.0)),
               Signal(samples=q.astype("f2"), timestamps=t, name="h")]
    with MDF(version=version, column_storage=columns) as mdf:
        mdf.append(signals, acq_name="Motion")
        mdf.append([Signal(samples=q[:9], timestamps=t[:9], name="force", unit="N")], acq_name="Drive")
        mdf.save(folder / f"small_{version.replace('.', '')}.mf4", overwrite=True, compression=compression)


def mdf_mixed():
    """Two groups among each other, in a list of plain and packed blocks; bits, and what is marked as invalid."""
    file = Blocks()
    groups = []
    for number in [1, 2]:
        channels = [file.channel("time", 4, 0, 64, kind=2, sync=1), file.channel("bits", 3, 8, 12, 3, flags=2, invalid=0)]
        groups.append(file.group(channels, 20, 10, invalid_bytes=1, number=number, name=f"g{number}"))
    records = [bytes([1 + i % 2]) + struct.pack("<dHB", i / 10, 37 * i, i % 5 == 0) for i in range(40)]
    content = b"".join(records)
    blocks = [file.data(content[:100]), file.packed(content[100:300], 12), file.packed(content[300:])]
    file.write(folder / "mixed.mf4", [file.data_group(groups, file.head_of_list(file.list(blocks)), 1)])


def mdf_apart():
    """Values and what says which are none in blocks of their own."""
    file = Blocks(420)
    group = file.group([file.channel("x", 4, 0, 64, flags=2, invalid=3)], 40, 8, invalid_bytes=1)
    lists = file.column_list([file.data(q[:30].tobytes(), b"DV"), file.packed(q[30:].tobytes(), 8, b"DV")], [0, file.data(bytes(10), b"DI")])
    counted = file.group([file.channel("time", 0, 0, 0, kind=3, sync=1, conversion=file.conversion(1, [0.0, 0.1]))], 40, 0)
    file.write(folder / "apart.mf4", [file.data_group([counted], 0), file.data_group([group], lists)])


mdf_mixed()
mdf_apart()

book = Workbook()
book.active.append(["t [s]", "q", "name"])
for row in zip(t, q):
    book.active.append([float(row[0]), float(row[1]), "x"])
book.create_sheet("more").append([1.5, 2.5])
book.save(folder / "small.xlsx")


def svb():
    """The layout is explained in write_svb.py."""
    def text(value):
        return struct.pack("<i", len(value)) + value.encode()

    main = text("Scope") + struct.pack("<qqi", 132_959_733_843_760_000, 132_959_733_853_760_000, 2)
    sizes, headers, at = [(40, 8, "REAL64"), (40, 2, "INT16")], [], 0
    for write in (False, True):
        length = 8 + len(main) + sum(map(len, headers))
        at, headers = length, []
        for n, size, kind in sizes:
            rest = (text("q") + text("5.23.1.7.1.1") + struct.pack("<iq?", 851, 10_000, True) + text("MAIN.q") + text("")
                    + struct.pack("<qq", 1, 2) + text(kind)
                    + struct.pack("<iiqqqddq", 5, size, n, n * (size + 4), at, 0.0, 1.0, -1))
            headers.append(struct.pack("<q", 8 + len(rest)) + rest)
            at += n * (size + 4)
    rows = [np.rec.fromarrays([np.arange(40, dtype="<u4") * 10_000, values]).tobytes() for values in (q, count)]
    (folder / "scope.svb").write_bytes(struct.pack("<q", length) + main + b"".join(headers) + b"".join(rows))


svb()

# A capture of EtherCAT: three cycles, each frame as it is sent and as it comes back. Without a map there is nothing to read.
capture = struct.pack("<IIIHHqI", 0x0A0D0D0A, 28, 0x1A2B3C4D, 1, 0, -1, 28) + struct.pack("<IIHHII", 1, 20, 1, 0, 0, 20)
for n in range(6):
    datagram = struct.pack("<BBIHHIH", 12, n // 2, 0x10000, 4, 0, n, 3 * (n % 2))
    frame = bytes([255] * 6 + [n % 2 * 2] + [0] * 5) + b"\x88\xa4" + struct.pack("<H", len(datagram) | 0x1000) + datagram
    body = struct.pack("<IIIII", 0, 0, 1000 * n, len(frame), len(frame)) + frame + bytes(-len(frame) % 4)
    capture += struct.pack("<II", 6, len(body) + 12) + body + struct.pack("<I", len(body) + 12)
(folder / "refused.pcapng").write_bytes(capture)
