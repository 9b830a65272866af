"""Writes small texts in every dialect that is read, to be damaged by the tests: `python seeds.py FOLDER`."""

import pathlib
import sys

folder = pathlib.Path(sys.argv[1])
rows = [(0.001 * n, ((n * n) % 17 - 8) / 4, ((5 * n) % 11 - 5) / 8) for n in range(30)]


def table(name, head, separator=",", decimal=".", end="\n", encoding="utf-8", tail=""):
    number = lambda x: f"{x:.4f}".replace(".", decimal)
    lines = [separator.join(map(number, row)) for row in rows]
    (folder / name).write_bytes((head + end.join(lines) + end + tail).encode(encoding))


table("comma.txt", "time [s],position [mm],force [N]\n")
table("german.txt", "Achse 3\nZeit [s];Istposition [mm];Moment [Nm]\n", ";", ",")
table("tab.txt", "# a comment\n% another\nt\tq\ttau\ns\trad\tN*m\n", "\t", tail="EOF\n")
table("blank.txt", "", "   ")
table("wide.txt", "t;position [mm];Kraft [N]\r\n", ";", end="\r\n", encoding="utf-16")
table("mac.txt", "t|x|F\r", "|", end="\r")
table("latin.txt", "Zeit [s];Länge [µm];Kraft [N]\n", ";", ",", encoding="latin-1")
table("quoted.txt", '"time, of ""all"" [s]","x\n[mm]","F [N]"\n')
for name, stamp in (("dates.txt", "2026-11-26T01:02:{:06.3f}Z"), ("times.txt", "23:59:{:06.3f}")):
    lines = [f"{stamp.format(59.99 - 0.01 * (30 - n))},{x},{f},on" for n, (_, x, f) in enumerate(rows)]
    (folder / name).write_text("time,position [mm],force [N],state\n" + "\n".join(lines) + "\n")
scope = "Name\tlog\nFile\tc:\\x\nStartTime of export\t132959733843760000\t\n\nName\tx\tName\ty\nSampleTime[ms]\t1\tSampleTime[ms]\t2\n\n"
lines = [f"{n}\t{x}\t{2 * n}\t{f}" for n, (_, x, f) in enumerate(rows)]
(folder / "scope.txt").write_text(scope + "\n".join(lines) + "\n")
lines = ["overrun\n" * (n % 7 == 0) + f"{n + 3 * (n // 7)} {x:.3f} {f:.3f} " for n, (_, x, f) in enumerate(rows)]
(folder / "halsampler.txt").write_text("\n".join(lines) + "\n")
listed = "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n    - log\n    - \"b.db3\"\n"
(folder / "metadata.txt").write_text(listed + "  compression_format: \"\"\n  files:\n    - path: log\n")
empty = [f"{t},{x if n % 5 else ''},{f if n % 3 else 'NaN'},{'TRUE' if n % 2 else 'FALSE'}" for n, (t, x, f) in enumerate(rows)]
(folder / "holes.txt").write_text("t [s],x [mm],F [N],enabled\n" + "\n".join(empty) + "\n")
