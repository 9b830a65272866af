//! The pages of a column that is packed in a way for which the library would need code in C: Zstandard, as polars and newer Spark
//! write, gzip and LZ4. The decoders are those of the other formats.

use std::fs::File;
use std::io::{self, Read};

use flate2::read::MultiGzDecoder;
use parquet::basic::{Compression, Encoding};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::ParquetError;

use super::scan::{self, Header, Kind};
use crate::binary::zstd;

/// The pages of a column of a row group, one after the other.
pub(super) struct Pages {
    file: File,
    /// Where the next page begins.
    at: u64,
    end: u64,
    packing: Packing,
    /// Most bytes of a page.
    largest: u64,
    window: Vec<u8>,
}

#[derive(Clone, Copy)]
pub(super) enum Packing {
    Zstandard,
    Gzip,
    Lz4,
}

impl Packing {
    /// That of a column; `None` where the library unpacks it, or nobody.
    pub(super) fn of(compression: Compression) -> Option<Self> {
        match compression {
            Compression::ZSTD(_) => Some(Packing::Zstandard),
            Compression::GZIP(_) => Some(Packing::Gzip),
            Compression::LZ4_RAW => Some(Packing::Lz4),
            _ => None,
        }
    }

    /// Unpacks what should be that many bytes.
    fn unpacked(self, packed: &[u8], wanted: u64, out: &mut Vec<u8>) -> io::Result<()> {
        let mut read = |mut unpacker: Box<dyn Read + '_>| {
            unpacker.by_ref().take(wanted).read_to_end(out).map(drop)
        };
        match self {
            Packing::Zstandard => read(Box::new(zstd(packed, wanted)?)),
            Packing::Gzip => read(Box::new(MultiGzDecoder::new(packed))),
            Packing::Lz4 => {
                let whole = lz4_flex::block::decompress(packed, wanted as usize);
                out.extend(whole.map_err(io::Error::other)?);
                Ok(())
            }
        }
    }
}

impl Pages {
    /// Of the bytes from `start` to `end`, whose pages unpack to `largest` bytes at most.
    pub(super) fn new(file: File, start: u64, end: u64, packing: Packing, largest: u64) -> Self {
        Self {
            file,
            at: start,
            end,
            packing,
            largest,
            window: Vec::new(),
        }
    }

    fn page(&mut self) -> Result<Option<Page>, String> {
        while self.at < self.end {
            let header = scan::header(&mut self.file, self.at, self.end, &mut self.window)?;
            let begin = self.at + header.bytes;
            let packed = header.sizes(self.at, self.end)?;
            let at = self.at;
            self.at = begin + packed;
            if let Some(page) = self.unpacked(&header, begin, packed)? {
                return Ok(Some(page));
            }
            if matches!(header.kind, Kind::Other) {
                continue;
            }
            return Err(format!("a damaged page at byte {at}"));
        }
        Ok(None)
    }

    /// A page; `None` where it is an index, or its header does not fit.
    fn unpacked(&mut self, header: &Header, begin: u64, size: u64) -> Result<Option<Page>, String> {
        let (Ok(wanted), Ok(values)) =
            (u64::try_from(header.unpacked), u32::try_from(header.values))
        else {
            return Ok(None);
        };
        if wanted > self.largest {
            return Err("the file has changed meanwhile".to_owned());
        }
        // Of the second version the levels stand in front, as they are.
        let levels = match header.kind {
            Kind::Data2 {
                levels: [definition, repetition],
                ..
            } => u64::from(definition) + u64::from(repetition),
            _ => 0,
        };
        if levels > size || levels > wanted {
            return Ok(None);
        }
        let mut packed = vec![0; size as usize];
        scan::read_at(&mut self.file, begin, &mut packed)?;
        let is_packed = !matches!(header.kind, Kind::Data2 { packed: false, .. });
        let buf = match is_packed {
            false => packed,
            true => {
                let (front, rest) = packed.split_at(levels as usize);
                let mut out = Vec::with_capacity(wanted as usize);
                out.extend_from_slice(front);
                // Of a page without any value nothing is packed.
                if wanted > levels {
                    let unpacked = self.packing.unpacked(rest, wanted - levels, &mut out);
                    unpacked.map_err(|e| format!("a page that cannot be unpacked ({e})"))?;
                }
                out
            }
        };
        if buf.len() as u64 != wanted {
            return Err(format!("a page of {} bytes instead of {wanted}", buf.len()));
        }
        let Some(encoding) = encoding(header.encoding) else {
            return Ok(None);
        };
        Ok(match header.kind {
            Kind::Dictionary => Some(Page::DictionaryPage {
                buf: buf.into(),
                num_values: values,
                encoding,
                is_sorted: false,
            }),
            Kind::Data {
                levels: [definition, repetition],
            } => levels_of(definition, repetition).map(|(definition, repetition)| Page::DataPage {
                buf: buf.into(),
                num_values: values,
                encoding,
                def_level_encoding: definition,
                rep_level_encoding: repetition,
                statistics: None,
            }),
            Kind::Data2 {
                nulls,
                rows,
                levels: [definition, repetition],
                packed,
            } => Some(Page::DataPageV2 {
                buf: buf.into(),
                num_values: values,
                encoding,
                num_nulls: nulls,
                num_rows: rows,
                def_levels_byte_len: definition,
                rep_levels_byte_len: repetition,
                is_compressed: packed,
                statistics: None,
            }),
            Kind::Other => None,
        })
    }
}

fn levels_of(definition: i64, repetition: i64) -> Option<(Encoding, Encoding)> {
    Some((encoding(definition)?, encoding(repetition)?))
}

/// The encodings by their numbers (parquet.thrift of Apache Parquet); bit-packed levels, which nobody has written for years, are
/// left out.
fn encoding(number: i64) -> Option<Encoding> {
    Some(match number {
        0 => Encoding::PLAIN,
        2 => Encoding::PLAIN_DICTIONARY,
        3 => Encoding::RLE,
        5 => Encoding::DELTA_BINARY_PACKED,
        6 => Encoding::DELTA_LENGTH_BYTE_ARRAY,
        7 => Encoding::DELTA_BYTE_ARRAY,
        8 => Encoding::RLE_DICTIONARY,
        9 => Encoding::BYTE_STREAM_SPLIT,
        _ => return None,
    })
}

impl Iterator for Pages {
    type Item = Result<Page, ParquetError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>, ParquetError> {
        self.page().map_err(ParquetError::General)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>, ParquetError> {
        Err(ParquetError::NYI(
            "pages are read in their order".to_owned(),
        ))
    }

    fn skip_next_page(&mut self) -> Result<(), ParquetError> {
        self.get_next_page().map(drop)
    }

    /// Whether the list of a row may not go on in the next page.
    fn at_record_boundary(&mut self) -> Result<bool, ParquetError> {
        Ok(self.at >= self.end)
    }
}
