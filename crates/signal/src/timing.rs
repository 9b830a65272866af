//! Whether a position was read beside the instants of its stamps: noise that grows with speed.

use std::ops::Range;

/// Order of the differences.
const DIFFERENCE_ORDER: usize = 6;
/// Sum of the squared weights of a sixth difference: the binomial coefficient of 12 over 6.
const DIFFERENCE_GAIN: f64 = 924.0;
/// Median of the square of a normal number with the variance 1.
const MEDIAN_OF_SQUARE: f64 = 0.454_936;
/// Classes of speed, of equal width up to the largest.
const CLASSES: usize = 4;
/// Fewest differences of a class.
const FEWEST: usize = 200;
/// Least way in a sample, in steps of the encoder, from which on its steps are noise.
const LEAST_WAY: f64 = 2.0;
/// Least timing noise that is told from a smooth motion, samples: the sixth difference of a motion at a sixteenth of the sample
/// rate is as large.
const LEAST: f64 = 0.01;
/// How many times its noise at rest the position has to have at the largest speed, in variances.
const GROWTH: f64 = 4.0;
/// How far the variance of a class may be from the line, of the line.
const FIT: f64 = 0.5;

/// Noise of a position that was read beside the instants of its stamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimingNoise {
    /// Standard deviation of the instants, samples.
    pub samples: f64,
    /// Standard deviation of what does not grow with speed, in the position's unit.
    pub beside: f64,
}

/// The timing noise of positions, sampled evenly as they are stamped, with an encoder step of `step`; `None` where there is none
/// that can be told: its variance has to grow with the square of the speed, in each of four classes of speed.
///
/// From sixth differences, and their medians, so that stick-slip, gaps and stray samples count for little.
pub fn timing_noise<'a>(
    positions: impl Iterator<Item = &'a [f64]>,
    step: f64,
) -> Option<TimingNoise> {
    let mut windows: Vec<(f64, f64)> = Vec::new();
    for position in positions {
        windows.extend(position.windows(DIFFERENCE_ORDER + 1).map(|x| {
            let pairs = (x[0] + x[6]) - 6.0 * (x[1] + x[5]) + 15.0 * (x[2] + x[4]);
            let way = (x[6] - x[0]).abs() / DIFFERENCE_ORDER as f64;
            let difference = pairs - 20.0 * x[3];
            (way, difference * difference)
        }));
    }
    windows.retain(|(way, square)| *way > LEAST_WAY * step && square.is_finite());
    windows.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    // A few jumps are no speed.
    let top = windows.get(windows.len().checked_sub(FEWEST)?)?.0;
    let mut classes = Vec::with_capacity(CLASSES);
    for class in 0..CLASSES {
        let ends = [class, class + 1].map(|k| top * k as f64 / CLASSES as f64);
        let from = windows.partition_point(|(way, _)| *way < ends[0]);
        let to = match class + 1 {
            CLASSES => windows.len(),
            _ => windows.partition_point(|(way, _)| *way < ends[1]),
        };
        classes.extend(of_class(&windows, from..to));
    }
    line(&classes, top)
}

/// Square of the median way in a sample, and variance of the position.
fn of_class(windows: &[(f64, f64)], range: Range<usize>) -> Option<(f64, f64)> {
    if range.len() < FEWEST {
        return None;
    }
    let class = &windows[range];
    let middle = class.len() / 2;
    let way = class[middle].0;
    let mut squares: Vec<f64> = class.iter().map(|(_, square)| *square).collect();
    let (_, median, _) = squares.select_nth_unstable_by(middle, f64::total_cmp);
    Some((way * way, *median / (MEDIAN_OF_SQUARE * DIFFERENCE_GAIN)))
}

/// `variance = beside^2 + samples^2 way^2`, by least squares of the relative errors.
fn line(classes: &[(f64, f64)], top: f64) -> Option<TimingNoise> {
    if classes.len() < CLASSES - 1 || classes.iter().any(|(_, variance)| *variance <= 0.0) {
        return None;
    }
    let sum = |of: &dyn Fn(f64) -> f64| -> f64 {
        let each = classes
            .iter()
            .map(|(ways, variance)| of(*ways) / (variance * variance));
        each.sum()
    };
    let of_variance = |of: &dyn Fn(f64) -> f64| -> f64 {
        let each = classes.iter().map(|(ways, variance)| of(*ways) / variance);
        each.sum()
    };
    let (one, way, square) = (sum(&|_| 1.0), sum(&|w| w), sum(&|w| w * w));
    let (y, wy) = (of_variance(&|_| 1.0), of_variance(&|w| w));
    let determinant = one * square - way * way;
    let mut beside = (y * square - wy * way) / determinant;
    let mut samples = (one * wy - way * y) / determinant;
    if beside < 0.0 {
        (beside, samples) = (0.0, wy / square);
    }
    let fits = classes.iter().all(|(ways, variance)| {
        let due = beside + samples * ways;
        (variance - due).abs() <= FIT * due
    });
    let grows = samples * top * top >= GROWTH * beside && samples >= LEAST * LEAST;
    (fits && grows).then(|| TimingNoise {
        samples: samples.sqrt(),
        beside: beside.sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::timing_noise;

    /// Uniform in -1 to 1.
    fn random(state: &mut u64) -> f64 {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A sine of 1 Hz at 1 kHz, read up to `jitter` samples beside its stamps, in steps.
    fn sine(jitter: f64, step: f64, white: f64) -> Vec<f64> {
        let mut state = 1;
        (0..10_000)
            .map(|k| {
                let at = f64::from(k) + jitter * random(&mut state);
                let x =
                    0.05 * (std::f64::consts::TAU * at * 1e-3).sin() + white * random(&mut state);
                (x / step).round() * step
            })
            .collect()
    }

    #[test]
    fn instants_beside_their_stamps_are_found() {
        for jitter in [0.05, 0.2, 0.5] {
            let x = sine(jitter, 1e-7, 0.0);
            let found = timing_noise(std::iter::once(&x[..]), 1e-7).unwrap();
            let due = jitter / 3.0_f64.sqrt();
            assert!((found.samples / due - 1.0).abs() < 0.1, "{found:?} {due}");
            assert!(found.beside < 0.3 * due * 3e-4, "{found:?}");
        }
    }

    #[test]
    fn what_does_not_grow_with_speed_is_none() {
        for (step, white) in [(1e-7, 0.0), (5e-6, 0.0), (1e-7, 3e-6), (1e-4, 0.0)] {
            let x = sine(0.0, step, white);
            assert_eq!(
                timing_noise(std::iter::once(&x[..]), step),
                None,
                "{step} {white}"
            );
        }
        assert_eq!(timing_noise(std::iter::once(&[0.0; 3][..]), 0.0), None);
        assert_eq!(timing_noise(std::iter::once(&[0.0; 3000][..]), 0.0), None);
    }
}
