//! Data sets of LeRobot of which a file is damaged.

use std::cell::Cell;

use proptest::collection::vec;

use super::binary_common::written;
use super::{damage, read, runner};

/// Files of a small data set, of which one is damaged at a time: what it holds, and an episode.
const FILES: [&str; 2] = ["meta/info.json", "data/chunk-000/file-000.parquet"];

/// Reads the data set as a whole and the damaged file alone; counts refusals of the whole.
pub fn hostile() {
    let folder = written("write_lerobot.py");
    let root = folder.path().join("v30");
    assert!(read(&root).is_ok());
    let (refused, all) = (Cell::new(0), Cell::new(0));
    for name in FILES {
        let path = root.join(name);
        let whole = std::fs::read(&path).unwrap();
        runner(150)
            .run(&vec(damage(), 1..4), |damages| {
                let mut bytes = whole.clone();
                damages.iter().for_each(|damage| damage.apply(&mut bytes));
                std::fs::write(&path, bytes).unwrap();
                let _ = read(&path);
                refused.set(refused.get() + u32::from(read(&root).is_err()));
                all.set(all.get() + 1);
                Ok(())
            })
            .unwrap();
        std::fs::write(&path, whole).unwrap();
    }
    assert!(refused.get() > 0);
    let (some, all) = (refused.get(), all.get());
    eprintln!("{some} of {all} damaged data sets refused");
}
