//! What a residual has after reversals beyond what it has elsewhere.

use super::parts::Measures;

/// Way after a reversal, in Fc/sigma0, after which a bristle has turned round but for 4 %.
const TURNED: f64 = 4.0;

/// Where a bristle turns round.
pub(super) struct Reversals {
    after: Vec<bool>,
    /// How often it does.
    count: usize,
}

impl Reversals {
    /// For a bristle of the length Fc/sigma0, m or rad.
    pub fn of(measures: &Measures, length: f64) -> Self {
        let after = measures.after_reversals(TURNED * length);
        let begins = after.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        Self {
            count: begins + usize::from(after.first() == Some(&true)),
            after,
        }
    }

    /// Mean square over all samples of what a residual has after reversals beyond what it has elsewhere, negative where that
    /// is less, and its standard deviation where both are noise that remembers for as long as the bristle turns.
    pub fn excess(&self, residual: &[f64]) -> (f64, f64) {
        let square = |after: bool| {
            let own = residual.iter().zip(&self.after);
            let (sum, count) = own
                .filter(|(_, is_after)| **is_after == after)
                .fold((0.0, 0.0), |(sum, count), (r, _)| {
                    (sum + r * r, count + 1.0)
                });
            (sum / count, count)
        };
        let ((after, samples), (elsewhere, others)) = (square(true), square(false));
        if samples == 0.0 || others == 0.0 {
            return (0.0, 0.0);
        }
        let share = samples / (samples + others);
        let chance = (2.0 / self.count.max(1) as f64).sqrt() * elsewhere;
        (share * (after - elsewhere), share * chance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten reversals, at each of which a tenth of the samples follows.
    fn reversals() -> Reversals {
        Reversals {
            after: (0..10_000).map(|i| i % 1000 < 100).collect(),
            count: 10,
        }
    }

    #[test]
    fn noise_that_is_the_same_everywhere_has_no_excess() {
        let noise: Vec<f64> = (0..10_000).map(|i| libm::sin(f64::from(i * i))).collect();
        let (excess, chance) = reversals().excess(&noise);
        assert!(excess.abs() < chance, "{excess} {chance}");
    }

    #[test]
    fn twice_as_much_after_reversals_is_three_tenths_more() {
        let square = |i: i32| if i % 2 == 0 { 1.0 } else { -1.0 };
        let scale = |i: i32| if i % 1000 < 100 { 2.0 } else { 1.0 };
        let residual: Vec<f64> = (0..10_000).map(|i| scale(i) * square(i)).collect();
        let (excess, chance) = reversals().excess(&residual);
        assert!((excess - 0.3).abs() < 1e-12, "{excess}");
        assert!((chance - 0.1 * (0.2_f64).sqrt()).abs() < 1e-12, "{chance}");
    }
}
