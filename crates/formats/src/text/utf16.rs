//! UTF-16 turned into UTF-8 while it is read.

use std::io::{self, Read};

/// A UTF-16 source after its byte order mark, read as UTF-8. A lone surrogate or a cut-off last
/// unit becomes U+FFFD.
pub(super) struct Utf16<R> {
    inner: R,
    big_endian: bool,
    /// Odd byte of a unit that was cut by the last read.
    odd: Option<u8>,
    /// First half of a character beyond the basic plane.
    high: Option<u16>,
    ready: Vec<u8>,
    taken: usize,
}

impl<R: Read> Utf16<R> {
    pub(super) fn new(inner: R, big_endian: bool) -> Self {
        Self {
            inner,
            big_endian,
            odd: None,
            high: None,
            ready: Vec::new(),
            taken: 0,
        }
    }

    /// Decodes the next piece; false at the end.
    fn refill(&mut self) -> io::Result<bool> {
        self.ready.clear();
        self.taken = 0;
        let mut raw = [0_u8; 16 * 1024];
        let count = loop {
            match self.inner.read(&mut raw) {
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                other => break other?,
            }
        };
        if count == 0 {
            let cut = self.odd.take().is_some() | self.high.take().is_some();
            if cut {
                self.push(char::REPLACEMENT_CHARACTER);
            }
            return Ok(cut);
        }
        for &byte in &raw[..count] {
            match self.odd.take() {
                None => self.odd = Some(byte),
                Some(first) if self.big_endian => self.unit(u16::from_be_bytes([first, byte])),
                Some(first) => self.unit(u16::from_le_bytes([first, byte])),
            }
        }
        Ok(true)
    }

    fn unit(&mut self, unit: u16) {
        let units = self.high.take().into_iter().chain([unit]);
        if (0xD800..0xDC00).contains(&unit) {
            if units.count() > 1 {
                self.push(char::REPLACEMENT_CHARACTER);
            }
            self.high = Some(unit);
            return;
        }
        for decoded in char::decode_utf16(units) {
            self.push(decoded.unwrap_or(char::REPLACEMENT_CHARACTER));
        }
    }

    fn push(&mut self, character: char) {
        self.ready
            .extend_from_slice(character.encode_utf8(&mut [0; 4]).as_bytes());
    }
}

impl<R: Read> Read for Utf16<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        while self.taken == self.ready.len() {
            if !self.refill()? {
                return Ok(0);
            }
        }
        let count = out.len().min(self.ready.len() - self.taken);
        out[..count].copy_from_slice(&self.ready[self.taken..self.taken + count]);
        self.taken += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives one byte at a time, so that every unit and pair is cut.
    struct Drip<'a>(&'a [u8]);

    impl Read for Drip<'_> {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            self.0.read(&mut out[..1])
        }
    }

    #[test]
    fn agrees_with_the_standard_library() {
        let mut units: Vec<u16> = "Zeit [µs]\t𝄞 Δx\r\n".encode_utf16().collect();
        units.extend([0xD800, 0x41, 0xDC00, 0xD800, 0xD834, 0xDD1E, 0xD800]);
        let expected = String::from_utf16_lossy(&units);
        for big_endian in [false, true] {
            let encode = |u: &u16| {
                if big_endian {
                    u.to_be_bytes()
                } else {
                    u.to_le_bytes()
                }
            };
            let bytes: Vec<u8> = units.iter().flat_map(encode).collect();
            let mut text = String::new();
            Utf16::new(Drip(&bytes), big_endian)
                .read_to_string(&mut text)
                .unwrap();
            assert_eq!(text, expected);
        }
    }
}
