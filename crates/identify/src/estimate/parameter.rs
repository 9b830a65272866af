//! One parameter with its deviation, its interval, and whether the data determine it.

use crate::law::physical::{Dimension, Physical};
use crate::separable::Optimum;
use stiction_number::{LARGEST_PERCENT, Percent};

/// Relative standard deviation above which a parameter counts as not determined by the data.
pub const IDENTIFIABLE: f64 = 0.10;
/// Two-sided 95 % quantile of the normal distribution.
pub(crate) const Q95: f64 = 1.959_963_984_540_054;

/// How a 95 % interval was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntervalKind {
    /// From the curvature of the cost at the optimum.
    Linear,
    /// From the cost along the parameter, all others fitted again at each of its values.
    Profile,
}

impl IntervalKind {
    /// Name as written to files.
    pub fn name(self) -> &'static str {
        match self {
            IntervalKind::Linear => "linear",
            IntervalKind::Profile => "profile",
        }
    }
}

/// Why a parameter is not determined, from its deviation relative to its size; `of` says what that size is.
pub(crate) fn too_uncertain(relative: f64, of: &str) -> String {
    let percent = Percent::deviation(100.0 * relative);
    if percent.is_bounded() {
        format!("standard deviation {} of {of}", percent.decimals(0))
    } else {
        format!("its standard deviation is not bounded (over {LARGEST_PERCENT} % of {of})")
    }
}

/// One parameter of the law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name in files, such as `sigma0` or `coulomb_pos`.
    pub name: String,
    /// What it measures.
    pub dimension: Dimension,
    /// Best value, SI.
    pub value: f64,
    /// Standard deviation with correlated residuals counted; `None` where the data say nothing.
    pub std: Option<f64>,
    /// What encoder steps, filters and derivatives are estimated to have added, SI; `None` where that
    /// was not estimated. It is taken off the value up to 10 %; beyond, the interval allows for it.
    pub bias: Option<f64>,
    /// 95 % interval; `None` where the data bound it on no side, an infinite end where they bound it
    /// on the other side only. A linear one is log-normal for parameters that are positive by nature.
    pub ci95: Option<(f64, f64)>,
    /// How the interval was found.
    pub interval: IntervalKind,
    /// Whether the data determine it: standard deviation at most 10 % and not at a bound.
    pub identifiable: bool,
    /// Whether it was fitted; a given parameter has no deviation.
    pub identified: bool,
    /// Why it is not identifiable; empty if it is.
    pub reason: String,
    /// Parameters that move together with one that is not identifiable, the closest first, with
    /// their correlation in -1..1.
    pub moves_with: Vec<(String, f64)>,
    /// What motion would determine a parameter that is not identifiable; empty if it is.
    pub advice: String,
}

impl Parameter {
    /// A parameter that was given, not fitted.
    pub fn given(name: &str, dimension: Dimension, value: f64) -> Self {
        Self {
            name: name.into(),
            dimension,
            value,
            std: None,
            bias: None,
            ci95: None,
            interval: IntervalKind::Linear,
            identifiable: true,
            identified: false,
            reason: String::new(),
            moves_with: Vec::new(),
            advice: String::new(),
        }
    }

    /// A fitted parameter with its linear interval. `bias` is what the conditioning adds to it;
    /// `level` the Coulomb level that a parameter is measured by which may be zero.
    pub(crate) fn fitted(
        p: &Physical,
        variance: f64,
        bias: Option<f64>,
        optimum: &Optimum,
        level: f64,
    ) -> Self {
        Self::judged(p, variance, bias, at_its_end(p, optimum), level)
    }

    /// The same with what already speaks against it in `reason`; `level` is what a parameter that may
    /// be zero is measured by: the Coulomb level, or the sample time for a delay.
    pub(crate) fn judged(
        p: &Physical,
        variance: f64,
        bias: Option<f64>,
        mut reason: String,
        level: f64,
    ) -> Self {
        let known = reason.is_empty() && variance.is_finite() && variance >= 0.0;
        let std = known.then(|| variance.sqrt());
        if reason.is_empty() && std.is_none() {
            reason = "its deviation is beyond the range of numbers".into();
        }
        let size = if p.positive {
            p.value.abs()
        } else {
            p.value.abs().max(level)
        };
        let (size, of) = match p.dimension {
            _ if p.positive => (size, "its value"),
            Dimension::Time => (level, "the sample time"),
            _ => (size, "its value or of the Coulomb level"),
        };
        let shift = bias.filter(|b| known && b.is_finite()).unwrap_or(0.0);
        let corrected = shift.abs() <= IDENTIFIABLE * size;
        let value = if !corrected || shift == 0.0 {
            p.value
        } else if p.share {
            let odds = shift / (p.value * (1.0 - p.value));
            share_at(p.value, -odds)
        } else if p.positive {
            p.value * libm::exp(-shift / p.value)
        } else {
            p.value - shift
        };
        let left = if corrected { 0.0 } else { shift };
        let reach = std.map(|s| s * quantile(left, s));
        if let Some(std) = std {
            let relative = std / size;
            if relative > IDENTIFIABLE || relative.is_nan() {
                reason = too_uncertain(relative, of);
            } else if !corrected {
                reason = format!(
                    "encoder steps and filters shift it by about {} of {of}",
                    Percent::error(100.0 * shift.abs() / size).decimals(0)
                );
            }
        }
        let ci95 = reach.and_then(|reach| {
            if p.share {
                // Normal in the logarithm of the odds, so that it stays between 0 and 1.
                let r = reach / (p.value * (1.0 - p.value));
                (r.is_finite() && r <= WIDEST).then(|| (share_at(value, -r), share_at(value, r)))
            } else if p.positive {
                // Wider than a factor of e^4 to each side, the data bound it on no side.
                let r = reach / p.value;
                (r.is_finite() && r <= WIDEST)
                    .then(|| (value * libm::exp(-r), value * libm::exp(r)))
            } else {
                Some((value - reach, value + reach))
            }
        });
        // A share near one may be off by little of its value, and its odds by anything.
        if ci95.is_none() && reason.is_empty() {
            reason = "the data bound it on no side".into();
        }
        Self {
            std,
            bias: bias.filter(|_| known),
            ci95,
            identifiable: reason.is_empty(),
            identified: true,
            reason,
            ..Self::given(&p.name, p.dimension, value)
        }
    }
}

/// A share whose odds are moved by a factor, in the logarithm.
fn share_at(share: f64, odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-odds) * (1.0 - share) / share)
}

/// Half-width in the logarithm beyond which an interval says nothing.
pub(crate) const WIDEST: f64 = 4.0;

/// Why a parameter is not free at the optimum; empty if it is.
fn at_its_end(p: &Physical, optimum: &Optimum) -> String {
    let solution = &optimum.evaluation.solution;
    if let Some(j) = p.linear {
        if solution.dependent[j] {
            return "cannot be told apart from the other terms on this motion".into();
        }
        if !solution.active[j] {
            return "held at zero: the data ask for a negative value".into();
        }
    }
    match p.nonlinear {
        Some(i) if optimum.bounds.at_bound(&optimum.p, i) => {
            "stands at the bound of its search range".into()
        }
        _ => String::new(),
    }
}

/// Half-width of a 95 % interval about an estimate with this bias and standard deviation, in
/// deviations: the 95 % quantile of |N(bias/std, 1)|, which is 1.96 without bias. An estimate that
/// keeps its bias needs an interval that reaches that far to hold the truth as often (Armstrong and
/// Kolesár 2018, doi 10.3982/ECTA14434).
pub(crate) fn quantile(bias: f64, std: f64) -> f64 {
    let t = (bias / std).abs();
    if !(t > 0.0 && t.is_finite()) {
        return Q95;
    }
    let inside = |c: f64| normal(c - t) - normal(-c - t);
    // Between 1.96 and 1.96 + t, whatever t.
    let (mut low, mut high) = (Q95, Q95 + t);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if inside(middle) < 0.95 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Distribution function of the standard normal.
fn normal(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tabulated quantiles of the folded normal (square roots of those of the noncentral chi-square
    /// with one degree of freedom, scipy 1.17 `ncx2.ppf(.95, 1, t*t)`).
    #[test]
    fn the_quantile_is_that_of_the_noncentral_chi_square() {
        for (t, chi) in [
            (0.5, 4.758_843_831_386_585),
            (1.0, 7.002_086_262_339_715),
            (3.0, 21.574_665_215_805_194),
        ] {
            let found = quantile(2.0 * t, 2.0);
            assert!((found * found / chi - 1.0).abs() < 1e-9, "{t}: {found}");
        }
        assert_eq!(quantile(0.0, 1.0), Q95);
        assert_eq!(quantile(1.0, 0.0), Q95);
    }
}
