//! What to do next with a fit, as data for Python.

use serde_json::{Map, Value};
use stiction_files::result::{Action, ResultFile};
use stiction_pages::text::next_action;

/// The action on a result as JSON: its name, and what it has; a line of an axis file also as `key` and `value`.
pub fn next(result: &ResultFile) -> Option<String> {
    let action = next_action(result);
    let (name, mut data) = match serde_json::to_value(&action).ok()? {
        Value::String(name) => (name, Map::new()),
        Value::Object(one) => match one.into_iter().next()? {
            (name, Value::Object(data)) => (name, data),
            _ => return None,
        },
        _ => return None,
    };
    if let Action::Line { line, .. } = &action {
        let table: toml::Table = line.parse().ok()?;
        let (key, value) = table.into_iter().next()?;
        data.insert("key".into(), key.into());
        data.insert("value".into(), serde_json::to_value(value).ok()?);
    }
    data.insert("action".into(), name.into());
    Some(Value::Object(data).to_string())
}
