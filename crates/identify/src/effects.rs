//! What the residual of a law shows: forces and changes of friction that the law does not have.
//!
//! Every effect gives columns: by how much the force would differ with a little of it. All are judged alike. The law and the columns
//! are fitted again, linearised, without a quarter of the strokes in turn; what the strokes that were left out have less of an error
//! with the columns than without is what the effect explains. The effect that explains most is taken up beside the law, and the others
//! are judged again beside it, so that what one explains no other is named for. Strokes judge whether it is chance.
//!
//! It is a diagnosis: no effect enters an interval.

pub(crate) mod beside;
mod gap;
mod held_out;
mod levels;
mod limit;
mod measures;
mod other_shape;
mod single;
mod spring;
mod waves;

use self::beside::Beside;
use self::held_out::{HeldOut, Score};
use self::measures::Measures;
use crate::conditioning::record::Segment;
use crate::conditioning::record::extent;
use crate::law::terms::{ColumnKind, Terms};
use crate::scatter::strokes::Strokes;
use crate::separable::objective::{Evaluation, Objective};
use stiction_policy::effect;

/// A force, or a change of friction, that a law does not have.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// What it is.
    pub effect: Effect,
    /// Part of the variance of what the law leaves on strokes that were not fitted which is gone with it, beside the effects before it,
    /// 0 to 1.
    pub explains: f64,
    /// Relative standard deviation of its pitch, frequency, width or factor, by strokes.
    pub deviation: f64,
    /// Its course: what it goes with (s, m, N, K, Hz, or with rad), and the part of itself by which a level of friction differs, the
    /// force, or the part of the residual that it explains there.
    pub course: Vec<(f64, f64)>,
}

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// The level of friction changes during the log: least and largest, in parts of its mean.
    Drift([f64; 2]),
    /// The level of friction changes along the stroke: least and largest, in parts of its mean, and whether it goes as a line.
    Position([f64; 2], bool),
    /// The level of friction changes with the load that the log has.
    Load([f64; 2]),
    /// The level of friction changes with the temperature that the log has.
    Temperature([f64; 2]),
    /// A force that repeats with the position.
    Ripple(Wave),
    /// A level of friction that repeats with the position, as parts of its mean.
    LevelWave(Wave),
    /// A force that changes smoothly with the position, as that of a spring or, on less than a quarter turn, of a weight: by how much it
    /// drives back, N/m or with rad.
    SpringForce(f64),
    /// A load on a spring.
    Resonance {
        /// Frequency of the load while the motor stands still, `sqrt(k/m)/2 pi`, Hz.
        frequency: f64,
        /// The load, in parts of the moving mass.
        load: f64,
        /// Whether the encoder is on the load.
        read_at_load: bool,
    },
    /// A load behind a gap.
    Backlash {
        /// Lost motion, m or rad.
        width: f64,
        /// The load, in parts of the moving mass.
        load: f64,
    },
    /// Dynamics between force and motion that a rigid mass and a delay do not have: half the square of a time, s^2. Negative where
    /// the logged force is smoother than what belongs to its motion.
    Dynamics(f64),
    /// Two clocks that run apart: by how much the force falls further behind its motion, s/s.
    Clocks(f64),
    /// A drive that gave no more than this, and the part of the samples with more.
    Limit(f64, f64),
    /// A stated mass that is another one, kg or kg m^2.
    Mass(f64),
    /// A stated delay that is another one, s.
    Delay(f64),
    /// Friction that follows the travel after a reversal in another way than one bristle.
    Bristles,
    /// Friction that follows the speed in another way than the law.
    Curve,
}

/// A wave over the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Pitch, m or rad.
    pub pitch: f64,
    /// Amplitude, in the unit of the force or in parts of the level.
    pub amplitude: f64,
    /// The stroke, m or rad.
    pub stroke: f64,
    /// Which wave of its kind in the terms, counted from 0, is off by so much that this one explains what it leaves; none for one more.
    pub replaces: Option<usize>,
}

impl Effect {
    /// Whether it is a shape of friction, and no other force or change.
    pub fn is_a_shape(&self) -> bool {
        matches!(self, Effect::Bristles | Effect::Curve)
    }

    /// Whether it describes what is left and does not say where it comes from.
    fn is_general(&self) -> bool {
        self.is_a_shape() || matches!(self, Effect::Dynamics(_))
    }

    /// Whether it has one size, which has to be known.
    fn has_a_size(&self) -> bool {
        let levels = matches!(
            self,
            Effect::Drift(_) | Effect::Position(..) | Effect::Load(_) | Effect::Temperature(_)
        );
        !(levels || self.is_a_shape() || matches!(self, Effect::SpringForce(_)))
    }

    /// Whether it is as a mass on a motion of one frequency.
    fn goes_with_the_mass(&self) -> bool {
        matches!(self, Effect::SpringForce(_) | Effect::Resonance { .. })
    }

    /// Whether an error of a model of gravity, inertia and coupling looks alike.
    fn may_be_of_a_rigid_body(&self) -> bool {
        matches!(
            self,
            Effect::SpringForce(_) | Effect::Resonance { .. } | Effect::Dynamics(_)
        )
    }

    /// Whether two are of one kind.
    fn is_like(&self, other: &Effect) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

/// A fitted law, and what it leaves.
struct Fitted<'a> {
    objective: &'a Objective<'a>,
    terms: &'a Terms,
    at: &'a Evaluation,
    p: &'a [f64],
    measures: Measures,
    /// How often the axis turns back.
    reversals: usize,
    /// The level of friction that a change multiplies, at the kept samples, in the unit of the force.
    level: Vec<f64>,
    /// Moving mass, kg or kg m^2; 0 where there is none.
    mass: f64,
}

impl Fitted<'_> {
    /// Least and largest position, m or rad; `None` where the stroke is no longer than a few bristles.
    fn stroke(&self) -> Option<(f64, f64)> {
        let (low, high) = extent(&self.measures.position);
        let kappa = self.objective.law().layout().kappa;
        let length = kappa.map_or(0.0, |i| libm::exp(-self.p[i]));
        let stroke = high - low;
        (stroke > effect::MIN_BRISTLE_LENGTHS * length && stroke > 0.0 && stroke.is_finite())
            .then_some((low, high))
    }
}

/// What an effect is with some coefficients; `None` where these are none of such an effect.
type Made = Box<dyn Fn(&[f64]) -> Option<Effect>>;

/// An effect, as it would change the force.
struct Candidate {
    columns: Vec<Vec<f64>>,
    effect: Made,
    /// What a relative change of its size changes the force by, for a first column with a coefficient of 1.
    slope: Option<Vec<f64>>,
    /// What it goes with, at the kept samples; empty where `course` is known.
    along: Vec<f64>,
    /// Whether it changes the level of friction.
    is_of_level: bool,
    course: Vec<(f64, f64)>,
}

impl Candidate {
    fn new(columns: Vec<Vec<f64>>, effect: impl Fn(&[f64]) -> Option<Effect> + 'static) -> Self {
        Self {
            columns,
            effect: Box::new(effect),
            slope: None,
            along: Vec::new(),
            is_of_level: false,
            course: Vec::new(),
        }
    }
}

/// What a fit leaves: the effects that explain most of it, the largest first.
pub(crate) fn sought(
    objective: &Objective,
    terms: &Terms,
    (at, p): (&Evaluation, &[f64]),
    residual: &[f64],
) -> Vec<Found> {
    let friction = friction(objective, at);
    let viscous = viscous(objective, at);
    let fitted = Fitted {
        objective,
        terms,
        at,
        p,
        measures: Measures::of(objective.record()),
        reversals: Strokes::of(objective.record())
            .length
            .len()
            .saturating_sub(1),
        level: friction.iter().zip(viscous).map(|(f, v)| f - v).collect(),
        mass: objective.mass(&at.solution.coefficients).unwrap_or(0.0),
    };
    let Some(mut held_out) = HeldOut::of(objective.record(), &at.jacobian(), residual) else {
        return Vec::new();
    };
    let mut beside = Beside::new(&at.jacobian(), residual);
    let mut found: Vec<Found> = Vec::new();
    let modelled = |s: &Segment| !s.channels.external_deviations.is_empty();
    let beside_a_model = objective.record().segments.iter().any(modelled);
    let all = held_out.left();
    let fixed = single::candidates(&fitted).into_iter();
    let fixed = fixed.chain(levels::candidates(&fitted));
    let fixed: Vec<Candidate> = fixed.chain(other_shape::candidates(&fitted)).collect();
    while found.len() < effect::MAX_REPORTED {
        let sized = waves::candidates(&fitted, &beside).into_iter();
        let sized = sized.chain(limit::candidate(&fitted, &beside));
        let sized = sized.chain(spring::candidates(&fitted, &beside));
        let sized: Vec<Candidate> = sized.chain(gap::candidate(&fitted, &beside)).collect();
        let judged = fixed.iter().chain(&sized).filter_map(|candidate| {
            let score = held_out.score(&candidate.columns);
            let effect = (candidate.effect)(&score.coefficients)?;
            let is_new = found.iter().all(|own| !own.effect.is_like(&effect));
            let apart =
                |column: &Vec<f64>| beside.part_outside(column) >= effect::MIN_INDEPENDENT_PART;
            let is_apart = !effect.goes_with_the_mass() || candidate.columns.iter().all(apart);
            let may_be = !(beside_a_model && effect.may_be_of_a_rigid_body());
            (is_new && is_sure(&score, all) && is_apart && may_be)
                .then_some((candidate, score, effect))
        });
        let judged: Vec<_> = judged.collect();
        let most = |general: bool| {
            let own = judged.iter().filter(|own| general || !own.2.is_general());
            own.max_by(|a, b| a.1.gain.total_cmp(&b.1.gain))
        };
        let Some(best) = most(true) else {
            break;
        };
        let special =
            most(false).filter(|own| own.1.gain >= effect::MIN_SPECIAL_PART * best.1.gain);
        let (candidate, score, effect) = special.unwrap_or(best);
        let effect = *effect;
        let course = course(candidate, &fitted, beside.residual());
        for column in &candidate.columns {
            beside = beside.with(column);
        }
        let slope = candidate.slope.as_ref().map(|slope| {
            let size =
                score.coefficients[0].hypot(score.coefficients.get(1).copied().unwrap_or(0.0));
            slope.iter().map(|x| size * x).collect::<Vec<f64>>()
        });
        // A pitch that is off is off by a part, which is the coefficient.
        let unit = match effect {
            Effect::Ripple(wave) | Effect::LevelWave(wave) if wave.replaces.is_some() => {
                score.coefficients[0].abs()
            }
            _ => 1.0,
        };
        found.push(Found {
            effect,
            explains: score.gain / all,
            deviation: match slope {
                Some(slope) => held_out.deviation(&beside.outside(&slope), beside.residual()),
                None => unit * score.deviation,
            },
            course,
        });
        held_out = held_out.with(&candidate.columns);
    }
    found
}

/// The effects whose size is known and that explain far more than those of their kind do in `replicas`, where encoder and filters alone
/// make them.
pub(crate) fn beyond(found: Vec<Found>, replicas: &[Found]) -> Vec<Found> {
    let made = |own: &Found| {
        let alike = replicas
            .iter()
            .filter(|other| own.effect.is_like(&other.effect));
        alike.map(|other| other.explains).fold(0.0, f64::max)
    };
    let kept = found.into_iter();
    let known =
        |own: &Found| !own.effect.has_a_size() || own.deviation <= effect::MAX_RELATIVE_DEVIATION;
    kept.filter(|own| known(own) && own.explains > effect::MIN_OVER_REPLICAS * made(own))
        .collect()
}

fn is_sure(score: &Score, all: f64) -> bool {
    score.gain >= effect::MIN_EXPLAINED * all
        && score.gain >= effect::MIN_STROKE_DEVIATIONS * score.gain_deviation
}

/// Places at which the course of an effect is shown.
const PLACES: usize = 32;

/// What an effect changes over what it goes with.
fn course(candidate: &Candidate, fitted: &Fitted, residual: &[f64]) -> Vec<(f64, f64)> {
    if candidate.along.is_empty() {
        return candidate.course.clone();
    }
    let (low, high) = extent(&candidate.along);
    let mut sums = [[0.0; 4]; PLACES];
    for (i, x) in candidate.along.iter().enumerate() {
        let weight = if candidate.is_of_level {
            fitted.level[i]
        } else {
            1.0
        };
        let place = (PLACES as f64 * (x - low) / (high - low)) as usize;
        let own = &mut sums[place.min(PLACES - 1)];
        for (sum, more) in own
            .iter_mut()
            .zip([1.0, *x, weight * weight, weight * residual[i]])
        {
            *sum += more;
        }
    }
    let known = sums.iter().filter(|[_, _, square, _]| *square > 0.0);
    known
        .map(|[n, x, square, product]| (x / n, product / square))
        .collect()
}

/// Friction as the law has it at the kept samples.
pub(crate) fn friction(objective: &Objective, at: &Evaluation) -> Vec<f64> {
    sum_of(objective, at, |column| {
        let beside = [ColumnKind::Acceleration, ColumnKind::One];
        let wave = matches!(column, ColumnKind::Sine(_) | ColumnKind::Cosine(_));
        !wave && !beside.contains(column)
    })
}

/// The part of it that grows with speed.
fn viscous(objective: &Objective, at: &Evaluation) -> Vec<f64> {
    sum_of(objective, at, |column| {
        matches!(
            column,
            ColumnKind::Speed(_) | ColumnKind::Square(_) | ColumnKind::SpeedTimes(..)
        )
    })
}

/// The force of the linear terms of some kinds at the kept samples.
fn sum_of(objective: &Objective, at: &Evaluation, is: impl Fn(&ColumnKind) -> bool) -> Vec<f64> {
    let mut out = vec![0.0; at.residual().len()];
    let columns = at.columns.iter().zip(&at.solution.coefficients);
    let terms = objective.linear().iter().zip(columns);
    for (_, (column, c)) in terms.filter(|(term, _)| is(&term.column)) {
        for (y, x) in out.iter_mut().zip(column.iter()) {
            *y += c * x;
        }
    }
    out
}
