//! Exponentials without branches, for loops that the compiler turns into vector instructions.
//!
//! Everything is written with [`f64::mul_add`], whose result is the correctly rounded one on every
//! target, so the bits do not depend on whether the processor has the instruction.

/// Arguments of exponentials are limited to this from below: nothing that is added to a number near
/// one is smaller than `exp(-700)`, and arithmetic with subnormal numbers is slow.
pub(crate) const LOWEST_ARGUMENT: f64 = -700.0;

/// Adding this to a number rounds it to an integer; the lowest bits of the sum are then that integer
/// with the bias of an exponent already on it.
const ROUND_TO_INTEGER: f64 = 1.5 * (1_u64 << 52) as f64 + 1023.0;

/// `(exp(r) - 1 - r)/r^2` on |r| <= ln2/2 to 2.4e-16 of its value: interpolation at the ten Chebyshev
/// points, computed with seventy digits (`tests/exp/polynomial.py`); even and odd powers are stored
/// separately.
const EVEN: [f64; 5] = [
    0.5000000000000001,
    0.041666666666624136,
    0.001388888891720967,
    2.4801521302241082e-05,
    2.7620085455018414e-07,
];
const ODD: [f64; 5] = [
    0.16666666666666669,
    0.008333333333330063,
    0.00019841269863050506,
    2.7557268464831627e-06,
    2.510038319586702e-08,
];

/// `a b + c`, rounded once.
#[inline(always)]
pub(crate) fn fma(a: f64, b: f64, c: f64) -> f64 {
    a.mul_add(b, c)
}

/// The larger; the second where the first is NaN.
#[inline(always)]
pub(crate) fn at_least(x: f64, low: f64) -> f64 {
    if x > low { x } else { low }
}

/// The smaller; the second where the first is NaN.
#[inline(always)]
pub(crate) fn at_most(x: f64, high: f64) -> f64 {
    if x < high { x } else { high }
}

/// The argument of an exponential, its power of two taken off: `exp(x) = scale exp(r)`, |r| <= ln2/2.
#[derive(Clone, Copy)]
struct Reduced {
    scale: f64,
    r: f64,
    square: f64,
}

impl Reduced {
    /// For `x` in -700..=700.
    #[inline(always)]
    fn of(x: f64) -> Self {
        let shifted = fma(x, std::f64::consts::LOG2_E, ROUND_TO_INTEGER);
        let n = shifted - ROUND_TO_INTEGER;
        // The rounding of ln2 shifts the exponent by 2.3e-17 n, which matters only for results far below one.
        let r = fma(n, -std::f64::consts::LN_2, x);
        Reduced {
            scale: f64::from_bits(shifted.to_bits() << 52),
            r,
            square: r * r,
        }
    }

    /// `(exp(r) - 1 - r)/r^2`.
    #[inline(always)]
    fn quotient(&self) -> f64 {
        let square = self.square;
        let half = |c: &[f64; 5]| {
            fma(
                fma(fma(fma(c[4], square, c[3]), square, c[2]), square, c[1]),
                square,
                c[0],
            )
        };
        fma(half(&ODD), self.r, half(&EVEN))
    }

    /// `exp(x)` for that quotient.
    #[inline(always)]
    fn exp(&self, quotient: f64) -> f64 {
        fma(self.scale, fma(self.square, quotient, self.r), self.scale)
    }
}

/// An exponential taken apart: `exp(x) = scale (1 + r + r^2 q)`.
#[derive(Clone, Copy)]
struct Parts {
    reduced: Reduced,
    q: f64,
}

impl Parts {
    /// For `x` in -700..=700.
    #[inline(always)]
    fn of(x: f64) -> Self {
        let reduced = Reduced::of(x);
        Self {
            reduced,
            q: reduced.quotient(),
        }
    }

    /// `exp(x)`.
    #[inline(always)]
    fn exp(&self) -> f64 {
        self.reduced.exp(self.q)
    }

    /// `(exp(x) - 1)/x` where |x| is below ln2/2.
    #[inline(always)]
    fn mean(&self) -> f64 {
        fma(self.reduced.r, self.q, 1.0)
    }

    /// Derivative of the mean with respect to `-x`, likewise.
    #[inline(always)]
    fn mean_slope(&self) -> f64 {
        fma(self.q, 1.0 - self.reduced.r, -1.0)
    }
}

/// `exp(x)` for `x` in -700..=700; below, `exp(-700)`.
///
/// At most `2 + 0.31 |x|` units in the last place from libm's, which for `x <= 0` is nowhere more than
/// 1.2e-16 in all.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    Parts::of(at_least(x, LOWEST_ARGUMENT)).exp()
}

/// [`exp`] of several numbers, step by step side by side: as written one after the other, the chain of operations
/// of each would wait for that of the one before.
#[inline(always)]
pub(crate) fn exps<const K: usize>(x: [f64; K]) -> [f64; K] {
    let mut reduced = [Reduced {
        scale: 0.0,
        r: 0.0,
        square: 0.0,
    }; K];
    for k in 0..K {
        reduced[k] = Reduced::of(at_least(x[k], LOWEST_ARGUMENT));
    }
    let mut q = [0.0; K];
    for k in 0..K {
        q[k] = reduced[k].quotient();
    }
    let mut out = [0.0; K];
    for k in 0..K {
        out[k] = reduced[k].exp(q[k]);
    }
    out
}

/// `expm1(x)` for `x` in -700..=0; relative error below 1e-15.
#[inline(always)]
pub(crate) fn expm1(x: f64) -> f64 {
    let Parts { reduced, q } = Parts::of(x);
    let grown = fma(reduced.square, q, reduced.r);
    fma(reduced.scale, grown, reduced.scale - 1.0)
}

/// Effect of an interval of length `a` (dimensionless) on a deviation.
#[derive(Clone, Copy)]
pub(crate) struct Decay {
    /// `exp(-a)`.
    pub keep: f64,
    /// `(1 - exp(-a))/a`.
    pub mean: f64,
    /// Derivative of the mean with respect to `a`.
    pub slope: f64,
}

/// The decays of two intervals with one division.
///
/// The arguments are `-a`, in -1e150..=0. Below a = .34 the mean comes from the polynomial, above from the
/// division, so that neither loses digits: relative error of the mean below 1.5e-15, of its slope
/// below 5e-15, of the exponential as for [`exp`].
#[inline(always)]
pub(crate) fn decays(x: [f64; 2]) -> [Decay; 2] {
    let part = |x: f64| Parts::of(at_least(x, LOWEST_ARGUMENT));
    let parts = [part(x[0]), part(x[1])];
    let far = [
        at_most(x[0], POLYNOMIAL_ALONE),
        at_most(x[1], POLYNOMIAL_ALONE),
    ];
    let inverse = 1.0 / (far[0] * far[1]);
    let decay = |i: usize| {
        let keep = parts[i].exp();
        let divided = far[1 - i] * inverse;
        let (mean, slope) = if far[i] == x[i] {
            let mean = (keep - 1.0) * divided;
            (mean, (mean - keep) * divided)
        } else {
            (parts[i].mean(), parts[i].mean_slope())
        };
        Decay { keep, mean, slope }
    };
    [decay(0), decay(1)]
}

/// For arguments above this the polynomial needs no power of two.
pub(crate) const POLYNOMIAL_ALONE: f64 = -0.34;
/// Lower limit of the arguments of decays: the product of two of them does not overflow.
pub(crate) const LONGEST_DECAY: f64 = -1e150;

#[cfg(test)]
mod tests {
    use super::*;

    /// Arguments from 0 to -700, logarithmically spaced.
    fn arguments() -> impl Iterator<Item = f64> {
        (0..2_000_000).map(|i| -700.0 * libm::exp(-f64::from(i) * 2e-5))
    }

    /// Distance in units in the last place of the second.
    fn ulps(found: f64, right: f64) -> f64 {
        let unit = f64::from_bits(right.abs().to_bits() + 1) - right.abs();
        (found - right).abs() / unit
    }

    /// libm's own error is below one unit.
    #[test]
    fn exp_is_libms_within_the_documented_error() {
        let (mut relative, mut absolute) = (0.0_f64, 0.0_f64);
        for x in arguments() {
            for x in [x, -x] {
                let error = ulps(exp(x), libm::exp(x));
                relative = relative.max(error / (2.0 + 0.31 * x.abs()));
            }
            absolute = absolute.max((exp(x) - libm::exp(x)).abs());
        }
        assert!(relative <= 1.0, "{relative} of what is documented");
        assert!(absolute <= 1.2e-16, "{absolute:e}");
        assert_eq!((exp(0.0), exp(-0.0)), (1.0, 1.0));
        assert_eq!(exp(f64::NEG_INFINITY), exp(-700.0));
    }

    #[test]
    fn expm1_is_libms() {
        let error = |x: f64| (expm1(x) / libm::expm1(x) - 1.0).abs();
        let worst = arguments().map(error).fold(0.0, f64::max);
        assert!(worst < 1e-15, "{worst:e}");
        assert_eq!(expm1(0.0), 0.0);
    }

    /// The mean against libm's expm1.
    #[test]
    fn a_decay_keeps_its_digits_at_every_length() {
        let (mut worst, mut worst_slope) = (0.0_f64, 0.0_f64);
        for x in arguments() {
            let other = -0.01 - x / 3.0 % 5.0;
            for (pair, i) in [([x, other], 0), ([other, x], 1)] {
                let Decay { keep, mean, slope } = decays(pair)[i];
                assert_eq!(keep, exp(x));
                worst = worst.max((mean / (libm::expm1(x) / x) - 1.0).abs());
                // Exact to rounding for long intervals; the sum of its series for short ones.
                let right = if x < -1.0 {
                    -(keep - mean) / x
                } else {
                    let term = |k: u32| f64::from(k) / libm::tgamma(f64::from(k) + 2.0);
                    (1..20).rev().fold(0.0, |sum, k| -term(k) + x * sum)
                };
                worst_slope = worst_slope.max((slope / right - 1.0).abs());
            }
        }
        assert!(
            worst < 1.5e-15 && worst_slope < 5e-15,
            "{worst:e} {worst_slope:e}"
        );
        let Decay { keep, mean, slope } = decays([0.0, -700.0])[0];
        assert_eq!((keep, mean), (1.0, 1.0));
        assert!((slope + 0.5).abs() < 2e-16);
    }
}
