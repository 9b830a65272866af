//! What goes wrong in a workflow, with a stable code.

use std::path::PathBuf;
use stiction_codes::Code;

/// A workflow that could not be carried out.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A recording, or an axis, model or study file, was refused; or a file cannot be written.
    #[error("{0}")]
    File(#[from] stiction_files::Error),
    /// A record cannot be identified.
    #[error("{inputs}: {source}")]
    Identify {
        /// The logs, for the message.
        inputs: String,
        /// Why.
        source: stiction_identify::Error,
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
}

impl Error {
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
            Error::Checkpoint { .. } => Code::BadCheckpoint,
            Error::Export(_) | Error::ExportModel { .. } => Code::NotExported,
            Error::Usage { .. } => Code::Usage,
        }
    }

    pub(crate) fn usage(found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Error::Usage {
            found: found.into(),
            allowed: allowed.into(),
        }
    }
}

impl From<stiction_log::Error> for Error {
    fn from(e: stiction_log::Error) -> Self {
        Error::File(e.into())
    }
}
