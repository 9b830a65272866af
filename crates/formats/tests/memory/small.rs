//! Small files that ask for much: memory or work that grows faster than they do.

use std::path::Path;
use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};
use stiction_formats::Kind;

use super::binary_common::{recordings, written};
use super::{MEMORY_BOUND, SAMPLES, read, read_within};

pub fn hostile(path: &Path) {
    hdf5();
    objects(path);
    chunks(path);
    definitions(path);
    keys(path);
}

/// Whatever is allowed, the file itself bounds what is unpacked. The other column is read.
fn hdf5() {
    let folder = written("write_evil_hdf5.py");
    for file in recordings(folder.path()) {
        let name = file.file_name().unwrap().to_str().unwrap();
        let result = read_within(&file, SAMPLES << 10, MEMORY_BOUND);
        match result {
            Ok(table) => {
                assert!(!name.starts_with("refused"), "{name}");
                let columns: Vec<_> = table.columns.iter().map(|c| c.name.as_str()).collect();
                assert_eq!(columns, ["a"], "{name}");
                assert!(table.skipped[0].starts_with("x: "), "{:?}", table.skipped);
            }
            Err(error) => assert!(name.starts_with("refused"), "{error}"),
        }
    }
}

/// What a reader of objects holds counts, whether it is a sample or not.
fn objects(path: &Path) {
    let refused = |text: String| {
        std::fs::write(path, text).unwrap();
        let error = read_within(path, SAMPLES, MEMORY_BOUND).unwrap_err();
        assert_eq!(error.kind, Kind::Limit, "{error}");
    };
    // A list that stands in the last record alone has a length in every one.
    let lists: Vec<_> = (0..2000).map(|k| format!("\"k{k}\":[]")).collect();
    let empty = "{}\n".repeat(4000);
    refused(format!("{{\"t\":0}}\n{empty}{{{}}}", lists.join(",")));
    // Every name has those of all the objects around it.
    let deep = format!("{{\"{}\":", "k".repeat(4000)).repeat(30);
    let leaves: Vec<_> = (0..3000).map(|k| format!("\"k{k}\":1")).collect();
    refused(format!("{deep}{{{}}}{}", leaves.join(","), "}".repeat(30)));
}

/// A record of MCAP.
fn record(kind: u8, content: &[u8]) -> Vec<u8> {
    let length = (content.len() as u64).to_le_bytes();
    [&[kind], &length[..], content].concat()
}

fn text(text: &str) -> Vec<u8> {
    let length = (text.len() as u32).to_le_bytes();
    [&length[..], text.as_bytes()].concat()
}

/// A recording with these records.
fn mcap(path: &Path, records: &[Vec<u8>]) {
    let end = record(15, &[0; 4]);
    let all = [b"\x89MCAP0\r\n", &records.concat()[..], &end].concat();
    std::fs::write(path, all).unwrap();
}

/// A chunk of 33 kB that unpacks to a gigabyte of records without content.
fn chunks(path: &Path) {
    const BLOCK: u32 = 1 << 17;
    const BLOCKS: u32 = 1 << 13;
    // A frame of Zstandard with a window of a block, and blocks that repeat one byte.
    let mut packed = vec![0x28, 0xb5, 0x2f, 0xfd, 0, 7 << 3];
    for block in 1..=BLOCKS {
        let head = BLOCK << 3 | 1 << 1 | u32::from(block == BLOCKS);
        packed.extend_from_slice(&head.to_le_bytes()[..3]);
        packed.push(0);
    }
    let size = u64::from(BLOCK) * u64::from(BLOCKS);
    let content = [
        &[0; 16][..],
        &size.to_le_bytes(),
        &[0; 4],
        &text("zstd"),
        &(packed.len() as u64).to_le_bytes(),
        &packed,
    ];
    mcap(path, &[record(6, &content.concat())]);
    let error = read(path).unwrap_err();
    assert_eq!(error.kind, Kind::Limit, "{error}");
}

/// Definitions within definitions: as many ways to the last as there are grains of sand, and a list of nothing without end.
fn definitions(path: &Path) {
    let inner = |k: usize| format!("a/T{} f\n", k + 1).repeat(100);
    let mut nested = inner(0);
    for k in 1..15 {
        nested += &format!("===\nMSG: a/T{k}\n{}", inner(k));
    }
    nested += "===\nMSG: a/T15\nuint8 x\n";
    let endless = "a/T1[4000000000] f\n===\nMSG: a/T1\nuint8[0] x\n";
    for definition in [&nested, endless] {
        let schema = [
            &[1, 0][..],
            &text("a/T0"),
            &text("ros2msg"),
            &text(definition),
        ];
        let channel = [&[1, 0, 1, 0][..], &text("/t"), &text("cdr"), &[0; 4]];
        let message = [&[1, 0][..], &[0; 20], &[0, 1, 0, 0], &[0; 60]];
        let records = [
            (3, schema.concat()),
            (4, channel.concat()),
            (5, message.concat()),
        ];
        mcap(path, &records.map(|(kind, content)| record(kind, &content)));
        let error = read_within(path, 8 * SAMPLES, MEMORY_BOUND).unwrap_err();
        assert_eq!(error.kind, Kind::Format, "{error}");
    }
}

/// Keys in another order than before are found without a look at each of the others.
fn keys(path: &Path) {
    let took = |count: usize| {
        let object = |keys: &mut dyn Iterator<Item = usize>| {
            let pairs: Vec<_> = keys.map(|k| format!("\"k{k}\":{k}")).collect();
            format!("{{{}}}\n", pairs.join(","))
        };
        let there = object(&mut (0..count));
        std::fs::write(path, there + &object(&mut (0..count).rev())).unwrap();
        let once = || {
            let begun = spent();
            let table = read_within(path, 64 * SAMPLES, 8 * MEMORY_BOUND).unwrap();
            assert_eq!(table.columns.len(), count);
            spent() - begun
        };
        (0..5).map(|_| once()).min().unwrap()
    };
    let (few, many) = (took(1000), took(16_000));
    // 16 times the keys: 256 times the pairs of them.
    assert!(many < 64 * few, "{few:?} for a sixteenth, {many:?} for all");
}

/// Time of the processor, which a machine that is busy elsewhere does not lengthen.
fn spent() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::try_from(time).expect("time goes on")
}
