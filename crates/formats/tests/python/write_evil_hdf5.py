"""Writes small HDF5 files that claim to hold much: beside a column `a` that can be read, a dataset of which little is there.

Usage: python write_evil_hdf5.py FOLDER
"""

import pathlib
import struct
import sys

import h5py
import numpy as np

folder = pathlib.Path(sys.argv[1])
a = np.arange(40.0)
LONG = 1 << 25


def lookup3(data):
    """The checksum of HDF5: hashlittle of Bob Jenkins, <https://burtleburtle.net/bob/c/lookup3.c>."""
    def rot(x, k):
        return (x << k | x >> (32 - k)) & 0xFFFFFFFF

    x = y = z = (0xDEADBEEF + len(data)) & 0xFFFFFFFF
    data += bytes(-len(data) % 12)
    words = struct.unpack(f"<{len(data) // 4}I", data)
    for k in range(0, len(words), 3):
        x, y, z = ((old + new) & 0xFFFFFFFF for old, new in zip((x, y, z), words[k:]))
        if k + 3 < len(words):
            for shift in [4, 6, 8, 16, 19, 4]:
                x = (x - z & 0xFFFFFFFF) ^ rot(z, shift)
                z = z + y & 0xFFFFFFFF
                x, y, z = y, z, x
        else:
            for shift in [14, 11, 25, 16, 4, 14, 24]:
                z = ((z ^ y) - rot(y, shift)) & 0xFFFFFFFF
                x, y, z = y, z, x
    return y


def made(name, put, **options):
    path = folder / f"{name}.h5"
    with h5py.File(path, "w", **options) as file:
        file["a"] = a
        put(file)
    return path


def changed(path, mark, changes, length):
    """Puts bytes into the block that begins so, and its checksum behind them."""
    content = bytearray(path.read_bytes())
    at = content.index(mark)
    for place, byte in changes.items():
        content[at + place] = byte
    content[at + length:at + length + 4] = struct.pack("<I", lookup3(bytes(content[at:at + length])))
    path.write_bytes(content)


def some(file, **more):
    made = file.create_dataset("x", (LONG,), "f8", chunks=(1024,), **more)
    made[:3] = 1.0


made("unwritten", lambda file: file.create_dataset("x", (LONG,), "f8"))
made("row", lambda file: file.create_dataset("x", (1, 16 * LONG), "f8"))
made("chunk", lambda file: file.create_dataset("x", (LONG,), "f8", chunks=(LONG // 2,), maxshape=(None,)))
made("records", lambda file: file.create_dataset("x", (LONG,), [("p", "f8"), ("q", "f8")]))
made("cells", lambda file: file.create_dataset("x", (LONG,), h5py.ref_dtype))
made("few", some)
for version in ["earliest", "v114"]:
    made(f"grown_{version}", lambda file: some(file, maxshape=(None,)), libver=version)

# Chunks beyond the end: as many as the file says, each to be unpacked.
path = made("beyond", lambda file: file.create_dataset("x", data=np.zeros(1234567), chunks=(100_000,), compression="gzip"))
path.write_bytes(path.read_bytes().replace(struct.pack("<Q", 1234567), struct.pack("<Q", 3)))

# A list of blocks that doubles with every second of 200 steps.
path = made("refused_index", lambda file: file.create_dataset("x", data=a, chunks=(2,), maxshape=(None,)), libver="v114")
assert lookup3(b"Four score and seven years ago") == 0x17770551
changed(path, b"EAHD", {7: 255, 10: 200}, 68)
