//! HDF5 files: MAT files of version 7.3, and what h5py and others write.
//!
//! Groups and MATLAB structs become `group.dataset`, elements of cells `name{1}`, compound types
//! `dataset.member`. Members of a group stand in the order of their names, since HDF5 keeps no
//! other. An attribute `unit` or `units` is the unit of its dataset. MATLAB (attribute
//! `MATLAB_class`) stores arrays with their axes reversed; those are turned back, so `q(:,1)` is the
//! first column of `q` as its author saw it, from either program.

mod prepare;
mod pure;
mod tree;
mod window;

use std::io::Read;
use std::path::Path;

use tree::{Dataset, Element, Group, Node};
use window::Window;

use crate::binary::{Collector, Layout, Order, guard};
use crate::limits::Budget;
use crate::{Error, Kind, Limits, Table};

/// Deepest nesting of groups or cells; MATLAB and h5py files of recordings use two or three levels.
const MAX_DEPTH: usize = 16;

/// Bytes that the datasets of the smallest file may have.
const UNPACKED: u64 = 1 << 20;

/// Bytes that the decoder holds for each chunk, about.
const CHUNK: u64 = 256;

/// Reads every dataset of numbers.
pub(crate) fn read(path: &Path, bytes: u64, limits: Limits) -> Result<Table, Error> {
    guard("HDF5", || {
        // The decoder holds the file.
        let mut collector = Collector::packed(Budget::beside(limits, bytes)?, bytes, UNPACKED);
        let root = pure::open(path).map_err(broken)?;
        group(root.as_ref(), "", 0, &mut collector)?;
        Ok(collector.finish())
    })
}

fn broken(found: String) -> Error {
    Error::new(
        Kind::Format,
        format!("broken or unsupported HDF5 ({found})"),
        "a file as MATLAB (save -v7.3) or h5py writes it",
    )
}

fn group(
    group: &dyn Group,
    path: &str,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    let fail = |found| broken(found).in_column(if path.is_empty() { "/" } else { path });
    if depth > MAX_DEPTH {
        return Err(fail(format!("groups are nested deeper than {MAX_DEPTH}")));
    }
    let mut members = group.members().map_err(fail)?;
    members.sort_by(|a, b| a.0.cmp(&b.0));
    for (name, member) in members {
        // MATLAB's store of cell elements and objects; what it holds is found from the outside.
        if name.starts_with('#') {
            collector.entry()?;
            continue;
        }
        let path = match path {
            "" => name,
            path => format!("{path}.{name}"),
        };
        node(&member, &path, depth, collector)?;
    }
    Ok(())
}

fn node(node: &Node, path: &str, depth: usize, collector: &mut Collector) -> Result<(), Error> {
    collector.entry()?;
    match node {
        Node::Group(inner) => group(inner.as_ref(), path, depth + 1, collector),
        Node::Dataset(inner) => dataset(inner.as_ref(), path, depth, collector).map_err(|error| {
            match error.place.column {
                None => error.in_column(path),
                Some(_) => error,
            }
        }),
    }
}

fn dataset(
    dataset: &dyn Dataset,
    name: &str,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    let class = dataset.text_attribute("MATLAB_class");
    if let Some("char") = class.as_deref() {
        collector.skip(name, "text");
        return Ok(());
    }
    if dataset.has_attribute("MATLAB_empty") {
        collector.skip(name, "empty");
        return Ok(());
    }
    let element = dataset.element().map_err(broken)?;
    let width = match &element {
        Element::Other(what) => {
            collector.skip(name, what);
            return Ok(());
        }
        Element::Reference(width) => *width,
        Element::Record(record) => record.bytes(),
        Element::Number(number) => number.width(),
    };
    let mut dims = dataset.dims().map_err(broken)?;
    let chunk = dataset.chunk().map_err(broken)?;
    if let Some(why) = beyond(dataset, &dims, &chunk, width, collector).map_err(broken)? {
        collector.skip(name, why);
        return Ok(());
    }
    // A chunk is unpacked as a whole, whatever its elements are.
    let mut unpacked = chunk.clone();
    if let Element::Record(record) = &element {
        unpacked.push(record.bytes().div_ceil(8) as u64);
    }
    collector.fits(name, &unpacked)?;
    let stream = |dims: &[u64]| Window::new(dataset, dims, &chunk, width);
    let cut = |error: std::io::Error| broken(error.to_string());
    match element {
        Element::Other(_) => {}
        Element::Reference(_) => cell(dataset, name, &dims, depth, collector)?,
        Element::Record(_) if class.is_some() => {
            collector.skip(name, "complex numbers; save real(x) and imag(x)");
        }
        Element::Record(record) => {
            let rows = dims.iter().try_fold(1u64, |n, &dim| n.checked_mul(dim));
            let rows = rows.unwrap_or(u64::MAX);
            // One row of a dataset of several axes is unpacked as a whole.
            collector.fits(name, &[rows, record.bytes().div_ceil(8) as u64])?;
            let mut stream = stream(&dims);
            record.columns(name, rows, collector, |row| {
                stream.read_exact(row).map_err(cut)
            })?;
        }
        Element::Number(number) => {
            let mut stream = stream(&dims);
            let order = match class {
                Some(_) => {
                    dims.reverse();
                    Order::Column
                }
                None => Order::Row,
            };
            if let Layout::Skip(why) = Layout::of(&dims) {
                collector.skip(name, &why);
                return Ok(());
            }
            collector.reserve(name, &dims)?;
            let unit = ["unit", "units", "Unit", "Units"]
                .iter()
                .find_map(|name| dataset.text_attribute(name))
                .map(|unit| unit.trim().to_owned())
                .filter(|unit| !unit.is_empty());
            collector
                .numbers(name, unit, (&dims, order), number, &mut stream)
                .map_err(cut)?;
        }
    }
    Ok(())
}

/// Why a dataset, with elements of `width` bytes, is not unpacked: that would take more than the file can hold.
fn beyond(
    dataset: &dyn Dataset,
    dims: &[u64],
    chunk: &[u64],
    width: usize,
    collector: &mut Collector,
) -> Result<Option<&'static str>, String> {
    let edges = chunk.iter().copied().chain(std::iter::repeat(1));
    let counts = dims
        .iter()
        .zip(edges)
        .map(|(&n, edge)| (n.div_ceil(edge.max(1)), edge));
    let (grid, bytes) = counts.fold((1, width as u64), |(grid, bytes), (count, edge)| {
        let whole = count.saturating_mul(edge);
        (
            u64::saturating_mul(grid, count),
            u64::saturating_mul(bytes, whole),
        )
    });
    if !collector.unpacks(bytes) {
        return Ok(Some("larger than the file can hold; was it never written?"));
    }
    // More of them than there are places for would be unpacked one over the other.
    let (chunks, stored) = dataset.chunks(grid, bytes)?;
    let held = chunks.saturating_mul(CHUNK).saturating_add(stored);
    if chunks > grid || !collector.unpacks(held) {
        return Ok(Some("has more chunks than fit in it"));
    }
    Ok(None)
}

/// A cell, or one field of a struct array: `name{1}`, `name{2}` ...
fn cell(
    dataset: &dyn Dataset,
    name: &str,
    dims: &[u64],
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    if depth > MAX_DEPTH {
        return Err(broken(format!("cells are nested deeper than {MAX_DEPTH}")));
    }
    collector.fits(name, dims)?;
    let count = dims.iter().product::<u64>();
    if count > 65_536 {
        collector.skip(name, "a cell array with too many elements");
        return Ok(());
    }
    let targets = dataset.targets().map_err(broken)?;
    for (index, target) in targets.iter().enumerate() {
        node(
            target,
            &format!("{name}{{{}}}", index + 1),
            depth + 1,
            collector,
        )?;
    }
    Ok(())
}
