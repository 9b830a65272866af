//! The residual as an autoregression: a model of filtered white noise, for the correlation of the residual.
//!
//! The scores `J_t r_t` of a friction fit are short bursts around each reversal, so their own
//! correlation is known from few samples. The correlation of the residual is known from all of them:
//! where it does not depend on the motion, the covariance `B J^T G J B` with `G` that of the
//! autoregression is the sharper one (and the generalised Cramer-Rao bound of this estimator).

use crate::separable::linear::dot;
use nalgebra::DMatrix;

/// Longest memory that is looked for, samples. After the common filter the regression keeps 2.5
/// samples a period of the cut-off, so 20 reach over 8 of its periods.
const MOST_ORDER: usize = 20;

/// `sum_k a_k r_{t-k} = e_t` with `a_0 = 1`.
#[derive(Clone, Debug)]
pub(super) struct Autoregression {
    /// `a_1, a_2, ...`
    coefficients: Vec<f64>,
    /// Variance of `e`.
    variance: f64,
}

impl Autoregression {
    /// Yule-Walker, by the recursion of Levinson, of the order with the least information criterion
    /// of Akaike. `breaks` are the indices at which a new segment starts.
    ///
    /// The autocovariances are sums over the segments divided by the number of all samples, which
    /// makes every order stable.
    pub fn fit(residual: &[f64], breaks: &[usize]) -> Self {
        let n = residual.len();
        let most = MOST_ORDER.min(n / 20);
        let covariance: Vec<f64> = (0..=most)
            .map(|lag| {
                segments(n, breaks)
                    .filter(|s| s.len() > lag)
                    .map(|s| {
                        dot(
                            &residual[s.start + lag..s.end],
                            &residual[s.start..s.end - lag],
                        )
                    })
                    .sum::<f64>()
                    / n.max(1) as f64
            })
            .collect();
        let mut now = Self {
            coefficients: Vec::new(),
            variance: covariance[0],
        };
        let mut best = now.clone();
        let mut least = 0.0;
        for order in 1..=most {
            let reach: f64 = covariance[order]
                + now
                    .coefficients
                    .iter()
                    .zip(covariance[1..order].iter().rev())
                    .map(|(a, c)| a * c)
                    .sum::<f64>();
            let reflection = -reach / now.variance;
            let left = now.variance * (1.0 - reflection * reflection);
            if !(left > 0.0 && left.is_finite()) {
                break;
            }
            let mirrored: Vec<f64> = now.coefficients.iter().rev().copied().collect();
            for (a, m) in now.coefficients.iter_mut().zip(mirrored) {
                *a += reflection * m;
            }
            now.coefficients.push(reflection);
            now.variance = left;
            let criterion = n as f64 * libm::log(left / covariance[0]) + 2.0 * order as f64;
            if criterion < least {
                least = criterion;
                best = now.clone();
            }
        }
        best
    }

    /// Covariance of the sums `sum w_t r_t` of columns `w`: the products of `L^T w`, where `L L^T` is the covariance
    /// of the residual.
    ///
    /// The columns are taken side by side, from the last sample on, a chunk at a time.
    pub fn covariance(&self, columns: &[Vec<f64>], breaks: &[usize]) -> DMatrix<f64> {
        let q = columns.len();
        let n = columns.first().map_or(0, Vec::len);
        let order = self.coefficients.len();
        let mut sums = vec![0.0; q * q];
        // `L^T w` of a chunk and of the samples after it that it reaches to, sample by sample.
        let mut rows = vec![0.0; (CHUNK + order) * q];
        for s in segments(n, breaks) {
            rows.fill(0.0);
            let mut end = s.end;
            while end > s.start {
                let start = s.start.max(end.saturating_sub(CHUNK));
                let many = end - start;
                for (k, column) in columns.iter().enumerate() {
                    let to = rows[k..].iter_mut().step_by(q);
                    to.zip(&column[start..end]).for_each(|(to, x)| *to = *x);
                }
                for t in (0..many).rev() {
                    let (now, after) = rows[t * q..].split_at_mut(q);
                    // The latest sample first, so that only one product has to wait for the values just
                    // computed (shorter dependency chain).
                    let reach = self.coefficients.iter().zip(after.chunks_exact(q));
                    for (a, later) in reach.rev() {
                        for (x, later) in now.iter_mut().zip(later) {
                            *x -= a * later;
                        }
                    }
                }
                for row in rows[..many * q].chunks_exact(q) {
                    for (i, x) in row.iter().enumerate() {
                        for (sum, y) in sums[i * q..].iter_mut().zip(&row[..=i]) {
                            *sum += x * y;
                        }
                    }
                }
                // The next chunk is written in front of the samples that it depends on.
                let next = CHUNK.min(start - s.start);
                rows.copy_within(..many.min(order) * q, next * q);
                if many < order {
                    rows[(next + many) * q..(next + order) * q].fill(0.0);
                }
                end = start;
            }
        }
        let variance = self.variance.max(0.0);
        DMatrix::from_fn(q, q, |i, j| variance * sums[i.max(j) * q + i.min(j)])
    }
}

/// Samples of all columns that stay in the fastest CPU caches.
const CHUNK: usize = 256;

/// Ranges between breaks.
pub(super) fn segments(n: usize, breaks: &[usize]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let starts = std::iter::once(0).chain(breaks.iter().copied());
    let ends = breaks.iter().copied().chain(std::iter::once(n));
    starts.zip(ends).map(move |(a, b)| a.min(n)..b.min(n))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A second-order process with known coefficients, from a linear congruential sum of uniforms.
    fn process(n: usize) -> Vec<f64> {
        let mut state = 12345_u64;
        let mut white = || {
            (0..12)
                .map(|_| {
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    (state >> 11) as f64 / (1_u64 << 53) as f64
                })
                .sum::<f64>()
                - 6.0
        };
        let mut out = vec![0.0; n];
        for t in 2..n {
            out[t] = 1.2 * out[t - 1] - 0.5 * out[t - 2] + white();
        }
        out
    }

    #[test]
    fn known_coefficients_are_found() {
        let found = Autoregression::fit(&process(60_000), &[]);
        assert!(found.coefficients.len() >= 2);
        assert!((found.coefficients[0] + 1.2).abs() < 0.03, "{found:?}");
        assert!((found.coefficients[1] - 0.5).abs() < 0.03, "{found:?}");
        assert!((found.variance - 1.0).abs() < 0.03, "{found:?}");
    }

    /// The variance of a mean against the spectral density at zero, `variance/(1 - 1.2 + .5)^2`.
    #[test]
    fn the_variance_of_a_sum_is_the_spectral_density_at_zero() {
        let found = Autoregression::fit(&process(60_000), &[]);
        let energy =
            |ones: usize, breaks: &[usize]| found.covariance(&[vec![1.0; ones]], breaks)[(0, 0)];
        let per_sample = energy(20_000, &[]) / 20_000.0;
        assert!((per_sample * 0.3 * 0.3 - 1.0).abs() < 0.1, "{per_sample}");
        // Two uncorrelated halves have the sum of their variances.
        let halves = energy(20_000, &[10_000]);
        assert!((halves / (2.0 * energy(10_000, &[])) - 1.0).abs() < 1e-12);
        // The result does not depend on where chunks are cut: three samples more than one chunk, with two
        // columns.
        let pair = [vec![1.0; 259], vec![2.0; 259]];
        let both = found.covariance(&pair, &[2]);
        let one = energy(2, &[]) + energy(257, &[]);
        assert!((both[(0, 0)] / one - 1.0).abs() < 1e-12);
        assert!((both[(1, 0)] / (2.0 * one) - 1.0).abs() < 1e-12);
    }

    /// `w L L^T w` written out for a first-order process, whose covariance is known in closed form.
    #[test]
    fn the_covariance_of_a_first_order_process_is_its_closed_form() {
        let (a, n) = (-0.6_f64, 700);
        let process = Autoregression {
            coefficients: vec![a],
            variance: 2.0,
        };
        let w: Vec<f64> = (0..n).map(|t| libm::sin(0.37 * t as f64)).collect();
        // L is the inverse of the whitening from rest: r_t = sum_k (-a)^k e_{t-k}.
        let mut closed = 0.0;
        for from in 0..n {
            let reach: f64 = (from..n).map(|t| (-a).powi((t - from) as i32) * w[t]).sum();
            closed += 2.0 * reach * reach;
        }
        let found = process.covariance(&[w], &[])[(0, 0)];
        assert!((found / closed - 1.0).abs() < 1e-12, "{found} {closed}");
    }

    #[test]
    fn a_residual_without_energy_gives_nothing() {
        let found = Autoregression::fit(&[0.0; 500], &[]);
        assert_eq!(found.covariance(&[vec![1.0; 500]], &[])[(0, 0)], 0.0);
        assert!(Autoregression::fit(&[], &[]).coefficients.is_empty());
    }
}
