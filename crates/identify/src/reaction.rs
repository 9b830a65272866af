//! How the controller responds to the readings of its encoder.
//!
//! A controller takes every encoder step for motion and responds with a force that really acts on the
//! axis. So the logged force is correlated with the errors of the logged position, which noise drawn anew
//! does not reproduce. The response is identified from both channels above the band that the axis can
//! follow.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use nalgebra::{SMatrix, SVector};
use stiction_policy::encoder;
use stiction_signal::Sos;

/// Longest duration of a response, samples: a difference of positions over one sample lasts two samples,
/// with filtering or computing delay in the drive a few more.
const ANSWER_LAGS: usize = 6;
/// Cut-off between what the axis can follow and encoder steps, parts of the sample rate.
const AXIS_CUTOFF: f64 = 0.05;
/// Highest cut-off of the filters that remove noise, relative to the sample rate.
const HIGHEST_NOISE_CUTOFF: f64 = 0.2;
/// Number of octaves below it.
const OCTAVES_BELOW: u32 = 5;
/// How long before and after a large reading motion may have been asked for, periods of the cut-off: the filter spreads it.
const SPREAD: f64 = 2.0;

/// Samples by which the mean of a sample and the one before is late.
pub(crate) const AS_MEAN: f64 = 0.5;

/// How a force that is held from sample to sample was logged: as the mean of two neighbours where it is
/// logged late by a part of a sample (half for a force centred about its instant).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Logging {
    /// Whole samples by which it is logged late.
    whole: isize,
    /// The part of a sample beyond them, below 1.
    pub part: f64,
}

impl Logging {
    /// For a force that is logged `late` samples later than it was held.
    pub fn new(late: f64) -> Self {
        let whole = libm::floor(late);
        Self {
            whole: whole as isize,
            part: late - whole,
        }
    }

    /// Samples by which the force is logged late.
    pub fn late(&self) -> f64 {
        self.whole as f64 + self.part
    }

    /// The value that the log shows of a held force at a sample.
    pub fn at(&self, held: &[f64], sample: usize) -> f64 {
        let last = held.len() as isize - 1;
        let read = |i: isize| held[i.clamp(0, last) as usize];
        let now = sample as isize - self.whole;
        (1.0 - self.part) * read(now) + self.part * read(now - 1)
    }
}

/// Response of the controller to a reading, N/m (N m/rad), by lag in samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reaction {
    by_lag: [f64; ANSWER_LAGS],
}

impl Reaction {
    /// The response that a record shows; `None` where none can be seen.
    ///
    /// Ramps of acceleration reach far above the band that the axis follows. There the force is what the reference asks of the
    /// mass, as if a difference of position were answered for as long as it stands. Where the samples far from such motion
    /// surely show less of that, they alone say how the controller responds (a test of one estimate by another that holds
    /// under fewer assumptions: Hausman 1978, doi 10.2307/1913827).
    pub fn of(record: &Record, logging: Logging) -> Option<Self> {
        let (mut all, mut far) = (Sums::default(), Sums::default());
        Fast::of(record)?.each(logging, |x, force, is_far| {
            all.add(x, force);
            if is_far {
                far.add(x, force);
            }
        });
        let all = all.answer()?;
        let surely_less = |far: &Answer| {
            let apart = far.deviation * far.deviation - all.deviation * all.deviation;
            far.standing - all.standing > encoder::MIN_STANDING_DEVIATIONS * apart.max(0.0).sqrt()
        };
        let answer = far.answer().filter(surely_less).unwrap_or(all);
        answer.reaction()
    }

    /// The force that acted on the axis on a segment: the response to the readings, and the rest of the
    /// logged force (reference, integrator) without the noise of the force sensor, which does not act on
    /// the axis.
    pub fn felt(&self, segment: &Segment, logging: Logging) -> Option<Vec<f64>> {
        let samples = 0..segment.drive.len();
        let answer: Vec<f64> = samples
            .clone()
            .map(|k| self.force(|lag| segment.reading[k.saturating_sub(lag)]))
            .collect();
        let rest: Vec<f64> = samples
            .clone()
            .map(|k| segment.drive[k] - logging.at(&answer, k))
            .collect();
        let smooth = without_noise(&rest)?;
        let earlier = Shift::earlier(-logging.late());
        Some(
            samples
                .map(|k| earlier.at(&smooth, k) + answer[k])
                .collect(),
        )
    }

    /// The force that responds to the last readings, `reading(lag)` being that of `lag` samples ago.
    pub fn force(&self, reading: impl Fn(usize) -> f64) -> f64 {
        (0..ANSWER_LAGS)
            .map(|lag| self.by_lag[lag] * reading(lag))
            .sum()
    }
}

/// Whether a held force was logged as the mean of two samples, as far from motion the response of the controller to its readings
/// tells: taken for a force that was logged as it was held it lasts a sample longer, and the other way round no response of this
/// length is left (order by the criterion of Schwarz 1978, doi 10.1214/aos/1176344136). `false` where no response is seen. How much
/// later a force acts than it was logged no response tells.
pub(crate) fn is_logged_as_mean(record: &Record) -> bool {
    let Some(fast) = Fast::of(record) else {
        return false;
    };
    let criterion = |late: f64| {
        let mut far = Sums::default();
        fast.each(Logging::new(late), |x, force, is_far| {
            if is_far {
                far.add(x, force);
            }
        });
        let answer = far.answer().filter(|answer| answer.is_certain);
        answer.and_then(|_| far.criterion())
    };
    match (criterion(0.0), criterion(AS_MEAN)) {
        (Some(held), Some(mean)) => mean < held,
        (None, Some(_)) => true,
        (_, None) => false,
    }
}

/// What a record has above the band that the axis can follow.
struct Fast {
    segments: Vec<FastSegment>,
    /// Samples that the filter needs to settle at both ends.
    trim: usize,
}

/// The same of one segment.
struct FastSegment {
    force: Vec<f64>,
    reading: Vec<f64>,
    /// Which samples are far from motion.
    is_far: Vec<bool>,
}

impl Fast {
    /// `None` where there is no position.
    fn of(record: &Record) -> Option<Self> {
        let slow = Sos::butterworth_low_pass(4, AXIS_CUTOFF, 1.0).ok()?;
        let both = record.segments.iter().map(|segment| {
            let reading = (!segment.reading.is_empty()).then_some(&segment.reading)?;
            Some((fast(&segment.drive, &slow)?, fast(reading, &slow)?))
        });
        let both: Vec<_> = both.collect::<Option<_>>()?;
        let largest = largest_at_rest(record, both.iter().map(|(_, reading)| &reading[..]));
        let segments = both.into_iter().map(|(force, reading)| FastSegment {
            is_far: far_from_motion(&reading, largest),
            force,
            reading,
        });
        Some(Self {
            segments: segments.collect(),
            trim: slow.settling_samples(),
        })
    }

    /// Shows the last readings, the force and whether it is far from motion, sample by sample. The response is logged with the
    /// force, so the readings get the same delay and averaging as the log.
    fn each(&self, logging: Logging, mut see: impl FnMut(&SVector<f64, ANSWER_LAGS>, f64, bool)) {
        for segment in &self.segments {
            let samples = segment.force.len();
            let reading = (0..samples).map(|k| logging.at(&segment.reading, k));
            let reading: Vec<f64> = reading.collect();
            for k in self.trim + ANSWER_LAGS - 1..samples.saturating_sub(self.trim) {
                let x = SVector::from_fn(|lag, _| reading[k - lag]);
                see(&x, segment.force[k], segment.is_far[k]);
            }
        }
    }
}

/// Sums of a least squares fit of the force to the last readings.
#[derive(Clone, Default)]
struct Sums {
    square: SMatrix<f64, ANSWER_LAGS, ANSWER_LAGS>,
    product: SVector<f64, ANSWER_LAGS>,
    power: f64,
    samples: usize,
}

impl Sums {
    fn add(&mut self, x: &SVector<f64, ANSWER_LAGS>, force: f64) {
        self.square += x * x.transpose();
        self.product += x * force;
        self.power += force * force;
        self.samples += 1;
    }

    /// Schwarz's criterion of the number of lags that makes it least; `None` where the readings determine no response.
    fn criterion(&self) -> Option<f64> {
        let samples = self.samples as f64;
        let with = |lags: usize| {
            let square = self.square.view((0, 0), (lags, lags)).into_owned();
            let product = self.product.rows(0, lags).into_owned();
            let left = self.power - square.cholesky()?.solve(&product).dot(&product);
            Some(samples * libm::log(left / samples) + lags as f64 * libm::log(samples))
        };
        let each = (1..=ANSWER_LAGS).filter_map(with);
        each.filter(|criterion| criterion.is_finite())
            .min_by(f64::total_cmp)
    }

    /// The fit; `None` where the readings do not determine it.
    fn answer(&self) -> Option<Answer> {
        let factor = self.square.cholesky()?;
        let by_lag = factor.solve(&self.product);
        let explained = by_lag.dot(&self.product);
        let variance = (self.power - explained) / self.samples.saturating_sub(ANSWER_LAGS) as f64;
        let moved = factor.solve(&SVector::repeat(1.0));
        Some(Answer {
            standing: by_lag.sum(),
            deviation: (variance * moved.sum()).sqrt(),
            is_certain: explained > encoder::MIN_RESPONSE_GAIN * ANSWER_LAGS as f64 * variance,
            by_lag,
            moved,
        })
    }
}

/// A fitted response.
struct Answer {
    by_lag: SVector<f64, ANSWER_LAGS>,
    /// How it changes with its response to a standing difference.
    moved: SVector<f64, ANSWER_LAGS>,
    /// Response to a standing difference of position, N/m (N m/rad), and its standard deviation.
    standing: f64,
    deviation: f64,
    /// Whether it explains more than chance does.
    is_certain: bool,
}

impl Answer {
    fn reaction(self) -> Option<Reaction> {
        if !self.is_certain {
            return None;
        }
        let mut by_lag = self.by_lag;
        // A standing difference of position is answered by a hundredth of what a step is. Where noise hides that, none
        // is assumed: one of the wrong sign would make the simulated axis run away.
        if self.standing > -encoder::MIN_STANDING_DEVIATIONS * self.deviation {
            by_lag -= self.moved * (self.standing / self.moved.sum());
        }
        Some(Reaction {
            by_lag: by_lag.into(),
        })
    }
}

/// Reading above the band of the axis beyond which it may be motion, m (rad): what counts, or the noise of the encoder, do not reach.
fn largest_at_rest<'a>(record: &Record, readings: impl Iterator<Item = &'a [f64]>) -> f64 {
    let counts = record.resolution.unwrap_or(0.0) / 12.0_f64.sqrt();
    let mut sizes: Vec<f64> = readings.flatten().map(|x| x.abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    (encoder::MAX_READING_IN_COUNTS * counts).max(encoder::MAX_READING_IN_MEDIANS * median)
}

/// Whether no reading near a sample is larger than that.
fn far_from_motion(reading: &[f64], largest: f64) -> Vec<bool> {
    let near = (SPREAD / AXIS_CUTOFF) as usize;
    let mut out = vec![true; reading.len()];
    let mut done = 0;
    for (k, _) in reading
        .iter()
        .enumerate()
        .filter(|(_, x)| x.abs() > largest)
    {
        let end = (k + near + 1).min(out.len());
        // Each sample is written once, however many are too large.
        out[k.saturating_sub(near).max(done)..end].fill(false);
        done = end;
    }
    out
}

/// The part of a channel above the band that the axis can follow.
fn fast(x: &[f64], slow: &Sos) -> Option<Vec<f64>> {
    let smooth = slow.zero_phase(x).ok()?;
    Some(x.iter().zip(&smooth).map(|(x, s)| x - s).collect())
}

/// A channel without its white noise: split into octaves, of which only what exceeds the noise is kept
/// (thresholds of Donoho and Johnstone 1994, doi 10.1093/biomet/81.3.425, in bands of zero-phase
/// filters). The part above the highest octave is taken as noise.
fn without_noise(x: &[f64]) -> Option<Vec<f64>> {
    let below = |cutoff: f64| {
        let low_pass = Sos::butterworth_low_pass(4, cutoff, 1.0).ok()?;
        low_pass.zero_phase(x).ok()
    };
    let mut fine = below(HIGHEST_NOISE_CUTOFF)?;
    let lost: f64 = x.iter().zip(&fine).map(|(x, s)| (x - s) * (x - s)).sum();
    let density = lost / (x.len() as f64 * (0.5 - HIGHEST_NOISE_CUTOFF));
    let mut kept = vec![0.0; x.len()];
    for octave in 1..=OCTAVES_BELOW {
        let width = HIGHEST_NOISE_CUTOFF / f64::from(1 << octave);
        let coarse = below(width)?;
        let least = encoder::MIN_OUTSTANDING_DEVIATIONS * (density * width).sqrt();
        for (kept, (fine, coarse)) in kept.iter_mut().zip(fine.iter().zip(&coarse)) {
            let band = fine - coarse;
            if band.abs() > least {
                *kept += band;
            }
        }
        fine = coarse;
    }
    Some(kept.iter().zip(&fine).map(|(a, b)| a + b).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answered::{ANSWER, NOISE, moves, read, record};

    #[test]
    fn the_answer_is_found_however_the_force_was_logged() {
        for late in [0.0, 0.5, 1.0, -0.8] {
            let (record, held) = record(true, late);
            let logging = Logging::new(late);
            let reaction = Reaction::of(&record, logging).unwrap();
            for (lag, found) in reaction.by_lag.iter().enumerate() {
                let truth = ANSWER.get(lag).copied().unwrap_or(0.0);
                assert!(
                    (found - truth).abs() < 0.05 * ANSWER[1],
                    "late by {late}: lag {lag}: {found:e}"
                );
            }
            let felt = reaction.felt(&record.segments[0], logging).unwrap();
            let middle = 200..felt.len() - 200;
            let square: f64 = middle.clone().map(|k| (felt[k] - held[k]).powi(2)).sum();
            let off = (square / middle.len() as f64).sqrt();
            assert!(off < 0.3 * NOISE, "late by {late}: off by {off} N");
        }
    }

    #[test]
    fn the_answer_tells_whether_the_force_is_a_mean() {
        for (late, mean) in [(0.0, false), (1.0, false), (0.5, true), (1.5, true)] {
            let (record, _) = record(true, late);
            assert_eq!(is_logged_as_mean(&record), mean, "late by {late}");
        }
        let (silent, _) = record(false, 0.5);
        assert!(!is_logged_as_mean(&silent));
    }

    #[test]
    fn a_standing_difference_that_noise_hides_is_not_answered() {
        for seed in 0..6 {
            // Of 10 nm the noise leaves a tenth of each lag open, ten times the sum of the answer.
            let (record, _) = read(true, 0.0, 10e-9, seed);
            let reaction = Reaction::of(&record, Logging::new(0.0)).unwrap();
            let standing: f64 = reaction.by_lag.iter().sum();
            assert!(standing < 1e-6 * ANSWER[1], "seed {seed}: {standing:e}");
            assert!((reaction.by_lag[0] - ANSWER[0]).abs() < 0.5 * ANSWER[1]);
        }
    }

    #[test]
    fn the_mass_that_a_reference_moves_is_no_answer() {
        let found = Reaction::of(&moves(100e-9), Logging::new(0.0)).unwrap();
        for (lag, found) in found.by_lag.iter().enumerate() {
            let truth = ANSWER.get(lag).copied().unwrap_or(0.0);
            let off = (found - truth).abs();
            assert!(off < 0.05 * ANSWER[1], "lag {lag}: {found:e}");
        }
    }

    #[test]
    fn no_answer_is_found_where_there_is_none() {
        let (record, _) = record(false, 0.0);
        assert_eq!(Reaction::of(&record, Logging::new(0.0)), None);
    }
}
