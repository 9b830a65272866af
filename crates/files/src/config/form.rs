//! Which form a file has that a user gives, and which one was asked for.

use crate::error::Error;
use std::io::Read;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// What a file that is read is to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Form {
    /// `axis.toml`.
    #[default]
    Axis,
    /// `model.toml`.
    Model,
    /// `study.toml`.
    Study,
    /// `plan.toml`.
    Plan,
    /// `robot.toml`.
    Robot,
}

/// So much of a file tells what it is, characters or bytes.
const HEAD: usize = 4096;

/// What a file is that is none to type, by the schema that it begins with.
const WRITTEN: [(&str, &str); 7] = [
    ("result", "the result of an identification"),
    ("study", "the result of a study"),
    ("compare", "a comparison of searches"),
    ("reproduce", "the result of published experiments"),
    ("batch", "the summary of a batch"),
    ("drift", "the alarms of a fleet"),
    ("robot", "the result of an identification of a robot"),
];

/// What a text is called whose lines have as many cells as each other.
const TABLE: &str = "a table, such as a log";
/// What a file is called that is a recording by its first bytes.
const RECORDING: &str = "a recording, such as a log";

/// What a file is that is given in place of another, so far as it leads somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Looks {
    /// A recording, or a table that may be one.
    Log,
    /// `axis.toml`.
    Axis,
    /// `model.toml`.
    Model,
    /// `study.toml`.
    Study,
    /// `plan.toml`.
    Plan,
    /// `robot.toml`.
    Robot,
    /// `result.json`.
    Result,
}

impl Looks {
    /// What it is called in messages.
    pub fn what(self) -> &'static str {
        match self {
            Looks::Log => TABLE,
            Looks::Axis => Form::Axis.what(),
            Looks::Model => Form::Model.what(),
            Looks::Study => Form::Study.what(),
            Looks::Plan => Form::Plan.what(),
            Looks::Robot => Form::Robot.what(),
            Looks::Result => "the result of an identification (result.json)",
        }
    }
}

/// What a file looks like by its first lines; `None` where nothing tells it.
pub fn looks(file: &Path) -> Option<Looks> {
    if stiction_formats::is_binary_recording(file) {
        return Some(Looks::Log);
    }
    let text = head(file)?;
    match of_text(&text).as_deref() {
        Some(TABLE) => return Some(Looks::Log),
        Some(found) if found == Looks::Result.what() => return Some(Looks::Result),
        Some(_) => return None,
        None => {}
    }
    Some(match typed_form(file, &text)? {
        Form::Axis => Looks::Axis,
        Form::Model => Looks::Model,
        Form::Study => Looks::Study,
        Form::Plan => Looks::Plan,
        Form::Robot => Looks::Robot,
    })
}

/// Refuses a file where a log is wanted that is one that stiction wrote, or one that a user types.
///
/// # Errors
/// [`Error::OtherForm`], with what the file is.
pub fn refuse_as_log(file: &Path) -> Result<(), Error> {
    let Some(text) = head(file) else {
        return Ok(());
    };
    // Other JSON may be a log.
    let written = of_text(&text).filter(|found| found != TABLE && found != "JSON");
    let found = match written {
        Some(found) => found,
        None => match typed_form(file, &text) {
            Some(form) => form.what().into(),
            None => return Ok(()),
        },
    };
    Err(Error::OtherForm {
        file: file.to_path_buf(),
        found,
        wanted: "a log",
        instead: None,
    })
}

/// The beginning of a file, as text; `None` where it is none.
fn head(file: &Path) -> Option<String> {
    if !stiction_formats::is_regular(file) {
        return None;
    }
    let mut head = Vec::new();
    let open = std::fs::File::open(file).ok()?;
    open.take(HEAD as u64).read_to_end(&mut head).ok()?;
    Some(String::from_utf8_lossy(&head).into_owned())
}

/// The form of a file in TOML, which is read whole only where its beginning could be that.
fn typed_form(file: &Path, head: &str) -> Option<Form> {
    let mut lines = head.trim_start_matches('\u{feff}').lines().map(str::trim);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with('#'))?;
    let key = first.split_once('=').map(|(key, _)| key.trim());
    let is_key = |key: &str| {
        key.chars()
            .all(|c| c.is_ascii_alphanumeric() || "_-.\"".contains(c))
    };
    let may_be = key.is_some_and(is_key) || (first.starts_with('[') && first.ends_with(']'));
    let short = file
        .metadata()
        .is_ok_and(|about| about.len() <= super::typed::MAX_BYTES);
    if !may_be || !short {
        return None;
    }
    let text = std::fs::read_to_string(file).ok()?;
    let tables = DeTable::parse(&text).ok()?;
    of_tables(tables.get_ref())
}

impl Form {
    /// What it is called in messages.
    pub fn what(self) -> &'static str {
        match self {
            Form::Axis => "an axis file",
            Form::Model => "a model file as an identification writes it",
            Form::Study => "a study file",
            Form::Plan => "a plan.toml as stiction plan writes it",
            Form::Robot => "a robot file",
        }
    }

    /// The page that lists every key.
    pub fn page(self) -> &'static str {
        match self {
            Form::Axis => "docs/axis.md",
            Form::Model => "docs/result.md",
            Form::Study => "docs/study.md",
            Form::Plan => "docs/plan.md",
            Form::Robot => "docs/robot.md",
        }
    }

    /// Its name in a folder that stiction wrote; axis files are written by people, under any name.
    fn name(self) -> Option<&'static str> {
        match self {
            Form::Axis => None,
            Form::Model => Some("model.toml"),
            Form::Study => Some("study.toml"),
            Form::Plan => Some("plan.toml"),
            Form::Robot => Some("robot.toml"),
        }
    }

    /// The error of a file that is something else, with the file of this form beside it or in it.
    pub fn instead_of(self, file: &Path, found: String) -> Error {
        let beside = self.name().map(|name| match file.is_dir() {
            true => file.join(name),
            false => file.with_file_name(name),
        });
        Error::OtherForm {
            file: file.to_path_buf(),
            found,
            wanted: self.what(),
            instead: beside.filter(|path| path.is_file() && path != file),
        }
    }
}

/// The form of tables that were read, by keys that no other form has.
pub(super) fn of_tables(entries: &DeTable<'_>) -> Option<Form> {
    let get = |key: &str| entries.get(key).map(|value| value.get_ref());
    let schema = match get("schema") {
        Some(DeValue::String(schema)) => schema.strip_prefix("stiction."),
        _ => None,
    };
    let schema = schema.and_then(|schema| schema.split('/').next());
    let is_table = |key: &str| matches!(get(key), Some(DeValue::Table(_)));
    let is_list = |key: &str| matches!(get(key), Some(DeValue::Array(_)));
    match schema {
        Some("model") => Some(Form::Model),
        Some("plan") => Some(Form::Plan),
        Some("robot") => Some(Form::Robot),
        _ if is_table("joint") || is_table("tool") || get("urdf").is_some() => Some(Form::Robot),
        _ if is_list("parameter") && get("law").is_some() => Some(Form::Model),
        _ if is_table("axis") && (is_list("path") || is_table("path")) => Some(Form::Study),
        _ if is_list("log")
            || [
                "columns",
                "conditioning",
                "ethercat",
                "limits",
                "log",
                "terms",
            ]
            .into_iter()
            .any(is_table) =>
        {
            Some(Form::Axis)
        }
        _ if get("rate").is_some() || get("mass").is_some() => Some(Form::Axis),
        _ => None,
    }
}

/// Whether such a file says no more than a robot file and an axis file both may.
pub(super) fn may_be_both(entries: &DeTable<'_>, wanted: Form) -> bool {
    let both = ["columns", "ethercat", "log", "text", "rate"];
    let mut keys = entries.keys();
    wanted == Form::Robot && keys.all(|key| both.contains(&&**key.get_ref()))
}

/// What a text is that is no TOML, if its beginning tells it.
pub(super) fn of_text(text: &str) -> Option<String> {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let head: String = text.chars().take(HEAD).collect();
    let written = |(kind, what): &(&str, &str)| {
        let is_it = head.contains(&format!("\"stiction.{kind}/"));
        is_it.then(|| format!("{what} ({kind}.json)"))
    };
    if text.starts_with('{') {
        let known = WRITTEN.iter().find_map(written);
        return Some(known.unwrap_or_else(|| "JSON".into()));
    }
    let mut lines = head.lines();
    let line = lines.next().unwrap_or_default();
    let next = lines.next().unwrap_or_default();
    let begins = |with: &str| {
        line.get(..with.len())
            .is_some_and(|l| l.eq_ignore_ascii_case(with))
    };
    if begins("<!doctype html") || begins("<html") {
        return Some("a page for a browser".into());
    }
    let is_toml = line.contains('=') || line.starts_with(['[', '#']);
    let is_table = [',', ';', '\t'].into_iter().any(|mark| {
        let cells = |line: &str| line.matches(mark).count();
        cells(line) > 0 && cells(line) == cells(next)
    });
    (is_table && !is_toml).then(|| TABLE.into())
}

/// What a file is that cannot be read as a text, or is too long for one that a user types.
pub(super) fn of_file(file: &Path) -> Option<String> {
    if file.is_dir() {
        return Some("a folder".into());
    }
    if stiction_formats::is_binary_recording(file) {
        return Some(RECORDING.into());
    }
    of_text(&head(file)?)
}
