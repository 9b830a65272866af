//! `results.parquet` as it is written: row groups of a bounded number of rows, so that a batch of any size takes little memory.

use super::row::{LogRow, ParameterRow};
use crate::error::Error;
use crate::output::Staged;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Text,
    Real,
    Whole,
    Flag,
}

/// A cell of a row.
enum Cell<'a> {
    Text(Option<&'a str>),
    Real(Option<f64>),
    Whole(Option<u64>),
    Flag(Option<bool>),
}

/// The columns, in their order; described in `docs/fleet.md`.
pub const COLUMNS: [&str; 28] = [
    "path",
    "machine",
    "time",
    "temperature",
    "law",
    "parameter",
    "value",
    "unit",
    "low",
    "high",
    "std",
    "identifiable",
    "origin",
    "trustworthy",
    "warnings",
    "error",
    "message",
    "relative_error_percent",
    "samples",
    "asymmetric",
    "method",
    "axis",
    "report",
    "sha256",
    "key",
    "version",
    "seed",
    "schema",
];

pub(super) const KINDS: [Kind; COLUMNS.len()] = {
    use Kind::{Flag, Real, Text, Whole};
    [
        Text, Text, Real, Real, Text, Text, Real, Text, Real, Real, Real, Flag, Text, Flag, Text,
        Text, Text, Real, Whole, Flag, Text, Text, Text, Text, Text, Text, Whole, Text,
    ]
};

/// Rows of a group.
const GROUP: usize = 1 << 16;

/// What was gathered of a column: the values that are there, and in which rows they are.
enum Gathered {
    Text(Vec<ByteArray>),
    Real(Vec<f64>),
    Whole(Vec<i64>),
    Flag(Vec<bool>),
}

struct Column {
    values: Gathered,
    there: Vec<i16>,
}

impl Column {
    fn of(kind: Kind) -> Self {
        let values = match kind {
            Kind::Text => Gathered::Text(Vec::new()),
            Kind::Real => Gathered::Real(Vec::new()),
            Kind::Whole => Gathered::Whole(Vec::new()),
            Kind::Flag => Gathered::Flag(Vec::new()),
        };
        Column {
            values,
            there: Vec::new(),
        }
    }

    fn push(&mut self, cell: Cell) {
        match (&mut self.values, cell) {
            (Gathered::Text(all), Cell::Text(Some(text))) => all.push(ByteArray::from(text)),
            (Gathered::Real(all), Cell::Real(Some(x))) => all.push(x),
            (Gathered::Whole(all), Cell::Whole(Some(n))) => all.push(n as i64),
            (Gathered::Flag(all), Cell::Flag(Some(flag))) => all.push(flag),
            _ => return self.there.push(0),
        }
        self.there.push(1);
    }

    /// Writes what was gathered as the next column of a group, and begins anew.
    fn write(
        &mut self,
        group: &mut SerializedRowGroupWriter<'_, File>,
    ) -> Result<(), ParquetError> {
        let there = std::mem::take(&mut self.there);
        match &mut self.values {
            Gathered::Text(all) => put::<ByteArrayType>(group, all, &there),
            Gathered::Real(all) => put::<DoubleType>(group, all, &there),
            Gathered::Whole(all) => put::<Int64Type>(group, all, &there),
            Gathered::Flag(all) => put::<BoolType>(group, all, &there),
        }
    }
}

fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &mut Vec<T::T>,
    there: &[i16],
) -> Result<(), ParquetError> {
    let missing = || ParquetError::General("a column too many".into());
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<T>().write_batch(values, Some(there), None)?;
    values.clear();
    column.close()
}

/// The table of a batch in the making: it has its name once [`Results::end`] gives it.
pub struct Results {
    staged: Staged,
    writer: SerializedFileWriter<File>,
    columns: Vec<Column>,
}

impl Results {
    /// Begins a table that is going to be `path`.
    ///
    /// # Errors
    /// Where nothing can be written there.
    pub fn begin(path: &Path) -> Result<Self, Error> {
        let staged = Staged::begin(path)?;
        let version = concat!("stiction ", env!("CARGO_PKG_VERSION"));
        let about = KeyValue::new("stiction.schema".into(), Some(super::SCHEMA.to_string()));
        let properties = WriterProperties::builder()
            .set_created_by(version.into())
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(vec![about]))
            .build();
        let file = staged.file()?;
        let writer = SerializedFileWriter::new(file, schema(), Arc::new(properties));
        let writer = writer.map_err(|e| staged.fault(e.to_string()))?;
        Ok(Results {
            staged,
            writer,
            columns: KINDS.into_iter().map(Column::of).collect(),
        })
    }

    /// Adds the rows of a log.
    ///
    /// # Errors
    /// Where they cannot be written.
    pub fn add(&mut self, log: &LogRow) -> Result<(), Error> {
        let warnings: Vec<&str> = log.warnings.iter().map(|code| code.as_str()).collect();
        let warnings = warnings.join(" ");
        match log.parameters.is_empty() {
            true => self.row(log, None, &warnings),
            false => log
                .parameters
                .iter()
                .for_each(|p| self.row(log, Some(p), &warnings)),
        }
        match self.columns[0].there.len() >= GROUP {
            true => self.flush(),
            false => Ok(()),
        }
    }

    fn row(&mut self, log: &LogRow, parameter: Option<&ParameterRow>, warnings: &str) {
        let p = parameter;
        let identified = log.error.is_none();
        let cells = [
            Cell::Text(Some(&log.path)),
            Cell::Text(log.machine.as_deref()),
            Cell::Real(log.time),
            Cell::Real(log.temperature),
            Cell::Text(log.law.as_deref()),
            Cell::Text(p.map(|p| p.name.as_str())),
            Cell::Real(p.and_then(|p| p.value)),
            Cell::Text(p.map(|p| p.unit.as_str())),
            Cell::Real(p.and_then(|p| p.low)),
            Cell::Real(p.and_then(|p| p.high)),
            Cell::Real(p.and_then(|p| p.std)),
            Cell::Flag(p.map(|p| p.identifiable)),
            Cell::Text(p.map(|p| p.origin.as_str())),
            Cell::Flag(log.trustworthy),
            Cell::Text(identified.then_some(warnings)),
            Cell::Text(log.error.map(|code| code.as_str())),
            Cell::Text(log.message.as_deref()),
            Cell::Real(log.relative_error_percent),
            Cell::Whole(log.samples),
            Cell::Flag(log.asymmetric),
            Cell::Text(log.method.as_deref()),
            Cell::Text(log.axis.as_deref()),
            Cell::Text(log.report.as_deref()),
            Cell::Text(log.sha256.as_deref()),
            Cell::Text(Some(&log.key)),
            Cell::Text(Some(&log.version)),
            Cell::Whole(Some(log.seed)),
            Cell::Text(Some(super::SCHEMA)),
        ];
        for (column, cell) in self.columns.iter_mut().zip(cells) {
            column.push(cell);
        }
    }

    /// Writes what was gathered as a group of rows.
    fn flush(&mut self) -> Result<(), Error> {
        let Results {
            staged,
            writer,
            columns,
        } = self;
        let mut write = || {
            let mut group = writer.next_row_group()?;
            for column in columns.iter_mut() {
                column.write(&mut group)?;
            }
            group.close().map(drop)
        };
        write().map_err(|e: ParquetError| staged.fault(e.to_string()))
    }

    /// Gives the table its name, in place of what was there.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn end(mut self) -> Result<(), Error> {
        if !self.columns[0].there.is_empty() {
            self.flush()?;
        }
        let Results { staged, writer, .. } = self;
        writer.close().map_err(|e| staged.fault(e.to_string()))?;
        staged.publish()
    }
}

fn schema() -> TypePtr {
    let column = |(name, kind): (&&str, Kind)| {
        let (physical, logical) = match kind {
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Kind::Real => (Physical::DOUBLE, None),
            Kind::Whole => (Physical::INT64, None),
            Kind::Flag => (Physical::BOOLEAN, None),
        };
        let column = Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical);
        Arc::new(column.build().expect("a type of the format"))
    };
    let columns = COLUMNS.iter().zip(KINDS).map(column).collect();
    let all = Type::group_type_builder("results").with_fields(columns);
    Arc::new(all.build().expect("a type of the format"))
}
