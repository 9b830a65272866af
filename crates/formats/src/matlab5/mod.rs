//! MAT files of version 5 (`save -v6`, `save -v7`, `scipy.io.savemat`).
//!
//! Format: "MAT-File Format", The MathWorks, chapter 1. Numbers of every class, logical arrays,
//! structs, struct arrays and cells are read; text, sparse and complex arrays, objects and function
//! handles are named in [`Table::skipped`]. A column vector or row vector is a column, a 1 x 1 array
//! a scalar, a matrix `q` the columns `q(:,1)`, `q(:,2)` ...

mod element;
mod matrix;

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

use element::{COMPRESSED, MATRIX, Stream};
use flate2::bufread::ZlibDecoder;

use crate::binary::{ByteOrder, Collector};
use crate::{Error, Kind, Limits, Table};

/// Bytes of the header of a file.
const HEADER: u64 = 128;

/// Reads all variables of a file of this many bytes.
pub(crate) fn read(file: File, bytes: u64, limits: Limits) -> Result<Table, Error> {
    let mut collector = Collector::new(limits);
    let mut reader = BufReader::with_capacity(1 << 16, file);
    let io = |error: std::io::Error| Error::new(Kind::Io, format!("cannot be read ({error})"), "");
    reader.seek(SeekFrom::Start(HEADER - 2)).map_err(io)?;
    let mut mark = [0; 2];
    reader.read_exact(&mut mark).map_err(io)?;
    // The letters M and I as one 16-bit number, in the order of the machine that wrote them.
    let order = match &mark {
        b"MI" => ByteOrder::Big,
        _ => ByteOrder::Little,
    };
    let mut at = HEADER;
    while at < bytes {
        reader.seek(SeekFrom::Start(at)).map_err(io)?;
        let mut stream = Stream::new(&mut reader, bytes - at, at, order);
        let tag = stream.tag()?;
        if tag.size > stream.left() {
            return Err(stream.bad(format!(
                "a variable of {} bytes where {} are left",
                tag.size,
                stream.left()
            )));
        }
        let content_at = at + 8;
        match tag.kind {
            MATRIX => drop(matrix::variable(&mut stream, tag, &mut collector)?),
            COMPRESSED => {
                let mut unpack = ZlibDecoder::new((&mut reader).take(tag.size));
                let mut inside = Stream::unpacked(&mut unpack, at, order);
                let tag = inside.tag()?;
                if tag.kind != MATRIX {
                    return Err(inside.bad(format!("compressed data of type {}", tag.kind)));
                }
                if matrix::variable(&mut inside, tag, &mut collector)? {
                    inside.verify_end()?;
                }
            }
            kind => return Err(stream.bad(format!("a variable of unknown type {kind}"))),
        }
        // Compressed elements are not padded; the others were written with their padding in `size`.
        at = content_at + tag.size;
    }
    Ok(collector.finish())
}
