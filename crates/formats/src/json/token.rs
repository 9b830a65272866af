//! The tokens of JSON text, read from a stream that is never held as a whole.

use std::io::Read;

use crate::{Error, Kind};

/// Longest key in bytes.
const MAX_KEY: usize = 4096;

/// Longest number that is parsed; the decimal expansion of the smallest f64 has 1077 characters.
const MAX_NUMBER: usize = 2048;

/// How much of a text is kept: more than any number or date has.
const KEPT_TEXT: usize = 64;

/// Bytes that are read at once.
const BLOCK: usize = 1 << 16;

/// What begins at a place of the text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token {
    Object,
    Array,
    /// A number, and whether it is an integer that `f64` cannot hold.
    Number(f64, bool),
    /// `true` or `false`.
    Truth(bool),
    Null,
    /// A text; how it begins is in [`Tokens::text`].
    Text,
}

/// A stream of JSON text.
pub(super) struct Tokens<R> {
    reader: R,
    block: Vec<u8>,
    used: usize,
    /// Bytes before the block.
    before: u64,
    row: u64,
    text: Vec<u8>,
}

impl<R: Read> Tokens<R> {
    pub(super) fn new(reader: R) -> Self {
        Self {
            reader,
            block: Vec::new(),
            used: 0,
            before: 0,
            row: 1,
            text: Vec::new(),
        }
    }

    /// Takes the mark of UTF-8, if the file begins with it.
    pub(super) fn byte_order_mark(&mut self) -> Result<(), Error> {
        self.peek()?;
        if self.block.starts_with(b"\xef\xbb\xbf") {
            self.used = 3;
        }
        Ok(())
    }

    /// The key or text that was read last; of a text only how it begins.
    pub(super) fn text(&self) -> &[u8] {
        &self.text
    }

    /// The line that is being read, counted from 1.
    pub(super) fn row(&self) -> u64 {
        self.row
    }

    /// An error at the place that is being read.
    pub(super) fn bad(&self, found: impl Into<String>) -> Error {
        Error::new(Kind::Format, found, "JSON, or one JSON value in every line")
            .at_line(self.row)
            .at_byte(self.before + self.used as u64)
    }

    fn peek(&mut self) -> Result<Option<u8>, Error> {
        if self.used == self.block.len() {
            self.before += self.block.len() as u64;
            self.used = 0;
            self.block.clear();
            let read = (&mut self.reader)
                .take(BLOCK as u64)
                .read_to_end(&mut self.block);
            read.map_err(|error| {
                Error::new(Kind::Io, format!("cannot be read ({error})"), "").at_byte(self.before)
            })?;
        }
        Ok(self.block.get(self.used).copied())
    }

    fn next(&mut self) -> Result<Option<u8>, Error> {
        let byte = self.peek()?;
        self.used += usize::from(byte.is_some());
        Ok(byte)
    }

    /// The next byte that is not blank, which is not taken.
    pub(super) fn ahead(&mut self) -> Result<Option<u8>, Error> {
        loop {
            match self.peek()? {
                Some(b'\n') => self.row += 1,
                Some(b' ' | b'\t' | b'\r') => {}
                other => return Ok(other),
            }
            self.used += 1;
        }
    }

    /// Takes this byte if it is the next one that is not blank.
    pub(super) fn take(&mut self, byte: u8) -> Result<bool, Error> {
        let there = self.ahead()? == Some(byte);
        self.used += usize::from(there);
        Ok(there)
    }

    /// What is in the way where something else has to stand.
    pub(super) fn instead_of(&mut self, wanted: &str) -> Error {
        match self.ahead() {
            Err(error) => error,
            Ok(None) => self.bad(format!("the file ends where {wanted} has to follow")),
            Ok(Some(byte)) => {
                let found = byte.escape_ascii();
                self.bad(format!("`{found}` where {wanted} has to stand"))
            }
        }
    }

    /// Begins a value; of an object or array only the bracket is taken.
    pub(super) fn value(&mut self) -> Result<Token, Error> {
        match self.ahead()? {
            Some(b'{') => {
                self.used += 1;
                Ok(Token::Object)
            }
            Some(b'[') => {
                self.used += 1;
                Ok(Token::Array)
            }
            Some(b'"') => {
                self.quoted(KEPT_TEXT)?;
                Ok(Token::Text)
            }
            Some(b'-' | b'0'..=b'9') => self.number(),
            Some(b'a'..=b'z' | b'A'..=b'Z') => self.word(false),
            _ => Err(self.instead_of("a value")),
        }
    }

    /// A key and its colon; the key is left in [`Tokens::text`].
    pub(super) fn key(&mut self) -> Result<(), Error> {
        if self.ahead()? != Some(b'"') {
            return Err(self.instead_of("a quoted key"));
        }
        self.quoted(MAX_KEY)?;
        if self.text.len() >= MAX_KEY {
            return Err(self.bad(format!("a key of more than {MAX_KEY} bytes")));
        }
        match self.take(b':')? {
            true => Ok(()),
            false => Err(self.instead_of("`:`")),
        }
    }

    /// Reads what is between quotes, and keeps this much of it.
    fn quoted(&mut self, keep: usize) -> Result<(), Error> {
        self.text.clear();
        self.used += 1;
        loop {
            let mut scratch = [0; 4];
            let part = match self.next()? {
                None => return Err(self.bad("the file ends within a text")),
                Some(b'"') => return Ok(()),
                Some(b'\\') => self.escape()?.encode_utf8(&mut scratch).as_bytes(),
                Some(byte) if byte < b' ' => {
                    self.used -= 1;
                    return Err(self.bad("a line or control character within a text"));
                }
                Some(byte) => {
                    scratch[0] = byte;
                    &scratch[..1]
                }
            };
            if self.text.len() < keep {
                self.text.extend_from_slice(part);
            }
        }
    }

    fn escape(&mut self) -> Result<char, Error> {
        Ok(match self.next()? {
            Some(b'n') => '\n',
            Some(b't') => '\t',
            Some(b'r') => '\r',
            Some(b'b') => '\u{8}',
            Some(b'f') => '\u{c}',
            Some(byte @ (b'"' | b'\\' | b'/')) => char::from(byte),
            Some(b'u') => {
                let first = self.four()?;
                // Outside of the plane of 16 bits two halves stand for one character.
                let pair = (0xd800..0xdc00).contains(&first) && self.peek()? == Some(b'\\');
                let code = if pair {
                    self.used += 1;
                    match self.next()? {
                        Some(b'u') => {
                            let second = self.four()?;
                            let low = second.wrapping_sub(0xdc00) & 0x3ff;
                            0x10000 + ((first - 0xd800) << 10 | low)
                        }
                        _ => return Err(self.bad("half a character in a text")),
                    }
                } else {
                    first
                };
                char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER)
            }
            _ => return Err(self.bad("an unknown escape in a text")),
        })
    }

    fn four(&mut self) -> Result<u32, Error> {
        let mut code = 0;
        for _ in 0..4 {
            let digit = self.next()?.and_then(|byte| char::from(byte).to_digit(16));
            match digit {
                Some(digit) => code = code << 4 | digit,
                None => return Err(self.bad("an escape without four hexadecimal digits")),
            }
        }
        Ok(code)
    }

    fn number(&mut self) -> Result<Token, Error> {
        self.text.clear();
        while let Some(byte @ (b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E')) = self.peek()? {
            self.text.push(byte);
            self.used += 1;
            if self.text.len() > MAX_NUMBER {
                return Err(self.bad(format!("a number of more than {MAX_NUMBER} characters")));
            }
        }
        if self.text == b"-" {
            return self.word(true);
        }
        match fast_float2::parse(&self.text) {
            Ok(value) => Ok(Token::Number(value, rounded(&self.text, value))),
            Err(_) => {
                let found = self.text.escape_ascii();
                Err(self.bad(format!("`{found}` where a number has to stand")))
            }
        }
    }

    /// `true`, `false`, `null`, and the infinities and NaN that Python and printf write.
    fn word(&mut self, negative: bool) -> Result<Token, Error> {
        self.text.clear();
        while let Some(byte) = self.peek()?.filter(u8::is_ascii_alphanumeric) {
            self.text.push(byte);
            self.used += 1;
            if self.text.len() > KEPT_TEXT {
                break;
            }
        }
        Ok(match (&self.text[..], negative) {
            (b"true", false) => Token::Truth(true),
            (b"false", false) => Token::Truth(false),
            (b"null", false) => Token::Null,
            (b"NaN" | b"nan", _) => Token::Number(f64::NAN, false),
            (b"Infinity" | b"inf", false) => Token::Number(f64::INFINITY, false),
            (b"Infinity" | b"inf", true) => Token::Number(f64::NEG_INFINITY, false),
            (word, _) => {
                let found = word.escape_ascii();
                return Err(self.bad(format!("`{found}` where a value has to stand")));
            }
        })
    }
}

/// Whether this is an integer that the double nearest to it does not hold.
fn rounded(text: &[u8], value: f64) -> bool {
    const EXACT_DIGITS: usize = 15;
    let whole = |text: &[u8]| std::str::from_utf8(text).ok()?.parse::<i128>().ok();
    text.len() > EXACT_DIGITS && whole(text).is_some_and(|whole| value as i128 != whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(text: &str) -> Result<Token, Error> {
        Tokens::new(text.as_bytes()).value()
    }

    #[test]
    fn numbers_and_words() {
        assert_eq!(one(" -0.25e2,").unwrap(), Token::Number(-25.0, false));
        assert_eq!(
            one("9007199254740993").unwrap(),
            Token::Number(9007199254740992.0, true)
        );
        assert_eq!(
            one("9007199254740992").unwrap(),
            Token::Number(9007199254740992.0, false)
        );
        assert_eq!(
            one("-Infinity").unwrap(),
            Token::Number(f64::NEG_INFINITY, false)
        );
        assert_eq!(one("true").unwrap(), Token::Truth(true));
        for wrong in ["1.2.3", "--1", "nul", "+1", "", "-true", "1e", "]"] {
            assert!(one(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn texts() {
        let read = |text: &str| {
            let mut tokens = Tokens::new(text.as_bytes());
            tokens
                .value()
                .map(|_| String::from_utf8(tokens.text().to_vec()).unwrap())
        };
        assert_eq!(
            read(r#""a\"b\u00e9\ud83d\ude00""#).unwrap(),
            "a\"b\u{e9}\u{1f600}"
        );
        for wrong in ["\"a", "\"a\nb\"", r#""\x""#, r#""\u12g4""#, r#""\ud800\n""#] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_place_is_told() {
        let mut tokens = Tokens::new(&b"\n\n  ?"[..]);
        let error = tokens.value().unwrap_err();
        assert_eq!((error.place.row, error.place.byte), (Some(3), Some(4)));
    }
}
