//! Uniform time: log samples onto an even grid by straight lines, gaps remembered.

use stiction_policy::conditioning;

/// Uniform time over one stretch.
pub(crate) struct Grid<'a> {
    time: &'a [f64],
    start: f64,
    step: f64,
    /// `None` where the samples already stand on the grid; else the sample before each grid point.
    before: Option<Vec<usize>>,
    count: usize,
}

impl<'a> Grid<'a> {
    pub fn new(time: &'a [f64], step: f64) -> Option<Self> {
        let (start, end) = (*time.first()?, *time.last()?);
        if time.len() < 4 {
            return None;
        }
        let uniform = time
            .iter()
            .enumerate()
            .all(|(i, t)| (t - start - i as f64 * step).abs() <= 0.5 * step)
            && time
                .windows(2)
                .all(|t| ((t[1] - t[0]) / step - 1.0).abs() <= conditioning::MAX_STEP_SPREAD);
        if uniform {
            return Some(Self {
                time,
                start,
                step,
                before: None,
                count: time.len(),
            });
        }
        let count = ((end - start) / step * (1.0 + 1e-12)) as usize + 1;
        // Gaps are bridged up to a few samples each, so the grid cannot be much longer than the log.
        if count as f64 > (conditioning::MAX_BRIDGED_SAMPLES + 3.0) * time.len() as f64 {
            return None;
        }
        let mut before = Vec::with_capacity(count);
        let mut at = 0;
        for k in 0..count {
            let t = start + k as f64 * step;
            while at + 2 < time.len() && time[at + 1] <= t {
                at += 1;
            }
            before.push(at);
        }
        Some(Self {
            time,
            start,
            step,
            before: Some(before),
            count,
        })
    }

    pub fn len(&self) -> usize {
        self.count
    }

    pub fn times(&self) -> Vec<f64> {
        (0..self.count)
            .map(|k| self.start + k as f64 * self.step)
            .collect()
    }

    pub fn resample(&self, x: &[f64]) -> Vec<f64> {
        let Some(before) = &self.before else {
            return x.to_vec();
        };
        before
            .iter()
            .enumerate()
            .map(|(k, &i)| {
                let t = self.start + k as f64 * self.step;
                let w = ((t - self.time[i]) / (self.time[i + 1] - self.time[i])).clamp(0.0, 1.0);
                x[i] + w * (x[i + 1] - x[i])
            })
            .collect()
    }

    /// Which grid points stand between samples at rest; none where no sample is.
    pub fn at_rest(&self, at_rest: &[bool]) -> Vec<bool> {
        if !at_rest.contains(&true) {
            return Vec::new();
        }
        let still = |i: usize| at_rest.get(i).copied().unwrap_or(false);
        match &self.before {
            None => (0..self.count).map(still).collect(),
            Some(before) => before.iter().map(|&i| still(i) && still(i + 1)).collect(),
        }
    }

    /// Which grid points stand on valid samples with no gap around them.
    pub fn keep(&self, valid: &[bool]) -> Vec<bool> {
        let ok = |i: usize| valid.get(i).copied().unwrap_or(true);
        match &self.before {
            None => (0..self.count).map(ok).collect(),
            Some(before) => before
                .iter()
                .map(|&i| ok(i) && ok(i + 1) && self.time[i + 1] - self.time[i] < 1.75 * self.step)
                .collect(),
        }
    }
}
