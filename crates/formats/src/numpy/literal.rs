//! The Python literal that heads an NPY file.
//!
//! Only what NumPy writes there: strings, whole numbers, `True`, `False`, lists, tuples and one
//! dictionary. Every value is looked at once and nesting is limited, so a hostile header costs no
//! more than its length.

/// A value of the header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Literal {
    Text(String),
    Whole(u64),
    Truth(bool),
    /// A list or a tuple; NumPy's own reader tells them apart nowhere it matters.
    Sequence(Vec<Literal>),
    Dictionary(Vec<(String, Literal)>),
}

/// Deepest nesting of lists and tuples; a record in a record takes two levels.
const MAX_DEPTH: usize = 16;

/// Parses the whole of `text`; the error says what is wrong and where.
pub(super) fn parse(text: &str) -> Result<Literal, String> {
    let mut parser = Parser { text, at: 0 };
    let value = parser.value(0)?;
    parser.blank();
    match parser.peek() {
        None => Ok(value),
        Some(other) => Err(parser.wrong(other)),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
}

impl Parser<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn next(&mut self) -> Option<char> {
        let next = self.peek()?;
        self.at += next.len_utf8();
        Some(next)
    }

    fn blank(&mut self) {
        while self.peek().is_some_and(char::is_whitespace) {
            self.next();
        }
    }

    fn wrong(&self, found: char) -> String {
        format!(
            "unexpected {found:?} at character {} of the header",
            self.at
        )
    }

    fn take(&mut self, word: &str) -> bool {
        let found = self.text[self.at..].starts_with(word);
        if found {
            self.at += word.len();
        }
        found
    }

    fn value(&mut self, depth: usize) -> Result<Literal, String> {
        if depth > MAX_DEPTH {
            return Err(format!(
                "the header is nested deeper than {MAX_DEPTH} levels"
            ));
        }
        self.blank();
        match self.peek().ok_or("the header ends early")? {
            '\'' | '"' => self.text().map(Literal::Text),
            '0'..='9' => self.whole().map(Literal::Whole),
            '[' => self.sequence(']', depth),
            '(' => self.sequence(')', depth),
            '{' => self.dictionary(depth),
            _ if self.take("True") => Ok(Literal::Truth(true)),
            _ if self.take("False") => Ok(Literal::Truth(false)),
            other => Err(self.wrong(other)),
        }
    }

    fn text(&mut self) -> Result<String, String> {
        let quote = self.next();
        let mut out = String::new();
        loop {
            match self.next().ok_or("the header ends inside a string")? {
                c if Some(c) == quote => return Ok(out),
                '\\' => out.push(self.escaped()?),
                c => out.push(c),
            }
        }
    }

    fn escaped(&mut self) -> Result<char, String> {
        let kind = self.next().ok_or("the header ends inside a string")?;
        let digits = match kind {
            'n' => return Ok('\n'),
            't' => return Ok('\t'),
            'r' => return Ok('\r'),
            '\\' | '\'' | '"' => return Ok(kind),
            'x' => 2,
            'u' => 4,
            'U' => 8,
            other => return Err(format!("unknown escape \\{other} in the header")),
        };
        let code = self.text.get(self.at..self.at + digits);
        self.at += digits;
        code.and_then(|code| u32::from_str_radix(code, 16).ok())
            .and_then(char::from_u32)
            .ok_or_else(|| "broken escape in a string of the header".to_owned())
    }

    fn whole(&mut self) -> Result<u64, String> {
        let start = self.at;
        while self.peek().is_some_and(|c| c.is_ascii_digit()) {
            self.next();
        }
        let digits = &self.text[start..self.at];
        // Python 2 wrote long integers as `3L`.
        self.take("L");
        digits
            .parse()
            .map_err(|_| format!("{digits} in the header is too large"))
    }

    fn sequence(&mut self, close: char, depth: usize) -> Result<Literal, String> {
        self.next();
        let mut items = Vec::new();
        loop {
            self.blank();
            if self.peek() == Some(close) {
                self.next();
                return Ok(Literal::Sequence(items));
            }
            items.push(self.value(depth + 1)?);
            self.comma(close)?;
        }
    }

    fn dictionary(&mut self, depth: usize) -> Result<Literal, String> {
        self.next();
        let mut items = Vec::new();
        loop {
            self.blank();
            match self.peek() {
                Some('}') => {
                    self.next();
                    return Ok(Literal::Dictionary(items));
                }
                Some('\'' | '"') => {
                    let key = self.text()?;
                    self.blank();
                    match self.next() {
                        Some(':') => items.push((key, self.value(depth + 1)?)),
                        _ => return Err(format!("no ':' after {key:?} in the header")),
                    }
                    self.comma('}')?;
                }
                Some(other) => return Err(self.wrong(other)),
                None => return Err("the header ends early".to_owned()),
            }
        }
    }

    /// A comma, or the closing bracket that is left for the caller.
    fn comma(&mut self, close: char) -> Result<(), String> {
        self.blank();
        match self.peek() {
            Some(',') => {
                self.next();
                Ok(())
            }
            Some(c) if c == close => Ok(()),
            Some(other) => Err(self.wrong(other)),
            None => Err("the header ends early".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_numpy_writes() {
        let header = "{'descr': [('a', '<f8'), ('b\\u00e9', '<i4', (2,))], \
                      'fortran_order': False, 'shape': (3L, 4), }   \n";
        let Literal::Dictionary(items) = parse(header).unwrap() else {
            panic!("no dictionary");
        };
        assert_eq!(items.len(), 3);
        assert_eq!(items[1].1, Literal::Truth(false));
        let shape = vec![Literal::Whole(3), Literal::Whole(4)];
        assert_eq!(items[2].1, Literal::Sequence(shape));
        let Literal::Sequence(fields) = &items[0].1 else {
            panic!("no fields");
        };
        let name = Literal::Text("b\u{e9}".to_owned());
        assert!(matches!(&fields[1], Literal::Sequence(f) if f[0] == name));
    }

    #[test]
    fn deep_nesting_is_refused_at_once() {
        for open in ["[", "(", "{'a':"] {
            assert!(parse(&open.repeat(100_000)).unwrap_err().contains("deeper"));
        }
    }

    #[test]
    fn broken_text_says_where() {
        assert!(parse("{'a': 1 2}").unwrap_err().contains("character 8"));
        assert!(parse("99999999999999999999999").is_err());
        assert!(parse("'\\u12").is_err());
        assert!(parse("'\\uéé'").is_err());
        assert!(parse("").is_err());
    }
}
