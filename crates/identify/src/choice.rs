//! Which of several laws the data support: held-out error within its noise, AIC and BIC beside it.

use crate::crossval::LawScore;
use stiction_signal::effective_sample_size;

/// Lags that the noise of a difference looks at, at most.
const MOST_LAGS: usize = 2000;
/// A law counts as equal to the best while its mean squared held-out residual is above the least by
/// no more than this many standard errors of the difference: the one-sided 95 % point.
const WITHIN: f64 = 1.645;
/// Or by no more than this part: 1 % of the held-out error. Less is of no use to anyone, however sure.
const EQUAL: f64 = 1.01 * 1.01 - 1.0;

/// How a law stands among others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Mean squared held-out residual above the least of all laws, as a part of that least one; 0 for
    /// the law that has it. `None` where the law has no held-out error.
    pub excess: Option<f64>,
    /// Standard error of that difference, sample by sample, correlation counted.
    pub excess_std: Option<f64>,
    /// AIC above the least of all laws, on effective samples; `None` where no number.
    pub aic: Option<f64>,
    /// BIC above the least of all laws.
    pub bic: Option<f64>,
    /// Whether this is the law to take: of those whose held-out error is within its noise (or 1 %)
    /// of the least, the one with the fewest parameters.
    pub best: bool,
}

/// Compares laws that were fitted and scored on the same samples.
///
/// The difference of the squared held-out residuals of two laws, sample by sample, is tested with its
/// own autocorrelation counted (Diebold and Mariano 1995, doi 10.1080/07350015.1995.10524599): both
/// laws meet the same noise, so their difference is known much better than either error.
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
    let best = scores
        .iter()
        .zip(&excess)
        .enumerate()
        .filter_map(|(i, (s, e))| {
            let (mean, std) = (*e)?;
            (mean <= (WITHIN * std).max(EQUAL)).then_some((i, s.parameters, mean))
        })
        .min_by(|a, b| a.1.cmp(&b.1).then(a.2.total_cmp(&b.2)))
        .map(|(i, ..)| i);
    let [aic, bic] = information(scores);
    (0..scores.len())
        .map(|i| Standing {
            excess: excess[i].map(|(mean, _)| mean),
            excess_std: excess[i].map(|(_, std)| std),
            aic: aic[i],
            bic: bic[i],
            best: best == Some(i),
        })
        .collect()
}

/// Mean difference of the squares and its standard error, as parts of the mean square of `least`.
fn excess(residual: &[f64], least: &[f64]) -> Option<(f64, f64)> {
    let n = residual.len().min(least.len());
    let difference: Vec<f64> = residual
        .iter()
        .zip(least)
        .map(|(a, b)| a * a - b * b)
        .collect();
    let unit = least.iter().map(|b| b * b).sum::<f64>() / n.max(1) as f64;
    let mean = difference.iter().sum::<f64>() / n.max(1) as f64;
    if n < 2 || !mean.is_finite() {
        return None;
    }
    if mean == 0.0 {
        return Some((0.0, 0.0));
    }
    let spread: f64 = difference.iter().map(|d| (d - mean) * (d - mean)).sum();
    let size = effective_sample_size(&difference, MOST_LAGS).map_or(n as f64, |e| e.size);
    let std = (spread / (n - 1) as f64 / size.max(1.0)).sqrt();
    // A law that leaves nothing is not matched by one that leaves something.
    (unit > 0.0)
        .then_some((mean / unit, std / unit))
        .filter(|(a, b)| a.is_finite() && b.is_finite())
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
