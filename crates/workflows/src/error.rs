//! What goes wrong in a workflow, with a stable code.

mod parts;

use crate::wording::Wording;
pub use parts::Parts;
use std::path::PathBuf;
use stiction_codes::Code;
use stiction_files::Axis;
use stiction_files::result::Action;
use stiction_number::{full, shortest};

/// A workflow that could not be carried out.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A recording, or an axis, model or study file, was refused; or a file cannot be written.
    #[error("{0}")]
    File(#[from] stiction_files::Error),
    /// A record cannot be identified.
    #[error("{inputs}: {}", of_the_log(source))]
    Identify {
        /// The logs, for the message.
        inputs: String,
        /// Why.
        source: stiction_identify::Error,
        /// What leads on.
        action: Box<Action>,
    },
    /// One log was given twice.
    #[error("{} and {} are the same {}; give each log once, and validate on logs that are not fitted", .first.display(), .second.display(), same(.copied))]
    SameLog {
        /// Its path.
        first: PathBuf,
        /// The other path.
        second: PathBuf,
        /// The samples that agree, where the files differ.
        copied: Option<usize>,
    },
    /// A checkpoint that cannot be taken up.
    #[error("{}: {found}; {allowed}", .file.display())]
    Checkpoint {
        /// The file.
        file: PathBuf,
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: Wording,
    },
    /// A model cannot be exported.
    #[error("{0}")]
    Export(#[from] stiction_export::Error),
    /// A model cannot be exported because of a number in its file.
    #[error("{}: {place}{source}", .file.display())]
    ExportModel {
        /// The file.
        file: PathBuf,
        /// Line and key, ending in `: `.
        place: String,
        /// Why.
        source: stiction_export::Error,
    },
    /// What is to be fed forward is not in the model.
    #[error("{found}; it can feed forward: {}", .instead.join(", "))]
    NotFed {
        /// What is missing.
        found: String,
        /// What of it there is.
        instead: Vec<&'static str>,
    },
    /// What a map is to show is not in the model.
    #[error("target {target}: {reason}")]
    NoMap {
        /// The target.
        target: &'static str,
        /// What is missing, and what brings it in.
        reason: String,
    },
    /// A URDF was refused.
    #[error("{}: {source}", .file.display())]
    Urdf {
        /// The file.
        file: PathBuf,
        /// Why.
        source: Box<stiction_rigid::Error>,
    },
    /// A recording from a device could not begin.
    #[error("{0}")]
    Record(#[from] stiction_record::Error),
    /// The options do not go together with each other or with the logs.
    #[error("{found}; {allowed}")]
    Usage {
        /// What was found.
        found: Wording,
        /// What is allowed.
        allowed: Wording,
    },
}

impl Error {
    /// Where too few samples are left: what became of the others, and how many are needed.
    pub fn losses(&self) -> Option<(&stiction_identify::Losses, usize)> {
        match self {
            Error::Identify {
                source: stiction_identify::Error::TooFewSamples { losses, needed, .. },
                ..
            } => Some((losses, *needed)),
            _ => None,
        }
    }

    /// Stable code, the name of a page in `docs/codes/`.
    pub fn code(&self) -> Code {
        use stiction_identify::Error as Fit;
        match self {
            Error::File(e) => e.code(),
            Error::Identify { source, .. } => match source {
                Fit::TooFewSamples { .. } => Code::TooFewSamples,
                Fit::NoMotion { .. } => Code::NoMotion,
                Fit::NoForce { .. } => Code::NoForce,
                Fit::TooFewSpeeds { .. } => Code::TooFewSpeeds,
                Fit::NoStep { .. } | Fit::FaintStep { .. } => Code::NoStep,
                Fit::NoBreakAway { .. } => Code::NoBreakAway,
                Fit::Setting { .. } | Fit::Filter { .. } => Code::BadSetting,
                Fit::NotSimulated { .. } | Fit::Diverged { .. } => Code::NotSimulated,
                Fit::NoMotionChannel { .. }
                | Fit::MissingChannel { .. }
                | Fit::Length { .. }
                | Fit::NotFinite { .. }
                | Fit::Time { .. } => Code::BadRecord,
            },
            Error::Checkpoint { .. } => Code::BadCheckpoint,
            Error::Export(_)
            | Error::ExportModel { .. }
            | Error::NotFed { .. }
            | Error::NoMap { .. } => Code::NotExported,
            Error::Urdf { .. } => Code::BadUrdf,
            Error::Record(e) => e.code(),
            Error::Usage { .. } | Error::SameLog { .. } => Code::Usage,
        }
    }

    /// The same error with the place of the key whose value the engine refused, if the axis file has that key.
    pub(crate) fn at_axis(self, axis: &Axis) -> Self {
        use stiction_identify::{Error as Fit, SignalError};
        let Error::Identify { inputs, source, .. } = &self else {
            return self;
        };
        let (name, found, allowed) = match source {
            Fit::Setting {
                name,
                found,
                allowed,
            } => (*name, shortest(*found), (*allowed).to_string()),
            Fit::Filter {
                name,
                source:
                    SignalError::Parameter {
                        parameter,
                        found,
                        allowed,
                    },
            } => {
                let found = format!("{parameter} is {}", full(*found));
                (*name, found, format!("allowed: {allowed}"))
            }
            _ => return self,
        };
        let key = match name {
            "source_cutoff" | "common_cutoff" | "decimate" | "min_speed" => {
                format!("conditioning.{name}")
            }
            "mass" => name.into(),
            "segment" | "segments" => "simulation.segment".into(),
            "stribeck_exponent" => format!("terms.{name}"),
            _ if name.starts_with("controller.") => name.into(),
            _ => return self,
        };
        match axis.refuse(&key, format!("{inputs}: {found}"), allowed, self.code()) {
            Some(error) => error.into(),
            None => self,
        }
    }

    /// Logs that cannot be identified, which are to be looked at.
    pub(crate) fn identify(inputs: impl Into<String>, source: stiction_identify::Error) -> Self {
        Error::Identify {
            inputs: inputs.into(),
            source,
            action: Box::new(Action::CHECK),
        }
    }

    pub(crate) fn usage(found: impl Into<Wording>, allowed: impl Into<Wording>) -> Self {
        Error::Usage {
            found: found.into(),
            allowed: allowed.into(),
        }
    }
}

/// What two files have in common.
fn same(copied: &Option<usize>) -> String {
    copied.map_or("log".into(), |samples| {
        format!("recording: time, motion and force agree in all {samples} samples")
    })
}

/// What the engine says of a log without its number, where the path stands before it.
fn of_the_log(source: &stiction_identify::Error) -> String {
    let said = source.to_string();
    let number = source.log().map(|log| format!("log {log}: "));
    let rest = number.and_then(|number| said.strip_prefix(&number).map(str::to_string));
    rest.unwrap_or(said)
}

impl From<stiction_formats::Error> for Error {
    fn from(e: stiction_formats::Error) -> Self {
        Error::File(e.into())
    }
}
