//! Parquet files, uncompressed or with Snappy, Zstandard, gzip or LZ4, as pyarrow, pandas, polars and Spark write them.
//!
//! Numbers of every type are read; a missing value is NaN. Time stamps become seconds from the first
//! one, which [`Table::detected`] names. Fields of structs are `struct.field`; text, raw bytes and
//! lists of several lengths are named in [`Table::skipped`]; those of one length are `field(:,1)`, `field(:,2)` ...

mod cells;
mod column;
mod list;
mod pages;
mod scan;
mod thrift;

use std::fs::File;
use std::sync::Arc;

pub use cells::{Cells, read_cells};
use column::{Meaning, Samples};
use list::Lists;
use pages::{Packing, Pages};
use parquet::basic::Compression;
use parquet::column::reader::{ColumnReader, get_column_reader};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};

use crate::binary::{Collector, Order, guard, seconds};
use crate::{Error, Kind, Limits, Table};

/// Reads every column of numbers of a file of this many bytes, beside so many samples of other files.
pub(crate) fn read(file: File, bytes: u64, limits: Limits, beside: u64) -> Result<Table, Error> {
    guard("Parquet", || {
        let mut raw = file
            .try_clone()
            .map_err(|error| broken(error.to_string()))?;
        scan::footer(&mut raw, bytes).map_err(broken)?;
        let reader = SerializedFileReader::new(file).map_err(library)?;
        let mut collector = Collector::new(limits);
        collector.reserve("", &[beside])?;
        let columns = reader.metadata().file_metadata().schema_descr_ptr();
        for index in 0..columns.num_columns() {
            collector.entry()?;
            let name = columns.column(index).path().parts().join(".");
            one(&reader, &mut raw, index, &name, &mut collector)
                .map_err(|error| error.in_column(&name))?;
        }
        Ok(collector.finish())
    })
}

fn broken(found: impl Into<String>) -> Error {
    Error::new(Kind::Format, found, "a whole Parquet file")
}

fn library(error: ParquetError) -> Error {
    broken(format!("broken or unsupported Parquet ({error})"))
}

/// A column of a row group, and how many values its pages claim; refused where it is packed as nothing here unpacks, or its pages ask for too much memory.
fn chunk(
    reader: &SerializedFileReader<File>,
    raw: &mut File,
    group: usize,
    index: usize,
    collector: &Collector,
) -> Result<(ColumnReader, u64), Error> {
    let group = reader.get_row_group(group).map_err(library)?;
    let about = group.metadata();
    let chunk = about.columns().get(index);
    let chunk = chunk.ok_or_else(|| broken("a missing column"))?;
    let compression = chunk.compression();
    let packing = Packing::of(compression);
    let plain = matches!(compression, Compression::UNCOMPRESSED | Compression::SNAPPY);
    if packing.is_none() && !plain {
        return Err(Error::new(
            Kind::Format,
            format!("compressed with {compression}"),
            "write the file with compression 'zstd', 'snappy', 'gzip' or none",
        ));
    }
    let start = chunk
        .dictionary_page_offset()
        .unwrap_or(chunk.data_page_offset());
    let end = start.checked_add(chunk.compressed_size());
    let (Ok(start), Some(Ok(end))) = (u64::try_from(start), end.map(u64::try_from)) else {
        return Err(broken("a negative offset"));
    };
    // Snappy packs at most 64 bytes into 3; what is not compressed stays as long as it is. The others have no such bound.
    let most = |packed: u64| match packing {
        None => packed.saturating_mul(22) + 64,
        Some(_) => u64::MAX,
    };
    let (largest, values) = scan::pages(raw, start, end, most).map_err(broken)?;
    collector.holds("a page", largest)?;
    let Some(packing) = packing else {
        let reader = group.get_column_reader(index).map_err(library)?;
        return Ok((reader, values));
    };
    let file = raw.try_clone().map_err(|error| broken(error.to_string()))?;
    let pages = Pages::new(file, start, end, packing, largest);
    let reader = get_column_reader(chunk.column_descr_ptr(), Box::new(pages));
    Ok((reader, values))
}

/// Reads one column from all row groups.
fn one(
    reader: &SerializedFileReader<File>,
    raw: &mut File,
    index: usize,
    name: &str,
    collector: &mut Collector,
) -> Result<(), Error> {
    let schema = reader.metadata().file_metadata().schema_descr();
    let descriptor: Arc<_> = schema.column(index);
    let mut lists = Lists::of(schema, &descriptor);
    let name = &lists.as_ref().map_or(name.to_owned(), |l| l.name.clone());
    let meaning = match lists {
        None if descriptor.max_rep_level() > 0 => Meaning::Other("a list in every row".to_owned()),
        _ => Meaning::of(&descriptor),
    };
    if let Meaning::Other(what) = &meaning {
        collector.skip_column(name, what);
        return Ok(());
    }
    let mut samples = Samples::default();
    let mut total = 0;
    for (number, group) in reader.metadata().row_groups().iter().enumerate() {
        let rows = u64::try_from(group.num_rows()).map_err(|_| broken("a negative length"))?;
        if lists.is_none() {
            collector.reserve(name, &[rows])?;
        }
        total += rows;
        let (mut chunk, values) = chunk(reader, raw, number, index, collector)?;
        if lists.is_some() {
            collector.reserve(name, &[values])?;
        }
        samples
            .append(
                &meaning,
                descriptor.max_def_level(),
                rows as usize,
                lists.as_mut(),
                &mut chunk,
            )
            .map_err(library)?;
        let read = lists.as_ref().map_or(samples.len(), |lists| lists.rows);
        if read as u64 != total {
            return Err(broken(format!(
                "row group {} ends after {read} of {total} rows",
                number + 1
            )));
        }
    }
    if let Some(lists) = lists {
        return lists.give(&meaning, samples, collector);
    }
    match meaning {
        _ if total == 0 => collector.skip_column(name, "empty"),
        Meaning::Ticks(period, clock) => {
            let (values, done) = seconds(&samples.ticks, period, clock);
            collector.detected(format!("{name}: {done}"));
            collector.stamps(name, values);
        }
        // A file of one row still has columns.
        _ if total == 1 => collector.column(name, None, samples.values.samples),
        _ => collector.array(name, None, &[total], Order::Row, samples.values),
    }
    Ok(())
}
