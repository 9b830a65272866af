//! One column of a Parquet file: what its values mean, and reading them.

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{DataType, Int96};
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;

use super::list::Lists;
use crate::binary::{Clock, Period, Values, decimal, half};

/// What the stored values of a column are.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Meaning {
    Signed,
    Unsigned,
    /// Two bytes each, IEEE 754 half precision.
    Half,
    Ticks(Period, Clock),
    /// Integers in units of 10^-scale.
    Decimal(u32),
    /// Not numbers, and what it is instead.
    Other(String),
}

impl Meaning {
    pub(super) fn of(column: &ColumnDescriptor) -> Self {
        let other = |what: &str| Meaning::Other(what.to_owned());
        let converted = column.converted_type();
        match (column.physical_type(), column.logical_type_ref()) {
            (Type::INT96, _) => Meaning::Ticks(NANO, Clock::Epoch),
            (_, Some(LogicalType::Timestamp(stamp))) => {
                Meaning::Ticks(period(&stamp.unit), Clock::Epoch)
            }
            (_, Some(LogicalType::Time(time))) => {
                Meaning::Ticks(period(&time.unit), Clock::Duration)
            }
            (_, Some(LogicalType::Decimal(decimal))) => scaled(decimal.scale),
            (Type::INT32 | Type::INT64, Some(LogicalType::Integer(integer))) => {
                if integer.is_signed {
                    Meaning::Signed
                } else {
                    Meaning::Unsigned
                }
            }
            (Type::FIXED_LEN_BYTE_ARRAY, Some(LogicalType::Float16)) => Meaning::Half,
            (Type::BYTE_ARRAY, _) => other("text"),
            (Type::FIXED_LEN_BYTE_ARRAY, _) if converted == ConvertedType::DECIMAL => {
                scaled(column.type_scale())
            }
            (Type::FIXED_LEN_BYTE_ARRAY, _) => other("raw bytes"),
            _ => match converted {
                ConvertedType::TIMESTAMP_MILLIS => Meaning::Ticks(MILLI, Clock::Epoch),
                ConvertedType::TIMESTAMP_MICROS => Meaning::Ticks(MICRO, Clock::Epoch),
                ConvertedType::TIME_MILLIS => Meaning::Ticks(MILLI, Clock::Duration),
                ConvertedType::TIME_MICROS => Meaning::Ticks(MICRO, Clock::Duration),
                ConvertedType::DECIMAL => scaled(column.type_scale()),
                ConvertedType::UINT_8
                | ConvertedType::UINT_16
                | ConvertedType::UINT_32
                | ConvertedType::UINT_64 => Meaning::Unsigned,
                _ => Meaning::Signed,
            },
        }
    }
}

const MILLI: Period = Period {
    times: 1,
    over: 1_000,
};
const MICRO: Period = Period {
    times: 1,
    over: 1_000_000,
};
const NANO: Period = Period {
    times: 1,
    over: 1_000_000_000,
};

fn period(unit: &TimeUnit) -> Period {
    match unit {
        TimeUnit::MILLIS => MILLI,
        TimeUnit::MICROS => MICRO,
        TimeUnit::NANOS => NANO,
    }
}

fn scaled(scale: i32) -> Meaning {
    match u32::try_from(scale) {
        Ok(scale @ 0..=38) => Meaning::Decimal(scale),
        _ => Meaning::Other(format!("decimal numbers of scale {scale}")),
    }
}

/// What was read of a column so far.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub(super) values: Values,
    pub(super) ticks: Vec<Option<i64>>,
}

impl Samples {
    pub(super) fn len(&self) -> usize {
        self.values.samples.len() + self.ticks.len()
    }

    /// Appends the rows of one row group, or the elements of its lists; a value is there at definition level `full`.
    pub(super) fn append(
        &mut self,
        meaning: &Meaning,
        full: i16,
        rows: usize,
        lists: Option<&mut Lists>,
        reader: &mut ColumnReader,
    ) -> Result<(), ParquetError> {
        use ColumnReader as R;
        let Self { values, ticks } = self;
        let Values { samples, rounded } = values;
        let mut whole = |integer: i128| {
            let real = integer as f64;
            *rounded |= real as i128 != integer;
            real
        };
        let mut push = |value: Option<f64>| samples.push(value.unwrap_or(f64::NAN));
        let mut tick = |value| ticks.push(value);
        let unsigned = *meaning == Meaning::Unsigned;
        match (reader, meaning) {
            (R::Int32ColumnReader(r), Meaning::Ticks(..)) => {
                records(r, rows, full, lists, |v| tick(v.copied().map(i64::from)))
            }
            (R::Int64ColumnReader(r), Meaning::Ticks(..)) => {
                records(r, rows, full, lists, |v| tick(v.copied()))
            }
            (R::Int96ColumnReader(r), _) => {
                records(r, rows, full, lists, |v| tick(v.map(Int96::to_nanos)))
            }
            (R::Int32ColumnReader(r), Meaning::Decimal(scale)) => {
                records(r, rows, full, lists, |v| {
                    push(v.map(|&v| decimal(i128::from(v), *scale)));
                })
            }
            (R::Int64ColumnReader(r), Meaning::Decimal(scale)) => {
                records(r, rows, full, lists, |v| {
                    push(v.map(|&v| decimal(i128::from(v), *scale)));
                })
            }
            (R::FixedLenByteArrayColumnReader(r), Meaning::Decimal(scale)) => {
                records(r, rows, full, lists, |v| {
                    push(
                        v.and_then(|v| big_endian(v.data()))
                            .map(|v| decimal(v, *scale)),
                    );
                })
            }
            (R::FixedLenByteArrayColumnReader(r), _) => records(r, rows, full, lists, |v| {
                push(
                    v.and_then(|v| v.data().try_into().ok())
                        .map(u16::from_le_bytes)
                        .map(half),
                );
            }),
            (R::BoolColumnReader(r), _) => records(r, rows, full, lists, |v| {
                push(v.map(|&v| f64::from(u8::from(v))))
            }),
            (R::Int32ColumnReader(r), _) if unsigned => records(r, rows, full, lists, |v| {
                push(v.map(|&v| f64::from(v as u32)))
            }),
            (R::Int32ColumnReader(r), _) => {
                records(r, rows, full, lists, |v| push(v.map(|&v| f64::from(v))))
            }
            (R::Int64ColumnReader(r), _) if unsigned => records(r, rows, full, lists, |v| {
                push(v.map(|&v| whole(i128::from(v as u64))));
            }),
            (R::Int64ColumnReader(r), _) => records(r, rows, full, lists, |v| {
                push(v.map(|&v| whole(i128::from(v))))
            }),
            (R::FloatColumnReader(r), _) => {
                records(r, rows, full, lists, |v| push(v.map(|&v| f64::from(v))))
            }
            (R::DoubleColumnReader(r), _) => records(r, rows, full, lists, |v| push(v.copied())),
            (R::ByteArrayColumnReader(_), _) => {
                Err(ParquetError::General("text is not read".to_owned()))
            }
        }
    }
}

/// Calls `take` on every row, `None` for a missing value, one below definition level `full`.
pub(super) fn each<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    full: i16,
    take: impl FnMut(Option<&T::T>),
) -> Result<(), ParquetError> {
    records(reader, rows, full, None, take)
}

/// The same, of rows that have lists on every element.
fn records<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    full: i16,
    mut lists: Option<&mut Lists>,
    mut take: impl FnMut(Option<&T::T>),
) -> Result<(), ParquetError> {
    // As many as the readers of other formats take at once.
    const BATCH_ROWS: usize = 8192;
    let (mut values, mut present, mut repeats) = (Vec::new(), Vec::new(), Vec::new());
    let nullable = full > 0;
    let mut left = rows;
    while left > 0 {
        values.clear();
        present.clear();
        repeats.clear();
        let levels = nullable.then_some(&mut present);
        let again = lists.is_some().then_some(&mut repeats);
        let (records, _, _) =
            reader.read_records(left.min(BATCH_ROWS), levels, again, &mut values)?;
        if records == 0 {
            break;
        }
        left = left.saturating_sub(records);
        if let Some(lists) = &mut lists {
            let mut values = values.iter();
            for (&level, &repeat) in present.iter().zip(&repeats) {
                if lists.see(repeat == 0, level) {
                    take(if level == full { values.next() } else { None });
                }
            }
            lists.end();
        } else if nullable {
            let mut values = values.iter();
            for &level in &present {
                take(if level == full { values.next() } else { None });
            }
        } else {
            values.iter().for_each(|value| take(Some(value)));
        }
    }
    Ok(())
}

/// Two's complement, most significant byte first.
fn big_endian(bytes: &[u8]) -> Option<i128> {
    let first = *bytes.first()?;
    let sign = if first >= 0x80 { -1 } else { 0 };
    let fold = |n: i128, &byte: &u8| n << 8 | i128::from(byte);
    (bytes.len() <= 16).then(|| bytes.iter().fold(sign, fold))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals() {
        assert_eq!(decimal(big_endian(&[0xff, 0x85]).unwrap(), 2), -1.23);
        assert_eq!(decimal(big_endian(&[0x00, 0x80]).unwrap(), 0), 128.0);
        assert_eq!(big_endian(&[0; 17]), None);
    }
}
