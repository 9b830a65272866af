//! NumPy's data types, as far as they hold numbers.

use super::literal::Literal;
use crate::binary::{ByteOrder, Cell, Class, Clock, Field, Number, Period, Record};

/// What one element of an array is.
#[derive(Clone, Debug)]
pub(super) enum Dtype {
    Number(Number),
    /// `datetime64` and `timedelta64`: a 64-bit count.
    Ticks(ByteOrder, Period, Clock),
    Record(Record),
    /// Not numbers, and what it is instead.
    Other(String),
}

/// Most elements of an array inside a record; each becomes a column of its own.
const MAX_SUBARRAY: u64 = 1024;

impl Dtype {
    /// From the `descr` of a header.
    pub(super) fn new(descr: &Literal) -> Result<Self, String> {
        match descr {
            Literal::Text(code) => Ok(Plain::new(code)?.dtype),
            Literal::Sequence(items) => {
                let mut fields = Vec::new();
                let bytes = flatten("", items, 0, &mut fields)?;
                Ok(match Record::new(bytes, fields) {
                    Some(record) => Dtype::Record(record),
                    None => Dtype::Other(format!("records of {bytes} bytes")),
                })
            }
            _ => Err("'descr' is neither a type nor a list of fields".to_owned()),
        }
    }
}

/// A type without parts, and how many bytes it takes.
struct Plain {
    dtype: Dtype,
    bytes: usize,
}

impl Plain {
    /// From a code such as `<f8`.
    fn new(code: &str) -> Result<Self, String> {
        let bad = || format!("unknown type {code:?}");
        let order = match code.chars().next() {
            Some('<' | '|' | '=') => ByteOrder::Little,
            Some('>') => ByteOrder::Big,
            _ => return Err(bad()),
        };
        let kind = code[1..].chars().next().ok_or_else(bad)?;
        let rest = &code[1 + kind.len_utf8()..];
        let (size, unit) = rest.split_at(rest.find('[').unwrap_or(rest.len()));
        let size: usize = match (size, kind) {
            ("", 'O') => 8,
            ("", '?') => 1,
            (size, _) => size.parse().map_err(|_| bad())?,
        };
        let number = |class| match Number::new(class, size, order) {
            Some(number) => Dtype::Number(number),
            None => Dtype::Other(format!("numbers of type {code}, not supported")),
        };
        let other = |what: &str| Dtype::Other(what.to_owned());
        let dtype = match kind {
            'f' => number(Class::Float),
            'i' => number(Class::Signed),
            'u' => number(Class::Unsigned),
            'b' | '?' => number(Class::Bool),
            'M' | 'm' if size == 8 => match period(unit) {
                Some(period) => Dtype::Ticks(order, period, clock(kind)),
                None => Dtype::Other(format!("times of type {code}, not supported")),
            },
            'S' | 'a' | 'U' => other("text"),
            'c' => other("complex numbers; save their parts as columns"),
            'O' => other("Python objects (pickled), which are never loaded"),
            'V' => other("raw bytes"),
            _ => return Err(bad()),
        };
        let bytes = match kind {
            'U' => size.checked_mul(4).ok_or_else(bad)?,
            _ => size,
        };
        Ok(Self { dtype, bytes })
    }
}

fn clock(kind: char) -> Clock {
    if kind == 'M' {
        Clock::Epoch
    } else {
        Clock::Duration
    }
}

/// `[ns]`, `[10us]`; months and years have no fixed length.
fn period(unit: &str) -> Option<Period> {
    let unit = unit.strip_prefix('[')?.strip_suffix(']')?;
    let (times, unit) = unit.split_at(unit.find(|c: char| !c.is_ascii_digit())?);
    let times: u64 = if times.is_empty() {
        1
    } else {
        times.parse().ok()?
    };
    let (seconds, over) = match unit {
        "W" => (604_800, 1),
        "D" => (86_400, 1),
        "h" => (3_600, 1),
        "m" => (60, 1),
        "s" => (1, 1),
        "ms" => (1, 1_000),
        "us" => (1, 1_000_000),
        "ns" => (1, 1_000_000_000),
        "ps" => (1, 1_000_000_000_000),
        "fs" => (1, 1_000_000_000_000_000),
        "as" => (1, 1_000_000_000_000_000_000),
        _ => return None,
    };
    Some(Period {
        times: times.checked_mul(seconds)?,
        over,
    })
}

/// Appends the fields of a record that starts at `offset`; returns the bytes that the record takes.
fn flatten(
    prefix: &str,
    items: &[Literal],
    offset: usize,
    out: &mut Vec<Field>,
) -> Result<usize, String> {
    let mut bytes = 0usize;
    for item in items {
        let Literal::Sequence(parts) = item else {
            return Err("a field is not a tuple of name and type".to_owned());
        };
        let (name, kind, shape) = match &parts[..] {
            [name, kind] => (name, kind, &[][..]),
            [name, kind, Literal::Sequence(shape)] => (name, kind, &shape[..]),
            [name, kind, shape @ Literal::Whole(_)] => (name, kind, std::slice::from_ref(shape)),
            _ => return Err("a field is not a tuple of name, type and shape".to_owned()),
        };
        let name = match name {
            Literal::Text(name) => name,
            // (title, name)
            Literal::Sequence(both) => match &both[..] {
                [_, Literal::Text(name)] => name,
                _ => return Err("a field has no name".to_owned()),
            },
            _ => return Err("a field has no name".to_owned()),
        };
        let path = match prefix {
            "" => name.clone(),
            prefix => format!("{prefix}.{name}"),
        };
        let copies = shape.iter().try_fold(1u64, |n, dim| match dim {
            Literal::Whole(dim) => n.checked_mul(*dim),
            _ => None,
        });
        let copies = copies.ok_or_else(|| format!("field {path} has an impossible shape"))?;
        let size = cells(&path, kind, copies, offset + bytes, out)?;
        bytes = usize::try_from(copies)
            .ok()
            .and_then(|copies| copies.checked_mul(size))
            .and_then(|size| size.checked_add(bytes))
            .filter(|&bytes| bytes <= 1 << 40)
            .ok_or_else(|| format!("field {path} is impossibly large"))?;
    }
    Ok(bytes)
}

/// Appends the cells of one field, and returns the bytes of one of its `copies`.
fn cells(
    path: &str,
    kind: &Literal,
    copies: u64,
    offset: usize,
    out: &mut Vec<Field>,
) -> Result<usize, String> {
    let mut other = |what: &str| {
        out.push(Field {
            name: path.to_owned(),
            offset,
            cell: Cell::Other(what.to_owned()),
        });
    };
    let code = match kind {
        Literal::Sequence(items) if copies == 1 => return flatten(path, items, offset, out),
        Literal::Sequence(items) => {
            other("an array of records");
            return flatten(path, items, 0, &mut Vec::new());
        }
        Literal::Text(code) => code,
        _ => return Err(format!("field {path} has no type")),
    };
    let Plain { dtype, bytes } = Plain::new(code)?;
    match dtype {
        Dtype::Number(_) if copies > MAX_SUBARRAY => other("an array with too many elements"),
        Dtype::Number(number) => {
            for copy in 0..copies as usize {
                out.push(Field {
                    name: match copies {
                        1 => path.to_owned(),
                        _ => format!("{path}(:,{})", copy + 1),
                    },
                    offset: offset + copy * bytes,
                    cell: Cell::Number(number),
                });
            }
        }
        Dtype::Other(what) => {
            // Unnamed raw bytes only fill a gap between aligned fields.
            if !(code.contains('V') && path.rsplit('.').next() == Some("")) {
                other(&what);
            }
        }
        Dtype::Ticks(..) => other("times inside a record"),
        Dtype::Record(_) => {}
    }
    Ok(bytes)
}
