//! What to do next, as commands to type.

use std::path::Path;
use stiction_files::result::{Next, ResultFile};

/// What the commands are for.
pub(crate) fn why(next: Next) -> &'static str {
    match next {
        Next::Export => {
            "the compensator as C; also st, tcpou, plcopen, rust, mujoco, hal, fmu and tf5200"
        }
        Next::LetTheDataChoose => "let the data choose the law",
        Next::FitTogether => "fit both together",
        Next::Simulate => "fit the position of the simulated axis, which differentiates nothing",
        Next::Check => "see what the log shows, and what motion to record instead",
        Next::Again => "the same again, to the end",
    }
}

/// The command that leads on from the result in a folder.
pub(crate) fn command(result: &ResultFile, dir: &Path) -> String {
    let folder = quoted(&dir.display().to_string());
    let another = |suffix: &str| quoted(&format!("{}-{suffix}", dir.display()));
    let mut logs: Vec<String> = result.inputs.iter().map(|i| quoted(&i.path)).collect();
    let next = result.trust.next;
    if next == Next::FitTogether {
        logs.extend(result.validation.iter().map(|v| quoted(&v.path)));
    }
    let mut log = logs.join(" ");
    if let Some(file) = &result.axis.file {
        log.push_str(&format!(" --axis {}", quoted(file)));
    }
    match next {
        Next::Export => {
            let model = quoted(&dir.join("model.toml").display().to_string());
            let code = quoted(&dir.join("c").display().to_string());
            format!("stiction export {model} --target c --out {code}")
        }
        Next::LetTheDataChoose => format!("stiction identify {log} --out {}", another("auto")),
        Next::FitTogether => format!("stiction identify {log} --out {}", another("together")),
        Next::Simulate => format!(
            "stiction identify {log} --method output-error --out {}",
            another("simulated")
        ),
        Next::Check => format!("stiction check {log}"),
        Next::Again => {
            let law = match (result.law_chosen_by.as_str(), result.asymmetric) {
                ("user", true) => format!(" --law {} --asymmetric", result.law),
                ("user", false) => format!(" --law {}", result.law),
                _ => String::new(),
            };
            let method = match result.method.as_str() {
                "separable" => String::new(),
                other => format!(" --method {other}"),
            };
            format!("stiction identify {log}{law}{method} --out {folder}")
        }
    }
}

/// A path as a shell takes it: in quotes where it holds anything but letters, digits and plain signs.
pub(crate) fn quoted(path: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+=:,@%".contains(c);
    // What begins with a dash would be taken for an option.
    let folder = if path.starts_with('-') { "./" } else { "" };
    match !path.is_empty() && path.chars().all(plain) {
        true => format!("{folder}{path}"),
        false => format!("'{folder}{}'", path.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_path_is_quoted_where_a_shell_would_split_it() {
        assert_eq!(quoted("logs/a-1.csv"), "logs/a-1.csv");
        assert_eq!(quoted("my log.csv"), "'my log.csv'");
        assert_eq!(quoted("-a.csv"), "./-a.csv");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
    }
}
