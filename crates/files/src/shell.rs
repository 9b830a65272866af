//! Commands as they are typed.

use std::path::{Path, PathBuf};

/// Whether a shell takes a letter as it stands.
pub fn plain(c: char) -> bool {
    (c.is_alphanumeric() || "/._-+=:,@%".contains(c)) && stands_for(c).is_none()
}

/// Stand-ins for the bytes 0x80 to 0xff of a name that is not UTF-8: the last private characters of Unicode.
const STAND_INS: u32 = 0x10_ff80;

/// The byte of a name that is not UTF-8 that a character of [`text`] stands for.
pub fn stands_for(c: char) -> Option<u8> {
    let byte = u32::from(c).checked_sub(STAND_INS)? + 0x80;
    u8::try_from(byte).ok()
}

/// A path as text from which [`quoted`] makes the very path: a byte that is not UTF-8 is a character that [`stands_for`] it.
#[cfg(unix)]
pub fn text(path: &Path) -> String {
    use std::os::unix::ffi::OsStrExt;
    let stand_in = |byte: &u8| char::from_u32(STAND_INS + u32::from(*byte) - 0x80);
    let mut out = String::new();
    for chunk in path.as_os_str().as_bytes().utf8_chunks() {
        for c in chunk.valid().chars() {
            match stands_for(c) {
                None => out.push(c),
                // A name that has one of the characters itself.
                Some(_) => {
                    let mut bytes = [0; 4];
                    let bytes = c.encode_utf8(&mut bytes).as_bytes();
                    out.extend(bytes.iter().filter_map(stand_in));
                }
            }
        }
        out.extend(chunk.invalid().iter().filter_map(stand_in));
    }
    out
}

/// A path as text; what is not Unicode is lost.
#[cfg(not(unix))]
pub fn text(path: &Path) -> String {
    path.display().to_string()
}

/// The option that exports code for a call at each sample of logs of this rate, Hz, with a blank before it; empty where that is
/// not known.
pub fn cycle_option(rate_hz: Option<f64>) -> String {
    let option = |rate| format!(" --cycle-time {}", cycle_time(rate));
    rate_hz.map_or(String::new(), option)
}

/// The cycle time of that code, s: within what an export takes, and with four digits, as time stamps give more than a
/// controller has.
pub fn cycle_time(rate_hz: f64) -> f64 {
    let seconds = (1.0 / rate_hz).clamp(1e-6, 0.1);
    format!("{seconds:.3e}").parse().unwrap_or(seconds)
}

/// A path as a shell takes it.
pub fn quoted_path(path: &Path) -> String {
    quoted(&text(path))
}

/// A path, as [`text`] gives it, as a shell takes it: in quotes where it holds anything but letters, digits and plain signs, with
/// what a terminal would not show as it is in octal, as in `$'a\033b'` (POSIX 2024, bash, zsh, ksh).
pub fn quoted(path: &str) -> String {
    // What begins with a dash would be taken for an option.
    let folder = if path.starts_with('-') { "./" } else { "" };
    if !path.is_empty() && path.chars().all(plain) {
        return format!("{folder}{path}");
    }
    if !path.chars().any(is_unseen) {
        return format!("'{folder}{}'", path.replace('\'', "'\\''"));
    }
    let mut out = format!("$'{folder}");
    for c in path.chars() {
        if let Some(byte) = stands_for(c) {
            out.push_str(&octal(byte));
        } else if is_unseen(c) {
            let mut bytes = [0; 4];
            out.extend(c.encode_utf8(&mut bytes).bytes().map(octal));
        } else {
            if matches!(c, '\'' | '\\') {
                out.push('\\');
            }
            out.push(c);
        }
    }
    out.push('\'');
    out
}

/// Three digits, so that a digit behind them is none of theirs.
fn octal(byte: u8) -> String {
    format!("\\{byte:03o}")
}

/// Whether a terminal shows a character as nothing, does something at it, or turns what is around it.
pub fn is_unseen(c: char) -> bool {
    c.is_control()
        || stands_for(c).is_some()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

/// What an axis file for a log may be called, as a shell takes it: by the log, so that those of several do not meet. Where one of
/// that name is there and a log of the same name in another format lies beside, the ending is part of it.
pub fn axis_file(log: &str) -> String {
    let path = Path::new(log);
    let short = named_by(path.file_stem());
    match Path::new(&short).exists() && has_namesake(path) {
        true => quoted(&named_by(path.file_name())),
        false => quoted(&short),
    }
}

/// An axis file for a log that is not there yet, as a shell takes it: by the whole name of the log, else with a number.
pub fn new_axis_file(log: &Path) -> String {
    let whole = named_by(log.file_name());
    let numbered = (2..).map(|number| whole.replace(".axis.toml", &format!(".{number}.axis.toml")));
    let mut names = [named_by(log.file_stem()), whole.clone()]
        .into_iter()
        .chain(numbered);
    // A name that leads nowhere is one too.
    let is_free = |name: &String| Path::new(name).symlink_metadata().is_err();
    quoted(&names.find(is_free).unwrap_or(whole))
}

/// A folder to write into that holds nothing: this one, else with a number behind its name.
pub fn free_folder(dir: &Path) -> PathBuf {
    let is_free = |dir: &PathBuf| match std::fs::read_dir(dir) {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) => dir.symlink_metadata().is_err(),
    };
    let name = dir.file_name().map(std::ffi::OsStr::to_os_string);
    let Some(name) = name.filter(|_| !is_free(&dir.to_path_buf())) else {
        return dir.to_path_buf();
    };
    let numbered = (2..).map(|number| {
        let mut name = name.clone();
        name.push(format!("-{number}"));
        dir.with_file_name(name)
    });
    numbered
        .take(MOST_NAMES)
        .find(is_free)
        .unwrap_or(dir.to_path_buf())
}

fn named_by(name: Option<&std::ffi::OsStr>) -> String {
    let name = name.map(|name| name.to_string_lossy());
    format!("{}.axis.toml", name.as_deref().unwrap_or("log"))
}

/// Most names of a folder that are looked at.
const MOST_NAMES: usize = 10_000;

/// Whether a file of the same name with another ending lies beside a log.
fn has_namesake(log: &Path) -> bool {
    let folder = match log.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .take(MOST_NAMES)
        .map(|entry| entry.path())
        .any(|path| {
            path.file_stem() == log.file_stem()
                && path.file_name() != log.file_name()
                && path.extension().is_some_and(|end| end != "toml")
                && path.is_file()
        })
}

/// A name in the midst of a text: a line feed in it begins no line.
pub fn shown(name: &str) -> String {
    name.replace('\n', "\\n")
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

    #[test]
    fn what_a_terminal_does_not_show_is_typed_in_octal() {
        assert_eq!(quoted("\u{1b}[31m it's"), "$'\\033[31m it\\'s'");
        assert_eq!(quoted("-a\n1"), "$'./-a\\0121'");
        assert_eq!(quoted("a\u{202e}b\\c"), "$'a\\342\\200\\256b\\\\c'");
    }

    /// Whatever bytes a name has, the shell gives them back, and none of them reaches the terminal that is not to be seen.
    #[cfg(unix)]
    #[test]
    fn a_shell_gives_the_very_name() {
        use super::quoted_path;
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        use std::path::Path;
        use std::process::Command;
        let every: Vec<u8> = (1..=255).collect();
        let names: [&[u8]; 7] = [
            &every,
            b"plain.csv",
            b"it's $(id) `x`.csv",
            b"\x1b[31mname.csv",
            "a\u{202e}b\u{2066}.csv".as_bytes(),
            b"non\xff7utf\xc3.csv",
            "\u{10ffff}\u{10ff80}.csv".as_bytes(),
        ];
        for name in names {
            let typed = quoted_path(Path::new(OsStr::from_bytes(name)));
            assert!(!typed.chars().any(super::is_unseen), "{typed:?}");
            let script = format!("printf %s {typed}");
            let Ok(shown) = Command::new("bash").args(["-c", &script]).output() else {
                return;
            };
            assert_eq!(shown.stdout, name, "{typed}");
        }
    }
}
