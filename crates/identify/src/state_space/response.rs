//! How the controller responds to the readings of its encoder.
//!
//! A controller takes every encoder step for motion and responds with a force that really acts on the axis: with parts of the
//! last readings, as a rule behind a filter of the first order. The response is identified from the finest scale of force and
//! reading, which an axis cannot follow.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use crate::reaction::Logging;
use nalgebra::{SMatrix, SVector};
use std::borrow::Cow;
use std::cmp::Ordering;
use stiction_policy::encoder;
use stiction_signal::{finest_scale, without_noise};

/// Readings that the response is made of: a difference of positions, and one sample of computing delay.
const LAGS: usize = 3;
/// Parts of a response that are left a sample later, which are tried: that of a filter of the first order, 0 for none.
const MEMORIES: [f64; 15] = [
    0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9,
];
/// Samples at the ends of a segment that are not asked: they are mirrored in the finest scale, not seen.
const ENDS: usize = 8;
/// Times that the samples are chosen.
const CHOICES: usize = 8;
/// Median of the absolute value of a standard normal number.
const MEDIAN_NORMAL: f64 = 0.674_489_750_196_081_7;

/// Response of the controller to its readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Response {
    /// Force by the reading of so many samples ago, N/m (N m/rad).
    by_lag: [f64; LAGS],
    /// Part of it that is left a sample later.
    memory: f64,
}

impl Response {
    /// The response that a record shows; `None` where none can be seen.
    ///
    /// Samples at which the rest of the force jumps (a reference with steps of acceleration) are left out, in turn with the
    /// fit.
    pub fn of(record: &Record, logging: Logging) -> Option<Self> {
        let most = record.resolution.filter(|count| *count > 0.0);
        let most = most.map_or(f64::INFINITY, |count| encoder::MAX_FINE_COUNTS * count);
        let mut channels = Vec::new();
        for segment in &record.segments {
            if segment.reading.is_empty() {
                return None;
            }
            let reading = finest_scale(&segment.reading);
            // The response is logged with the force, so the readings get the same delay and averaging as the log.
            let late = |k: usize| logging.at(&reading, k);
            channels.push(Channels {
                force: finest_scale(&segment.drive),
                reading: (0..reading.len()).map(late).collect(),
            });
        }
        let mut memory = 0.0;
        let mut rows = rows(&channels, memory, most);
        let mut chosen = chosen(&rows)?;
        // The memory is looked for on the samples that were chosen without one, then on those chosen with it.
        for _ in 0..2 {
            let best = MEMORIES.into_iter().filter_map(|memory| {
                let rows = self::rows(&channels, memory, most);
                let fit = Regression::over(&rows, &chosen)?;
                Some((memory, fit.left))
            });
            (memory, _) = best.min_by(|a, b| a.1.total_cmp(&b.1))?;
            rows = self::rows(&channels, memory, most);
            chosen = self::chosen(&rows)?;
        }
        Regression::over(&rows, &chosen)?.answer(memory)
    }

    /// The force at each of some samples that responds to the readings up to there.
    fn forces(&self, reading: &[f64]) -> Vec<f64> {
        let mut last = 0.0;
        let first = reading.first().copied().unwrap_or(0.0);
        let lagged = |k: usize, lag: usize| reading[k.saturating_sub(lag)] - first;
        let force = |k: usize| {
            let new: f64 = (0..LAGS).map(|lag| self.by_lag[lag] * lagged(k, lag)).sum();
            last = self.memory.mul_add(last, new);
            last
        };
        (0..reading.len()).map(force).collect()
    }
}

/// A force taken apart.
pub(super) struct Felt {
    /// What acted on the axis.
    pub force: Vec<f64>,
    /// The noise of the force sensor, at each sample as it was logged.
    pub noise: Vec<f64>,
}

/// The force that acted on the axis on a segment: the response to the readings, where one is known, and the rest of the logged
/// force (reference, integrator) without the noise of the force sensor, which does not act on the axis.
pub(super) fn felt(segment: &Segment, logging: Logging, response: Option<&Response>) -> Felt {
    let samples = 0..segment.drive.len();
    let answer = response.map(|response| response.forces(&segment.reading));
    let rest: Cow<[f64]> = match &answer {
        Some(answer) => samples
            .clone()
            .map(|k| segment.drive[k] - logging.at(answer, k))
            .collect(),
        None => (&segment.drive).into(),
    };
    let smooth = without_noise(&rest, encoder::MIN_OUTSTANDING_DEVIATIONS);
    let earlier = Shift::earlier(-logging.late());
    let answered = |k: usize| answer.as_ref().map_or(0.0, |answer| answer[k]);
    let force = samples.map(|k| earlier.at(&smooth, k) + answered(k));
    let noise = rest.iter().zip(&smooth).map(|(rest, smooth)| rest - smooth);
    Felt {
        force: force.collect(),
        noise: noise.collect(),
    }
}

/// The finest scale of the force and of the reading that is logged with it.
struct Channels {
    force: Vec<f64>,
    reading: Vec<f64>,
}

/// The finest scale of the last readings behind a filter, and of the force.
type Row = ([f64; LAGS], f64);

/// One for each sample at which the motion does not bend.
fn rows(channels: &[Channels], memory: f64, most: f64) -> Vec<Row> {
    let mut out = Vec::new();
    for Channels { force, reading } in channels {
        let mut last = 0.0;
        let filtered: Vec<f64> = reading
            .iter()
            .map(|x| {
                last = memory * last + x;
                last
            })
            .collect();
        for k in ENDS..force.len().saturating_sub(ENDS) {
            if reading[k].abs() <= most {
                out.push((std::array::from_fn(|lag| filtered[k - lag]), force[k]));
            }
        }
    }
    out
}

/// Which rows do not jump, as a regression tells; `None` where the readings determine none.
fn chosen(rows: &[Row]) -> Option<Vec<bool>> {
    let mut chosen = vec![true; rows.len()];
    for _ in 0..CHOICES {
        let fit = Regression::over(rows, &chosen)?;
        let rests: Vec<f64> = rows
            .iter()
            .map(|row| rest(row, &fit.by_lag).abs())
            .collect();
        let mut sizes = rests.clone();
        let middle = sizes.len() / 2;
        let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        let most = encoder::MAX_RESPONSE_DEVIATIONS * median / MEDIAN_NORMAL;
        let next: Vec<bool> = rests.iter().map(|rest| *rest <= most).collect();
        if next == chosen {
            break;
        }
        chosen = next;
    }
    Some(chosen)
}

/// What a response leaves of the force.
fn rest((x, force): &Row, by_lag: &SVector<f64, LAGS>) -> f64 {
    let answer: f64 = (0..LAGS).map(|lag| by_lag[lag] * x[lag]).sum();
    force - answer
}

/// The finest scale of the force as a sum of those of the last readings.
struct Regression {
    by_lag: SVector<f64, LAGS>,
    /// Inverse of the sums of products of the readings.
    inverse: SMatrix<f64, LAGS, LAGS>,
    /// Sum of squares that the readings explain, and that they leave.
    explained: f64,
    left: f64,
    samples: usize,
}

impl Regression {
    /// Over some rows; `None` where the readings do not determine it.
    fn over(rows: &[Row], chosen: &[bool]) -> Option<Self> {
        let mut square = SMatrix::<f64, LAGS, LAGS>::zeros();
        let mut product = SVector::<f64, LAGS>::zeros();
        let (mut power, mut samples) = (0.0, 0);
        for ((x, force), _) in rows.iter().zip(chosen).filter(|(_, chosen)| **chosen) {
            let x = SVector::from(*x);
            square += x * x.transpose();
            product += x * *force;
            power += force * force;
            samples += 1;
        }
        let factor = square.cholesky()?;
        let by_lag = factor.solve(&product);
        let explained = by_lag.dot(&product);
        Some(Self {
            by_lag,
            inverse: factor.inverse(),
            explained,
            left: (power - explained).max(0.0),
            samples,
        })
    }

    /// The response, if it explains more than chance does.
    fn answer(mut self, memory: f64) -> Option<Response> {
        let variance = self.left / self.samples.saturating_sub(LAGS) as f64;
        let chance = LAGS as f64 * variance;
        if self
            .explained
            .partial_cmp(&(encoder::MIN_RESPONSE_GAIN * chance))
            != Some(Ordering::Greater)
        {
            return None;
        }
        // A standing difference of position is answered by a hundredth of what a step is. Where noise hides that, none is
        // assumed: one of the wrong sign would be taken off the rest.
        let moved = self.inverse * SVector::<f64, LAGS>::repeat(1.0);
        let standing = self.by_lag.sum();
        let deviation = (variance * moved.sum()).sqrt();
        if standing > -encoder::MIN_STANDING_DEVIATIONS * deviation {
            self.by_lag -= moved * (standing / moved.sum());
        }
        Some(Response {
            by_lag: self.by_lag.into(),
            memory,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answered::{ANSWER, NOISE, read, record};

    #[test]
    fn the_answer_is_found_however_the_force_was_logged() {
        for late in [0.0, 0.5, 1.0, -0.8] {
            let (record, held) = record(true, late);
            let logging = Logging::new(late);
            let response = Response::of(&record, logging).unwrap();
            // What one count is answered with.
            let mut count = vec![0.0; 9];
            count[1] = 1.0;
            for (lag, found) in response.forces(&count)[1..].iter().enumerate() {
                let truth = ANSWER.get(lag).copied().unwrap_or(0.0);
                assert!(
                    (found - truth).abs() < 0.05 * ANSWER[1],
                    "late by {late}: lag {lag}: {found:e}"
                );
            }
            let felt = felt(&record.segments[0], logging, Some(&response));
            let middle = 200..held.len() - 200;
            let rms = |of: &dyn Fn(usize) -> f64| {
                let square: f64 = middle.clone().map(|k| of(k).powi(2)).sum();
                (square / middle.len() as f64).sqrt()
            };
            let off = rms(&|k| felt.force[k] - held[k]);
            assert!(off < 0.3 * NOISE, "late by {late}: off by {off} N");
            let noise = rms(&|k| felt.noise[k]);
            assert!(
                (noise - NOISE).abs() < 0.1 * NOISE,
                "late by {late}: {noise} N"
            );
        }
    }

    #[test]
    fn a_standing_difference_that_noise_hides_is_not_answered() {
        for seed in 0..6 {
            // Of 10 nm the noise leaves a tenth of each lag open, ten times the sum of the answer.
            let (record, _) = read(true, 0.0, 10e-9, seed);
            let response = Response::of(&record, Logging::new(0.0)).unwrap();
            let standing: f64 = response.by_lag.iter().sum();
            assert!(standing < 1e-6 * ANSWER[1], "seed {seed}: {standing:e}");
            assert!((response.by_lag[0] - ANSWER[0]).abs() < 0.5 * ANSWER[1]);
        }
    }

    #[test]
    fn no_answer_is_found_where_there_is_none() {
        let (record, _) = record(false, 0.0);
        assert_eq!(Response::of(&record, Logging::new(0.0)), None);
    }
}
