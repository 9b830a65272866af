//! The two exponentials of the law, for `f64`.
//!
//! Most of the time of a step goes into them, and their short code is inlined. They use only sums and products,
//! which every processor rounds alike, so the bits are the same everywhere; no table, and branches for the range only.

use core::f64::consts::LOG2_E;

/// Largest magnitude of an argument whose exponential is a normal number (with a margin; `ln` of the largest `f64` is 709.8).
const MAX_ARGUMENT: f64 = 708.0;

/// Largest magnitude of an argument that needs no reduction, below ln2/2 = 0.347: the power of two is then 1. The velocity of
/// an axis changes little from sample to sample, so the branch is predicted, and a third of the time of an exponential is
/// saved (decision 0033).
const MAX_UNREDUCED: f64 = 0.34;

/// Largest magnitude of an argument whose exponential is 1 plus the argument to rounding: 2^-54, a quarter of the spacing of
/// `f64` at 1.
const MAX_LINEAR: f64 = 1.0 / (1_u64 << 54) as f64;

/// Below this argument an exponential is 0 to rounding: less than half the smallest `f64`, whose `ln` is -744.4.
const MIN_ARGUMENT: f64 = -746.0;

/// Adding this to a number rounds it to an integer; the lowest bits of the sum are then that integer with the bias of
/// an exponent already on it.
const ROUNDING_SHIFT: f64 = 1.5 * (1_u64 << 52) as f64 + 1023.0;

/// ln 2 in two parts: the first has 33 bits, so that its product with an exponent is exact.
const LN2: [f64; 2] = [
    f64::from_bits(0x3fe6_2e42_fee0_0000),
    f64::from_bits(0x3dea_39ef_3579_3c76),
];

/// `(exp(r) - 1 - r)/r^2` on |r| <= ln2/2 to 2.4e-16 of its value: interpolation at the ten Chebyshev points,
/// computed with seventy digits (`crates/lanes/tests/exp/polynomial.py`); even and odd powers are stored separately.
const EVEN_COEFFICIENTS: [f64; 5] = [
    0.5000000000000001,
    0.041666666666624136,
    0.001388888891720967,
    2.4801521302241082e-05,
    2.7620085455018414e-07,
];
const ODD_COEFFICIENTS: [f64; 5] = [
    0.16666666666666669,
    0.008333333333330063,
    0.00019841269863050506,
    2.7557268464831627e-06,
    2.510038319586702e-08,
];

/// `exp(r) - 1` for |r| <= ln2/2.
#[inline(always)]
fn grown(r: f64) -> f64 {
    let r2 = r * r;
    let r4 = r2 * r2;
    let half = |c: &[f64; 5]| (c[0] + c[1] * r2) + r4 * ((c[2] + c[3] * r2) + c[4] * r4);
    r + r2 * (half(&EVEN_COEFFICIENTS) + r * half(&ODD_COEFFICIENTS))
}

/// A power of two and the remainder: `exp(x) = scale exp(r)` with |r| <= ln2/2, for |x| <= 708.
#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    let shifted = x * LOG2_E + ROUNDING_SHIFT;
    let n = shifted - ROUNDING_SHIFT;
    let r = (x - n * LN2[0]) - n * LN2[1];
    (f64::from_bits(shifted.to_bits() << 52), r)
}

/// `exp(x)`, within 2.3e-16 of its value.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    let size = x.abs();
    if size <= MAX_UNREDUCED {
        // A law at rest needs this in each sample.
        if size <= MAX_LINEAR {
            return 1.0 + x;
        }
        1.0 + grown(x)
    } else if size <= MAX_ARGUMENT {
        let (scale, r) = reduced(x);
        scale + scale * grown(r)
    } else if x < MIN_ARGUMENT {
        0.0
    } else {
        libm::exp(x)
    }
}

/// `exp(x) - 1`, within 2.3e-16 of its value.
#[inline(always)]
pub(crate) fn expm1(x: f64) -> f64 {
    let size = x.abs();
    if size <= MAX_UNREDUCED {
        grown(x)
    } else if size <= MAX_ARGUMENT {
        let (scale, r) = reduced(x);
        (scale - 1.0) + scale * grown(r)
    } else {
        libm::expm1(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Arguments of both signs, logarithmically spaced from 1e-17 to 800, and the ends of the range.
    fn arguments() -> impl Iterator<Item = f64> {
        let sizes = (0..1_000_000).map(|i| 800.0 * libm::exp(-f64::from(i) * 4.6e-5));
        sizes.chain([MAX_ARGUMENT, 708.1]).flat_map(|x| [x, -x])
    }

    fn worst(own: fn(f64) -> f64, right: fn(f64) -> f64) -> f64 {
        let error = |x| match (own(x), right(x)) {
            (a, b) if a == b => 0.0,
            (a, b) => (a / b - 1.0).abs(),
        };
        arguments().map(error).fold(0.0, f64::max)
    }

    /// libm's own error is below one unit in the last place.
    #[test]
    fn both_are_libms_to_rounding() {
        let found = [worst(exp, libm::exp), worst(expm1, libm::expm1)];
        assert!(found.iter().all(|&e| e <= 3.4e-16), "{found:?}");
    }

    #[test]
    fn special_values_are_exact() {
        assert_eq!((exp(0.0), exp(-0.0)), (1.0, 1.0));
        assert_eq!((expm1(0.0), expm1(f64::NEG_INFINITY)), (0.0, -1.0));
        assert_eq!(
            (exp(f64::NEG_INFINITY), exp(f64::INFINITY)),
            (0.0, f64::INFINITY)
        );
        assert!(exp(f64::NAN).is_nan() && expm1(f64::NAN).is_nan());
        assert_eq!((exp(-1e300), exp(1e300)), (0.0, f64::INFINITY));
    }

    /// The bounds of the law depend on this: a deflection never overshoots the steady value that it approaches.
    #[test]
    fn a_decay_stays_between_nothing_and_all() {
        for x in arguments().filter(|x| *x <= 0.0) {
            assert!((0.0..=1.0).contains(&exp(x)), "{x:e}");
            assert!((-1.0..=0.0).contains(&expm1(x)), "{x:e}");
        }
    }
}
