"""Writes recordings as JSON and JSON lines, with Python's json and with pandas, and beside each one the truth.

Usage: python write_json.py FOLDER

Every file is read again by json or pandas, which must find what was written.
"""

import datetime
import json

import numpy as np
import pandas as pd

from truth import Truth, bits, folder, rng, single, whole


def plain(n):
    """Floats of random bits; JSON has one NaN."""
    values = bits(n)
    values[np.isnan(values)] = np.nan
    return values


def finite(n):
    values = plain(n)
    values[~np.isfinite(values)] = -0.0
    return values


def put(truth, value, **options):
    truth.path.write_text(json.dumps(value, **options))
    again = json.loads(truth.path.read_text())
    assert json.dumps(again, **options) == json.dumps(value, **options)
    truth.write()


def columns(name, **options):
    truth = Truth(name)
    t, q, near = plain(3000), single(500).astype(float), rng.normal(size=500)
    q[np.isnan(q)] = np.nan
    count, flag = whole(np.int32, 70), rng.integers(0, 2, size=40).astype(bool)
    wide = [9007199254740993, -9007199254740993, 18446744073709551615, 2**70]
    value = {"kp": 200, "mass": 0.49, "motor": "xl330", "on": True, "none": None, "empty": [],
             "t": t.tolist(), "drive": {"q": q.tolist(), "deep": {"near": near.tolist()}, "name": "x"},
             "count": count.tolist(), "flag": flag.tolist(), "holes": [1.5, None, None, 2.5, None],
             "words": ["a", "b"], "wide": wide, "m": finite(60).reshape(20, 3).tolist(), "\u00e4\"\\/\n": [1, 2]}
    truth.scalar("kp", 200)
    truth.scalar("mass", 0.49)
    truth.skipped("motor")
    truth.scalar("on", 1)
    truth.skipped("none", "empty")
    truth.column("t", t)
    truth.column("drive.q", q)
    truth.column("drive.deep.near", near)
    truth.skipped("drive.name")
    truth.column("count", count)
    truth.column("flag", flag)
    truth.column("holes", [1.5, np.nan, np.nan, 2.5, np.nan])
    truth.skipped("words")
    truth.column("wide", [float(n) for n in wide])
    truth.matrix("m", np.array(value["m"]))
    truth.column("\u00e4\"\\/\n", [1, 2])
    put(truth, value, **options)


def records(n):
    """Records as a device writes them: nested, with holes, a fixed list, text and a date."""
    t, q, force = finite(n), finite(n), finite(n)
    start = datetime.datetime(2026, 8, 1, 12, tzinfo=datetime.UTC)
    rows, holes, sparse = [], force.copy(), np.full(n, np.nan)
    for i in range(n):
        row = {"t": t[i], "yaw": {"position": q[i], "velocity": [q[i], i], "mode": "hold"},
               "at": (start + datetime.timedelta(microseconds=1001 * i)).isoformat(),
               "quoted": str(i)}
        if i % 3 == 0:
            row["force"] = None
            holes[i] = np.nan
        elif i % 3 == 1:
            row["force"] = force[i]
        else:
            row = {"force": force[i], **row}
        if 5 <= i < 8:
            row["late"] = i / 7
            sparse[i] = i / 7
        rows.append(row)
    return rows, t, q, holes, sparse


def truth_of_records(truth, prefix, n, t, q, holes, sparse):
    truth.column(prefix + "t", t)
    truth.column(prefix + "yaw.position", q)
    truth.matrix(prefix + "yaw.velocity", np.column_stack([q, np.arange(n)]))
    truth.skipped(prefix + "yaw.mode")
    truth.column(prefix + "at", np.arange(n) * 1001 / 1e6)
    truth.column(prefix + "quoted", np.arange(n))
    truth.column(prefix + "force", holes)
    truth.column(prefix + "late", sparse)


def of_records(name, wrap):
    truth = Truth(name)
    rows, *signals = records(300)
    prefix = ""
    if wrap:
        truth.scalar("length", 0.1)
        prefix = "entries."
    truth_of_records(truth, prefix, 300, *signals)
    put(truth, {"length": 0.1, "entries": rows} if wrap else rows, indent=1 if wrap else None)


def lines(name, n, end="\n"):
    truth = Truth(name)
    rows, *signals = records(n)
    truth_of_records(truth, "", n, *signals)
    text = end.join(json.dumps(row) for row in rows)
    truth.path.write_text(text, newline="")
    truth.write()


def lines_of_lists(name):
    truth = Truth(name)
    m = finite(400).reshape(100, 4)
    truth.path.write_text("".join(json.dumps(row) + "\n" for row in m.tolist()))
    truth.matrix("", m)
    truth.write()


def runs(name):
    """Runs of different lengths, and signals in rows."""
    truth = Truth(name)
    long = [finite(50), finite(70)]
    value = {"runs": [{"t": long[0].tolist(), "load": 1.5, "deep": {"q": [1, 2]}},
                      {"t": long[1].tolist(), "load": 2.5, "deep": {"q": [3, 4, 5]}}],
             "rows": [long[0].tolist(), long[0][::-1].tolist()], "cube": [[[1, 2], [3, 4]]]}
    truth.column("runs{1}.t", long[0])
    truth.column("runs{2}.t", long[1])
    truth.column("runs.load", [1.5, 2.5])
    truth.column("runs{1}.deep.q", [1, 2])
    truth.column("runs{2}.deep.q", [3, 4, 5])
    truth.column("rows{1}", long[0])
    truth.column("rows{2}", long[0][::-1])
    truth.skipped("cube")
    put(truth, value)


def holes_in_lists(name):
    truth = Truth(name)
    value = [{"q": [1.0, 2.0]}, {}, {"q": []}, {"q": None}, {"q": [None, 3.0]}, {"q": [4.0, None]}, {}]
    nan = np.nan
    truth.matrix("q", np.array([[1, 2], [nan, nan], [nan, nan], [nan, nan], [nan, 3], [4, nan], [nan, nan]]))
    put(truth, value)


def pandas(name, **options):
    truth = Truth(name)
    frame = pd.DataFrame({"t": np.linspace(0, 1, 300).round(7), "n": whole(np.int16, 300),
                          "phase": ["a", "b", "c"] * 100})
    frame.to_json(truth.path, double_precision=15, **options)
    again = pd.read_json(truth.path, precise_float=True, **options)
    assert (again["t"] == frame["t"]).all() and (again["n"] == frame["n"]).all()
    truth.column("t", frame["t"])
    truth.column("n", frame["n"])
    truth.skipped("phase")
    truth.write()


columns("columns.json")
columns("indented.json", indent=2, ensure_ascii=False)
of_records("records.json", False)
of_records("wrapped.json", True)
lines("lines.jsonl", 300)
lines("lines_crlf.jsonl", 300, "\r\n")
lines_of_lists("lists.jsonl")
runs("runs.json")
holes_in_lists("holes.json")
pandas("pandas.json")
pandas("pandas_records.json", orient="records")
pandas("pandas_lines.json", orient="records", lines=True)
pandas("pandas_list.json", orient="columns")
