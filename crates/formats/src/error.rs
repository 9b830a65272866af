//! Why a recording was refused: the file, the place in it, what was found, what is allowed.
//!
//! The text of an [`Error`] ends in what is allowed or what to do, and has a line for each thing that has to be decided; [`Kind::code`] names its page in `docs/codes`.

use std::borrow::Cow;
use std::fmt;
use std::path::{Path, PathBuf};
use stiction_codes::Code;

/// The kind of problem; each has a stable code and a page in `docs/codes/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The file cannot be opened or read.
    Io,
    /// The bytes do not follow the format they claim.
    Format,
    /// The file is larger, or asks for more memory, than is allowed.
    Limit,
    /// More than one reading is possible; the message lists the choices.
    Ambiguous,
    /// Something that is needed is missing (a column, a rate).
    Missing,
    /// A unit or scale is unknown or of the wrong dimension.
    Unit,
    /// Time stamps that no documented rule can repair.
    Time,
    /// A number outside what is allowed.
    Value,
}

impl Kind {
    /// Stable code of this kind, the name of its page in `docs/codes/`.
    pub fn code(self) -> Code {
        match self {
            Kind::Io => Code::LogIo,
            Kind::Format => Code::LogFormat,
            Kind::Limit => Code::LogLimit,
            Kind::Ambiguous => Code::LogAmbiguous,
            Kind::Missing => Code::LogMissing,
            Kind::Unit => Code::LogUnit,
            Kind::Time => Code::LogTime,
            Kind::Value => Code::LogValue,
        }
    }
}

/// What a place in a file is counted in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Counted {
    /// Rows of a sheet, or records, as what shows such a file counts them.
    #[default]
    Rows,
    /// Lines of a text, as an editor counts them, with those of its head.
    Lines,
    /// Rows of samples, without those of a head.
    DataRows,
}

impl Counted {
    fn name(self) -> &'static str {
        match self {
            Counted::Rows => "row",
            Counted::Lines => "line",
            Counted::DataRows => "data row",
        }
    }
}

/// Where in a file the problem is; every part is optional.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Line or row, counted from 1.
    pub row: Option<u64>,
    /// What `row` counts.
    pub counted: Counted,
    /// Column by its name, or its number counted from 1.
    pub column: Option<Box<str>>,
    /// Byte offset from the start of the file.
    pub byte: Option<u64>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        if let Some(row) = self.row {
            parts.push(format!("{} {row}", self.counted.name()));
        }
        if let Some(column) = &self.column {
            parts.push(format!("column {column}"));
        }
        if let Some(byte) = self.byte {
            parts.push(format!("byte {byte}"));
        }
        f.write_str(&parts.join(", "))
    }
}

/// What few errors have.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Rest {
    /// The key of the axis file that it is about.
    setting: Option<Cow<'static, str>>,
    /// Whether a line of the axis file, which `allowed` has, settles it.
    settled: bool,
    /// What else is wrong with the same recording.
    others: Vec<Error>,
}

/// A recording that was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The kind of problem.
    pub kind: Kind,
    /// The file, where known.
    pub file: Option<PathBuf>,
    /// The place in the file.
    pub place: Place,
    /// What was found.
    pub found: String,
    /// What is allowed, or what to do; empty where nothing useful can be said.
    pub allowed: String,
    /// Boxed, so that an error stays small.
    rest: Option<Box<Rest>>,
}

impl Error {
    /// A problem of this kind: what was found, and what is allowed instead.
    pub fn new(kind: Kind, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self {
            kind,
            file: None,
            place: Place::default(),
            found: found.into(),
            allowed: allowed.into(),
            rest: None,
        }
    }

    /// The same problem, about the value of this key of the axis file.
    #[must_use]
    pub fn of_setting(mut self, key: impl Into<Cow<'static, str>>) -> Self {
        self.rest.get_or_insert_default().setting = Some(key.into());
        self
    }

    /// The key of the axis file whose value this is about, such as `log.crop`; `None` where it is about the recording alone.
    pub fn setting(&self) -> Option<&str> {
        self.rest.as_ref()?.setting.as_deref()
    }

    /// The same problem, which a line of the axis file settles.
    #[must_use]
    pub fn settled_by_line(mut self) -> Self {
        self.rest.get_or_insert_default().settled = true;
        self
    }

    /// Whether a line of the axis file, which `allowed` has, settles it; else the recording is to be corrected.
    pub fn is_settled_by_line(&self) -> bool {
        self.rest.as_ref().is_some_and(|rest| rest.settled)
    }

    /// The same problem, with what is allowed for it and for everything else that is wrong in other words.
    #[must_use]
    pub fn reworded(mut self, words: &dyn Fn(&str) -> String) -> Self {
        self.allowed = words(&self.allowed);
        for other in self.rest.iter_mut().flat_map(|rest| &mut rest.others) {
            other.allowed = words(&other.allowed);
        }
        self
    }

    /// One error of several of the same recording, each of which stands whatever is done about the others; `None` of none.
    pub fn of_all(found: Vec<Error>) -> Option<Self> {
        let mut found = found.into_iter();
        let mut first = found.next()?;
        let others: Vec<Error> = found.collect();
        if !others.is_empty() {
            first.rest.get_or_insert_default().others = others;
        }
        Some(first)
    }

    /// Everything that is wrong, an error each: first this one without what else is wrong.
    pub fn each(mut self) -> Vec<Error> {
        let others = self
            .rest
            .as_mut()
            .map(|rest| std::mem::take(&mut rest.others));
        let mut all = vec![self];
        all.extend(others.unwrap_or_default());
        all
    }

    /// The same problem, in this file.
    #[must_use]
    pub fn in_file(mut self, file: &Path) -> Self {
        self.file = Some(file.to_path_buf());
        for other in self.rest.iter_mut().flat_map(|rest| &mut rest.others) {
            other.file = Some(file.to_path_buf());
        }
        self
    }

    /// The same problem, at this row counted from 1.
    #[must_use]
    pub fn at_row(mut self, row: u64) -> Self {
        self.place.row = Some(row);
        self
    }

    /// The same problem, at this line of a text counted from 1.
    #[must_use]
    pub fn at_line(mut self, line: u64) -> Self {
        self.place.counted = Counted::Lines;
        self.at_row(line)
    }

    /// The same problem, at this row of samples counted from 1.
    #[must_use]
    pub fn at_data_row(mut self, row: u64) -> Self {
        self.place.counted = Counted::DataRows;
        self.at_row(row)
    }

    /// The same problem, in this column.
    #[must_use]
    pub fn in_column(mut self, column: impl Into<String>) -> Self {
        self.place.column = Some(column.into().into_boxed_str());
        self
    }

    /// The same problem, at this byte offset.
    #[must_use]
    pub fn at_byte(mut self, byte: u64) -> Self {
        self.place.byte = Some(byte);
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}: ", file.display())?;
        }
        if self.place != Place::default() {
            write!(f, "{}: ", self.place)?;
        }
        f.write_str(&self.found)?;
        if !self.allowed.is_empty() {
            write!(f, "; {}", self.allowed)?;
        }
        for other in self.rest.iter().flat_map(|rest| &rest.others) {
            write!(f, "\n{other}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}
