//! What `meta/info.json` of a data set says: its version, its frames a second, and the names in its lists.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde_json::Value;

use crate::binary::Collector;
use crate::{Error, Kind, Table};

/// Longest one that is read, in bytes.
const LONGEST: u64 = 256 << 10;

/// Frames a second that are taken.
const RATES: std::ops::RangeInclusive<f64> = 1e-3..=1e9;

/// What of it is needed.
pub(super) struct Info {
    pub(super) version: String,
    pub(super) frames_per_second: f64,
    features: Vec<Feature>,
}

/// A column, or a list of them.
struct Feature {
    name: String,
    /// `float32`, `video`, `image` and the like.
    kind: String,
    /// The names of its elements, where it has any.
    elements: Vec<String>,
}

impl Info {
    /// Reads a file.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let bad = |found: String| {
            let allowed = "meta/info.json as LeRobot 2.0 or later writes it";
            Error::new(Kind::Format, format!("in meta/info.json: {found}"), allowed)
        };
        let mut text = Vec::new();
        File::open(path)
            .and_then(|file| file.take(LONGEST + 1).read_to_end(&mut text))
            .map_err(|error| Error::new(Kind::Io, format!("cannot be read ({error})"), ""))?;
        if text.len() as u64 > LONGEST {
            return Err(bad(format!("more than {LONGEST} bytes")));
        }
        let info: Value = serde_json::from_slice(&text).map_err(|error| bad(error.to_string()))?;
        let version = info["codebase_version"].as_str().unwrap_or_default();
        let features = info["features"].as_object();
        let (false, Some(features)) = (version.is_empty(), features) else {
            return Err(bad("no codebase_version and features".to_owned()));
        };
        let rate = info["fps"].as_f64().filter(|rate| RATES.contains(rate));
        Ok(Self {
            version: version.chars().take(20).collect(),
            frames_per_second: rate.ok_or_else(|| bad("no fps, frames a second".to_owned()))?,
            features: features
                .iter()
                .map(|(name, of)| Feature {
                    name: name.clone(),
                    kind: of["dtype"].as_str().unwrap_or_default().to_owned(),
                    elements: elements(&of["names"]),
                })
                .collect(),
        })
    }

    /// Gives the columns of lists the names of their elements, where there is one for each, and no other column has it.
    pub(super) fn name(&self, table: &mut Table) {
        for feature in &self.features {
            let list = format!("{}(:,", feature.name);
            let columns = table.columns.iter().enumerate();
            let own: Vec<usize> = columns
                .filter(|(_, c)| c.name.starts_with(&list))
                .map(|(at, _)| at)
                .collect();
            // Names that are no text name nothing.
            if feature.elements.iter().any(String::is_empty) {
                continue;
            }
            let names: Vec<String> = (feature.elements.iter())
                .map(|element| format!("{}.{element}", feature.name))
                .collect();
            let known: BTreeSet<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
            let distinct: BTreeSet<&str> = names.iter().map(String::as_str).collect();
            let whole = (own.iter().enumerate())
                .all(|(n, at)| table.columns[*at].name == Collector::of_matrix(&feature.name, n));
            if own.len() != names.len()
                || distinct.len() != names.len()
                || !known.is_disjoint(&distinct)
                || !whole
            {
                continue;
            }
            for (at, name) in own.into_iter().zip(names) {
                let other = std::mem::replace(&mut table.columns[at].name, name);
                table.other_names.insert(at, other);
            }
        }
    }

    /// Names pictures and videos among what was left out: once, whatever columns they have.
    pub(super) fn leave_out(&self, table: &mut Table) {
        let seen = |feature: &&Feature| matches!(feature.kind.as_str(), "image" | "video");
        for Feature { name, kind, .. } in self.features.iter().filter(seen) {
            let inside = |said: &String| {
                let rest = said.strip_prefix(name.as_str());
                rest.is_some_and(|rest| rest.starts_with(['.', ':']))
            };
            table.skipped.retain(|said| !inside(said));
            table.skipped.push(format!("{name}: {kind}"));
        }
    }
}

/// The names of elements: a list of them, as in `{"motors": ["elbow", ..]}` too, or the place of each, `{"x": 0, "y": 1}`.
fn elements(names: &Value) -> Vec<String> {
    let list = |value: &Value| -> Vec<String> {
        let texts = value.as_array().into_iter().flatten();
        texts
            .map(|name| name.as_str().unwrap_or_default().to_owned())
            .collect()
    };
    let Some(object) = names.as_object() else {
        return list(names);
    };
    let places: Option<Vec<(u64, &String)>> = (object.iter())
        .map(|(name, place)| Some((place.as_u64()?, name)))
        .collect();
    if let Some(mut places) = places {
        places.sort();
        return places.into_iter().map(|(_, name)| name.clone()).collect();
    }
    // The order of several lists is that of the file, which a map does not keep.
    match object.len() {
        1 => object.values().flat_map(list).collect(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_as_versions_of_lerobot_write_them() {
        for (written, read) in [
            (r#"["a.pos", "b.pos"]"#, vec!["a.pos", "b.pos"]),
            (r#"{"motors": ["a", "b"]}"#, vec!["a", "b"]),
            (r#"{"y": 1, "x": 0}"#, vec!["x", "y"]),
            (r#"{"right": ["a"], "left": ["a"]}"#, vec![]),
            (r#"["a", null, "b"]"#, vec!["a", "", "b"]),
            ("null", vec![]),
            ("3", vec![]),
        ] {
            let names = serde_json::from_str(written).unwrap();
            assert_eq!(elements(&names), read, "{written}");
        }
    }
}
