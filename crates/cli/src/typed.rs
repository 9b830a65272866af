//! What was typed, argument by argument, also where some are missing.

use crate::arguments::Arguments;
use crate::words;
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory};
use std::ffi::OsString;
use std::path::PathBuf;

/// A command as it was typed.
pub struct Typed {
    /// The name of the command.
    pub command: String,
    matches: ArgMatches,
}

impl Typed {
    /// The command that was typed; `None` without one.
    pub fn new() -> Option<Self> {
        let stiction = Arguments::command().ignore_errors(true);
        let matches = stiction.try_get_matches_from(words::whole());
        let (command, matches) = matches.ok()?.remove_subcommand()?;
        Some(Self { command, matches })
    }

    /// What stands behind the command without an option before it.
    pub fn files(&self) -> Vec<PathBuf> {
        let known = Arguments::command();
        let command = known.find_subcommand(&self.command);
        let positionals = command
            .into_iter()
            .flat_map(|command| command.get_positionals());
        let values = positionals.flat_map(|argument| self.values(argument.get_id().as_str()));
        values.map(PathBuf::from).collect()
    }

    /// The values of an option; none where it was not typed.
    pub fn values(&self, id: &str) -> Vec<OsString> {
        let source = self.matches.try_contains_id(id).ok().filter(|there| *there);
        let source = source.and_then(|_| self.matches.value_source(id));
        if source != Some(ValueSource::CommandLine) {
            return Vec::new();
        }
        let values = self.matches.get_raw(id).into_iter().flatten();
        values.map(|value| value.to_os_string()).collect()
    }
}
