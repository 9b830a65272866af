//! The linear terms of the force: the law's own and those that stand beside it.

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::friction_curve::Hats;
use crate::law::dependence::{Dependence, Factor};
use crate::law::prior::Prior;
use crate::law::{Law, LawKind};
use std::f64::consts::TAU;
use stiction_parameters::{Name, Quantity, Wave};
use stiction_policy::delay;

/// Linear terms beside the friction law; each is one more exact unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms {
    /// Mass or inertia times acceleration.
    pub mass: Mass,
    /// A constant force. Beside an asymmetric law without much presliding it cannot be separated from the
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
    /// A curve of friction by speed in place of the levels and viscous friction of a law: that of
    /// [`friction_curve`](crate::friction_curve()), empty for a law.
    pub curve: Hats,
    /// How much later the force was logged than the motion it belongs to. Not linear, but like the
    /// terms above no part of the law.
    pub delay: Delay,
    /// Standard deviation of a delay that is given, s, which intervals count; 0 where it is known.
    pub delay_deviation: f64,
    /// How a delay that is given came to be known.
    pub delay_from: DelayFrom,
    /// A lag between the force that was logged and that which the axis feels, as a current loop has one. Its time is a part of a
    /// delay that is fitted; beside one that is given there is none.
    pub lag: Lag,
    /// Whether a low-pass behind which the force was logged was undone, which makes its noise another one and larger.
    pub low_pass_undone: bool,
    /// The delay that the first fit of the choice of cut-offs found, whose common cut-off is low; `None` without a choice.
    pub first_delay: Option<FirstDelay>,
    /// What is known of the law before the log; `None` before a first fit shows what a sample counts.
    pub prior: Option<Prior>,
}

/// A delay of the force against the motion as a fit with low cut-offs found it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstDelay {
    /// Samples.
    pub delay: f64,
    /// Its standard deviation, samples.
    pub deviation: f64,
}

/// What is known of the delay of the force against the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Delay {
    /// One more unknown, up to four samples either way.
    Fitted,
    /// Known, s; negative where the force is logged before its motion, as for a command that is held from
    /// its sample to the next.
    Given(f64),
}

impl Delay {
    /// Force and motion of a row belong together.
    pub const NONE: Self = Delay::Given(0.0);
}

/// How a delay that is given came to be known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DelayFrom {
    /// It was stated.
    Stated,
    /// LuGre found it on the same record, or that none is within the range, and leaves a residual of this root mean square, N (N m).
    /// Maxwell-slip elements begin there to look for their own.
    OtherLaw(f64),
    /// Maxwell-slip elements found it, along the profile of their cost.
    Elements,
}

/// What is known of a lag of first order: the square of its time constant, which is what a force shows of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag {
    /// The square, s^2, in the mean of what is possible.
    pub square: f64,
    /// Its variance, s^4.
    pub variance: f64,
}

impl Lag {
    /// No lag.
    pub const NONE: Self = Self {
        square: 0.0,
        variance: 0.0,
    };

    /// What fits assume of it: one that is not certain is left out, and may be as large as it may.
    pub(crate) fn assumed(self) -> Self {
        match self.square * self.square
            > delay::MIN_LAG_DEVIATIONS * delay::MIN_LAG_DEVIATIONS * self.variance
        {
            true => self,
            false => Self {
                square: 0.0,
                variance: self.variance + self.square * self.square,
            },
        }
    }

    /// The time constant, s.
    pub fn time(&self) -> f64 {
        self.square.sqrt()
    }
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
            delay_deviation: 0.0,
            delay_from: DelayFrom::Stated,
            lag: Lag::NONE,
            low_pass_undone: false,
            first_delay: None,
            prior: None,
            quadratic_viscous: false,
            dependences: Vec::new(),
            curve: Hats::default(),
        }
    }
}

/// One linear unknown: the parameter that it stands for, and its column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinearTerm {
    pub name: Name,
    pub column: ColumnKind,
}

impl LinearTerm {
    /// Whether its coefficient must not be negative. The curve of one direction may: a weight beside friction is in it.
    pub fn is_never_negative(&self) -> bool {
        let of_curve = matches!(self.column, ColumnKind::LevelTimes(Factor::Hat(_), _));
        !of_curve && self.name.quantity.allowed().is_never_negative()
    }
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
    /// The rate times a factor.
    RateTimes(Factor),
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
    /// The parameter of this direction.
    pub fn of(self, quantity: Quantity) -> Name {
        let side = match self {
            Side::Positive => stiction_parameters::Side::Positive,
            Side::Negative => stiction_parameters::Side::Negative,
        };
        Name::new(quantity, side)
    }

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
    /// temperature, the middle of the stroke, the number of logs. One log has no levels of its own beside those of the others.
    #[must_use]
    pub fn about(&self, record: &Record) -> Self {
        let dependences = self.dependences.iter().map(|d| d.about(record));
        let dependences = dependences.filter(|d| d.logs() != Some(1)).collect();
        let about = Self {
            dependences,
            ..self.clone()
        };
        about.transmitting(record)
    }

    /// Pitches of the waves that the level of friction has along the stroke, m or rad, in their order.
    pub fn level_pitches(&self) -> Vec<f64> {
        let dependences = self.dependences.iter();
        let pitches = dependences.filter_map(|own| match own {
            Dependence::CoulombPitch(pitch) => Some(*pitch),
            _ => None,
        });
        pitches.collect()
    }

    /// The channel of the log that a dependence needs beside these terms, if any.
    pub fn channel(&self, dependence: &Dependence) -> Option<&'static str> {
        match dependence {
            Dependence::CoulombTransmitted(_) | Dependence::CoulombDriven(_) if self.gravity => {
                Some("position")
            }
            other => other.channel(),
        }
    }

    /// Refuses a record without a channel that a term needs.
    pub(crate) fn check(&self, record: &Record) -> Result<(), Error> {
        for dependence in &self.dependences {
            let Some(channel) = self.channel(dependence) else {
                continue;
            };
            let missing = record.segments.iter().find(|s| {
                let channel = match channel {
                    "load" => &s.channels.load,
                    "temperature" => &s.channels.temperature,
                    "external" => &s.channels.external,
                    _ => &s.channels.position,
                };
                channel.is_empty()
            });
            if let Some(segment) = missing {
                return Err(Error::MissingChannel {
                    log: segment.log + 1,
                    channel,
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
        let mut push = |name: Name, column| out.push(LinearTerm { name, column });
        let split = law.kind == LawKind::CoulombViscous && law.asymmetric;
        if !self.curve.0.is_empty() {
            // No parameter of a law: the names only count them.
            for (k, (hat, side)) in self.curve.0.iter().enumerate() {
                let name = Quantity::ElementForce(k as u32 + 1);
                push(
                    name.into(),
                    ColumnKind::LevelTimes(Factor::Hat(*hat), Some(*side)),
                );
            }
        } else if law.kind.has_elements() {
            for k in 0..law.elements {
                let name = Quantity::ElementForce(k as u32 + 1);
                push(name.into(), ColumnKind::Element(k));
            }
        } else if split {
            for side in [Side::Positive, Side::Negative] {
                push(side.of(Quantity::Coulomb), ColumnKind::Sign(side));
            }
        } else {
            push(Quantity::Coulomb.into(), ColumnKind::Level);
        }
        if law.has_micro_damping() {
            push(Quantity::Sigma1.into(), ColumnKind::Rate);
        }
        for side in sides(law).into_iter().filter(|_| self.curve.0.is_empty()) {
            push(name(Quantity::Sigma2, side), ColumnKind::Speed(side));
        }
        if self.quadratic_viscous {
            for side in sides(law) {
                let name = name(Quantity::QuadraticViscous, side);
                push(name, ColumnKind::Square(side));
            }
        }
        if self.mass == Mass::Fitted {
            push(Quantity::Mass.into(), ColumnKind::Acceleration);
        }
        if self.offset {
            push(Quantity::Offset.into(), ColumnKind::One);
        }
        if self.gravity {
            push(Quantity::Gravity(Wave::Sine).into(), ColumnKind::Sine(1.0));
            let cosine = Quantity::Gravity(Wave::Cosine);
            push(cosine.into(), ColumnKind::Cosine(1.0));
        }
        for (k, pitch) in self.cogging.iter().enumerate() {
            let wave = |part| Quantity::Cogging(k as u32 + 1, part).into();
            push(wave(Wave::Sine), ColumnKind::Sine(TAU / pitch));
            push(wave(Wave::Cosine), ColumnKind::Cosine(TAU / pitch));
        }
        let mut pitches = 0;
        for dependence in &self.dependences {
            for (quantity, factor) in dependence.factors(pitches) {
                if let Quantity::Sigma1Log(_) = quantity {
                    if law.has_micro_damping() {
                        push(quantity.into(), ColumnKind::RateTimes(factor));
                    }
                    continue;
                }
                // The direction of motion makes no difference to what happens between logs.
                let sides = match dependence.logs() {
                    Some(_) => vec![None],
                    None => sides(law),
                };
                for side in sides {
                    let column = if dependence.is_viscous() {
                        ColumnKind::SpeedTimes(factor, side)
                    } else {
                        ColumnKind::LevelTimes(factor, side)
                    };
                    push(name(quantity, side), column);
                }
            }
            pitches += usize::from(matches!(dependence, Dependence::CoulombPitch(_)));
        }
        out
    }
}

/// The directions that have unknowns of their own.
fn sides(law: &Law) -> Vec<Option<Side>> {
    if law.asymmetric {
        vec![Some(Side::Positive), Some(Side::Negative)]
    } else {
        vec![None]
    }
}

/// The parameter of one direction, or of both.
fn name(quantity: Quantity, side: Option<Side>) -> Name {
    side.map_or(quantity.into(), |side| side.of(quantity))
}
