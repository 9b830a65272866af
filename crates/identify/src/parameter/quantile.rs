//! Quantiles of normal errors with a bias.

/// Two-sided 95 % quantile of the normal distribution.
pub const NORMAL_Q95: f64 = 1.959_963_984_540_054;

/// Half-width of a 95 % interval about an estimate with this bias and standard deviation, in
/// deviations: the 95 % quantile of |N(bias/std, 1)|, which is 1.96 without bias. An estimate that
/// keeps its bias needs an interval that reaches that far to hold the truth as often (Armstrong and
/// Kolesár 2018, doi 10.3982/ECTA14434).
pub(crate) fn quantile(bias: f64, std: f64) -> f64 {
    let t = (bias / std).abs();
    if !(t > 0.0 && t.is_finite()) {
        return NORMAL_Q95;
    }
    let inside = |c: f64| normal(c - t) - normal(-c - t);
    // Between 1.96 and 1.96 + t, whatever t.
    let (mut low, mut high) = (NORMAL_Q95, NORMAL_Q95 + t);
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
        assert_eq!(quantile(0.0, 1.0), NORMAL_Q95);
        assert_eq!(quantile(1.0, 0.0), NORMAL_Q95);
    }
}
