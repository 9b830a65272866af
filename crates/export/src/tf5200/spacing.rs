//! A curve as few points with straight lines between them, with the least possible largest error.

/// Rounds in which the values of the points are shifted; far beyond where the error settles.
const SHIFT_ROUNDS: usize = 60;
/// Halvings of the common error: to the rounding of its first value.
const HALVINGS: usize = 50;

/// Points of a curve given at `x`, rising, by its values `y`: at most `count` of them, as index and value.
///
/// First the points: on the curve, every line as long as a common error allows, and the least such error. Then the
/// values: moved off the curve to where the errors on both sides of it are the same.
pub(super) fn least_error(x: &[f64], y: &[f64], count: usize) -> Vec<(usize, f64)> {
    let (mut low, mut high) = (0.0, span(y));
    let mut knots = chords(x, y, 0.0);
    if knots.len() > count {
        for _ in 0..HALVINGS {
            let error = 0.5 * (low + high);
            if chords(x, y, error).len() <= count {
                high = error;
            } else {
                low = error;
            }
        }
        knots = chords(x, y, high);
    }
    let mut values: Vec<f64> = knots.iter().map(|&k| y[k]).collect();
    let mut best = (largest(x, y, &knots, &values), values.clone());
    for _ in 0..SHIFT_ROUNDS {
        let middles: Vec<f64> = knots
            .windows(2)
            .zip(values.windows(2))
            .map(|(k, v)| {
                let (least, most) = errors(x, y, k, v);
                0.5 * (least + most)
            })
            .collect();
        for (i, value) in values.iter_mut().enumerate() {
            let before = i.checked_sub(1).map(|i| middles[i]);
            let after = middles.get(i).copied();
            let (a, b) = (before.or(after), after.or(before));
            *value += 0.5 * (a.unwrap_or(0.0) + b.unwrap_or(0.0));
        }
        let error = largest(x, y, &knots, &values);
        if error < best.0 {
            best = (error, values.clone());
        }
    }
    knots.into_iter().zip(best.1).collect()
}

fn span(y: &[f64]) -> f64 {
    let most = y.iter().copied().fold(f64::MIN, f64::max);
    let least = y.iter().copied().fold(f64::MAX, f64::min);
    most - least
}

/// Points on the curve: from each the farthest whose line to it is within `error`.
fn chords(x: &[f64], y: &[f64], error: f64) -> Vec<usize> {
    let mut knots = vec![0];
    let mut from = 0;
    while from + 1 < x.len() {
        let within = |to: usize| {
            let (least, most) = errors(x, y, &[from, to], &[y[from], y[to]]);
            // Beyond rounding, so that a straight curve is one line.
            most.max(-least) <= error + 1e-12 * (y[from].abs() + y[to].abs())
        };
        let (mut good, mut bad) = (from + 1, x.len());
        while good + 1 < bad {
            let middle = good + (bad - good) / 2;
            if within(middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        knots.push(good);
        from = good;
    }
    knots
}

/// Least and largest of the curve less the line between two points.
fn errors(x: &[f64], y: &[f64], ends: &[usize], values: &[f64]) -> (f64, f64) {
    let (a, b) = (ends[0], ends[1]);
    let slope = (values[1] - values[0]) / (x[b] - x[a]);
    (a..=b).fold((f64::MAX, f64::MIN), |(least, most), i| {
        let off = y[i] - (values[0] + slope * (x[i] - x[a]));
        (least.min(off), most.max(off))
    })
}

fn largest(x: &[f64], y: &[f64], knots: &[usize], values: &[f64]) -> f64 {
    let each = knots.windows(2).zip(values.windows(2));
    each.map(|(k, v)| {
        let (least, most) = errors(x, y, k, v);
        most.max(-least)
    })
    .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known for many points n: the largest error of the best continuous broken line of n pieces is
    /// (integral of sqrt |f''|)^2 / (16 n^2). For exp(-x) over 0 to 5 the integral is 2 (1 - exp(-2.5)).
    #[test]
    fn as_good_as_it_gets() {
        let x: Vec<f64> = (0..=5000).map(|k| 1e-3 * f64::from(k)).collect();
        let y: Vec<f64> = x.iter().map(|x| libm::exp(-x)).collect();
        let table = least_error(&x, &y, 20);
        let (knots, values): (Vec<usize>, Vec<f64>) = table.into_iter().unzip();
        assert_eq!(knots.len(), 20);
        let integral = 2.0 * (1.0 - libm::exp(-2.5));
        let best = integral * integral / (16.0 * 19.0 * 19.0);
        let found = largest(&x, &y, &knots, &values);
        assert!(found < 1.1 * best && found > 0.98 * best, "{found} {best}");
        // Evenly spaced points on the curve: h^2/8 where it bends most.
        assert!(found < 0.2 * (5.0_f64 / 19.0).powi(2) / 8.0);
    }

    #[test]
    fn a_straight_line_takes_two_points() {
        let x: Vec<f64> = (0..100).map(f64::from).collect();
        let y: Vec<f64> = x.iter().map(|x| 3.0 + 0.1 * x).collect();
        assert_eq!(least_error(&x, &y, 20).len(), 2);
    }
}
