"""Writes databases that are no recordings of rosbag2, or damaged ones: `python write_odd_db3.py FOLDER`."""

import pathlib
import shutil
import sqlite3
import struct
import sys

folder = pathlib.Path(sys.argv[1])
ROWS = 20


def bag(name, kind="std_msgs/msg/Float64", content=struct.pack("<4sd", b"\0\1\0\0", 1.5), rows=ROWS, before=(), close=True):
    file = sqlite3.connect(folder / name)
    for line in before:
        file.execute(line)
    file.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT NULL)")
    file.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    file.execute("INSERT INTO topics VALUES (1, '/x', ?, 'cdr')", (kind,))
    for i in range(rows):
        file.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (1, ?, ?)", (10**9 * i, content))
    file.commit()
    if close:
        file.close()
    return file


# The recorder is still open: all of it is in the log beside the file.
held = bag("open.db3", before=["PRAGMA journal_mode=WAL"], close=False)
for end in ("", "-wal"):
    shutil.copy(folder / f"open.db3{end}", folder / f"wal.db3{end}")
held.close()
(folder / "open.db3").unlink()
bag("closed.db3", before=["PRAGMA journal_mode=WAL"])
bag("hot.db3")
(folder / "hot.db3-journal").write_bytes(bytes.fromhex("d9d505f920a163d7") + bytes(504))
other = sqlite3.connect(folder / "other.db3")
other.execute("CREATE TABLE samples(t REAL, x REAL)")
other.execute("CREATE TABLE axes(name TEXT)")
other.close()
empty = sqlite3.connect(folder / "empty.db3")
empty.execute("PRAGMA user_version = 3")
empty.close()
bag("utf16.db3", before=["PRAGMA encoding = 'UTF-16le'"])
bag("cut.db3", rows=200, before=["PRAGMA page_size = 512"])
whole = (folder / "cut.db3").read_bytes()
(folder / "cut.db3").write_bytes(whole[: len(whole) // 2])
# Two cells of the first page of messages lead to the same page.
root = 3
twice, at = bytearray(whole), 512 * (root - 1)
assert twice[at] == 5
first, second = struct.unpack(">HH", twice[at + 12 : at + 16])
twice[at + second : at + second + 4] = twice[at + first : at + first + 4]
(folder / "twice.db3").write_bytes(twice)
bag("unknown.db3", kind="a_msgs/msg/Own")
bag("short.db3", kind="sensor_msgs/msg/JointState")
bag("large.db3", kind="std_msgs/msg/String", content=b"\0\1\0\0" + struct.pack("<I", 200_000) + bytes(200_000), rows=1)
for name, listed in (("lost.d", "nowhere.db3"), ("other.d", "note.txt")):
    (folder / name).mkdir()
    (folder / name / "note.txt").write_text("no recording\n")
    text = f"rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n    - {listed}\n"
    (folder / name / "metadata.yaml").write_text(text)
