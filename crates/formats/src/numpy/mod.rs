//! NumPy arrays: one in an NPY file, several in an NPZ archive.
//!
//! Format: numpy.lib.format versions 1.0 to 3.0. Arrays of pickled Python objects are never loaded.

mod dtype;
mod literal;

use std::fs::File;
use std::io::{self, BufReader, Read};

use dtype::Dtype;
use literal::Literal;
use zip::ZipArchive;

use crate::binary::{ByteOrder, Clock, Collector, Layout, Order, Period, guard, seconds};
use crate::{Error, Kind, Limits, Table};

/// Longest header in bytes; NumPy's own reader stops at 10 000 bytes unless told otherwise.
const MAX_HEADER: u64 = 1 << 20;

/// Reads the one array of an NPY file; it has no name.
pub(crate) fn read_npy(file: File, limits: Limits) -> Result<Table, Error> {
    let mut collector = Collector::new(limits);
    let mut reader = BufReader::with_capacity(1 << 16, file);
    array(&mut reader, "", &mut collector)?;
    Ok(collector.finish())
}

/// Reads the arrays of an NPZ archive, in their order in the archive.
pub(crate) fn read_npz(file: File, limits: Limits) -> Result<Table, Error> {
    guard("ZIP", || {
        let mut collector = Collector::new(limits);
        let mut archive = ZipArchive::new(BufReader::new(file)).map_err(broken_zip)?;
        for index in 0..archive.len() {
            collector.entry()?;
            let name = match archive.name_for_index(index) {
                Some(name) => name.map_err(broken_zip)?.into_owned(),
                None => String::new(),
            };
            let Some(name) = name.strip_suffix(".npy") else {
                collector.skip(&name, "not an NPY array");
                continue;
            };
            let mut member = archive
                .by_index(index)
                .map_err(|error| broken_zip(error).in_column(name))?;
            array(&mut member, name, &mut collector).map_err(|error| error.in_column(name))?;
        }
        Ok(collector.finish())
    })
}

fn broken_zip(error: zip::result::ZipError) -> Error {
    Error::new(
        Kind::Format,
        format!("broken ZIP archive ({error})"),
        "an NPZ archive as numpy.savez or numpy.savez_compressed writes it",
    )
}

/// Reads one array, header and samples.
fn array(reader: &mut impl Read, name: &str, collector: &mut Collector) -> Result<(), Error> {
    let header = Header::read(reader)?;
    let mut dims = header.shape;
    match header.dtype {
        Dtype::Other(what) => collector.skip(name, &what),
        Dtype::Record(record) => {
            // Too many to count are too many to reserve.
            let rows = dims.iter().try_fold(1u64, |n, &dim| n.checked_mul(dim));
            let rows = rows.unwrap_or(u64::MAX);
            let read = record.columns(name, rows, collector, |bytes| {
                reader.read_exact(bytes).map_err(cut)
            })?;
            if read {
                at_end(reader)?;
            }
        }
        Dtype::Number(number) => {
            if let Layout::Skip(why) = Layout::of(&dims) {
                collector.skip(name, &why);
                return Ok(());
            }
            collector.reserve(name, &dims)?;
            collector
                .numbers(name, None, (&dims, header.order), number, reader)
                .map_err(cut)?;
            at_end(reader)?;
        }
        Dtype::Ticks(order, period, clock) => {
            dims.retain(|&n| n != 1);
            if dims.len() != 1 || dims.contains(&0) {
                collector.skip(name, "time stamps that are not one column");
                return Ok(());
            }
            let count = collector.reserve(name, &dims)?;
            let values = times(reader, count, order, period, clock)?;
            at_end(reader)?;
            collector.detected(format!("{name}: {}", values.1));
            collector.stamps(name, values.0);
        }
    }
    Ok(())
}

/// Reads `datetime64` or `timedelta64` counts as seconds; the smallest integer is "not a time".
fn times(
    reader: &mut impl Read,
    count: u64,
    order: ByteOrder,
    period: Period,
    clock: Clock,
) -> Result<(Vec<f64>, String), Error> {
    let mut ticks = Vec::new();
    let mut bytes = [0; 8];
    for _ in 0..count {
        reader.read_exact(&mut bytes).map_err(cut)?;
        let tick = match order {
            ByteOrder::Little => i64::from_le_bytes(bytes),
            ByteOrder::Big => i64::from_be_bytes(bytes),
        };
        ticks.push(Some(tick).filter(|&tick| tick != i64::MIN));
    }
    Ok(seconds(&ticks, period, clock))
}

/// The array must be all there is; in an archive this also has its checksum verified.
fn at_end(reader: &mut impl Read) -> Result<(), Error> {
    match reader.read(&mut [0]) {
        Ok(0) => Ok(()),
        Ok(_) => Err(Error::new(
            Kind::Format,
            "there is more in the file than the array its header declares",
            "one array, as numpy.save writes it",
        )),
        Err(error) => Err(cut(error)),
    }
}

fn cut(error: io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => Error::new(
            Kind::Format,
            "the data end before the array that its header declares",
            "the whole file as NumPy wrote it",
        ),
        io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput | io::ErrorKind::Other => {
            Error::new(
                Kind::Format,
                format!("the data are damaged ({error})"),
                "the whole file as NumPy wrote it",
            )
        }
        _ => Error::new(Kind::Io, format!("cannot be read ({error})"), ""),
    }
}

/// What stands before the samples.
struct Header {
    dtype: Dtype,
    order: Order,
    shape: Vec<u64>,
}

impl Header {
    fn read(reader: &mut impl Read) -> Result<Self, Error> {
        let mut start = [0; 8];
        reader.read_exact(&mut start).map_err(cut)?;
        if !start.starts_with(b"\x93NUMPY") {
            return Err(bad("no NPY signature"));
        }
        let length = match start[6] {
            1 => {
                let mut bytes = [0; 2];
                reader.read_exact(&mut bytes).map_err(cut)?;
                u64::from(u16::from_le_bytes(bytes))
            }
            2 | 3 => {
                let mut bytes = [0; 4];
                reader.read_exact(&mut bytes).map_err(cut)?;
                u64::from(u32::from_le_bytes(bytes))
            }
            version => return Err(bad(format!("NPY version {version}, newer than 3"))),
        };
        if length > MAX_HEADER {
            return Err(Error::new(
                Kind::Limit,
                format!("an NPY header of {length} bytes"),
                format!("at most {MAX_HEADER} bytes"),
            ));
        }
        let mut text = vec![0; length as usize];
        reader.read_exact(&mut text).map_err(cut)?;
        // Versions 1 and 2 are Latin-1, version 3 is UTF-8.
        let text = match start[6] {
            3 => String::from_utf8(text).map_err(|_| bad("the header is not UTF-8"))?,
            _ => text.into_iter().map(char::from).collect(),
        };
        Self::new(&text).map_err(bad)
    }

    fn new(text: &str) -> Result<Self, String> {
        let Literal::Dictionary(items) = literal::parse(text)? else {
            return Err("the header is not a dictionary".to_owned());
        };
        let find = |key: &str| {
            let item = items.iter().find(|(name, _)| name == key);
            item.map(|(_, value)| value)
                .ok_or_else(|| format!("the header has no '{key}'"))
        };
        let Literal::Truth(fortran) = find("fortran_order")? else {
            return Err("'fortran_order' is not True or False".to_owned());
        };
        let Literal::Sequence(shape) = find("shape")? else {
            return Err("'shape' is not a tuple".to_owned());
        };
        let shape = shape.iter().map(|dim| match dim {
            Literal::Whole(dim) => Ok(*dim),
            _ => Err("'shape' is not a tuple of whole numbers".to_owned()),
        });
        Ok(Self {
            dtype: Dtype::new(find("descr")?)?,
            order: if *fortran { Order::Column } else { Order::Row },
            shape: shape.collect::<Result<_, _>>()?,
        })
    }
}

fn bad(found: impl Into<String>) -> Error {
    Error::new(
        Kind::Format,
        found,
        "an NPY array of version 1 to 3, as numpy.save writes it",
    )
}
