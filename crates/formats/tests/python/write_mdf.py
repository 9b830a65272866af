"""Writes MDF 4 files with asammdf, and by hand what it does not write, and beside each one the truth.

Usage: python write_mdf.py FOLDER

The truth is what asammdf reads from the file; linear and rational conversions are computed here from what it reads unconverted,
in 64-bit floats, since asammdf converts floats of 16 and 32 bits in their own width; of `apart` and `left_out` it is what was written.
"""

import struct

import numpy as np
from asammdf import MDF, Signal
from asammdf.blocks.v4_blocks import ChannelConversion

from mdf import Blocks, converted, linear
from truth import INTEGERS, Truth, bits, folder, half, rng, single, whole


def read(mdf, group, index):
    """A channel as 64-bit floats, NaN where it is marked as invalid."""
    if mdf.groups[group].channels[index].channel_type == 3:
        # Of a time that is a count, `get` gives what has been converted already.
        return mdf.get_master(group)
    signal = mdf.get(group=group, index=index, raw=True, ignore_invalidation_bits=True)
    with np.errstate(all="ignore"):
        values = converted(signal.conversion, signal.samples.astype("<f8"))
    if signal.invalidation_bits is not None and len(values):
        values = np.where(np.asarray(signal.invalidation_bits), np.nan, values)
    return values


def truth_of(truth, groups, left_out=()):
    """`groups` are what the groups of the file are called where names repeat, each group of asammdf one of them."""
    with MDF(truth.path, process_bus_logging=False) as mdf:
        names = [ch.name for group in mdf.groups for ch in group.channels]
        for number, group in enumerate(mdf.groups):
            for index, ch in enumerate(group.channels):
                name = ch.name if names.count(ch.name) == 1 else f"{groups[number]}.{ch.name}"
                if name in left_out:
                    truth.skipped(name)
                else:
                    truth.column(name, read(mdf, number, index))
    truth.write()


def written(version, compression, columns=False):
    """Two groups of their own time, a third of one channel, every kind of number, and what is left out."""
    truth = Truth(f"version_{version.replace('.', '')}_{compression}{'_columns' if columns else ''}.mf4")
    n = 2500
    t = np.cumsum(rng.uniform(1e-4, 1e-3, size=n))
    numbers = [("q", bits(n)), ("f", single(n)), ("h", half(n)), ("big", bits(n).astype(">f8")),
               *[(np.dtype(d).name, whole(d, n)) for d in INTEGERS], ("big_int32", whole(np.int32, n).astype(">i4"))]
    motion = [Signal(samples=values, timestamps=t, name=name, unit="mm" if name == "q" else "") for name, values in numbers]
    motion.append(Signal(samples=whole(np.int16, n), timestamps=t, name="torque", unit="N m", conversion=linear(0.25, -3.5)))
    motion.append(Signal(samples=whole(np.uint64, n), timestamps=t, name="scaled", conversion=linear(1e-9, 0.0)))
    motion.append(Signal(samples=single(n), timestamps=t, name="single_scaled", conversion=linear(0.1, 7.0)))
    rational = {"P1": 1e-3, "P2": 2.0, "P3": -1.0, "P4": 0.0, "P5": 1.0, "P6": 40000.0}
    motion.append(Signal(samples=whole(np.int16, n), timestamps=t, name="quotient",
                         conversion=ChannelConversion(conversion_type=2, **rational)))
    motion.append(Signal(samples=whole(np.int16, n), timestamps=t, name="holes", invalidation_bits=rng.integers(0, 2, size=n).astype(bool)))
    motion.append(Signal(samples=bits(n), timestamps=t, name="none", invalidation_bits=np.arange(n) > 7))
    motion.append(Signal(samples=np.array([b"ab", b"c"] * (n // 2)), timestamps=t, name="words", encoding="utf-8"))
    motion.append(Signal(samples=rng.integers(0, 3, size=n).astype("u1"), timestamps=t, name="state",
                         conversion=ChannelConversion(conversion_type=7, ref_param_nr=3, val_0=0, val_1=1, text_0=b"off", text_1=b"on", default_addr=b"?")))
    motion.append(Signal(samples=rng.integers(0, 3, size=n).astype("u1"), timestamps=t, name="table", conversion=ChannelConversion(
        conversion_type=4, val_param_nr=4, **{"raw_0": 0.0, "phys_0": 1.0, "raw_1": 2.0, "phys_1": 5.0})))
    motion.append(Signal(samples=np.rec.fromarrays([np.zeros((n, 3))], dtype=[("array", "(3,)<f8")]), timestamps=t, name="array"))
    slow = np.arange(60) / 10
    drive = [Signal(samples=bits(60), timestamps=slow, name="q", unit="mm"), Signal(samples=single(60), timestamps=slow, name="current", unit="A")]
    if columns:
        # What asammdf cannot write this way.
        motion = [s for s in motion if s.name not in ("holes", "none", "words", "state", "array")]
    with MDF(version=version, column_storage=columns) as mdf:
        mdf.append(motion, acq_name="Motion")
        mdf.append(drive, acq_name="Drive")
        mdf.append([Signal(samples=bits(60), timestamps=slow, name="temperature", unit="degC")])
        mdf.save(truth.path, overwrite=True, compression=compression)
    with MDF(truth.path, process_bus_logging=False) as mdf:
        labels = []
        for number, group in enumerate(mdf.groups):
            base = mdf.virtual_groups_map[number]
            name = mdf.groups[base].channel_group.acq_name
            labels.append(name or f"group{base + 1}")
    truth_of(truth, labels, {"words", "state", "table", "array"})


def odd_bits(number):
    """Integers among other bits, in both byte orders; time as a count of records; records in a list of blocks plain and packed."""
    truth = Truth(f"odd_bits_{number}.mf4")
    n, size = 600, 40
    file = Blocks()
    channels = [file.channel("t", 0, 0, 0, kind=3, sync=1, conversion=file.conversion(1, [0.5, 0.001]))]
    at = 0
    for count, bit in [(1, 3), (3, 5), (7, 0), (12, 4), (12, 0), (20, 2), (31, 1), (33, 0), (40, 0), (53, 3), (57, 7)]:
        for data_type in [0, 1, 2, 3]:
            # Which bytes they share does not matter: all bits are random.
            channels.append(file.channel(f"{['u', 'U', 'i', 'I'][data_type]}{count}", data_type, at % 31, count, bit,
                                         flags=2 if at % 3 == 0 else 0, invalid=at % 16))
            at += 7
    channels.append(file.channel("angle", 2, 3, 16, unit="deg", conversion=file.conversion(1, [-7.0, 0.1])))
    group = file.group(channels, n, size, invalid_bytes=2)
    content = rng.integers(0, 256, size=n * (size + 2), dtype=np.uint8).tobytes()
    cuts = [0, 100, 9000, 9001, len(content)]
    parts = [content[a:b] for a, b in zip(cuts, cuts[1:])]
    blocks = [file.data(parts[0]), file.packed(parts[1], size + 2), file.packed(parts[2]), file.packed(parts[3], 7)]
    first = file.list(blocks[:3], after=file.list(blocks[3:]))
    file.write(truth.path, [file.data_group([group], file.head_of_list(first) if number else first)])
    truth_of(truth, ["group1"])


def mixed(number_bytes):
    """Records of three groups among each other, and of one that has the texts of a channel."""
    truth = Truth(f"mixed_{number_bytes}.mf4")
    file = Blocks()
    counts, numbers = [300, 40, 120], [3, 250, 7]
    groups = []
    for count, number in zip(counts, numbers):
        channels = [file.channel("time", 4, 0, 64, kind=2, sync=1), file.channel(f"q{number}", 4, 8, 32, unit="mm"),
                    file.channel("word", 0, 12, 16, flags=2, invalid=1)]
        groups.append(file.group(channels, count, 14, invalid_bytes=1, number=number, name="Axis" if number == 7 else ""))
    groups.append(file.group([], 30, 0, number=9, flags=1))
    order = np.repeat([0, 1, 2, 3], [*counts, 30])
    rng.shuffle(order)
    content = b""
    for group in order:
        content += int([*numbers, 9][group]).to_bytes(number_bytes, "little")
        if group == 3:
            content += struct.pack("<I", 5) + b"hello"
        else:
            content += struct.pack("<d", rng.random()) + rng.integers(0, 256, size=7, dtype=np.uint8).tobytes()
    file.write(truth.path, [file.data_group(groups, file.packed(content), number_bytes)])
    truth_of(truth, ["group1", "group2", "Axis"])


def apart(deflated):
    """Values and what says which are none in blocks of their own; the time in another group. asammdf does not read it."""
    truth = Truth(f"apart_{int(deflated)}.mf4")
    file = Blocks(420)
    n, cut = 500, 300
    t, q, w = np.arange(n) / 1000, bits(n), whole(np.int16, n)
    marks = rng.integers(0, 2, size=n, dtype=np.uint8)
    store = (lambda content, mark: file.packed(content, 2 if mark == b"DV" else 0, mark)) if deflated else file.data
    master = file.group([file.channel("time", 4, 0, 64, kind=2, sync=1)], n, 8, name="Fast")
    values = np.rec.fromarrays([q, w], dtype="<f8,<i2")
    own = file.group([file.channel("q", 4, 0, 64, flags=2, invalid=4), file.channel("w", 2, 8, 16)], n, 10, invalid_bytes=1, flags=8, base=master)
    blocks = [store(values[:cut].tobytes(), b"DV"), store(values[cut:].tobytes(), b"DV")]
    invalid = store((marks[cut:] << 4).tobytes(), b"DI")
    single = file.group([file.channel("time", 4, 0, 64)], n, 8, flags=8, base=master)
    file.write(truth.path, [file.data_group([master], store(t.tobytes(), b"DV")),
                            file.data_group([own], file.column_list(blocks, [0, invalid])),
                            file.data_group([single], file.column_list([store(q.tobytes(), b"DV")]))])
    truth.column("Fast.time", t)
    truth.column("q", np.where((marks == 1) & (np.arange(n) >= cut), np.nan, q))
    truth.column("w", w)
    truth.column("Fast.time", q)
    truth.write()


def left_out():
    """What is no column: structures, arrays, messages of a bus, events, values without any that is valid, groups without records."""
    truth = Truth("left_out.mf4")
    file = Blocks()
    member = file.channel("member", 0, 0, 8)
    axis = file.block(b"CA", [0], bytes(16))
    channels = [file.channel("q", 0, 0, 8), file.channel("pair", 10, 0, 16, composition=member), file.channel("rows", 0, 0, 8, composition=axis),
                file.channel("never", 0, 0, 8, flags=1), file.channel("half", 4, 0, 24), file.channel("picture", 0, 0, 8, kind=4),
                file.channel("formula", 0, 0, 8, conversion=file.conversion(3, [])), file.channel("z", 15, 0, 64)]
    groups = [file.group(channels, 5, 3, name="Values"), file.group([file.channel("id", 0, 0, 8)], 5, 1, flags=2, name="CAN"),
              file.group([file.channel("stop", 0, 0, 8)], 5, 1, flags=16), file.group([file.channel("late", 0, 0, 8)], 0, 1)]
    file.write(truth.path, [file.data_group([group], file.data(bytes(range(15)))) for group in groups])
    truth.column("q", np.arange(5) * 3)
    truth.skipped("pair", "rows", "never", "half", "picture", "formula", "z", "CAN", "group3", "late")
    truth.write()


odd_bits(0)
odd_bits(1)
for number_bytes in [1, 2, 4, 8]:
    mixed(number_bytes)
apart(False)
apart(True)
left_out()
# With columns in groups of their own or without: asammdf 8.4.1 fails at some files of 4.20 without.
for compression in [0, 1, 2]:
    for version in ["4.00", "4.10", "4.11"]:
        written(version, compression)
    written("4.20", compression, columns=True)
