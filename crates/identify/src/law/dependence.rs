//! Friction that changes with more than the velocity: normal load, what is transmitted, temperature, place on the stroke,
//! from log to log.
//!
//! The level of friction becomes `Fc + sum c_k f_k(t)` with a known factor `f_k` of another channel.
//! In the separable form `Fc eta` becomes `(Fc + sum c_k f_k) eta`, so each `c_k` is one more linear
//! unknown with the column `f_k eta`. Static friction and bristle stiffness change in proportion with
//! the level: `Fs/Fc` and the presliding length `Fc/s0` are those of the whole log.

use crate::conditioning::channels::Channels;
use crate::conditioning::record::{Record, Segment, extent};
use crate::friction_curve::Hat;
use crate::law::map::Map;
use crate::law::terms::Side;
use crate::law::transmitted::Transmitted;
use std::f64::consts::TAU;
use stiction_parameters::{Quantity, Wave};
use stiction_policy::interval;

/// A part of friction and what it changes with. References are where `coulomb` and `sigma2` hold;
/// [`Terms::about`](crate::Terms::about) takes them from a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dependence {
    /// Coulomb level, linear in the normal load about this load (unit of the load channel). Its
    /// coefficient is a coefficient of friction where load and force are in one unit.
    CoulombLoad(f64),
    /// Coulomb level, linear in the temperature about this one, K.
    CoulombTemperature(f64),
    /// Coulomb level, linear in the position about this one, m or rad.
    CoulombPosition(f64),
    /// Coulomb level with `sin` and `cos` of `2 pi x / pitch`, m or rad.
    CoulombPitch(f64),
    /// Coulomb level with a map over the stroke.
    CoulombMap(Map),
    /// Coulomb level, linear in the size of what the transmission passes on to the load. Its coefficient is a part of that.
    CoulombTransmitted(Transmitted),
    /// The same for what is added while the load drives the axis.
    CoulombDriven(Transmitted),
    /// Viscous friction, linear in the temperature about this one, K.
    ViscousTemperature(f64),
    /// Coulomb level and micro-damping of each of so many logs; the parameters hold in the first.
    CoulombLog(usize),
    /// Viscous friction of each of so many logs.
    ViscousLog(usize),
}

/// What multiplies a column of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Factor {
    /// A channel minus its reference.
    Load(f64),
    Temperature(f64),
    Position(f64),
    /// `sin` of a rate times position, 1/m or 1/rad.
    Sine(f64),
    Cosine(f64),
    /// A part of a map, counted from 1.
    Map(Map, usize),
    /// Size of what is transmitted minus its reference.
    Transmitted(Transmitted),
    /// That size where it points against friction, so that the load drives the axis; else 0.
    Driven(Transmitted),
    /// 1 in this log, counted from 0, and 0 in the others.
    Log(usize),
    /// A part of a curve by speed.
    Hat(Hat),
}

impl Dependence {
    /// Name of the key of the axis file, and stem of its parameters.
    pub fn name(&self) -> &'static str {
        match self {
            Dependence::CoulombLoad(_) => "coulomb_load",
            Dependence::CoulombTemperature(_) => "coulomb_temperature",
            Dependence::CoulombPosition(_) => "coulomb_position",
            Dependence::CoulombPitch(_) => "coulomb_pitch",
            Dependence::CoulombMap(_) => "coulomb_position",
            Dependence::CoulombTransmitted(_) => "coulomb_transmitted",
            Dependence::CoulombDriven(_) => "coulomb_driven",
            Dependence::ViscousTemperature(_) => "sigma2_temperature",
            Dependence::CoulombLog(_) => "coulomb_log",
            Dependence::ViscousLog(_) => "sigma2_log",
        }
    }

    /// The channel of the log that it needs, if any; [`Terms::channel`](crate::Terms::channel) counts a weight that is fitted.
    pub(crate) fn channel(&self) -> Option<&'static str> {
        match self {
            Dependence::CoulombLoad(_) => Some("load"),
            Dependence::CoulombTemperature(_) | Dependence::ViscousTemperature(_) => {
                Some("temperature")
            }
            Dependence::CoulombPosition(_)
            | Dependence::CoulombPitch(_)
            | Dependence::CoulombMap(_) => Some("position"),
            Dependence::CoulombTransmitted(_) | Dependence::CoulombDriven(_) => Some("external"),
            Dependence::CoulombLog(_) | Dependence::ViscousLog(_) => None,
        }
    }

    /// The logs that have levels of their own, where it is that.
    pub(crate) fn logs(&self) -> Option<usize> {
        match *self {
            Dependence::CoulombLog(logs) | Dependence::ViscousLog(logs) => Some(logs),
            _ => None,
        }
    }

    /// The references as given parameters, with their values: none for a pitch, the middle of the stroke and its length for a map.
    pub(crate) fn references(&self) -> Vec<(Quantity, f64)> {
        match *self {
            Dependence::CoulombLoad(x) => vec![(Quantity::LoadReference, x)],
            Dependence::CoulombTemperature(x) | Dependence::ViscousTemperature(x) => {
                vec![(Quantity::TemperatureReference, x)]
            }
            Dependence::CoulombPosition(x) => vec![(Quantity::PositionReference, x)],
            Dependence::CoulombMap(map) if map.terms > 0 => vec![
                (Quantity::PositionReference, map.middle()),
                (Quantity::PositionStroke, map.stroke),
            ],
            Dependence::CoulombTransmitted(of) => {
                vec![(Quantity::TransmittedReference, of.reference)]
            }
            Dependence::CoulombDriven(_)
            | Dependence::CoulombPitch(_)
            | Dependence::CoulombMap(_)
            | Dependence::CoulombLog(_)
            | Dependence::ViscousLog(_) => Vec::new(),
        }
    }

    /// Whether it changes the viscous term rather than the level.
    pub(crate) fn is_viscous(&self) -> bool {
        matches!(
            self,
            Dependence::ViscousTemperature(_) | Dependence::ViscousLog(_)
        )
    }

    /// Its columns: the parameter, and the factor.
    pub(crate) fn factors(&self, pitches_before: usize) -> Vec<(Quantity, Factor)> {
        match *self {
            Dependence::CoulombLoad(x) => vec![(Quantity::CoulombLoad, Factor::Load(x))],
            Dependence::CoulombTemperature(x) => {
                vec![(Quantity::CoulombTemperature, Factor::Temperature(x))]
            }
            Dependence::ViscousTemperature(x) => {
                vec![(Quantity::Sigma2Temperature, Factor::Temperature(x))]
            }
            Dependence::CoulombPosition(x) => {
                vec![(Quantity::CoulombPosition, Factor::Position(x))]
            }
            Dependence::CoulombTransmitted(of) => {
                vec![(Quantity::CoulombTransmitted, Factor::Transmitted(of))]
            }
            Dependence::CoulombDriven(of) => vec![(Quantity::CoulombDriven, Factor::Driven(of))],
            Dependence::CoulombPitch(pitch) => {
                let wave = |part| Quantity::CoulombPitch(pitches_before as u32 + 1, part);
                vec![
                    (wave(Wave::Sine), Factor::Sine(TAU / pitch)),
                    (wave(Wave::Cosine), Factor::Cosine(TAU / pitch)),
                ]
            }
            Dependence::CoulombMap(map) => {
                let each = 1..=map.terms;
                each.map(|k| (Quantity::CoulombMap(k as u32), Factor::Map(map, k)))
                    .collect()
            }
            Dependence::CoulombLog(logs) => {
                let mut out = beyond_the_first(logs, Quantity::CoulombLog);
                out.extend(beyond_the_first(logs, Quantity::Sigma1Log));
                out
            }
            Dependence::ViscousLog(logs) => beyond_the_first(logs, Quantity::Sigma2Log),
        }
    }

    /// The same about what a record holds: the mean of load and temperature over the samples that
    /// count, the middle of the stroke, the number of its logs.
    pub(crate) fn about(self, record: &Record) -> Self {
        let mean = |channel: &dyn Fn(&Channels) -> &[f64]| {
            let values = record.pick(|s| channel(&s.channels));
            let n = values.len().max(1) as f64;
            // Divided first, so that the sum of very large loads does not overflow.
            values.iter().map(|x| x / n).sum::<f64>()
        };
        match self {
            Dependence::CoulombLoad(_) => Dependence::CoulombLoad(mean(&|c| &c.load)),
            Dependence::CoulombTemperature(_) => {
                Dependence::CoulombTemperature(mean(&|c| &c.temperature))
            }
            Dependence::ViscousTemperature(_) => {
                Dependence::ViscousTemperature(mean(&|c| &c.temperature))
            }
            Dependence::CoulombPosition(_) => {
                let (low, high) = extent(&record.pick(|s| &s.channels.position));
                Dependence::CoulombPosition(if low <= high {
                    low + 0.5 * (high - low)
                } else {
                    0.0
                })
            }
            Dependence::CoulombMap(map) => Dependence::CoulombMap(map.about(record)),
            // What is transmitted follows from all terms.
            Dependence::CoulombTransmitted(_)
            | Dependence::CoulombDriven(_)
            | Dependence::CoulombPitch(_) => self,
            Dependence::CoulombLog(_) => Dependence::CoulombLog(logs(record)),
            Dependence::ViscousLog(_) => Dependence::ViscousLog(logs(record)),
        }
    }
}

/// The logs of a record, also those that gave no samples.
fn logs(record: &Record) -> usize {
    let last = record.segments.iter().map(|s| s.log + 1).max();
    last.unwrap_or(0)
}

/// A parameter of every log but the first, numbered from 2.
fn beyond_the_first(logs: usize, of: fn(u32) -> Quantity) -> Vec<(Quantity, Factor)> {
    let others = 1..logs;
    others.map(|k| (of(k as u32 + 1), Factor::Log(k))).collect()
}

impl Factor {
    /// None for what belongs to a log.
    fn channel<'a>(&self, channels: &'a Channels) -> &'a [f64] {
        match self {
            Factor::Load(_) => &channels.load,
            Factor::Temperature(_) => &channels.temperature,
            Factor::Position(_) | Factor::Sine(_) | Factor::Cosine(_) | Factor::Map(..) => {
                &channels.position
            }
            Factor::Log(_) | Factor::Transmitted(_) | Factor::Driven(_) | Factor::Hat(_) => &[],
        }
    }

    /// The factor at the full rate of a segment; zero (as at the reference) where the channel is
    /// missing, which a fit refuses. One that depends on the sign of the deflection keeps its own sign here
    /// ([`of`](Self::of)).
    pub fn along(&self, segment: &Segment) -> Vec<f64> {
        if let Factor::Log(log) = *self {
            let own = f64::from(u8::from(segment.log == log));
            return vec![own; segment.velocity.len()];
        }
        match *self {
            Factor::Transmitted(of) => {
                let along = of.along(segment).into_iter();
                return along.map(|tau| tau.abs() - of.reference).collect();
            }
            Factor::Driven(of) => return of.along(segment),
            Factor::Hat(hat) => {
                let speeds = segment.velocity.iter().map(|v| v.abs());
                return speeds.map(|speed| hat.value(speed)).collect();
            }
            _ => {}
        }
        let values = self.channel(&segment.channels);
        if values.len() != segment.velocity.len() {
            return vec![0.0; segment.velocity.len()];
        }
        let at = |x: f64| match *self {
            Factor::Load(reference)
            | Factor::Temperature(reference)
            | Factor::Position(reference) => x - reference,
            Factor::Sine(rate) => libm::sin(rate * x),
            Factor::Cosine(rate) => libm::cos(rate * x),
            Factor::Map(map, k) => map.part(k, x),
            Factor::Log(_) | Factor::Transmitted(_) | Factor::Driven(_) | Factor::Hat(_) => 0.0,
        };
        values.iter().map(|&x| at(x)).collect()
    }

    /// What multiplies `eta` where the factor is `along` there: nothing in the other direction than `side`, and of what the load
    /// drives nothing where the motor drives.
    #[inline]
    pub fn of(&self, along: f64, eta: f64, side: Option<Side>) -> f64 {
        if side.is_some_and(|side| !side.selects(eta)) {
            return 0.0;
        }
        match self {
            Factor::Driven(_) if along * eta >= 0.0 => 0.0,
            Factor::Driven(_) => along.abs(),
            _ => along,
        }
    }

    /// Range over which the factor is used, at least: what the log spans, but never less than the mean
    /// load itself and 10 K. A coefficient times this compares with the level it changes. Without this
    /// minimum a load that shows only its noise would look well known.
    pub fn span(&self, record: &Record) -> f64 {
        let largest = record
            .segments
            .iter()
            .flat_map(|s| self.along(s))
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        match self {
            Factor::Load(reference) => largest.max(reference.abs()),
            Factor::Temperature(_) => largest.max(interval::TEMPERATURE_SPAN),
            Factor::Position(_) | Factor::Driven(_) => largest,
            Factor::Transmitted(of) => largest.max(of.reference),
            Factor::Sine(_)
            | Factor::Cosine(_)
            | Factor::Map(..)
            | Factor::Log(_)
            | Factor::Hat(_) => 1.0,
        }
    }
}

/// `eta` times a factor, in one direction of the deflection or both. It goes through zero with `eta`,
/// so the force stays continuous where the direction changes.
pub(crate) fn product(
    eta: &[f64],
    (factor, along): (&Factor, &[f64]),
    side: Option<Side>,
) -> Vec<f64> {
    let each = eta.iter().zip(along);
    each.map(|(&eta, &f)| eta * factor.of(f, eta, side))
        .collect()
}
