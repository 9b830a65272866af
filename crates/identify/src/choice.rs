//! Which of several laws the data support: held-out error within its noise, AIC and BIC beside it.

use crate::crossval::LawScore;
use crate::fit::MOST_LAGS;
use stiction_policy::choice;
use stiction_signal::effective_sample_size;

/// How a law compares with the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// `ln` of the held-out error (rms) over the least of all laws; 0 for the law that has it. `None`
    /// where the law has no held-out error.
    pub excess: Option<f64>,
    /// Standard error of that logarithm, correlation counted.
    pub excess_std: Option<f64>,
    /// AIC above the least of all laws, with the number of effective samples; `None` where it is undefined.
    pub aic: Option<f64>,
    /// BIC above the least of all laws.
    pub bic: Option<f64>,
    /// Whether this is the law to take: of those whose held-out error is within its noise (or 5 %)
    /// of the least, the one with the fewest parameters. A law without a held-out error, because too few
    /// samples would be left to fit it, is not taken beside others; where none has one, the law with the least BIC.
    pub best: bool,
    /// Whether its held-out error is within its noise (or 5 %) of the least.
    pub as_good: bool,
}

/// Compares laws that were fitted and scored on the same samples.
///
/// Whether one error is really above another is tested on the differences sample by sample, with their
/// own autocorrelation counted (Diebold and Mariano 1995, doi 10.1080/07350015.1995.10524599): both laws
/// meet the same noise, so their ratio is known much better than either error. The logarithm of the ratio
/// is tested, because squared errors that are dominated by a few reversals are far from normally
/// distributed.
///
/// AIC and BIC are `N ln(rms^2) + 2 k` and `N ln(rms^2) + k ln N` of the fit. `N` is the number of
/// effective samples of the residual of the closest fit. All laws use the same `N`; otherwise they could
/// not be compared.
pub fn choose(scores: &[LawScore]) -> Vec<Standing> {
    let error = |s: &LawScore| s.held_out.map(|f| f.rmse);
    let least = scores
        .iter()
        .enumerate()
        .filter_map(|(i, s)| Some((i, error(s)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(i, _)| i);
    let excess: Vec<Option<(f64, f64)>> = scores
        .iter()
        .map(|s| {
            let least = &scores[least?];
            error(s)?;
            excess(&s.residual, &least.residual)
        })
        .collect();
    let [aic, bic] = information(scores);
    let as_good: Vec<bool> = excess
        .iter()
        .map(|own| own.is_some_and(is_as_good))
        .collect();
    let best = if excess.iter().any(Option::is_some) {
        simplest(scores, &excess, &as_good)
    } else {
        bic.iter().position(|above| *above == Some(0.0))
    };
    (0..scores.len())
        .map(|i| Standing {
            excess: excess[i].map(|(ratio, _)| ratio).filter(|x| x.is_finite()),
            excess_std: excess[i].map(|(_, std)| std),
            aic: aic[i],
            bic: bic[i],
            best: best == Some(i),
            as_good: as_good[i],
        })
        .collect()
}

/// Whether an error above the least, as a logarithm with its standard error, is none.
fn is_as_good((ratio, std): (f64, f64)) -> bool {
    let [least, most] = [choice::MAX_SIMPLER_ERROR, choice::MAX_CERTAIN_ERROR].map(libm::log);
    ratio <= (choice::MAX_EQUAL_DEVIATIONS * std).clamp(least, most)
}

/// The law with the fewest parameters among those as good as the best.
fn simplest(scores: &[LawScore], excess: &[Option<(f64, f64)>], as_good: &[bool]) -> Option<usize> {
    let all = scores.iter().zip(excess).enumerate();
    let equal = all.filter(|(i, _)| as_good[*i]);
    equal
        .filter_map(|(i, (s, e))| Some((i, s.parameters, (*e)?.0)))
        .min_by(|a, b| a.1.cmp(&b.1).then(a.2.total_cmp(&b.2)))
        .map(|(i, ..)| i)
}

/// `ln(rms(a)/rms(b))` and its standard error: half the logarithm of the ratio of two means, whose
/// influence function is `a^2/mean(a^2) - b^2/mean(b^2)`.
fn excess(a: &[f64], b: &[f64]) -> Option<(f64, f64)> {
    let n = a.len().min(b.len());
    let mean_square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>() / n.max(1) as f64;
    let (size_a, size_b) = (mean_square(a), mean_square(b));
    if n < 2 || size_a == size_b {
        return (n >= 2).then_some((0.0, 0.0));
    }
    if size_b == 0.0 {
        // A law with a residual never equals a law that leaves no residual at all.
        return Some((f64::INFINITY, 0.0));
    }
    let influence: Vec<f64> = a
        .iter()
        .zip(b)
        .map(|(a, b)| a * a / size_a - b * b / size_b)
        .collect();
    let spread: f64 = influence.iter().map(|d| d * d).sum();
    let size = effective_sample_size(&influence, MOST_LAGS).map_or(n as f64, |e| e.size);
    let ratio = 0.5 * libm::log(size_a / size_b);
    let std = 0.5 * (spread / (n - 1) as f64 / size.max(1.0)).sqrt();
    (ratio.is_finite() && std.is_finite()).then_some((ratio, std))
}

/// AIC and BIC above the least of each.
fn information(scores: &[LawScore]) -> [Vec<Option<f64>>; 2] {
    let closest = scores
        .iter()
        .min_by(|a, b| a.fitted.rmse.total_cmp(&b.fitted.rmse));
    let size = closest.map_or(1.0, |s| s.fitted.effective_samples.max(1.0));
    let above = |penalty: f64| {
        let values: Vec<f64> = scores
            .iter()
            .map(|s| 2.0 * size * libm::log(s.fitted.rmse) + penalty * s.parameters as f64)
            .collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        values
            .into_iter()
            .map(|x| Some(x - least).filter(|d| d.is_finite()))
            .collect()
    };
    [above(2.0), above(libm::log(size))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Fit;
    use crate::law::{Law, LawKind};

    /// Standard normal by the sum of twelve uniform numbers.
    fn normal(seed: u64, i: usize) -> f64 {
        let mut x = (seed << 32 ^ i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        (0..12)
            .map(|_| {
                x ^= x << 13;
                x ^= x >> 7;
                x ^= x << 17;
                (x >> 11) as f64 / (1u64 << 53) as f64
            })
            .sum::<f64>()
            - 6.0
    }

    fn score(parameters: usize, residual: Vec<f64>) -> LawScore {
        let measured = vec![10.0; residual.len()];
        let fit = Fit::new(&measured, &residual).unwrap();
        LawScore {
            law: Law::new(LawKind::Dahl),
            parameters,
            fitted: fit,
            held_out: Some(fit),
            held_out_low_speed: None,
            residual,
        }
    }

    /// The standard error is that of the difference: its square is the variance over many draws.
    #[test]
    fn the_standard_error_is_that_of_repeated_draws() {
        let n = 400;
        let draws: Vec<(f64, f64)> = (0..400)
            .map(|seed| {
                let common: Vec<f64> = (0..n).map(|i| normal(2 * seed, i)).collect();
                let other = (0..n)
                    .map(|i| common[i] + 0.3 * normal(2 * seed + 1, i))
                    .collect();
                let standings = choose(&[score(5, other), score(4, common)]);
                // The other is 4.4 % worse by construction, and never by so little that it is least.
                (
                    standings[0].excess.unwrap(),
                    standings[0].excess_std.unwrap(),
                )
            })
            .collect();
        let mean = draws.iter().map(|d| d.0).sum::<f64>() / 400.0;
        let spread = draws.iter().map(|d| (d.0 - mean).powi(2)).sum::<f64>() / 399.0;
        let told = draws.iter().map(|d| d.1 * d.1).sum::<f64>() / 400.0;
        assert!((mean - 0.5 * 1.09_f64.ln()).abs() < 2e-3, "{mean}");
        assert!(
            (told / spread).sqrt() > 0.85 && (told / spread).sqrt() < 1.15,
            "{told} {spread}"
        );
    }

    #[test]
    fn the_simplest_within_the_noise_is_best() {
        let noise: Vec<f64> = (0..1000).map(|i| normal(1, i)).collect();
        let scaled = |factor: f64| noise.iter().map(|x| factor * x).collect::<Vec<f64>>();
        // Exactly proportional residuals have a difference without noise: only 5 % is left.
        let laws = [
            score(4, scaled(1.5)),
            score(6, scaled(1.04)),
            score(8, scaled(1.0)),
        ];
        let best = choose(&laws).iter().position(|s| s.best);
        assert_eq!(best, Some(1));
        assert_eq!(choose(&laws)[2].excess, Some(0.0));
    }

    #[test]
    fn without_held_out_errors_the_bayesian_criterion_decides() {
        let noise: Vec<f64> = (0..1000).map(|i| normal(1, i)).collect();
        let mut laws = [
            score(4, noise.iter().map(|x| 1.5 * x).collect()),
            score(6, noise.iter().map(|x| 1.001 * x).collect()),
            score(20, noise.clone()),
        ];
        laws[2].held_out = None;
        let standings = choose(&laws);
        assert!(standings[1].best && standings[1].bic == Some(0.0));
        assert_eq!(standings[2].excess, None);
        // 14 more parameters for a thousandth of the error.
        let bic = standings[2].bic.unwrap();
        let n = laws[2].fitted.effective_samples;
        assert!(
            (bic - (14.0 * n.ln() - 2.0 * n * 1.001_f64.ln())).abs() < 1e-6,
            "{bic}"
        );
    }

    #[test]
    fn a_law_that_leaves_nothing_and_no_laws_at_all() {
        let laws = [score(4, vec![1.0; 100]), score(6, vec![0.0; 100])];
        let standings = choose(&laws);
        assert!(standings[1].best && !standings[0].best);
        assert!(choose(&[]).is_empty());
        assert!(choose(&laws[1..])[0].best);
    }
}
