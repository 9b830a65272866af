"""Sums of the measured bags as rosbags reads them, which the test of the recordings has: python sum_db3.py RECORDINGS

Of each signal of each joint, in the order of the names: the bits of all samples, rotated by their index, added modulo 2^64.
"""

import pathlib
import sys

from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader
from rosbags.typesys import Stores, get_typestore

import numpy as np

store = get_typestore(Stores.ROS2_HUMBLE)


def total(values):
    words = np.asarray(values, dtype="<f8").view("<u8")
    turn = np.arange(words.size, dtype=np.uint64) % 64
    turned = words << turn | np.where(turn > 0, words >> (64 - turn) % 64, 0).astype("<u8")
    return int(turned.sum(dtype="<u8"))


for name in ["ur10", "panda"]:
    reader = Sqlite3Reader(pathlib.Path(sys.argv[1]) / f"robots/ur10_panda/{name}.db3")
    reader.open()
    rows = [(time, store.deserialize_cdr(data, "sensor_msgs/msg/JointState")) for _, time, data in reader.messages(reader.connections)]
    stamps = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec - rows[0][0] for _, m in rows]
    print(name, len(rows), rows[0][1].name, [len(getattr(rows[0][1], key)) for key in ("position", "velocity", "effort")])
    print(f"0x{total(np.array(stamps) / 1e9):016x}")
    for at in range(len(rows[0][1].name)):
        sums = [total([getattr(m, key)[at] for _, m in rows]) for key in ("position", "velocity", "effort") if len(getattr(rows[0][1], key))]
        print(", ".join(f"0x{s:016x}" for s in sums))
