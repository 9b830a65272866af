//! `check --init`: an axis file to fill in, with what was detected already in it.

use std::fmt::Write;
use stiction_log::{Channel, Mapping, Role, Selector, Table};

/// Text of an axis file for a table: detected columns filled in, everything else as comments that say
/// what may stand there.
pub fn template(table: &Table, detected: Option<&Mapping>) -> String {
    let mut out = String::from(
        "# Axis file for stiction. Values carry their unit: \"5 mm/s\", \"35.15 N/V\". Every key is\n\
         # described in docs/axis.md; lines that start with # are off.\n\n",
    );
    let kind = detected.and_then(|m| m.motion);
    match kind {
        Some(kind) => {
            let _ = writeln!(out, "kind = \"{kind}\"");
        }
        None => out.push_str("# kind = \"linear\"    # or \"rotary\"\n"),
    }
    out.push_str("# name = \"X axis\"\n");
    out.push_str(
        "# mass = \"4.6 kg\"     # known mass or inertia; \"fit\" (default) or \"none\"\n",
    );
    let has_time = detected.is_some_and(|m| m.time.is_some());
    if !has_time {
        out.push_str("# rate = \"1 kHz\"      # where there is no time column\n");
    }
    out.push_str("\n[columns]\n# The file has:\n");
    for (i, column) in table.columns.iter().enumerate().take(64) {
        let name = if column.name.is_empty() {
            "(no name)"
        } else {
            &column.name
        };
        let unit = column
            .unit
            .as_deref()
            .map_or(String::new(), |u| format!(" [{u}]"));
        // A name from a file must not break out of its comment, and TOML allows no control
        // characters there.
        let line = format!("{name}{unit}").replace(char::is_control, " ");
        let _ = writeln!(out, "#   {}: {line}", i + 1);
    }
    for role in Role::ALL {
        match detected.and_then(|m| m.channel(role)) {
            Some(channel) => {
                let _ = writeln!(out, "{role} = {}", entry(channel));
            }
            None => {
                let example = match role {
                    Role::Time => "{ column = 1, unit = \"s\" }",
                    Role::Position => "{ column = 2, unit = \"mm\" }",
                    Role::Velocity => "{ column = 3, unit = \"mm/s\" }",
                    Role::Force => {
                        "{ column = 4, unit = \"A\", scale = \"96 N/A\", invert = false }"
                    }
                    Role::Reference => "{ column = 5, unit = \"mm\" }",
                    Role::Temperature => "{ column = 6, unit = \"degC\" }",
                    Role::Load => "{ column = 7, unit = \"N\" }",
                };
                let _ = writeln!(out, "# {role} = {example}");
            }
        }
    }
    out.push_str(
        "\n[log]\n# crop = [\"1 s\", \"20 s\"]\n# wrap = \"360 deg\"        # travel after which the position \
         starts again\n# resolution = \"50 nm\"    # one encoder count\n# force_limit = \"100 N\"   # where \
         the force saturates\n\n[conditioning]\n# source_cutoff = \"100 Hz\"   # \"auto\" (default), \"off\" \
         or a frequency\n# common_cutoff = \"50 Hz\"\n# min_speed = \"1 mm/s\"       # only faster samples \
         count\n\n[terms]\n# gravity = true           # rotary axis: sin q and cos q\n# cogging = [\"24 \
         mm\"]      # pitch of each cogging wave\n\n[report]\n# low_speed = \"1 mm/s\"       # what counts as \
         near zero speed\n",
    );
    out
}

fn entry(channel: &Channel) -> String {
    let column = match &channel.column {
        Selector::Name(name) => toml::Value::String(name.clone()).to_string(),
        Selector::Index(i) => i.to_string(),
    };
    let mut out = format!("{{ column = {column}");
    if let Some(unit) = &channel.unit {
        let _ = write!(
            out,
            ", unit = {}",
            toml::Value::String(unit.text().to_string())
        );
    }
    if let Some(scale) = &channel.scale {
        let _ = write!(out, ", scale = {}", toml::Value::String(scale.to_string()));
    }
    if channel.invert {
        out.push_str(", invert = true");
    }
    out.push_str(" }");
    out
}
