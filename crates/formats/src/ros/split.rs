//! A recording of rosbag2 as a whole: the files that its `metadata.yaml` lists, read one after the other as one.

use std::fs::{File, Metadata};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use super::Bag;
use crate::regular::regular;
use crate::sniff::{Format, sniff};
use crate::{Error, Kind, Limits, Table};

/// First line of such a file, but for comments.
const HEAD: &str = "rosbag2_bagfile_information:";

/// Its name in the folder of a recording.
pub(crate) const NAME: &str = "metadata.yaml";

/// Longest one that is read, in bytes.
const LONGEST: u64 = 4 << 20;

/// Whether a text begins as one of rosbag2.
pub(crate) fn is_metadata(start: &[u8]) -> bool {
    let mut lines = start.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#") && *line != b"---");
    first == Some(HEAD.as_bytes())
}

/// A file of a recording, and what was known of it before it was read.
pub(crate) type Part = (PathBuf, Metadata);

/// Reads the messages of all files of a recording; also gives these files.
pub(crate) fn read(path: &Path, limits: Limits) -> Result<(Table, Vec<Part>), Error> {
    let names = files(&text(path)?)?;
    let mut parts: Vec<Part> = Vec::new();
    for name in &names {
        let file = path.with_file_name("").join(name);
        let about = regular(&file).map_err(|error| {
            let found = format!("{name}, which it lists, {error}");
            Error::new(Kind::Io, found, "all files of the recording in its folder")
        })?;
        parts.push((file, about));
    }
    let bytes = parts.iter().map(|(_, about)| about.len()).sum();
    let mut table = super::read("rosbag2", bytes, limits, |bag| {
        parts
            .iter()
            .zip(&names)
            .try_for_each(|((file, about), name)| {
                part(file, about.len(), limits, bag).map_err(|mut error| {
                    error.found = format!("in {name}: {}", error.found);
                    error
                })
            })
    })?;
    if parts.len() > 1 {
        let count = parts.len();
        table
            .detected
            .insert(0, format!("{count} files, read as one recording"));
    }
    Ok((table, parts))
}

/// Reads the messages of one file.
fn part(path: &Path, bytes: u64, limits: Limits, bag: &mut Bag) -> Result<(), Error> {
    let io = |error| Error::new(Kind::Io, format!("cannot be read ({error})"), "");
    let mut file = File::open(path).map_err(io)?;
    let format = sniff(&mut file, bytes).map_err(io)?;
    let file = File::open(path).map_err(io)?;
    match format {
        Format::Mcap => crate::mcap::read(file, bag),
        Format::Rosbag => crate::rosbag::read(file, path, bytes, limits, bag),
        other => Err(Error::new(
            Kind::Format,
            format!("{}, and no recording of rosbag2", other.words()),
            "SQLite or MCAP, plain or packed with zstd",
        )),
    }
}

/// Of how many files a file is one, by the `metadata.yaml` beside it; `None` where it is the only one or nothing says so.
pub(crate) fn is_part(path: &Path) -> Option<usize> {
    let beside = path.with_file_name(NAME);
    let names = regular(&beside)
        .ok()
        .and_then(|_| files(&text(&beside).ok()?).ok())?;
    let listed = names
        .iter()
        .any(|name| Path::new(name).file_name() == path.file_name());
    (listed && names.len() > 1).then_some(names.len())
}

fn text(path: &Path) -> Result<String, Error> {
    let mut text = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LONGEST + 1).read_to_end(&mut text));
    read.map_err(|error| Error::new(Kind::Io, format!("cannot be read ({error})"), ""))?;
    let text = String::from_utf8(text)
        .ok()
        .filter(|text| text.len() as u64 <= LONGEST);
    text.filter(|text| is_metadata(text.as_bytes()))
        .ok_or_else(|| {
            let found = format!("no metadata of rosbag2 of at most {LONGEST} bytes");
            Error::new(Kind::Format, found, "metadata.yaml as rosbag2 writes it")
        })
}

/// The files that a text lists under `relative_file_paths`, in their order: a line each, as rosbag2 and rosbags write them.
fn files(text: &str) -> Result<Vec<String>, Error> {
    let bad = |line: usize, found: String| {
        let allowed = "metadata.yaml as rosbag2 writes it, or one file of the recording";
        Error::new(Kind::Format, found, allowed).at_line(line as u64 + 1)
    };
    let (mut names, mut version, mut indent, mut listing) = (Vec::new(), None, None, false);
    let lines = text.lines().enumerate();
    for (number, line) in lines.filter(|(_, line)| !line.trim_start().starts_with('#')) {
        let content = line.trim();
        let own = line.len() - line.trim_start().len();
        if content.is_empty() || own == 0 {
            continue;
        }
        let indent = *indent.get_or_insert(own);
        if let Some(item) = content.strip_prefix("- ").filter(|_| listing) {
            let name = scalar(item);
            let name = name.ok_or_else(|| bad(number, format!("{content}, which is no name")))?;
            names.push((number, name));
            continue;
        }
        if own > indent || content.starts_with('-') {
            // Of another key; a name over several lines is not understood.
            match listing {
                true => return Err(bad(number, format!("{content} in the list of files"))),
                false => continue,
            }
        }
        let Some((key, value)) = content.split_once(':') else {
            return Err(bad(number, format!("{content}, which is no key")));
        };
        let value = scalar(value.trim());
        listing = false;
        match (key, value.as_deref()) {
            ("version", Some(value)) => version = value.parse().ok(),
            ("relative_file_paths", Some("")) => listing = true,
            ("storage_identifier", Some("sqlite3" | "mcap"))
            | ("compression_format", Some("" | "zstd")) => {}
            (
                "version" | "relative_file_paths" | "storage_identifier" | "compression_format",
                _,
            ) => {
                return Err(bad(number, format!("{content}, which is not read")));
            }
            _ => {}
        }
    }
    let version: u32 = version.ok_or_else(|| bad(0, "no version".to_owned()))?;
    let mut all: Vec<String> = Vec::new();
    for (line, name) in names {
        // Up to version 3 the folder of the recording stands in front.
        let name = match (version, name.split_once('/')) {
            (..=3, Some((_, inside))) => inside.to_owned(),
            _ => name,
        };
        let inside = Path::new(&name)
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if !inside || name.is_empty() || all.contains(&name) {
            return Err(bad(
                line,
                format!("{name}, which is not a file of its own in the folder"),
            ));
        }
        all.push(name);
    }
    match all.is_empty() {
        true => Err(bad(0, "no file under relative_file_paths".to_owned())),
        false => Ok(all),
    }
}

/// A value as it is, or between quotes; `None` of lists and of what has an escape.
fn scalar(value: &str) -> Option<String> {
    let bare = value.trim();
    for quote in ['"', '\''] {
        if let Some(inside) = bare.strip_prefix(quote) {
            let inside = inside.strip_suffix(quote)?;
            return (!inside.contains(['\\', quote])).then(|| inside.to_owned());
        }
    }
    let plain = !bare.starts_with(['[', '{', '&', '*', '!', '|', '>', '%', '@', '`']);
    (plain && !bare.contains(" #")).then(|| bare.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "rosbag2_bagfile_information:\n";

    #[test]
    fn files_as_rosbag2_and_rosbags_list_them() {
        let text = "  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n    - bag_0.db3\n    - \"bag_1.db3\"\n  \
                    duration:\n    nanoseconds: 1\n  topics_with_message_count:\n    - topic_metadata:\n        name: /a\n        \
                    offered_qos_profiles: \"- history: 3\\n  depth: 0\"\n      message_count: 4\n  compression_format: \"\"\n";
        assert_eq!(
            files(&format!("{HEADER}{text}")).unwrap(),
            ["bag_0.db3", "bag_1.db3"]
        );
        let text = "  compression_format: zstd\n  files:\n  - path: x.db3.zstd\n  relative_file_paths:\n  - 'x y.db3.zstd'\n  version: 8\n";
        assert_eq!(files(&format!("{HEADER}{text}")).unwrap(), ["x y.db3.zstd"]);
        let text = "  version: 2\n  relative_file_paths:\n    - bag/bag_0.db3\n";
        assert_eq!(files(&format!("{HEADER}{text}")).unwrap(), ["bag_0.db3"]);
    }

    #[test]
    fn what_is_not_understood_is_refused_with_its_line() {
        for (list, line) in [
            ("- ../a.db3", 4),
            ("- /a.db3", 4),
            ("- a.db3\n  - a.db3", 5),
            ("- \"a\\n.db3\"", 4),
            ("- [a.db3]", 4),
            ("- a.db3\n    more", 5),
            ("", 1),
        ] {
            let text = format!("{HEADER}  version: 5\n  relative_file_paths:\n  {list}\n");
            let error = files(&text).unwrap_err();
            assert_eq!(error.place.row, Some(line), "{list}: {error}");
        }
        for text in [
            "  relative_file_paths: [a.db3]\n",
            "  version: 5\n  compression_format: lz4\n",
            "  \"version\" 5\n",
        ] {
            assert!(files(&format!("{HEADER}{text}")).is_err(), "{text}");
        }
        assert!(is_metadata(
            b"# x\n\nrosbag2_bagfile_information:\n  version: 5"
        ));
        assert!(!is_metadata(b"time: 1\n"));
    }
}
