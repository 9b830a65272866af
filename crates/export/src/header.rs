//! The head of every file: what it is, the parameters with their intervals, and their origin.

use crate::{Model, Parameter, terms};

/// Lines of plain ASCII without anything that could end a comment in a target's language; `code` where the compensator
/// itself follows: then with its inputs and outputs.
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
        lines.extend(other_unit(model));
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
            Some(ends) => interval(ends),
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
            unit(p, model.is_share())
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

/// An interval, which the data may bound on one side only.
fn interval([low, high]: [f64; 2]) -> String {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{low:.4e} to {high:.4e}"),
        (false, true) => format!("at most {high:.4e}"),
        (true, false) => format!("at least {low:.4e}"),
        (false, false) => "no interval".into(),
    }
}

/// The unit of a parameter, products with a blank; empty for a plain number. Where the force is a fraction of a rated value,
/// 1 takes the place of its unit.
fn unit(p: &Parameter, share: bool) -> String {
    let text = p.unit.replace(['*', '·'], " ");
    let unit = match text.strip_prefix('1') {
        // The only parameter that is a plain number whatever the unit of the force.
        Some(rest) if share && p.name != "stribeck_exponent" => format!("p.u.{rest}"),
        Some(rest) if rest.is_empty() || rest.starts_with(' ') => rest.trim_start().into(),
        _ => text,
    };
    if unit.is_empty() {
        unit
    } else {
        format!(" {unit}")
    }
}

/// Inputs and outputs.
fn interface(model: &Model) -> Vec<String> {
    let mut lines = vec![
        "The force is a feedforward: add it to the force or torque that the controller commands."
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
    if model.settings.adaptation.is_some() {
        lines.insert(
            4,
            "     Force that the drive was given in the cycle before, with this compensator's part; whether to learn from it.".into(),
        );
    }
    let (inputs, outputs) = terms::interface(model);
    let out = lines.len() - 1;
    lines.splice(out..out, inputs);
    lines.extend(outputs);
    lines.extend(other_unit(model));
    lines
}

/// The unit of the force where it is not an SI force or torque.
fn other_unit(model: &Model) -> Option<String> {
    let share = match model.force_unit() {
        _ if model.in_newtons() => return None,
        "p.u." => " (1 is 100 percent)",
        _ => "",
    };
    Some(format!(
        "The force is in {}{share}, the unit of the log; whatever it is added to has to be in the same unit.",
        model.force_unit()
    ))
}

/// Lines with inputs and outputs, each after a prefix.
pub(crate) fn comment(model: &Model, prefix: &str) -> String {
    joined(&lines(model, true), prefix)
}

/// The same without inputs and outputs, for a table.
pub(crate) fn table_comment(model: &Model, prefix: &str) -> String {
    joined(&lines(model, false), prefix)
}

/// The lines, each after a prefix.
pub(crate) fn joined(lines: &[String], prefix: &str) -> String {
    let lines: Vec<String> = lines
        .iter()
        .map(|line| format!("{prefix}{line}").trim_end().to_string())
        .collect();
    lines.join("\n")
}

/// The harmless part of a text from an untrusted source.
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
    use super::{Parameter, interval, plain, unit};

    #[test]
    fn units_follow_a_number() {
        for (name, text, plain, share) in [
            ("sigma1", "N*s/m", "N s/m", "N s/m"),
            ("sigma1", "N·m·s/rad", "N m s/rad", "N m s/rad"),
            ("sigma1", "1*s/m", "s/m", "p.u. s/m"),
            ("sigma0", "1/m", "1/m", "p.u./m"),
            ("static", "1", "", "p.u."),
            ("stribeck_exponent", "1", "", ""),
            ("stribeck_velocity", "m/s", "m/s", "m/s"),
        ] {
            let p = Parameter {
                name: name.into(),
                value: 1.0,
                unit: text.into(),
                interval: None,
                identifiable: true,
                given: false,
            };
            assert_eq!(unit(&p, false).trim_start(), plain);
            assert_eq!(unit(&p, true).trim_start(), share);
        }
    }

    #[test]
    fn an_interval_may_be_open() {
        let inf = f64::INFINITY;
        assert_eq!(interval([1.0, 98.0]), "1.0000e0 to 9.8000e1");
        assert_eq!(interval([-inf, 98.0]), "at most 9.8000e1");
        assert_eq!(interval([1.0, inf]), "at least 1.0000e0");
        assert_eq!(interval([-inf, inf]), "no interval");
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
