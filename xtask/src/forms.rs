//! CITATION.cff and the forms of issues against the schemas that are published for them; without the network.

use crate::python;
use crate::shell::{self, Outcome};
use std::fs;

const FORMS: &str = ".github/ISSUE_TEMPLATE";

/// Refuses a file that its schema does not allow.
pub fn check() -> Outcome {
    let folder = shell::root().join(FORMS);
    let entries = fs::read_dir(&folder).map_err(|e| format!("{FORMS}: {e}"))?;
    let names = entries
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned());
    let (settings, forms): (Vec<String>, Vec<String>) = names
        .map(|name| format!("{FORMS}/{name}"))
        .partition(|name| name.ends_with("/config.yml"));
    valid("citation-file-format", &["CITATION.cff".into()])?;
    valid("github-issue-config", &settings)?;
    valid("github-issue-forms", &forms)
}

fn valid(schema: &str, files: &[String]) -> Outcome {
    let schema = format!("vendor.{schema}");
    let mut arguments = vec![
        "-m",
        "check_jsonschema",
        "--quiet",
        "--builtin-schema",
        &schema,
    ];
    arguments.extend(files.iter().map(String::as_str));
    shell::run(shell::command(&python::environment()?, &arguments))
}
