//! Slopes of a sampled signal over any range, each in constant time.

/// Running sums of a signal and of its products with time.
pub(super) struct Moments {
    /// Sums of time, of time squared, of the signal, and of their product, up to each sample.
    sums: Vec<[f64; 4]>,
    middle: f64,
    level: f64,
}

impl Moments {
    /// Sums of `signal` over `time`, both of one length.
    pub fn new(time: &[f64], signal: &[f64]) -> Self {
        // Time is counted from the middle sample, so that its squares lose no digits.
        let at = time.len() / 2;
        let (middle, level) = (
            time.get(at).copied().unwrap_or(0.0),
            signal.get(at).copied().unwrap_or(0.0),
        );
        let mut now = [0.0; 4];
        let mut sums = Vec::with_capacity(time.len() + 1);
        sums.push(now);
        for (t, x) in time.iter().zip(signal) {
            let (t, x) = (t - middle, x - level);
            for (sum, term) in now.iter_mut().zip([t, t * t, x, t * x]) {
                *sum += term;
            }
            sums.push(now);
        }
        Self {
            sums,
            middle,
            level,
        }
    }

    /// Least-squares slope over samples `from..to`, per second; zero where it is not defined.
    pub fn slope(&self, from: usize, to: usize) -> f64 {
        let [t, tt, x, tx] = self.over(from, to);
        let n = (to - from) as f64;
        let spread = tt - t * t / n;
        if spread > 0.0 {
            (tx - t * x / n) / spread
        } else {
            0.0
        }
    }

    /// Mean of the signal over samples `from..to`.
    pub fn mean(&self, from: usize, to: usize) -> f64 {
        self.level + self.over(from, to)[2] / (to - from).max(1) as f64
    }

    /// Mean of the time over samples `from..to`.
    pub fn instant(&self, from: usize, to: usize) -> f64 {
        self.middle + self.over(from, to)[0] / (to - from).max(1) as f64
    }

    fn over(&self, from: usize, to: usize) -> [f64; 4] {
        let (a, b) = (&self.sums[from], &self.sums[to]);
        std::array::from_fn(|k| b[k] - a[k])
    }
}

#[cfg(test)]
mod tests {
    use super::Moments;

    #[test]
    fn a_line_has_its_slope_and_mean_over_every_range() {
        let time: Vec<f64> = (0..500).map(|i| 100.0 + 1e-3 * f64::from(i)).collect();
        let line: Vec<f64> = time.iter().map(|t| 7.0 - 0.3 * t).collect();
        let moments = Moments::new(&time, &line);
        for (from, to) in [(0, 500), (3, 7), (250, 400)] {
            assert!((moments.slope(from, to) + 0.3).abs() < 1e-9);
            let middle = 0.5 * (time[from] + time[to - 1]);
            assert!((moments.instant(from, to) - middle).abs() < 1e-9);
            assert!((moments.mean(from, to) - (7.0 - 0.3 * middle)).abs() < 1e-9);
        }
    }
}
