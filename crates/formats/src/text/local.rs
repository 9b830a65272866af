//! Dates with time as they are written from place to place: `26.11.2024 12:00:00.123`, `11/26/2024 12:00:00 PM`,
//! `26-Nov-2024 12:00:00`.
//!
//! Which number is the day follows from what is written: with dots day comes before month and year, a month may have a name,
//! a number above 12 is no month. Where that leaves more than one order, a log of one day needs none; the first date that
//! differs settles it, if only one order makes both dates, or only one makes it the day after. Else the log is refused.

use super::clock::{self, Cursor, DAY};
use std::fmt;

/// ns.
const DAY_NS: i64 = DAY * 1_000_000_000;
/// As English writes them short.
const MONTHS: [&[u8; 3]; 12] = [
    b"jan", b"feb", b"mar", b"apr", b"may", b"jun", b"jul", b"aug", b"sep", b"oct", b"nov", b"dec",
];

/// A date with time, its numbers as they stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Local {
    /// The three numbers of the date; a month with a name is its number.
    parts: [i64; 3],
    /// What stands between them.
    mark: u8,
    /// Whether the year has four digits.
    long_year: bool,
    named_month: bool,
    /// Nanoseconds since midnight.
    of_day: i64,
    /// Whether it has a fraction of a second.
    pub fraction: bool,
}

/// Which number of a date is what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    DayMonthYear,
    MonthDayYear,
    YearMonthDay,
}

const ORDERS: [Order; 3] = [
    Order::DayMonthYear,
    Order::MonthDayYear,
    Order::YearMonthDay,
];

/// The dates of a column: the first, and their order once it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dates {
    first: Local,
    order: Option<Order>,
}

/// What is wrong with a date.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wrong {
    /// It is none in the order of the first.
    NoDate,
    /// More than one order is possible, and they differ in the time that has passed.
    Unclear,
}

/// Reads a date with time whose year does not come first with four digits.
pub(super) fn read(cell: &[u8]) -> Option<Local> {
    let mut text = Cursor(cell);
    let first = text.digits(1, 2)?;
    let mark = text.next().filter(|b| b"-/.".contains(b))?;
    let (second, named_month) = match text.digits(1, 2) {
        Some(number) => (number, false),
        None => (month(&mut text)?, true),
    };
    text.expect(mark)?;
    let before = text.0.len();
    let third = text.digits(2, 4)?;
    let digits = before - text.0.len();
    // `26.11.2024, 12:00:00`
    let _ = text.expect(b',');
    if !matches!(text.next(), Some(b' ' | b'T' | b't')) || digits == 3 {
        return None;
    }
    while text.expect(b' ').is_some() {}
    let (of_day, fraction) = text.time_of_day(false)?;
    let local = Local {
        parts: [first, second, third],
        mark,
        long_year: digits == 4,
        named_month,
        of_day,
        fraction,
    };
    let is_date = text.0.is_empty() && ORDERS.iter().any(|order| local.day(*order).is_some());
    is_date.then_some(local)
}

fn month(text: &mut Cursor<'_>) -> Option<i64> {
    let (word, rest) = text.0.split_at_checked(3)?;
    let month = MONTHS
        .iter()
        .position(|name| word.eq_ignore_ascii_case(*name))?;
    text.0 = rest;
    Some(month as i64 + 1)
}

impl Local {
    /// Days since 1970-01-01 in this order; `None` where it is no date so, or nobody writes such dates in this order.
    fn day(&self, order: Order) -> Option<i64> {
        let [a, b, c] = self.parts;
        let year = |short: i64| if self.long_year { short } else { 2000 + short };
        match order {
            Order::DayMonthYear => clock::days(year(c), b, a),
            Order::MonthDayYear if self.mark != b'.' && !self.named_month => {
                clock::days(year(c), a, b)
            }
            Order::YearMonthDay if !self.long_year && !self.named_month => {
                clock::days(2000 + a, b, c)
            }
            _ => None,
        }
    }
}

impl fmt::Display for Local {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([a, b, c], mark) = (self.parts, char::from(self.mark));
        let seconds = self.of_day / 1_000_000_000;
        let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
        write!(
            f,
            "`{a:02}{mark}{b:02}{mark}{c:02} {hour:02}:{minute:02}:{second:02}`"
        )
    }
}

impl From<Local> for Dates {
    fn from(first: Local) -> Self {
        let mut possible = ORDERS
            .into_iter()
            .filter(|order| first.day(*order).is_some());
        let (one, other) = (possible.next(), possible.next());
        Self {
            first,
            order: one.filter(|_| other.is_none()),
        }
    }
}

impl Dates {
    /// The first date.
    pub fn first(&self) -> Local {
        self.first
    }

    /// Seconds from the first date, of which this one may be the first that shows the order of day and month.
    pub fn seconds(&mut self, date: Local) -> Result<f64, Wrong> {
        let days = match self.order {
            _ if self.is_of_first_day(date) => 0,
            Some(order) => self.days(date, order).ok_or(Wrong::NoDate)?,
            None => self.settle(date)?,
        };
        Ok((days * DAY_NS + date.of_day - self.first.of_day) as f64 / 1e9)
    }

    fn is_of_first_day(&self, date: Local) -> bool {
        let first = self.first;
        (date.parts, date.mark, date.long_year) == (first.parts, first.mark, first.long_year)
    }

    /// Days from the first date, in this order.
    fn days(&self, date: Local, order: Order) -> Option<i64> {
        let alike = date.mark == self.first.mark && date.long_year == self.first.long_year;
        let first = self.first.day(order).filter(|_| alike)?;
        Some(date.day(order)? - first)
    }

    /// Takes the only order that makes both dates, or else the only one that makes this the day after the first.
    fn settle(&mut self, date: Local) -> Result<i64, Wrong> {
        let possible = ORDERS
            .iter()
            .filter_map(|order| Some((*order, self.days(date, *order)?)));
        let possible: Vec<(Order, i64)> = possible.collect();
        let next = possible.iter().filter(|(_, days)| *days == 1).count();
        let settled = match possible.len() {
            0 => return Err(Wrong::NoDate),
            1 => possible.first(),
            _ if next == 1 => possible.iter().find(|(_, days)| *days == 1),
            _ => None,
        };
        let (order, days) = settled.ok_or(Wrong::Unclear)?;
        self.order = Some(*order);
        Ok(*days)
    }

    /// How they are written, for people.
    pub fn said(&self) -> &'static str {
        match self.order {
            None => "all of one day",
            Some(Order::DayMonthYear) => "day before month",
            Some(Order::MonthDayYear) => "month before day",
            Some(Order::YearMonthDay) => "year before month",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn seconds(cells: &[&str]) -> Result<Vec<f64>, Wrong> {
        let local = |cell: &&str| read(cell.as_bytes()).unwrap_or_else(|| panic!("{cell}"));
        let mut dates = Dates::from(local(&cells[0]));
        cells
            .iter()
            .map(|cell| dates.seconds(local(cell)))
            .collect()
    }

    #[test]
    fn the_order_follows_from_dots_names_and_numbers_above_12() {
        for (cells, passed) in [
            (["01.02.2024 10:00:00", "02.02.2024 10:00:00"], 86_400.0),
            (
                ["01.02.2024 10:00:00", "01.03.2024 10:00:00"],
                29.0 * 86_400.0,
            ),
            (["11/26/2024 11:59:59 PM", "11/27/2024 12:00:00 AM"], 1.0),
            (["26/11/24 12:00:00.123", "26/11/24 12:00:00.124"], 0.001),
            (["26-Nov-2024 12:00:00", "26-Nov-2024 12:00:00,25"], 0.25),
            (["31.12.2023, 23:59:59.5", "01.01.2024, 00:00:00.5"], 1.0),
        ] {
            assert_eq!(seconds(&cells), Ok(vec![0.0, passed]), "{cells:?}");
        }
    }

    #[test]
    fn one_day_needs_no_order_and_the_next_day_shows_it() {
        let day = |date: &str, time: &str| format!("{date} {time}");
        for (first, second) in [("01/02/2024", "02/02/2024"), ("02/01/2024", "02/02/2024")] {
            let cells = [
                day(first, "23:59:59.5"),
                day(first, "23:59:59.75"),
                day(second, "00:00:00.25"),
            ];
            let cells: Vec<&str> = cells.iter().map(String::as_str).collect();
            assert_eq!(seconds(&cells), Ok(vec![0.0, 0.25, 0.75]));
        }
        // A number above 12 shows it whatever lies between.
        assert_eq!(
            seconds(&["01/02/2024 00:00", "01/15/2024 00:00"]),
            Ok(vec![0.0, 13.0 * 86_400.0])
        );
    }

    #[test]
    fn what_stays_unclear_or_is_no_date_is_refused() {
        for (cells, wrong) in [
            (
                ["03/04/2024 10:00:00", "07/04/2024 10:00:00"],
                Wrong::Unclear,
            ),
            (
                ["03/04/2024 10:00:00", "02/04/2024 10:00:00"],
                Wrong::Unclear,
            ),
            (
                ["13/04/2024 10:00:00", "04/13/2024 10:00:00"],
                Wrong::NoDate,
            ),
            (
                ["03/04/2024 10:00:00", "04.04.2024 10:00:00"],
                Wrong::NoDate,
            ),
        ] {
            assert_eq!(seconds(&cells), Err(wrong), "{cells:?}");
        }
        for text in [
            "01/02/2024",
            "32.01.2024 10:00:00",
            "31.02.2024 10:00:00",
            "13/13/2024 10:00:00",
            "01/02-2024 10:00:00",
            "01.02.024 10:00:00",
            "11.26.2024 10:00:00",
            "26-Nop-2024 10:00:00",
            "01/02/2024 24:00:00",
            "01/02/2024 10:00:00 h",
        ] {
            assert_eq!(read(text.as_bytes()), None, "{text}");
        }
    }

    proptest! {
        /// Whichever order a log is written in, what is read of it are the seconds that have passed; or it is refused.
        #[test]
        fn no_order_is_taken_for_another(
            first in 0_i64..20_000,
            steps in proptest::collection::vec(0_i64..3, 1..6),
            month_first in any::<bool>(),
        ) {
            let mut day = first;
            let mut days = vec![day];
            days.extend(steps.iter().map(|step| { day += step; day }));
            let written: Vec<String> = days.iter().map(|&days| {
                let date = (1..=31).flat_map(|d| (1..=12).flat_map(move |m| (1970..2026).map(move |y| (y, m, d))))
                    .find(|&(y, m, d)| clock::days(y, m, d) == Some(days)).unwrap();
                let (y, m, d) = date;
                match month_first {
                    true => format!("{m}/{d}/{y} 10:00:00"),
                    false => format!("{d}/{m}/{y} 10:00:00"),
                }
            }).collect();
            let cells: Vec<&str> = written.iter().map(String::as_str).collect();
            if let Ok(read) = seconds(&cells) {
                let passed: Vec<f64> = days.iter().map(|d| ((d - first) * DAY) as f64).collect();
                prop_assert_eq!(read, passed, "{:?}", cells);
            }
        }
    }
}
