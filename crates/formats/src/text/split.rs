//! Where one cell ends: separators, blanks and quotes, the same for head and body.

use super::options::Separator;
use memchr::{memchr, memrchr};
use std::borrow::Cow;

/// Which bytes end a cell and a row.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    pub separator: Separator,
    pub byte: Option<u8>,
    /// Last byte of a row: LF, or CR in files that have no LF.
    pub row: u8,
    ends: [bool; 256],
    blank: [bool; 256],
}

impl Ends {
    pub(super) fn new(separator: Separator, row: u8) -> Self {
        let byte = separator.byte();
        let mut blank = [false; 256];
        for b in *b" \t\r" {
            blank[usize::from(b)] = Some(b) != byte && b != row;
        }
        let mut ends = if byte.is_none() { blank } else { [false; 256] };
        ends[usize::from(row)] = true;
        if let Some(byte) = byte {
            ends[usize::from(byte)] = true;
        }
        Self {
            separator,
            byte,
            row,
            ends,
            blank,
        }
    }

    /// Whether a byte ends a cell that is not quoted.
    #[inline]
    pub(super) fn is_end(&self, byte: u8) -> bool {
        self.ends[usize::from(byte)]
    }

    /// The first place from here on that is not padding.
    #[inline]
    pub(super) fn skip_blanks(&self, text: &[u8], mut at: usize) -> usize {
        while at < text.len() && self.blank[usize::from(text[at])] {
            at += 1;
        }
        at
    }

    /// The start of the row after the one at `at`, taking no account of quotes.
    pub(super) fn next_row(&self, text: &[u8], at: usize) -> usize {
        memchr(self.row, &text[at..]).map_or(text.len(), |n| at + n + 1)
    }

    /// The end of the last whole row in a block that starts with a row.
    pub(super) fn last_row_end(&self, text: &[u8]) -> Option<usize> {
        if memchr(b'"', text).is_none() {
            return memrchr(self.row, text).map(|n| n + 1);
        }
        let (mut at, mut last, mut at_start) = (0, None, true);
        while at < text.len() {
            if at_start && is_comment(&text[at..]) {
                at = self.next_row(text, at);
                last = (text[at - 1] == self.row).then_some(at).or(last);
                continue;
            }
            let found = field(text, at, self);
            if found.open || found.end == text.len() {
                break;
            }
            at_start = text[found.end] == self.row;
            at = found.end + usize::from(at_start || self.byte == Some(text[found.end]));
            if at_start {
                last = Some(at);
            }
        }
        last
    }
}

/// Whether a row is a remark between samples: `#`, `%` or `//` after blanks.
#[inline]
pub(super) fn is_comment(row: &[u8]) -> bool {
    match row.first() {
        Some(b'#' | b'%') => true,
        Some(b'/' | b' ' | b'\t') => {
            let text = row.trim_ascii_start();
            text.starts_with(b"#") || text.starts_with(b"%") || text.starts_with(b"//")
        }
        _ => false,
    }
}

/// One cell of a row.
#[derive(Clone, Debug)]
pub(super) struct Field<'a> {
    /// Content without padding and quotes.
    pub text: Cow<'a, [u8]>,
    /// Whether it was quoted.
    pub quoted: bool,
    /// Whether a quote was opened and never closed.
    pub open: bool,
    /// The place of the byte that ends the cell, or the end of the text.
    pub end: usize,
}

/// The cell that starts at `at`. A quoted cell may hold separators, line ends and `""` for a quote.
pub(super) fn field<'a>(text: &'a [u8], at: usize, ends: &Ends) -> Field<'a> {
    let start = ends.skip_blanks(text, at);
    if text.get(start) == Some(&b'"') {
        return quoted(text, start + 1, ends);
    }
    let length = text[start..].iter().position(|&b| ends.is_end(b));
    let end = length.map_or(text.len(), |n| start + n);
    let content = text[start..end].trim_ascii_end();
    Field {
        text: Cow::Borrowed(content),
        quoted: false,
        open: false,
        end,
    }
}

fn quoted<'a>(text: &'a [u8], start: usize, ends: &Ends) -> Field<'a> {
    let mut content: Cow<'a, [u8]> = Cow::Borrowed(&[]);
    let mut from = start;
    loop {
        let Some(quote) = memchr(b'"', &text[from..]).map(|n| from + n) else {
            append(&mut content, &text[from..]);
            return Field {
                text: content,
                quoted: true,
                open: true,
                end: text.len(),
            };
        };
        if text.get(quote + 1) == Some(&b'"') {
            append(&mut content, &text[from..=quote]);
            from = quote + 2;
            continue;
        }
        append(&mut content, &text[from..quote]);
        let length = text[quote + 1..].iter().position(|&b| ends.is_end(b));
        let end = length.map_or(text.len(), |n| quote + 1 + n);
        append(&mut content, text[quote + 1..end].trim_ascii_end());
        return Field {
            text: content,
            quoted: true,
            open: false,
            end,
        };
    }
}

fn append<'a>(content: &mut Cow<'a, [u8]>, more: &'a [u8]) {
    if content.is_empty() {
        *content = Cow::Borrowed(more);
    } else if !more.is_empty() {
        content.to_mut().extend_from_slice(more);
    }
}

/// The cells of one row, at most `limit` of them.
pub(super) fn fields<'a>(row: &'a [u8], ends: &Ends, limit: usize) -> Vec<Field<'a>> {
    let mut cells = Vec::new();
    let mut at = 0;
    while cells.len() < limit {
        if ends.byte.is_none() {
            at = ends.skip_blanks(row, at);
            if at == row.len() {
                break;
            }
        }
        let cell = field(row, at, ends);
        at = cell.end;
        cells.push(cell);
        if at == row.len() || row[at] == ends.row {
            break;
        }
        at += usize::from(ends.byte.is_some());
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn texts(row: &str, separator: Separator) -> Vec<String> {
        let ends = Ends::new(separator, b'\n');
        fields(row.as_bytes(), &ends, usize::MAX)
            .into_iter()
            .map(|f| String::from_utf8(f.text.into_owned()).unwrap())
            .collect()
    }

    #[test]
    fn blanks_pad_and_separate() {
        assert_eq!(texts(" a \t 1  2\t\r", Separator::Blanks), ["a", "1", "2"]);
        assert_eq!(texts(" a , ,b c,", Separator::Comma), ["a", "", "b c", ""]);
        assert_eq!(texts("a\t \tb\r", Separator::Tab), ["a", "", "b"]);
        assert_eq!(texts("\"a b\" 2", Separator::Blanks), ["a b", "2"]);
    }

    proptest! {
        /// Quotes mean what they mean to the csv crate, for cells that are not padded.
        #[test]
        fn quotes_as_the_csv_crate_reads_them(
            row in proptest::collection::vec("[a\"x;,1]{0,5}", 1..6)
        ) {
            let row = row.join(";");
            prop_assume!(!row.is_empty());
            let mut reader = csv::ReaderBuilder::new()
                .delimiter(b';')
                .has_headers(false)
                .flexible(true)
                .from_reader(row.as_bytes());
            let theirs: Vec<String> =
                reader.records().next().unwrap().unwrap().iter().map(str::to_owned).collect();
            prop_assert_eq!(texts(&row, Separator::Semicolon), theirs);
        }

        /// A block is only ever cut where the csv crate ends a record.
        #[test]
        fn cuts_where_records_end(text in "[a\",\n1]{0,40}") {
            let ends = Ends::new(Separator::Comma, b'\n');
            let mut reader = csv::ReaderBuilder::new()
                .has_headers(false)
                .flexible(true)
                .from_reader(text.as_bytes());
            let mut record = csv::ByteRecord::new();
            let mut stops = vec![];
            while reader.read_byte_record(&mut record).unwrap() {
                stops.push(usize::try_from(reader.position().byte()).unwrap());
            }
            if let Some(cut) = ends.last_row_end(text.as_bytes()) {
                // The csv crate skips empty lines after a record; so may the cut.
                let only_blank = |s: usize| s <= cut && text[s..cut].bytes().all(|b| b == b'\n');
                prop_assert!(stops.iter().any(|&s| only_blank(s)) || only_blank(0));
            }
        }
    }
}
