"""Writes SVB files of TwinCAT Scope by the layout that Beckhoff publishes, and beside each one the truth.

Usage: python write_svb.py FOLDER

Layout: https://infosys.beckhoff.com/content/1033/te13xx_tc3_scopeview/6193066251.html, "Format description for developers".
No program but TwinCAT Scope writes such files, so the truth is what was put in.
"""

import struct

import numpy as np

from truth import Truth, bits, rng, single, whole

TYPES = {
    "REAL64": ("<f8", 5, bits), "REAL32": ("<f4", 4, single),
    **{f"{sign}INT{8 * n}": (f"<{letter}{n}", code, None)
       for sign, letter, codes in [("", "i", (16, 2, 3, 20)), ("U", "u", (17, 18, 19, 21))]
       for n, code in zip((1, 2, 4, 8), codes)},
    "BITARR16": ("<u2", 18, None), "BIT": ("u1", 33, None),
}
START = 132_959_733_843_760_000


def text(value):
    value = value.encode()
    return struct.pack("<i", len(value)) + value


def values_of(kind, n):
    dtype, _, make = TYPES[kind]
    if kind == "BIT":
        return rng.integers(0, 2, size=n).astype("u1")
    return make(n).astype(dtype) if make else whole(np.dtype(dtype).newbyteorder("="), n).astype(dtype)


def written(name, channels, old=False, more=b"", head_counts_all=True):
    """Channels: (name, kind, values, stamps in 100 ns or None, sample time in 100 ns, offset, scale)."""
    truth = Truth(name)

    def headers(first):
        out, at = [], first
        for title, kind, values, stamps, period, offset, scale in channels:
            size = values.dtype.itemsize
            data = len(values) * (size + (0 if stamps is None else 4))
            code = TYPES[kind][1] if kind in TYPES else 30
            rest = (text(title) + text("5.23.1.7.1.1") + struct.pack("<iq?", 851, period, True) + text(f"MAIN.{title}")
                    + text("a comment; \u00e4") + struct.pack("<qq", 16448, 608) + text(("ADST_" if old else "") + kind)
                    + struct.pack("<iiqqqddq", code, size, len(values), data, at, offset, scale, -1) + more)
            out.append(struct.pack("<q", 8 + len(rest)) + rest)
            at += data
        return b"".join(out)

    main = text("YT Scope Project \u00e4") + struct.pack("<qqi", START, START + 9_990_000, len(channels))
    length = 8 + len(main) + len(headers(0))
    file = struct.pack("<q", length if head_counts_all else 8 + len(main)) + main + headers(length)
    for _, _, values, stamps, *_ in channels:
        if stamps is None:
            file += values.tobytes()
            continue
        rows = np.zeros(len(values), dtype=[("t", "<u4"), ("v", values.dtype)])
        rows["t"], rows["v"] = np.asarray(stamps, dtype=np.uint64) % 2**32, values
        file += rows.tobytes()
    truth.path.write_bytes(file)
    return truth


def seconds(stamps):
    return np.asarray(stamps, dtype=np.float64) / 1e7


# Every type, on one clock.
clock = np.arange(5000) * 5000
every = [(f"ch {kind}", kind, values_of(kind, 5000), clock, 5000, 0.0, 1.0) for kind in TYPES]
for old, more, all_ in [(False, b"", True), (True, b"", True), (False, b"later fields", False)]:
    truth = written(f"types_{old}_{all_}.svb", every, old, more, all_)
    truth.column("time", seconds(clock))
    for title, _, values, *_ in every:
        truth.column(title, values)
    truth.write()

# Two clocks, one of which overflows its 32 bits twice; a text, a channel without samples, an offset and a scale.
fast, slow = 10_000 * np.arange(3000) + 7, 20_000_000 * np.arange(700)
channels = [
    ("ActPos", "REAL64", values_of("REAL64", 3000), fast, 10_000, 0.0, 1.0),
    ("ActPos (1)", "REAL64", values_of("REAL64", 3000), fast, 10_000, 0.0, 1.0),
    ("Note", "STRING", np.array([b"abc"] * 5), np.arange(5), 10_000, 0.0, 1.0),
    ("ActTorque", "INT16", values_of("INT16", 700), slow, 20_000_000, 2.0, -1.0),
    ("Never", "REAL32", values_of("REAL32", 0), np.arange(0), 10_000, 0.0, 1.0),
]
truth = written("clocks.svb", channels)
truth.column("time of ActPos", seconds(fast))
truth.column("ActPos", channels[0][2])
truth.column("ActPos (1)", channels[1][2])
truth.column("time of ActTorque", seconds(slow))
truth.column("ActTorque", channels[3][2])
for title, period in [("ActPos", 1.0), ("ActPos (1)", 1.0), ("ActTorque", 2000.0)]:
    truth.scalar(f"SampleTime[ms] of {title}", period)
truth.skipped("Note", "Never")
truth.write()

# Exported without time stamps.
channels = [(title, "REAL32", values_of("REAL32", 400), None, 2500, 0.0, 1.0) for title in ["q", "tau"]]
truth = written("no_times.svb", channels)
for title, _, values, *_ in channels:
    truth.column(title, values)
truth.write()
