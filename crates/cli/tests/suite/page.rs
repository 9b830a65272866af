//! Pages of the documentation that are followed as they stand.

use std::path::Path;
use std::process::Command;

/// The text of a page.
pub struct Page(pub &'static str);

impl Page {
    /// Blocks of a kind, in the order of the page.
    pub fn blocks(&self, kind: &str) -> Vec<String> {
        let mut blocks = Vec::new();
        let mut open: Option<(String, String)> = None;
        for line in self.0.lines() {
            match (line.strip_prefix("```"), &mut open) {
                (Some(_), Some((of, text))) => {
                    if of == kind {
                        blocks.push(text.clone());
                    }
                    open = None;
                }
                (Some(of), None) => open = Some((of.into(), String::new())),
                (None, Some((_, text))) => {
                    text.push_str(line);
                    text.push('\n');
                }
                (None, None) => {}
            }
        }
        blocks
    }

    /// The commands, without the name of the program.
    pub fn commands(&self) -> Vec<String> {
        let lines = self.blocks("").join("");
        let plain = |line: &str| line.strip_prefix("stiction ").expect("a command").into();
        lines.lines().map(plain).collect()
    }
}

/// Exit code, standard output and standard error of a command whose words have no spaces, which did not panic.
pub fn run(dir: &Path, line: &str) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    command.args(line.split_whitespace()).current_dir(dir);
    crate::split(command.output().unwrap())
}
