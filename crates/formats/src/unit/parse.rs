//! The grammar of a unit: products, quotients, powers and brackets of known symbols.

use super::dimension::{Dimension, Factor};
use super::symbol::{self, Size};
use super::{MAX_UNIT_CHARS, Unit, nearest};
use crate::{Error, Kind};

const SPELLING: &str = "write units as in mm/s, N*m, kg*m^2, um/count";

/// Reads a whole unit.
pub(super) fn unit(text: &str) -> Result<Unit, Error> {
    let text = text.trim();
    let inner = unwrap_brackets(text);
    if inner.is_empty() {
        return Err(Error::new(Kind::Unit, "the unit is empty", SPELLING));
    }
    if inner.chars().count() > MAX_UNIT_CHARS {
        let found = format!("a unit of more than {MAX_UNIT_CHARS} characters");
        return Err(Error::new(Kind::Unit, found, SPELLING));
    }
    let compact: String = inner.chars().filter(|c| !c.is_whitespace()).collect();
    let size = match compact.as_str() {
        "-" => Parser::one(),
        // Of the rated value, as drives of CiA 402 give torque and current.
        "0.1%" | "0,1%" => symbol::per_thousand(),
        "1/min" | "/min" | "min-1" | "min^-1" | "min\u{207b}\u{b9}" => symbol::per_minute(),
        _ => {
            let mut parser = Parser {
                text: inner,
                at: 0,
                depth: 0,
                factors: 0,
            };
            let size = parser.product()?;
            if parser.at < inner.len() {
                let left = &inner[parser.at..];
                return Err(problem(
                    text,
                    &format!("{left:?}, which is not part of a unit"),
                    SPELLING,
                ));
            }
            // An offset means something only for a temperature that stands alone.
            if size.offset != 0.0 && parser.factors > 1 {
                return Err(problem(text, "a Celsius scale inside a product", "use K"));
            }
            size
        }
    };
    let factor = Factor::new(size.mantissa, size.exponent)
        .ok_or_else(|| problem(text, "a factor outside the range of numbers", SPELLING))?;
    Ok(Unit {
        text: text.to_string(),
        dimension: size.dimension,
        factor,
        offset: size.offset,
        note: size.note,
    })
}

/// `[mm]` and `(mm)` as they stand in headers.
fn unwrap_brackets(text: &str) -> &str {
    let inside = |open, close| {
        let inner = text.strip_prefix(open)?.strip_suffix(close)?;
        (!inner.contains([open, close])).then_some(inner.trim())
    };
    inside('[', ']')
        .or_else(|| inside('(', ')'))
        .unwrap_or(text)
}

fn problem(text: &str, what: &str, allowed: &str) -> Error {
    Error::new(Kind::Unit, format!("unit {text:?} has {what}"), allowed)
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    factors: usize,
}

enum Join {
    Times { sign: bool },
    Over,
}

impl Parser<'_> {
    fn one() -> Size {
        Size {
            mantissa: 1.0,
            exponent: 0,
            offset: 0.0,
            dimension: Dimension::ONE,
            note: None,
        }
    }

    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let hit = self.peek() == Some(wanted);
        if hit {
            self.at += wanted.len_utf8();
        }
        hit
    }

    fn blanks(&mut self) {
        while let Some(c) = self.peek().filter(|c| c.is_whitespace()) {
            self.at += c.len_utf8();
        }
    }

    fn wrong(&self, what: &str, allowed: &str) -> Error {
        problem(self.text, what, allowed)
    }

    fn product(&mut self) -> Result<Size, Error> {
        self.blanks();
        // `1/s`, and `/s` after a number.
        let bare = self.peek() == Some('/');
        let mut total = if bare || self.take('1') {
            Self::one()
        } else {
            self.factor()?
        };
        let mut divided = false;
        while let Some(join) = self.join() {
            match join {
                Join::Over => {
                    let next = self.factor()?;
                    total = self.combine(total, next, -1)?;
                    divided = true;
                }
                Join::Times { sign } => {
                    if divided && !sign {
                        let advice = "put the numerator first (N s/m) or use brackets (N/(m s))";
                        return Err(
                            self.wrong("a factor after a division without an operator", advice)
                        );
                    }
                    let next = self.factor()?;
                    total = self.combine(total, next, 1)?;
                }
            }
        }
        Ok(total)
    }

    /// The sign between two factors; none at the end or before a closing bracket.
    fn join(&mut self) -> Option<Join> {
        let blank = self.peek().is_some_and(char::is_whitespace);
        self.blanks();
        let rest = &self.text[self.at..];
        let next = rest.chars().next()?;
        match next {
            ')' => None,
            '/' => {
                self.at += 1;
                Some(Join::Over)
            }
            '*' | '.' | '\u{b7}' | '\u{22c5}' | '\u{d7}' => {
                self.at += next.len_utf8();
                Some(Join::Times { sign: true })
            }
            '-' if rest[1..].chars().next().is_some_and(is_symbol) => {
                self.at += 1;
                Some(Join::Times { sign: false })
            }
            _ if blank || next == '(' => Some(Join::Times { sign: false }),
            _ => None,
        }
    }

    fn factor(&mut self) -> Result<Size, Error> {
        self.blanks();
        self.factors += 1;
        if self.take('(') {
            self.depth += 1;
            if self.depth > 8 {
                return Err(self.wrong("brackets more than 8 deep", SPELLING));
            }
            let inner = self.product()?;
            self.blanks();
            if !self.take(')') {
                return Err(self.wrong("an unclosed bracket", SPELLING));
            }
            self.depth -= 1;
            let power = self.power()?;
            return self.combine(Self::one(), inner, power);
        }
        let start = self.at;
        while let Some(c) = self.peek().filter(|c| is_symbol(*c)) {
            self.at += c.len_utf8();
        }
        let run = &self.text[start..self.at];
        if run.is_empty() {
            let what = match self.peek() {
                Some(c) => format!("{c:?} where a symbol should be"),
                None => "no symbol at its end".to_string(),
            };
            return Err(self.wrong(&what, SPELLING));
        }
        if let Some(turn) = symbol::turn(run).filter(|_| self.before_time()) {
            return Ok(turn);
        }
        if let Some(size) = symbol::lookup(run) {
            let power = self.power()?;
            return if power == 1 {
                Ok(size)
            } else {
                self.combine(Self::one(), size, power)
            };
        }
        if let Some((left, right)) = symbol::split(run) {
            self.factors += 1;
            let power = self.power()?;
            return self.combine(left, right, power);
        }
        Err(unknown(run))
    }

    /// Whether `/min` or `/s` follows.
    fn before_time(&self) -> bool {
        let Some(rest) = self.text[self.at..].trim_start().strip_prefix('/') else {
            return false;
        };
        let rest = rest.trim_start();
        let end = rest.find(|c| !is_symbol(c)).unwrap_or(rest.len());
        matches!(&rest[..end], "min" | "s")
    }

    /// A power after a symbol or bracket: `2`, `-1`, `^2`, `**2`, `^(-1)`, superscripts; one if none.
    fn power(&mut self) -> Result<i32, Error> {
        let rest = &self.text[self.at..];
        let marked = rest.strip_prefix('^').or_else(|| rest.strip_prefix("**"));
        let body = marked.unwrap_or(rest);
        let bracket = marked.is_some() && body.starts_with('(');
        let body = if bracket { &body[1..] } else { body };
        let mut digits = String::new();
        let mut used = 0;
        for c in body.chars() {
            let plain = match c {
                '-' | '\u{207b}' | '\u{2212}' if digits.is_empty() => '-',
                '+' if digits.is_empty() && marked.is_some() => '+',
                '0'..='9' => c,
                _ => match SUPERSCRIPTS.iter().position(|s| *s == c) {
                    Some(digit) => char::from(b"0123456789"[digit]),
                    None => break,
                },
            };
            digits.push(plain);
            used += c.len_utf8();
        }
        let after = &body[used..];
        let no_digits = !digits.contains(|c: char| c.is_ascii_digit());
        // A minus without digits joins two symbols (`N-m`); it is not a power.
        if marked.is_none() && no_digits {
            return Ok(1);
        }
        let closed = !bracket || after.starts_with(')');
        let power = digits
            .parse::<i32>()
            .ok()
            .filter(|p| *p != 0 && p.abs() <= 12 && closed);
        let left = after.len() - usize::from(bracket && closed);
        self.at = self.text.len() - left;
        power.ok_or_else(|| self.wrong("a power that is not a whole number from 1 to 12", SPELLING))
    }

    /// `total * next^power`.
    fn combine(&self, total: Size, next: Size, power: i32) -> Result<Size, Error> {
        let dimension = next
            .dimension
            .power(power)
            .and_then(|d| total.dimension.times(d))
            .ok_or_else(|| self.wrong("powers that no physical quantity has", SPELLING))?;
        let mut mantissa = total.mantissa;
        for _ in 0..power.abs() {
            mantissa = if power > 0 {
                mantissa * next.mantissa
            } else {
                mantissa / next.mantissa
            };
        }
        Ok(Size {
            mantissa,
            exponent: total.exponent + next.exponent * power,
            offset: total.offset + next.offset,
            dimension,
            note: total.note.or(next.note),
        })
    }
}

const SUPERSCRIPTS: [char; 10] = [
    '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}',
    '\u{2078}', '\u{2079}',
];

fn is_symbol(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '%' | '\u{2030}' | '\u{b0}' | '\u{2103}' | '_')
}

fn unknown(run: &str) -> Error {
    let near = nearest(run, symbol::COMMON.split(", "));
    let allowed = if near.is_empty() {
        format!(
            "known units are s, m, rad, deg, rpm, N, A, V, kg, counts, % and similar ones; {SPELLING}"
        )
    } else {
        format!("similar: {}; {SPELLING}", near.join(", "))
    };
    Error::new(Kind::Unit, format!("unknown unit {run:?}"), allowed)
}
