//! How much force the law leaves, and where: from the residual of the samples that were fitted.
//!
//! White noise of the force is no friction and is taken out everywhere: its size is seen in the second differences of the
//! residual, and what it adds to the mean of n samples is its variance over n.

use stiction_files::result::{RemainingEntry, ShapeEntry};
use stiction_identify::Series;
use stiction_policy::effect;

/// Stretches of time and places, in each of which the level of friction is looked at.
const PARTS: usize = 8;
/// Places at which a force that differs from place to place is looked at.
const PLACES: usize = 64;
/// Lengths that divide the way after a reversal, in presliding lengths.
const LENGTHS: [f64; 6] = [0.25, 1.0, 4.0, 16.0, 64.0, 256.0];
/// Largest value of `exp(-s/4) - exp(-s)`, the course of a shape.
const SHAPE_PEAK: f64 = 0.4725;
/// Median of the square of a standard normal number.
const MEDIAN_SQUARE: f64 = 0.4549;

/// What remains, of a law with that presliding length (m or rad).
pub(super) fn remaining(series: &Series, presliding: f64) -> Option<RemainingEntry> {
    let n = series.time.len();
    if n < 4 * PLACES || !(presliding > 0.0 && presliding.is_finite()) {
        return None;
    }
    let friction: Vec<f64> = (series.model.iter().zip(&series.other))
        .map(|(m, o)| m - o)
        .collect();
    let mut left = series.residual();
    let white = white(&left);
    let low = series
        .position
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    let high = series
        .position
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let stroke = high - low;
    if !(stroke > 0.0 && stroke.is_finite()) {
        return None;
    }
    let time = one_after_another(series);
    let axes = [&time, &series.position].map(|x| Along::of(x));
    let level = (axes.iter())
        .map(|along| along.levels(&friction, &left, white).1)
        .fold(0.0, f64::max);
    for along in &axes {
        let levels = along.levels(&friction, &left, white).0;
        for ((&p, f), r) in along.parts.iter().zip(&friction).zip(&mut left) {
            *r -= levels[p] * f;
        }
    }
    let ways = ways(series, effect::MIN_REVERSAL * stroke);
    let shapes = shapes(&ways, presliding, &mut left, white);
    let place = |x: &f64| (((x - low) / stroke * PLACES as f64) as usize).min(PLACES - 1);
    let place: Vec<usize> = series.position.iter().map(place).collect();
    let (place, length) = places(&place, stroke, &mut left, white);
    let (wandering, memory) = wandering(series, &left);
    Some(RemainingEntry {
        level,
        shapes,
        place,
        place_length: length,
        wandering,
        memory,
    })
}

/// Times at which each log begins where the one before ended, s: levels that differ between logs are not to meet in a stretch.
fn one_after_another(series: &Series) -> Vec<f64> {
    let (mut shift, mut last) = (0.0, 0.0);
    let mut log = series.log.first();
    let samples = series.log.iter().zip(&series.time);
    samples
        .map(|(own, t)| {
            if log != Some(own) {
                (shift, log) = (last - t, Some(own));
            }
            last = t + shift;
            last
        })
        .collect()
}

/// Variance of the white part: that of second differences, which is six times as large, as its median shows it.
fn white(left: &[f64]) -> f64 {
    let mut squares: Vec<f64> = left
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2))
        .collect();
    squares.sort_unstable_by(f64::total_cmp);
    squares
        .get(squares.len() / 2)
        .map_or(0.0, |m| m / (6.0 * MEDIAN_SQUARE))
}

/// Time or place, divided into parts, in each of which the level of friction is looked at.
struct Along {
    /// From -1 to 1.
    at: Vec<f64>,
    parts: Vec<usize>,
}

impl Along {
    fn of(values: &[f64]) -> Self {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let at: Vec<f64> = (values.iter().map(|x| 2.0 * (x - low) / (high - low) - 1.0)).collect();
        let part = |x: &f64| ((0.5 * (x + 1.0) * PARTS as f64) as usize).min(PARTS - 1);
        Along {
            parts: at.iter().map(part).collect(),
            at,
        }
    }

    /// How far the level is from that of the law in each part, as a part of it, and how far it gets: in a part, or at an
    /// end of the straight line through all of them.
    fn levels(&self, friction: &[f64], left: &[f64], white: f64) -> ([f64; PARTS], f64) {
        let mut sums = [[0.0; 3]; PARTS];
        // Of the line a + b x: squares, and products with the residual.
        let (mut s0, mut s1, mut s2, mut p0, mut p1) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (((&p, x), f), r) in self.parts.iter().zip(&self.at).zip(friction).zip(left) {
            sums[p][0] += f * r;
            sums[p][1] += f * f;
            sums[p][2] += 1.0;
            s0 += f * f;
            s1 += f * f * x;
            s2 += f * f * x * x;
            p0 += f * r;
            p1 += f * r * x;
        }
        let least = effect::MIN_LEVEL_SHARE * left.len() as f64;
        let levels = sums.map(
            |[product, square, count]| match count >= least && square > 0.0 {
                true => product / square,
                false => 0.0,
            },
        );
        let beyond = |level: f64, square: f64| (level * level - white / square).max(0.0);
        let most = (levels.iter().zip(&sums))
            .filter(|(_, sums)| sums[1] > 0.0)
            .map(|(&level, sums)| beyond(level, sums[1]))
            .fold(0.0, f64::max);
        let determinant = s0 * s2 - s1 * s1;
        let ends = match determinant > 1e-9 * s0 * s2 {
            true => {
                let a = (s2 * p0 - s1 * p1) / determinant;
                let b = (s0 * p1 - s1 * p0) / determinant;
                let chance = determinant / s0;
                beyond((a + b).abs().max((a - b).abs()), chance)
            }
            false => 0.0,
        };
        (levels, most.max(ends).sqrt())
    }
}

/// Travel since the last reversal with its sign and the number of that reversal, for each sample.
fn ways(series: &Series, least: f64) -> Vec<(f64, usize)> {
    let x = &series.position;
    let (mut turned, mut farthest, mut direction, mut count) = (x[0], x[0], 0.0_f64, 0);
    let step = |&x: &f64| {
        let on = (x - farthest) * direction;
        if direction == 0.0 {
            if (x - turned).abs() > least {
                (direction, farthest) = ((x - turned).signum(), x);
            }
        } else if on > 0.0 {
            farthest = x;
        } else if -on > least {
            (turned, farthest, direction, count) = (farthest, x, -direction, count + 1);
        }
        (x - turned, count)
    };
    x.iter().map(step).collect()
}

/// Force after a reversal, as far as it is not that of the law; its mean is taken out of what is left.
fn shapes(ways: &[(f64, usize)], presliding: f64, left: &mut [f64], white: f64) -> Vec<ShapeEntry> {
    let mut out = Vec::new();
    for pair in LENGTHS.windows(2) {
        let (short, long) = (pair[0] * presliding, pair[1] * presliding);
        let within = |s: f64| s.abs() >= short && s.abs() < long;
        // One mean for each way that has samples there.
        let mut squares = 0.0;
        let mut count = 0.0;
        let mut total = 0.0;
        let mut samples = 0.0;
        let mut i = 0;
        while i < ways.len() {
            let end = i + ways[i..].iter().take_while(|w| w.1 == ways[i].1).count();
            let (mut sum, mut n) = (0.0, 0.0);
            for t in i..end {
                if within(ways[t].0) {
                    sum += left[t] * ways[t].0.signum();
                    n += 1.0;
                }
            }
            if n > 0.0 {
                squares += sum * sum / n - white;
                count += n;
                total += sum;
                samples += n;
            }
            i = end;
        }
        let force: f64 = if count > 0.0 {
            (squares / count).max(0.0).sqrt()
        } else {
            0.0
        };
        let mean = if samples > 0.0 { total / samples } else { 0.0 };
        for (w, r) in ways.iter().zip(left.iter_mut()) {
            if within(w.0) {
                *r -= mean * w.0.signum();
            }
        }
        out.push(ShapeEntry {
            force: force / SHAPE_PEAK,
            short,
            long,
        });
    }
    out
}

/// Rms force that differs from place to place, and its wavelength; taken out of what is left.
fn places(places: &[usize], stroke: f64, left: &mut [f64], white: f64) -> (f64, f64) {
    let mut sums = [(0.0, 0.0); PLACES];
    for (&p, r) in places.iter().zip(left.iter()) {
        sums[p].0 += r;
        sums[p].1 += 1.0;
    }
    let n = left.len() as f64;
    let means = sums.map(|(sum, count)| if count > 0.0 { sum / count } else { 0.0 });
    let energy = sums
        .iter()
        .filter(|s| s.1 > 0.0)
        .map(|s| s.0 * s.0 / s.1 - white)
        .sum::<f64>()
        / n;
    // The zero crossings of a random wave are half its length apart (Rice).
    let crossings = means
        .windows(2)
        .filter(|m| m[0] * m[1] < 0.0)
        .count()
        .max(1);
    for (&p, r) in places.iter().zip(left.iter_mut()) {
        *r -= means[p];
    }
    (energy.max(0.0).sqrt(), 2.0 * stroke / crossings as f64)
}

/// What is left beyond white noise and forgets itself, rms and time constant, from the covariance over one and two samples.
fn wandering(series: &Series, left: &[f64]) -> (f64, f64) {
    let n = left.len();
    let mut steps: Vec<f64> = series.time.windows(2).map(|t| t[1] - t[0]).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let step = steps[steps.len() / 2];
    let over = |lag: usize| (lag..n).map(|t| left[t] * left[t - lag]).sum::<f64>() / n as f64;
    let (all, one, two) = (over(0), over(1), over(2));
    if !(one > 0.0 && two > 0.0 && two < one) {
        return (0.0, step);
    }
    let kept = two / one;
    ((one / kept).min(all).sqrt(), -step / kept.ln())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const COULOMB: f64 = 10.0;
    const STROKE: f64 = 0.05;

    /// Ten seconds to and fro, with a residual that is a function of time, position and direction.
    fn series(left: impl Fn(f64, f64, f64) -> f64) -> Series {
        let mut series = Series::default();
        for k in 0..5000 {
            let t = 2e-3 * k as f64;
            let (x, v) = (0.5 * STROKE * (1.0 - (TAU * t).cos()), (TAU * t).sin());
            let model = COULOMB * v.signum();
            series.log.push(0);
            series.time.push(t);
            series.position.push(x);
            series.velocity.push(0.5 * STROKE * TAU * v);
            series.model.push(model);
            series.other.push(0.0);
            series.measured.push(model + left(t, x, v.signum()));
        }
        series
    }

    /// White and of variance 1, the same every time.
    fn white_noise() -> impl Fn(f64) -> f64 {
        |t| {
            let mut x = (t * 1e6).round() as u64;
            let mut sum = 0.0;
            for _ in 0..12 {
                x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let mut y = x;
                y = (y ^ (y >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                y = (y ^ (y >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                sum += ((y ^ (y >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
            }
            sum - 6.0
        }
    }

    fn found(left: impl Fn(f64, f64, f64) -> f64) -> RemainingEntry {
        remaining(&series(left), 1e-5).unwrap()
    }

    #[test]
    fn noise_is_not_friction() {
        let noise = white_noise();
        let found = found(|t, _, _| noise(t));
        assert!(found.level < 0.02, "{found:?}");
        assert!(found.place < 0.15 && found.wandering < 0.2, "{found:?}");
        assert!(found.shapes.iter().all(|s| s.force < 0.8), "{found:?}");
    }

    #[test]
    fn a_level_that_drifts_is_found_up_to_its_end() {
        let noise = white_noise();
        let drift = found(|t, _, sign| 0.1 * noise(t) + sign * COULOMB * 0.2 * (t / 10.0 - 0.5));
        assert!((drift.level - 0.1).abs() < 0.01, "{drift:?}");
        let along = found(|t, x, sign| 0.1 * noise(t) + sign * COULOMB * 0.2 * (x / STROKE - 0.5));
        assert!((along.level - 0.1).abs() < 0.01, "{along:?}");
    }

    #[test]
    fn a_level_that_logs_have_differently_is_found() {
        let noise = white_noise();
        let log = |level: f64| series(|t, _, sign| 0.1 * noise(t) + sign * COULOMB * level);
        let (mut both, second) = (log(0.1), log(-0.1));
        both.log.extend(second.log.iter().map(|_| 1));
        both.time.extend(second.time);
        both.position.extend(second.position);
        both.velocity.extend(second.velocity);
        both.model.extend(second.model);
        both.other.extend(second.other);
        both.measured.extend(second.measured);
        let found = remaining(&both, 1e-5).unwrap();
        // Of a step at the middle the straight line through all stretches ends at one and a half of it.
        assert!((found.level - 0.15).abs() < 0.01, "{found:?}");
    }

    #[test]
    fn a_wave_over_the_stroke_is_found_with_its_length() {
        let noise = white_noise();
        let wave = found(|t, x, _| 0.1 * noise(t) + (TAU * x / 0.01).sin());
        assert!((wave.place - 0.5_f64.sqrt()).abs() < 0.1, "{wave:?}");
        assert!((wave.place_length / 0.01 - 1.0).abs() < 0.2, "{wave:?}");
    }

    #[test]
    fn a_series_that_says_nothing_gives_nothing() {
        assert!(remaining(&Series::default(), 1e-5).is_none());
        assert!(remaining(&series(|_, _, _| 0.0), f64::NAN).is_none());
    }
}
