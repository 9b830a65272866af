"""Writes HDF5 files in which one member is of a kind that cannot be read, and beside each one the truth: the others are.

Usage: python write_odd_hdf5.py FOLDER
"""

import h5py
import numpy as np

from truth import Truth, bits, folder


def odd(name, put, *left_out, columns=(), **options):
    truth = Truth(name)
    t, q = bits(300), bits(200)
    with h5py.File(truth.path, "w", **options) as file:
        file["a"] = t
        file["z/q"] = q
        put(file)
    truth.column("a", t)
    for key, values in columns:
        truth.column(key, values)
    truth.column("z.q", q)
    truth.skipped(*left_out)
    truth.write()


def links(file):
    file["soft"] = h5py.SoftLink("/a")
    file["nowhere"] = h5py.SoftLink("/gone")
    file["outside"] = h5py.ExternalLink("other.h5", "/x")


def soft(file):
    """In groups of the old form, which external links turn into new ones."""
    file["soft"] = h5py.SoftLink("/a")
    file["z/up"] = h5py.SoftLink("/z")
    file["z/nowhere"] = h5py.SoftLink("gone/further")
    for number in range(30):
        file[f"z/link{number}"] = h5py.SoftLink("/a")


def empty(file):
    file["nothing"] = h5py.Empty("f8")


def region(file):
    made = file.create_dataset("region", (2,), dtype=h5py.regionref_dtype)
    made[0] = file["a"].regionref[2:5]


def virtual(file):
    layout = h5py.VirtualLayout(shape=(300,), dtype="f8")
    layout[:] = h5py.VirtualSource(file["a"])
    file.create_virtual_dataset("virtual", layout)


def committed(file):
    file["type"] = np.dtype("f8")


def outside(file):
    file.create_dataset("outside", (10,), dtype="f8", external=[("raw.bin", 0, 80)])


def opaque(file):
    file.create_dataset("opaque", data=np.zeros(3, dtype="V7"))
    file.create_dataset("time", data=np.arange(3).astype("M8[ns]").astype(h5py.opaque_dtype("M8[ns]")))
    file.create_dataset("array", (3,), dtype=np.dtype(("f8", (2,))))
    file.create_dataset("quad", (3,), dtype=np.longdouble)


def grown(file):
    values = np.arange(2000.0)
    file.create_dataset("two", data=values.reshape(500, 4), maxshape=(None, None), chunks=(50, 2))
    file.create_dataset("one", data=values, maxshape=(None,), chunks=(100,))
    file.create_dataset("fixed", data=values, chunks=(100,))
    file.create_dataset("single", data=values, chunks=(2000,))


def packed(file):
    values = np.arange(2000.0)
    file.create_dataset("two", data=values.reshape(500, 4), maxshape=(None, None), chunks=(50, 2), compression="gzip")
    file.create_dataset("one", data=values, maxshape=(None,), chunks=(100,), compression="gzip")


values = np.arange(2000.0)
tables = [("fixed", values), ("one", values), ("single", values)] + [
    (f"two(:,{j + 1})", values.reshape(500, 4)[:, j]) for j in range(4)]
for version in ["earliest", "v108", "v110", "v114", "latest"]:
    def all_of(name, put, *left_out, **more):
        odd(f"{name}_{version}.h5", put, *left_out, libver=version, **more)

    # The decoder does not tell of links that are not hard ones.
    all_of("links", links)
    all_of("soft", soft)
    all_of("empty", empty, "nothing")
    all_of("region", region, "region")
    if version not in ("earliest", "v108"):
        all_of("virtual", virtual, "virtual")
    all_of("committed", committed)
    all_of("outside", outside, "outside")
    all_of("opaque", opaque, "array", "opaque", "quad", "time")
    if version in ("earliest", "v108"):
        all_of("grown", grown, columns=tables)
        all_of("packed", packed, columns=tables[1:2] + tables[3:])
    else:
        all_of("grown", grown, "two", columns=tables[:3])
        # HDF5 2.0 has another layout for packed chunks.
        all_of("packed", packed, *["one"] * (version == "latest"), "two", columns=tables[1:2] * (version != "latest"))
