//! Pages whose figures a command prints. What stands between `<!-- figures: COMMAND -->` and `<!-- end of figures -->` is what the
//! command printed when it was last run, with date, commit and machine.

use crate::shell::{self, Outcome};
use crate::wheel;
use std::fs;
use std::path::Path;

const BEGIN: &str = "<!-- figures: ";
const CLOSE: &str = " -->\n";
const END: &str = "<!-- end of figures -->";

/// Variables of a command.
type Variables = Vec<(&'static str, String)>;

/// README's table and picture.
pub fn front() -> Outcome {
    renew("README.md", None, |_| {
        Ok(vec![("STICTION_WHEEL", wheel::debug()?)])
    })
}

/// The figures of docs/performance.md, or those that the command line names: an hour on a machine that does nothing else.
pub fn performance() -> Outcome {
    let name = std::env::args().nth(2);
    renew("docs/performance.md", name.as_deref(), |command| {
        if is_of(command, "python") {
            wheel::measurable()?;
        }
        Ok(Vec::new())
    })
}

/// Runs the commands of a page, all or those of a name, and writes after each what it printed. What `prepare` does for a command
/// comes before it. A command that fails leaves its figures as they were and the others to run.
fn renew(
    page: &str,
    name: Option<&str>,
    prepare: impl Fn(&str) -> Result<Variables, String>,
) -> Outcome {
    let path = shell::root().join(page);
    let text = fs::read_to_string(&path).map_err(|e| format!("{page}: {e}"))?;
    let (mut done, mut rest) = (String::new(), text.as_str());
    let (mut all, mut run, mut failed) = (Vec::new(), 0, Vec::new());
    while let Some(next) = next(rest).map_err(|e| format!("{page}: {e}"))? {
        let command = next.command;
        let mut figures = next.figures.to_owned();
        if name.is_none_or(|name| is_of(command, name)) {
            run += 1;
            match prepare(command).and_then(|variables| printed(command, variables)) {
                Ok(printed) => figures = format!("{printed}\n"),
                Err(error) => {
                    eprintln!("{error}");
                    failed.push(format!("    {error}"));
                }
            }
        }
        all.push(format!("    {command}"));
        done += &format!("{}{BEGIN}{command}{CLOSE}{figures}", next.before);
        rest = next.after;
        let whole = format!("{done}{rest}");
        fs::write(&path, whole).map_err(|e| format!("{page}: {e}"))?;
    }
    if let (Some(name), 0) = (name, run) {
        let all = all.join("\n");
        return Err(format!("{page} has no figures of `{name}`; it has\n{all}"));
    }
    match failed.len() {
        0 => Ok(()),
        n => Err(format!(
            "{page}: {n} of {run} failed, their figures are the old ones:\n{}",
            failed.join("\n")
        )),
    }
}

/// Whether a command runs a script of `bench/`, by its path without ending, or by a folder of it.
fn is_of(command: &str, name: &str) -> bool {
    let mut scripts = command
        .split_whitespace()
        .filter_map(|word| word.strip_prefix("bench/"));
    scripts.any(|script| Path::new(script).with_extension("").starts_with(name))
}

/// What a command prints in the root of the workspace, where it ends well.
fn printed(command: &str, variables: Variables) -> Result<String, String> {
    let mut words = command.split_whitespace();
    let program = words.next().ok_or("a command without a program")?;
    let arguments: Vec<&str> = words.collect();
    let mut run = shell::command(program, &arguments);
    run.envs(variables);
    let text = shell::timed_output(run)?;
    match text.trim() {
        "" => Err(format!("`{command}` printed nothing")),
        text => Ok(text.into()),
    }
}

/// A command of a page with what stands around it.
#[derive(Debug, PartialEq)]
struct Region<'a> {
    before: &'a str,
    command: &'a str,
    figures: &'a str,
    /// From the mark of its end on.
    after: &'a str,
}

/// The next command.
fn next(text: &str) -> Result<Option<Region<'_>>, String> {
    let Some((before, marked)) = text.split_once(BEGIN) else {
        return Ok(None);
    };
    let (command, rest) = marked
        .split_once(CLOSE)
        .ok_or("`<!-- figures:` without its end in the same line")?;
    let end = rest
        .find(END)
        .ok_or_else(|| format!("{command}: no `{END}`"))?;
    let (figures, after) = rest.split_at(end);
    Ok(Some(Region {
        before,
        command,
        figures,
        after,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_has_the_name_of_its_path_or_folder() {
        let command = "python3 bench/peers/compare.py 20000 7";
        assert!(is_of(command, "peers"));
        assert!(is_of(command, "peers/compare"));
        assert!(!is_of(command, "peers/identify"));
        assert!(!is_of(command, "peer"));
        assert!(is_of("python3 bench/exported.py", "exported"));
    }

    #[test]
    fn the_page_is_cut_into_commands_and_put_together_again() {
        let page = include_str!("../../docs/performance.md");
        let (mut rest, mut whole, mut count) = (page, String::new(), 0);
        while let Some(region) = next(rest).unwrap() {
            let Region {
                before,
                command,
                figures,
                ..
            } = region;
            let script = command.split_whitespace().nth(1).unwrap();
            assert!(shell::root().join(script).is_file(), "{script}");
            whole += &format!("{before}{BEGIN}{command}{CLOSE}{figures}");
            rest = region.after;
            count += 1;
        }
        assert_eq!(whole + rest, page);
        assert!(count > 1);
    }
}
