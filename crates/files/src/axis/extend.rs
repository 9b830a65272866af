//! `check --init` with an axis file: the file as it is, with what was found added to it.

use super::values::Axis;

/// A line that an axis file may lack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Addition {
    /// The table it belongs to; empty for the top level.
    pub table: &'static str,
    /// The key, with other names that it may go by.
    pub names: &'static [&'static str],
    /// Its value as typed.
    pub value: String,
    /// Where it comes from, for people.
    pub why: String,
    /// Whether it takes the place of a line that the file has: the file's own column, with the unit it lacks.
    pub replaces: bool,
}

/// The text with what it lacks, and what was changed, line by line. The rest stays as typed, comments too.
///
/// `text` has to be a valid axis file; where a line cannot be placed, it is named instead.
pub fn extend(text: &str, additions: &[Addition]) -> (String, Vec<String>) {
    let mut out = text.to_string();
    let mut changes = Vec::new();
    for addition in additions {
        let line = format!("{} = {}", addition.names[0], addition.value);
        let place = match addition.table {
            "" => String::new(),
            table if is_list(&out, table) => format!(" under [[{table}]] of the log"),
            table => format!(" under [{table}]"),
        };
        let has = given(&out, addition);
        if has && !addition.replaces {
            continue;
        }
        let next = match has {
            true => replaced(&out, addition),
            false => Some(added(&out, addition.table, &line)),
        };
        let why = &addition.why;
        match next.filter(|next| Axis::parse(next).is_ok()) {
            Some(next) => {
                out = next;
                let done = if has { "changed" } else { "added" };
                changes.push(format!("{done}{place}: {line} ({why})"));
            }
            None => changes.push(format!("to write by hand{place}: {line} ({why})")),
        }
    }
    (out, changes)
}

/// Whether the file has a list of such tables.
fn is_list(text: &str, table: &str) -> bool {
    let root = text.parse::<toml::Table>();
    root.is_ok_and(|root| root.get(table).is_some_and(toml::Value::is_array))
}

/// Whether the file gives a key.
fn given(text: &str, addition: &Addition) -> bool {
    let Ok(root) = text.parse::<toml::Table>() else {
        return true;
    };
    let table = match addition.table {
        "" => Some(&root),
        name => root.get(name).and_then(toml::Value::as_table),
    };
    table.is_some_and(|table| addition.names.iter().any(|name| table.contains_key(*name)))
}

/// Where the lines of a table are: from below its header to the next header.
fn section(text: &str, table: &str) -> Option<std::ops::Range<usize>> {
    let mut at = 0;
    let mut start = if table.is_empty() { Some(0) } else { None };
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim_start();
        if let Some(header) = trimmed.strip_prefix('[') {
            if let Some(start) = start {
                return Some(start..at);
            }
            let header = header.split(']').next().unwrap_or_default();
            if header.trim() == table {
                start = Some(at + line.len());
            }
        }
        at += line.len();
    }
    start.map(|start| start..at)
}

fn added(text: &str, table: &str, line: &str) -> String {
    let mut out = text.to_string();
    if !out.is_empty() && !out.ends_with('\n') {
        out.push('\n');
    }
    match section(&out, table) {
        Some(section) => {
            // Below the last line of the table that says something.
            let said = out[section.clone()].trim_end().len();
            let end = section.start + said + usize::from(said > 0);
            out.insert_str(end, &format!("{line}\n"));
        }
        None => out.push_str(&format!("\n[{table}]\n{line}\n")),
    }
    out
}

/// The file with the line of this key replaced; `None` where it is not on a line of its own.
fn replaced(text: &str, addition: &Addition) -> Option<String> {
    let section = section(text, addition.table)?;
    let mut at = section.start;
    for line in text[section].split_inclusive('\n') {
        let key = line.split('=').next().unwrap_or_default().trim();
        if line.contains('=') && addition.names.contains(&key) {
            let mut out = text.to_string();
            let end = at + line.trim_end().len();
            let comment = comment(line).map_or(String::new(), |text| format!(" {text}"));
            out.replace_range(at..end, &format!("{key} = {}{comment}", addition.value));
            return Some(out);
        }
        at += line.len();
    }
    None
}

/// The comment at the end of a line.
fn comment(line: &str) -> Option<&str> {
    let starts = line.match_indices('#').map(|(at, _)| at);
    let whole = |at: &usize| line[..*at].parse::<toml::Table>().is_ok();
    starts
        .into_iter()
        .find(whole)
        .map(|at| line[at..].trim_end())
}

#[cfg(test)]
mod tests {
    use super::{Addition, Axis, extend};

    const LINE: Addition = Addition {
        table: "",
        names: &["kind"],
        value: String::new(),
        why: String::new(),
        replaces: false,
    };

    fn addition(table: &'static str, names: &'static [&'static str], value: &str) -> Addition {
        Addition {
            table,
            names,
            value: value.into(),
            why: "found".into(),
            ..LINE
        }
    }

    #[test]
    fn what_a_file_says_stays_and_what_it_lacks_is_added() {
        let file = "# mine\nname = \"X\"\n\n[columns]\nforce = \"F\" # the drive's\n";
        let additions = [
            addition("", &["kind"], "\"linear\""),
            addition("", &["name"], "\"Y\""),
            addition("columns", &["time"], "{ column = \"t\", unit = \"s\" }"),
            Addition {
                replaces: true,
                ..addition(
                    "columns",
                    &["force", "torque"],
                    "{ column = \"F\", unit = \"N\" }",
                )
            },
            addition("log", &["resolution"], "\"1e-6 m\""),
        ];
        let (text, changes) = extend(file, &additions);
        let expected = "# mine\nname = \"X\"\nkind = \"linear\"\n\n[columns]\nforce = { column = \"F\", unit = \"N\" } # the drive's\n\
                        time = { column = \"t\", unit = \"s\" }\n\n[log]\nresolution = \"1e-6 m\"\n";
        assert_eq!(text, expected);
        assert_eq!(changes.len(), 4);
        assert!(
            changes[2].starts_with("changed under [columns]: force = "),
            "{changes:?}"
        );
        // Twice adds nothing but what is replaced by itself.
        assert_eq!(extend(&text, &additions).0, text);
    }

    #[test]
    fn an_empty_file_and_one_without_line_end_are_extended() {
        let additions = [
            addition("", &["kind"], "\"rotary\""),
            addition("columns", &["time"], "\"t\""),
        ];
        for file in [
            "",
            "mass = \"none\"",
            "# only words",
            "[columns]\nposition = \"x\"",
        ] {
            let (text, changes) = extend(file, &additions);
            assert_eq!(changes.len(), 2, "{file:?}: {changes:?}");
            assert!(
                changes.iter().all(|c| c.starts_with("added")),
                "{file:?}: {changes:?}, {:?}",
                Axis::parse(&text).err().map(|e| e.to_string())
            );
            assert!(text.contains(file), "{text}");
        }
    }
}
