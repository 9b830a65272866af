//! From which deviation on a number has changed: where a fleet in which nothing changes would be alarmed as seldom as was asked
//! for.
//!
//! The distribution of the largest deviation that is looked at over the horizon has no closed form: medians of windows that
//! overlap, of numbers that are not normal, against a reference that wanders too. So quiet machines are simulated with the noise
//! that was found (a parametric bootstrap, Efron and Tibshirani 1993), and the limits are quantiles of what they do.

use crate::course::Measure;
use crate::noise::Noise;
use crate::random::Random;
use crate::robust::weighted_median;

/// Logs of a window: the fewest in which one or two far off say nothing, and more for changes that are small.
pub const WINDOWS: [usize; 3] = [5, 10, 20];

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Part of the machines in which nothing changes that may be alarmed within the horizon, 0 to 1. Default 0.035: of worlds that
    /// are not quite what the test takes them for, at most 0.05.
    pub alarmed: f64,
    /// The horizon, s; at least the logs of the longest window. Default 60 days.
    pub horizon: f64,
    /// Logs from which the reference of a machine is taken, at least 3. Default 10.
    pub reference: usize,
    /// Seed of the simulated machines.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            alarmed: 0.035,
            horizon: 60.0 * 86_400.0,
            reference: 10,
            seed: 0,
        }
    }
}

/// The deviations of medians over the windows from which on a number has changed, on the scale of its measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// For each of [`WINDOWS`].
    pub of_window: [f64; WINDOWS.len()],
    /// Logs of the reference.
    pub reference: usize,
}

/// Machines that are simulated.
const MACHINES: usize = 4000;
/// Most logs of a machine that is simulated.
const MOST_LOGS: usize = 1000;
/// The quantile at which windows are brought to the same scale.
const COMMON: f64 = 0.95;

impl Limits {
    /// The limits for one of so many numbers that are looked at on each machine.
    pub fn of(noise: &Noise, numbers: usize, settings: &Settings) -> Self {
        Self::of_while(noise, numbers, settings, || true).expect("goes on")
    }

    /// The same for as long as `goes_on` says so, which is asked for each machine that is simulated; else `None`.
    pub fn of_while(
        noise: &Noise,
        numbers: usize,
        settings: &Settings,
        mut goes_on: impl FnMut() -> bool,
    ) -> Option<Self> {
        let reference = settings.reference.max(3);
        // Every window is looked at once at least, however seldom there is a log.
        let logs = (settings.horizon / noise.spacing)
            .ceil()
            .max(WINDOWS[WINDOWS.len() - 1] as f64);
        let logs = (logs as usize).min(MOST_LOGS);
        let part = settings.alarmed / numbers.max(1) as f64;
        let mut random = Random::new(settings.seed);
        let mut machine = || largest(&quiet(noise, reference + logs, &mut random), reference);
        let machines = (0..MACHINES).map(|_| goes_on().then(&mut machine));
        let machines: Vec<[f64; WINDOWS.len()]> = machines.collect::<Option<_>>()?;
        let mut of_window = [0.0; WINDOWS.len()];
        for (w, unit) in of_window.iter_mut().enumerate() {
            *unit = quantile(machines.iter().map(|m| m[w]).collect(), COMMON);
        }
        // One factor for all windows, since a machine is alarmed by any of them.
        let worst = |machine: &[f64; WINDOWS.len()]| {
            let parts = machine
                .iter()
                .zip(of_window)
                .map(|(x, unit)| if unit > 0.0 { x / unit } else { 0.0 });
            parts.fold(0.0, f64::max)
        };
        let factor = quantile(machines.iter().map(worst).collect(), 1.0 - part);
        Some(Limits {
            of_window: of_window.map(|unit| unit * factor),
            reference,
        })
    }

    /// Whether changes of the size of the number itself would be found: one to double, or of a number that may be 0 one by all
    /// that it usually is. Where not, that nothing was found tells nothing.
    pub fn tell(&self, noise: &Noise) -> bool {
        let most = match noise.measure {
            Measure::Relative => std::f64::consts::LN_2,
            Measure::Absolute => noise.level.abs(),
        };
        self.of_window[0] <= most
    }
}

/// The number below which that part of them lies; those between count by their distance.
fn quantile(mut numbers: Vec<f64>, part: f64) -> f64 {
    numbers.sort_unstable_by(f64::total_cmp);
    let place = part.clamp(0.0, 1.0) * (numbers.len() - 1) as f64;
    let (below, rest) = (place.floor() as usize, place.fract());
    let above = (below + 1).min(numbers.len() - 1);
    numbers[below] * (1.0 - rest) + numbers[above] * rest
}

/// A machine in which nothing changes: deviations with their weights.
fn quiet(noise: &Noise, logs: usize, random: &mut Random) -> Vec<(f64, f64)> {
    let stays = libm::exp(-noise.spacing / noise.memory);
    let renewed = noise.wandering * libm::sqrt(1.0 - stays * stays);
    let mut slow = noise.wandering * random.normal();
    let mut course = Vec::with_capacity(logs);
    for _ in 0..logs {
        let one = random.one_of(noise.shape.len());
        let std = noise.stds[random.one_of(noise.stds.len())];
        let sign = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        let new = sign * noise.shape[one] * libm::sqrt(noise.variance(std));
        course.push((slow + new, noise.weight(std)));
        slow = stays * slow + renewed * random.normal();
    }
    course
}

/// The largest deviation of the medians over each window.
fn largest(course: &[(f64, f64)], reference: usize) -> [f64; WINDOWS.len()] {
    let level = weighted_median(&mut course[..reference].to_vec());
    let after = &course[reference..];
    let mut window = Vec::new();
    WINDOWS.map(|logs| {
        let medians = after.windows(logs).map(|points| {
            window.clear();
            window.extend_from_slice(points);
            (weighted_median(&mut window) - level).abs()
        });
        medians.fold(0.0, f64::max)
    })
}
