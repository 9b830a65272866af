//! A planned motion on the axis of the demo, to go through what a plan leads to before there is a machine.

use super::axis::{AXIS, along, csv};
use crate::error::Error;
use std::path::{Path, PathBuf};
use stiction_files::plan::ReadPlan;
use stiction_files::{Kept, shell, write_keeping};
use stiction_servo::known;

/// Name of the log.
pub const PLANNED: &str = "planned.csv";

/// Runs the motion of a `plan.toml` on the simulated axis and writes its log into `dir`; another file that had its name is kept.
/// The seed is that of the noise.
///
/// # Errors
/// Where the plan cannot be read or is of a rotary axis, the axis does not survive the motion, or the folder cannot be written.
pub fn planned(
    plan: impl AsRef<Path>,
    dir: impl AsRef<Path>,
    seed: u64,
) -> Result<(PathBuf, Option<Kept>), Error> {
    let (plan, dir) = (ReadPlan::read(plan.as_ref())?, dir.as_ref());
    let refused = |found: String, allowed: &'static str| {
        Error::usage(format!("{}: {found}", shell::text(&plan.file)), allowed)
    };
    if plan.kind != "linear" {
        let found = format!("is of a {} axis", plan.kind);
        return Err(refused(
            found,
            "a plan of a linear axis: that of the demo is a slide",
        ));
    }
    let axis = known::find(AXIS).expect("the demo axis is in the library");
    let follows = "a motion that a slide of 10 kg can follow";
    let record = along(&axis, plan.motion.clone(), seed);
    let record = record.map_err(|e| refused(e.to_string(), follows))?;
    let all = record.position.iter().chain(&record.force);
    if !all.copied().all(f64::is_finite) {
        let found = "the simulated axis runs away".into();
        return Err(refused(found, follows));
    }
    std::fs::create_dir_all(dir).map_err(|e| stiction_files::Error::output(dir, e.to_string()))?;
    let path = dir.join(PLANNED);
    let kept = write_keeping(&path, csv(&record).as_bytes())?;
    Ok((path, kept))
}
