//! The tree of an HDF5 file through the crate `hdf5-pure`.

use hdf5_pure::{
    ChunkIndex, Datatype, DatatypeByteOrder, Error, FloatingPointLayout, FormatError, Layout,
    Object, ReferenceType,
};

use super::prepare;
use super::tree::{Dataset, Element, Group, Node};
use crate::binary::{ByteOrder, Cell, Class, Field, Number, Record};

/// Filters that the crate can decode: deflate, shuffle, Fletcher-32, scale-offset, LZF.
const FILTERS: [u16; 5] = [1, 2, 3, 6, 32000];

/// Opens the file, which is read into memory: reading on demand, the crate takes memory for the
/// sizes that a chunk claims before it looks whether the file is that long.
pub(super) fn open(path: &std::path::Path) -> Result<Box<dyn Group>, String> {
    let mut bytes = std::fs::read(path).map_err(words)?;
    prepare::check(&bytes)?;
    prepare::drop_soft_links(&mut bytes);
    let file = hdf5_pure::File::from_bytes(bytes).map_err(words)?;
    Ok(Box::new(file.root()))
}

fn words(error: impl std::fmt::Display) -> String {
    error.to_string()
}

impl Group for hdf5_pure::Group {
    fn members(&self) -> Result<Vec<(String, Node)>, String> {
        let datasets = self.iter_datasets().map_err(words)?;
        let groups = self.iter_groups().map_err(words)?;
        Ok(datasets
            .map(|(name, dataset)| (name, Node::Dataset(Box::new(dataset))))
            .chain(groups.map(|(name, group)| (name, Node::Group(Box::new(group)))))
            .collect())
    }
}

impl Dataset for hdf5_pure::Dataset {
    fn dims(&self) -> Result<Vec<u64>, String> {
        let dims = self.shape().map_err(words)?;
        // The crate does not tell a set of nothing from one of a single value, but that it has no bytes.
        let bytes = match self.layout() {
            Ok(Layout::Compact { size } | Layout::Contiguous { size, .. }) => size,
            _ => 1,
        };
        Ok(if dims.is_empty() && bytes == 0 {
            vec![0]
        } else {
            dims
        })
    }

    fn chunk(&self) -> Result<Vec<u64>, String> {
        Ok(self.chunk_shape().map_err(words)?.unwrap_or_default())
    }

    fn chunks(&self, grid: u64, bytes: u64) -> Result<(u64, u64), String> {
        match self.layout().map_err(words)? {
            // All of them, one behind the other, which the crate lists without looking at the file.
            Layout::Chunked {
                index: ChunkIndex::Implicit,
                ..
            } => Ok((grid, bytes)),
            Layout::Chunked { .. } => {
                let chunks = self.chunks().map_err(words)?;
                let bytes = chunks.iter().map(|chunk| chunk.storage_size);
                Ok((chunks.len() as u64, bytes.fold(0, u64::saturating_add)))
            }
            _ => Ok((0, 0)),
        }
    }

    fn element(&self) -> Result<Element, String> {
        if let Some(filter) = self.filters().iter().find(|id| !FILTERS.contains(id)) {
            return Ok(Element::Other(format!(
                "compressed by HDF5 filter {filter}, which is not supported; use gzip"
            )));
        }
        if let Some(what) = elsewhere(self) {
            return Ok(Element::Other(what.to_owned()));
        }
        let datatype = self.datatype().map_err(words)?;
        Ok(match &datatype {
            Datatype::Compound { size, members } => {
                let mut fields = Vec::new();
                flatten("", members, 0, &mut fields);
                match Record::new(*size as usize, fields) {
                    Some(record) => Element::Record(record),
                    None => Element::Other(format!("records of {size} bytes")),
                }
            }
            Datatype::Reference {
                ref_type: ReferenceType::DatasetRegion,
                ..
            } => Element::Other("references to regions".to_owned()),
            Datatype::Reference { size, .. } => Element::Reference(*size as usize),
            plain => match number(plain) {
                Ok(number) => Element::Number(number),
                Err(what) => Element::Other(what),
            },
        })
    }

    fn text_attribute(&self, name: &str) -> Option<String> {
        let attributes = self.attrs().ok()?;
        let value = attributes.get(name)?;
        let one = value.as_strings().and_then(|all| match all {
            [one] => Some(one.as_str()),
            _ => None,
        });
        value.as_str().or(one).map(str::to_owned)
    }

    fn has_attribute(&self, name: &str) -> bool {
        self.attr_datatypes()
            .is_ok_and(|attributes| attributes.contains_key(name))
    }

    fn rows(&self, start: u64, count: u64) -> Result<Vec<u8>, String> {
        self.read_raw_rows(start, count).map_err(words)
    }

    fn targets(&self) -> Result<Vec<Node>, String> {
        let objects = self.dereference().map_err(words)?;
        objects
            .into_iter()
            .map(|object| match object {
                Object::Group(group) => Ok(Node::Group(Box::new(group))),
                Object::Dataset(dataset) => Ok(Node::Dataset(dataset)),
                _ => Err("a reference to something other than a group or dataset".to_owned()),
            })
            .collect()
    }
}

/// Why the elements of a dataset cannot be found, where that is no damage.
fn elsewhere(dataset: &hdf5_pure::Dataset) -> Option<&'static str> {
    let layout = match dataset.layout() {
        Err(Error::Format(FormatError::InvalidLayoutVersion(_))) => {
            return Some("a layout of another version; write it with libver 'v114' or 'earliest'");
        }
        layout => layout.ok()?,
    };
    match layout {
        Layout::Virtual => Some("a virtual dataset; copy its values into the file"),
        Layout::Chunked {
            index: ChunkIndex::BTreeV2,
            ..
        } => Some("chunks that grow in more than one direction; write it with libver 'earliest'"),
        // No row is read, which tells all the same.
        Layout::Contiguous { address: None, .. } => match dataset.read_raw_rows(u64::MAX, 0) {
            Err(Error::Format(FormatError::UnsupportedExternalStorage)) => {
                Some("values in another file; copy them into this one")
            }
            _ => None,
        },
        _ => None,
    }
}

/// The number format of a type, or what the type is instead.
fn number(datatype: &Datatype) -> Result<Number, String> {
    let order = |order: &DatatypeByteOrder| match order {
        DatatypeByteOrder::LittleEndian => Ok(ByteOrder::Little),
        DatatypeByteOrder::BigEndian => Ok(ByteOrder::Big),
        DatatypeByteOrder::Vax => Err("numbers in VAX order".to_owned()),
    };
    let found = match datatype {
        Datatype::FixedPoint {
            size,
            byte_order,
            layout,
        } => {
            let class = if layout.signed {
                Class::Signed
            } else {
                Class::Unsigned
            };
            let full =
                layout.bit_offset == 0 && u64::from(layout.bit_precision) == u64::from(*size) * 8;
            full.then_some((class, *size, byte_order))
        }
        Datatype::FloatingPoint {
            size,
            byte_order,
            layout,
        } => ieee(layout, *size).then_some((Class::Float, *size, byte_order)),
        Datatype::Enumeration { base_type, .. }
            if matches!(
                **base_type,
                Datatype::FixedPoint { .. } | Datatype::FloatingPoint { .. }
            ) =>
        {
            return number(base_type);
        }
        Datatype::String { .. }
        | Datatype::VariableLength {
            is_string: true, ..
        } => return Err("text".to_owned()),
        Datatype::VariableLength { .. } => return Err("lists of varying length".to_owned()),
        Datatype::Compound { .. } => return Err("records".to_owned()),
        Datatype::Array { .. } => return Err("elements that are arrays".to_owned()),
        Datatype::Time { .. } => return Err("times".to_owned()),
        _ => return Err("not numbers".to_owned()),
    };
    let unusual = || "numbers in an unsupported format".to_owned();
    let (class, size, byte_order) = found.ok_or_else(unusual)?;
    Number::new(class, size as usize, order(byte_order)?).ok_or_else(unusual)
}

/// Whether the type is IEEE 754 binary16, 32 or 64.
fn ieee(layout: &FloatingPointLayout, size: u32) -> bool {
    let (bits, mantissa, bias) = match size {
        2 => (16, 10, 15),
        4 => (32, 23, 127),
        8 => (64, 52, 1023),
        _ => return false,
    };
    layout.bit_offset == 0
        && layout.bit_precision == bits
        && layout.mantissa_location == 0
        && layout.mantissa_size == mantissa
        && layout.exponent_location == mantissa
        && u16::from(layout.exponent_size) == bits - 1 - u16::from(mantissa)
        && layout.exponent_bias == bias
}

/// Appends the members of a compound type that starts at `offset`.
fn flatten(
    prefix: &str,
    members: &[hdf5_pure::CompoundMember],
    offset: usize,
    out: &mut Vec<Field>,
) {
    for member in members {
        let name = match prefix {
            "" => member.name.clone(),
            prefix => format!("{prefix}.{}", member.name),
        };
        let here = usize::try_from(member.byte_offset).unwrap_or(usize::MAX);
        let offset = offset.saturating_add(here);
        match &member.datatype {
            Datatype::Compound { members, .. } => flatten(&name, members, offset, out),
            plain => out.push(Field {
                name,
                offset,
                cell: number(plain).map_or_else(Cell::Other, Cell::Number),
            }),
        }
    }
}
