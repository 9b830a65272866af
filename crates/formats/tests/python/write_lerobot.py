"""Writes data sets as LeRobot 2.1 and 3.0 lay them out, and what a reader must find: `python write_lerobot.py FOLDER`.

The layout is that of `LeRobotDataset.create`, `add_frame` and `save_episode` of lerobot 0.3 (v2.1) and 0.4 (v3.0): the Arrow types
are those of `get_hf_features_from_features`, a list of one length for each vector, `float32` for `timestamp`, which begins with 0 in
each episode, and a struct of bytes and path for a picture.
"""

import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from truth import Truth, folder, rng

FPS = 30
JOINTS = ["shoulder_pan.pos", "elbow_flex.pos", "gripper.pos"]
LENGTHS = [40, 31, 1, 52]


def features(names):
    vector = {"dtype": "float32", "shape": [3], "names": names}
    one = lambda kind: {"dtype": kind, "shape": [1], "names": None}
    return {
        "action": vector,
        "observation.state": vector,
        "observation.plain": {"dtype": "float32", "shape": [2], "names": None},
        "observation.images.top": {"dtype": "video", "shape": [480, 640, 3], "names": ["height", "width", "channels"]},
        "observation.images.wrist": {"dtype": "image", "shape": [4, 4, 3], "names": ["height", "width", "channels"]},
        "timestamp": one("float32"),
        "frame_index": one("int64"),
        "episode_index": one("int64"),
        "index": one("int64"),
        "task_index": one("int64"),
    }


def episode(number, frames, begin):
    single = lambda *shape: rng.normal(size=shape).astype(np.float32)
    return {
        "action": single(frames, 3),
        "observation.state": single(frames, 3),
        "observation.plain": single(frames, 2),
        "timestamp": (np.arange(frames) / FPS).astype(np.float32),
        "frame_index": np.arange(frames),
        "episode_index": np.full(frames, number),
        "index": begin + np.arange(frames),
        "task_index": np.zeros(frames, dtype=np.int64),
    }


def table(episodes):
    columns = {}
    for key in episodes[0]:
        values = np.concatenate([e[key] for e in episodes])
        if values.ndim == 2:
            flat = pa.array(values.ravel())
            columns[key] = pa.FixedSizeListArray.from_arrays(flat, values.shape[1])
        else:
            columns[key] = pa.array(values)
        if key == "observation.plain":
            picture = pa.struct({"bytes": pa.binary(), "path": pa.string()})
            pictures = [{"bytes": b"PNG", "path": f"frame-{n:06d}.png"} for n in range(len(values))]
            columns["observation.images.wrist"] = pa.array(pictures, type=picture)
    return pa.table(columns)


def data_set(name, version, names, files, written):
    root = folder / name
    (root / "meta").mkdir(parents=True)
    episodes, begin = [], 0
    for number, frames in enumerate(LENGTHS):
        episodes.append(episode(number, frames, begin))
        begin += frames
    at = 0
    for index, (path, count) in enumerate(files):
        path = root / path
        path.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(table(episodes[at:at + count]), path, compression="snappy", use_dictionary=True)
        at += count
    info = {
        "codebase_version": version, "robot_type": "so101_follower", "total_episodes": len(LENGTHS),
        "total_frames": begin, "fps": FPS, "splits": {"train": f"0:{len(LENGTHS)}"}, "features": features(names),
    }
    (root / "meta" / "info.json").write_text(json.dumps(info, indent=4))

    truth = Truth(f"{name}.all")
    # Each episode begins one frame after the one before it.
    time, last = [], None
    for e in episodes:
        own = e["timestamp"].astype(np.float64)
        shift = 0.0 if last is None else last + 1.0 / FPS - own[0]
        time.append(own + shift if last is not None else own)
        last = time[-1][-1]
    for key in episodes[0]:
        values = np.concatenate([e[key] for e in episodes]).astype(np.float64)
        if key == "timestamp":
            truth.column(key, np.concatenate(time))
        elif values.ndim == 1:
            truth.column(key, values)
        else:
            for n in range(values.shape[1]):
                element = f"{key}(:,{n + 1})" if key == "observation.plain" else f"{key}.{written[n]}"
                truth.column(element, values[:, n])
    truth.skipped("observation.images.top")
    truth.skipped("observation.images.wrist")
    truth.write()


each = [(f"data/chunk-000/episode_{n:06d}.parquet", 1) for n in range(len(LENGTHS))]
data_set("v21", "v2.1", JOINTS, each, JOINTS)
motors = ["main_shoulder_pan", "main_elbow_flex", "main_gripper"]
data_set("v20", "v2.0", {"motors": motors}, each, motors)
several = [("data/chunk-000/file-000.parquet", 3), ("data/chunk-001/file-000.parquet", 1)]
data_set("v30", "v3.0", JOINTS, several, JOINTS)
