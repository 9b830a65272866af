//! SVB files that are broken: what is said of them.

use super::common::written;
use stiction_formats::{ReadOptions, read_table};

#[test]
fn what_is_broken_is_named() {
    let folder = written("write_svb.py");
    let whole = std::fs::read(folder.path().join("no_times.svb")).unwrap();
    let length = u64::from_le_bytes(*whole.first_chunk().unwrap()) as usize;
    let place = |number: u64| {
        let bytes = number.to_le_bytes();
        whole.windows(8).position(|part| part == bytes).unwrap()
    };
    let with = |at: usize, number: u64| {
        let mut bytes = whole.clone();
        bytes[at..at + 8].copy_from_slice(&number.to_le_bytes());
        bytes
    };
    // Samples, bytes of the data, start of the data.
    let samples = place(400);
    let files = [
        whole[..whole.len() - 1].to_vec(),
        whole[..length].to_vec(),
        whole[..length - 30].to_vec(),
        with(samples, 399),
        with(samples, u64::MAX / 2),
        with(samples + 16, u64::MAX - 7),
        // The header of the first channel ends before or beyond what stands in it.
        with(12 + "YT Scope Project \u{e4}".len() + 20, 9),
        with(12 + "YT Scope Project \u{e4}".len() + 20, 1 << 40),
    ];
    let mut said = Vec::new();
    for bytes in files {
        let path = folder.path().join("broken");
        std::fs::write(&path, bytes).unwrap();
        said.push(match read_table(&path, &ReadOptions::default()) {
            Err(error) => error
                .to_string()
                .replace(&format!("{}: ", path.display()), ""),
            Ok(table) => format!("read: {:?}", table.detected),
        });
    }
    insta::assert_snapshot!(said.join("\n"));
}
