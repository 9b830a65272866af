//! What goes wrong with a file, with a stable code; and what a user should know although the work goes on.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_number::short;
use stiction_say::Notice;

/// A file that cannot be read, understood or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A recording was refused.
    #[error("{0}")]
    Log(#[from] stiction_formats::Error),
    /// An axis, model or study file was refused.
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
    /// A file that is something else than what is read here.
    #[error("{}: is {found}; {wanted} is wanted{}", .file.display(), here(.instead.as_deref()))]
    OtherForm {
        /// The file.
        file: PathBuf,
        /// What it is.
        found: String,
        /// What is wanted.
        wanted: &'static str,
        /// A file of that form beside it.
        instead: Option<PathBuf>,
    },
    /// Everything that is wrong with one file, or with a recording and its axis file: two things or more, a line each.
    #[error("{}", lines(.0))]
    Several(Vec<Error>),
    /// A value of an axis file that does not go with a recording.
    #[error("{}: {place}{found}; {allowed}", .file.display())]
    Misfit {
        /// The axis file.
        file: PathBuf,
        /// Line and key, ending in `: `.
        place: String,
        /// What was found, with the recording.
        found: String,
        /// What is allowed.
        allowed: String,
        /// What is wrong with it.
        code: Code,
    },
    /// More would be simulated than is allowed at once.
    #[error(
        "{what}: {found}; at most {} are simulated unless more are allowed",
        short(*.allowed as f64)
    )]
    TooLarge {
        /// The study, or what searches are compared on.
        what: String,
        /// Runs and samples, and what multiplies to them.
        found: String,
        /// So many samples would have to be allowed.
        needed: u64,
        /// So many are.
        allowed: u64,
    },
    /// Runs that were kept are not of this work.
    #[error("{}: {found}; go on with what they are of, or begin anew", .path.display())]
    Runs {
        /// The file that holds them.
        path: PathBuf,
        /// What was found.
        found: String,
    },
    /// The output folder cannot be used.
    #[error("{}: {reason}", .path.display())]
    Output {
        /// The folder or file.
        path: PathBuf,
        /// Why.
        reason: String,
        /// Whether there is no room left.
        is_full: bool,
    },
    /// The output folder, or a file in it, is something that would be lost.
    #[error("{}: {found}; choose another folder{}", .path.display(), if *.may_force { ", or ask for it to be written into all the same" } else { "" })]
    Taken {
        /// The folder or file.
        path: PathBuf,
        /// What is there.
        found: Cow<'static, str>,
        /// Whether it may be written into all the same, where that is asked for.
        may_force: bool,
    },
}

impl Error {
    /// Stable code, the name of a page in `docs/codes/`.
    pub fn code(&self) -> Code {
        match self {
            Error::Log(e) => e.kind.code(),
            Error::Several(all) => all.first().map_or(Code::BadConfig, Error::code),
            Error::Config { .. } | Error::OtherForm { .. } => Code::BadConfig,
            Error::Misfit { code, .. } => *code,
            Error::Runs { .. } => Code::BadCheckpoint,
            Error::TooLarge { .. } => Code::TooLarge,
            Error::Output { .. } | Error::Taken { .. } => Code::Output,
        }
    }

    /// The typed files that have to be corrected, each with its line where one is known, counted from 1.
    pub fn to_correct(&self) -> Vec<(&Path, Option<usize>)> {
        match self {
            Error::Several(all) => all.iter().flat_map(Error::to_correct).collect(),
            Error::Config { file, place, .. } | Error::Misfit { file, place, .. } => {
                vec![(file, line(place))]
            }
            _ => Vec::new(),
        }
    }

    /// Whether something could not be written because there is no room left.
    pub fn is_full_disk(&self) -> bool {
        matches!(self, Error::Output { is_full: true, .. })
    }

    /// One error of all that were found, if any were.
    pub(crate) fn of_all(mut found: Vec<Error>) -> Option<Self> {
        match found.len() {
            0 | 1 => found.pop(),
            _ => Some(Error::Several(found)),
        }
    }

    /// A folder or file that cannot be written, and why.
    pub fn output(path: &Path, reason: impl Into<String>) -> Self {
        Error::Output {
            path: path.to_path_buf(),
            reason: reason.into(),
            is_full: false,
        }
    }

    /// A folder or file that the system does not let be written.
    pub(crate) fn io(path: &Path, e: &std::io::Error) -> Self {
        Error::Output {
            path: path.to_path_buf(),
            reason: why(e),
            is_full: is_full(e),
        }
    }

    pub(crate) fn taken(path: &Path, found: impl Into<Cow<'static, str>>, may_force: bool) -> Self {
        Error::Taken {
            path: path.to_path_buf(),
            found: found.into(),
            may_force,
        }
    }
}

fn is_full(e: &std::io::Error) -> bool {
    use std::io::ErrorKind as Kind;
    matches!(e.kind(), Kind::StorageFull | Kind::QuotaExceeded)
}

/// What went wrong with a file that is written, in words.
pub(crate) fn why(e: &std::io::Error) -> String {
    use std::io::ErrorKind as Kind;
    match e.kind() {
        Kind::PermissionDenied => "permission denied".into(),
        _ if is_full(e) => "the disk, or the share of it that may be used, is full".into(),
        Kind::NotFound => "no such folder".into(),
        Kind::InvalidFilename => {
            "is longer than a disk takes: a name mostly 255 bytes, the whole path 4096".into()
        }
        _ => e.to_string(),
    }
}

/// The line of a place such as `line 3, column 8, rate: `.
fn line(place: &str) -> Option<usize> {
    let (number, _) = place.strip_prefix("line ")?.split_once(',')?;
    number.parse().ok()
}

fn here(instead: Option<&Path>) -> String {
    instead.map_or(String::new(), |path| format!(": {}", path.display()))
}

fn lines(all: &[Error]) -> String {
    let lines: Vec<_> = all.iter().map(Error::to_string).collect();
    lines.join("\n")
}

/// Something a user should know although the work went on.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Warning {
    /// What it is; each code has a page in `docs/codes/`.
    pub code: Code,
    /// What was seen, with numbers.
    pub message: String,
    #[serde(skip)]
    kind: Option<Box<Notice>>,
}

impl Warning {
    /// A warning with its code.
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            kind: None,
        }
    }

    /// What it is, with its numbers; `None` where only its words are known, as after it was read from a file.
    pub fn kind(&self) -> Option<&Notice> {
        self.kind.as_deref()
    }

    /// Whether it says no more than what was done or assumed; after it was read from a file, nothing is known of that.
    pub fn is_note(&self) -> bool {
        matches!(self.kind(), Some(Notice::Robot(own)) if own.is_note())
    }
}

impl PartialEq for Warning {
    fn eq(&self, other: &Self) -> bool {
        (self.code, &self.message) == (other.code, &other.message)
    }
}

impl Eq for Warning {}

impl From<Notice> for Warning {
    fn from(notice: Notice) -> Self {
        Self {
            code: notice.code(),
            message: notice.to_string(),
            kind: Some(Box::new(notice)),
        }
    }
}
