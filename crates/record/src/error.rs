//! Why nothing, or no more, can be recorded.

use std::path::{Path, PathBuf};
use stiction_codes::Code;

/// What is wrong with a device or the way to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// No connection can be made.
    Unreachable,
    /// The connection ended.
    Closed,
    /// The device is connected and sends nothing.
    Silent,
    /// The device refuses a request.
    Refused,
    /// What the device sends does not follow its protocol.
    Malformed,
    /// The clock of the device was set back.
    Restarted,
}

/// A recording that cannot begin or go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An address, rate or file name that cannot be used.
    #[error("{found}; {allowed}")]
    Usage {
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// The device, or the way to it.
    #[error("{address}: {reason}")]
    Device {
        /// The address, as `host:port`.
        address: String,
        /// What is wrong.
        fault: Fault,
        /// The same in words, with a remedy.
        reason: String,
    },
    /// The log cannot be written.
    #[error("{}: {}", .path.display(), why(source))]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

impl Error {
    /// Stable code, the name of a page in `docs/codes/`.
    pub fn code(&self) -> Code {
        match self {
            Error::Usage { .. } => Code::Usage,
            Error::Device { .. } => Code::Device,
            Error::File { .. } => Code::Output,
        }
    }

    pub(crate) fn usage(found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Error::Usage {
            found: found.into(),
            allowed: allowed.into(),
        }
    }

    pub(crate) fn device(address: &str, fault: Fault, reason: impl Into<String>) -> Self {
        Error::Device {
            address: address.into(),
            fault,
            reason: reason.into(),
        }
    }

    pub(crate) fn file(path: &Path, source: std::io::Error) -> Self {
        Error::File {
            path: path.to_path_buf(),
            source,
        }
    }
}

fn why(e: &std::io::Error) -> String {
    use std::io::ErrorKind as Kind;
    match e.kind() {
        Kind::StorageFull | Kind::QuotaExceeded => {
            "the disk, or the share of it that may be used, is full".into()
        }
        Kind::PermissionDenied => "permission denied".into(),
        Kind::NotFound => "no such folder".into(),
        _ => e.to_string(),
    }
}
