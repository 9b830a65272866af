//! Friction in steady sliding by speed, whatever the law.
//!
//! The friction of each direction is a piecewise linear function of the speed times the deflection of a Dahl bristle, fitted with
//! the mass and the forces beside friction. Half of the sum of both directions has no constant force in it, and scatters less from
//! log to log than any parameter of a law.

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::estimate::sliding::slides;
use crate::estimate::{Estimate, outweighs_inertia};
use crate::law::prior::Prior;
use crate::law::terms::{ColumnKind, Delay, Side, Terms};
use crate::law::{Law, LawKind};
use crate::scatter::strokes::Strokes;
use crate::scatter::{Fitted, HalfWidths, Scatter};
use crate::separable::follow;
use crate::separable::logs::Logs;
use crate::separable::objective::Evaluation;
use crate::separable::settings::Settings;
use nalgebra::DVector;
use std::ops::Range;
use stiction_search::{Observer, Status};

/// Most knots of the curve.
const KNOTS: usize = 7;
/// First knot, in parts of the top speed: below it the fitted curve is constant, so that it takes up rests and break-away and is not
/// stated.
const FIRST: f64 = 0.02;
/// Fewest samples of a direction nearest to a knot, for each unknown of the curve.
const SAMPLES: usize = 4;
/// Speeds between two knots at which the curve is stated.
const BETWEEN: usize = 4;

/// Friction by speed.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionCurve {
    /// Speeds from the least to the largest at which friction outweighs inertia, m/s or rad/s.
    pub speed: Vec<f64>,
    /// Friction of the directions that the log has.
    pub directions: Vec<OfDirection>,
    /// Half of the sum of both directions, N (N m); empty for one direction.
    pub both: Vec<Level>,
    /// Coulomb and viscous friction, N and N s/m (N m and N m s/rad), of the straight line nearest to it from a tenth of the top speed
    /// on; `None` for one direction, for one speed, and where the curve ends below half of the top speed of the log.
    pub line: Option<[Level; 2]>,
    /// Correlations from day to day, -1 to 1: of the two, and of each with the mass, where it is fitted.
    pub correlation: Option<(f64, Option<[f64; 2]>)>,
    /// Half of their difference: a constant force, a weight, or friction that differs.
    pub constant: Vec<Level>,
    /// Half of the sum at a twentieth, half and all of the largest speed, none below the least; of a single direction its own.
    pub at: Vec<Level>,
}

/// The curve of one direction, with the constant force.
#[derive(Clone, Debug, PartialEq)]
pub struct OfDirection {
    /// Whether it is motion forward.
    pub forward: bool,
    /// At the speeds of the curve; against the motion, N (N m).
    pub level: Vec<Level>,
}

/// Friction at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Speed, m/s or rad/s.
    pub speed: f64,
    /// Force against the motion, N (N m).
    pub force: f64,
    /// Half of its 95 % interval.
    pub half: HalfWidths,
}

/// Parts of the top speed of the curve at which friction is stated in three numbers.
const PARTS: [f64; 3] = [0.05, 0.5, 1.0];

/// Part of the top speed from which on a line of Coulomb and viscous friction is taken: below it lies the Stribeck curve, which no
/// line describes.
const LINE: f64 = 0.1;
/// Part of the top speed of the log that the curve reaches at least, for a line to stand for all of it. Source: choice.
const REACH: f64 = 0.5;

/// A piecewise linear function of the speed that is 1 at a knot and 0 at its neighbours, constant beyond the outer ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hat {
    below: f64,
    at: f64,
    above: f64,
}

/// The parts of a curve by speed, each in one direction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hats(pub(crate) Vec<(Hat, Side)>);

impl Hat {
    /// At a speed.
    pub fn value(&self, speed: f64) -> f64 {
        let rising = (speed - self.below) / (self.at - self.below);
        let falling = (self.above - speed) / (self.above - self.at);
        match speed < self.at {
            _ if self.below.is_infinite() && speed <= self.at => 1.0,
            _ if self.above.is_infinite() && speed >= self.at => 1.0,
            true => rising.clamp(0.0, 1.0),
            false => falling.clamp(0.0, 1.0),
        }
    }

    /// Those of some knots.
    fn of(knots: &[f64]) -> Vec<Self> {
        let at =
            |k: Option<usize>, beyond: f64| k.and_then(|k| knots.get(k)).copied().unwrap_or(beyond);
        let hat = |k: usize| Hat {
            below: at(k.checked_sub(1), f64::NEG_INFINITY),
            at: knots[k],
            above: at(Some(k + 1), f64::INFINITY),
        };
        (0..knots.len()).map(hat).collect()
    }
}

/// The curve of a record beside a law that was fitted to it: with its mass, delay and the forces beside friction as unknowns, as there.
/// `None` where the axis does not slide, where the record has less than it takes, and where the search was stopped.
///
/// # Errors
/// Those of the fit of a law.
pub fn friction_curve(
    record: &Record,
    fitted: &Estimate,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Option<FrictionCurve>, Error> {
    if fitted.stays_in_presliding() {
        return Ok(None);
    }
    let record = &sliding(record, fitted);
    let strokes = Strokes::of(record);
    let Some((knots, told, sides)) = knots(&strokes, &outweighs_inertia(record, fitted)) else {
        return Ok(None);
    };
    let hats = Hat::of(&knots);
    let terms = Terms {
        curve: Hats(
            sides
                .iter()
                .flat_map(|side| hats.iter().map(|hat| (*hat, *side)))
                .collect(),
        ),
        offset: false,
        quadratic_viscous: false,
        delay: Delay::Given(fitted.delay_samples() * record.step()),
        ..fitted.terms.clone()
    };
    let law = Law::new(LawKind::Dahl);
    let kappa = fitted
        .law
        .layout()
        .kappa
        .filter(|_| !fitted.law.kind.has_elements());
    let length = kappa.and_then(|at| fitted.unknowns().get(at)).copied();
    let start = length.unwrap_or_else(|| Prior::of(record, &strokes, 0.0).kappa().0);
    let optimum = follow(&[start], record, law, &terms, settings, observer)?;
    if optimum.status == Status::Interrupted {
        return Ok(None);
    }
    let columns = terms.columns(&law);
    let mass = columns
        .iter()
        .position(|own| matches!(own.column, ColumnKind::Acceleration));
    Ok(stated(
        record,
        &strokes,
        (&hats, told, &sides),
        mass,
        &optimum.evaluation,
    ))
}

/// The record without what lies between a reversal and the turn of the bristles, where friction is not that of steady sliding.
fn sliding(record: &Record, fitted: &Estimate) -> Record {
    let strokes = Strokes::of(record);
    let slides = |travel: &f64| slides(*travel, &fitted.parameters);
    let mut slides = strokes.travel.iter().map(slides);
    let all = record.segments.iter().flat_map(|segment| &segment.keep);
    let counts: Vec<bool> = all
        .map(|keep| *keep && slides.next() == Some(true))
        .collect();
    record.masked(|i| counts[i])
}

/// Knots that the speeds of every direction reach, which of them are stated, and the directions; `None` where none is.
///
/// Where inertia outweighs friction, an error of some per cent in its size or timing is one of as many in friction or more, and comes
/// again in every stroke, so that no scatter shows it. Speeds that are only passed so have no knot between those that are stated; beyond
/// they keep theirs, which then take up that error.
fn knots(strokes: &Strokes, is_known: &[bool]) -> Option<(Vec<f64>, Range<usize>, Vec<Side>)> {
    let of = |sense: f64, known: bool| {
        let each = strokes.speed.iter().zip(&strokes.sense).zip(is_known);
        each.filter(move |((_, own), is_known)| **own == sense && (**is_known || !known))
            .map(|((speed, _), _)| *speed)
    };
    let sides: Vec<(Side, f64)> = [(Side::Positive, 1.0), (Side::Negative, -1.0)]
        .into_iter()
        .filter(|(_, sense)| {
            let moving = of(*sense, false).filter(|v| *v > FIRST * strokes.top);
            moving.count() > SAMPLES * KNOTS
        })
        .collect();
    let last = (KNOTS - 1) as f64;
    let root = FIRST.sqrt();
    let knot = |k: usize| strokes.top * (root + (1.0 - root) * k as f64 / last).powi(2);
    let fastest = strokes.speed.iter().copied().fold(0.0, f64::max);
    let mut all: Vec<f64> = (0..KNOTS).map(knot).collect();
    all.extend(Some(fastest).filter(|fastest| *fastest > knot(KNOTS)));
    let hats = Hat::of(&all);
    let seen = |hat: &Hat, known: bool| {
        // Its own: two knots around a single speed are not told apart.
        let own = |sense: f64| of(sense, known).filter(|speed| hat.value(*speed) > 0.5);
        sides
            .iter()
            .all(|(_, sense)| own(*sense).count() >= SAMPLES)
    };
    // The outer ones hold what is slower and faster too: rests, break-away, a few samples beyond the top speed.
    let mut known = hats[1..KNOTS].iter().filter(|hat| seen(hat, true));
    let first = known.next()?.at;
    let last = known.next_back().map_or(first, |hat| hat.at);
    let used = hats
        .iter()
        .filter(|hat| seen(hat, (first..=last).contains(&hat.at)));
    let knots: Vec<f64> = used.map(|hat| hat.at).collect();
    let told = knots.partition_point(|at| *at < first)..knots.partition_point(|at| *at <= last);
    let sides: Vec<Side> = sides.into_iter().map(|(side, _)| side).collect();
    (!sides.is_empty() && strokes.top > 0.0).then_some((knots, told, sides))
}

/// The curve of a fit whose first linear unknowns are the knots of each direction, at those that are stated; the mass is at a place among
/// all.
fn stated(
    record: &Record,
    strokes: &Strokes,
    (hats, told, sides): (&[Hat], Range<usize>, &[Side]),
    mass: Option<usize>,
    at: &Evaluation,
) -> Option<FrictionCurve> {
    let c = &at.solution.coefficients;
    let knots = hats.len() * sides.len();
    // Place of each linear unknown among the parameters.
    let nonlinear = at.slopes.len();
    let mut place = vec![None; c.len()];
    let active = (0..c.len()).filter(|j| at.solution.active[*j]);
    for (k, j) in active.enumerate() {
        place[j] = Some(nonlinear + k);
    }
    if place[..knots].contains(&None) {
        return None;
    }
    let mut friction = vec![0.0; at.residual().len()];
    for (column, c) in at.columns[..knots].iter().zip(c.iter()) {
        friction
            .iter_mut()
            .zip(column.iter())
            .for_each(|(f, x)| *f += c * x);
    }
    let jacobian = at.jacobian();
    let mut prior = vec![0.0; jacobian.len()];
    let known = Prior::of(record, strokes, 0.0).kappa().1;
    prior[..nonlinear].fill(1.0 / (known * known));
    let logs = Logs::of(record);
    let logs = logs.as_ref().map_or(&[][..], |logs| logs.ranges());
    let fit = Fitted {
        jacobian,
        residual: at.residual(),
        friction: &friction,
        logs,
        prior,
    };
    let scatter = Scatter::from_strokes(&fit, strokes)?.with_transfer(&fit, strokes);
    let all = at.slopes.len() + at.solution.active.iter().filter(|active| **active).count();
    // A sum over speeds with their weights, of the directions by theirs, with its derivatives.
    let weighed = |speeds: &[(f64, f64)], directions: &[f64]| {
        let mut gradient = DVector::zeros(all);
        let mut force = 0.0;
        for (s, part) in directions.iter().enumerate() {
            for (k, hat) in hats.iter().enumerate() {
                let j = s * hats.len() + k;
                let each = speeds
                    .iter()
                    .map(|(speed, weight)| weight * hat.value(*speed));
                let weight = part * each.sum::<f64>();
                force += weight * c[j];
                if let Some(i) = place[j] {
                    gradient[i] += weight;
                }
            }
        }
        (force, gradient)
    };
    let stated = |speed: f64, (force, gradient): &(f64, DVector<f64>)| Level {
        speed,
        force: *force,
        half: scatter.variances(gradient).half_widths(),
    };
    let level =
        |speed: f64, directions: &[f64]| stated(speed, &weighed(&[(speed, 1.0)], directions));
    let speed: Vec<f64> = hats[told.clone()]
        .windows(2)
        .flat_map(|pair| {
            let step = (pair[1].at - pair[0].at) / BETWEEN as f64;
            (0..BETWEEN).map(move |i| pair[0].at + i as f64 * step)
        })
        .chain(hats[told].last().map(|hat| hat.at))
        .collect();
    let (least, top) = (*speed.first()?, *speed.last()?);
    let along = |weights: &[f64]| speed.iter().map(|v| level(*v, weights)).collect();
    let two = sides.len() == 2;
    let alone = |s: usize| {
        let mut weights = vec![0.0; sides.len()];
        weights[s] = 1.0;
        weights
    };
    let directions = sides.iter().enumerate().map(|(s, side)| OfDirection {
        forward: *side == Side::Positive,
        level: along(&alone(s)),
    });
    let half = if two { vec![0.5; 2] } else { vec![1.0] };
    let both: Vec<Level> = if two { along(&half) } else { Vec::new() };
    // The line nearest to it, each speed counted as far as to its neighbours.
    let line = (two && speed.len() > 1 && top >= REACH * strokes.top).then(|| {
        let within = |v: &f64| if *v >= LINE * top { 1.0 } else { 0.0 };
        let weights = spacing(&speed).into_iter().zip(&speed);
        let weights: Vec<f64> = weights.map(|(w, v)| w * within(v)).collect();
        let moment = |power: i32| -> f64 {
            let each = speed.iter().zip(&weights);
            each.map(|(v, w)| w * v.powi(power)).sum()
        };
        let [n, mean, square] = [0, 1, 2].map(moment);
        let size = n * square - mean * mean;
        let weighted = |of: &dyn Fn(f64) -> f64| {
            let each = speed.iter().zip(&weights);
            let parts: Vec<(f64, f64)> = each.map(|(v, w)| (*v, w * of(*v) / size)).collect();
            weighed(&parts, &half)
        };
        [
            weighted(&|v| square - mean * v),
            weighted(&|v| n * v - mean),
        ]
    });
    let mut at: Vec<f64> = PARTS.map(|part| (part * top).max(least)).into();
    at.dedup();
    Some(FrictionCurve {
        directions: directions.collect(),
        both,
        correlation: line.as_ref().map(|[coulomb, viscous]| {
            let with_mass = mass.and_then(|j| place[j]).map(|i| {
                let mut own = DVector::zeros(all);
                own[i] = 1.0;
                [coulomb, viscous].map(|of| scatter.correlation(&own, &of.1))
            });
            (scatter.correlation(&coulomb.1, &viscous.1), with_mass)
        }),
        line: line.map(|own| own.map(|own| stated(top, &own))),
        constant: if two { along(&[0.5, -0.5]) } else { Vec::new() },
        at: at.iter().map(|speed| level(*speed, &half)).collect(),
        speed,
    })
}

/// Half of the way from the neighbour below each of some speeds to the one above.
fn spacing(speed: &[f64]) -> Vec<f64> {
    let at = |i: usize| speed[i.min(speed.len() - 1)];
    let each = 0..speed.len();
    each.map(|i| 0.5 * (at(i + 1) - at(i.saturating_sub(1))))
        .collect()
}
