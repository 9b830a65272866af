//! Force and motion that were stamped by two clocks, of which one runs fast.
//!
//! The delay of the force then grows along the log, and the force that a law with one delay lacks is the derivative of the force
//! with respect to the delay times the time. As for a [`coupling`](super::coupling), that is one more column.

use super::coupling::beside::Beside;
use crate::conditioning::record::Record;
use crate::separable::objective::{Evaluation, Objective};

/// Parts of the log, each of which is left out in turn to see how surely the delay grows.
const PARTS: usize = 8;
/// Standard deviations of the growth from which it is sure, and least growth over the log, samples: of 108 logs of
/// `stiction_testkit::worlds` by one clock the surest has 6 and 0.06.
const SURE: f64 = 8.0;
const LEAST: f64 = 0.1;
/// Fewest reversals of a log: each shows the delay at one instant.
pub(super) const FEWEST_REVERSALS: usize = 4;

/// Part of a misfit of the shape of the law that they explain where they are its cause.
pub(super) const PART_OF_MISFIT: f64 = 0.3;

/// Two clocks that run apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clocks {
    /// By how much the force falls further behind its motion in each second, s/s; negative where the motion does. To first
    /// order: less than the clocks are apart where the force changes within less time than they come apart.
    pub drift: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// The same from the beginning of the log to its end, s.
    pub growth: f64,
    /// Part of the variance of the residual that it explains, 0 to 1.
    pub share: f64,
}

/// Looks for clocks that run apart, `time` (s) being that of the kept samples of one log; `None` where they do not, surely.
pub(super) fn sought(
    record: &Record,
    objective: &Objective,
    at: &Evaluation,
    time: &[f64],
    residual: &[f64],
) -> Option<Clocks> {
    let one_log = record.segments.windows(2).all(|s| s[0].log == s[1].log);
    let slope = at
        .slopes
        .last()
        .filter(|_| one_log && objective.is_delayed())?;
    let (first, last) = (time.first()?, time.last()?);
    let (middle, duration) = (0.5 * (first + last), last - first);
    let step = record.step();
    // The unknown is in samples, and larger for a force that is logged later.
    let later = slope.iter().zip(time).map(|(s, t)| s * (t - middle) / step);
    let beside = Beside::new(&at.jacobian(), residual);
    let column = beside.outside(&later.collect::<Vec<f64>>());
    let found = beside.explained(&column);
    let deviation = deviation(&column, residual)?;
    let growth = found.coefficient * duration;
    let is_sure = found.coefficient.abs() > SURE * deviation && growth.abs() > LEAST * step;
    is_sure.then_some(Clocks {
        drift: found.coefficient,
        deviation,
        growth,
        share: found.share,
    })
}

/// Standard deviation of the coefficient of a column that all others leave, by leaving out parts of the log (Tukey's jackknife:
/// Efron and Tibshirani 1993, ISBN 0-412-04231-2, chapter 11).
fn deviation(column: &[f64], residual: &[f64]) -> Option<f64> {
    let length = residual.len().div_ceil(PARTS).max(1);
    let sums = |(x, y): (&[f64], &[f64])| {
        let both = x.iter().zip(y);
        both.fold((0.0, 0.0), |(xx, xy), (x, y)| (xx + x * x, xy + x * y))
    };
    let parts: Vec<(f64, f64)> = column
        .chunks(length)
        .zip(residual.chunks(length))
        .map(sums)
        .collect();
    let all = parts
        .iter()
        .fold((0.0, 0.0), |all, part| (all.0 + part.0, all.1 + part.1));
    let without: Vec<f64> = parts
        .iter()
        .map(|part| (all.1 - part.1) / (all.0 - part.0))
        .collect();
    let count = without.len() as f64;
    let mean = without.iter().sum::<f64>() / count;
    let square = without.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    let deviation = ((count - 1.0) / count * square).sqrt();
    deviation.is_finite().then_some(deviation)
}
