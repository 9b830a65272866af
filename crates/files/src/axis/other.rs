//! Another file, whose columns a log has too: one for a single log, or one for each by its name.

use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

/// What stands for the name of a log, without its ending.
const NAME: &str = "{log}";

/// A file that is named beside a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OtherFile {
    /// This one, which belongs to one log.
    One(PathBuf),
    /// One for each log, such as `{log}_tau.csv`, from the folder of the log.
    OfEachLog(String),
}

impl OtherFile {
    /// The file that is given from a folder, that of the axis file.
    pub(crate) fn given_from(folder: &Path, given: &str) -> Self {
        match given.contains(NAME) {
            true => Self::OfEachLog(given.into()),
            false => Self::One(folder.join(given)),
        }
    }

    /// The file that belongs to a log.
    pub fn of(&self, log: &Path) -> PathBuf {
        let pattern = match self {
            Self::One(file) => return file.clone(),
            Self::OfEachLog(pattern) => pattern,
        };
        let stem = log.file_stem().unwrap_or_default();
        let mut name = OsString::new();
        for (i, part) in pattern.split(NAME).enumerate() {
            if i > 0 {
                name.push(stem);
            }
            name.push(part);
        }
        match log.parent() {
            Some(folder) => folder.join(name),
            None => name.into(),
        }
    }

    /// The file of the one log that it belongs to; `None` where each log has one.
    pub fn of_one_log(&self) -> Option<&Path> {
        match self {
            Self::One(file) => Some(file),
            Self::OfEachLog(_) => None,
        }
    }

    /// As it stands in the axis file, from where the program was started.
    pub(crate) fn given(&self) -> &Path {
        match self {
            Self::One(file) => file,
            Self::OfEachLog(pattern) => Path::new(pattern),
        }
    }
}

impl fmt::Display for OtherFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.given().display().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_log_has_the_file_of_its_name() {
        let of = |given: &str| OtherFile::given_from(Path::new("set"), given);
        let log = Path::new("monday/run.1.csv");
        for (given, file) in [
            ("tau.csv", "set/tau.csv"),
            ("{log}_tau.csv", "monday/run.1_tau.csv"),
            ("../tau/{log}.mat", "monday/../tau/run.1.mat"),
            ("{log}/{log}.csv", "monday/run.1/run.1.csv"),
            ("/all/{log}", "/all/run.1"),
        ] {
            assert_eq!(of(given).of(log), Path::new(file), "{given}");
        }
        assert_eq!(
            of("{log}_b.csv").of(Path::new("a.csv")),
            Path::new("a_b.csv")
        );
    }
}
