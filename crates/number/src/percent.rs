//! Percentages of what was measured or fitted, and what stands in their place where no reader can use the number.

use crate::typeset::sig;

/// Largest percentage that is printed as a number, %. Ten times the value itself: beyond it the data say nothing of a
/// value, and more digits only hide that.
pub const LARGEST_PERCENT: f64 = 1000.0;

/// A percentage to be printed.
///
/// Beyond [`LARGEST_PERCENT`] a deviation is `not bounded` and an error `over 1000 %` (`below -1000 %`); what is not a number is a dash.
///
/// ```
/// use stiction_number::Percent;
/// assert_eq!(Percent::error(12.345).decimals(2), "12.35 %");
/// assert_eq!(Percent::error(-3.21).signed(1), "-3.2 %");
/// assert_eq!(Percent::error(124_601_617_115.19).decimals(2), "over 1000 %");
/// assert_eq!(Percent::deviation(1e24).digits(2), "not bounded");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Percent {
    /// %
    value: f64,
    deviation: bool,
}

impl Percent {
    /// A relative error, a difference or a share, %.
    pub fn error(percent: f64) -> Self {
        Self {
            value: percent,
            deviation: false,
        }
    }

    /// The deviation of a value relative to that value, %.
    pub fn deviation(percent: f64) -> Self {
        Self {
            value: percent,
            deviation: true,
        }
    }

    /// Whether a number can be printed at all.
    pub fn is_bounded(self) -> bool {
        self.value.abs() <= LARGEST_PERCENT
    }

    /// With a fixed number of decimals, ASCII: `12.35 %`.
    pub fn decimals(self, decimals: usize) -> String {
        self.or_beyond("-", "-", |x| format!("{x:.decimals$}"))
    }

    /// The same with a sign: `+12.35 %`.
    pub fn signed(self, decimals: usize) -> String {
        self.or_beyond("-", "-", |x| format!("{x:+.decimals$}"))
    }

    /// With significant digits, typeset as in a report: `−12.3 %`.
    pub fn digits(self, digits: usize) -> String {
        self.or_beyond("–", "−", |x| sig(x, digits))
    }

    /// With at most four digits, ASCII: `12.35 %`, `0.5 %`.
    pub fn short(self) -> String {
        self.or_beyond("-", "-", crate::short)
    }

    /// Three decimals, and four digits where a good fit leaves less than 0.1 %: `2.345 %`, `0.01234 %`.
    pub fn fine(self) -> String {
        self.or_beyond("-", "-", |x| {
            if x < 0.1 {
                crate::four_digits(x)
            } else {
                format!("{x:.3}")
            }
        })
    }

    fn or_beyond(self, none: &str, minus: &str, write: impl Fn(f64) -> String) -> String {
        if self.is_bounded() {
            format!("{} %", write(self.value))
        } else if self.deviation {
            "not bounded".into()
        } else if self.value.is_nan() {
            none.into()
        } else if self.value > 0.0 {
            format!("over {LARGEST_PERCENT} %")
        } else {
            format!("below {minus}{LARGEST_PERCENT} %")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_beyond_ten_times_the_value() {
        for (x, error, deviation) in [
            (0.0, "0.00 %", "0.00 %"),
            (1000.0, "1000.00 %", "1000.00 %"),
            (1000.001, "over 1000 %", "not bounded"),
            (2.973528090936806e24, "over 1000 %", "not bounded"),
            (f64::INFINITY, "over 1000 %", "not bounded"),
            (-5000.0, "below -1000 %", "not bounded"),
            (f64::NAN, "-", "not bounded"),
        ] {
            assert_eq!(Percent::error(x).decimals(2), error);
            assert_eq!(Percent::deviation(x).decimals(2), deviation);
            assert_eq!(Percent::deviation(x).is_bounded(), deviation.ends_with('%'));
        }
    }

    #[test]
    fn each_way_of_writing() {
        let x = Percent::error(-12.345);
        assert_eq!(x.signed(1), "-12.3 %");
        assert_eq!(x.digits(3), "−12.3 %");
        assert_eq!(Percent::error(12.345).signed(0), "+12 %");
        assert_eq!(Percent::error(-1e9).digits(3), "below −1000 %");
        assert_eq!(Percent::error(f64::NAN).digits(3), "–");
        assert_eq!(Percent::error(12.3456).short(), "12.35 %");
        assert_eq!(Percent::error(12.3456).fine(), "12.346 %");
        assert_eq!(Percent::error(0.012345).fine(), "0.01235 %");
        assert_eq!(Percent::error(1e5).fine(), "over 1000 %");
    }
}
