//! What a plan is.

use super::PlanOptions;
use super::assume::Given;
use super::band::Band;
use stiction_files::plan::PlanFile;
use stiction_plan::carrier::Carried;
use stiction_plan::{Expected, Motion};

/// A planned motion with what it can be expected to show.
#[derive(Clone, Debug)]
pub struct Planned {
    /// What goes into `plan.toml`.
    pub file: PlanFile,
    /// The motion.
    pub motion: Motion,
    /// What a log of it can be expected to show.
    pub expected: Expected,
    /// The force to expect.
    pub band: Band,
    /// What was asked for.
    pub options: PlanOptions,
    /// What it was planned with.
    pub given: Given,
    /// The set points: `setpoints.csv`, then each form that was asked for.
    pub carried: Vec<Carried>,
}
