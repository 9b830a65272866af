//! What one cell says: a number, a missing value, a moment, or text.

use super::clock::{self, Moment};
use super::local::{self, Local};
use super::options::Decimal;

/// What a cell holds, and for a number which decimal mark it shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell {
    /// Nothing but blanks.
    Empty,
    /// A mark for a missing value.
    Missing,
    /// A number and its decimal mark, if it has one.
    Number(f64, Option<Decimal>),
    /// A date with time, or a time of day.
    Moment(Moment),
    /// A date with time whose order of day and month other cells may have to tell.
    Local(Local),
    /// Several numbers in brackets, and how many.
    List(usize),
    /// Anything else.
    Text,
}

impl Cell {
    /// Whether the cell holds a number or a point in time.
    pub(super) fn is_sample(self) -> bool {
        self.samples() > 0
    }

    /// How many numbers and points in time the cell holds.
    pub(super) fn samples(self) -> usize {
        match self {
            Cell::Number(..) | Cell::Moment(_) | Cell::Local(_) => 1,
            Cell::List(length) => length,
            _ => 0,
        }
    }

    /// Whether the cell holds a point in time without a fraction of a second.
    pub(super) fn is_whole_second(self) -> bool {
        match self {
            Cell::Moment(moment) => !moment.fraction,
            Cell::Local(date) => !date.fraction,
            _ => false,
        }
    }

    /// Whether the cell holds no value.
    pub(super) fn is_void(self) -> bool {
        matches!(self, Cell::Empty | Cell::Missing)
    }
}

/// Longest number that is parsed; the decimal expansion of the smallest f64 has 1077 characters.
const LONGEST_NUMBER: usize = 2048;

/// The minus of typesetting, U+2212, which spreadsheets and programs of Python show.
const MINUS: &[u8] = "\u{2212}".as_bytes();

/// Understands a cell without knowing the decimal mark: `1,5` and `1.5` are numbers, `1.234,5` and
/// `1,234,567` are not.
pub(crate) fn classify(cell: &[u8]) -> Cell {
    let cell = cell.trim_ascii();
    if cell.is_empty() {
        return Cell::Empty;
    }
    if let Some(value) = word(cell) {
        return value;
    }
    if !cell.iter().any(u8::is_ascii_digit) {
        return Cell::Text;
    }
    if let Some(at) = memchr::memmem::find(cell, MINUS) {
        return classify(&[&cell[..at], b"-", &cell[at + MINUS.len()..]].concat());
    }
    if let Some(value) = number(cell, Decimal::Point) {
        let mark = cell.contains(&b'.').then_some(Decimal::Point);
        return Cell::Number(value, mark);
    }
    if let Some(value) = number(cell, Decimal::Comma) {
        return Cell::Number(value, Some(Decimal::Comma));
    }
    if let Some(moment) = clock::moment(cell) {
        return Cell::Moment(moment);
    }
    if let Some(length) = length_of_list(cell) {
        return Cell::List(length);
    }
    local::read(cell).map_or(Cell::Text, Cell::Local)
}

/// What stands between the brackets of a list: `[0.1, 0.2]` or `(1, 2)` of Python, `[0.1 0.2]` of NumPy.
fn inside_list(cell: &[u8]) -> Option<&[u8]> {
    let inside = match cell {
        [b'[', inside @ .., b']'] | [b'(', inside @ .., b')'] => inside,
        _ => return None,
    };
    let inside = inside.trim_ascii();
    Some(inside.strip_suffix(b",").unwrap_or(inside))
}

/// The numbers of a list, in the order of the cell; a missing one is NaN, and `None` is no number. A comma or blanks stand between
/// them, and the decimal mark is the point.
pub(super) fn elements(cell: &[u8]) -> Option<impl Iterator<Item = Option<f64>>> {
    let inside = inside_list(cell.trim_ascii())?;
    let commas = inside.contains(&b',');
    let parts = inside.split(move |byte| match commas {
        true => *byte == b',',
        false => byte.is_ascii_whitespace(),
    });
    let parts = parts.filter(move |part| commas || !part.is_empty());
    Some(parts.map(|part| {
        let part = part.trim_ascii();
        match fast_float2::parse(part) {
            Ok(value) => Some(value),
            Err(_) => match word(part) {
                Some(Cell::Missing) => Some(f64::NAN),
                Some(Cell::Number(value, _)) => Some(value),
                _ => None,
            },
        }
    }))
}

/// The length of a list of two numbers or more: one in brackets may be an index, or a negative amount.
fn length_of_list(cell: &[u8]) -> Option<usize> {
    let mut length = 0;
    for element in elements(cell)? {
        element?;
        length += 1;
    }
    (length > 1).then_some(length)
}

/// Whether a list is empty.
pub(super) fn is_empty_list(cell: &[u8]) -> bool {
    inside_list(cell.trim_ascii()).is_some_and(<[u8]>::is_empty)
}

/// The correctly rounded value of a cell written with this decimal mark.
pub(super) fn number(cell: &[u8], decimal: Decimal) -> Option<f64> {
    if cell.len() > LONGEST_NUMBER {
        return None;
    }
    match decimal {
        Decimal::Point => fast_float2::parse(cell).ok(),
        Decimal::Comma => {
            let mut short = [0_u8; 64];
            let mut long = Vec::new();
            let copy = match short.get_mut(..cell.len()) {
                Some(copy) => copy,
                None => {
                    long.resize(cell.len(), 0);
                    &mut long[..]
                }
            };
            with_point(cell, copy)?;
            fast_float2::parse(copy).ok()
        }
    }
}

/// Copies a number with decimal comma as one with decimal point. A comma without a digit behind it
/// is refused: `1, 2` is two cells.
#[inline]
pub(super) fn with_point(cell: &[u8], copy: &mut [u8]) -> Option<()> {
    for (n, (to, &from)) in copy.iter_mut().zip(cell).enumerate() {
        *to = match from {
            b',' if cell.get(n + 1).is_some_and(u8::is_ascii_digit) => b'.',
            b',' | b'.' => return None,
            other => other,
        };
    }
    Some(())
}

/// Words that stand for a value or for its absence, in any case.
fn word(cell: &[u8]) -> Option<Cell> {
    const MISSING: [&str; 23] = [
        "nan",
        "na",
        "n/a",
        "#n/a",
        "#na",
        "<na>",
        "null",
        "none",
        "nat",
        "-",
        "--",
        "?",
        "1.#qnan",
        "1.#ind",
        "nan(ind)",
        "nan(snan)",
        "(null)",
        // What a spreadsheet shows where a formula has no value.
        "#value!",
        "#div/0!",
        "#ref!",
        "#num!",
        "#name?",
        "#null!",
    ];
    // The longest word is eleven characters with its sign.
    if cell.len() > 12
        || !cell
            .iter()
            .any(|b| b.is_ascii_alphabetic() || b"-?".contains(b))
    {
        return None;
    }
    let mut lower = [0_u8; 12];
    for (to, from) in lower.iter_mut().zip(cell) {
        *to = if *from == b',' {
            b'.'
        } else {
            from.to_ascii_lowercase()
        };
    }
    let lower = std::str::from_utf8(&lower[..cell.len()]).ok()?;
    let (sign, bare) = match lower.as_bytes()[0] {
        b'-' if lower.len() > 1 => (-1.0, &lower[1..]),
        b'+' if lower.len() > 1 => (1.0, &lower[1..]),
        _ => (1.0, lower),
    };
    match bare {
        "inf" | "infinity" | "1.#inf" => Some(Cell::Number(sign * f64::INFINITY, None)),
        "true" if bare == lower => Some(Cell::Number(1.0, None)),
        "false" if bare == lower => Some(Cell::Number(0.0, None)),
        _ if MISSING.contains(&bare) => Some(Cell::Missing),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_mark_makes_a_number_and_two_do_not() {
        let point = |v| Cell::Number(v, Some(Decimal::Point));
        let comma = |v| Cell::Number(v, Some(Decimal::Comma));
        assert_eq!(classify(b" +1.5 "), point(1.5));
        assert_eq!(classify(b"-,5e-3"), comma(-0.0005));
        assert_eq!(classify("\u{2212}1.5e\u{2212}3".as_bytes()), point(-0.0015));
        assert_eq!(classify("1\u{2212}5".as_bytes()), Cell::Text);
        assert_eq!(classify(b"12"), Cell::Number(12.0, None));
        for text in [
            "1.234,5",
            "1,234.5",
            "1,234,567",
            "1.2.3",
            "1_0",
            "0x10",
            "1e",
            "1,5,",
            "--1",
        ] {
            assert_eq!(classify(text.as_bytes()), Cell::Text, "{text}");
        }
    }

    #[test]
    fn words() {
        assert_eq!(classify(b"TRUE"), Cell::Number(1.0, None));
        assert_eq!(
            classify(b"-Infinity"),
            Cell::Number(f64::NEG_INFINITY, None)
        );
        assert_eq!(classify(b"-1,#INF"), Cell::Number(f64::NEG_INFINITY, None));
        for missing in [
            "#VALUE!",
            "#DIV/0!",
            "NaN",
            "-nan(ind)",
            "N/A",
            "null",
            "1.#QNAN",
            "-",
            "<NA>",
        ] {
            assert_eq!(classify(missing.as_bytes()), Cell::Missing, "{missing}");
        }
        for text in ["-true", "hold", "nano", "i", "infinit"] {
            assert_eq!(classify(text.as_bytes()), Cell::Text, "{text}");
        }
    }

    #[test]
    fn lists() {
        let list = |text: &str| elements(text.as_bytes()).map(Iterator::collect::<Vec<_>>);
        for text in ["[1.5, -2,3e2]", "(1.5,-2, 3e2,)", " [ 1.5 -2.\n  3e2] "] {
            assert_eq!(list(text), Some(vec![Some(1.5), Some(-2.0), Some(300.0)]));
            assert_eq!(classify(text.as_bytes()), Cell::List(3), "{text}");
        }
        assert_eq!(classify(b"[nan, inf, None, True]"), Cell::Text);
        assert_eq!(classify(b"[nan, inf, None, 0]"), Cell::List(4));
        assert_eq!(list("[]"), Some(vec![]));
        assert!(is_empty_list(b" [ ] ") && !is_empty_list(b"[1]"));
        for text in [
            "[1]",
            "(5)",
            "[1, a]",
            "[1, , 2]",
            "[1, 2",
            "1, 2]",
            "[[1, 2], [3, 4]]",
            "[1; 2]",
        ] {
            assert_eq!(classify(text.as_bytes()), Cell::Text, "{text}");
        }
    }

    #[test]
    fn long_numbers_round_correctly() {
        // 2^-1074 written out, the longest exact expansion there is, with either mark.
        let exact = format!("{:.1074}", f64::from_bits(1));
        assert_eq!(
            number(exact.as_bytes(), Decimal::Point),
            Some(f64::from_bits(1))
        );
        let comma = exact.replace('.', ",");
        assert_eq!(
            number(comma.as_bytes(), Decimal::Comma),
            Some(f64::from_bits(1))
        );
    }
}
