//! What the columns of an Arrow file are: its schema, flattened to the columns that buffers are stored for.

use super::flat::Table;
use crate::Error;
use crate::binary::{ByteOrder, Class, Clock, Collector, Number, Period};

/// Deepest nesting of fields.
const MAX_DEPTH: usize = 32;

/// Lists that are not read.
const LISTS: Kind = Kind::Other("a list in every row", 2, true);

/// Bytes of all names together.
const MAX_NAMES: usize = 8 << 20;

/// One field, with those below it.
pub(super) struct Field {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    pub(super) kind: Kind,
    pub(super) children: Vec<Field>,
}

/// How a field is stored, and what its values mean.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Number(Number),
    /// Bits.
    Truth,
    /// Counts of this many bytes.
    Ticks(usize, Period, Clock),
    /// 128-bit integers in units of 10^-scale.
    Decimal(u32),
    Structure,
    /// As many elements in every row.
    Fixed(u64),
    /// Numbers in every row, as many as offsets of this many bytes say.
    List(usize),
    /// Not numbers, what it is, how many buffers stand for it, and whether the fields below are stored.
    Other(&'static str, usize, bool),
    /// Text or bytes whose number of buffers is said in every batch.
    View(&'static str),
}

impl Kind {
    /// Buffers of the field itself.
    pub(super) fn buffers(&self) -> usize {
        match self {
            Kind::Number(_) | Kind::Truth | Kind::Ticks(..) | Kind::Decimal(_) | Kind::View(_) => 2,
            Kind::List(_) => 2,
            Kind::Structure | Kind::Fixed(_) => 1,
            Kind::Other(_, buffers, _) => *buffers,
        }
    }
}

/// Reads the fields of a schema; `None` where it is damaged.
pub(super) fn fields(
    schema: Table<'_>,
    collector: &mut Collector,
) -> Option<Result<Vec<Field>, Error>> {
    let order = match schema.short(0, 0)? {
        0 => ByteOrder::Little,
        _ => ByteOrder::Big,
    };
    let mut names = MAX_NAMES;
    let below = Below {
        order,
        field: 1,
        depth: 0,
    };
    below.read(schema, "", &mut names, collector)
}

struct Below {
    order: ByteOrder,
    /// Which field of the table has the fields below it.
    field: usize,
    depth: usize,
}

impl Below {
    fn read(
        &self,
        table: Table<'_>,
        prefix: &str,
        names: &mut usize,
        collector: &mut Collector,
    ) -> Option<Result<Vec<Field>, Error>> {
        if self.depth > MAX_DEPTH {
            return None;
        }
        let all = table.vector(self.field, 4)?;
        let mut out = Vec::new();
        for index in 0..all.len {
            if let Err(error) = collector.entry() {
                return Some(Err(error));
            }
            let field = all.table(index)?;
            let own = field.text(0)?;
            let name = match prefix {
                "" => own,
                prefix => format!("{prefix}.{own}"),
            };
            *names = names.checked_sub(name.len())?;
            let kind = self.kind(field)?;
            let below = Below {
                order: self.order,
                field: 5,
                depth: self.depth + 1,
            };
            // Of a dictionary the indices are stored, not what is below its values.
            let inside = match kind {
                Kind::Other(_, _, false) | Kind::View(_) => Vec::new(),
                _ => match below.read(field, &name, names, collector)? {
                    Ok(inside) => inside,
                    Err(error) => return Some(Err(error)),
                },
            };
            // Of lists those of plain numbers are read.
            let plain = |field: &Field| {
                matches!(field.kind, Kind::Number(_) | Kind::Truth | Kind::Decimal(_))
            };
            let kind = match kind {
                Kind::List(_) if inside.len() != 1 || !inside.iter().all(plain) => LISTS,
                kind => kind,
            };
            out.push(Field {
                unit: unit(field)?,
                name,
                kind,
                children: inside,
            });
        }
        Some(Ok(out))
    }

    fn kind(&self, field: Table<'_>) -> Option<Kind> {
        if field.table(4)?.is_some() {
            return Some(Kind::Other("categories", 2, false));
        }
        let of = field.table(3)??;
        let number = |class, bits: i32| {
            let number = Number::new(class, usize::try_from(bits / 8).ok()?, self.order)?;
            Some(Kind::Number(number))
        };
        let little = self.order == ByteOrder::Little;
        Some(match field.byte(2)? {
            1 => Kind::Other("empty", 0, false),
            2 if of.byte(1)? != 0 => number(Class::Signed, of.int(0, 0)?)?,
            2 => number(Class::Unsigned, of.int(0, 0)?)?,
            3 => number(Class::Float, 16 << of.short(0, 0)?.clamp(0, 3))?,
            4 | 19 => Kind::Other("raw bytes", 3, false),
            5 | 20 => Kind::Other("text", 3, false),
            6 => Kind::Truth,
            7 if little && of.int(2, 128)? == 128 => match of.int(1, 0)? {
                scale @ 0..=38 => Kind::Decimal(scale as u32),
                _ => Kind::Other("decimal numbers of negative scale", 2, false),
            },
            7 => Kind::Other("decimal numbers that are not of 128 bits", 2, false),
            8 if of.short(0, 1)? == 0 => number(Class::Signed, 32)?,
            8 => Kind::Ticks(8, period(1)?, Clock::Epoch),
            9 => {
                let width = usize::try_from(of.int(1, 32)? / 8).ok()?;
                Kind::Ticks(width, period(of.short(0, 1)?)?, Clock::Duration)
            }
            10 => Kind::Ticks(8, period(of.short(0, 0)?)?, Clock::Epoch),
            11 => Kind::Other("calendar intervals", 2, false),
            12 => Kind::List(4),
            21 => Kind::List(8),
            17 => LISTS,
            13 => Kind::Structure,
            14 if of.short(0, 0)? == 0 => Kind::Other("a union", 1, true),
            14 => Kind::Other("a union", 2, true),
            15 => Kind::Other("raw bytes", 2, false),
            16 => Kind::Fixed(u64::try_from(of.int(0, 0)?).ok()?),
            18 => Kind::Ticks(8, period(of.short(0, 1)?)?, Clock::Duration),
            22 => Kind::Other("run-end encoded values", 0, true),
            23 => Kind::View("raw bytes"),
            24 => Kind::View("text"),
            25 | 26 => Kind::Other("a list in every row", 3, true),
            _ => return None,
        })
    }
}

fn period(unit: i16) -> Option<Period> {
    let over = match unit {
        0 => 1,
        1 => 1_000,
        2 => 1_000_000,
        3 => 1_000_000_000,
        _ => return None,
    };
    Some(Period { times: 1, over })
}

/// The metadata `unit` or `units` of a field.
fn unit(field: Table<'_>) -> Option<Option<String>> {
    let pairs = field.vector(6, 4)?;
    for index in 0..pairs.len.min(1024) {
        let pair = pairs.table(index)?;
        if matches!(pair.text(0)?.as_str(), "unit" | "units" | "Unit" | "Units") {
            let unit = pair.text(1)?.trim().to_owned();
            return Some(Some(unit).filter(|unit| !unit.is_empty()));
        }
    }
    Some(None)
}
