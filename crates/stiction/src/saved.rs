//! A fit as its folder keeps it.

use crate::findings::findings;
use crate::{Error, Law, Model};
use std::path::{Path, PathBuf};
use stiction_files::result::ResultFile;

/// What [`Fit::write`](crate::Fit::write) or `stiction identify` left in a folder: all that was found, without the logs. What needs the
/// record, such as a prediction, needs a [`Fit`](crate::Fit).
#[derive(Clone, Debug)]
pub struct SavedFit {
    saved: stiction_pages::SavedFit,
    result: Box<ResultFile>,
}

findings!(SavedFit, |saved| &saved.result);

impl SavedFit {
    /// Reads the files of a folder.
    ///
    /// # Errors
    /// Where a file is missing, cannot be read, or is none of a fit.
    pub fn read(folder: impl AsRef<Path>) -> Result<Self, Error> {
        let saved = stiction_pages::SavedFit::read(folder)?;
        let result = Box::new(saved.result()?);
        Ok(Self { saved, result })
    }

    /// The law as `model.toml` has it.
    pub fn model(&self) -> Model {
        Model(self.saved.model().clone())
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
        Ok(self.saved.write(folder)?)
    }
}
