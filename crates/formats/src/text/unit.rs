//! Whether a piece of text in a header is a unit, and where it stands.

use crate::unit::Unit;

/// Splits `Position [mm]` or `Position (mm)` into name and unit.
///
/// Square brackets hold a unit unless they are empty or hold only digits (an index); round brackets
/// only where they hold a known unit, since `x (1)` or `q (left)` are names.
pub(crate) fn split(header: &str) -> (String, Option<String>) {
    let text = header.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        let Some(inside) = text.strip_suffix(close) else {
            continue;
        };
        let Some(at) = inside.rfind(open) else {
            continue;
        };
        let unit = inside[at + 1..].trim();
        let index = unit.chars().all(|c| c.is_ascii_digit());
        if index || (open == '(' && !is_known(unit)) {
            continue;
        }
        return (inside[..at].trim_end().to_owned(), Some(unit.to_owned()));
    }
    (text.to_owned(), None)
}

/// The unit of a cell in a units row: bare, or in either bracket.
pub(super) fn bare(cell: &str) -> &str {
    let cell = cell.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(inside) = cell.strip_prefix(open).and_then(|c| c.strip_suffix(close)) {
            return inside.trim();
        }
    }
    cell
}

/// Whether a text is a unit that can be converted; a bare number is an index.
pub fn is_known(text: &str) -> bool {
    let text = text.trim();
    text.chars().any(|c| c.is_alphabetic() || "%°‰".contains(c)) && Unit::parse(text).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(header: &str) -> (String, String) {
        let (name, unit) = split(header);
        (name, unit.unwrap_or_default())
    }

    #[test]
    fn brackets_hold_units_but_not_indices() {
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(parts("Position [mm]"), pair("Position", "mm"));
        assert_eq!(parts("Position(mm/s^2)"), pair("Position", "mm/s^2"));
        assert_eq!(parts("Angle (°)"), pair("Angle", "°"));
        assert_eq!(parts("Current [A_pk]"), pair("Current", "A_pk"));
        assert_eq!(parts("q[1] [rad]"), pair("q[1]", "rad"));
        for name in [
            "q[1]", "x (1)", "q (left)", "pos/mm", "pos_mm", "v []", "f(t)",
        ] {
            assert_eq!(parts(name), pair(name, ""), "{name}");
        }
    }

    #[test]
    fn units_of_the_trade() {
        for unit in [
            "s", "ms", "µs", "μm", "mm/s", "m/s²", "N m", "Nm", "mNm", "Ncm", "N·m", "rad/s",
            "deg/s", "1/min", "rev/min", "rpm", "kN", "A", "mA", "%", "counts", "°/s", "kg m^2",
            "s^-1",
        ] {
            assert!(is_known(unit), "{unit}");
        }
        for word in ["left", "1", "t", "time", "x", "pos", "", "n", "q", "Name"] {
            assert!(!is_known(word), "{word}");
        }
    }
}
