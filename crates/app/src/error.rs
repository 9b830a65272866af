//! What goes wrong in a workflow, with a stable code and an exit class.

use std::path::{Path, PathBuf};
use stiction_codes::Code;

/// A workflow that could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A recording was refused.
    #[error("{0}")]
    Log(#[from] stiction_log::Error),
    /// A record cannot be identified.
    #[error("{inputs}: {source}")]
    Identify {
        /// The logs, for the message.
        inputs: String,
        /// Why.
        source: stiction_identify::Error,
    },
    /// A file of our own form was refused.
    #[error("{}: {place}{found}; {allowed}", .file.display())]
    Config {
        /// The file.
        file: PathBuf,
        /// Line and key, ending in `: `, or empty.
        place: String,
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// A checkpoint that cannot be taken up.
    #[error("{}: {found}; {allowed}", .file.display())]
    Checkpoint {
        /// The file.
        file: PathBuf,
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// A model cannot be exported.
    #[error("{0}")]
    Export(#[from] stiction_export::Error),
    /// A model cannot be exported because of a number in its file.
    #[error("{}: parameter: {source}", .file.display())]
    ExportModel {
        /// The file.
        file: PathBuf,
        /// Why.
        source: stiction_export::Error,
    },
    /// The command as typed cannot be carried out.
    #[error("{found}; {allowed}")]
    Usage {
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// The output folder cannot be used.
    #[error("{}: {reason}", .path.display())]
    Output {
        /// The folder or file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

impl Error {
    /// Stable code, the name of a page in `docs/codes/`.
    pub fn code(&self) -> Code {
        use stiction_identify::Error as Fit;
        match self {
            Error::Log(e) => e.kind.code(),
            Error::Identify { source, .. } => match source {
                Fit::TooFewSamples { .. } => Code::TooFewSamples,
                Fit::NoMotion { .. } => Code::NoMotion,
                Fit::NoForce { .. } => Code::NoForce,
                Fit::TooFewSpeeds { .. } => Code::TooFewSpeeds,
                Fit::NoStep { .. } => Code::NoStep,
                Fit::NoBreakAway { .. } => Code::NoBreakAway,
                Fit::Setting { .. } | Fit::Filter { .. } => Code::BadSetting,
                Fit::NotSimulated { .. } => Code::NotSimulated,
                Fit::NoMotionChannel { .. }
                | Fit::MissingChannel { .. }
                | Fit::Length { .. }
                | Fit::NotFinite { .. }
                | Fit::Time { .. } => Code::BadRecord,
            },
            Error::Config { .. } => Code::BadConfig,
            Error::Checkpoint { .. } => Code::BadCheckpoint,
            Error::Export(_) | Error::ExportModel { .. } => Code::NotExported,
            Error::Usage { .. } => Code::Usage,
            Error::Output { .. } => Code::Output,
        }
    }

    pub(crate) fn output(path: &Path, reason: impl Into<String>) -> Self {
        Error::Output {
            path: path.to_path_buf(),
            reason: reason.into(),
        }
    }

    pub(crate) fn usage(found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Error::Usage {
            found: found.into(),
            allowed: allowed.into(),
        }
    }
}

/// Something a user should know although the work went on.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Warning {
    /// What it is; each code has a page in `docs/codes/`.
    pub code: Code,
    /// What was seen, with numbers.
    pub message: String,
}

impl Warning {
    pub(crate) fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
        }
    }
}
