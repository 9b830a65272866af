//! Columns of a table that holds more than samples, by their names: text, numbers and flags.

use std::collections::HashMap;
use std::fs::File;
use std::path::Path;

use parquet::basic::{ConvertedType, Type};
use parquet::column::reader::ColumnReader;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use super::column::{Meaning, each};
use super::{broken, chunk, library, scan};
use crate::binary::{Clock, Collector, guard};
use crate::open::{hand_on, not_opened};
use crate::regular::regular;
use crate::{Error, Kind, Limits};

/// A word that is missing.
const NONE: u32 = u32::MAX;
/// Seconds of a day.
const DAY: f64 = 86_400.0;

/// The cells of a column, as many as the table has rows.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Text; each word is kept once.
    Text {
        /// Which of the words a row has; none where [`Cells::text`] gives none.
        rows: Vec<u32>,
        /// The words, each once, in the order in which they come.
        words: Vec<String>,
    },
    /// Numbers of any type, NaN where one is missing; dates and time stamps as seconds since 1970.
    Numbers(Vec<f64>),
    /// Yes and no.
    Flags(Vec<Option<bool>>),
}

impl Cells {
    /// Cells of text.
    pub fn of_text(texts: impl IntoIterator<Item = Option<String>>) -> Self {
        let mut places: HashMap<String, u32> = HashMap::new();
        let (mut rows, mut words) = (Vec::new(), Vec::new());
        for text in texts {
            rows.push(text.map_or(NONE, |text| match places.get(&text) {
                Some(place) => *place,
                None => {
                    let place = words.len() as u32;
                    words.push(text.clone());
                    places.insert(text, place);
                    place
                }
            }));
        }
        Cells::Text { rows, words }
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        match self {
            Cells::Text { rows, .. } => rows.len(),
            Cells::Numbers(numbers) => numbers.len(),
            Cells::Flags(flags) => flags.len(),
        }
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The text of a row; `None` where it has none, or the column is no text.
    pub fn text(&self, row: usize) -> Option<&str> {
        match self {
            Cells::Text { rows, words } => Some(words.get(*rows.get(row)? as usize)?),
            _ => None,
        }
    }

    /// The number of a row; `None` where it has none, or the column is none of numbers.
    pub fn number(&self, row: usize) -> Option<f64> {
        match self {
            Cells::Numbers(numbers) => numbers.get(row).copied().filter(|x| !x.is_nan()),
            _ => None,
        }
    }

    /// Yes or no of a row; `None` where it says neither.
    pub fn flag(&self, row: usize) -> Option<bool> {
        match self {
            Cells::Flags(flags) => *flags.get(row)?,
            _ => None,
        }
    }
}

/// Reads the columns of a Parquet file that are named; `None` for one that it does not have. The bytes that were read are handed
/// on, in order, for a hash of exactly these. `goes_on` is asked before each part of a column, and where it says no there is
/// nothing.
///
/// # Errors
/// Where the file cannot be read, is damaged, has changed since it was opened or asks for more memory than is allowed, with the
/// file and the column.
pub fn read_cells(
    path: &Path,
    names: &[&str],
    limits: Limits,
    mut goes_on: impl FnMut() -> bool,
    mut bytes: impl FnMut(&[u8]),
) -> Result<Option<Vec<Option<Cells>>>, Error> {
    guard("Parquet", || {
        read(path, names, limits, &mut goes_on, &mut bytes)
    })
    .map_err(|error| error.in_file(path))
}

fn read(
    path: &Path,
    names: &[&str],
    limits: Limits,
    goes_on: &mut dyn FnMut() -> bool,
    bytes: &mut dyn FnMut(&[u8]),
) -> Result<Option<Vec<Option<Cells>>>, Error> {
    let io = |error: std::io::Error| Error::new(Kind::Io, format!("cannot be read ({error})"), "");
    let about = regular(path).map_err(|e| not_opened(e, "a Parquet file"))?;
    let file = File::open(path).map_err(io)?;
    let mut raw = file.try_clone().map_err(io)?;
    scan::footer(&mut raw, about.len()).map_err(broken)?;
    let reader = SerializedFileReader::new(file).map_err(library)?;
    let mut collector = Collector::new(limits);
    let columns = reader.metadata().file_metadata().schema_descr_ptr();
    let mut out = vec![None; names.len()];
    for index in 0..columns.num_columns() {
        collector.entry()?;
        let name = columns.column(index).path().parts().join(".");
        let Some(place) = names.iter().position(|wanted| *wanted == name) else {
            continue;
        };
        let cells = one(&reader, &mut raw, (index, &name), &mut collector, goes_on)
            .map_err(|error| error.in_column(&name))?;
        let Some(cells) = cells else {
            return Ok(None);
        };
        out[place] = Some(cells);
    }
    hand_on(path, &about, bytes)?;
    Ok(Some(out))
}

/// Reads one column from all row groups, for as long as `goes_on` says so.
fn one(
    reader: &SerializedFileReader<File>,
    raw: &mut File,
    (index, name): (usize, &str),
    collector: &mut Collector,
    goes_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Cells>, Error> {
    let columns = reader.metadata().file_metadata().schema_descr_ptr();
    let column = columns.column(index);
    if column.max_rep_level() > 0 {
        return Err(Error::new(
            Kind::Format,
            "a list in every row",
            "one cell in every row",
        ));
    }
    let mut taken = Taken::of(&column)?;
    let mut total = 0;
    for (number, group) in reader.metadata().row_groups().iter().enumerate() {
        if !goes_on() {
            return Ok(None);
        }
        let rows = u64::try_from(group.num_rows()).map_err(|_| broken("a negative length"))?;
        total += collector.reserve(name, &[rows])?;
        let (mut chunk, _) = chunk(reader, raw, number, index, collector)?;
        taken
            .append(column.max_def_level(), rows as usize, &mut chunk)
            .map_err(library)?;
        collector.holds("the words of a column", taken.bytes)?;
        if taken.cells.len() as u64 != total {
            return Err(broken(format!(
                "row group {} ends after {} of {total} rows",
                number + 1,
                taken.cells.len()
            )));
        }
    }
    Ok(Some(taken.cells))
}

/// What was taken of a column so far.
struct Taken {
    cells: Cells,
    /// Where a word stands among the words.
    places: HashMap<Vec<u8>, u32>,
    /// Of all words.
    bytes: u64,
    /// What a whole number counts.
    unit: f64,
}

/// What a whole number of a column counts: seconds of a date or a time stamp, else 1.
///
/// # Errors
/// Where it is none of these.
fn unit(column: &ColumnDescriptor) -> Result<f64, Error> {
    let other = |what: &str| {
        let allowed = "a number, a date or a time stamp";
        Err(Error::new(Kind::Format, what, allowed))
    };
    match Meaning::of(column) {
        Meaning::Ticks(period, Clock::Epoch) => Ok(period.times as f64 / period.over as f64),
        Meaning::Ticks(..) => other("a time of day"),
        Meaning::Decimal(_) => other("a decimal"),
        _ if column.converted_type() == ConvertedType::DATE => Ok(DAY),
        _ => Ok(1.0),
    }
}

impl Taken {
    fn of(column: &ColumnDescriptor) -> Result<Self, Error> {
        let cells = match column.physical_type() {
            Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY => Cells::Text {
                rows: Vec::new(),
                words: Vec::new(),
            },
            Type::BOOLEAN => Cells::Flags(Vec::new()),
            _ => Cells::Numbers(Vec::new()),
        };
        Ok(Self {
            cells,
            places: HashMap::new(),
            bytes: 0,
            unit: unit(column)?,
        })
    }

    fn append(
        &mut self,
        full: i16,
        rows: usize,
        reader: &mut ColumnReader,
    ) -> Result<(), ParquetError> {
        use ColumnReader as R;
        let Self {
            cells,
            places,
            bytes,
            unit,
        } = self;
        match (reader, cells) {
            (R::ByteArrayColumnReader(r), Cells::Text { rows: out, words }) => {
                each(r, rows, full, |value| {
                    let word = value.map(|value| {
                        *places.entry(value.data().to_vec()).or_insert_with(|| {
                            let word = String::from_utf8_lossy(value.data()).into_owned();
                            *bytes += 2 * word.len() as u64;
                            words.push(word);
                            words.len() as u32 - 1
                        })
                    });
                    out.push(word.unwrap_or(NONE));
                })
            }
            (R::BoolColumnReader(r), Cells::Flags(out)) => {
                each(r, rows, full, |value| out.push(value.copied()))
            }
            (R::DoubleColumnReader(r), Cells::Numbers(out)) => each(r, rows, full, |value| {
                out.push(value.copied().unwrap_or(f64::NAN))
            }),
            (R::FloatColumnReader(r), Cells::Numbers(out)) => each(r, rows, full, |value| {
                out.push(value.map_or(f64::NAN, |x| f64::from(*x)));
            }),
            (R::Int64ColumnReader(r), Cells::Numbers(out)) => each(r, rows, full, |value| {
                out.push(value.map_or(f64::NAN, |x| *x as f64 * *unit));
            }),
            (R::Int32ColumnReader(r), Cells::Numbers(out)) => each(r, rows, full, |value| {
                out.push(value.map_or(f64::NAN, |x| f64::from(*x) * *unit));
            }),
            _ => Err(ParquetError::General(
                "a type that is neither text, number nor flag".to_owned(),
            )),
        }
    }
}
