//! What an experiment is, its numbers and pictures, and what the experiments share.

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
    pub(super) fn relative(
        name: impl Into<String>,
        unit: &'static str,
        found: f64,
        reference: f64,
        relative: f64,
    ) -> Self {
        Check::absolute(name, unit, found, reference, relative * reference.abs())
    }

    /// A number with an absolute tolerance.
    pub(super) fn absolute(
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
    pub(super) fn new(label: impl Into<String>) -> Self {
        Curve {
            label: label.into(),
            ..Curve::default()
        }
    }

    pub(super) fn push(&mut self, x: f64, y: f64) {
        self.x.push(x);
        self.y.push(y);
    }
}

/// Largest allowed difference from the reference, relative; .5 % for break-away forces, which the references give to four
/// digits of a quantity that falls steeply.
pub(super) const TOLERANCE: f64 = 1e-3;

pub(super) fn axis() -> Result<KnownAxis, ParamError> {
    known::find("C95").ok_or(ParamError::new("axis", 0.0, "a known one"))
}

pub(super) fn block() -> Result<Plant, ParamError> {
    let axis = axis()?;
    Plant::new(axis.mass, axis.law)
}

/// The largest of some values; minus infinity of none.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}
