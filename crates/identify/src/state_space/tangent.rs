//! Numbers with one derivative, and with one in each vector lane.
//!
//! A loop over the lanes works on [`Tangent`]s. The values are the same in all lanes, so that the compiler computes them
//! once, before the loop; what is left in it are products of the derivatives, in whole vectors. For that its body must be
//! without branches and inner loops, and everything in it must be inlined.

/// Lanes: two vectors of the widest instruction set, four of the next.
pub(super) const LANES: usize = 16;

/// The lanes, on cache lines of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Lanes(pub [f64; LANES]);

impl Lanes {
    pub const ZERO: Self = Self([0.0; LANES]);
}

/// A number and its derivatives by all unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sensitive {
    pub value: f64,
    pub slope: Lanes,
}

impl Sensitive {
    pub const ZERO: Self = Self::constant(0.0);

    /// A number that depends on nothing.
    pub const fn constant(value: f64) -> Self {
        Self {
            value,
            slope: Lanes::ZERO,
        }
    }

    /// What a function of tangents gives in every lane.
    pub fn of(f: impl Fn(usize) -> Tangent) -> Self {
        let mut out = Self::constant(f(0).value);
        for k in 0..LANES {
            out.slope.0[k] = f(k).slope;
        }
        out
    }

    /// The number with the derivative of one lane.
    #[inline(always)]
    pub fn lane(&self, k: usize) -> Tangent {
        Tangent {
            value: self.value,
            slope: self.slope.0[k],
        }
    }
}

/// A number and a derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tangent {
    pub value: f64,
    pub slope: f64,
}

impl Tangent {
    pub const ZERO: Self = Self::constant(0.0);

    #[inline(always)]
    pub const fn constant(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }

    /// A function of this number: its value and derivative here.
    #[inline(always)]
    pub fn mapped(self, value: f64, derivative: f64) -> Self {
        Self {
            value,
            slope: derivative * self.slope,
        }
    }

    /// This number times a constant.
    #[inline(always)]
    pub fn scaled(self, by: f64) -> Self {
        self.mapped(self.value * by, by)
    }

    /// This number plus a constant.
    #[inline(always)]
    pub fn raised(self, by: f64) -> Self {
        Self {
            value: self.value + by,
            slope: self.slope,
        }
    }

    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }

    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: self.slope - other.slope,
        }
    }

    /// This number plus a constant times another.
    #[inline(always)]
    pub fn plus_scaled(self, by: f64, other: Self) -> Self {
        Self {
            value: by.mul_add(other.value, self.value),
            slope: by.mul_add(other.slope, self.slope),
        }
    }

    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: other.value.mul_add(self.slope, self.value * other.slope),
        }
    }

    /// This number plus a product.
    #[inline(always)]
    pub fn plus_product(self, a: Self, b: Self) -> Self {
        let first = a.value.mul_add(b.slope, self.slope);
        Self {
            value: a.value.mul_add(b.value, self.value),
            slope: b.value.mul_add(a.slope, first),
        }
    }

    /// This number less a product.
    #[inline(always)]
    pub fn minus_product(self, a: Self, b: Self) -> Self {
        let first = (-a.value).mul_add(b.slope, self.slope);
        Self {
            value: (-a.value).mul_add(b.value, self.value),
            slope: (-b.value).mul_add(a.slope, first),
        }
    }

    /// One over it.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        let inverse = 1.0 / self.value;
        self.mapped(inverse, -inverse * inverse)
    }

    /// The same number, with the derivative that it has through something else of this derivative.
    #[inline(always)]
    pub fn through(self, by: f64, slope: f64) -> Self {
        Self {
            value: self.value,
            slope: by.mul_add(slope, self.slope),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each operation against central differences.
    #[test]
    fn derivatives_match_differences() {
        let at = |x: [f64; 2], lane: usize| {
            let number = |i: usize| Tangent {
                value: x[i],
                slope: if i == lane { 1.0 } else { 0.0 },
            };
            let (a, b) = (number(0), number(1));
            [
                a.plus(b),
                a.minus(b).raised(2.0),
                a.times(b),
                a.plus_product(a, b),
                b.minus_product(a, b),
                a.plus_scaled(0.3, b).times(a),
                b.inverse().times(a),
                a.scaled(-2.0).times(a),
            ]
        };
        let x = [0.7, -1.3];
        let h = 1e-6;
        for lane in 0..2 {
            let moved = |by: f64| {
                let mut x = x;
                x[lane] += by;
                at(x, lane)
            };
            let (up, down) = (moved(h), moved(-h));
            for (i, found) in at(x, lane).iter().enumerate() {
                let numeric = (up[i].value - down[i].value) / (2.0 * h);
                assert!((found.slope - numeric).abs() < 1e-8, "{i} {lane}");
            }
        }
        let number = Tangent {
            value: 2.0,
            slope: 1.0,
        };
        assert_eq!(number.through(3.0, 4.0).slope, 13.0);
    }
}
