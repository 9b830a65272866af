//! What a number does where nothing changes: the intervals, the scatter between logs, slow wandering, temperature.
//!
//! All machines of a fleet are taken together, and medians throughout, so that the few that change say little. The variance of
//! differences over a lag (the variogram, Matheron 1963) is that of the scatter at short lags, and rises by that of the wandering
//! where the lag is longer than its memory.

use crate::course::{Measure, Point};
use crate::limits::WINDOWS;
use crate::robust::{SCALE_OF_MAD, median, weighted_median};
use stiction_policy::drift;

/// What a number does by itself; on the scale of its [`Measure`].
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// How changes are counted.
    pub measure: Measure,
    /// Change for each unit of temperature; none where temperatures are not known or do not differ.
    pub by_temperature: Option<f64>,
    /// Standard deviation of the scatter between logs beyond their intervals.
    pub scatter: f64,
    /// Standard deviation of the slow wandering.
    pub wandering: f64,
    /// Its time constant, s.
    pub memory: f64,
    /// Time between two logs, s: the median.
    pub spacing: f64,
    /// Part of the stated variances that repeats show, 0 to 1: what is off by the same in every log does not scatter.
    pub(crate) stated: f64,
    /// Median of all estimates.
    pub(crate) level: f64,
    /// Deviations over their standard deviation, as they were found.
    pub(crate) shape: Vec<f64>,
    /// Standard deviations of the estimates, as they were found.
    pub(crate) stds: Vec<f64>,
}

/// Lags at which differences are looked at, logs.
const LAGS: [usize; 8] = [1, 2, 3, 5, 8, 13, 21, 34];
/// Memories that are tried, in spacings.
const MEMORIES: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// Variance at a lag, as a part of the largest, up to which it is none but for rounding.
const NOTHING: f64 = 1e-20;
/// Most deviations that are kept as their shape.
const MOST_SHAPES: usize = 8192;

impl Noise {
    /// What is seen in these courses, each of one machine in the order of time; `None` where they are too short.
    pub fn of(courses: &[&[Point]]) -> Option<Self> {
        let measure = Measure::of(courses);
        let by_temperature = by_temperature(courses, measure);
        let courses: Vec<Vec<(f64, f64, f64)>> = courses
            .iter()
            .map(|course| without_steps(scaled(course, measure, by_temperature)))
            .collect();
        let spacing = spacing(&courses)?;
        let mut values: Vec<f64> = courses.iter().flatten().map(|p| p.1).collect();
        let mut squares: Vec<f64> = courses
            .iter()
            .flatten()
            .map(|(.., std)| std * std)
            .collect();
        let own = median(&mut squares);
        let (white, wandering, memory, repeats) = variances(&courses, spacing)?;
        let stated = if own > repeats { repeats / own } else { 1.0 };
        let scatter = libm::sqrt((white - stated * own).max(0.0));
        // Few and short courses show little of a slow wandering; what they do not show is counted.
        let spans: f64 = courses.iter().map(|course| span(course)).sum();
        let seen = (spans / (2.0 * memory)).max(1.0);
        let wandering = libm::sqrt(wandering * (1.0 + 2.0 * libm::sqrt(2.0 / seen)));
        let mut noise = Noise {
            measure,
            by_temperature,
            scatter,
            wandering,
            memory,
            spacing,
            stated,
            level: median(&mut values),
            shape: Vec::new(),
            stds: Vec::new(),
        };
        noise.take_shape(&courses)?;
        Some(noise)
    }

    /// Variance of a log of that deviation beside the wandering.
    pub(crate) fn variance(&self, std: f64) -> f64 {
        // Of noise of exactly 0 every difference would be a change.
        (self.stated * std * std + self.scatter * self.scatter).max(f64::MIN_POSITIVE)
    }

    /// Weight of a log of that deviation in a median: one that is well known does not count more than the wandering lets it.
    pub(crate) fn weight(&self, std: f64) -> f64 {
        1.0 / (self.variance(std) + self.wandering * self.wandering)
    }

    /// Gathers how deviations are spread, which need not be normal: each against the median of its neighbours.
    fn take_shape(&mut self, courses: &[Vec<(f64, f64, f64)>]) -> Option<()> {
        let mut shape = Vec::new();
        let mut stds = Vec::new();
        for course in courses {
            for (at, &(_, value, std)) in course.iter().enumerate() {
                // The four nearest others, fewer in the shortest courses.
                let first = at.saturating_sub(2).min(course.len().saturating_sub(5));
                let near = (first..course.len().min(first + 5)).filter(|i| *i != at);
                let middle = median(&mut near.map(|i| course[i].1).collect::<Vec<f64>>());
                shape.push((value - middle) / libm::sqrt(self.variance(std)));
                stds.push(std);
            }
        }
        let mut sizes: Vec<f64> = shape.iter().map(|x| x.abs()).collect();
        let unit = SCALE_OF_MAD * median(&mut sizes);
        if shape.len() < drift::MIN_DIFFERENCES || !unit.is_finite() {
            return None;
        }
        let step = shape.len().div_ceil(MOST_SHAPES);
        let unit = if unit > 0.0 { unit } else { 1.0 };
        self.shape = shape.into_iter().step_by(step).map(|x| x / unit).collect();
        self.stds = stds.into_iter().step_by(step).collect();
        Some(())
    }
}

/// Time, place on the scale without what temperature does, and deviation of each point.
pub(crate) fn scaled(
    course: &[Point],
    measure: Measure,
    by_temperature: Option<f64>,
) -> Vec<(f64, f64, f64)> {
    let mut known: Vec<f64> = course.iter().filter_map(|p| p.temperature).collect();
    let usual = median(&mut known);
    let one = |point: &Point| {
        let warmer = point.temperature.map_or(0.0, |t| t - usual);
        let value = measure.scaled(point.value) - by_temperature.unwrap_or(0.0) * warmer;
        (point.time, value, measure.deviation(point))
    };
    course.iter().map(one).collect()
}

/// The course with its later part brought to the level of the earlier one at each step: what happens once tells nothing of what
/// a number does by itself.
fn without_steps(mut course: Vec<(f64, f64, f64)>) -> Vec<(f64, f64, f64)> {
    // Each has to be found in what the others leave.
    for _ in 0..course.len() / WINDOWS[0] {
        let Some((at, size)) = step(&course) else {
            break;
        };
        course[at..]
            .iter_mut()
            .for_each(|(_, value, _)| *value -= size);
    }
    course
}

/// Place and size of the clearest step of a course: medians before and after it that are [`drift::MIN_STEP`] times further from each other
/// than logs scatter about them.
fn step(course: &[(f64, f64, f64)]) -> Option<(usize, f64)> {
    let clear = |at: usize| {
        let middle = |from: usize, to: usize| {
            median(&mut course[from..to].iter().map(|p| p.1).collect::<Vec<f64>>())
        };
        let (from, to) = (
            at.saturating_sub(WINDOWS[1]),
            course.len().min(at + WINDOWS[1]),
        );
        let (before, after) = (middle(from, at), middle(at, to));
        let off = |i: usize| (course[i].1 - if i < at { before } else { after }).abs();
        // The mean, not the median: numbers that repeat exactly more often than not scatter all the same.
        let scale = (from..to).map(off).sum::<f64>() / (to - from) as f64;
        let size = after - before;
        (size.abs() > drift::MIN_STEP * scale).then_some((size.abs() / scale, at, size))
    };
    let last = course.len().saturating_sub(WINDOWS[0]);
    let steps = (WINDOWS[0]..=last).filter_map(clear);
    let clearest = steps.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((clearest.1, clearest.2))
}

fn span(course: &[(f64, f64, f64)]) -> f64 {
    match (course.first(), course.last()) {
        (Some(first), Some(last)) => last.0 - first.0,
        _ => 0.0,
    }
}

/// Median time between two logs; `None` without two at different times.
fn spacing(courses: &[Vec<(f64, f64, f64)>]) -> Option<f64> {
    let steps = courses
        .iter()
        .flat_map(|c| c.windows(2).map(|w| w[1].0 - w[0].0));
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    let spacing = median(&mut steps);
    spacing.is_finite().then_some(spacing)
}

/// Change for each unit of temperature: the slope of least absolute deviations of differences within a machine, in which its
/// level has no part and slow wandering hardly any.
fn by_temperature(courses: &[&[Point]], measure: Measure) -> Option<f64> {
    let mut slopes = Vec::new();
    for course in courses {
        for lag in LAGS {
            for (a, b) in course.iter().zip(course.iter().skip(lag)) {
                let (Some(before), Some(after)) = (a.temperature, b.temperature) else {
                    continue;
                };
                let warmer = after - before;
                let more = measure.scaled(b.value) - measure.scaled(a.value);
                if warmer != 0.0 {
                    slopes.push((more / warmer, warmer.abs()));
                }
            }
        }
    }
    let slope = weighted_median(&mut slopes);
    (slopes.len() >= drift::MIN_DIFFERENCES && slope.is_finite()).then_some(slope)
}

/// Variance of what is new in each log, that of the wandering, and its memory: those whose variogram is nearest to that of the
/// courses; and an upper bound of the variance of repeats, from successive logs.
fn variances(courses: &[Vec<(f64, f64, f64)>], spacing: f64) -> Option<(f64, f64, f64, f64)> {
    let mut seen = Vec::new();
    let mut repeats = 0.0;
    for lag in LAGS {
        let pairs = courses
            .iter()
            .flat_map(|c| c.iter().zip(c.iter().skip(lag)));
        let (mut sizes, mut times): (Vec<f64>, Vec<f64>) =
            pairs.map(|(a, b)| ((b.1 - a.1).abs(), b.0 - a.0)).unzip();
        if sizes.len() < drift::MIN_DIFFERENCES {
            break;
        }
        let scale = SCALE_OF_MAD * median(&mut sizes);
        let variance = 0.5 * scale * scale;
        if lag == 1 {
            // Two deviations of a robust variance from that many normal differences above it.
            repeats = variance * (1.0 + 2.0 * libm::sqrt(5.4 / sizes.len() as f64));
        }
        seen.push((median(&mut times), variance));
    }
    let largest = seen.iter().map(|(_, v)| *v).fold(0.0, f64::max);
    if seen.is_empty() {
        return None;
    }
    if largest == 0.0 {
        return Some((0.0, 0.0, spacing, repeats));
    }
    seen.iter_mut().for_each(|(_, v)| *v /= largest);
    // A lag at which nothing differs, as in numbers that repeat, would outweigh all others. One that differs little does so rightly:
    // where many differ by a step between them, at long lags, it alone shows the scatter.
    seen.retain(|(_, v)| *v > NOTHING);
    let fits = MEMORIES.map(|memory| fitted(&seen, memory * spacing));
    let best = fits.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((largest * best.1, largest * best.2, best.3, repeats))
}

/// Error, variance of what is new, variance of the wandering for a memory: least squares of the relative error, neither below 0.
fn fitted(seen: &[(f64, f64)], memory: f64) -> (f64, f64, f64, f64) {
    let part = |lag: f64| -libm::expm1(-lag / memory);
    let sum = |of: &dyn Fn(f64) -> f64| {
        seen.iter()
            .map(|(lag, v)| of(part(*lag)) / (v * v))
            .sum::<f64>()
    };
    let with =
        |of: &dyn Fn(f64) -> f64| seen.iter().map(|(lag, v)| of(part(*lag)) / v).sum::<f64>();
    let (ones, mixed, squares) = (sum(&|_| 1.0), sum(&|g| g), sum(&|g| g * g));
    let (first, second) = (with(&|_| 1.0), with(&|g| g));
    let whole = ones * squares - mixed * mixed;
    let both = (
        (first * squares - second * mixed) / whole,
        (second * ones - first * mixed) / whole,
    );
    let alone = [both, (first / ones, 0.0), (0.0, second / squares)];
    let error = |(white, slow): (f64, f64)| -> f64 {
        let off = |(lag, v): &(f64, f64)| (white + slow * part(*lag)) / v - 1.0;
        seen.iter().map(|point| off(point) * off(point)).sum()
    };
    let allowed = alone
        .into_iter()
        .filter(|(white, slow)| *white >= 0.0 && *slow >= 0.0);
    let best = allowed.min_by(|a, b| error(*a).total_cmp(&error(*b)));
    let (white, slow) = best.unwrap_or((first / ones, 0.0));
    (error((white, slow)), white, slow, memory)
}
