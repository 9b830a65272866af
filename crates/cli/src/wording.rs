//! What an error says at the terminal: as the library says it, with options named as they are typed.

use stiction_codes::Code;
use stiction_files::Error as FileError;
use stiction_workflows::Error;
use stiction_workflows::Setting;
use stiction_workflows::export::ExportError;

/// The message of an error, a line for each thing that is wrong, each with its code.
pub fn lines(error: &Error) -> Vec<(Code, String)> {
    match error {
        Error::File(FileError::Several(all)) => all.iter().flat_map(lines_of_file).collect(),
        Error::File(e @ FileError::Log(_)) => lines_of_file(e),
        _ => vec![(error.code(), message(error))],
    }
}

fn lines_of_file(error: &FileError) -> Vec<(Code, String)> {
    match error {
        FileError::Log(e) => {
            let each = e.clone().each().into_iter();
            each.map(|e| (e.kind.code(), e.to_string())).collect()
        }
        _ => vec![(error.code(), error.to_string())],
    }
}

/// The message of an error.
pub fn message(error: &Error) -> String {
    match error {
        Error::File(FileError::Taken {
            path,
            found,
            may_force,
        }) => {
            let force = match may_force {
                true => " or add --force to write into it all the same",
                false => "",
            };
            format!("{}: {found}; choose another --out{force}", path.display())
        }
        Error::Export(ExportError::RatedForce { .. }) => format!("{error}, with --rated-force"),
        _ => error.named(typed),
    }
}

/// The name of an option.
pub fn option(setting: Setting) -> String {
    match setting {
        // Here the names differ from those of the library.
        Setting::Statics => "static".into(),
        Setting::Decades => "box".into(),
        Setting::Known => "model".into(),
        _ => setting.field().replace('_', "-"),
    }
}

/// An option as it is typed, with its value where there is one.
fn typed(setting: Setting, value: Option<&str>) -> String {
    let name = option(setting);
    match value {
        Some(value) => format!("--{name} {value}"),
        None => format!("--{name}"),
    }
}

#[cfg(test)]
mod tests {
    use super::typed;
    use crate::arguments::Arguments;
    use clap::CommandFactory;
    use stiction_workflows::Setting;

    #[test]
    fn every_setting_is_an_option() {
        let stiction = Arguments::command();
        let options: Vec<String> = stiction
            .get_subcommands()
            .flat_map(|command| command.get_arguments())
            .filter_map(|argument| argument.get_long())
            .map(|name| format!("--{name}"))
            .collect();
        for setting in Setting::ALL {
            assert!(options.contains(&typed(setting, None)), "{setting:?}");
        }
        assert_eq!(typed(Setting::Split, Some("2")), "--split 2");
    }
}
