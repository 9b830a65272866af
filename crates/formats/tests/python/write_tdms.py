"""Writes TDMS files with nptdms, and by hand what it does not write, and beside each one the truth.

Usage: python write_tdms.py FOLDER

The truth is what nptdms reads from the file.
"""

import struct

import numpy as np
from nptdms import ChannelObject, GroupObject, RootObject, TdmsFile, TdmsWriter

from truth import INTEGERS, Truth, bits, folder, rng, single, whole


def truth_of(path, truth, scalars=(), left_out=()):
    with TdmsFile.open(path, raw_timestamps=True) as file:
        for group in file.groups():
            for channel in group.channels():
                name = f"{group.name}.{channel.name}"
                values = channel[:]
                if name in left_out:
                    truth.skipped(name)
                elif channel.dtype == np.dtype("V16") or "second_fractions" in (values.dtype.names or ()):
                    ticks = [int(s) * 2**64 + int(f) for s, f in zip(values["seconds"], values["second_fractions"])]
                    truth.column(name, [(tick - ticks[0]) / 2**64 for tick in ticks])
                else:
                    truth.column(name, values)
    for name, value in scalars:
        truth.scalar(name, value)
    truth.write()


def written(name, version):
    truth = Truth(name)
    wave = {"unit_string": "N m", "wf_increment": 0.001, "wf_start_offset": 0.0}
    stamps = np.datetime64("2026-08-01T12:00:00.000001", "us") + np.cumsum(rng.integers(1, 2000, size=400)).astype("m8[us]")
    with TdmsWriter(truth.path, version=version) as writer:
        root = RootObject({"rated": 2.5, "author": "x", "count": 7})
        group = GroupObject("Axis", {"kt": 0.25, "note": "y"})
        channels = [ChannelObject("Axis", "torque", bits(400), wave), ChannelObject("Axis", "it's q", single(300), {"wf_increment": 0.001}),
                    ChannelObject("Axis", "flag", rng.integers(0, 2, size=20).astype(bool)),
                    ChannelObject("Axis", "stamp", stamps), ChannelObject("Axis", "words", ["a", "bc", "\u00e4"]),
                    ChannelObject("Axis", "z", np.array([1 + 2j, 3])), ChannelObject("Axis", "raw", np.arange(5, dtype=np.int16),
                                  {"NI_Number_Of_Scales": np.int32(1), "NI_Scale[0]_Scale_Type": "Linear",
                                   "NI_Scale[0]_Linear_Slope": 2.0, "NI_Scale[0]_Linear_Y_Intercept": 1.0})]
        channels += [ChannelObject("Integers", np.dtype(d).name, whole(d, 33)) for d in INTEGERS]
        writer.write_segment([root, group, *channels])
        # Segments that are like the one before, one that is not, one of metadata alone.
        for n in [100, 100, 70]:
            writer.write_segment([ChannelObject("Axis", "torque", bits(n)), ChannelObject("Axis", "words", ["x"] * 2)])
        writer.write_segment([RootObject({"rated": 3.5})])
        writer.write_segment([ChannelObject("Other", "late", bits(50)), ChannelObject("Axis", "flag", np.ones(3, dtype=bool))])
    truth_of(truth.path, truth, [("Axis.kt", 0.25), ("count", 7), ("rated", 3.5)], ["Axis.words", "Axis.z", "Axis.raw"])


def by_hand(name, order, interleaved):
    """Two segments, the second of data alone, each of several chunks."""
    truth = Truth(name)

    def text(value):
        return struct.pack(order + "I", len(value)) + value.encode()

    def channel(path, code, count):
        return text(path) + struct.pack(order + "IIIQ", 20, code, 1, count) + struct.pack(order + "I", 0)

    n = 40
    metadata = struct.pack(order + "I", 3) + channel("/'g'/'a'", 10, n) + channel("/'g'/'b'", 2, n) + channel("/'g'/'t'", 0x44, n)
    records = np.zeros(3 * n, dtype=[("a", order + "f8"), ("b", order + "i2"), ("t", "V16")])
    records["a"], records["b"] = bits(3 * n), whole(np.int16, 3 * n)
    for i in range(3 * n):
        fraction, seconds = int(rng.integers(0, 2**63)), 3_868_000_000 + i
        pair = struct.pack("<Qq", fraction, seconds) if order == "<" else struct.pack(">qQ", seconds, fraction)
        records["t"][i] = np.void(pair)
    flags = 1 << 3 | (1 << 5 if interleaved else 0) | (1 << 6 if order == ">" else 0)

    def data(rows):
        if interleaved:
            return rows.tobytes()
        return b"".join(rows[at : at + n][key].tobytes() for at in range(0, len(rows), n) for key in "abt")

    def segment(flags, metadata, content):
        lead = b"TDSm" + struct.pack("<I", flags) + struct.pack(order + "IQQ", 4713, len(metadata) + len(content), len(metadata))
        return lead + metadata + content

    truth.path.write_bytes(segment(flags | 1 << 1 | 1 << 2, metadata, data(records[: 2 * n])) + segment(flags, b"", data(records[2 * n :])))
    truth_of(truth.path, truth)


written("version_4712.tdms", 4712)
written("version_4713.tdms", 4713)
for order, end in [("<", "little"), (">", "big")]:
    for interleaved in [False, True]:
        by_hand(f"{end}_{interleaved}.tdms", order, interleaved)
