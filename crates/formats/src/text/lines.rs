//! The lines at the head of a file, counted as an editor counts them.

use super::split;

/// One line, or several where a quoted cell holds line ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    /// Number of its first line, from 1.
    pub number: u64,
    /// Where it starts in the head.
    pub start: usize,
    /// Its text without the line end.
    pub text: &'a [u8],
}

impl Line<'_> {
    pub(super) fn is_blank(&self) -> bool {
        self.text.iter().all(u8::is_ascii_whitespace)
    }

    /// Whether it is a remark above the samples, where `;` may start one too.
    pub(super) fn is_comment(&self) -> bool {
        split::is_comment(self.text) || self.text.trim_ascii_start().starts_with(b";")
    }

    /// The text of a remark without the characters that make it one.
    pub(super) fn without_mark(&self) -> Self {
        let text = self.text.trim_ascii_start();
        let marks = text.iter().take_while(|b| b"#%/;".contains(b)).count();
        Line {
            text: text[marks..].trim_ascii_start(),
            ..*self
        }
    }
}

/// Most lines that one quoted cell in the head may span.
const MAX_QUOTED_LINES: usize = 16;

/// The first lines of a head; a last line that is cut off by the end of the head is left out.
pub(super) fn lines(head: &[u8], row_end: u8, whole_file: bool, limit: usize) -> Vec<Line<'_>> {
    let (mut lines, mut start, mut number) = (Vec::new(), 0, 1);
    while start < head.len() && lines.len() < limit {
        let Some(mut end) = end_of_line(head, start, row_end, whole_file) else {
            break;
        };
        let mut spanned = 1;
        if has_open_quote(&head[start..end]) {
            let mut longer = end;
            for count in 2..=MAX_QUOTED_LINES {
                match end_of_line(head, longer + 1, row_end, whole_file) {
                    Some(next) if longer < head.len() => longer = next,
                    _ => break,
                }
                if !has_open_quote(&head[start..longer]) {
                    (end, spanned) = (longer, count);
                    break;
                }
            }
        }
        let text = head[start..end]
            .strip_suffix(b"\r")
            .unwrap_or(&head[start..end]);
        lines.push(Line {
            number,
            start,
            text,
        });
        start = end + 1;
        number += spanned as u64;
    }
    lines
}

fn end_of_line(head: &[u8], start: usize, row_end: u8, whole_file: bool) -> Option<usize> {
    let rest = head.get(start..)?;
    match memchr::memchr(row_end, rest) {
        Some(n) => Some(start + n),
        None if whole_file => Some(head.len()),
        None => None,
    }
}

/// Whether a quote that starts a cell, whatever the separator, is still open at the end.
fn has_open_quote(line: &[u8]) -> bool {
    let mut at = 0;
    let mut cell_start = true;
    while at < line.len() {
        if cell_start && line[at] == b'"' {
            at += 1;
            loop {
                match memchr::memchr(b'"', &line[at..]) {
                    None => return true,
                    Some(n) if line.get(at + n + 1) == Some(&b'"') => at += n + 2,
                    Some(n) => {
                        at += n + 1;
                        break;
                    }
                }
            }
            cell_start = false;
        } else {
            cell_start = b",;|\t ".contains(&line[at]);
            at += 1;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_an_editor() {
        let head = b"\xC3\xA9\r\n\r\n\"a\r\n[s]\",b\r\n1,2";
        let found: Vec<_> = lines(head, b'\n', true, 99)
            .iter()
            .map(|l| (l.number, l.text.to_vec()))
            .collect();
        let expected: Vec<(u64, Vec<u8>)> = vec![
            (1, "é".into()),
            (2, "".into()),
            (3, "\"a\r\n[s]\",b".into()),
            (5, "1,2".into()),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_cut_off_line_is_left_out() {
        assert_eq!(lines(b"1\n2\n3", b'\n', false, 99).len(), 2);
        assert_eq!(lines(b"1\r2\r3", b'\r', true, 99).len(), 3);
        assert_eq!(lines(b"\"open\n1\n2\n", b'\n', true, 99).len(), 3);
    }
}
