//! Times of a list: ISO 8601, or seconds.

/// Seconds of a time: a number as it stands, or seconds since 1970-01-01 00:00 UTC of a date with or without time of day and
/// offset, as `2026-03-01`, `2026-03-01T06:30`, `2026-03-01 06:30:15.5+02:00`. Without an offset it is UTC. `None` of anything else.
pub fn seconds_of(text: &str) -> Option<f64> {
    let text = text.trim();
    if let Ok(seconds) = text.parse::<f64>() {
        return seconds.is_finite().then_some(seconds);
    }
    let (date, rest) = text.split_at_checked(10)?;
    let days = days_of(date)?;
    if rest.is_empty() {
        return Some(86_400.0 * days as f64);
    }
    let rest = rest.strip_prefix(['T', 't', ' '])?;
    let zone = rest.find(['Z', 'z', '+', '-']).unwrap_or(rest.len());
    let (clock, zone) = rest.split_at(zone);
    let offset = offset_of(zone)?;
    Some(86_400.0 * days as f64 + clock_of(clock)? - offset)
}

/// Seconds of the date in the name of a file or, where there is none, of the folders above it, the nearest first: year, month and
/// day in this order, with or without time of day behind them, as `2026-03-01`, `20260301`, `2026_03_01_06_30`,
/// `20260301T063015`, in UTC.
pub fn seconds_in_name(path: &str) -> Option<f64> {
    path.split(['/', '\\']).rev().find_map(|name| {
        let starts = name.char_indices().map(|(at, _)| at);
        let mut whole = starts.filter(|at| *at == 0 || !name.as_bytes()[at - 1].is_ascii_digit());
        whole.find_map(|at| dated(&name[at..]))
    })
}

/// Seconds of a date with which a text begins; digits that go on are a number of something else.
fn dated(text: &str) -> Option<f64> {
    let (date, rest) = groups(text, &[4, 2, 2])?;
    let days = days_of(&date.join("-")).filter(|days| YEARS.contains(days))?;
    let clock = |counts| {
        let (clock, rest) = groups(rest, counts)?;
        clock_of(&clock.join(":")).filter(|_| !begins_with_digit(rest))
    };
    let clock = clock(&[2, 2, 2]).or_else(|| clock(&[2, 2]));
    let clock = clock.or_else(|| (!begins_with_digit(rest)).then_some(0.0))?;
    Some(86_400.0 * days as f64 + clock)
}

/// Days from 1970 to 2199: other numbers of eight digits are no dates of a log.
const YEARS: std::ops::Range<i64> = 0..84_006;

fn begins_with_digit(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit())
}

/// The groups of so many digits with which a text begins, each behind a mark or none, and what follows them.
fn groups<'a>(text: &'a str, counts: &[usize]) -> Option<(Vec<&'a str>, &'a str)> {
    let mut rest = text;
    let mut next = |count: &usize| {
        let plain = rest
            .strip_prefix(|c| "-_.: Tth".contains(c))
            .unwrap_or(rest);
        let (found, behind) = plain.split_at_checked(*count)?;
        rest = behind;
        digits(found, *count).map(|_| found)
    };
    let found: Option<Vec<&str>> = counts.iter().map(&mut next).collect();
    Some((found?, rest))
}

/// When a file was changed last, seconds since 1970; `None` of one that is not there.
pub fn seconds_of_file(path: &std::path::Path) -> Option<f64> {
    let changed = path.metadata().and_then(|file| file.modified()).ok()?;
    let since = changed.duration_since(std::time::UNIX_EPOCH).ok()?;
    Some(since.as_secs_f64())
}

/// A number of that many digits.
fn digits(text: &str, count: usize) -> Option<u32> {
    let all = text.len() == count && text.bytes().all(|b| b.is_ascii_digit());
    all.then(|| text.parse().ok()).flatten()
}

/// Days from 1970-01-01 to a date of the Gregorian calendar.
fn days_of(date: &str) -> Option<i64> {
    let mut parts = date.split('-');
    let (year, month, day) = (parts.next()?, parts.next()?, parts.next()?);
    let year = i64::from(digits(year, 4)?);
    let month = i64::from(digits(month, 2)?);
    let day = i64::from(digits(day, 2)?);
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let longest = match month {
        2 => 28 + i64::from(leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => return None,
    };
    if parts.next().is_some() || !(1..=longest).contains(&day) {
        return None;
    }
    // Years from March on, so that the day that leap years have more is their last.
    let (year, month) = (year - i64::from(month <= 2), (month + 9) % 12);
    let before_year = 365 * year + year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    let before_month = (153 * month + 2) / 5;
    Some(before_year + before_month + day - 1 - 719_468)
}

/// Times from this on are dates: three years after 1970.
const DATES_FROM: f64 = 1e8;
/// Times up to this are: the year 9999.
const DATES_TO: f64 = 2.5e11;

/// A time as people read it: date and time of day in UTC, or seconds where it is no date.
pub fn date_of(seconds: f64) -> String {
    if !(DATES_FROM..DATES_TO).contains(&seconds) {
        return format!("{} s", stiction_number::short(seconds));
    }
    let minutes = (seconds / 60.0).floor() as i64;
    let (days, minute) = (minutes.div_euclid(1440), minutes.rem_euclid(1440));
    // The inverse of `days_of`: years of 400, then of the calendar from March on.
    let from = days + 719_468;
    let (era, day) = (from.div_euclid(146_097), from.rem_euclid(146_097));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let date = of_year - (153 * month + 2) / 5 + 1;
    let calendar = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * era + year + i64::from(calendar <= 2);
    format!(
        "{year:04}-{calendar:02}-{date:02} {:02}:{:02}",
        minute / 60,
        minute % 60
    )
}

/// Seconds of `06:30`, `06:30:15`, `06:30:15.25`.
fn clock_of(clock: &str) -> Option<f64> {
    let mut parts = clock.split(':');
    let hour = digits(parts.next()?, 2).filter(|h| *h < 24)?;
    let minute = digits(parts.next()?, 2).filter(|m| *m < 60)?;
    let second = match parts.next() {
        None => 0.0,
        Some(text) => {
            let whole = text.split(['.', ',']).next()?;
            // A leap second is the last of its minute.
            digits(whole, 2).filter(|s| *s <= 60)?;
            let plain = text
                .bytes()
                .all(|b| b.is_ascii_digit() || b".,".contains(&b));
            let number = plain.then(|| text.replace(',', ".").parse::<f64>().ok());
            number.flatten()?
        }
    };
    let none_left = parts.next().is_none();
    none_left.then(|| f64::from(3600 * hour + 60 * minute) + second)
}

/// Seconds of `Z`, `+02:00`, `-0730`, `+02`, or nothing.
fn offset_of(zone: &str) -> Option<f64> {
    let sign = match zone.chars().next() {
        None | Some('Z' | 'z') => return (zone.len() <= 1).then_some(0.0),
        Some('-') => -1.0,
        _ => 1.0,
    };
    let plain = zone[1..].replace(':', "");
    let (hours, minutes) = match plain.len() {
        2 => (digits(&plain, 2)?, 0),
        4 => (digits(&plain[..2], 2)?, digits(&plain[2..], 2)?),
        _ => return None,
    };
    (hours < 24 && minutes < 60).then(|| sign * f64::from(3600 * hours + 60 * minutes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What `date -u -d "..." +%s.%N` of GNU coreutils 9 says of these.
    #[test]
    fn times_are_those_of_another_program() {
        for (text, seconds) in [
            ("1970-01-01", 0.0),
            ("2026-03-01", 1_772_323_200.0),
            ("2024-02-29T12:00", 1_709_208_000.0),
            ("2000-03-01 00:00:00Z", 951_868_800.0),
            ("1969-12-31T23:59:59.5Z", -0.5),
            ("2026-03-01T06:30:15.25+02:00", 1_772_339_415.25),
            ("2026-03-01T06:30:15-0730", 1_772_373_615.0),
            ("1.5e3", 1500.0),
            ("-3", -3.0),
        ] {
            assert_eq!(seconds_of(text), Some(seconds), "{text}");
        }
    }

    #[test]
    fn what_is_no_time_is_none() {
        for text in [
            "",
            "today",
            "NaN",
            "inf",
            "2026-02-29",
            "2026-13-01",
            "2026-1-1",
            "01.03.2026",
            "2026-03-01T24:00",
            "2026-03-01T6:30",
            "2026-03-01T06:30:61",
            "2026-03-01T06:30+2",
            "2026-03-01T06:30Zulu",
            "2026-03-01T06:30:1e1",
            "2026-03-01T06:30:",
            "\u{e9}\u{e9}\u{e9}\u{e9}\u{e9}\u{e9}",
        ] {
            assert_eq!(seconds_of(text), None, "{text}");
        }
    }

    #[test]
    fn names_hold_dates_with_and_without_a_time_of_day() {
        let of = |text: &str| seconds_of(text).unwrap();
        for (name, time) in [
            ("logs/2026-03-01.csv", "2026-03-01"),
            ("axis3_20260301.csv", "2026-03-01"),
            ("axis3_20260301_0630.csv", "2026-03-01T06:30"),
            ("run 2026-03-01T06-30-15 x.mcap", "2026-03-01T06:30:15"),
            ("20260301T063015Z.csv", "2026-03-01T06:30:15"),
            ("logs/2026_03_01/run_7.csv", "2026-03-01"),
            ("2026-03-01/log-2026-03-02-12.csv", "2026-03-02"),
        ] {
            assert_eq!(seconds_in_name(name), Some(of(time)), "{name}");
        }
        for name in [
            "run7.csv",
            "20261301.csv",
            "12026030100.csv",
            "10001212.csv",
            "2026-03.csv",
        ] {
            assert_eq!(seconds_in_name(name), None, "{name}");
        }
    }

    proptest! {
        /// A date that is written is read as the same minute.
        #[test]
        fn dates_come_back(seconds in 1e8..2.4e11f64) {
            let read = seconds_of(&date_of(seconds)).unwrap();
            prop_assert!(read <= seconds && seconds - read < 60.0, "{}", date_of(seconds));
        }

        #[test]
        fn any_text_is_taken_without_a_fault(text in "\\PC{0,24}", date in "[0-9TZ:+., -]{0,28}") {
            let _ = (seconds_of(&text), seconds_of(&date));
            let _ = (seconds_in_name(&text), seconds_in_name(&date));
        }

        /// Days follow each other without a gap over 400 years, the period of the calendar.
        #[test]
        fn days_follow_each_other(year in 1600u32..2400, month in 1u32..=12, day in 1u32..=28) {
            let of = |y: u32, m: u32, d: u32| days_of(&format!("{y:04}-{m:02}-{d:02}"));
            let (today, next) = (of(year, month, day).unwrap(), of(year, month, day + 1));
            let next = next.or(of(year, month + 1, 1)).or(of(year + 1, 1, 1)).unwrap();
            prop_assert_eq!(next, today + 1);
            prop_assert_eq!(of(year + 400, month, day), Some(today + 146_097));
        }
    }
}
