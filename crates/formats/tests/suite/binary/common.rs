//! What the tests of the binary readers share: files written by Python, and their truth.

// Not every test uses all of it.
#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::Command;

use stiction_formats::Table;

/// The Python of the project, with NumPy, SciPy, h5py, pyarrow and pandas.
fn python() -> PathBuf {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let python = std::env::var_os("STICTION_PYTHON")
        .map_or_else(|| workspace.join(".venv/bin/python"), PathBuf::from);
    assert!(
        python.exists(),
        "{} is missing: run `cargo xtask setup`",
        python.display()
    );
    python
}

/// Runs a script of `tests/python`; the folder holds what it wrote until it is dropped.
pub fn written(script: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    let status = Command::new(python())
        .arg(scripts.join(script))
        .arg(folder.path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .status()
        .unwrap();
    assert!(status.success(), "{script} failed");
    folder
}

/// The recordings in a folder that the script wrote, in the order of their names.
pub fn recordings(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end != "truth"))
        .collect();
    paths.sort();
    paths
}

/// What a reader must find in a file.
#[derive(Debug, Default, PartialEq)]
pub struct Truth {
    /// Names of the columns, and their samples as bits.
    pub columns: Vec<(String, Vec<u64>)>,
    /// Names of the scalars, and their bits.
    pub scalars: Vec<(String, u64)>,
    /// Names of what is left out.
    pub skipped: Vec<String>,
}

impl Truth {
    /// The truth that stands beside a recording; `None` for a file that must be refused.
    pub fn beside(recording: &Path) -> Option<Self> {
        let name = format!("{}.truth", recording.display());
        let bytes = std::fs::read(name).ok()?;
        let mut truth = Self::default();
        let mut rest = &bytes[..];
        while !rest.is_empty() {
            let kind = u32::from_le_bytes(take(&mut rest, 4).try_into().unwrap());
            let length = u32::from_le_bytes(take(&mut rest, 4).try_into().unwrap());
            let name = String::from_utf8(take(&mut rest, length as usize).to_vec()).unwrap();
            let count = u64::from_le_bytes(take(&mut rest, 8).try_into().unwrap());
            let samples: Vec<u64> = take(&mut rest, 8 * count as usize)
                .as_chunks::<8>()
                .0
                .iter()
                .map(|&chunk| u64::from_le_bytes(chunk))
                .collect();
            match kind {
                0 => truth.columns.push((name, samples)),
                1 => truth.scalars.push((name, samples[0])),
                _ => truth.skipped.push(name),
            }
        }
        Some(truth)
    }

    /// The same of what a reader found.
    pub fn of(table: &Table) -> Self {
        let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect();
        Self {
            columns: table
                .columns
                .iter()
                .map(|column| (column.name.clone(), bits(&column.values)))
                .collect(),
            scalars: table
                .scalars
                .iter()
                .map(|scalar| (scalar.name.clone(), scalar.value.to_bits()))
                .collect(),
            skipped: table
                .skipped
                .iter()
                .map(|note| note.split_once(": ").unwrap().0.to_owned())
                .collect(),
        }
    }
}

fn take<'a>(rest: &mut &'a [u8], bytes: usize) -> &'a [u8] {
    let (now, later) = rest.split_at(bytes);
    *rest = later;
    now
}
