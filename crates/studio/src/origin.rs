//! Which logs a result, a model or a study comes from, as these files say: the name and the hash of each.

use crate::workspace::{Entry, Workspace, kind_of_file};
use serde::{Deserialize, Serialize};

/// A log that something was found from.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Log {
    /// Its name in the folder; its path where it is not there.
    #[serde(rename(deserialize = "path"))]
    name: String,
    /// SHA-256 of its bytes then, hexadecimal.
    sha256: String,
}

/// `result.json`, and a table of a model.
#[derive(Default, Deserialize)]
struct Source {
    inputs: Vec<Log>,
}

#[derive(Deserialize)]
struct Model {
    source: Source,
}

/// The logs of an entry; empty for other kinds, and for what no log was needed for.
pub fn logs(workspace: &Workspace, entry: &Entry) -> Vec<Log> {
    let mut logs = match entry.kind {
        "result" => {
            let text = workspace.text(&format!("{}/result.json", entry.name));
            let read = text.map(|text| serde_json::from_str(&text).unwrap_or_default());
            read.map(|own: Source| own.inputs).unwrap_or_default()
        }
        "model" => of_model(workspace, &entry.name),
        "study" => of_study(workspace, &entry.name),
        _ => Vec::new(),
    };
    for log in &mut logs {
        if let Some(name) = workspace.name(log.name.as_ref()) {
            log.name = name;
        }
    }
    logs.dedup();
    logs
}

fn of_model(workspace: &Workspace, name: &str) -> Vec<Log> {
    let text = workspace.text(name).unwrap_or_default();
    toml::from_str(&text).map_or_else(|_| Vec::new(), |own: Model| own.source.inputs)
}

/// Those of the models that it names.
fn of_study(workspace: &Workspace, name: &str) -> Vec<Log> {
    let text = workspace.text(name).unwrap_or_default();
    let named = workspace.named(&text, name.as_ref());
    let names = named.iter().filter_map(|path| workspace.name(path));
    let models = names.filter(|name| kind_of_file(name) == "model");
    models.flat_map(|name| of_model(workspace, &name)).collect()
}
