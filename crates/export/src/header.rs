//! The head of every file: what it is, its numbers with intervals, where they came from.

use crate::Model;

/// Lines of plain ASCII without anything that could end a comment in a target's language; `code` where the compensator
/// itself follows, with what goes in and comes out.
pub(crate) fn lines(model: &Model, code: bool) -> Vec<String> {
    let mut lines = vec![format!(
        "Friction compensator of the axis '{}', law {}, written by stiction {}.",
        model.title,
        model.law(),
        model.provenance.version
    )];
    if code {
        lines.extend(interface(model));
    } else {
        lines.extend(counted(model));
    }
    if !model.notes.is_empty() {
        lines.push(String::new());
        lines.extend(model.notes.iter().map(|note| format!("NOTE: {note}")));
    }
    if !model.parameters.is_empty() {
        lines.push(String::new());
        lines.push("Parameters with their 95 percent intervals:".into());
    }
    for p in &model.parameters {
        let interval = match p.interval {
            _ if p.given => "given".into(),
            Some([low, high]) => format!("{low:.4e} to {high:.4e}"),
            None => "no interval".into(),
        };
        let flag = if p.identifiable || p.given {
            ""
        } else {
            ", NOT determined by the data"
        };
        lines.push(format!(
            "  {} = {:.6e}{}, {interval}{flag}",
            p.name,
            p.value,
            unit(&p.unit)
        ));
    }
    lines.push(String::new());
    lines.push(format!(
        "Model file: sha256 {}",
        model.provenance.model_sha256
    ));
    for (path, hash) in &model.provenance.inputs {
        lines.push(format!("Identified from {path}, sha256 {hash}"));
    }
    lines.iter().map(|line| plain(line)).collect()
}

/// A unit after a number, a product with a blank; none for a bare number.
fn unit(text: &str) -> String {
    let text = text.replace(['*', '·'], " ");
    match text.strip_prefix("1 ").unwrap_or(&text) {
        "1" | "" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// What goes in and comes out.
fn interface(model: &Model) -> Vec<String> {
    let mut lines = vec![
        "The force is a feedforward: add it to the force or torque that the controller asks for."
            .into(),
        String::new(),
        format!(
            "In:  reference velocity in {}, if known that of the instant at which the force will act (preview);",
            model.speed_unit()
        ),
        format!(
            "     tracking error, reference less measured position, in {}; enable. Called every {} s.",
            model.length_unit(),
            model.settings.cycle_time
        ),
        format!(
            "Out: force in {}, along the positive direction of the velocity.",
            model.force_unit()
        ),
    ];
    lines.extend(counted(model));
    lines
}

/// What a force is counted in that is none.
fn counted(model: &Model) -> Option<String> {
    let share = match model.force_unit() {
        _ if model.in_newtons() => return None,
        "p.u." => " (1 is 100 percent)",
        _ => "",
    };
    Some(format!(
        "The force is in {}{share}, as the log counted it; what it is added to has to count in the same.",
        model.force_unit()
    ))
}

/// The lines, each after a prefix.
pub(crate) fn comment(model: &Model, prefix: &str) -> String {
    joined(&lines(model, true), prefix)
}

/// The same without what goes in and comes out, for a table.
pub(crate) fn table_comment(model: &Model, prefix: &str) -> String {
    joined(&lines(model, false), prefix)
}

fn joined(lines: &[String], prefix: &str) -> String {
    let lines: Vec<String> = lines
        .iter()
        .map(|line| format!("{prefix}{line}").trim_end().to_string())
        .collect();
    lines.join("\n")
}

/// What is left of a text that may come from anywhere.
pub(crate) fn plain(text: &str) -> String {
    let spelled = text
        .replace('·', " ")
        .replace('²', "^2")
        .replace('°', "deg");
    spelled
        .chars()
        .map(|c| match c {
            ' ' | '_' | '.' | ',' | ':' | ';' | '/' | '+' | '-' | '=' | '^' | '%' | '\'' | '('
            | ')' => c,
            c if c.is_ascii_alphanumeric() => c,
            _ => '_',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn units_follow_a_number() {
        let units = ["N*s/m", "N·m·s/rad", "1*s/m", "1", "1/m"];
        let written = ["N s/m", "N m s/rad", "s/m", "", "1/m"];
        for (unit, text) in units.into_iter().zip(written) {
            assert_eq!(super::unit(unit).trim_start(), text);
        }
    }

    #[test]
    fn nothing_ends_a_comment() {
        assert_eq!(
            plain("a */ (* *) ]]> ??/ \\\n {x}"),
            "a _/ (_ _) ___ __/ __ _x_"
        );
        assert_eq!(plain("N·m·s/rad"), "N m s/rad");
    }
}
