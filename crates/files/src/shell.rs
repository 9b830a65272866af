//! Commands as they are typed.

use std::path::Path;

/// Whether a shell takes a letter as it stands.
pub fn plain(c: char) -> bool {
    c.is_alphanumeric() || "/._-+=:,@%".contains(c)
}

/// A path as a shell takes it: in quotes where it holds anything but letters, digits and plain signs.
pub fn quoted(path: &str) -> String {
    // What begins with a dash would be taken for an option.
    let folder = if path.starts_with('-') { "./" } else { "" };
    match !path.is_empty() && path.chars().all(plain) {
        true => format!("{folder}{path}"),
        false => format!("'{folder}{}'", path.replace('\'', "'\\''")),
    }
}

/// What an axis file for a log may be called, as a shell takes it: by the log, so that those of several do not meet.
pub fn axis_file(log: &str) -> String {
    let stem = Path::new(log)
        .file_stem()
        .map(|stem| stem.to_string_lossy());
    quoted(&format!("{}.axis.toml", stem.as_deref().unwrap_or("log")))
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
