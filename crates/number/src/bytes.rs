//! Sizes in bytes: as they are read from a command line, and as they are written in messages.

/// The multiples that a size may be given in; the first are those that it is written in.
const MULTIPLES: [(&str, u64); 10] = [
    ("TB", 1_000_000_000_000),
    ("GB", 1_000_000_000),
    ("MB", 1_000_000),
    ("kB", 1_000),
    ("TiB", 1 << 40),
    ("GiB", 1 << 30),
    ("MiB", 1 << 20),
    ("KiB", 1 << 10),
    ("KB", 1_000),
    ("B", 1),
];

/// A size in bytes with three digits: `12.6 GB`, `512 B`. Multiples are of 1000.
///
/// ```
/// use stiction_number::bytes;
/// assert_eq!(bytes(48_000_000_000), "48 GB");
/// assert_eq!(bytes(12_600_000), "12.6 MB");
/// assert_eq!(bytes(999), "999 B");
/// ```
pub fn bytes(count: u64) -> String {
    match MULTIPLES[..4].iter().find(|(_, by)| count >= *by) {
        Some((unit, by)) => format!("{} {unit}", crate::short(three_digits(count, *by))),
        None => format!("{count} B"),
    }
}

/// The multiple, to three digits, none of them below the point from 100 on.
fn three_digits(count: u64, by: u64) -> f64 {
    let value = count as f64 / by as f64;
    let decimals = match value {
        v if v < 10.0 => 100.0,
        v if v < 100.0 => 10.0,
        _ => 1.0,
    };
    (value * decimals).round() / decimals
}

/// A size as an option takes it, to type after a sign of equality or a blank: whole, in the largest multiple that is not less
/// than what is asked for by more than a hundredth, and never less than it.
///
/// ```
/// use stiction_number::{bytes_option, parse_bytes};
/// assert_eq!(bytes_option(48_000_000_000), "48GB");
/// assert_eq!(bytes_option(1_234_567_890), "1235MB");
/// assert!(parse_bytes(&bytes_option(1_234_567_891)) >= Some(1_234_567_891));
/// ```
pub fn bytes_option(count: u64) -> String {
    let fits = |(_, by): &&(&str, u64)| {
        let above = count.div_ceil(*by).saturating_mul(*by) - count;
        count >= *by && above <= count / 100
    };
    match MULTIPLES[..4].iter().find(fits) {
        Some((unit, by)) => format!("{}{unit}", count.div_ceil(*by)),
        None => count.to_string(),
    }
}

/// A number of bytes from `2GB`, `512 MiB`, `1.5g` or `4000000`; capital and small letters are alike, and a multiple without
/// its `B` is one of 1000. `None` where it is not such a size, or more than can be counted.
///
/// ```
/// use stiction_number::parse_bytes;
/// assert_eq!(parse_bytes("1.5 GB"), Some(1_500_000_000));
/// assert_eq!(parse_bytes("2gib"), Some(2 << 30));
/// assert_eq!(parse_bytes("500M"), Some(500_000_000));
/// assert_eq!(parse_bytes("much"), None);
/// ```
pub fn parse_bytes(text: &str) -> Option<u64> {
    let text = text.trim();
    let end = text
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let unit = unit.trim();
    let by = match unit {
        "" => 1,
        unit => {
            let same = |(name, _): &&(&str, u64)| {
                name.eq_ignore_ascii_case(unit) || name[..name.len() - 1].eq_ignore_ascii_case(unit)
            };
            MULTIPLES.iter().find(same)?.1
        }
    };
    if let Ok(whole) = number.parse::<u64>() {
        return whole.checked_mul(by);
    }
    let part = number.parse::<f64>().ok()? * by as f64;
    (part.is_finite() && part < u64::MAX as f64).then_some(part as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_offered_is_enough_and_not_much_more() {
        for count in [
            1,
            999,
            1001,
            123_456,
            99_999_999,
            12_884_901_889,
            u64::MAX / 3,
        ] {
            let offered = parse_bytes(&bytes_option(count)).unwrap();
            assert!(offered >= count && offered - count <= count / 100);
        }
    }

    #[test]
    fn what_is_no_size_is_refused() {
        for text in [
            "",
            "GB",
            "-1GB",
            "1..2GB",
            "1 PB",
            "1e9",
            "nan",
            "99999999999TB",
        ] {
            assert_eq!(parse_bytes(text), None, "{text}");
        }
        assert_eq!(parse_bytes(" 7 B "), Some(7));
        assert_eq!(parse_bytes("3k"), Some(3000));
    }
}
