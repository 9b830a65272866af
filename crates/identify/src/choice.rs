//! Which of several laws the data support: held-out error within its noise, AIC and BIC beside it.

use crate::crossval::LawScore;
use stiction_signal::effective_sample_size;

/// Lags that the noise of a difference looks at, at most.
const MOST_LAGS: usize = 2000;
/// A law counts as equal to the best while its held-out error is above the least by no more than this
/// many standard errors of the difference (the one-standard-error rule of Breiman, Friedman, Olshen
/// and Stone 1984, section 3.4.3).
const WITHIN: f64 = 1.0;
/// Or by no more than this factor. Less is of no use to anyone, however sure.
const EQUAL: f64 = 1.01;

/// How a law stands among others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// `ln` of the held-out error (rms) over the least of all laws; 0 for the law that has it. `None`
    /// where the law has no held-out error.
    pub excess: Option<f64>,
    /// Standard error of that logarithm, correlation counted.
    pub excess_std: Option<f64>,
    /// AIC above the least of all laws, on effective samples; `None` where no number.
    pub aic: Option<f64>,
    /// BIC above the least of all laws.
    pub bic: Option<f64>,
    /// Whether this is the law to take: of those whose held-out error is within its noise (or 1 %)
    /// of the least, the one with the fewest parameters. Where one of the laws has no held-out error,
    /// because too few samples would be left to fit it, the one with the least BIC.
    pub best: bool,
}

/// Compares laws that were fitted and scored on the same samples.
///
/// Whether one error is really above another is asked of the differences sample by sample, with their
/// own autocorrelation counted (Diebold and Mariano 1995, doi 10.1080/07350015.1995.10524599): both
/// laws meet the same noise, so their ratio is known much better than either error. The logarithm of
/// the ratio is tested, since squares that a few reversals dominate are far from normal.
///
/// AIC and BIC are `N ln(rms^2) + 2 k` and `N ln(rms^2) + k ln N` of the fit, with `N` the effective
/// samples that the residual of the closest fit is worth; one `N` for all laws, or they could not be
/// compared.
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
    let best = if excess.iter().all(Option::is_some) {
        simplest(scores, &excess)
    } else {
        bic.iter().position(|above| *above == Some(0.0))
    };
    (0..scores.len())
        .map(|i| Standing {
            excess: excess[i].map(|(ratio, _)| ratio),
            excess_std: excess[i].map(|(_, std)| std),
            aic: aic[i],
            bic: bic[i],
            best: best == Some(i),
        })
        .collect()
}

/// The law with the fewest parameters among those as good as the best.
fn simplest(scores: &[LawScore], excess: &[Option<(f64, f64)>]) -> Option<usize> {
    scores
        .iter()
        .zip(excess)
        .enumerate()
        .filter_map(|(i, (s, e))| {
            let (ratio, std) = (*e)?;
            (ratio <= (WITHIN * std).max(libm::log(EQUAL))).then_some((i, s.parameters, ratio))
        })
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
    let influence: Vec<f64> = a
        .iter()
        .zip(b)
        .map(|(a, b)| a * a / size_a - b * b / size_b)
        .collect();
    let spread: f64 = influence.iter().map(|d| d * d).sum();
    let size = effective_sample_size(&influence, MOST_LAGS).map_or(n as f64, |e| e.size);
    let ratio = 0.5 * libm::log(size_a / size_b);
    let std = 0.5 * (spread / (n - 1) as f64 / size.max(1.0)).sqrt();
    // A law that leaves nothing at all is matched by none that leaves something.
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
