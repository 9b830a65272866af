//! `[[log]]`: which part of which log is fitted, and which is validated on.

use std::path::{Path, PathBuf};
use stiction_log::Mapping;
use stiction_log::mapping::Parts;

/// Most stretches that are named.
const MOST_NAMED: usize = 4;

/// What is validated on of a log.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Validated {
    /// Nothing.
    None,
    /// The whole log, of which nothing is fitted.
    All,
    /// Stretches, s from the first sample of the file.
    Stretches(Vec<(f64, f64)>),
}

/// Whether a part of a log is fitted or validated on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Parameters follow from it.
    Fitted,
    /// They are held against it.
    Validated,
}

/// A log that the axis file names.
#[derive(Clone, Debug)]
pub struct ListedLog {
    /// The file, from the folder of the axis file.
    pub file: PathBuf,
    /// The key of the axis file: `log[1]`.
    pub key: String,
    /// How its columns are read, without its parts.
    pub(super) mapping: Mapping,
    /// What is fitted, s from the first sample of the file; `None` for all that is not validated on.
    pub(super) fit: Option<Vec<(f64, f64)>>,
    pub(super) validated: Validated,
}

impl ListedLog {
    /// Whether this is the log at a path.
    pub fn is(&self, path: &Path) -> bool {
        let same = |a: &Path, b: &Path| Some(a.canonicalize().ok()? == b.canonicalize().ok()?);
        same(&self.file, path).unwrap_or(self.file == path)
    }

    /// Whether a part of the log is left out, or is for something else than the rest.
    pub fn has_parts(&self) -> bool {
        self.fit.is_some() || self.validated != Validated::None
    }

    /// How a part is read; `None` where there is no such part.
    pub fn mapping(&self, part: Use) -> Option<Mapping> {
        let parts = match (part, &self.fit, &self.validated) {
            (Use::Fitted, _, Validated::All) | (Use::Validated, _, Validated::None) => return None,
            (Use::Fitted, None, Validated::None) | (Use::Validated, _, Validated::All) => None,
            (Use::Fitted, Some(fit), _) => Some(Parts::inside(fit.clone())),
            (Use::Fitted, None, Validated::Stretches(others)) => {
                Some(Parts::outside(others.clone()))
            }
            (Use::Validated, _, Validated::Stretches(own)) => Some(Parts::inside(own.clone())),
        };
        Some(Mapping {
            parts,
            ..self.mapping.clone()
        })
    }

    /// A part in words; `None` where it is the whole log.
    pub fn words(&self, part: Use) -> Option<String> {
        let words = |stretches: &[(f64, f64)]| {
            let each = stretches.iter().take(MOST_NAMED);
            let each: Vec<String> = each.map(|(from, to)| format!("{from} to {to} s")).collect();
            match stretches.len().saturating_sub(MOST_NAMED) {
                0 => each.join(", "),
                more => format!("{} and {more} more", each.join(", ")),
            }
        };
        let parts = self.mapping(part)?.parts?;
        let stretches = words(parts.stretches());
        Some(match parts.are_inside() {
            true => stretches,
            false => format!("all but {stretches}"),
        })
    }

    /// The key of this log that a setting of the reader is about, such as `log.crop`; other settings as they are.
    pub fn written(&self, setting: &str, part: Use) -> String {
        match setting.strip_prefix("log.") {
            Some("parts") => match part {
                Use::Fitted if self.fit.is_some() => format!("{}.fit", self.key),
                _ => format!("{}.validate", self.key),
            },
            Some(own) => format!("{}.{own}", self.key),
            None => setting.into(),
        }
    }
}
