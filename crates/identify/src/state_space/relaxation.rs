//! The functions of an exponential approach.

use crate::exponential::exp;

/// Length below which the functions come from a series.
const SHORT: f64 = 0.5;

/// `p0 = exp(-a)`, `p1 = (1 - p0)/a`, `p2 = (1 - p1)/a`, with two derivatives by `a >= 0` of each.
///
/// With `p(k) = (1/(k-1)! - p(k-1))/a` all derivatives are sums of these functions without loss of digits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Relaxation {
    /// What is left of a deviation at the end.
    pub end: [f64; 3],
    /// What is left of it on average; and the share of a ramp that is followed at the end.
    pub mean: [f64; 3],
    /// The share of a ramp that is followed on average.
    pub ramp: [f64; 3],
}

impl Relaxation {
    #[inline(always)]
    pub fn of(a: f64) -> Self {
        let (p0, p1, p2, p3, p4);
        if a < SHORT {
            p4 = series(a);
            p3 = 1.0 / 6.0 - a * p4;
            p2 = 0.5 - a * p3;
            p1 = 1.0 - a * p2;
            p0 = 1.0 - a * p1;
        } else {
            let inverse = 1.0 / a;
            p0 = exp(-a);
            p1 = (1.0 - p0) * inverse;
            p2 = (1.0 - p1) * inverse;
            p3 = (0.5 - p2) * inverse;
            p4 = (1.0 / 6.0 - p3) * inverse;
        }
        Self {
            end: [p0, -p0, p0],
            mean: [p1, p2 - p1, p1 - 2.0 * p2 + 2.0 * p3],
            ramp: [p2, 2.0 * p3 - p2, p2 - 4.0 * p3 + 6.0 * p4],
        }
    }
}

/// The sum of `(-a)^j/(j+4)!`, to rounding below [`SHORT`].
#[inline(always)]
fn series(a: f64) -> f64 {
    const INVERSE_FACTORIALS: [f64; 12] = [
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
        1.0 / 6_227_020_800.0,
        1.0 / 87_178_291_200.0,
        1.0 / 1_307_674_368_000.0,
    ];
    let mut sum = INVERSE_FACTORIALS[11];
    for k in (0..11).rev() {
        sum = INVERSE_FACTORIALS[k] - a * sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `p1` against libm, the means and their derivatives against the integrals that they are:
    /// `p1 = int exp(-a s) ds`, `p2 = int (1 - s) exp(-a s) ds` over 0..1, by Gauss-Legendre in pieces.
    #[test]
    fn functions_are_their_integrals() {
        let nodes = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
        let weights = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];
        let integral = |f: &dyn Fn(f64) -> f64| {
            let pieces = 2000;
            let width = 1.0 / f64::from(pieces);
            let piece = |i: i32| -> f64 {
                let at = |x: f64| (f64::from(i) + 0.5 + 0.5 * x) * width;
                (0..3).map(|n| weights[n] * f(at(nodes[n]))).sum::<f64>() * width
            };
            (0..pieces).map(piece).sum::<f64>()
        };
        for a in [0.0, 1e-9, 1e-3, 0.2, 0.499, 0.501, 1.0, 7.0, 60.0] {
            let found = Relaxation::of(a);
            assert!((found.end[0] - libm::exp(-a)).abs() < 1e-14);
            for order in 0..3_usize {
                let power = |s: f64| (-s).powi(order as i32) * libm::exp(-a * s);
                let mean = integral(&power);
                let ramp = integral(&|s| (1.0 - s) * power(s));
                for (found, right) in [(found.mean[order], mean), (found.ramp[order], ramp)] {
                    let off = (found - right).abs();
                    assert!(off < 2e-13 * (1.0 + a), "{a} {order}: {found} {right}");
                }
            }
        }
    }
}
