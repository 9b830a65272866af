//! The motion to record, within the limits of an axis.

mod assume;
mod design;
mod judged;
mod outcome;

pub use assume::Given;
pub use outcome::Planned;

use crate::error::Error;
use std::path::{Path, PathBuf};
use stiction_files::Axis;
use stiction_search::Observer;

/// What is to be planned.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanOptions {
    /// Longest motion, s.
    pub time: f64,
    /// Of the axes that it is made for.
    pub seed: u64,
}

/// Shortest and longest motion that is planned, s.
pub const TIMES: [f64; 2] = [2.0, 600.0];

impl Default for PlanOptions {
    fn default() -> Self {
        PlanOptions { time: 9.0, seed: 0 }
    }
}

/// Plans a motion for the axis of a file. The observer sees progress and may stop the work; `None` where it did so before there
/// was any motion. Results do not depend on the number of threads.
///
/// # Errors
/// Where the axis file lacks its limits, each key by its name, or where no motion keeps within them.
pub fn plan(
    axis_file: &Path,
    options: &PlanOptions,
    observer: &mut dyn Observer,
) -> Result<Option<Planned>, Error> {
    let [least, most] = TIMES;
    if !(least..=most).contains(&options.time) {
        let found = format!("--time {} s", stiction_number::full(options.time));
        return Err(Error::usage(found, format!("{least} s to {most} s")));
    }
    let axis = Axis::read(axis_file)?;
    let given = assume::given(&axis)?;
    let inputs = vec![PathBuf::from(axis_file)];
    design::design(&axis, given, inputs, options, observer)
}
