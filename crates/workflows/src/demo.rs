//! The demo: a known axis, a realistic log of it, its identification, and the truth beside it.

mod axis;
mod planned;
mod procedures;

use crate::error::Error;
use crate::identify::{self, Files, Options, Outcome};
use axis::{AXIS, csv, simulate};
pub use planned::{PLANNED, planned};
pub use procedures::procedures;
use std::path::{Path, PathBuf};
use stiction_files::{Kept, write_atomic, write_keeping};
use stiction_identify::Observer;
use stiction_servo::known::{self, KnownAxis};

/// Name of the log that the demo writes.
pub const LOG: &str = "demo.csv";
/// Simulates the axis, writes its log into `dir`, and identifies it from that file. Another file that had the name of the log
/// is kept.
///
/// # Errors
/// When the folder cannot be written.
pub fn demo(
    dir: impl AsRef<Path>,
    seed: u64,
    observer: &mut dyn Observer,
) -> Result<(Outcome, Option<Kept>), Error> {
    let dir = dir.as_ref();
    let axis = known::find(AXIS).expect("the demo axis is in the library");
    std::fs::create_dir_all(dir).map_err(|e| stiction_files::Error::output(dir, e.to_string()))?;
    let log: PathBuf = dir.join(LOG);
    let kept = write_keeping(&log, text(seed).as_bytes())?;
    let files = Files {
        logs: vec![log],
        ..Files::default()
    };
    let options = Options {
        seed,
        ..Options::default()
    };
    let mut outcome = identify::identify(&files, &options, observer)?;
    outcome.result.axis.name = Some("a simulated machine axis".into());
    outcome.truth = truth(&axis);
    Ok((outcome, kept))
}

/// Whether a folder holds the log of a demo and nothing else: one that was ended before its result.
pub fn is_begun(dir: &Path) -> bool {
    let names = std::fs::read_dir(dir).into_iter().flatten().flatten();
    let names: Vec<_> = names.map(|entry| entry.file_name()).collect();
    names.len() == 1 && names[0] == LOG
}

/// Simulates the axis of the demo, 9 s at 4 kHz in closed loop, and writes its log to a file: time, reference and position
/// in whole encoder steps, force with noise. The seed is that of the noise.
///
/// # Errors
/// When the file cannot be written.
pub fn write_log(file: impl AsRef<Path>, seed: u64) -> Result<(), Error> {
    Ok(write_atomic(file.as_ref(), text(seed).as_bytes())?)
}

/// The log as text.
fn text(seed: u64) -> String {
    let axis = known::find(AXIS).expect("the demo axis is in the library");
    let record = simulate(&axis, seed).expect("the demo settings are valid");
    csv(&record)
}

/// Names and values of the parameters of the axis that the demo simulates.
pub fn truth_of_demo() -> Vec<(String, f64)> {
    known::find(AXIS).map_or_else(Vec::new, |axis| truth(&axis))
}

fn truth(axis: &KnownAxis) -> Vec<(String, f64)> {
    let law = &axis.law;
    let side = law.curve().positive();
    [
        ("sigma0", law.stiffness()),
        ("sigma1", law.damping().at_rest()),
        ("sigma2", side.viscous),
        ("coulomb", side.coulomb),
        ("static", side.static_friction),
        ("stribeck_velocity", side.stribeck_velocity),
        ("mass", axis.mass),
        ("offset", law.curve().offset()),
    ]
    .into_iter()
    .map(|(name, value)| (name.to_string(), value))
    .collect()
}
