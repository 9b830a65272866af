"""Writes recordings of rosbag2, in SQLite and packed ones in MCAP, and beside each one the truth.

Usage: python write_db3.py FOLDER

Messages are packed by rosbags, from its own types; the truth is what rosbags unpacks again. Bags with definitions are written by
its writer, those without, as rosbag2 writes them up to Humble, by sqlite3.
"""

import pathlib
import shutil
import sqlite3

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from truth import Truth, bits, folder, rng, single, whole

START = 1_785_585_600_123_456_789
store = get_typestore(Stores.ROS2_HUMBLE)
POINT = "trajectory_msgs/JointTrajectoryPoint"
OTHERS = {
    "a_msgs/msg/Drive": "std_msgs/Header header\nuint8 state\nint16[3] counts\nstring<=10 mode\nfloat64[<=4] some\nfloat64 last\n",
    "control_msgs/msg/InterfaceValue": "string[] interface_names\nfloat64[] values\n",
    "control_msgs/msg/DynamicJointState": "std_msgs/Header header\nstring[] joint_names\nInterfaceValue[] interface_values\n",
    # As it was up to Galactic.
    "control_msgs/msg/JointTrajectoryControllerState":
        f"std_msgs/Header header\nstring[] joint_names\n{POINT} desired\n{POINT} actual\n{POINT} error\n",
}
for name, text in OTHERS.items():
    store.register(get_types_from_msg(text, name))
TIME, DURATION = "builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"
BYTES = {"byte", "char", "octet", "uint8"}


def make(kind, count):
    """A message of random content whose lists have so many elements."""
    def numbers(base, n):
        if base in ("float64", "float32"):
            return bits(n + 13)[13:] if base == "float64" else single(n)
        if base in BYTES or base == "bool":
            return rng.integers(2 if base == "bool" else 128, size=n, dtype="uint8")
        return whole(np.dtype(base).type, n + 2)[2:]

    def value(what, name):
        sort, detail = what
        if sort == Nodetype.NAME:
            return make(detail, count)
        if sort == Nodetype.BASE:
            return f"text {rng.integers(9)}" if detail[0] == "string" else numbers(detail[0], 1)[0].item()
        (inner, of), length = detail
        length = length if sort == Nodetype.ARRAY else count
        if inner == Nodetype.BASE and of[0] == "string":
            return [f"{name}_{i}" for i in range(length)]
        if inner == Nodetype.BASE:
            return numbers(of[0], length)
        return [value((inner, of), name) for _ in range(length)]

    if kind == TIME:
        return store.types[TIME](int(START // 10**9 + rng.integers(100)), int(rng.integers(10**9)))
    if kind == DURATION:
        return store.types[DURATION](int(rng.integers(-5, 5)), int(rng.integers(10**9)))
    return store.types[kind](**{name: value(what, name) for name, what in store.fielddefs[kind][1]})


def flatten(truth, path, kind, values, depth, origin):
    """What a reader makes of these values of a type, each a list of lists where `depth` says so."""
    def put(numbers):
        flat = np.array([np.ravel(row) for row in numbers]).astype(float)
        if depth > 1:
            truth.skipped(path)
        elif depth == 0 or flat.shape[1] == 1:
            truth.column(path, flat.ravel())
        else:
            truth.matrix(path, flat)

    def each(of, value, level):
        return of(value) if level == 0 else [each(of, inner, level - 1) for inner in value]

    if kind[0] == Nodetype.BASE:
        return truth.skipped(path) if kind[1][0] == "string" else put(values)
    if kind[0] != Nodetype.NAME:
        (inner, of), _ = kind[1]
        if inner == Nodetype.BASE and of[0] in BYTES:
            return truth.skipped(path)
        return flatten(truth, path, (inner, of), values, depth + 1, origin)
    if kind[1] == TIME:
        return put([each(lambda t: (t.sec * 10**9 + t.nanosec - origin) / 1e9, v, depth) for v in values])
    if kind[1] == DURATION:
        return put([each(lambda t: (t.sec * 10**9 + t.nanosec) / 1e9, v, depth) for v in values])
    names = []
    for name, what in store.fielddefs[kind[1]][1]:
        if name == "structure_needs_at_least_one_member":
            continue
        own = [each(lambda m: getattr(m, name), v, depth) for v in values]
        inner = what[1][0] if what[0] in (Nodetype.SEQUENCE, Nodetype.ARRAY) else (None, None)
        if name in ("name", "names", "joint_names") and what[0] == Nodetype.SEQUENCE and inner[1][0] == "string":
            names = own[0] if depth == 0 else []
        elif names and inner[0] == Nodetype.BASE and inner[1][0] not in BYTES:
            for i, joint in enumerate(names):
                later.append((f"{path}.{joint}.{name}", inner, [row[i] for row in own], joint))
        else:
            flatten(truth, f"{path}.{name}", what, own, depth, origin)
    # Columns of a joint stand together.
    for joint in names:
        for name, what, own, _ in [entry for entry in later if entry[3] == joint]:
            flatten(truth, name, what, own, depth, origin)
    later.clear()


later = []


def rows(topics, n, count=2):
    """So many messages of each topic, in turn: topic, type, time, bytes."""
    out, now = [], START
    for i in range(n):
        for topic, kind in topics:
            now += int(rng.integers(1, 2_000_000))
            data = bytes(store.serialize_cdr(make(kind, count), kind))
            out.append((topic, kind, now, data))
    return out


def describe(truth, messages):
    origin = messages[0][2]
    for topic, kind in dict.fromkeys((topic, kind) for topic, kind, _, _ in messages):
        own = [(time, store.deserialize_cdr(data, kind)) for other, _, time, data in messages if other == topic]
        path = topic.strip("/").replace("/", ".")
        fields = dict(store.fielddefs[kind][1])
        stamped = TIME in [what[1] for what in fields.values()] or "header" in fields
        if not stamped:
            truth.column(path + ".log_time", [(time - origin) / 1e9 for time, _ in own])
        flatten(truth, path, (Nodetype.NAME, kind), [message for _, message in own], 0, origin)


def humble(path, messages, page, others=()):
    """A bag as rosbag2 of Humble writes it; others are topics that are left out, with a message of their own."""
    with sqlite3.connect(path) as file:
        file.execute(f"PRAGMA page_size = {page}")
        file.execute("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL)")
        file.execute("CREATE TABLE metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,metadata TEXT NOT NULL)")
        file.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
                     "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL)")
        file.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
        file.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
        file.execute("INSERT INTO schema VALUES (3, 'humble')")
        topics = {}
        for topic, kind, encoding, _ in list(others) + [(topic, kind, "cdr", None) for topic, kind, _, _ in messages]:
            if topic not in topics:
                topics[topic] = len(topics) + 1
                file.execute("INSERT INTO topics VALUES (?, ?, ?, ?, ?)", (topics[topic], topic, kind, encoding, "- history: 3\n" * 400))
        for at, (topic, _, time, data) in enumerate(messages):
            file.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (topics[topic], time, data))
            for other, _, _, content in others if at % 50 == 1 else ():
                file.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (topics[other], time, content))
    file.close()


def bag(name, messages, plugin, mode, version):
    """A bag by the writer of rosbags; the file of it alone."""
    whole = folder / f"{name}.d"
    writer = Writer(whole, version=version, storage_plugin=plugin)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connections = {}
        for topic, kind, time, data in messages:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(connections[topic], time, data)
    (made,) = [path for path in whole.iterdir() if path.name != "metadata.yaml"]
    shutil.move(made, folder / name)
    shutil.rmtree(whole)


ARM = [("/arm/joint_states", "sensor_msgs/msg/JointState"), ("/force", "geometry_msgs/msg/WrenchStamped"),
       ("/command", "std_msgs/msg/Float64MultiArray")]
OTHER = [("/camera", "sensor_msgs/msg/Image", "cdr", b"\0\1\0\0" + bytes(100_000)), ("/own", "a_msgs/msg/Drive", "cdr", bytes(40)),
         ("/json", "std_msgs/msg/Float64", "json", b'{"data": 1}'),
         # Not what the type is: the recorder had another one of the same name.
         ("/odd", "geometry_msgs/msg/Vector3", "cdr", b"\0\1\0\0" + bytes(60))]
for page, n, count in [(512, 100, 60), (4096, 220, 200), (65536, 400, 3)]:
    messages = rows(ARM, n, count)
    truth = Truth(f"humble_{page}.db3")
    humble(truth.path, messages, page, OTHER)
    truth.skipped("camera", "own", "json", "odd")
    describe(truth, messages)
    truth.write()

# Every type whose layout is built in.
text = pathlib.Path(__file__).parents[2] / "src/ros/common.msg"
kinds = [line[5:].replace("/", "/msg/") for line in text.read_text().splitlines() if line.startswith("MSG: ")]
kinds = list(dict.fromkeys(kinds))
assert set(kinds) <= set(store.fielddefs), set(kinds) - set(store.fielddefs)
messages = rows([("/" + kind.split("/")[2].lower(), kind) for kind in kinds], 40)
truth = Truth("common.db3")
humble(truth.path, messages, 4096)
describe(truth, messages)
truth.write()

drive = ARM + [("/drive", "a_msgs/msg/Drive")]
NONE, FILE, MESSAGE = CompressionMode.NONE, CompressionMode.FILE, CompressionMode.MESSAGE
for name, plugin, mode, version in [("plain.db3", StoragePlugin.SQLITE3, NONE, 8), ("plain9.db3", StoragePlugin.SQLITE3, NONE, 9),
                                    ("messages.db3", StoragePlugin.SQLITE3, MESSAGE, 8), ("whole.db3.zstd", StoragePlugin.SQLITE3, FILE, 8),
                                    ("plain.mcap", StoragePlugin.MCAP, NONE, 8), ("messages.mcap", StoragePlugin.MCAP, MESSAGE, 8),
                                    ("whole.mcap.zstd", StoragePlugin.MCAP, FILE, 9)]:
    messages = rows(drive, 300)
    truth = Truth(name)
    bag(name, messages, plugin, mode, version)
    describe(truth, messages)
    truth.write()

# A recording in several files, of which a later one has a topic more.
truth = Truth("split.bag")
truth.path.mkdir()
first, second = rows(ARM, 80), rows(drive[:3] + [("/imu", "sensor_msgs/msg/Imu")], 80)
shift = first[-1][2] - START
messages = first + [(topic, kind, time + shift, data) for topic, kind, time, data in second]
thirds = [messages[:100], messages[100:300], messages[300:]]
for part, some in enumerate(thirds):
    humble(truth.path / f"split_{part}.db3", some, 4096)
listed = "".join(f"    - split_{part}.db3\n" for part in range(3))
(truth.path / "metadata.yaml").write_text(
    "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n" + listed
    + "  duration:\n    nanoseconds: 1\n  topics_with_message_count:\n    - topic_metadata:\n        name: /force\n"
    + "  compression_format: \"\"\n  compression_mode: \"\"\n")
describe(truth, messages)
truth.write()
