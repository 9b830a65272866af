//! The residual as an autoregression: what white noise, filtered, repeats itself the same way.
//!
//! The scores `J_t r_t` of a friction fit are short bursts around each reversal, so their own
//! correlation is known from few samples. The correlation of the residual is known from all of them:
//! where it does not depend on the motion, the covariance `B J^T G J B` with `G` that of the
//! autoregression is the sharper one (and the generalised Cramer-Rao bound of this estimator).

use crate::separable::linear::dot;

/// Longest memory that is looked for, samples. After the common filter the regression keeps 2.5
/// samples a period of the cut-off, so 20 reach over 8 of its periods.
const MOST: usize = 20;

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
        let most = MOST.min(n / 20);
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

    /// `L^T w` for a column `w`, where `L L^T` is the covariance of the residual: its energy is the
    /// variance of `sum w_t r_t`.
    pub fn transposed(&self, w: &[f64], breaks: &[usize]) -> Vec<f64> {
        let mut out = w.to_vec();
        for s in segments(w.len(), breaks) {
            for t in s.clone().rev() {
                let (now, after) = out[t..s.end].split_at_mut(1);
                // The latest first, so that no more than one product waits for the value just made.
                let reach = self.coefficients.iter().zip(after.iter()).rev();
                now[0] = reach.fold(now[0], |x, (a, later)| x - a * later);
            }
        }
        let deviation = self.variance.max(0.0).sqrt();
        out.iter_mut().for_each(|x| *x *= deviation);
        out
    }
}

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
        let ones = vec![1.0; 20_000];
        let sum = found.transposed(&ones, &[]);
        let per_sample = dot(&sum, &sum) / 20_000.0;
        assert!((per_sample * 0.3 * 0.3 - 1.0).abs() < 0.1, "{per_sample}");
        // Two halves that know nothing of each other have the sum of their variances.
        let halves = found.transposed(&ones, &[10_000]);
        let one = found.transposed(&ones[..10_000], &[]);
        assert!((dot(&halves, &halves) / (2.0 * dot(&one, &one)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_residual_without_energy_gives_nothing() {
        let found = Autoregression::fit(&[0.0; 500], &[]);
        assert_eq!(dot(&found.transposed(&[1.0; 500], &[]), &[1.0; 500]), 0.0);
        assert!(Autoregression::fit(&[], &[]).coefficients.is_empty());
    }
}
