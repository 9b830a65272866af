//! Numbers in messages and terminal text: ASCII, the same width rules everywhere.

/// At most four digits, without zeros at the end: `7.41`, `12346`, `7.41e6`.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    if !(1e-3..1e6).contains(&size) {
        let text = format!("{x:.3e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{power}", trimmed(digits));
    }
    if size >= 1000.0 {
        return format!("{x:.0}");
    }
    let decimals = if size >= 100.0 {
        1
    } else if size >= 10.0 {
        2
    } else if size >= 1.0 {
        3
    } else if size >= 0.1 {
        4
    } else if size >= 0.01 {
        5
    } else {
        6
    };
    trimmed(&format!("{x:.decimals$}")).to_string()
}

/// Four digits, zeros at the end included, so that a column lines up: `7.410`, `0.01200`, `7.410e6`.
pub fn four_digits(x: f64) -> String {
    let scientific = format!("{x:.3e}");
    if x == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&x.abs()) {
        // The power after rounding: .099999999 is written as .1 is.
        let power = scientific.split_once('e').and_then(|(_, p)| p.parse().ok());
        let decimals = (3 - power.unwrap_or(0)).clamp(0, 7) as usize;
        format!("{x:.decimals$}")
    } else {
        scientific
    }
}

/// All digits; very large and small numbers with a power of ten.
pub fn full(x: f64) -> String {
    if x == 0.0 || (1e-9..1e16).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

/// A number in as few digits as read back the same, as it would be typed: `20`, `1e-40`.
pub fn shortest(x: f64) -> String {
    let plain = format!("{x:?}");
    let plain = plain.strip_suffix(".0").unwrap_or(&plain);
    let powers = format!("{x:e}");
    // Few read how many zeros there are.
    if x.abs() >= 1e7 && powers.len() < plain.len() {
        powers
    } else {
        plain.into()
    }
}

/// A unit as people write it: `N·s/m`, `kg·m²`. Files keep the form that is typed, `N*s/m`.
pub fn unit(typed: &str) -> String {
    typed.replace('*', "·").replace("^2", "²")
}

/// R², the part of the variance that is explained: five digits up to 1. Below -1 the residual is larger than the signal
/// itself by far, and by how much is of no use.
pub fn r_squared(r2: f64) -> String {
    if r2 < -1.0 {
        "below -1".into()
    } else if r2.is_finite() {
        format!("{r2:.5}")
    } else {
        "-".into()
    }
}

/// `1 sample`, `3 samples`.
pub fn counted(number: usize, noun: &str) -> String {
    if number == 1 {
        format!("1 {noun}")
    } else {
        format!("{number} {noun}s")
    }
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') {
        digits.trim_end_matches('0').trim_end_matches('.')
    } else {
        digits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_have_few_digits() {
        for (x, trimmed, aligned) in [
            (0.0, "0", "0"),
            (7.41, "7.41", "7.410"),
            (-0.012, "-0.012", "-0.01200"),
            (9.99961, "10", "10.00"),
            (0.099_999_999, "0.1", "0.1000"),
            (1000.0, "1000", "1000"),
            (12345.6, "12346", "12346"),
            (7.41e6, "7.41e6", "7.410e6"),
            (1e-4, "1e-4", "1.000e-4"),
            (f64::INFINITY, "inf", "inf"),
            (f64::NAN, "NaN", "NaN"),
        ] {
            assert_eq!(short(x), trimmed);
            assert_eq!(four_digits(x), aligned);
        }
        assert_eq!(full(0.1), "0.1");
        assert_eq!(full(1e300), "1e300");
        assert_eq!(counted(1, "sample"), "1 sample");
        assert_eq!(counted(3, "sample"), "3 samples");
    }

    #[test]
    fn units_are_written_in_one_way() {
        assert_eq!(unit("N*s/m"), "N·s/m");
        assert_eq!(unit("kg*m^2"), "kg·m²");
        assert_eq!(unit("N*s^2/m^2"), "N·s²/m²");
        assert_eq!(unit("mm/s"), "mm/s");
    }

    #[test]
    fn no_r_squared_far_below_zero() {
        for (r2, text) in [
            (0.999_917, "0.99992"),
            (-0.25, "-0.25000"),
            (-4e25, "below -1"),
            (f64::NEG_INFINITY, "below -1"),
            (f64::NAN, "-"),
        ] {
            assert_eq!(r_squared(r2), text);
        }
    }

    #[test]
    fn numbers_are_as_typed() {
        let typed = [
            "20",
            "1000000",
            "2e7",
            "123456789",
            "1e-40",
            "0.0035",
            "-3",
            "1e300",
            "inf",
        ];
        for text in typed {
            assert_eq!(shortest(text.parse().unwrap()), text);
        }
    }
}
