//! Quantiles of Student's t.

use crate::parameter::NORMAL_Q95;

/// Fewest degrees of freedom that the expansion is good for.
const FEWEST: f64 = 3.0;
/// Two-sided 95 % quantiles with one degree of freedom, `tan(0.475 pi)`, and with two, `0.95 (2 / (1 - 0.95^2))^(1/2)`.
const FEW: [f64; 2] = [12.706_204_736_174_7, 4.302_652_729_749_46];

/// Two-sided 95 % quantile of a whole number of degrees of freedom, at least one.
pub(crate) fn whole(freedom: usize) -> f64 {
    let few = FEW.get(freedom.saturating_sub(1));
    few.copied().unwrap_or_else(|| quantile(freedom as f64))
}

/// Two-sided 95 % quantile, by the expansion of Cornish and Fisher in the degrees of freedom (Abramowitz and Stegun 1964,
/// 26.7.5); with fewer than three, that of three.
pub(crate) fn quantile(freedom: f64) -> f64 {
    let n = freedom.max(FEWEST);
    let x = NORMAL_Q95;
    let [x3, x5, x7, x9] = [3, 5, 7, 9].map(|k| x.powi(k));
    let terms = [
        (x3 + x) / 4.0,
        (5.0 * x5 + 16.0 * x3 + 3.0 * x) / 96.0,
        (3.0 * x7 + 19.0 * x5 + 17.0 * x3 - 15.0 * x) / 384.0,
        (79.0 * x9 + 776.0 * x7 + 1482.0 * x5 - 1920.0 * x3 - 945.0 * x) / 92_160.0,
    ];
    terms.iter().rev().fold(0.0, |sum, term| (sum + term) / n) + x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tabulated quantiles.
    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, wanted, within) in [
            (3.0, 3.182_446, 0.02),
            (5.0, 2.570_582, 2e-3),
            (10.0, 2.228_139, 1e-4),
            (19.0, 2.093_024, 1e-5),
            (1e9, NORMAL_Q95, 1e-8),
        ] {
            assert!(
                (quantile(freedom) - wanted).abs() < within,
                "{freedom}: {}",
                quantile(freedom)
            );
        }
        assert_eq!(quantile(f64::NAN), quantile(3.0));
    }

    /// With one degree the distribution of Cauchy, with two `F(t) = 1/2 + t / (2 (2 + t^2)^(1/2))`.
    #[test]
    fn quantiles_of_few_are_those_of_their_distributions() {
        let one = libm::atan(whole(1)) / std::f64::consts::PI;
        assert!((one - 0.475).abs() < 1e-15, "{one}");
        let two = whole(2) / (2.0 * (2.0 + whole(2).powi(2)).sqrt());
        assert!((two - 0.475).abs() < 1e-14, "{two}");
        assert_eq!(whole(3), quantile(3.0));
    }
}
