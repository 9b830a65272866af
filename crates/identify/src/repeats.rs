//! Motion that repeats itself, count for count.
//!
//! An axis on a periodic path crosses the counts of its encoder at the same places in every period, so that what they leave in
//! a residual comes back. The noise of a logged force, under which a [`replica`](crate::replica) is simulated, does not.

use crate::conditioning::shift::Shift;
use std::ops::Range;

/// Readings among which a period is looked for at first, about.
const COARSE: usize = 1024;
/// Mean square of the difference of readings a period apart, over that of all pairs, below which it may be one.
const ALIKE: f64 = 0.2;
/// Corrections of a period, and samples that each is made of, about.
const CORRECTIONS: usize = 6;
const USED: usize = 2048;
/// Times the median difference beyond which a pair tells nothing of the period: there the motion is another one.
const OUTLYING: f64 = 3.0;
/// Samples beside a whole period that are not told from none.
const WHOLE: f64 = 1e-3;
/// Pieces of a period, each of which repeats or does not.
const PIECES: usize = 16;
/// Mean difference of readings a period apart up to which the counts repeat, counts.
const REPEATED_COUNTS: f64 = 1.0;

/// A stretch of periodic motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Repeats {
    /// Samples.
    period: f64,
    /// Its samples, two periods at least.
    stretch: Range<usize>,
}

impl Repeats {
    /// The longest stretch in which readings come back after a period, to about a count; `None` where there is none.
    pub fn of(reading: &[f64], count: f64) -> Option<Self> {
        if count <= 0.0 {
            return None;
        }
        let step = (reading.len() / COARSE).max(1);
        let coarse: Vec<f64> = reading.iter().copied().step_by(step).collect();
        let least = |period: f64| Self::with(reading, count, corrected(reading, period)?);
        candidates(&coarse)
            .into_iter()
            .find_map(|period| least((period * step) as f64))
    }

    fn with(reading: &[f64], count: f64, period: f64) -> Option<Self> {
        let later = Shift::earlier(-period);
        let last = reading.len().checked_sub(libm::ceil(period) as usize + 1)?;
        let piece = (period as usize / PIECES).max(1);
        let (mut longest, mut begun) = (0..0, None);
        for from in (0..last).step_by(piece) {
            let all = from..(from + piece).min(last);
            let off: f64 = all
                .clone()
                .map(|k| (later.at(reading, k) - reading[k]).abs())
                .sum();
            if off > REPEATED_COUNTS * count * all.len() as f64 {
                begun = None;
                continue;
            }
            let stretch = *begun.get_or_insert(from)..all.end;
            if stretch.len() > longest.len() {
                longest = stretch;
            }
        }
        ((longest.len() as f64) > period).then(|| Self {
            period,
            stretch: longest.start..longest.end + period as usize,
        })
    }

    /// A channel whose stretch is, at every instant of the period, the mean over all periods.
    pub fn mean(&self, x: &[f64]) -> Vec<f64> {
        let Range { start, end } = self.stretch;
        let most = (self.stretch.len() as f64 / self.period) as isize + 1;
        let shifts: Vec<(f64, Shift)> = (-most..=most)
            .map(|i| i as f64 * self.period)
            .map(|later| (later, Shift::earlier(-later)))
            .collect();
        let mut out = x.to_vec();
        for k in self.stretch.clone() {
            let (mut sum, mut count) = (0.0, 0.0);
            for (later, shift) in &shifts {
                let at = k as f64 + later;
                if at >= start as f64 && at < end as f64 {
                    sum += shift.at(x, k);
                    count += 1.0;
                }
            }
            out[k] = sum / count;
        }
        out
    }
}

/// Periods that may be those of a motion, shortest first.
fn candidates(x: &[f64]) -> Vec<usize> {
    let n = x.len();
    let apart = |lag: usize| {
        let pairs = x.iter().zip(&x[lag..]);
        pairs.map(|(a, b)| (b - a) * (b - a)).sum::<f64>() / (n - lag) as f64
    };
    let mean = x.iter().sum::<f64>() / n.max(1) as f64;
    let all = 2.0 * x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n.max(1) as f64;
    let costs: Vec<f64> = (0..n / 2).map(apart).collect();
    (1..costs.len().saturating_sub(1))
        .filter(|&lag| costs[lag] <= costs[lag - 1] && costs[lag] < costs[lag + 1])
        .filter(|&lag| costs[lag] < ALIKE * all)
        .collect()
}

/// The period near a whole one, samples, with which the readings agree best; `None` where they lead away.
fn corrected(x: &[f64], whole: f64) -> Option<f64> {
    let mut period = whole;
    let beside = x.len() / COARSE + 1;
    for _ in 0..CORRECTIONS {
        let later = Shift::earlier(-period);
        let end = x
            .len()
            .checked_sub(libm::ceil(period) as usize + beside + 1)?;
        let of = |k: usize| {
            let speed = (x[k + beside] - x[k - beside]) / (2 * beside) as f64;
            (later.at(x, k) - x[k], speed)
        };
        let every = (end / USED).max(1);
        let pairs: Vec<(f64, f64)> = (beside..end).step_by(every).map(of).collect();
        let mut sizes: Vec<f64> = pairs.iter().map(|(off, _)| off.abs()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let most = OUTLYING * sizes.get(sizes.len() / 2)?;
        let of_motion = pairs.iter().filter(|(off, _)| off.abs() <= most);
        let (up, down) = of_motion.fold((0.0, 0.0), |(up, down), (off, speed)| {
            (up + off * speed, down + speed * speed)
        });
        let by = if down > 0.0 { up / down } else { 0.0 };
        period -= by;
        if (period - whole).abs() > 2.0 * beside as f64 {
            return None;
        }
    }
    let near = period.round();
    Some(if (period - near).abs() < WHOLE {
        near
    } else {
        period
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: f64 = 1e-7;

    /// A motion that begins softly, after half a period, and goes on with this period, samples.
    fn reading(period: f64) -> Vec<f64> {
        (0..8000)
            .map(|k| {
                let turns = k as f64 / period;
                let x = 1e-3 * turns.min(0.5) * libm::sin(std::f64::consts::TAU * turns);
                libm::round(x / COUNT) * COUNT
            })
            .collect()
    }

    #[test]
    fn a_period_is_found_and_where_it_begins() {
        for period in [1000.0, 777.3] {
            let found = Repeats::of(&reading(period), COUNT).unwrap();
            assert!((found.period - period).abs() < 2e-3, "{found:?}");
            let begins = found.stretch.start as f64 / period;
            assert!((0.4..0.6).contains(&begins), "{found:?}");
            assert!(found.stretch.end > 7900, "{found:?}");
        }
    }

    #[test]
    fn motion_that_comes_back_beside_its_counts_does_not_repeat() {
        let moved = |(k, x): (usize, &f64)| x + 2e-3 * COUNT * k as f64;
        let reading: Vec<f64> = reading(1000.0).iter().enumerate().map(moved).collect();
        assert_eq!(Repeats::of(&reading, COUNT), None);
    }

    #[test]
    fn a_mean_repeats_and_has_less_noise() {
        let repeats = Repeats::of(&reading(1000.0), COUNT).unwrap();
        let mut noise = stiction_servo::noise::Noise::new(3);
        let wave = |k: usize| libm::sin(std::f64::consts::TAU * k as f64 / 1000.0);
        let force: Vec<f64> = (0..8000).map(|k| wave(k) + 0.1 * noise.normal()).collect();
        let mean = repeats.mean(&force);
        assert_eq!(
            mean[..repeats.stretch.start],
            force[..repeats.stretch.start]
        );
        let inside = || (2000..6000).map(|k| (mean[k], mean[k + 1000], wave(k)));
        assert!(inside().all(|(now, later, _)| (now - later).abs() < 1e-12));
        let square: f64 = inside().map(|(now, _, wave)| (now - wave).powi(2)).sum();
        let off = (square / 4000.0).sqrt();
        assert!((0.02..0.06).contains(&off), "{off}");
    }
}
