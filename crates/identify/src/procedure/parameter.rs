//! A value and its variance as a parameter with interval and flag.

use crate::parameter::{NORMAL_Q95, Parameter, too_uncertain};
use stiction_parameters::Name;
use stiction_policy::interval;

/// Two-sided 95 % quantile of Student's t for `free` degrees of freedom, by the expansion of
/// Abramowitz and Stegun, 26.7.5; within 1 % from 3 degrees on.
pub(super) fn quantile(free: f64) -> f64 {
    let z = NORMAL_Q95;
    let n = free.max(3.0);
    let z2 = z * z;
    let g1 = z * (z2 + 1.0) / 4.0;
    let g2 = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
    let g3 = z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
    z + g1 / n + g2 / (n * n) + g3 / (n * n * n)
}

/// What is known of one parameter.
pub(super) struct Found {
    pub name: Name,
    pub value: f64,
    pub variance: f64,
    /// Why it is not identifiable whatever its deviation; empty if nothing is known.
    pub reason: &'static str,
}

impl Found {
    /// The parameter; `level` is the Coulomb level, with which a parameter that may be zero is compared,
    /// `quantile` the half-width of the 95 % interval in standard deviations.
    pub fn parameter(self, level: f64, quantile: f64) -> Parameter {
        let mut reason = self.reason.to_string();
        // Positive by nature, so its interval is log-normal.
        let positive = self.name.quantity.allowed().is_never_negative();
        let known = self.variance.is_finite() && self.variance >= 0.0;
        let std = (known && reason.is_empty()).then(|| self.variance.sqrt());
        let size = if positive {
            self.value.abs()
        } else {
            self.value.abs().max(level)
        };
        if reason.is_empty() {
            match std.map(|s| s / size) {
                Some(r) if r <= interval::MAX_HALF_WIDTH => {}
                Some(r) if r < 1e3 => {
                    reason = too_uncertain(r, "its value");
                }
                _ => reason = "the data do not determine it".into(),
            }
        }
        let ci95 = std.and_then(|s| {
            let reach = quantile * s;
            if !positive {
                return reach
                    .is_finite()
                    .then_some((self.value - reach, self.value + reach));
            }
            let r = reach / self.value;
            (r.is_finite() && r <= 4.0)
                .then(|| (self.value * libm::exp(-r), self.value * libm::exp(r)))
        });
        Parameter {
            std: std.filter(|s| s.is_finite()),
            ci95,
            identifiable: reason.is_empty(),
            identified: true,
            reason,
            ..Parameter::given(self.name, self.value)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::quantile;

    /// Against the table of Student's t (Abramowitz and Stegun, table 26.10).
    #[test]
    fn quantile_of_student() {
        for (free, t) in [
            (3.0, 3.182),
            (5.0, 2.571),
            (10.0, 2.228),
            (30.0, 2.042),
            (120.0, 1.980),
        ] {
            assert!(
                (quantile(free) / t - 1.0).abs() < 0.01,
                "{free}: {}",
                quantile(free)
            );
        }
    }
}
