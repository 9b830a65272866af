//! The experiments of Canudas de Wit, Olsson, Astrom, Lischinsky 1995 (doi 10.1109/9.376053) with the expected
//! numbers: the block of the paper's Table I, constant sigma1.
//!
//! References come from an adaptive Radau integration at a relative tolerance of 1e-9 to 1e-10, not from this workspace.
//! The letters B to G are this project's names for them.

mod break_away;
mod drift;
mod hunting;
mod lag;
mod presliding;
mod stick_slip;

use crate::known::{self, KnownAxis};
use crate::plant::Plant;
use stiction_friction::ParamError;

/// An experiment that has been run.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// `B` to `G`.
    pub letter: char,
    /// What it shows.
    pub title: &'static str,
    /// The numbers, beside their references.
    pub checks: Vec<Check>,
    /// Horizontal and vertical quantity of the curves, each with its SI unit.
    pub axes: [(&'static str, &'static str); 2],
    /// The picture.
    pub curves: Vec<Curve>,
}

/// A number beside its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// What it is.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// The expected value.
    pub reference: f64,
    /// The value found here.
    pub found: f64,
    /// Largest allowed difference, in `unit`.
    pub tolerance: f64,
}

impl Check {
    /// A number with a tolerance relative to the reference.
    fn relative(
        name: impl Into<String>,
        unit: &'static str,
        found: f64,
        reference: f64,
        relative: f64,
    ) -> Self {
        Check::absolute(name, unit, found, reference, relative * reference.abs())
    }

    /// A number with an absolute tolerance.
    fn absolute(
        name: impl Into<String>,
        unit: &'static str,
        found: f64,
        reference: f64,
        tolerance: f64,
    ) -> Self {
        Check {
            name: name.into(),
            unit,
            reference,
            found,
            tolerance,
        }
    }

    /// Whether it is within the tolerance.
    pub fn holds(&self) -> bool {
        (self.found - self.reference).abs() <= self.tolerance
    }
}

/// One line of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// What it is.
    pub label: String,
    /// Horizontal values, SI.
    pub x: Vec<f64>,
    /// Vertical values, SI.
    pub y: Vec<f64>,
}

impl Curve {
    fn new(label: impl Into<String>) -> Self {
        Curve {
            label: label.into(),
            ..Curve::default()
        }
    }

    fn push(&mut self, x: f64, y: f64) {
        self.x.push(x);
        self.y.push(y);
    }
}

/// Largest allowed difference from the reference, relative; .5 % for break-away forces, which the references give to four
/// digits of a quantity that falls steeply.
const TOLERANCE: f64 = 1e-3;

/// An experiment to run. It asks its argument now and then whether to go on; `None` where it was stopped.
pub type Run = fn(&dyn Fn() -> bool) -> Result<Option<Experiment>, ParamError>;

/// All of them, B to G.
pub const ALL: [Run; 6] = [
    |go_on| whole(presliding::run, go_on),
    |go_on| whole(lag::run, go_on),
    |go_on| whole(break_away::run, go_on),
    |go_on| whole(stick_slip::run, go_on),
    hunting::run,
    |go_on| whole(drift::run, go_on),
];

/// Runs one that takes less than a second, and so need not ask.
fn whole(
    run: fn() -> Result<Experiment, ParamError>,
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Experiment>, ParamError> {
    match go_on() {
        true => run().map(Some),
        false => Ok(None),
    }
}

fn axis() -> Result<KnownAxis, ParamError> {
    known::find("C95").ok_or(ParamError::new("axis", 0.0, "a known one"))
}

fn block() -> Result<Plant, ParamError> {
    let axis = axis()?;
    Plant::new(axis.mass, axis.law)
}

/// The largest of some values; minus infinity of none.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}
