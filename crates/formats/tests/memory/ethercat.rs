//! Damaged captures of EtherCAT, read with a map.

use std::cell::Cell;
use std::path::Path;

use proptest::collection::vec;
use stiction_formats::ethercat::{Address, Direction, Entry, ProcessData, Type};
use stiction_formats::{Limits, ReadOptions, read_table};

use super::binary_common::written;
use super::{MEMORY, MEMORY_BOUND, SAMPLES, damage, runner};

/// Entries at the ends of the datagrams, by address and without.
fn map() -> ProcessData {
    let entry = |name: &str, address, byte, bit, kind, direction| Entry {
        name: name.to_owned(),
        unit: None,
        address,
        byte,
        bit,
        kind,
        direction,
    };
    let logical = Some(Address::Logical(0x10000));
    let entries = vec![
        entry("a", logical, 8, 0, Type::I32, Direction::In),
        entry("b", logical, 5, 7, Type::U64, Direction::In),
        entry("c", logical, 0, 0, Type::F32, Direction::Out),
        entry("d", None, 14, 7, Type::Bool, Direction::In),
    ];
    ProcessData { entries }
}

/// Reads captures of both forms, damaged, with a map and without.
pub fn hostile(scratch: &Path) {
    let folder = written("write_ethercat.py");
    let options = |ethercat| ReadOptions {
        ethercat,
        limits: Limits {
            memory: SAMPLES * 24,
        },
        ..ReadOptions::default()
    };
    let (mapped, bare) = (options(map()), options(ProcessData::default()));
    let (refused, all) = (Cell::new(0), Cell::new(0));
    for name in [
        "small.pcapx",
        "both_two.pcapng",
        "both_big.pcap",
        "both_cooked.pcap",
        "both_udp.pcapng",
    ] {
        let whole = std::fs::read(folder.path().join(name)).unwrap();
        runner(200)
            .run(&vec(damage(), 1..6), |damages| {
                let mut bytes = whole.clone();
                damages.iter().for_each(|damage| damage.apply(&mut bytes));
                std::fs::write(scratch, bytes).unwrap();
                for options in [&mapped, &bare] {
                    let before = MEMORY.current_usage();
                    MEMORY.reset_peak_usage();
                    let result = read_table(scratch, options);
                    let used = MEMORY.peak_usage().saturating_sub(before);
                    assert!(used <= MEMORY_BOUND, "{used} bytes");
                    refused.set(refused.get() + u32::from(result.is_err()));
                    all.set(all.get() + 1);
                }
                Ok(())
            })
            .unwrap();
    }
    // Without a map all are; with it those that are damaged in the frames alone are read.
    let (some, all) = (refused.get(), all.get());
    assert!(some < all && some >= all / 2, "{some} of {all}");
    eprintln!("{some} of {all} readings of damaged captures refused");
}
