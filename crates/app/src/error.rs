//! What goes wrong in a workflow, with a stable code and an exit class.

use std::path::{Path, PathBuf};

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
    pub fn code(&self) -> &'static str {
        use stiction_identify::Error as Fit;
        match self {
            Error::Log(e) => e.kind.code(),
            Error::Identify { source, .. } => match source {
                Fit::TooFewSamples { .. } => "too-few-samples",
                Fit::NoMotion { .. } => "no-motion",
                Fit::NoForce { .. } => "no-force",
                Fit::TooFewSpeeds { .. } => "too-few-speeds",
                Fit::NoStep { .. } => "no-step",
                Fit::NoBreakAway { .. } => "no-break-away",
                Fit::Setting { .. } | Fit::Filter { .. } => "bad-setting",
                Fit::NotSimulated { .. } => "not-simulated",
                Fit::NoMotionChannel { .. }
                | Fit::MissingChannel { .. }
                | Fit::Length { .. }
                | Fit::NotFinite { .. }
                | Fit::Time { .. } => "bad-record",
            },
            Error::Config { .. } => "bad-config",
            Error::Checkpoint { .. } => "bad-checkpoint",
            Error::Export(_) | Error::ExportModel { .. } => "not-exported",
            Error::Usage { .. } => "usage",
            Error::Output { .. } => "output",
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
    /// Stable code, the name of a page in `docs/codes/`.
    pub code: String,
    /// What was seen, with numbers.
    pub message: String,
}

impl Warning {
    pub(crate) fn new(code: &str, message: impl Into<String>) -> Self {
        Self {
            code: code.to_string(),
            message: message.into(),
        }
    }
}
