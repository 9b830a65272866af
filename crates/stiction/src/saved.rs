//! A fit as its folder keeps it.

use crate::findings::findings;
use crate::{Error, Law, Model};
use std::path::{Path, PathBuf};

/// What [`Fit::write`](crate::Fit::write) or `stiction identify` left in a folder: all that was found, without the logs. What needs the
/// record, such as a prediction, needs a [`Fit`](crate::Fit).
#[derive(Clone, Debug)]
pub struct SavedFit(stiction_pages::SavedFit);

findings!(SavedFit, |saved| saved.0.result());

impl SavedFit {
    /// Reads the files of a folder.
    ///
    /// # Errors
    /// Where a file is missing, cannot be read, or is none of a fit.
    pub fn read(folder: impl AsRef<Path>) -> Result<Self, Error> {
        let saved = stiction_pages::SavedFit::read(folder);
        saved.map(Self).map_err(Error::of)
    }

    /// The law as `model.toml` has it.
    pub fn model(&self) -> Model {
        Model(self.0.model().clone())
    }

    /// The law with its numbers; see [`Fit::law`](crate::Fit::law).
    ///
    /// # Errors
    /// Where a value is one that the law cannot have.
    pub fn law(&self) -> Result<Law, Error> {
        self.model().law()
    }

    /// Writes the files into another folder, whole or not at all; their paths.
    ///
    /// # Errors
    /// Where the folder cannot be written, or holds something that stiction did not write.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        self.0.write(folder).map_err(Error::of)
    }
}
