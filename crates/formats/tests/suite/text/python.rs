//! Logs that Python, NumPy and pandas wrote come back bit for bit.

use std::path::{Path, PathBuf};
use std::process::Command;
use stiction_formats::Table;
use stiction_formats::text::{TextOptions, read_file};

fn python() -> PathBuf {
    let local = concat!(env!("CARGO_MANIFEST_DIR"), "/../../.venv/bin/python");
    let path = std::env::var_os("STICTION_PYTHON").map_or(PathBuf::from(local), PathBuf::from);
    assert!(
        path.exists(),
        "{} is missing: run `cargo xtask setup`",
        path.display()
    );
    path
}

fn columns_of(path: &Path) -> Vec<Vec<f64>> {
    let bytes = std::fs::read(path).unwrap();
    let count = usize::from(bytes[0]);
    let values: Vec<f64> = bytes[1..]
        .chunks_exact(8)
        .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
        .collect();
    let rows = values.len() / count;
    values.chunks(rows).map(<[f64]>::to_vec).collect()
}

fn bits(values: &[f64]) -> Vec<u64> {
    // A missing value has no payload in a text.
    values
        .iter()
        .map(|v| {
            if v.is_nan() {
                f64::NAN.to_bits()
            } else {
                v.to_bits()
            }
        })
        .collect()
}

#[test]
fn what_python_wrote_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/python/write_text.py");
    let run = Command::new(python())
        .arg(script)
        .arg(folder.path())
        .output()
        .unwrap();
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let mut logs: Vec<PathBuf> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e != "bin"))
        .collect();
    logs.sort();
    assert!(logs.len() >= 12, "{logs:?}");
    for log in &logs {
        let truth = columns_of(&log.with_extension("bin"));
        let table: Table =
            read_file(log, &TextOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(table.columns.len(), truth.len(), "{}", log.display());
        for (column, truth) in table.columns.iter().zip(&truth) {
            let (found, truth) = (bits(&column.values), bits(truth));
            assert_eq!(found.len(), truth.len(), "{}", log.display());
            let differs = found.iter().zip(&truth).position(|(a, b)| a != b);
            assert_eq!(differs, None, "{} column {}", log.display(), column.name);
        }
    }
}
