"""Blocks of MDF 4 as the standard lays them out, for files that asammdf does not write, and formulas of conversions."""

import struct
import zlib

import numpy as np
from asammdf.blocks.v4_blocks import ChannelConversion


class Blocks:
    """A file in the making: blocks one after the other, the links of some set later."""

    def __init__(self, version=410):
        text = f"{version // 100}.{version % 100:02}"
        self.bytes = bytearray(struct.pack("<8s8s8s4xH30x2H", b"MDF     ", text.encode().ljust(8), b"by hand ", version, 0, 0))
        self.header = self.block(b"HD", [0] * 6, struct.pack("<QhhBBBxdd", 0, 0, 0, 0, 0, 0, 0, 0))

    def block(self, mark, links, data=b""):
        at = len(self.bytes)
        self.bytes += struct.pack(f"<2s2sIQQ{len(links)}Q", b"##", mark, 0, 24 + 8 * len(links) + len(data), len(links), *links)
        self.bytes += data + bytes(-len(data) % 8)
        return at

    def link(self, block, number, to):
        struct.pack_into("<Q", self.bytes, block + 24 + 8 * number, to)

    def text(self, text):
        return self.block(b"TX", [], text.encode() + b"\0") if text else 0

    def conversion(self, kind, numbers):
        return self.block(b"CC", [0] * 4, struct.pack(f"<BBHHHdd{len(numbers)}d", kind, 0, 0, 0, len(numbers), 0, 0, *numbers))

    def channel(self, name, data_type, byte, bits, bit=0, *, kind=0, sync=0, flags=0, invalid=0, unit="", conversion=0, composition=0):
        links = [0, composition, self.text(name), 0, conversion, 0, self.text(unit), 0]
        return self.block(b"CN", links, struct.pack("<BBBBIIIIBBH6d", kind, sync, data_type, bit, byte, bits, flags, invalid, 0, 0, 0, *[0] * 6))

    def chain(self, blocks):
        """Makes each lead to the next; the first."""
        for before, after in zip(blocks, blocks[1:]):
            self.link(before, 0, after)
        return blocks[0] if blocks else 0

    def group(self, channels, records, data_bytes, *, invalid_bytes=0, name="", number=0, flags=0, base=None):
        links = [0, self.chain(channels), self.text(name), 0, 0, 0] + ([base] if base is not None else [])
        return self.block(b"CG", links, struct.pack("<QQHHIII", number, records, flags, 0, 0, data_bytes, invalid_bytes))

    def data_group(self, groups, data, number_bytes=0):
        return self.block(b"DG", [0, self.chain(groups), data, 0], struct.pack("<B7x", number_bytes))

    def write(self, path, data_groups):
        self.link(self.header, 0, self.chain(data_groups))
        path.write_bytes(self.bytes)

    def data(self, content, mark=b"DT"):
        return self.block(mark, [], content)

    def packed(self, content, columns=0, mark=b"DT"):
        """Deflated, with the bytes of rows of so many columns turned."""
        turned = content
        if columns:
            whole = len(content) // columns * columns
            turned = np.frombuffer(content[:whole], np.uint8).reshape(-1, columns).T.tobytes() + content[whole:]
        stored = zlib.compress(turned)
        return self.block(b"DZ", [], struct.pack("<2sBxIQQ", mark, 1 if columns else 0, columns, len(content), len(stored)) + stored)

    def list(self, blocks, after=0):
        return self.block(b"DL", [after, *blocks], struct.pack("<B3xIQ", 1, len(blocks), 0))

    def head_of_list(self, first):
        return self.block(b"HL", [first], struct.pack("<HB5x", 1, 0))

    def column_list(self, blocks, invalid=None, after=0):
        flags = 1 | (1 << 31 if invalid else 0)
        return self.block(b"LD", [after, *blocks, *(invalid or [])], struct.pack("<IIQ", flags, len(blocks), 0))


def linear(factor, offset):
    return ChannelConversion(conversion_type=1, a=factor, b=offset)


def converted(conversion, values):
    """What a linear or rational conversion makes of 64-bit floats."""
    if conversion is None or conversion.conversion_type == 0:
        return values
    if conversion.conversion_type == 1:
        values = values * conversion.a
        return values + conversion.b if conversion.b else values
    if conversion.conversion_type == 2:
        c = conversion
        return (c.P1 * (values * values) + c.P2 * values + c.P3) / (c.P4 * (values * values) + c.P5 * values + c.P6)
    raise ValueError(conversion.conversion_type)
