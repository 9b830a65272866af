//! Plain facts about the motion of a log, without a fit.

use crate::turns::turns;
use serde::Serialize;
use stiction_log::Log;
use stiction_policy::motion;
use stiction_signal::noise_deviation;

/// Longest window to either side over which a speed is taken from a position, s.
const LONGEST_WINDOW: f64 = 0.05;
/// Bounds of the decades of speed, in top speeds.
const DECADES: [f64; 4] = [1.0, 0.1, 0.01, 0.001];

/// How the axis moves.
#[derive(Clone, Debug, Serialize)]
pub struct Motion {
    /// Samples a second, Hz.
    pub rate_hz: f64,
    /// Top speed, but for half a percent of the samples, m/s or rad/s.
    pub top_speed: f64,
    /// Largest error of a speed from encoder steps and noise, likewise.
    pub speed_error: f64,
    /// Shares of the samples, dimensionless, that move forward and back faster than that error, rests left out.
    pub forward: f64,
    /// See `forward`.
    pub back: f64,
    /// Share of the samples in rests of 1 s or more.
    pub at_rest: f64,
    /// Share of the samples at which the axis is no faster than that error: rests, and dwells however short.
    pub still: f64,
    /// Share of the samples in the first, second and third decade below the top speed.
    pub decades: [f64; 3],
    /// The same in the first to third decade, in the direction that has less.
    pub decades_one_way: [f64; 3],
    /// Speeds that a twentieth and a half of the samples in motion do not reach, m/s or rad/s.
    pub slow_speed: f64,
    /// See `slow_speed`.
    pub middle_speed: f64,
    /// How often the axis turns back.
    pub reversals: usize,
    /// Samples that the force takes to turn round at the third slowest reversal, at the quickest of fewer.
    pub samples_at_reversal: Option<f64>,
    /// Rms acceleration over its error from encoder steps and noise.
    pub acceleration_over_error: f64,
    /// Length of the stroke, m or rad.
    pub range: f64,
    /// Encoder step, m or rad, where it is known.
    pub step: Option<f64>,
}

impl Motion {
    /// `None` for a log without motion.
    pub(crate) fn of(log: &Log) -> Option<Self> {
        let n = log.time.len();
        let seconds = log.time.last()? - log.time.first()?;
        let (velocity, error, window) = speeds_within(log)?;
        let mut sizes: Vec<f64> = velocity.iter().map(|v| v.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let top_speed = sizes[((1.0 - motion::SHARE_ABOVE_TOP) * (n - 1) as f64) as usize];
        if top_speed <= error || seconds <= 0.0 {
            return None;
        }
        let mut resting = vec![false; n];
        for rest in &log.rests {
            resting[rest.clone()].fill(true);
        }
        let share = |test: &dyn Fn(f64) -> bool| {
            let hits = velocity.iter().zip(&resting);
            hits.filter(|(v, rest)| !**rest && test(**v)).count() as f64 / n as f64
        };
        let decade = |k: usize, sign: f64| {
            let low = top_speed * DECADES[k + 1];
            let high = match k {
                0 => f64::INFINITY,
                _ => top_speed * DECADES[k],
            };
            // A speed within its own error may be rest.
            share(&|v: f64| v * sign > low.max(3.0 * error) && v * sign <= high)
        };
        let sides = [0, 1, 2].map(|k| (decade(k, 1.0), decade(k, -1.0)));
        let moving: Vec<f64> = sizes.iter().copied().filter(|v| *v > 3.0 * error).collect();
        let at = |part: f64| {
            let last = moving.len().saturating_sub(1);
            moving
                .get((part * last as f64) as usize)
                .copied()
                .unwrap_or(0.0)
        };
        let (x, turns) = turns(log)?;
        let low = x.iter().copied().fold(f64::INFINITY, f64::min);
        let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let accelerations: Vec<f64> = (2 * window..n)
            .step_by(window)
            .map(|i| {
                let dt = log.time[i] - log.time[i - 2 * window];
                (velocity[i] - velocity[i - 2 * window]) / dt
            })
            .collect();
        let squares: f64 = accelerations.iter().map(|a| a * a).sum();
        let rms = (squares / accelerations.len().max(1) as f64).sqrt();
        let span = 2.0 * window as f64 / log.rate_hz;
        Some(Self {
            rate_hz: log.rate_hz,
            top_speed,
            speed_error: error,
            forward: share(&|v: f64| v > 3.0 * error),
            back: share(&|v: f64| v < -3.0 * error),
            still: velocity.iter().filter(|v| v.abs() <= error).count() as f64 / n as f64,
            at_rest: resting.iter().filter(|r| **r).count() as f64 / n as f64,
            decades: sides.map(|(a, b)| a + b),
            decades_one_way: sides.map(|(a, b)| a.min(b)),
            slow_speed: at(0.05),
            middle_speed: at(0.5),
            reversals: turns.len(),
            samples_at_reversal: log
                .force
                .as_ref()
                .and_then(|force| samples_after(&x, force, &turns)),
            acceleration_over_error: if error > 0.0 {
                rms * span / error
            } else {
                f64::INFINITY
            },
            range: high - low,
            step: log.quantum,
        })
    }
}

/// The velocity of each sample, m/s or rad/s: of the position over a window just long enough for its encoder steps and noise,
/// as recorded where there is none; `None` without either.
pub fn speeds(log: &Log) -> Option<Vec<f64>> {
    Some(speeds_within(log)?.0)
}

/// Speeds with their error and the window, in samples to each side, that they are taken over.
fn speeds_within(log: &Log) -> Option<(Vec<f64>, f64, usize)> {
    let n = log.time.len();
    let Some(x) = &log.position else {
        let velocity = log.velocity.clone()?;
        let error = 3.0 * noise_deviation(std::iter::once(&velocity[..]));
        return Some((velocity, error, 1));
    };
    let noise = noise_deviation(log.segments.iter().filter_map(|s| x.get(s.clone())));
    let step = log.quantum.unwrap_or(0.0).max(noise);
    let longest = ((LONGEST_WINDOW * log.rate_hz) as usize).clamp(1, (n / 4).max(1));
    let mut window = 1;
    loop {
        let velocity: Vec<f64> = (0..n)
            .map(|i| {
                let (a, b) = (i.saturating_sub(window), (i + window).min(n - 1));
                (x[b] - x[a]) / (log.time[b] - log.time[a])
            })
            .collect();
        let error = step * log.rate_hz / (2 * window) as f64;
        let top = velocity.iter().fold(0.0_f64, |top, v| top.max(v.abs()));
        if error <= motion::MAX_SPEED_ERROR * top || 2 * window > longest {
            return Some((velocity, error, window));
        }
        window *= 2;
    }
}

/// Samples from a turn until the force has gone most of the way from its level in one direction to that in the other,
/// at the third slowest turn, so that one dwell does not count. A force that has done so before the turn, because the
/// axis brakes, takes none.
fn samples_after(x: &[f64], force: &[f64], turns: &[usize]) -> Option<f64> {
    let mut levels = [Vec::new(), Vec::new()];
    let ends = turns.iter().copied().chain([x.len() - 1]);
    let mut start = 0;
    for end in ends {
        levels[usize::from(x[end] > x[start])].extend(&force[start..=end]);
        start = end;
    }
    let [back, forward] = levels.map(|mut level: Vec<f64>| {
        let middle = level.len() / 2;
        (!level.is_empty()).then(|| *level.select_nth_unstable_by(middle, f64::total_cmp).1)
    });
    let (back, forward) = (back?, forward?);
    let after = turns.iter().enumerate().filter_map(|(k, &turn)| {
        let next = turns.get(k + 1).copied().unwrap_or(x.len());
        let (from, to) = match x[next - 1] > x[turn] {
            true => (back, forward),
            false => (forward, back),
        };
        let there = |f: &f64| (f - from) / (to - from) >= motion::MIN_FORCE_TURN;
        force[turn..next].iter().position(there).map(|k| k as f64)
    });
    let mut counts: Vec<f64> = after.collect();
    counts.sort_by(|a, b| b.total_cmp(a));
    counts.get(2.min(counts.len().saturating_sub(1))).copied()
}
