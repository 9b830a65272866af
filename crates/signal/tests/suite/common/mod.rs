//! Reference values of scipy and numpy, made afresh by the project's Python for each test.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// One comparison: input and expected output by name.
pub struct Case(Value);

/// The cases of one topic of `tests/scipy/make_reference.py`.
pub fn reference(topic: &str) -> Vec<Case> {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let python = std::env::var_os("STICTION_PYTHON").map_or_else(
        || crate_folder.join("../../.venv/bin/python"),
        PathBuf::from,
    );
    assert!(
        python.exists(),
        "{} is missing: run `cargo xtask setup`",
        python.display()
    );
    let script = crate_folder.join("tests/scipy/make_reference.py");
    let output = Command::new(&python)
        .arg(script)
        .arg(topic)
        .output()
        .expect("Python starts");
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "{topic}: run `cargo xtask setup`? {complaint}"
    );
    let cases: Vec<Value> = serde_json::from_slice(&output.stdout).expect("JSON from the script");
    assert!(!cases.is_empty());
    cases.into_iter().map(Case).collect()
}

#[allow(dead_code)] // Each test file uses some of these.
impl Case {
    pub fn signal(&self, name: &str) -> Vec<f64> {
        let bits = self.0[name]
            .as_array()
            .unwrap_or_else(|| panic!("array {name}"));
        bits.iter()
            .map(|bits| f64::from_bits(bits.as_u64().expect("64 bits")))
            .collect()
    }

    pub fn number(&self, name: &str) -> f64 {
        self.0[name]
            .as_f64()
            .unwrap_or_else(|| panic!("number {name}"))
    }

    pub fn count(&self, name: &str) -> usize {
        self.0[name]
            .as_u64()
            .unwrap_or_else(|| panic!("count {name}")) as usize
    }

    pub fn text(&self, name: &str) -> &str {
        self.0[name]
            .as_str()
            .unwrap_or_else(|| panic!("text {name}"))
    }
}

/// Largest difference as a part of `scale`, the largest value of the signal concerned.
#[allow(dead_code)]
pub fn error(found: &[f64], expected: &[f64], scale: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    // Not f64::max: it would drop a NaN.
    let larger = |most: f64, value: f64| {
        if value.abs() <= most {
            most
        } else {
            value.abs()
        }
    };
    let difference = found
        .iter()
        .zip(expected)
        .map(|(f, e)| f - e)
        .fold(0.0, larger);
    difference / scale.iter().copied().fold(f64::MIN_POSITIVE, larger)
}
