//! A channel read between its samples, as a delay between force and motion needs.

use std::array::from_fn;
use std::sync::Arc;
use stiction_signal::Reading;

/// Points of the Lagrange interpolation (docs/identification.md).
pub(crate) const INTERPOLATION_POINTS: usize = 6;

/// A shift by a fraction of a sample: reads a channel `samples` earlier.
///
/// Lagrange interpolation through six samples. It is exact for polynomials of degree 5; of a component
/// at a tenth of the sample rate it loses 6e-5, at a twentieth 1e-6.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shift {
    /// First of the samples that the interpolation reads, relative to the one asked for.
    first: isize,
    weights: [f64; INTERPOLATION_POINTS],
    /// Where the shift is a whole number of samples: the sample, relative to the one asked for, that is read.
    whole: Option<isize>,
}

impl Shift {
    /// No shift.
    pub const NONE: Self = Self {
        first: 0,
        weights: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        whole: Some(0),
    };

    /// The value `samples` earlier (later, if negative).
    pub fn earlier(samples: f64) -> Self {
        let (base, part) = split(samples);
        Self {
            first: base - 2,
            weights: derivatives(part, 0),
            whole: (part == 0.0).then_some(base),
        }
    }

    /// What a lag of first order, of the time constant `lag` (samples), makes of the channel that is sought, `samples`
    /// earlier: a part of `lag` of the time is that of the lag, which is undone, and the rest is a shift.
    pub fn before_lag(samples: f64, lag: f64) -> Self {
        if lag == 0.0 {
            return Self::earlier(samples);
        }
        Self::derived(samples + lag, [1.0, lag, 0.0])
    }

    /// The derivative of [`before_lag`](Self::before_lag) with respect to `samples`.
    pub fn slope(samples: f64, lag: f64) -> Self {
        Self::derived(samples + lag, [0.0, -1.0, -lag])
    }

    /// The derivative of [`before_lag`](Self::before_lag) with respect to the square of the lag.
    pub fn bend(samples: f64, lag: f64) -> Self {
        Self::derived(samples + lag, [0.0, 0.0, -0.5])
    }

    /// A sum of the value and its first two derivatives by the time in samples, `samples` earlier.
    fn derived(samples: f64, factors: [f64; 3]) -> Self {
        let (base, part) = split(samples);
        let of = [0, 1, 2].map(|order| derivatives(part, order));
        Self {
            first: base - 2,
            weights: from_fn(|i| (0..3).map(|order| factors[order] * of[order][i]).sum()),
            whole: None,
        }
    }

    /// The sample, relative to the one asked for, from which on a filter is read, and what is read there.
    pub fn reading(&self) -> (isize, Reading) {
        match self.whole {
            Some(whole) => (whole, Reading::SAMPLE),
            None => (self.first, Reading::between(self.weights)),
        }
    }

    /// What is read from `first` on, also where one sample is read alone.
    pub fn among(&self) -> Reading {
        Reading::between(self.weights)
    }

    /// The first of the six samples that are read, relative to the one asked for.
    pub fn first(&self) -> isize {
        self.first
    }

    /// What is read at each of the six samples alone.
    pub fn points() -> [Reading; INTERPOLATION_POINTS] {
        from_fn(|i| Reading::between(from_fn(|j| f64::from(u8::from(i == j)))))
    }

    /// The shifted channel at many samples, from its values at each of the six around them.
    pub fn of(&self, six: &[Arc<Vec<f64>>; INTERPOLATION_POINTS]) -> Arc<Vec<f64>> {
        let whole = self
            .whole
            .and_then(|whole| six.get(usize::try_from(whole - self.first).ok()?));
        if let Some(only) = whole {
            return Arc::clone(only);
        }
        let count = six.iter().map(|x| x.len()).min().unwrap_or(0);
        let six = six.each_ref().map(|x| &x[..count]);
        let at = |k: usize| self.between(&six.map(|x| x[k]));
        Arc::new((0..count).map(at).collect())
    }

    /// Two sums side by side, which is what every processor has.
    #[inline(always)]
    fn between(&self, six: &[f64; INTERPOLATION_POINTS]) -> f64 {
        let w = &self.weights;
        let sum = |i: usize| w[i] * six[i] + w[i + 2] * six[i + 2] + w[i + 4] * six[i + 4];
        sum(0) + sum(1)
    }

    /// Appends the shifted channel at every `every`-th sample, those numbered `numbers`.
    pub fn append(
        &self,
        full: &[f64],
        every: usize,
        numbers: std::ops::Range<usize>,
        out: &mut Vec<f64>,
    ) {
        out.reserve(numbers.len());
        let at = |i: usize| self.at(full, i * every);
        // Where no end is in the way, nothing needs to be asked.
        let points = INTERPOLATION_POINTS as isize;
        let ends = [-self.first, full.len() as isize - points - self.first + 1];
        let [begin, end] = ends
            .map(|x| (x.max(0) as usize).div_ceil(every))
            .map(|i| i.clamp(numbers.start, numbers.end));
        let (begin, end) = match self.whole {
            None => (begin, end.max(begin)),
            Some(_) => (numbers.end, numbers.end),
        };
        out.extend((numbers.start..begin).map(at));
        if let Some(first) = (begin * every).checked_add_signed(self.first)
            && let Some(rest) = full.get(first..)
        {
            let windows = rest.windows(INTERPOLATION_POINTS).step_by(every);
            let six = windows.take(end - begin).filter_map(<[f64]>::first_chunk);
            out.extend(six.map(|six| self.between(six)));
        }
        out.extend((end..numbers.end).map(at));
    }

    /// The shifted channel at sample `at`; beyond the ends the end values go on.
    #[inline(always)]
    pub fn at(&self, full: &[f64], at: usize) -> f64 {
        let last = full.len() as isize - 1;
        let read = |i: isize| full[(at as isize + i).clamp(0, last) as usize];
        if let Some(whole) = self.whole {
            return read(whole);
        }
        let inside = at
            .checked_add_signed(self.first)
            .and_then(|start| full.get(start..)?.first_chunk::<INTERPOLATION_POINTS>());
        if let Some(six) = inside {
            return self.between(six);
        }
        (0..INTERPOLATION_POINTS)
            .map(|i| self.weights[i] * read(self.first + i as isize))
            .sum()
    }

    /// The same of channels side by side.
    #[inline(always)]
    pub fn row<const L: usize>(&self, full: &[[f64; L]], at: usize) -> [f64; L] {
        let last = full.len() as isize - 1;
        let read = |i: isize| full[(at as isize + i).clamp(0, last) as usize];
        if let Some(whole) = self.whole {
            return read(whole);
        }
        let mut out = [0.0; L];
        for (i, weight) in (self.first..).zip(self.weights) {
            let row = read(i);
            for l in 0..L {
                out[l] += weight * row[l];
            }
        }
        out
    }
}

/// The sample before the point asked for, relative, and how far beyond it the point stands.
fn split(samples: f64) -> (isize, f64) {
    // Limited to more than the length of any log, so that the index stays in range whatever delay was given.
    let samples = if samples.is_nan() {
        0.0
    } else {
        samples.clamp(-1e12, 1e12)
    };
    let base = libm::floor(-samples);
    (base as isize, -samples - base)
}

/// Lagrange weights of the samples at -2..=3 for a point at `t`, 0 <= t < 1, or their derivatives of that order.
fn derivatives(t: f64, order: usize) -> [f64; INTERPOLATION_POINTS] {
    from_fn(|i| {
        let node = i as f64 - 2.0;
        product(t, node, order, &mut Vec::new())
    })
}

/// The polynomial that is 1 at a node and 0 at the others, those of `left` left out, at `t`; its derivative of that order.
fn product(t: f64, node: f64, order: usize, left: &mut Vec<f64>) -> f64 {
    if order == 0 {
        let factor = |x: f64| match left.contains(&x) {
            true => 1.0 / (node - x),
            false => (t - x) / (node - x),
        };
        return others(node).map(factor).product();
    }
    let mut sum = 0.0;
    for x in others(node) {
        if !left.contains(&x) {
            left.push(x);
            sum += product(t, node, order - 1, left);
            left.pop();
        }
    }
    sum
}

fn others(node: f64) -> impl Iterator<Item = f64> {
    (-2..=3).map(f64::from).filter(move |x| *x != node)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_five_is_shifted_exactly_with_its_derivative() {
        let f = |t: f64| 1.0 + t * (0.5 - t * (0.3 + t * (0.02 - t * (0.01 - 0.002 * t))));
        let full: Vec<f64> = (0..20).map(|i| f(0.3 * f64::from(i))).collect();
        for samples in [-1.7, -0.5, 0.0, 0.25, 2.0, 2.9] {
            let (value, slope) = (Shift::earlier(samples), Shift::slope(samples, 0.0));
            for at in 6..14 {
                let t = 0.3 * (at as f64 - samples);
                let want = (f(t + 1e-5) - f(t - 1e-5)) / 2e-5 * -0.3;
                assert!((value.at(&full, at) - f(t)).abs() < 1e-11);
                assert!((slope.at(&full, at) - want).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn a_lag_of_first_order_is_undone() {
        // In samples: what was c0 + c1 t + c2 t^2 is behind a lag of L, in the steady state,
        // c0 - c1 L + 2 c2 L^2 + (c1 - 2 c2 L) t + c2 t^2.
        let before = |t: f64| 1.0 + 0.3 * t - 0.02 * t * t;
        for (samples, lag) in [(-0.5, 0.0), (-1.7, 0.6), (-2.4, 1.5), (-3.0, 2.5)] {
            let behind =
                |t: f64| 1.0 - 0.3 * lag - 0.04 * lag * lag + (0.3 + 0.04 * lag) * t - 0.02 * t * t;
            let full: Vec<f64> = (0..30).map(|i| behind(f64::from(i))).collect();
            let at = |samples: f64, lag: f64| Shift::before_lag(samples, lag).at(&full, 12);
            // The delay is that of the lag and of the rest.
            let want = before(12.0 - samples - lag);
            assert!((at(samples, lag) - want).abs() < 1e-10);
            let h = 1e-5;
            let slope = (at(samples + h, lag) - at(samples - h, lag)) / (2.0 * h);
            assert!((Shift::slope(samples, lag).at(&full, 12) - slope).abs() < 1e-7);
            let lagged = |square: f64| at(samples, libm::sqrt(square));
            let square = lag * lag + 1.0;
            let bend = (lagged(square + h) - lagged(square - h)) / (2.0 * h);
            let found = Shift::bend(samples, libm::sqrt(square)).at(&full, 12);
            assert!((found - bend).abs() < 1e-7);
        }
    }

    /// Beyond an end and far from it, for all samples and for some.
    #[test]
    fn many_are_read_like_each() {
        let full: Vec<f64> = (0..40).map(|i| libm::sin(0.7 * f64::from(i))).collect();
        for samples in [-60.0, -3.2, -1.0, 0.0, 0.4, 2.0, 7.9, 60.0] {
            for shift in [Shift::earlier(samples), Shift::slope(samples, 0.3)] {
                for every in [1, 3, 7] {
                    let count = full.len().div_ceil(every);
                    for numbers in [0..count, 1..count, 2..count - 1, 3..3] {
                        let mut out = vec![5.0];
                        shift.append(&full, every, numbers.clone(), &mut out);
                        let each = numbers.map(|i| shift.at(&full, i * every));
                        assert!(out[1..].iter().copied().eq(each), "{samples} {every}");
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_an_end_the_end_value_goes_on() {
        let full = [2.0, 2.0, 2.0];
        for samples in [-40.0, -0.5, 0.0, 0.5, 40.0] {
            for at in 0..3 {
                assert!((Shift::earlier(samples).at(&full, at) - 2.0).abs() < 1e-13);
            }
        }
    }
}
