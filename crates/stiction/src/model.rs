//! An identified law as a file.

use crate::{Error, Export, Law, Target};
use std::path::Path;
use stiction_files::ModelFile;
use stiction_friction::compensator::Compensator;
use stiction_parameters::{LawKind, Name};

/// A law with its intervals and where they came from, as `model.toml` keeps it: what [`Export`] and studies take.
#[derive(Clone, Debug, PartialEq)]
pub struct Model(pub(crate) ModelFile);

impl Model {
    /// Reads a model file.
    ///
    /// # Errors
    /// Where it cannot be read, or contradicts itself: with line and key.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        ModelFile::read(file).map(Self).map_err(Error::of)
    }

    /// Reads the text of a model file.
    ///
    /// # Errors
    /// As [`Model::read`].
    pub fn parse(text: &str) -> Result<Self, Error> {
        ModelFile::parse(text).map(Self).map_err(Error::of)
    }

    /// The text of its model file.
    pub fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    /// Name of the axis, where it has one.
    pub fn name(&self) -> Option<&str> {
        self.0.name.as_deref()
    }

    /// Family of the law; `None` of one that this version does not know.
    pub fn law_kind(&self) -> Option<LawKind> {
        self.0.law.parse().ok()
    }

    /// Value of a parameter, SI; `None` where the model has none.
    pub fn value(&self, name: impl Into<Name>) -> Option<f64> {
        self.0.values()?.get(name)
    }

    /// The law with its numbers.
    ///
    /// # Errors
    /// Where a value is one that the law cannot have.
    pub fn law(&self) -> Result<Law, Error> {
        match self.0.values() {
            Some(values) => Law::of(&values),
            // Refused with the laws that there are.
            None => Err(Error::of(stiction_files::Error::Config {
                file: "model".into(),
                place: "law: ".into(),
                found: format!("{:?}", self.0.law),
                allowed: LawKind::ALL.map(LawKind::name).join(", "),
            })),
        }
    }

    /// Whether the identification found that it may be used to compensate.
    pub fn is_trustworthy(&self) -> bool {
        self.0.trustworthy
    }

    /// The compensator that [`Export`] writes for [`Target::Rust`], as a value to be stepped every `cycle_time` seconds.
    ///
    /// # Errors
    /// Where the law cannot be exported, or the cycle time is out of range.
    pub fn compensator(&self, cycle_time: f64) -> Result<Compensator<f64>, Error> {
        Export::new(Target::Rust, cycle_time).compensator(self)
    }
}
