//! A log of rows as text, written again as Parquet.

use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;
use std::sync::Arc;

/// Rows of a group.
const GROUP: usize = 1 << 15;

/// Writes the rows of `from`, a header and lines of so many numbers, into a new file.
pub(crate) fn write(from: &Path, to: &Path, columns: usize) -> io::Result<()> {
    let mut lines = BufReader::new(File::open(from)?).lines();
    let header = lines.next().ok_or(io::ErrorKind::UnexpectedEof)??;
    let names = names(&header);
    let field = |name: &String| {
        let field = Type::primitive_type_builder(name, Physical::DOUBLE);
        field
            .with_repetition(Repetition::OPTIONAL)
            .build()
            .map(Arc::new)
    };
    let fields: Result<Vec<_>, ParquetError> = names.iter().map(field).collect();
    let schema = Type::group_type_builder("log").with_fields(fields.map_err(fault)?);
    let schema = schema.build().map_err(fault)?;
    let properties = WriterProperties::builder()
        .set_created_by(concat!("stiction ", env!("CARGO_PKG_VERSION")).into())
        .set_compression(Compression::SNAPPY)
        .build();
    let file = File::options().write(true).create_new(true).open(to)?;
    let written = file.try_clone()?;
    let writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties));
    let mut writer = writer.map_err(fault)?;
    let mut group = vec![(Vec::new(), Vec::new()); columns];
    loop {
        let mut rows = 0;
        for line in lines.by_ref().take(GROUP) {
            for (cell, (values, there)) in line?.split(',').zip(&mut group) {
                let value = cell.parse::<f64>().ok();
                there.push(i16::from(value.is_some()));
                values.extend(value);
            }
            rows += 1;
        }
        if rows == 0 {
            break;
        }
        put(&mut writer, &mut group).map_err(fault)?;
    }
    writer.close().map_err(fault)?;
    written.sync_all()
}

/// Writes a group of rows and empties it.
fn put(
    writer: &mut SerializedFileWriter<File>,
    columns: &mut [(Vec<f64>, Vec<i16>)],
) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for (values, there) in columns {
        let missing = || ParquetError::General("a column too many".into());
        let mut column = group.next_column()?.ok_or_else(missing)?;
        let typed = column.typed::<DoubleType>();
        typed.write_batch(values, Some(there), None)?;
        column.close()?;
        values.clear();
        there.clear();
    }
    group.close().map(drop)
}

/// The cells of a header, some of them in quotes.
fn names(header: &str) -> Vec<String> {
    let mut names = vec![String::new()];
    let mut quoted = false;
    let mut before = ' ';
    for c in header.chars() {
        match c {
            '"' => {
                // A quote within quotes is written twice.
                if !quoted && before == '"' {
                    names.last_mut().expect("never empty").push('"');
                }
                quoted = !quoted;
            }
            ',' if !quoted => names.push(String::new()),
            c => names.last_mut().expect("never empty").push(c),
        }
        before = c;
    }
    names
}

/// The fault of the system behind one of the library, such as a full disk.
fn fault(e: ParquetError) -> io::Error {
    match e {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(e) => *e,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}
