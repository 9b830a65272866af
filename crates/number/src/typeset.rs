//! Numbers written for people: significant digits, uncertainties, intervals, SI prefixes.
//!
//! The minus sign is U+2212, spaces do not break, powers of ten are written `×10⁶`, a number that does not exist is an
//! en dash. All rounding starts from the exact binary value, so the same input gives the same
//! characters on every machine.

/// `value` with `digits` significant digits (1 to 17): `7.410`, `0.01235`, `7.410×10⁶`.
/// The power of ten appears where plain digits would be false (`12345` with four) or hard to count.
pub fn sig(value: f64, digits: usize) -> String {
    let digits = digits.clamp(1, 17);
    if !value.is_finite() {
        return not_finite(value);
    }
    if value == 0.0 {
        return "0".into();
    }
    let (figures, exponent) = decimal(value, digits);
    let sign = if value < 0.0 { "−" } else { "" };
    if (-4..digits.max(3) as i32).contains(&exponent) {
        format!("{sign}{}", plain(&figures, exponent - digits as i32 + 1))
    } else {
        format!(
            "{sign}{}{}",
            plain(&figures, 1 - digits as i32),
            times_ten(exponent)
        )
    }
}

/// A whole number in groups of three: `30 001` (narrow no-break spaces).
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.len() > 4 {
            out.push('\u{202f}');
        }
        out.push(c);
    }
    out
}

/// A value and its standard uncertainty in the short form `7.41(12)×10⁶`: the digits in brackets
/// are the uncertainty of the last digits shown (JCGM 100:2008, 7.2.2). Without a usable
/// uncertainty (zero, negative, not finite, beyond 12 digits below the value) it is [`sig`] with 4.
pub fn concise(value: f64, uncertainty: f64) -> String {
    match Grid::for_uncertainty(value, uncertainty) {
        Some(grid) => {
            let u = (uncertainty / ten(grid.last)).round();
            format!("{}({u}){}", grid.write(value), grid.suffix())
        }
        None => sig(value, 4),
    }
}

/// A value and its uncertainty as `7.41 ± 0.12` or `(7.41 ± 0.12)×10⁶`; fallback as in [`concise`].
pub fn plus_minus(value: f64, uncertainty: f64) -> String {
    match Grid::for_uncertainty(value, uncertainty) {
        Some(grid) => grid.bracket(format!(
            "{} ± {}",
            grid.write(value),
            grid.write(uncertainty)
        )),
        None => sig(value, 4),
    }
}

/// An interval as `7.17 … 7.65` or `(7.17 … 7.65)×10⁶`, with two digits of its width.
/// An open end is written `−∞` or `∞`; an end that those digits would show as zero has digits of its own:
/// `1607 … 2.184×10⁵`.
pub fn interval(low: f64, high: f64) -> String {
    let shown = |grid: &Grid| {
        let vanishes = |x: f64| x != 0.0 && !grid.write(x).contains(|c| ('1'..='9').contains(&c));
        !vanishes(low) && !vanishes(high)
    };
    match Grid::new(low.abs().max(high.abs()), (high - low).abs()).filter(shown) {
        Some(grid) => grid.bracket(format!(
            "{}\u{a0}…\u{a0}{}",
            grid.write(low),
            grid.write(high)
        )),
        None => format!("{}\u{a0}…\u{a0}{}", sig(low, 4), sig(high, 4)),
    }
}

/// A quantity with an SI prefix that keeps the number between 1 and 1000: `7.41 MN/m`, `12.5 µm`.
/// Units without prefixes (`kg`, `%`, `deg`, ...) get [`sig`].
pub fn si(value: f64, unit: &str, digits: usize) -> String {
    let with_unit = |number: String, unit: &str| {
        if unit.is_empty() {
            number
        } else {
            format!("{number}\u{a0}{unit}")
        }
    };
    if value.is_finite() && value != 0.0 {
        let (_, exponent) = decimal(value, digits.clamp(1, 17));
        let power = 3 * exponent.div_euclid(3);
        if let Some(prefixed) = prefixed(unit, power) {
            return with_unit(sig(value / ten(power), digits), &prefixed);
        }
    }
    with_unit(sig(value, digits), unit)
}

/// A value with its unit under an SI prefix.
pub fn quantity(x: f64, unit: &str) -> String {
    let (factor, prefix) = match (x.abs(), unit) {
        _ if x == 0.0 => (1.0, ""),
        (a, "m" | "rad" | "s") if a < 0.9995e-6 => (1e9, "n"),
        (a, "m" | "rad" | "s") if a < 0.9995e-3 => (1e6, "µ"),
        (a, "m" | "rad" | "s") if a < 0.9995 => (1e3, "m"),
        (a, "m/s" | "rad/s") if a < 0.9995e-3 => (1e6, "µ"),
        (a, "m/s" | "rad/s") if a < 0.9995 => (1e3, "m"),
        _ => (1.0, ""),
    };
    format!("{} {prefix}{}", sig(factor * x, 3), crate::unit(unit))
}

/// `unit` with the prefix for 10^`power`, where there is one and the unit takes prefixes.
pub fn prefixed(unit: &str, power: i32) -> Option<String> {
    const TAKES_PREFIX: [&str; 16] = [
        "m", "s", "N", "A", "V", "W", "J", "Hz", "rad", "Pa", "Nm", "Ω", "H", "F", "T", "C",
    ];
    let end = unit.find(['/', '·', ' ', '*', '⋅']).unwrap_or(unit.len());
    if !TAKES_PREFIX.contains(&&unit[..end]) {
        return None;
    }
    let prefix = match power {
        -12 => "p",
        -9 => "n",
        -6 => "µ",
        -3 => "m",
        0 => "",
        3 => "k",
        6 => "M",
        9 => "G",
        12 => "T",
        _ => return None,
    };
    Some(format!("{prefix}{unit}"))
}

/// `×10ⁿ`.
pub fn times_ten(exponent: i32) -> String {
    format!("×10{}", superscript(exponent))
}

/// An integer in superscript characters.
pub fn superscript(value: i32) -> String {
    value
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            c => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
        })
        .collect()
}

/// 10^`exponent`, correctly rounded: 0 below the range of f64, infinite above.
pub fn ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

/// The decimal exponent of a finite, non-zero value: 3 for 1000 and 9999.9.
pub fn exponent(value: f64) -> i32 {
    let text = format!("{value:e}");
    text.split_once('e')
        .and_then(|(_, e)| e.parse().ok())
        .unwrap_or(0)
}

/// The integer with the given digits times 10^`power`, without an exponent: ("1234", -2) = 12.34.
/// Trailing zeros stand for the digits left of a positive power.
pub fn plain(figures: &str, power: i32) -> String {
    if power >= 0 {
        return format!("{figures}{}", "0".repeat(power as usize));
    }
    let decimals = power.unsigned_abs() as usize;
    let padded = format!("{figures:0>width$}", width = decimals + 1);
    let (whole, fraction) = padded.split_at(padded.len() - decimals);
    format!("{whole}.{fraction}")
}

/// The `digits` significant figures of |value| and the exponent of the first.
fn decimal(value: f64, digits: usize) -> (String, i32) {
    let text = format!("{:.*e}", digits - 1, value.abs());
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    (mantissa.replace('.', ""), exponent.parse().unwrap_or(0))
}

fn not_finite(value: f64) -> String {
    match value {
        f64::INFINITY => "∞".into(),
        f64::NEG_INFINITY => "−∞".into(),
        _ => "–".into(),
    }
}

/// The decimal place to which several numbers are rounded together, and the power of ten taken out.
struct Grid {
    /// Exponent of the last digit shown.
    last: i32,
    /// Power of ten written once, behind.
    power: i32,
}

impl Grid {
    fn for_uncertainty(value: f64, uncertainty: f64) -> Option<Self> {
        (uncertainty > 0.0)
            .then(|| Self::new(value, uncertainty))
            .flatten()
    }

    /// Two digits of `width`, beside numbers of the size of `largest`.
    fn new(largest: f64, width: f64) -> Option<Self> {
        if !largest.is_finite() || !width.is_finite() || width == 0.0 {
            return None;
        }
        let (_, width_exponent) = decimal(width, 2);
        let last = width_exponent - 1;
        let top = if largest == 0.0 {
            width_exponent
        } else {
            exponent(largest).max(width_exponent)
        };
        let readable = top - last <= 13 && last > -300 && top < 300;
        let power = if (-4..6).contains(&top) && last <= 0 {
            0
        } else {
            top
        };
        readable.then_some(Self { last, power })
    }

    /// `value` in units of 10^power, down to the last digit.
    fn write(&self, value: f64) -> String {
        if !value.is_finite() {
            return not_finite(value);
        }
        let steps = (value / ten(self.last)).round();
        let sign = if steps < 0.0 { "−" } else { "" };
        format!(
            "{sign}{}",
            plain(&format!("{}", steps.abs()), self.last - self.power)
        )
    }

    fn suffix(&self) -> String {
        if self.power == 0 {
            String::new()
        } else {
            times_ten(self.power)
        }
    }

    fn bracket(&self, text: String) -> String {
        if self.power == 0 {
            text
        } else {
            format!("({text}){}", self.suffix())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits() {
        for (value, digits, expected) in [
            (7.41, 4, "7.410"),
            (-0.012345, 3, "−0.0123"),
            (7.41e6, 3, "7.41×10⁶"),
            (12345.0, 4, "1.234×10⁴"),
            (9999.96, 5, "10000"),
            (99999.6, 5, "1.0000×10⁵"),
            (100.0, 1, "100"),
            (1e-4, 2, "0.00010"),
            (9.996e-5, 3, "0.000100"),
            (1.5e-310, 2, "1.5×10⁻³¹⁰"),
            (f64::MAX, 3, "1.80×10³⁰⁸"),
            (0.0, 4, "0"),
            (f64::NAN, 4, "–"),
            (f64::NEG_INFINITY, 4, "−∞"),
            (123.0, 0, "100"),
        ] {
            assert_eq!(sig(value, digits), expected, "sig({value}, {digits})");
        }
    }

    #[test]
    fn uncertainties_share_the_last_digit() {
        for (value, u, short, long) in [
            (7.4123e6, 1.2e5, "7.41(12)×10⁶", "(7.41 ± 0.12)×10⁶"),
            (203.5034, 0.0996, "203.50(10)", "203.50 ± 0.10"),
            (-3.1648, 0.53, "−3.16(53)", "−3.16 ± 0.53"),
            (0.0, 0.25, "0.00(25)", "0.00 ± 0.25"),
            (1.98e-4, 3.1e-6, "0.0001980(31)", "0.0001980 ± 0.0000031"),
            (2.4e-7, 5.0e-5, "0.0(50)×10⁻⁵", "(0.0 ± 5.0)×10⁻⁵"),
            (12.0, 0.0, "12.00", "12.00"),
            (12.0, f64::NAN, "12.00", "12.00"),
            (f64::NAN, 1.0, "–", "–"),
            (1e300, 1e-300, "1.000×10³⁰⁰", "1.000×10³⁰⁰"),
        ] {
            assert_eq!(concise(value, u), short);
            assert_eq!(plus_minus(value, u).replace('\u{a0}', " "), long);
        }
    }

    #[test]
    fn intervals() {
        for (low, high, expected) in [
            (7.17e6, 7.652e6, "(7.17 … 7.65)×10⁶"),
            (-0.5, 1.26, "−0.5 … 1.3"),
            (0.0, 1.26, "0.0 … 1.3"),
            (1607.0, 2.184e5, "1607 … 2.184×10⁵"),
            (-2.184e5, -1607.0, "−2.184×10⁵ … −1607"),
            (f64::NEG_INFINITY, 3.0, "−∞ … 3.000"),
            (2.0, 2.0, "2.000 … 2.000"),
            (f64::NAN, f64::MAX, "– … 1.798×10³⁰⁸"),
        ] {
            assert_eq!(interval(low, high).replace('\u{a0}', " "), expected);
        }
    }

    #[test]
    fn prefixes_and_counts() {
        assert_eq!(si(7.41e6, "N/m", 3), "7.41\u{a0}MN/m");
        assert_eq!(si(-1.25e-5, "m", 3), "−12.5\u{a0}µm");
        assert_eq!(si(0.9999, "s", 2), "1.0\u{a0}s");
        assert_eq!(si(95.1, "kg", 3), "95.1\u{a0}kg");
        assert_eq!(si(0.0, "N", 3), "0\u{a0}N");
        assert_eq!(si(0.25, "", 2), "0.25");
        assert_eq!(count(30001), "30\u{202f}001");
        assert_eq!(count(1000), "1000");
        assert_eq!(
            count(u64::MAX).chars().filter(|c| *c == '\u{202f}').count(),
            6
        );
    }
}
