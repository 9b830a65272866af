//! Files of MDF 4 that lead to more than they hold: shared, looped, packed, claimed.

use std::io::Write;
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use stiction_formats::{Kind, Limits, ReadOptions, read_wanted};

use super::{SAMPLES, read};

/// A file in the making.
struct File {
    bytes: Vec<u8>,
}

/// The block that all groups are linked from.
const HEADER: u64 = 64;
/// Data types of channels.
const UNSIGNED: u8 = 0;

impl File {
    fn new() -> Self {
        let mut bytes = b"MDF     4.10    by hand \0\0\0\0\x9a\x01".to_vec();
        bytes.resize(64, 0);
        let mut file = Self { bytes };
        file.block(b"HD", &[0; 6], &[0; 32]);
        file
    }

    fn block(&mut self, mark: &[u8; 2], links: &[u64], data: &[u8]) -> u64 {
        let at = self.bytes.len() as u64;
        let length = 24 + 8 * links.len() + data.len();
        self.bytes.extend([b"##", &mark[..], &[0; 4]].concat());
        for number in [length as u64, links.len() as u64].iter().chain(links) {
            self.bytes.extend(number.to_le_bytes());
        }
        self.bytes.extend(data);
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        at
    }

    fn link(&mut self, block: u64, number: usize, to: u64) {
        let at = block as usize + 24 + 8 * number;
        self.bytes[at..at + 8].copy_from_slice(&to.to_le_bytes());
    }

    /// Makes each of some blocks lead to the next; the first.
    fn chain(&mut self, blocks: &[u64]) -> u64 {
        for pair in blocks.windows(2) {
            self.link(pair[0], 0, pair[1]);
        }
        blocks[0]
    }

    /// An integer of a byte at the beginning of its records; of kind 3 the count of records.
    fn channel(&mut self, kind: u8, name: u64) -> u64 {
        let mut data = [0; 72];
        data[..3].copy_from_slice(&[kind, 0, UNSIGNED]);
        data[8] = 8;
        self.block(b"CN", &[0, 0, name, 0, 0, 0, 0, 0], &data)
    }

    fn group(&mut self, channel: u64, records: u64, id: u8) -> u64 {
        let mut data = [0; 32];
        data[0] = id;
        data[8..16].copy_from_slice(&records.to_le_bytes());
        data[24] = 1;
        self.block(b"CG", &[0, channel, 0, 0, 0, 0], &data)
    }

    fn data_group(&mut self, group: u64, data: u64, id_bytes: u8) -> u64 {
        let flags = [id_bytes, 0, 0, 0, 0, 0, 0, 0];
        self.block(b"DG", &[0, group, data, 0], &flags)
    }

    /// Packed zeros or other bytes, so many times, said to be of a length; turned where `row` is not 0.
    fn packed(&mut self, bytes: &[u8], times: usize, length: u64, row: u32) -> u64 {
        let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
        for _ in 0..times {
            packer.write_all(bytes).unwrap();
        }
        let packed = packer.finish().unwrap();
        let mut data = b"DT\0\0".to_vec();
        data[2] = u8::from(row > 0);
        data.extend(row.to_le_bytes());
        data.extend(length.to_le_bytes());
        data.extend((packed.len() as u64).to_le_bytes());
        data.extend(packed);
        self.block(b"DZ", &[], &data)
    }

    fn list(&mut self, blocks: &[u64]) -> u64 {
        let mut data = [0; 16];
        data[4..8].copy_from_slice(&(blocks.len() as u32).to_le_bytes());
        let links = [&[0], blocks].concat();
        self.block(b"DL", &links, &data)
    }

    /// With its first data group.
    fn write(mut self, path: &Path, first: u64) {
        self.link(HEADER, 0, first);
        std::fs::write(path, self.bytes).unwrap();
    }

    /// One group, one channel of a kind, these records and data.
    fn simple(mut self, path: &Path, kind: u8, records: u64, data: u64) {
        let channel = self.channel(kind, 0);
        let group = self.group(channel, records, 0);
        let first = self.data_group(group, data, 0);
        self.write(path, first);
    }
}

const MANY: usize = 300;
const MIB: u64 = 1 << 20;

pub fn hostile(path: &Path) {
    let refused = |kind: Kind, word: &str| {
        let error = read(path).unwrap_err();
        assert_eq!(error.kind, kind, "{error}");
        assert!(error.to_string().contains(word), "{error}");
    };
    shared(path);
    refused(Kind::Format, "linked twice");
    shared_channels(path);
    refused(Kind::Format, "linked twice");

    // A list that names one block of 64 MiB again and again.
    let mut file = File::new();
    let zeros = vec![0; MIB as usize];
    let packed = file.packed(&zeros, 64, 64 * MIB, 0);
    let list = file.list(&[packed; 64]);
    file.simple(path, 0, 64 * 64 * MIB, list);
    refused(Kind::Limit, "--max-memory");
    let mut file = File::new();
    let packed = file.packed(&zeros, 64, 64 * MIB, 0);
    let list = file.list(&[packed; 64]);
    file.simple(path, 0, 10, list);
    refused(Kind::Format, "linked twice");

    // Records of two bytes that unpack to 64 MiB, of which the group has few.
    let mut file = File::new();
    let records = [7, 1].repeat(MIB as usize / 2);
    let packed = file.packed(&records, 64, 64 * MIB, 0);
    let channel = file.channel(0, 0);
    let group = file.group(channel, 50, 7);
    let first = file.data_group(group, packed, 1);
    file.write(path, first);
    let table = read(path).unwrap();
    assert_eq!(table.columns[0].values, [1.0; 50]);
    assert!(table.detected.iter().any(|line| line.contains("beyond")));

    claimed(path);
    looped(path);
    valid(path);
    refused(Kind::Missing, "more channels than");

    // Names of 4 kB that thousands of channels share.
    let mut file = File::new();
    let name = file.block(b"TX", &[], &[b'n'; 4000]);
    let channels: Vec<u64> = (0..5000).map(|_| file.channel(0, name)).collect();
    let channel = file.chain(&channels);
    let group = file.group(channel, 1, 0);
    let data = file.block(b"DT", &[], &[1]);
    let first = file.data_group(group, data, 0);
    file.write(path, first);
    refused(Kind::Limit, "--max-memory");
}

/// Groups that share groups, which share channels.
fn shared(path: &Path) {
    let mut file = File::new();
    let channels: Vec<u64> = (0..MANY).map(|_| file.channel(0, 0)).collect();
    let channel = file.chain(&channels);
    let groups: Vec<u64> = (0..MANY).map(|_| file.group(channel, 1, 0)).collect();
    let group = file.chain(&groups);
    let all: Vec<u64> = (0..MANY).map(|_| file.data_group(group, 0, 0)).collect();
    let first = file.chain(&all);
    file.write(path, first);
}

/// 1000 groups that share 2000 channels.
fn shared_channels(path: &Path) {
    let mut file = File::new();
    let channels: Vec<u64> = (0..2000).map(|_| file.channel(0, 0)).collect();
    let channel = file.chain(&channels);
    let groups: Vec<u64> = (0..1000).map(|_| file.group(channel, 1, 0)).collect();
    let group = file.chain(&groups);
    let first = file.data_group(group, 0, 0);
    file.write(path, first);
}

/// Records and bytes that a file only claims, also where nobody asks for the column.
fn claimed(path: &Path) {
    let options = ReadOptions {
        limits: Limits {
            memory: SAMPLES * 24,
        },
        ..ReadOptions::default()
    };
    let nobody = |heads: &stiction_formats::Table| vec![false; heads.columns.len()];
    for (kind, records, length, row, whole, none) in [
        (0, 1 << 50, 1 << 50, 0, Kind::Limit, Kind::Format),
        (0, 1000, 1 << 50, 0, Kind::Format, Kind::Format),
        (0, 1 << 50, 8, 0, Kind::Limit, Kind::Format),
        (0, 1000, 1 << 40, 4, Kind::Limit, Kind::Limit),
        (0, 1000, u64::MAX, 1, Kind::Limit, Kind::Limit),
        (3, 1 << 50, 8, 0, Kind::Limit, Kind::Limit),
    ] {
        let mut file = File::new();
        let data = file.packed(&[1; 100], 1, length, row);
        file.simple(path, kind, records, data);
        let error = read(path).unwrap_err();
        assert_eq!(error.kind, whole, "{error}");
        let error = read_wanted(path, &options, |_| {}, &nobody).unwrap_err();
        assert_eq!(error.kind, none, "{error}");
    }
}

/// Bits for every record that are said and not stored, 64 GB of them; then 1000 channels of one byte.
fn valid(path: &Path) {
    let mut file = File::new();
    let channel = file.channel(0, 0);
    let group = file.group(channel, 1 << 16, 0);
    let at = group as usize + 72 + 28;
    file.bytes[at..at + 4].copy_from_slice(&((1u32 << 20) - 1).to_le_bytes());
    let data = file.block(b"DV", &[], &[1; 1 << 16]);
    let mut flags = [0; 16];
    flags[3..5].copy_from_slice(&[0x80, 1]);
    let list = file.block(b"LD", &[0, data, 0], &flags);
    let first = file.data_group(group, list, 0);
    file.write(path, first);
    assert_eq!(read(path).unwrap().columns[0].values, [1.0; 1 << 16]);

    let mut file = File::new();
    let channels: Vec<u64> = (0..1000).map(|_| file.channel(0, 0)).collect();
    let channel = file.chain(&channels);
    let group = file.group(channel, 1, 0);
    let data = file.block(b"DT", &[], &[1]);
    let first = file.data_group(group, data, 0);
    file.write(path, first);
}

/// Blocks that lead to themselves, and one that lies in another.
fn looped(path: &Path) {
    let refused = || {
        let error = read(path).unwrap_err();
        assert!(error.to_string().contains("linked twice"), "{error}");
    };
    for kind in [b"DG", b"CG", b"CN"] {
        let mut file = File::new();
        let channel = file.channel(0, 0);
        let group = file.group(channel, 1, 0);
        let first = file.data_group(group, 0, 0);
        let block = match kind {
            b"DG" => first,
            b"CG" => group,
            _ => channel,
        };
        file.link(block, 0, block);
        file.write(path, first);
        refused();
    }
    let mut file = File::new();
    let list = file.list(&[]);
    file.link(list, 0, list);
    file.simple(path, 0, 1, list);
    refused();

    let mut file = File::new();
    let mut inner = File { bytes: Vec::new() };
    inner.block(b"DT", &[], &[1; 8]);
    let outer = file.block(b"DT", &[], &inner.bytes);
    let list = file.list(&[outer, outer + 24]);
    file.simple(path, 0, 1, list);
    refused();
}

/// Every byte of small files changed, in two ways; how many are refused, of how many.
pub fn every_byte(folder: &Path, scratch: &Path) -> (u32, u32) {
    let (mut refused, mut all) = (0, 0);
    for name in ["small_420.mf4", "mixed.mf4", "apart.mf4"] {
        let whole = std::fs::read(folder.join(name)).unwrap();
        for (at, change) in (0..whole.len()).flat_map(|at| [(at, 0xff), (at, 1)]) {
            let mut bytes = whole.clone();
            bytes[at] ^= change;
            std::fs::write(scratch, bytes).unwrap();
            refused += u32::from(read(scratch).is_err());
            all += 1;
        }
    }
    (refused, all)
}
