//! What an installed program brings along for shells and for `man`, written from the arguments themselves.

use crate::arguments::Arguments;
use clap::CommandFactory;
use clap_complete::Shell;

/// The completions of a shell, to be put where that shell looks for them.
pub fn completions(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "stiction", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// The manual page of a command, or of stiction itself where none of its commands is named, in roff.
pub fn manual(command: Option<&str>) -> String {
    let mut stiction = Arguments::command();
    stiction.build();
    let found = command.and_then(|name| {
        let page = stiction.find_subcommand(name)?.clone();
        Some(page.display_name(format!("stiction-{name}")))
    });
    let mut roff = Vec::new();
    clap_mangen::Man::new(found.unwrap_or(stiction))
        .render(&mut roff)
        .expect("memory takes what is written");
    String::from_utf8_lossy(&roff).into_owned()
}

#[cfg(test)]
mod tests {
    use super::{completions, manual};
    use crate::arguments::{Arguments, COMMANDS};
    use clap::{CommandFactory, ValueEnum};

    #[test]
    fn every_command_has_a_manual_page() {
        let stiction = Arguments::command();
        let names: Vec<&str> = stiction.get_subcommands().map(|c| c.get_name()).collect();
        assert_eq!(names, COMMANDS);
        let main = manual(None);
        for name in COMMANDS {
            let page = manual(Some(name));
            assert!(page.contains(&format!(".TH stiction-{name} 1")), "{page}");
            assert!(page.contains("SYNOPSIS") && main.contains(&format!("stiction\\-{name}(1)")));
        }
    }

    #[test]
    fn every_shell_completes_every_command() {
        for shell in clap_complete::Shell::value_variants() {
            let script = completions(*shell);
            assert!(COMMANDS.iter().all(|name| script.contains(name)), "{shell}");
        }
    }
}
