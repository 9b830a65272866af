//! What is known of a machine.

use crate::{Error, Motion};
use std::path::Path;

/// What is known of a machine and its logs: kind, mass, force scale, columns, units, terms beside the friction law. The keys are
/// those of `axis.toml` (docs/axis.md). The default knows nothing: columns and units are those that a file itself names.
///
/// ```
/// use stiction::{Axis, Code};
/// let axis = Axis::parse("kind = \"linear\"\nmass = \"4.6 kg\"\n")?;
/// assert_eq!(axis.name(), None);
/// let refused = Axis::parse("kind = \"round\"\n").unwrap_err();
/// assert_eq!((refused.code(), refused.place()), (Code::BadConfig, "axis: line 1, column 8, kind"));
/// # Ok::<(), stiction::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Axis(pub(crate) stiction_files::Axis);

impl Axis {
    /// Reads an axis file.
    ///
    /// # Errors
    /// Where it cannot be read, or a value in it is refused: with line, column and key.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        stiction_files::Axis::read(file)
            .map(Self)
            .map_err(Error::of)
    }

    /// Reads the text of an axis file. Paths in it are from where the program runs.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse(text: &str) -> Result<Self, Error> {
        stiction_files::Axis::parse(text)
            .map(Self)
            .map_err(Error::of)
    }

    /// Its name, where it has one.
    pub fn name(&self) -> Option<&str> {
        self.0.name.as_deref()
    }

    /// Linear or rotary, where it is stated.
    pub fn motion(&self) -> Option<Motion> {
        self.0.mapping.motion.map(Motion::of)
    }

    /// The file that it was read from.
    pub fn file(&self) -> Option<&Path> {
        self.0.file()
    }
}
