//! How much of the delay of a force that a drive was asked for is a lag.
//!
//! A drive holds the force that it was asked for until the next period, may compute for a while, and passes it through a
//! current loop. To first order all of that is a delay, which a fit finds. To second order a lag of the time constant `tau`
//! makes the force smaller too, by `(omega tau)^2 / 2` where a delay changes nothing: taken for a delay, it makes the mass too
//! large. The square of the time constant lies between 0 and that of the time by which the force acts later than one that is
//! held, all values there equally likely before the log is asked. The log is asked with cut-offs at which noise of the position
//! has no say: what a high common cut-off leaves of it looks like a square below zero, what a low one on the position takes off
//! the motion as well. What is left open counts in the intervals of all that follows.

use crate::conditioning::record::{Record, Samples};
use crate::conditioning::{Conditioning, Cutoff, condition_as};
use crate::error::Error;
use crate::estimate::uncertainty::{Unknowns, followed, sandwich};
use crate::law::Law;
use crate::law::terms::{Delay, Lag, Terms};
use crate::replica::HELD_DELAY;
use crate::separable::follow;
use crate::separable::objective::{Evaluation, Objective};
use crate::separable::optimum::Optimum;
use crate::separable::settings::Settings;
use nalgebra::DMatrix;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI, SQRT_2};
use stiction_policy::delay;
use stiction_search::{Counts, Observer, Status};

/// Cut-offs at which the log is asked, parts of the sample rate: on the position, and in common.
const CUTOFFS: [f64; 2] = [0.1, 0.035];
/// What a force that is held loses, as the square of a lag, samples. Replicas show that.
const HELD_SQUARE: f64 = 1.0 / 12.0;
/// Most fits beside a lag that is known better and better.
const MOST_FITS: usize = 4;
/// Change of the square of the lag, in parts of its deviation, that is none any more.
const SETTLED: f64 = 0.1;

/// The lag that logs show, `near` being a fit of them on a record with any cut-offs, and what it took; `None` where the force does not act
/// later than one that is held, or the observer stops it.
pub(crate) fn lag(
    logs: &[Samples],
    (wanted, record): (&Conditioning, &Record),
    terms: &Terms,
    near: &Optimum,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Option<(Lag, Counts)>, Error> {
    if longest(&near.law, terms, near).is_none() {
        return Ok(None);
    }
    let conditioning = asked(wanted, record);
    // A short log may not bear these cut-offs.
    let Ok(record) = condition_as(logs, &conditioning, 0.0) else {
        return Ok(None);
    };
    let mut terms = terms.about(&record);
    let mut counts = Counts::default();
    let mut found = None;
    let mut start = near.p.clone();
    for _ in 0..MOST_FITS {
        let optimum = follow(&start, &record, near.law, &terms, settings, observer)?;
        counts.add(&optimum.counts);
        if optimum.status == Status::Interrupted {
            return Ok(None);
        }
        let Some(next) = at(&record, &terms, &optimum) else {
            break;
        };
        let change = (next.square - terms.lag.square).abs();
        terms.lag = next;
        found = Some((next.assumed(), counts));
        if change < SETTLED * next.variance.sqrt() {
            break;
        }
        start = optimum.p;
    }
    Ok(found)
}

/// The conditioning with the cut-offs at which logs are asked, `record` being one of them.
pub(crate) fn asked(wanted: &Conditioning, record: &Record) -> Conditioning {
    let rate = 1.0 / record.step();
    let [source, common] = CUTOFFS.map(|part| Cutoff::Hz(part * rate));
    Conditioning {
        source_cutoff: source,
        common_cutoff: common,
        min_speed: delay::MIN_LAG_SPEED * record.top_speed(),
        ..*wanted
    }
}

/// The longest lag that the delay of a fit leaves room for, samples; `None` where nothing is asked.
fn longest(law: &Law, terms: &Terms, optimum: &Optimum) -> Option<f64> {
    let asked = terms.delay == Delay::Fitted && law.layout().kappa.is_some();
    let delay = optimum.p.last().filter(|_| asked && optimum.delay)?;
    let most = HELD_DELAY - delay;
    (most >= delay::MIN_LAG).then_some(most)
}

/// What a fit says of the lag.
fn at(record: &Record, terms: &Terms, optimum: &Optimum) -> Option<Lag> {
    let most = longest(&optimum.law, terms, optimum)?;
    let unit = record.step() * record.step();
    let (further, variance) = further(record, terms, optimum)?;
    let found = terms.lag.square / unit + further;
    let (square, variance) = between(found, variance, most * most);
    Some(Lag {
        square: square * unit,
        variance: variance * unit * unit,
    })
}

/// By how much the square of the lag is more than that of a fit, and its variance, in samples; negative where a force was logged
/// behind a low-pass.
pub(crate) fn further(record: &Record, terms: &Terms, optimum: &Optimum) -> Option<(f64, f64)> {
    let objective = Objective::new(record, optimum.law, terms);
    let at = &optimum.evaluation;
    let bend = objective.bend(&optimum.p, &at.solution.coefficients);
    let known = beside(&objective, at, &bend);
    let own = known.bread.nrows() - 1;
    let score: f64 = bend.iter().zip(at.residual()).map(|(x, r)| x * r).sum();
    let (square, variance) = (
        known.bread[(own, own)] * score,
        known.covariance[(own, own)],
    );
    let finite = square.is_finite() && variance.is_finite();
    finite.then_some((square - HELD_SQUARE, variance))
}

/// Uncertainty of the unknowns that are not held at zero, and of the square of the lag, the last of them.
fn beside(objective: &Objective, at: &Evaluation, bend: &[f64]) -> Unknowns {
    let mut jacobian = at.jacobian();
    jacobian.push(bend);
    sandwich(&jacobian, at.residual(), &objective.record().breaks())
}

/// Covariance of the unknowns, nonlinear then linear, that comes of what is open of the lag; `None` where nothing is.
pub(crate) fn spread(
    objective: &Objective,
    lag: Lag,
    p: &[f64],
    at: &Evaluation,
) -> Option<DMatrix<f64>> {
    let unit = objective.record().step() * objective.record().step();
    beside_a_square(objective, lag.variance / (unit * unit), p, at)
}

/// Covariance of the unknowns, nonlinear then linear, beside the square of a time of which so much is open, samples^4; `None` where nothing
/// is.
pub(crate) fn beside_a_square(
    objective: &Objective,
    variance: f64,
    p: &[f64],
    at: &Evaluation,
) -> Option<DMatrix<f64>> {
    if variance.is_nan() || variance <= 0.0 || !objective.is_delayed() {
        return None;
    }
    let bend = objective.bend(p, &at.solution.coefficients);
    let bread = beside(objective, at, &bend).bread;
    let followed = followed(at, &bread)?;
    let covariance = |i: usize, j: usize| variance * followed[i] * followed[j];
    Some(DMatrix::from_fn(followed.len(), followed.len(), covariance))
}

/// Mean and variance of a normal number of this mean and variance that lies between 0 and `most` (Johnson, Kotz and
/// Balakrishnan 1994, ISBN 0-471-58495-9, section 13.10.1).
fn between(mean: f64, variance: f64, most: f64) -> (f64, f64) {
    let deviation = variance.sqrt();
    let flat = (0.5 * most, most * most / 12.0);
    if !(deviation.is_finite() && mean.is_finite()) {
        return flat;
    }
    let [low, high] = [-mean / deviation, (most - mean) / deviation];
    let mass = 0.5 * (libm::erfc(low * FRAC_1_SQRT_2) - libm::erfc(high * FRAC_1_SQRT_2));
    // Far outside, all of it is at the nearer end.
    if mass.is_nan() || mass < 1e-9 {
        return match mean {
            m if m <= 0.0 => (0.0, 0.0),
            m if m >= most => (most, 0.0),
            _ => (mean, variance),
        };
    }
    let density = |x: f64| 0.5 * FRAC_2_SQRT_PI / SQRT_2 * libm::exp(-0.5 * x * x);
    let [at_low, at_high] = [density(low), density(high)];
    let shift = (at_low - at_high) / mass;
    let narrower = (low * at_low - high * at_high) / mass;
    let variance = variance * (1.0 + narrower - shift * shift).max(0.0);
    ((mean + deviation * shift).clamp(0.0, most), variance)
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn between_two_ends() {
        // A flat density, half a normal one, a normal one.
        let (mean, variance) = between(0.3, 1e6, 2.0);
        assert!((mean - 1.0).abs() < 1e-5 && (variance - 4.0 / 12.0).abs() < 1e-5);
        let (mean, variance) = between(0.0, 1.0, 1e3);
        let pi = std::f64::consts::PI;
        assert!((mean - (2.0 / pi).sqrt()).abs() < 1e-12);
        assert!((variance - (1.0 - 2.0 / pi)).abs() < 1e-12);
        let (mean, variance) = between(5.0, 0.01, 10.0);
        assert!((mean - 5.0).abs() < 1e-12 && (variance - 0.01).abs() < 1e-12);
        assert_eq!(between(-50.0, 1.0, 1.0), (0.0, 0.0));
        assert_eq!(between(50.0, 1.0, 1.0), (1.0, 0.0));
        assert_eq!(between(f64::NAN, 1.0, 2.0).0, 1.0);
    }
}
