//! The linear terms of the force: the law's own and those that stand beside it.

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::dependence::{Dependence, Factor};
use crate::law::{Law, LawKind};
use std::f64::consts::TAU;

/// Linear terms beside the friction law; each is one more exact unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms {
    /// Mass or inertia times acceleration.
    pub mass: Mass,
    /// A constant force. Beside an asymmetric law without much presliding it cannot be told from the
    /// difference of the two Coulomb levels.
    pub offset: bool,
    /// Gravity of a rotary axis: `sin q` and `cos q`.
    pub gravity: bool,
    /// Cogging: `sin` and `cos` of `2 pi x / pitch` for each pitch, m or rad.
    pub cogging: Vec<f64>,
    /// Viscous friction that grows with the square of the speed, `v |v|`; negative where it bends
    /// the other way.
    pub quadratic_viscous: bool,
    /// Friction that changes with load, temperature or position.
    pub dependences: Vec<Dependence>,
    /// How much later the force was logged than the motion it belongs to. Not linear, but like the
    /// terms above no part of the law.
    pub delay: Delay,
}

/// What is known of the delay of the force against the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Delay {
    /// One more unknown, up to four samples either way.
    Fitted,
    /// Known, s; negative where the force stands in the log before its motion, as a command does that
    /// is held from its sample to the next.
    Given(f64),
}

impl Delay {
    /// Force and motion of a row belong together.
    pub const NONE: Self = Delay::Given(0.0);
}

/// What is known of the moving mass or inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mass {
    /// One more unknown.
    Fitted,
    /// Known: kg or kg m^2 (force unit per acceleration), not negative.
    Given(f64),
    /// The force channel holds no inertia (a load cell between carriage and guide).
    Absent,
}

impl Default for Terms {
    fn default() -> Self {
        Self {
            mass: Mass::Fitted,
            offset: true,
            gravity: false,
            cogging: Vec::new(),
            delay: Delay::NONE,
            quadratic_viscous: false,
            dependences: Vec::new(),
        }
    }
}

/// One linear unknown: its name in files, its place among the physical parameters, and whether it
/// must not be negative.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinearTerm {
    pub name: String,
    pub column: ColumnKind,
    pub nonnegative: bool,
}

/// How a column of the regression is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ColumnKind {
    /// `eta` (or its steady state for a static law).
    Level,
    /// Deflection of one Maxwell-slip element, counted from 0, over its yield deflection.
    Element(usize),
    /// `sgn v` for one direction only (Coulomb + viscous, asymmetric).
    Sign(Side),
    /// `v - |v| eta / gh`.
    Rate,
    /// `v`, or `v` in one direction only.
    Speed(Option<Side>),
    /// `v |v|`, or that in one direction only.
    Square(Option<Side>),
    /// `eta` times a factor, or that in one direction of the deflection only.
    LevelTimes(Factor, Option<Side>),
    /// `v` times a factor, or that in one direction only.
    SpeedTimes(Factor, Option<Side>),
    Acceleration,
    One,
    /// `sin` of a rate times position, 1/m or 1/rad.
    Sine(f64),
    Cosine(f64),
}

/// A direction of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Positive,
    Negative,
}

impl Side {
    /// 1 for a velocity in this direction, 0 otherwise.
    pub fn selects(self, v: f64) -> bool {
        match self {
            Side::Positive => v > 0.0,
            Side::Negative => v < 0.0,
        }
    }
}

impl Terms {
    /// The same terms with the references of the dependences taken from a record: the mean load and
    /// temperature, the middle of the stroke.
    #[must_use]
    pub fn about(&self, record: &Record) -> Self {
        let dependences = self.dependences.iter().map(|d| d.about(record)).collect();
        Self {
            dependences,
            ..self.clone()
        }
    }

    /// Refuses a record without a channel that a term needs.
    pub(crate) fn check(&self, record: &Record) -> Result<(), Error> {
        for dependence in &self.dependences {
            let missing = record.segments.iter().find(|s| {
                let channel = match dependence.channel() {
                    "load" => &s.channels.load,
                    "temperature" => &s.channels.temperature,
                    _ => &s.channels.position,
                };
                channel.is_empty()
            });
            if let Some(segment) = missing {
                return Err(Error::MissingChannel {
                    log: segment.log + 1,
                    channel: dependence.channel(),
                    term: dependence.name(),
                });
            }
        }
        Ok(())
    }

    /// The linear unknowns of a law with these terms, in the order of the columns; the law's own
    /// (those that depend on the nonlinear unknowns) come first.
    pub(crate) fn columns(&self, law: &Law) -> Vec<LinearTerm> {
        let mut out = Vec::new();
        let mut push = |name: &str, column, nonnegative| {
            out.push(LinearTerm {
                name: name.to_string(),
                column,
                nonnegative,
            });
        };
        let split = law.kind == LawKind::CoulombViscous && law.asymmetric;
        if law.kind.has_elements() {
            for k in 0..law.elements {
                let name = format!("{}{}", crate::gms::ELEMENT, k + 1);
                push(&name, ColumnKind::Element(k), true);
            }
        } else if split {
            push("coulomb_pos", ColumnKind::Sign(Side::Positive), true);
            push("coulomb_neg", ColumnKind::Sign(Side::Negative), true);
        } else {
            push("coulomb", ColumnKind::Level, true);
        }
        if law.kind.has_micro_damping() {
            push("sigma1", ColumnKind::Rate, true);
        }
        if law.asymmetric {
            push("sigma2_pos", ColumnKind::Speed(Some(Side::Positive)), true);
            push("sigma2_neg", ColumnKind::Speed(Some(Side::Negative)), true);
        } else {
            push("sigma2", ColumnKind::Speed(None), true);
        }
        if self.quadratic_viscous {
            for (side, suffix) in sides(law) {
                push(
                    &format!("quadratic_viscous{suffix}"),
                    ColumnKind::Square(side),
                    false,
                );
            }
        }
        if self.mass == Mass::Fitted {
            push("mass", ColumnKind::Acceleration, true);
        }
        if self.offset {
            push("offset", ColumnKind::One, false);
        }
        if self.gravity {
            push("gravity_sin", ColumnKind::Sine(1.0), false);
            push("gravity_cos", ColumnKind::Cosine(1.0), false);
        }
        for (k, pitch) in self.cogging.iter().enumerate() {
            push(
                &format!("cogging{}_sin", k + 1),
                ColumnKind::Sine(TAU / pitch),
                false,
            );
            push(
                &format!("cogging{}_cos", k + 1),
                ColumnKind::Cosine(TAU / pitch),
                false,
            );
        }
        let mut pitches = 0;
        for dependence in &self.dependences {
            for (name, factor) in dependence.factors(pitches) {
                for (side, suffix) in sides(law) {
                    let column = if dependence.is_viscous() {
                        ColumnKind::SpeedTimes(factor, side)
                    } else {
                        ColumnKind::LevelTimes(factor, side)
                    };
                    push(&format!("{name}{suffix}"), column, false);
                }
            }
            pitches += usize::from(matches!(dependence, Dependence::CoulombPitch(_)));
        }
        out
    }
}

/// The directions that have unknowns of their own, and the suffix of their names.
fn sides(law: &Law) -> Vec<(Option<Side>, &'static str)> {
    if law.asymmetric {
        vec![
            (Some(Side::Positive), "_pos"),
            (Some(Side::Negative), "_neg"),
        ]
    } else {
        vec![(None, "")]
    }
}
