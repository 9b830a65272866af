"""Small files that claim or unpack to gigabytes, one of each kind: `python make.py DIR`.

Needs h5py, numpy and pyarrow, as the tests do (`cargo xtask setup`). Nothing here holds a sample of a recording.
"""

import io
import struct
import sys
import zipfile
import zlib
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.feather
import pyarrow.parquet

ROWS = 100_000_000  # 800 MB as numbers of 64 bits
HUGE = 2_000_000_000


def hdf5(folder):
    with h5py.File(folder / "packed.h5", "w") as file:
        file.create_dataset("q", (ROWS,), "f8", chunks=(1 << 20,), compression="gzip", compression_opts=9)
        for start in range(0, ROWS, 1 << 20):
            file["q"][start : start + (1 << 20)] = 0.0
    # Chunks that were never written are filled, so the file holds nothing of them.
    with h5py.File(folder / "unwritten.h5", "w") as file:
        file.create_dataset("q", (HUGE,), "f8", chunks=(1 << 16,), compression="gzip")
    with h5py.File(folder / "unwritten-bytes.h5", "w") as file:
        file.create_dataset("q", (HUGE,), "i1", chunks=(1 << 16,))
    with h5py.File(folder / "one-chunk.h5", "w") as file:
        data = file.create_dataset("q", (64, 1 << 22), "i1", chunks=(64, 1 << 22), compression="gzip", compression_opts=9)
        data[:] = 0
    with h5py.File(folder / "contiguous.h5", "w") as file:
        file.create_dataset("q", (HUGE,), "f8")
    # Many names of one set.
    with h5py.File(folder / "links.h5", "w") as file:
        data = file.create_dataset("q", (1 << 20,), "f8", chunks=(1 << 20,), compression="gzip", compression_opts=9)
        data[:] = 0.0
        for index in range(2000):
            file[f"q{index}"] = data
    with h5py.File(folder / "many-chunks.h5", "w") as file:
        file.create_dataset("q", (HUGE,), "f8", chunks=(1,))
    with h5py.File(folder / "records.h5", "w") as file:
        kind = np.dtype([("a", "f8"), ("b", "f8"), ("c", "i1", (1000,))])
        file.create_dataset("q", (4_000_000,), kind, chunks=(1000,), compression="gzip")


def header(descr, shape):
    text = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text


def numpy(folder):
    zeros = bytes(1 << 20)
    with zipfile.ZipFile(folder / "packed.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        with archive.open("q.npy", "w", force_zip64=True) as member:
            member.write(header("'|i1'", "(251658240,)"))
            for _ in range(240):
                member.write(zeros)
    with zipfile.ZipFile(folder / "skipped.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in ("a", "b"):
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                member.write(header("'|S1048576'", "(1000,)"))
                for _ in range(1000):
                    member.write(zeros)
    (folder / "claims.npy").write_bytes(header("'<f8'", f"({HUGE},)") + bytes(8000))


def matlab(folder):
    element = struct.pack("<6I", 6, 8, 6, 0, 5, 8) + struct.pack("<2I", ROWS, 1) + struct.pack("<2H", 1, 1)
    element += struct.pack("<I", ord("q")) + struct.pack("<2I", 9, ROWS * 8 & 0xFFFFFFFF)
    packer = zlib.compressobj(9)
    packed = packer.compress(struct.pack("<2I", 14, len(element) + ROWS * 8) + element)
    for _ in range(ROWS * 8 // (1 << 20)):
        packed += packer.compress(bytes(1 << 20))
    packed += packer.flush()
    start = b" " * 124 + struct.pack("<H", 0x0100) + b"IM"
    (folder / "packed.mat").write_bytes(start + struct.pack("<2I", 15, len(packed)) + packed)
    (folder / "claims-v4.mat").write_bytes(struct.pack("<5I", 0, HUGE, 1, 0, 2) + b"q\0" + bytes(8000))


def arrow(folder):
    table = pa.table({"t": np.zeros(ROWS // 2), "q": np.zeros(ROWS // 2)})
    pa.parquet.write_table(table, folder / "packed.parquet", compression="snappy", use_dictionary=True)
    pa.feather.write_feather(table, str(folder / "packed.arrow"), compression="zstd", compression_level=19)
    pa.feather.write_feather(table, str(folder / "packed-lz4.arrow"), compression="lz4")


def workbook(folder):
    parts = {
        "[Content_Types].xml": '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"/>',
        "_rels/.rels": '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": '<?xml version="1.0"?><workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" '
        'xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets><sheet name="s" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet1.xml"/>'
        '<Relationship Id="r2" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/sharedStrings" Target="sharedStrings.xml"/></Relationships>',
    }
    sheet = '<?xml version="1.0"?><worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>'
    for name, strings in (("packed", False), ("strings", True)):
        with zipfile.ZipFile(folder / f"{name}.xlsx", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
            for path, text in parts.items():
                archive.writestr(path, text)
            if strings:
                with archive.open("xl/sharedStrings.xml", "w", force_zip64=True) as member:
                    member.write(b'<?xml version="1.0"?><sst xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">')
                    for _ in range(200):
                        member.write(b"<si><t>aaaaaaaa</t></si>" * 40_000)
                    member.write(b"</sst>")
            with archive.open("xl/worksheets/sheet1.xml", "w", force_zip64=True) as member:
                member.write(sheet.encode())
                row = b"<row><c><v>0</v></c><c><v>0</v></c></row>"
                for _ in range(1 if strings else 400):
                    member.write(row * 40_000)
                member.write(b"</sheetData></worksheet>")


def text(folder):
    (folder / "one-row.csv").write_bytes(b"t,q\n" + b"0," * (8 << 20))
    # A table where every number is a byte: eight times the file in memory.
    (folder / "dense.csv").write_bytes(b"t,q,f\n" + b"1,2,3\n" * 16_000_000)
    (folder / "dense.json").write_bytes(b'{"q":[' + b"0," * 30_000_000 + b"0]}")


def mcap(folder):
    import mcap.writer

    with open(folder / "packed.mcap", "wb") as stream:
        writer = mcap.writer.Writer(stream, compression=mcap.writer.CompressionType.ZSTD, chunk_size=256 << 20)
        writer.start("ros2", "")
        schema = writer.register_schema("x/Q", "ros2msg", b"float64[] q")
        channel = writer.register_channel("/q", "cdr", schema)
        for time in range(400):
            body = b"\0\1\0\0" + struct.pack("<II", 1 << 17, 0) + bytes((1 << 17) * 8)
            writer.add_message(channel, time, body, time)
        writer.finish()


def tdms(folder):
    name = lambda text: struct.pack("<I", len(text)) + text.encode()
    lead = lambda flags, end, raw: b"TDSm" + struct.pack("<IIQQ", flags, 4713, end, raw)
    about = struct.pack("<I", 1) + name("/'g'/'q'") + struct.pack("<I", 20)
    about += struct.pack("<IIQ", 10, 1, HUGE) + struct.pack("<I", 0)
    (folder / "claims.tdms").write_bytes(lead(0xE, len(about) + 8000, len(about)) + about + bytes(8000))


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for make in (hdf5, numpy, matlab, arrow, workbook, text, mcap, tdms):
        try:
            make(folder)
        except ModuleNotFoundError as error:
            print(f"{make.__name__}: left out, {error}", file=sys.stderr)
