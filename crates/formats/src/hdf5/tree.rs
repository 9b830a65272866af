//! What the reader asks of an HDF5 library, so that the library can be replaced.

use crate::binary::{Number, Record};

/// A member of a group, or what a reference points at.
pub(super) enum Node {
    Group(Box<dyn Group>),
    Dataset(Box<dyn Dataset>),
}

/// A group. Errors are the words of the library.
pub(super) trait Group {
    /// Members and their names, in no order that means anything.
    fn members(&self) -> Result<Vec<(String, Node)>, String>;
}

/// A dataset. Errors are the words of the library.
pub(super) trait Dataset {
    /// Lengths of the axes, slowest first; none for a single value.
    fn dims(&self) -> Result<Vec<u64>, String>;

    /// Lengths of the axes of one chunk, which is unpacked as a whole; none where there are none.
    fn chunk(&self) -> Result<Vec<u64>, String>;

    /// Chunks that the file has of it, and the bytes that they take there, of a dataset that would have `grid` of them with
    /// `bytes` unpacked; nothing of a dataset without chunks.
    fn chunks(&self, grid: u64, bytes: u64) -> Result<(u64, u64), String>;

    /// What one element is.
    fn element(&self) -> Result<Element, String>;

    /// An attribute that is one string.
    fn text_attribute(&self, name: &str) -> Option<String>;

    /// Whether there is an attribute of this name.
    fn has_attribute(&self, name: &str) -> bool;

    /// The elements of `count` rows (indices of the first axis) from `start` on, unpacked, in the
    /// format of the file, the last axis running fastest.
    fn rows(&self, start: u64, count: u64) -> Result<Vec<u8>, String>;

    /// What the elements, references to objects, point at.
    fn targets(&self) -> Result<Vec<Node>, String>;
}

/// What one element of a dataset is.
pub(super) enum Element {
    Number(Number),
    Record(Record),
    /// A reference to an object, of this many bytes.
    Reference(usize),
    /// Not numbers, and what it is instead.
    Other(String),
}
