//! Stretches in which nothing moves by more than the encoder and the noise explain.

use crate::log::Log;
use std::collections::VecDeque;
use std::ops::Range;
use stiction_codes::Code;
use stiction_policy::rest;
use stiction_signal::{Travel, noise_deviation};

/// Samples of a block whose noise is looked at ...
const BLOCK: usize = 64;

/// The stretches at rest, in order, that last at least `shortest` seconds; none in a record that moves nowhere.
pub(super) fn stretches(log: &Log, shortest: f64) -> Vec<Range<usize>> {
    let Some(signal) = Signal::of(log, shortest) else {
        return Vec::new();
    };
    let whole = 0..log.time.len();
    let first = signal.prefix(whole.clone());
    let from = first.as_ref().map_or(0, |rest| rest.end);
    let last = signal.suffix(from..whole.end);
    let to = last.as_ref().map_or(whole.end, |rest| rest.start);
    let mut out: Vec<Range<usize>> = first.into_iter().collect();
    out.extend(signal.inside(from..to));
    out.extend(last);
    // A position that is frozen while the axis moves is a fault and not a rest.
    let stuck = |rest: &Range<usize>| {
        log.excluded.iter().any(|e| {
            let both = e.samples.start.max(rest.start)..e.samples.end.min(rest.end);
            e.code == Code::StuckEncoder && !both.is_empty()
        })
    };
    out.retain(|rest| !stuck(rest));
    out
}

/// What tells rest from motion: the position, or the velocity where there is none.
struct Signal<'a> {
    values: &'a [f64],
    time: &'a [f64],
    /// Range of the values at rest.
    band: f64,
    /// Of a position, the sums of the values before each; of a velocity, its integral up to each.
    sums: Vec<f64>,
    /// Shortest rest, s.
    shortest: f64,
    /// Standard deviation of the noise, where the values are a velocity.
    velocity_noise: Option<f64>,
}

impl<'a> Signal<'a> {
    fn of(log: &'a Log, shortest: f64) -> Option<Self> {
        let time = &log.time;
        let seconds = time.last()? - time.first()?;
        if let Some(position) = &log.position {
            let band = Travel::shortest_movement(log.quantum.unwrap_or(0.0), quiet(position));
            let travel = Travel::of(position.iter().copied(), band);
            let speed = (travel.up + travel.down) / seconds;
            // A position without step and noise was computed; at rest its steps are those of the numbers.
            let band = band.max(1e-9 * travel.range);
            if travel.range < rest::MIN_RANGE * band || speed <= 0.0 {
                return None;
            }
            return Some(Self {
                values: position,
                time,
                sums: sums(position),
                band,
                shortest: shortest.max(rest::MIN_CROSSINGS * band / speed),
                velocity_noise: None,
            });
        }
        let velocity = log.velocity.as_ref()?;
        let noise = quiet(velocity);
        let step = super::super::encoder::quantum(velocity, &vec![false; velocity.len()]);
        let top = velocity.iter().fold(0.0_f64, |top, v| top.max(v.abs()));
        let band = Travel::shortest_movement(step.unwrap_or(0.0), noise).max(1e-9 * top);
        (top >= rest::MIN_RANGE * band).then_some(Self {
            values: velocity,
            time,
            sums: integral(time, velocity),
            band,
            shortest,
            velocity_noise: Some(noise),
        })
    }

    /// The rest with which a stretch begins.
    fn prefix(&self, within: Range<usize>) -> Option<Range<usize>> {
        let values = &self.values[within.clone()];
        let rest = within.start..within.start + within_band(values.iter(), self.band);
        let rest =
            rest.start..rest.end - self.leaving(rest.clone(), |r| self.values[r].iter().rev());
        self.is_rest(&rest).then_some(rest)
    }

    /// The rest with which a stretch ends.
    fn suffix(&self, within: Range<usize>) -> Option<Range<usize>> {
        let values = &self.values[within.clone()];
        let rest = within.end - within_band(values.iter().rev(), self.band)..within.end;
        let rest = rest.start + self.leaving(rest.clone(), |r| self.values[r].iter())..rest.end;
        self.is_rest(&rest).then_some(rest)
    }

    /// How many of the samples, from the side that is walked first, already belong to the motion: they are further than
    /// a third of the band from the level of the rest.
    fn leaving<'s, I: Iterator<Item = &'s f64>>(
        &self,
        rest: Range<usize>,
        walk: impl FnOnce(Range<usize>) -> I,
    ) -> usize {
        let mut sorted = self.values[rest.clone()].to_vec();
        let Some(level) = crate::findings::median(&mut sorted) else {
            return 0;
        };
        let away = |x: &&f64| (**x - level).abs() > 0.35 * self.band;
        walk(rest).take_while(away).count()
    }

    /// Rests within a stretch, each as long as it can be, one after the other.
    fn inside(&self, within: Range<usize>) -> Vec<Range<usize>> {
        let mut out = Vec::new();
        let mut start = within.start;
        // Where the largest and smallest values from `start` on are, and of what follows them, and so on.
        let (mut high, mut low): (VecDeque<usize>, VecDeque<usize>) = Default::default();
        for (i, &x) in self
            .values
            .iter()
            .enumerate()
            .take(within.end)
            .skip(within.start)
        {
            while high.back().is_some_and(|&k| self.values[k] <= x) {
                high.pop_back();
            }
            while low.back().is_some_and(|&k| self.values[k] >= x) {
                low.pop_back();
            }
            high.push_back(i);
            low.push_back(i);
            let mut asked = false;
            while self.values[high[0]] - self.values[low[0]] > self.band {
                let ended = start..i;
                if !asked && self.is_rest(&ended) {
                    out.push(ended);
                    start = i;
                } else {
                    start += 1;
                }
                asked = true;
                for queue in [&mut high, &mut low] {
                    while queue[0] < start {
                        queue.pop_front();
                    }
                }
            }
        }
        let last = start..within.end;
        out.extend(self.is_rest(&last).then_some(last));
        out
    }

    /// Whether a stretch within the band is a rest: long enough, and it goes nowhere.
    fn is_rest(&self, rest: &Range<usize>) -> bool {
        let n = rest.len();
        if n < 6 || self.time[rest.end - 1] - self.time[rest.start] < self.shortest {
            return false;
        }
        let Some(noise) = self.velocity_noise else {
            let third = n / 3;
            let first = self.sums[rest.start + third] - self.sums[rest.start];
            let last = self.sums[rest.end] - self.sums[rest.end - third];
            return (last - first).abs() <= rest::MAX_DRIFT * self.band * third as f64;
        };
        // Noise lets an integrated velocity walk; what goes further has moved, however slowly.
        let moved = self.sums[rest.end - 1] - self.sums[rest.start];
        let seconds = self.time[rest.end - 1] - self.time[rest.start];
        let walk = Travel::shortest_integrated(noise, seconds, n);
        moved.abs() <= walk.max(1e-3 * self.band * seconds)
    }
}

/// Sums of the values before each, and of all.
fn sums(values: &[f64]) -> Vec<f64> {
    let first = values.first().copied().unwrap_or(0.0);
    let mut sum = 0.0;
    let running = values.iter().map(|x| {
        sum += x - first;
        sum
    });
    std::iter::once(0.0).chain(running).collect()
}

/// The integral of a velocity up to each sample.
fn integral(time: &[f64], velocity: &[f64]) -> Vec<f64> {
    let mut x = 0.0;
    let steps = time.windows(2).zip(velocity.windows(2)).map(|(t, v)| {
        x += 0.5 * (v[0] + v[1]) * (t[1] - t[0]);
        x
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// Standard deviation of the noise where the signal is quietest.
fn quiet(values: &[f64]) -> f64 {
    let blocks = values.chunks_exact(BLOCK.min(values.len().max(1)));
    let mut noise: Vec<f64> = blocks
        .map(|block| noise_deviation(std::iter::once(block)))
        .collect();
    if noise.is_empty() {
        return 0.0;
    }
    let at = (rest::QUIETEST_SHARE * noise.len() as f64) as usize;
    *noise.select_nth_unstable_by(at, f64::total_cmp).1
}

/// How many values from the first on lie within a band.
fn within_band<'v>(values: impl Iterator<Item = &'v f64>, band: f64) -> usize {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    values
        .take_while(|x| {
            low = low.min(**x);
            high = high.max(**x);
            high - low <= band
        })
        .count()
}
