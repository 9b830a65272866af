//! What lies between motor and load, where a law leaves something systematically: a spring, or a gap.
//!
//! A law of one rigid mass takes motor and load for one. Of a load on a spring, and of one behind a gap, the motion follows
//! from that of the encoder, and with it the force that the rigid mass lacks: one more column beside those of the law. What
//! such a column explains of the residual, beyond all that the parameters of the law can take up, tells the two from friction
//! of another shape, which such a column hardly explains. Reasons and figures: decision 0066.

pub(super) mod beside;
mod gap;
mod spring;

use self::beside::Beside;
use super::Divisions;
use crate::conditioning::shift::Shift;
use crate::law::terms::{ColumnKind, Terms};
use crate::separable::objective::{Evaluation, Objective};

/// Where the encoder is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoder {
    /// On the motor.
    Motor,
    /// On the load.
    Load,
}

/// What lies between motor and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Between {
    /// A spring, on which the load vibrates.
    Spring {
        /// Frequency of the load while the motor stands still, `sqrt(k/m)/2 pi`, Hz.
        frequency: f64,
        /// Where the encoder is.
        encoder: Encoder,
    },
    /// A gap that the force must cross before it moves the load.
    Gap {
        /// Its width, the lost motion, m or rad.
        width: f64,
    },
}

/// A load that does not follow its motor rigidly.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// What lies between the two.
    pub between: Between,
    /// Relative standard deviation of its frequency or width: that of a fit to four samples of what it leaves.
    pub deviation: f64,
    /// The load, as a part of the moving mass.
    pub load: f64,
    /// Part of the variance of the residual that it explains, 0 to 1.
    pub share: f64,
    /// That part for other frequencies (Hz) or widths (m or rad).
    pub course: Vec<(f64, f64)>,
}

impl Coupling {
    /// Whether its frequency or width is told from none.
    pub(super) fn is_sure(&self) -> bool {
        self.deviation <= MOST_DEVIATION
    }

    /// Frequency at which motor and load vibrate against each other, Hz; `None` for a gap.
    pub fn resonance(&self) -> Option<f64> {
        match self.between {
            Between::Spring { frequency, .. } => Some(frequency / (1.0 - self.load).sqrt()),
            Between::Gap { .. } => None,
        }
    }
}

/// Independent ways in which a law is taken to be wrong (decision 0061): what is left is a fit to so many samples.
const WAYS: f64 = 4.0;
/// Deviation up to which a frequency or width is stated.
const MOST_DEVIATION: f64 = 0.5;
/// Part of the moving mass that a load has.
const LOAD: std::ops::Range<f64> = 0.1..0.9;

/// A fitted law, and what it leaves.
pub(super) struct Fitted<'a> {
    objective: &'a Objective<'a>,
    terms: &'a Terms,
    at: &'a Evaluation,
    p: &'a [f64],
    /// Moving mass, kg or kg m^2, in the unit of the force.
    mass: f64,
    /// Acceleration behind the common filter at the full rate, segment by segment.
    acceleration: Vec<Vec<f64>>,
    shift: Shift,
    beside: Beside,
}

/// Looks for a spring and for a gap; `None` where neither shows surely.
pub(super) fn sought(
    divisions: &Divisions,
    objective: &Objective,
    terms: &Terms,
    (at, p): (&Evaluation, &[f64]),
    left: &[f64],
) -> Option<Coupling> {
    objective.law().layout().kappa?;
    let coefficients = &at.solution.coefficients;
    let mass = objective.mass(coefficients).filter(|m| *m > 0.0)?;
    let beside = Beside::new(&at.jacobian(), left);
    // What a gap explains of the kept samples alone says whether to look closely.
    let drag = viscous(objective, coefficients) / mass;
    let suspected = gap::suspected(divisions, objective.record(), &beside, mass, drag);
    let record = objective.record();
    let mut acceleration: Vec<Vec<f64>> = record
        .segments
        .iter()
        .map(|s| s.acceleration.clone())
        .collect();
    acceleration
        .iter_mut()
        .for_each(|a| record.filter(std::iter::once(a)));
    let fitted = Fitted {
        objective,
        terms,
        at,
        p,
        mass,
        acceleration,
        shift: objective.shift(p),
        beside,
    };
    let of_motor = spring::behind_the_motor(&fitted);
    let bend = fitted.bend();
    let at_motor = of_motor.as_ref().and_then(|found| found.named(&fitted));
    let found = at_motor.or_else(|| spring::before_the_encoder(&fitted, &bend));
    if found.is_some() {
        return found;
    }
    // A gap is what no spring explains, wherever its encoder is.
    let mut springs = fitted.beside.with(&bend);
    if let Some(spring) = &of_motor {
        springs = springs.with(&spring.column);
    }
    let of_spring = of_motor.map_or(0.0, |spring| spring.share);
    gap::found(&fitted, suspected?, drag, (&springs, of_spring))
}

/// Viscous friction, of an asymmetric law that of either direction.
fn viscous(objective: &Objective, coefficients: &[f64]) -> f64 {
    let terms = objective.linear().iter().zip(coefficients);
    let speed = terms.filter(|(term, _)| matches!(term.column, ColumnKind::Speed(_)));
    speed.map(|(_, c)| c.max(0.0)).fold(0.0, f64::max)
}

impl Fitted<'_> {
    /// A full-rate channel of each segment, which has passed the common filter, at the kept samples.
    fn kept(&self, full: &[Vec<f64>]) -> Vec<f64> {
        let record = self.objective.record();
        let mut out = Vec::with_capacity(record.kept());
        for (segment, full) in record.segments.iter().zip(full) {
            record.thin(segment, full, self.shift, &mut out);
        }
        out
    }

    /// Second derivative of the acceleration.
    fn bend(&self) -> Vec<f64> {
        let segments = self
            .objective
            .record()
            .segments
            .iter()
            .zip(&self.acceleration);
        let twice: Vec<Vec<f64>> = segments
            .map(|(s, a)| slope(&slope(a, s.step), s.step))
            .collect();
        self.kept(&twice)
    }
}

/// Central differences, at the ends one-sided.
fn slope(values: &[f64], step: f64) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|i| {
            let (from, to) = (i.saturating_sub(1), (i + 1).min(last));
            (values[to] - values[from]) / (step * to.abs_diff(from).max(1) as f64)
        })
        .collect()
}
