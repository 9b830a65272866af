//! What a workbook has beside its sheets: their names, texts that cells share, and which styles are dates.

use std::io::{self, BufRead};

use super::xml::{Part, Xml, attribute, name};

/// Most bytes of all texts that cells share.
const MAX_TEXTS: usize = 64 << 20;

/// Most styles and sheets.
const MAX_ENTRIES: usize = 65_536;

/// A workbook.
#[derive(Default)]
pub(super) struct Book {
    texts: Vec<String>,
    /// Whether a style shows numbers as dates or times.
    dates: Vec<bool>,
}

impl Book {
    /// Reads the texts that cells share.
    pub(super) fn texts(&mut self, reader: impl BufRead) -> io::Result<()> {
        let mut xml = Xml::new(reader);
        let (mut in_text, mut left) = (false, MAX_TEXTS);
        // Within `rPh` stands how a word is read aloud, in Japanese: no part of the text.
        let mut aloud = false;
        while let Some(part) = xml.next()? {
            match part {
                Part::Open(tag, empty) => match name(&tag) {
                    "si" => {
                        left = take(left, size_of::<String>())?;
                        self.texts.push(String::new());
                    }
                    "t" => in_text = !empty && !aloud,
                    "rPh" => aloud = !empty,
                    _ => {}
                },
                Part::Text(text) if in_text => {
                    left = take(left, text.len())?;
                    if let Some(last) = self.texts.last_mut() {
                        last.push_str(&text);
                    }
                }
                Part::Text(_) => {}
                Part::Close(tag) => {
                    in_text = false;
                    aloud &= tag != "rPh";
                }
            }
        }
        Ok(())
    }

    /// Reads which styles are dates: ISO 29500-1, 18.8.30 and 18.8.45.
    pub(super) fn styles(&mut self, reader: impl BufRead) -> io::Result<()> {
        let mut xml = Xml::new(reader);
        let mut own = std::collections::HashSet::new();
        let mut in_cells = false;
        while let Some(part) = xml.next()? {
            match part {
                Part::Open(tag, _) => match name(&tag) {
                    "numFmt" if own.len() < MAX_ENTRIES => {
                        let id = attribute(&tag, "numFmtId").and_then(|id| id.parse::<u32>().ok());
                        let code = attribute(&tag, "formatCode").unwrap_or_default();
                        own.extend(id.filter(|_| is_date(&code)));
                    }
                    "cellXfs" => in_cells = true,
                    "xf" if in_cells && self.dates.len() < MAX_ENTRIES => {
                        let id = attribute(&tag, "numFmtId").and_then(|id| id.parse().ok());
                        let id = id.unwrap_or(0);
                        self.dates
                            .push(matches!(id, 14..=22 | 45..=47) || own.contains(&id));
                    }
                    _ => {}
                },
                Part::Close(tag) if tag == "cellXfs" => in_cells = false,
                _ => {}
            }
        }
        Ok(())
    }

    /// What a cell says, as the text reader takes it.
    pub(super) fn text(&self, kind: &str, style: Option<usize>, text: &str) -> String {
        match kind {
            "s" => {
                let index = text.trim().parse::<usize>().ok();
                let shared = index.and_then(|index| self.texts.get(index));
                shared.cloned().unwrap_or_default()
            }
            "b" => if text.trim() == "1" { "TRUE" } else { "FALSE" }.to_owned(),
            // An error such as #DIV/0!.
            "e" => "NaN".to_owned(),
            "" | "n" => {
                let dated = style.and_then(|style| self.dates.get(style)) == Some(&true);
                let moment = text.trim().parse().ok().filter(|_| dated).and_then(moment);
                moment.unwrap_or_else(|| text.to_owned())
            }
            _ => text.to_owned(),
        }
    }
}

fn take(left: usize, bytes: usize) -> io::Result<usize> {
    left.checked_sub(bytes)
        .ok_or_else(|| io::Error::other(format!("more than {MAX_TEXTS} bytes of texts")))
}

/// A sheet of the workbook.
pub(super) struct Named {
    /// As it is called.
    pub name: String,
    /// Where it is told.
    pub id: String,
    /// Whether Excel shows it.
    pub is_hidden: bool,
}

/// The sheets in the order of the workbook, those that are shown before those that are hidden.
pub(super) fn sheets(reader: impl BufRead) -> io::Result<Vec<Named>> {
    let mut xml = Xml::new(reader);
    let mut all = Vec::new();
    while let Some(part) = xml.next()? {
        if let Part::Open(tag, _) = part
            && name(&tag) == "sheet"
            && all.len() < MAX_ENTRIES
        {
            let id = ["r:id", "id"].iter().find_map(|key| attribute(&tag, key));
            let state = attribute(&tag, "state").unwrap_or_default();
            all.push(Named {
                name: attribute(&tag, "name").unwrap_or_default(),
                id: id.unwrap_or_default(),
                is_hidden: matches!(state.as_str(), "hidden" | "veryHidden"),
            });
        }
    }
    all.sort_by_key(|sheet| sheet.is_hidden);
    Ok(all)
}

/// Where in the archive the file is that a relationship leads to.
pub(super) fn target(reader: impl BufRead, id: &str) -> io::Result<Option<String>> {
    let mut xml = Xml::new(reader);
    while let Some(part) = xml.next()? {
        if let Part::Open(tag, _) = part
            && attribute(&tag, "Id").as_deref() == Some(id)
        {
            let target = attribute(&tag, "Target").unwrap_or_default();
            return Ok(Some(match target.strip_prefix('/') {
                Some(whole) => whole.to_owned(),
                None => format!("xl/{target}"),
            }));
        }
    }
    Ok(None)
}

/// Whether a format shows dates or times: it has days, years, hours or seconds outside of quotes and brackets.
fn is_date(code: &str) -> bool {
    let (mut quoted, mut bracket) = (false, false);
    code.chars().any(|letter| {
        match letter {
            '"' => quoted = !quoted,
            '[' => bracket = true,
            ']' => bracket = false,
            _ => {
                return !quoted
                    && !bracket
                    && matches!(letter, 'd' | 'y' | 'h' | 's' | 'D' | 'Y' | 'H' | 'S');
            }
        }
        false
    })
}

/// The date and time of days since 1899-12-30, or below one day the time of day, to 10 µs:
/// a double of days of this century resolves 0.6 µs, and writers round.
fn moment(days: f64) -> Option<String> {
    const DAY: f64 = 86_400e6;
    // The year 9999, which is the last one of Excel.
    if !(0.0..2_958_466.0).contains(&days) {
        return None;
    }
    let micro = (days * DAY / 10.0).round() as i64 * 10;
    let (day, rest) = (micro / DAY as i64, micro % DAY as i64);
    let (second, micro) = (rest / 1_000_000, rest % 1_000_000);
    let time = format!(
        "{:02}:{:02}:{:02}.{micro:06}",
        second / 3600,
        second / 60 % 60,
        second % 60
    );
    if days < 1.0 && day == 0 {
        return Some(time);
    }
    // Days since 0000-03-01, in cycles of 400 years of which the leap day is last.
    let day = day + 693_899;
    let (cycle, day) = (day / 146_097, day % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let in_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * in_year + 2) / 153;
    let date = in_year - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    Some(format!(
        "{:04}-{month:02}-{date:02}T{time}",
        cycle * 400 + year + next
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates() {
        // From Excel: 45413.5 is noon of 2024-05-01, 60 + 1 is 1900-03-01.
        assert_eq!(
            moment(45_413.5).as_deref(),
            Some("2024-05-01T12:00:00.000000")
        );
        assert_eq!(moment(61.0).as_deref(), Some("1900-03-01T00:00:00.000000"));
        assert_eq!(
            moment(45_351.0).as_deref(),
            Some("2024-02-29T00:00:00.000000")
        );
        assert_eq!(
            moment(45_657.0).as_deref(),
            Some("2024-12-31T00:00:00.000000")
        );
        assert_eq!(moment(0.25).as_deref(), Some("06:00:00.000000"));
        assert_eq!(moment(-1.0), None);
        for (code, date) in [
            ("0.00E+00", false),
            ("yyyy-mm-dd", true),
            ("[h]:mm:ss", true),
            ("0 \"days\"", false),
            ("General", false),
        ] {
            assert_eq!(is_date(code), date, "{code}");
        }
    }
}
