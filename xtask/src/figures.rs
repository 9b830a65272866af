//! Pages whose figures a command prints. What stands between `<!-- figures: COMMAND -->` and `<!-- end of figures -->` is what the
//! command printed when it was last run, with date, commit and machine.

use crate::shell::{self, Outcome};
use crate::wheel;
use std::fs;

const BEGIN: &str = "<!-- figures: ";
const CLOSE: &str = " -->\n";
const END: &str = "<!-- end of figures -->";

/// README's table and picture.
pub fn front() -> Outcome {
    let wheel = wheel::debug()?;
    renew("README.md", &[("STICTION_WHEEL", &wheel)])
}

/// The figures of docs/performance.md: an hour on a machine that does nothing else.
pub fn performance() -> Outcome {
    wheel::release()?;
    renew("docs/performance.md", &[])
}

/// Runs every command of a page, in the root of the workspace, and writes what each printed. A command that fails leaves the page
/// as it was from there on.
fn renew(page: &str, variables: &[(&str, &str)]) -> Outcome {
    let path = shell::root().join(page);
    let text = fs::read_to_string(&path).map_err(|e| format!("{page}: {e}"))?;
    let mut done = String::new();
    let mut rest = text.as_str();
    while let Some((before, command, after)) = next(rest).map_err(|e| format!("{page}: {e}"))? {
        println!("==> {command}");
        let mut words = command.split_whitespace();
        let program = words.next().ok_or("a command without a program")?;
        let arguments: Vec<&str> = words.collect();
        let mut run = shell::command(program, &arguments);
        run.envs(variables.iter().copied());
        let printed = shell::output(run)?;
        done += &format!("{before}{BEGIN}{command}{CLOSE}{}\n", printed.trim());
        rest = after;
        let whole = format!("{done}{rest}");
        fs::write(&path, whole).map_err(|e| format!("{page}: {e}"))?;
    }
    Ok(())
}

/// What comes before the next command, the command, and what comes from its end on.
fn next(text: &str) -> Result<Option<(&str, &str, &str)>, String> {
    let Some((before, marked)) = text.split_once(BEGIN) else {
        return Ok(None);
    };
    let (command, rest) = marked
        .split_once(CLOSE)
        .ok_or("`<!-- figures:` without its end in the same line")?;
    let end = rest
        .find(END)
        .ok_or_else(|| format!("{command}: no `{END}`"))?;
    Ok(Some((before, command, &rest[end..])))
}
