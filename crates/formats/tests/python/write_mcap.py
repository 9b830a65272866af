"""Writes ROS 2 recordings as MCAP with the mcap packages, and beside each one the truth.

Usage: python write_mcap.py FOLDER

The truth is what mcap_ros2 decodes from the file.
"""

import json

import numpy as np
from mcap.writer import CompressionType, Writer as Plain
from mcap_ros2.reader import read_ros2_messages
from mcap_ros2.writer import Writer

from truth import Truth, bits, folder, rng, whole

HEADER = """
================================================================================
MSG: std_msgs/Header
# Standard metadata.
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
JOINTS = """# The state of joints.
std_msgs/Header header

string[] name
float64[] position
float64[] velocity
float64[] effort
""" + HEADER
WRENCH = """std_msgs/Header header
geometry_msgs/Wrench wrench
""" + HEADER + """================================================================================
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3  force
geometry_msgs/Vector3  torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""
OWN = """uint8 IDLE=0
string NOTE="x # y"
uint8 state
bool enabled
int16[3] counts
string<=10 mode
int64 wide
uint8[] picture
float32[] currents
a_msgs/Motor[] motors
builtin_interfaces/Duration lag
float64[<=4] some
char c
int8 small 3
uint16 u
uint32 v
uint64 w
float64[] never
a_msgs/Nothing nothing
float64 last
================================================================================
MSG: a_msgs/Motor
int8 temperature
float64 torque
string label
================================================================================
MSG: a_msgs/Nothing
"""
START = 1_785_585_600_123_456_789


def stamp(ns):
    return {"sec": ns // 10**9, "nanosec": ns % 10**9}


def put(name, compression, chunk, joints=True, others=True):
    truth = Truth(name)
    n = 300
    ticks = START + np.cumsum(rng.integers(1, 2_000_000, size=n))
    with open(truth.path, "wb") as file:
        writer = Writer(file, chunk_size=chunk, compression=compression)
        state = writer.register_msgdef("sensor_msgs/msg/JointState", JOINTS)
        wrench = writer.register_msgdef("geometry_msgs/msg/WrenchStamped", WRENCH)
        own = writer.register_msgdef("a_msgs/msg/Drive", OWN)
        for i in range(n):
            ns = int(ticks[i])
            header = {"stamp": stamp(ns), "frame_id": "base"}
            q = [float(x) for x in bits(3)[rng.permutation(3)] * 1.0]
            names = ["shoulder", "elbow", "wrist"]
            if i % 4 == 3:
                names = ["wrist", "elbow", "shoulder"]
            if joints:
                message = {"header": header, "name": names, "position": q, "velocity": [i + 0.5, i / 3, -i],
                           "effort": [] if i % 5 == 4 else [1.0, 2.0, i]}
                writer.write_message("/arm/joint_states", state, message, log_time=ns + 500, publish_time=ns)
            if others and i % 3 == 0:
                vector = [dict(zip("xyz", rng.normal(size=3).tolist())) for _ in range(2)]
                writer.write_message("/wrench", wrench, {"header": header, "wrench": {"force": vector[0], "torque": vector[1]}},
                                     log_time=ns + 700, publish_time=ns)
            if others and i % 2 == 0:
                message = {"state": i % 256, "enabled": i % 2 == 0, "counts": [i, -i, 7], "mode": "run", "wide": int(whole(np.int64, 3)[2]),
                           "picture": bytes(range(i % 7)), "currents": [float(np.float32(i / 7)), 0.5],
                           "motors": [{"temperature": -5, "torque": i / 9, "label": "a"}, {"temperature": 50, "torque": -i / 9, "label": "b"}],
                           "lag": stamp(1_500_000_000 + i), "some": [1.0] * (1 + i % 4), "c": 65, "small": -3, "u": 65535, "v": 2**32 - 1,
                           "w": 2**53 + 1, "never": [], "nothing": {}, "last": i / 11}
                writer.write_message("/drive", own, message, log_time=ns + 900, publish_time=ns)
        writer.add_metadata("about", {"axis": "3"})
        writer.add_attachment(0, 0, "note.txt", "text/plain", b"hello")
        writer.finish()
    found = {"/arm/joint_states": [], "/wrench": [], "/drive": []}
    for message in read_ros2_messages(str(truth.path)):
        found[message.channel.topic].append((message.log_time_ns, message.ros_msg))
    # The origin of every time stamp of the file is when its first message was recorded.
    origin = min(rows[0][0] for rows in found.values() if rows)

    def seconds(stamps):
        return np.array([s.sec * 10**9 + s.nanosec - origin for s in stamps]) / 1e9

    if joints:
        states = [m for _, m in found["/arm/joint_states"]]
        truth.column("arm.joint_states.header.stamp", seconds([m.header.stamp for m in states]))
        truth.skipped("arm.joint_states.header.frame_id")
        for joint in ["shoulder", "elbow", "wrist"]:
            at = [m.name.index(joint) for m in states]
            for signal in ["position", "velocity", "effort"]:
                lists = [getattr(m, signal) for m in states]
                truth.column(f"arm.joint_states.{joint}.{signal}", [row[j] if row else np.nan for row, j in zip(lists, at)])
    if others:
        rows = [m for _, m in found["/wrench"]]
        truth.column("wrench.header.stamp", seconds([m.header.stamp for m in rows]))
        truth.skipped("wrench.header.frame_id")
        for part in ["force", "torque"]:
            for axis in "xyz":
                truth.column(f"wrench.wrench.{part}.{axis}", [getattr(getattr(m.wrench, part), axis) for m in rows])
        rows = [m for _, m in found["/drive"]]
        truth.column("drive.log_time", np.array([t - origin for t, _ in found["/drive"]]) / 1e9)

        def plain(key):
            truth.column("drive." + key, [float(getattr(m, key)) for m in rows])

        def lists(key, part=lambda m: m):
            truth.matrix("drive." + key, np.array([[float(part(x)) for x in getattr(m, key.split(".")[0])] for m in rows]))

        plain("state")
        plain("enabled")
        lists("counts")
        truth.skipped("drive.mode")
        plain("wide")
        truth.skipped("drive.picture")
        lists("currents")
        lists("motors.temperature", lambda m: m.temperature)
        lists("motors.torque", lambda m: m.torque)
        truth.skipped("drive.motors.label")
        truth.column("drive.lag", np.array([m.lag.sec * 10**9 + m.lag.nanosec for m in rows]) / 1e9)
        truth.skipped("drive.some")
        for key in ["c", "small", "u", "v", "w"]:
            plain(key)
        truth.skipped("drive.never")
        plain("last")
    truth.write()


def foreign(name):
    """Topics in other encodings beside one that is read."""
    truth = Truth(name)
    with open(truth.path, "wb") as file:
        writer = Plain(file, compression=CompressionType.NONE, use_chunking=False)
        writer.start(profile="", library="test")
        schema = writer.register_schema("std_msgs/msg/Float64", "ros2msg", b"float64 data\n")
        other = writer.register_schema("foo.Bar", "protobuf", b"\x0a")
        idl = writer.register_schema("std_msgs/msg/Float64", "ros2idl", b"module")
        topics = [("/f", "cdr", schema), ("/json", "json", 0), ("/proto", "protobuf", other), ("/idl", "cdr", idl)]
        channels = [writer.register_channel(topic, encoding, schema_id) for topic, encoding, schema_id in topics]
        for i in range(5):
            data = [b"\x00\x00\x00\x00" + np.array(i / 3, ">f8").tobytes(), json.dumps({"x": i}).encode(), b"\x08\x01", b"\x00\x01\x00\x00"]
            for channel, content in zip(channels, data):
                writer.add_message(channel, START + i, content, START + i)
        writer.finish()
    truth.skipped("json", "proto", "idl")
    truth.column("f.log_time", np.arange(5) / 1e9)
    truth.column("f.data", np.arange(5) / 3)
    truth.write()


put("none.mcap", CompressionType.NONE, 2**20)
put("lz4.mcap", CompressionType.LZ4, 10_000)
put("zstd.mcap", CompressionType.ZSTD, 30_000)
put("joints.mcap", CompressionType.ZSTD, 2**20, others=False)
foreign("foreign.mcap")
