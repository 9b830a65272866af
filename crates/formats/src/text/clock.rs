//! Date-times whose order of day and month is beyond doubt: ISO 8601, and times of day. Others: [`super::local`].

/// A point in time: nanoseconds since 1970-01-01 for a date, since midnight for a time of day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Moment {
    /// Nanoseconds since the epoch (or midnight); times with a zone are converted to UTC.
    pub ns: i64,
    /// Whether a date is part of it.
    pub dated: bool,
    /// Whether it has a fraction of a second.
    pub fraction: bool,
}

/// ns.
const SECOND: i64 = 1_000_000_000;
/// s.
pub(super) const DAY: i64 = 86_400;

/// Reads `2024-05-01T12:00:00.001`, with `T` or a blank, `.` or `,`, an optional zone; or
/// `12:00:00.001`. Seconds are needed in a time of day, so that `12:00` stays text.
pub(super) fn moment(cell: &[u8]) -> Option<Moment> {
    let mut text = Cursor(cell);
    let date = text.date();
    if date.is_some() && !matches!(text.next(), Some(b'T' | b't' | b' ')) {
        return None;
    }
    let (of_day, fraction) = text.time_of_day(date.is_none())?;
    let zone = if date.is_some() { text.zone()? } else { 0 };
    if !text.0.is_empty() {
        return None;
    }
    let midnight = (date.unwrap_or(0) * DAY - zone).checked_mul(SECOND)?;
    Some(Moment {
        ns: midnight.checked_add(of_day)?,
        dated: date.is_some(),
        fraction,
    })
}

/// What is left of a cell.
pub(super) struct Cursor<'a>(pub &'a [u8]);

impl Cursor<'_> {
    pub fn next(&mut self) -> Option<u8> {
        let (&first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(first)
    }

    pub fn expect(&mut self, byte: u8) -> Option<()> {
        self.0 = self.0.strip_prefix(&[byte])?;
        Some(())
    }

    pub fn digits(&mut self, least: usize, most: usize) -> Option<i64> {
        let count = self
            .0
            .iter()
            .take(most)
            .take_while(|b| b.is_ascii_digit())
            .count();
        if count < least {
            return None;
        }
        let (digits, rest) = self.0.split_at(count);
        self.0 = rest;
        Some(
            digits
                .iter()
                .fold(0, |sum, d| sum * 10 + i64::from(d - b'0')),
        )
    }

    /// Nanoseconds since midnight, and whether a fraction of a second is among them: `9:00`, `09:00:00.25`, `09:00:00,25`,
    /// `09:00:00:250`, `9:00:00 PM`. Seconds may be left out unless they are needed.
    pub fn time_of_day(&mut self, seconds_needed: bool) -> Option<(i64, bool)> {
        let mut hour = self.digits(1, 2)?;
        self.expect(b':')?;
        let minute = self.digits(2, 2)?;
        let second = match self.expect(b':') {
            Some(()) => self.digits(2, 2)?,
            None if seconds_needed => return None,
            None => 0,
        };
        let fraction = match self.0.first() {
            Some(b'.' | b',') => {
                self.next();
                Some(self.nanoseconds()?)
            }
            // Drives write milliseconds so; fewer digits could be any part of a second.
            Some(b':') => {
                self.next();
                Some(self.digits(3, 3)? * 1_000_000)
            }
            _ => None,
        };
        if let Some(after_noon) = self.half_of_day() {
            if !(1..=12).contains(&hour) {
                return None;
            }
            hour = hour % 12 + if after_noon { 12 } else { 0 };
        }
        if hour > 23 || minute > 59 || second > 59 {
            return None;
        }
        let whole = (hour * 3600 + minute * 60 + second) * SECOND;
        Some((whole + fraction.unwrap_or(0), fraction.is_some()))
    }

    /// Whether `PM` follows, or `AM`; nothing is taken where neither does.
    fn half_of_day(&mut self) -> Option<bool> {
        let rest = self.0.strip_prefix(b" ").unwrap_or(self.0);
        let (half, rest) = rest.split_at_checked(2)?;
        let after_noon = [&b"AM"[..], b"PM"]
            .iter()
            .position(|word| half.eq_ignore_ascii_case(word))?;
        self.0 = rest;
        Some(after_noon == 1)
    }

    /// One to nine digits of a second; more are refused, since f64 seconds could not tell them.
    fn nanoseconds(&mut self) -> Option<i64> {
        let before = self.0.len();
        let value = self.digits(1, 9)?;
        Some((before - self.0.len()..9).fold(value, |ns, _| ns * 10))
    }

    /// Days since 1970-01-01 of `yyyy-mm-dd`, `yyyy/mm/dd` or `yyyy.mm.dd`; nothing is taken where
    /// no such date stands.
    fn date(&mut self) -> Option<i64> {
        let mut ahead = Cursor(self.0);
        let year = ahead.digits(4, 4)?;
        let mark = ahead.next().filter(|b| b"-/.".contains(b))?;
        let month = ahead.digits(1, 2)?;
        ahead.expect(mark)?;
        let day = ahead.digits(1, 2)?;
        let date = days(year, month, day)?;
        self.0 = ahead.0;
        Some(date)
    }

    /// Seconds east of UTC of `Z`, `+02`, `+0200`, `+02:00` or nothing.
    fn zone(&mut self) -> Option<i64> {
        let sign = match self.0.first() {
            None => return Some(0),
            Some(b'Z' | b'z') => {
                self.next();
                return Some(0);
            }
            Some(b'+') => 1,
            Some(b'-') => -1,
            Some(_) => return None,
        };
        self.next();
        let hours = self.digits(2, 2)?;
        let _ = self.expect(b':');
        let minutes = if self.0.is_empty() {
            0
        } else {
            self.digits(2, 2)?
        };
        (hours < 24 && minutes < 60).then_some(sign * (hours * 3600 + minutes * 60))
    }
}

/// Days since 1970-01-01; `None` where there is no such date.
pub(super) fn days(year: i64, month: i64, day: i64) -> Option<i64> {
    let is_date = (1..=12).contains(&month) && (1..=days_in(year, month)).contains(&day);
    is_date.then(|| days_from_epoch(year, month, day))
}

fn days_in(year: i64, month: i64) -> i64 {
    match month {
        2 if year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Days from 1970-01-01 in the Gregorian calendar: whole years and months before the date, counted
/// with years that begin in March so that the leap day comes last.
fn days_from_epoch(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = if month > 2 {
        (year, month - 3)
    } else {
        (year - 1, month + 9)
    };
    let leaps = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    // 153 days in every five months that alternate 31, 30, 31, 30, 31.
    let in_year = (153 * month + 2) / 5 + day - 1;
    365 * year + leaps + in_year - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ns(text: &str) -> Option<i64> {
        moment(text.as_bytes()).map(|m| m.ns)
    }

    #[test]
    fn known_instants() {
        // From `date -u -d ... +%s`.
        assert_eq!(ns("1970-01-01T00:00:00"), Some(0));
        assert_eq!(ns("2024-02-29 23:59:59.5"), Some(1_709_251_199_500_000_000));
        assert_eq!(
            ns("2024-05-01T12:00:00,001"),
            Some(1_714_564_800_001_000_000)
        );
        assert_eq!(
            ns("2024-05-01T14:00:00+02:00"),
            Some(1_714_564_800_000_000_000)
        );
        assert_eq!(ns("2024/05/01 12:00Z"), Some(1_714_564_800_000_000_000));
        assert_eq!(ns("1969-12-31T23:59:59.999999999Z"), Some(-1));
        assert_eq!(ns("1900-03-01 00:00:00"), Some(-2_203_891_200_000_000_000));
        assert_eq!(ns("9:00:00.25"), Some(32_400_250_000_000));
        assert_eq!(ns("09:00:00:250"), Some(32_400_250_000_000));
        assert_eq!(ns("12:00:00.5 AM"), Some(500_000_000));
        assert_eq!(ns("12:00:00 pm"), Some(43_200_000_000_000));
        assert_eq!(ns("2024-05-01 02:00:00PM"), ns("2024-05-01 14:00:00"));
    }

    #[test]
    fn what_is_no_moment() {
        for text in [
            "2023-02-29 10:00:00",
            "2024-13-01 00:00:00",
            "24:00:00",
            "12:60:00",
            "12:00",
            "01/02/2024 10:00:00",
            "2024-05-01",
            "2024-05-01T12:00:00.0000000001",
            "12:00:00Z",
            "12:00:00:25",
            "12:00:00:2500",
            "13:00:00 PM",
            "0:00:00 AM",
            "12:00 PM",
            "9999-01-01 00:00:00",
        ] {
            assert_eq!(ns(text), None, "{text}");
        }
    }
}
