"""Writes captures of an EtherCAT network with one drive of CiA 402, and what a reader must find: `python write_ethercat.py FOLDER`.

Frames are put together by the EtherCAT layers of scapy and read back by them for the truth; the containers are written here, after
draft-ietf-opsawg-pcap and draft-ietf-opsawg-pcapng, and read back by scapy as well.

Each cycle the master sends a frame, which comes back with the mark of the first slave in its source address, the inputs of the
drive and the working counter. Of some cycles the frame does not come back, or the drive does not answer.
"""

import logging
import struct
from fractions import Fraction

import numpy as np
from scapy.all import IP, UDP, Dot1Q, Ether, RawPcapNgReader, RawPcapReader
from scapy.contrib.ethercat import (
    EtherCat, EtherCatBRD, EtherCatFPRD, EtherCatFPWR, EtherCatFRMW, EtherCatLRD, EtherCatLRW, EtherCatLWR)

from truth import Truth, folder, rng

# It says so of each last datagram that nothing follows it.
logging.getLogger("scapy").setLevel(logging.CRITICAL)

CYCLES = 100
LOGICAL = 0x10000
SENT, BACK = "00:1b:21:3c:9d:f8", "02:1b:21:3c:9d:f8"
LOST, SILENT = {40, 41, 70}, {20, 80, 81}

time_ns = np.cumsum(rng.integers(980_000, 1_020_000, CYCLES)) + 1_790_000_000_000_000_000
position = np.cumsum(rng.integers(-2000, 2000, CYCLES)).astype(np.int32)
torque = rng.integers(-1500, 1500, CYCLES).astype(np.int16)
status = rng.choice([0x1237, 0x0637, 0x0627], CYCLES).astype(np.uint16)
target = (position + rng.integers(-9, 9, CYCLES)).astype(np.int32)
control = rng.choice([0x0F, 0x07], CYCLES).astype(np.uint16)
flags = rng.integers(0, 256, CYCLES).astype(np.uint8)


def outputs(n):
    return struct.pack("<Hi", control[n], target[n])


def inputs(n):
    return struct.pack("<HihB", status[n], position[n], torque[n], flags[n])


def both(n, back):
    """One datagram, outputs before inputs."""
    return [(EtherCatLRW, dict(adr=LOGICAL), outputs(n) + (inputs(n) if back else bytes(9)), 3)]


def shared(n, back):
    """One datagram, inputs and outputs in the same place."""
    own = inputs(n) if back else outputs(n) + bytes(3)
    return [(EtherCatLRW, dict(adr=LOGICAL), own, 3)]


def apart(n, back):
    """Two datagrams, of which the second has no outputs."""
    read = (EtherCatLRD, dict(adr=LOGICAL + 0x800), inputs(n) if back else bytes(9), 1)
    return [(EtherCatLWR, dict(adr=LOGICAL), outputs(n), 1), read]


def station(n, back):
    read = (EtherCatFPRD, dict(adp=1001, ado=0x1100), inputs(n) if back else bytes(9), 1)
    return [(EtherCatFPWR, dict(adp=1001, ado=0x1000), outputs(n), 1), read]


def frame(n, back, datagrams, wrap, source=None):
    stamp = struct.pack("<Q", int(time_ns[n])) if back else bytes(8)
    all = [(EtherCatFRMW, dict(adp=1001, ado=0x910), stamp, 1)] + datagrams(n, back)
    if n % 7 == 0:
        all.append((EtherCatBRD, dict(adp=1 if back else 0, ado=0x130), b"\x08\x00" if back else bytes(2), 1))
    answers = back and n not in SILENT
    parts = []
    for kind, where, data, counter in all:
        parts.append(kind(idx=n % 256, data=list(data), wkc=counter if answers else 0, **where))
    mac = source or (BACK if back else SENT)
    head = Ether(dst="ff:ff:ff:ff:ff:ff", src=mac)
    packet = head / EtherCat()
    for part in parts:
        packet = packet / part
    return wrap(bytes(packet), mac)


def plain(packet, mac):
    return packet


def tagged(packet, mac):
    return bytes(Ether(dst="ff:ff:ff:ff:ff:ff", src=mac, type=0x8100) / Dot1Q(vlan=5, type=0x88A4)) + packet[14:]


def in_udp(packet, mac):
    head = Ether(dst="ff:ff:ff:ff:ff:ff", src=mac) / IP(dst="10.0.0.255", src="10.0.0.1") / UDP(sport=34980, dport=34980)
    return bytes(head / packet[14:])


def cooked(packet, mac):
    address = bytes.fromhex(mac.replace(":", "")) + bytes(2)
    return struct.pack(">HHH", 1, 1, 6) + address + packet[12:]


def packets(datagrams, wrap, source=None):
    """All packets with their times, ns: some of them have nothing to do with EtherCAT."""
    for n in range(CYCLES):
        yield int(time_ns[n]), frame(n, False, datagrams, wrap, source)
        if n not in LOST:
            yield int(time_ns[n]) + 31_000, frame(n, True, datagrams, wrap, source)
        if n % 30 == 3:
            other = bytes(Ether(src=SENT, dst=BACK) / IP() / UDP(dport=53) / b"not ours at all")
            yield int(time_ns[n]) + 40_000, wrap(other, SENT) if wrap is cooked else other


def pcap(order, nano, link, all):
    magic, unit = (0xA1B23C4D, 1) if nano else (0xA1B2C3D4, 1000)
    out = struct.pack(order + "IHHiIII", magic, 2, 4, 0, 0, 65535, link)
    for at, data in all:
        seconds, rest = divmod(at, 10**9)
        out += struct.pack(order + "IIII", seconds, rest // unit, len(data), len(data)) + data
    return out


def block(order, kind, body):
    body += bytes(-len(body) % 4)
    length = struct.pack(order + "I", len(body) + 12)
    return struct.pack(order + "I", kind) + length + body + length


def pcapng(order, code, link, all):
    ticks = 2 ** (code & 0x7F) if code & 0x80 else 10**code
    option = lambda number, value: struct.pack(order + "HH", number, len(value)) + value + bytes(-len(value) % 4)
    out = block(order, 0x0A0D0D0A, struct.pack(order + "IHHq", 0x1A2B3C4D, 1, 0, -1) + option(4, b"a capture") + option(0, b""))
    for resolution in [6, code]:
        about = struct.pack(order + "HHI", link, 0, 0) + option(2, b"eth0") + option(9, bytes([resolution])) + option(0, b"")
        out += block(order, 1, about)
    out += block(order, 4, bytes(8)) + block(order, 0x0BAD, b"own block")
    for at, data in all:
        stamp = at * ticks // 10**9
        head = struct.pack(order + "IIIII", 1, stamp >> 32, stamp & 0xFFFFFFFF, len(data), len(data))
        out += block(order, 6, head + data + bytes(-len(data) % 4) + option(2, b"\0\0\0\1"))
    return out


def decoded(path, link, skip):
    """Times, ns, and datagrams of each frame that came back whole, by scapy."""
    if path.suffix == ".pcap":
        with RawPcapReader(str(path)) as reader:
            read = [(m.sec * 10**9 + m.usec * (1 if reader.nano else 1000), data) for data, m in reader]
    else:
        with RawPcapNgReader(str(path)) as reader:
            read = [(Fraction(((m.tshigh << 32) + m.tslow) * 10**9, m.tsresol), data) for data, m in reader]
    for at, data in read:
        inside = data[skip:]
        if b"not ours" in data:
            continue
        own = []
        part = EtherCat(inside).payload
        while part and part.name.startswith("EtherCat"):
            own.append(part)
            part = part.payload
        yield at, own


def write(name, content, datagrams, link=1, skip=14):
    path = folder / name
    path.write_bytes(content)
    signed = lambda data, at, size: int.from_bytes(bytes(data)[at:at + size], "little", signed=True)
    rows, sent = [], {}
    for at, parts in decoded(path, link, skip):
        own = [p for p in parts if p.name in DATA[datagrams]]
        if all(p.wkc == 0 for p in own):
            sent = {p.idx: p for p in own if p.name == DATA[datagrams][0]}
            continue
        out = bytes(sent[own[0].idx].data)
        reads = bytes(own[-1].data)
        reads = reads[6:] if datagrams is both else reads
        clock = next(p for p in parts if p.name == "EtherCatFRMW")
        rows.append((at, reads[0] | reads[1] << 8, signed(reads, 2, 4), signed(reads, 6, 2), reads[8] >> 5 & 1, out[0] | out[1] << 8,
                     signed(out, 2, 4), int.from_bytes(bytes(clock.data), "little")))
    assert len(rows) == CYCLES - len(LOST) - len(SILENT), (name, len(rows))
    truth = Truth(name)
    columns = list(zip(*rows))
    truth.column("time", [float(Fraction(at - columns[0][0]) / 10**9) for at in columns[0]])
    names = ["Statusword", "Position actual value", "Torque actual value", "flag", "Controlword", "Target position", "clock"]
    for key, values in zip(names, columns[1:]):
        truth.column(key, [float(v) for v in values])
    truth.write()


DATA = {
    both: ["EtherCatLRW"], shared: ["EtherCatLRW"], apart: ["EtherCatLWR", "EtherCatLRD"], station: ["EtherCatFPWR", "EtherCatFPRD"],
}
write("both_nano.pcapng", pcapng("<", 9, 1, packets(both, plain)), both)
write("both_two.pcapng", pcapng(">", 0x80 | 30, 1, packets(both, plain)), both)
write("both_micro.pcap", pcap("<", False, 1, packets(both, plain)), both)
write("both_big.pcap", pcap(">", True, 1, packets(both, plain)), both)
write("both_vlan.pcap", pcap("<", True, 1, packets(both, tagged)), both, skip=18)
write("both_udp.pcapng", pcapng("<", 6, 1, packets(both, in_udp)), both, skip=42)
write("both_cooked.pcap", pcap("<", True, 113, packets(both, cooked)), both, 113, 16)
write("both_unmarked.pcap", pcap("<", True, 1, packets(both, plain, SENT)), both)
write("both_always_marked.pcap", pcap("<", True, 1, packets(both, plain, BACK)), both)
write("shared.pcapng", pcapng("<", 9, 1, packets(shared, plain)), shared)
write("apart.pcapng", pcapng("<", 9, 1, packets(apart, plain)), apart)
write("station.pcapng", pcapng("<", 9, 1, packets(station, plain)), station)

all = list(packets(both, plain))
(folder / "sent.pcapx").write_bytes(pcap("<", True, 1, [p for p in all if p[1][6:12] == bytes.fromhex(SENT.replace(":", ""))]))
(folder / "cut.pcapx").write_bytes(pcap("<", True, 1, all)[:-20])
(folder / "other.pcapx").write_bytes(pcap("<", True, 127, all))
(folder / "small.pcapx").write_bytes(pcapng("<", 9, 1, all[:40]))


# Descriptions of the network and of the drive, as ETG.2100 and ETG.2000 lay them out.
ENTRIES = {
    "TxPdo": [("6041", 16, "Statusword", "UINT"), ("6064", 32, "Position actual value", "DINT"),
              ("6077", 16, "Torque actual value", "INT"), ("2001", 8, "Flags", "USINT")],
    "RxPdo": [("6040", 16, "Controlword", "UINT"), ("607a", 32, "Target position", "DINT")],
}


def pdos(kind, index, manager):
    entry = "<Entry><Index>#x{}</Index><SubIndex>0</SubIndex><BitLen>{}</BitLen><Name>{}</Name><DataType>{}</DataType></Entry>"
    entries = "".join(entry.format(*own) for own in ENTRIES[kind])
    spare = f"<{kind} Fixed='1'><Index>#x{index + 1:x}</Index><Name>spare</Name>{entries}</{kind}>"
    return f"<{kind} Fixed='1' Sm='{manager}'><Index>#x{index:x}</Index><Name>usual</Name>{entries}</{kind}>{spare}"


def network(image):
    """A digital input in front of the drive, whose process data begins with byte 2 of the outputs and 4 of the inputs."""
    slave = f"""<Slave><Info><Name>Term 1 (EK1100)</Name><PhysAddr>1000</PhysAddr></Info></Slave>
<Slave><Info><Name>Drive 2 (X)</Name><PhysAddr>1001</PhysAddr></Info><ProcessData>
<Send><BitStart>16</BitStart><BitLength>48</BitLength></Send><Recv><BitStart>32</BitStart><BitLength>72</BitLength></Recv>
{pdos("RxPdo", 0x1600, 2)}{pdos("TxPdo", 0x1A00, 3)}</ProcessData></Slave>"""
    command = "<Cmd><State>OP</State><Cmd>{}</Cmd><Addr>{}</Addr><DataLength>{}</DataLength><Cnt>1</Cnt><{}>{}</{}></Cmd>"
    commands = command.format(11, LOGICAL, 6, "OutputOffs", 2, "OutputOffs")
    commands += command.format(10, LOGICAL + 0x800, 9, "InputOffs", 4, "InputOffs")
    commands += "<Cmd><Cmd>7</Cmd><Adp>0</Adp><Ado>#x0130</Ado><DataLength>2</DataLength></Cmd>"
    variable = "<Variable><Name>{}</Name><DataType>{}</DataType><BitSize>{}</BitSize><BitOffs>{}</BitOffs></Variable>"

    def variables(kind, bit, group):
        out = ""
        for _, bits, name, of in ENTRIES[kind]:
            out += variable.format(f"Drive 2 (X).{group}.{name}", of, bits, bit)
            bit += bits
        return out

    inputs = variable.format("Term 1 (EK1100).Channel 1.Input", "BOOL", 1, 0) + variables("TxPdo", 32, "Inputs")
    images = f"<ProcessImage><Inputs>{inputs}</Inputs><Outputs>{variables('RxPdo', 16, 'Outputs')}</Outputs></ProcessImage>"
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<EtherCATConfig Version="1.3"><Config><Master><Info><Name>Master</Name></Info></Master>{slave}
<Cyclic><CycleTime>1000</CycleTime><Frame>{commands}</Frame></Cyclic>{images if image else ""}</Config></EtherCATConfig>
"""


device = f"""<?xml version="1.0"?>
<EtherCATInfo><Vendor><Id>1</Id></Vendor><Descriptions><Devices><Device Physics="YY"><Type>Drive</Type>
{pdos("RxPdo", 0x1600, 2)}{pdos("TxPdo", 0x1A00, 3)}</Device></Devices></Descriptions></EtherCATInfo>
"""
for name, kind, text in [
    ("eni_image", "apart", network(True)), ("eni_slaves", "apart", network(False)),
    ("esi_apart", "apart", device), ("esi_both", "both_nano", device), ("esi_shared", "shared", device),
    ("esi_station", "station", device), ("damaged", "apart", device[:400]),
]:
    (folder / name).mkdir()
    (folder / name / "log.pcapng").write_bytes((folder / f"{kind}.pcapng").read_bytes())
    (folder / name / "about.xml").write_text(text)
