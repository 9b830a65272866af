//! The force that a transmission passes on to its load, on which the friction of its teeth depends.
//!
//! Load side, not motor side: `tau = weight - external`. The force of the motor is the weight and the friction that is asked
//! for, so a level in proportion to *that* explains any force by itself (decision 0077). Of the weight the shape over the
//! angle is that of one estimate; its size is the fitted one ([`Transmitted::scale`]), and [`Terms::weighing`] renews the
//! shape until both are one.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use crate::law::dependence::{Dependence, Factor};
use crate::law::terms::{ColumnKind, Delay, LinearTerm, Terms};
use crate::law::{Law, LawKind};
use crate::parameter::Parameter;
use crate::separable::objective::Objective;
use stiction_parameters::{Quantity, Wave};
use stiction_policy::interval;

/// Rounds in which a first weight is found, of a law without a bristle: each leaves about a tenth of the error of the last,
/// and the fits of the law itself begin there.
const ROUNDS: usize = 4;

/// What is transmitted, as an estimate of the weight has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transmitted {
    /// Weight of a rotary axis, `sine sin q + cosine cos q`, in the unit of the force.
    pub sine: f64,
    /// See `sine`.
    pub cosine: f64,
    /// Size at which the parameters hold: the mean over the record.
    pub reference: f64,
    /// By which part what is transmitted grows with each amplitude of the weight, in the mean over the record.
    growth: [f64; 2],
}

impl Transmitted {
    /// Along a segment at the full rate: positive where the motor has to push towards positive position. A missing channel adds nothing.
    pub(crate) fn along(&self, segment: &Segment) -> Vec<f64> {
        let channels = &segment.channels;
        let mut out = self.of(&channels.position, &channels.external);
        out.resize(segment.velocity.len(), 0.0);
        out
    }

    /// The same of positions (rad) and external forces.
    pub fn of(&self, position: &[f64], external: &[f64]) -> Vec<f64> {
        let weighs = [self.sine, self.cosine] != [0.0; 2];
        let of_position = if weighs { position.len() } else { 0 };
        let at = |i: usize| {
            let weight = match position.get(i) {
                Some(&q) if weighs => self.sine * libm::sin(q) + self.cosine * libm::cos(q),
                _ => 0.0,
            };
            weight - external.get(i).copied().unwrap_or(0.0)
        };
        (0..of_position.max(external.len())).map(at).collect()
    }

    /// Of this record with a weight.
    fn weighing(record: &Record, [sine, cosine]: [f64; 2]) -> Self {
        let bare = Self {
            sine,
            cosine,
            ..Self::default()
        };
        let mut sums = [0.0; 4];
        let mut count = 0.0_f64;
        for segment in &record.segments {
            let along = bare.along(segment);
            let at = |f: fn(f64) -> f64| -> Vec<f64> {
                let angles = segment.channels.position.iter().zip(&along);
                angles.map(|(&q, tau)| f(q) * tau).collect()
            };
            let all = [
                along.iter().map(|tau| tau.abs()).collect(),
                along.iter().map(|tau| tau * tau).collect(),
                at(libm::sin),
                at(libm::cos),
            ];
            for (sum, full) in sums.iter_mut().zip(all) {
                let mut kept = Vec::new();
                record.thin(segment, &full, Shift::NONE, &mut kept);
                *sum += kept.iter().sum::<f64>();
            }
            count += segment.keep.iter().filter(|keep| **keep).count() as f64;
        }
        let [size, square, by_sine, by_cosine] = sums;
        let part = |x: f64| if square > 0.0 { x / square } else { 0.0 };
        Self {
            reference: size / count.max(1.0),
            growth: [part(by_sine), part(by_cosine)],
            ..bare
        }
    }

    /// How much larger what is transmitted is with the weight that is fitted, and the derivatives by its amplitudes.
    pub(crate) fn scale(&self, weight: [f64; 2]) -> (f64, [f64; 2]) {
        let more = [weight[0] - self.sine, weight[1] - self.cosine];
        let scale = 1.0 + self.growth[0] * more[0] + self.growth[1] * more[1];
        (scale, self.growth)
    }

    /// Part of its mean square by which another weight changes what is transmitted, beyond its size.
    fn differs(&self, other: &Self) -> f64 {
        let away = [other.sine - self.sine, other.cosine - self.cosine];
        let by = self.growth[0] * away[0] + self.growth[1] * away[1];
        let size = libm::hypot(self.sine, self.cosine).max(libm::hypot(other.sine, other.cosine));
        match size > 0.0 {
            true => libm::hypot(away[0], away[1]) / size,
            false => by.abs(),
        }
    }
}

/// Amplitudes of the weight among linear unknowns, where it is fitted.
pub(crate) fn weight_of(linear: &[LinearTerm]) -> Option<[usize; 2]> {
    let at = |wave| {
        let quantity = Quantity::Gravity(wave);
        linear.iter().position(|term| term.name == quantity)
    };
    Some([at(Wave::Sine)?, at(Wave::Cosine)?])
}

impl Terms {
    /// What is transmitted, where friction depends on it.
    pub fn transmitted(&self) -> Option<Transmitted> {
        self.dependences.iter().find_map(|d| match d {
            Dependence::CoulombTransmitted(own) | Dependence::CoulombDriven(own) => Some(*own),
            _ => None,
        })
    }

    /// The same terms with what is transmitted under this weight.
    fn with_weight(&self, record: &Record, weight: [f64; 2]) -> Self {
        let own = Transmitted::weighing(record, weight);
        let renewed = |d: &Dependence| match *d {
            Dependence::CoulombTransmitted(_) => Dependence::CoulombTransmitted(own),
            Dependence::CoulombDriven(_) => Dependence::CoulombDriven(own),
            other => other,
        };
        Self {
            dependences: self.dependences.iter().map(renewed).collect(),
            ..self.clone()
        }
    }

    /// The same terms with the weight that was fitted with them as that which is transmitted; `None` where it is the same to
    /// `tolerance`, a part of it, or not fitted.
    pub(crate) fn weighing(
        &self,
        record: &Record,
        law: &Law,
        coefficients: &[f64],
        tolerance: f64,
    ) -> Option<Self> {
        let own = self.transmitted()?;
        let weight = weight_of(&self.columns(law))?;
        let weight = [coefficients.get(weight[0])?, coefficients.get(weight[1])?].map(|x| *x);
        if weight.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let renewed = self.with_weight(record, weight);
        let differs = own.differs(&renewed.transmitted()?);
        (differs > tolerance).then_some(renewed)
    }

    /// The same terms with what is transmitted from a record: a weight that is fitted as Coulomb and viscous friction leave it.
    pub(crate) fn transmitting(self, record: &Record) -> Self {
        if self.transmitted().is_none() {
            return self;
        }
        let mut found = self.with_weight(record, [0.0; 2]);
        if !self.gravity || record.kept() == 0 {
            return found;
        }
        let law = Law::new(LawKind::CoulombViscous);
        for _ in 0..ROUNDS {
            let still = Terms {
                delay: Delay::NONE,
                ..found.clone()
            };
            let objective = Objective::new(record, law, &still);
            let c = objective.evaluate(&[], false).solution.coefficients;
            match found.weighing(record, &law, &c, 0.0) {
                Some(next) => found = next,
                None => break,
            }
        }
        found
    }
}

/// Leaves the parts of what is transmitted open where the weight that they are parts of is: on a way in one direction a larger
/// weight and a larger part of it look alike.
pub(crate) fn flag_parts_of_an_open_weight(terms: &Terms, parameters: &mut [Parameter]) {
    let Some(of) = terms.transmitted().filter(|_| terms.gravity) else {
        return;
    };
    let deviation = |wave| {
        let mut weight = parameters.iter();
        let weight = weight.find(|p| p.name == Quantity::Gravity(wave))?;
        weight.std
    };
    let spread = [Wave::Sine, Wave::Cosine].map(deviation);
    let known = match spread {
        [Some(sine), Some(cosine)] => {
            libm::hypot(of.growth[0] * sine, of.growth[1] * cosine) <= interval::MAX_HALF_WIDTH
        }
        _ => false,
    };
    if known {
        return;
    }
    for p in parameters.iter_mut().filter(|p| p.identifiable) {
        let quantity = p.name.quantity;
        if matches!(
            quantity,
            Quantity::CoulombTransmitted | Quantity::CoulombDriven
        ) {
            p.identifiable = false;
            p.reason = "is a part of the weight, which is not determined".into();
        }
    }
}

/// Whether a column is of what is transmitted, and how that follows from the weight.
pub(crate) fn of(column: ColumnKind) -> Option<Transmitted> {
    match column {
        ColumnKind::LevelTimes(Factor::Transmitted(own) | Factor::Driven(own), _) => Some(own),
        _ => None,
    }
}
