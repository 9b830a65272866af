//! Names that are legal in every target.

use crate::Error;
use sha2::{Digest, Sha256};

/// Longest identifier, in characters; LinuxCNC's HAL takes less. The suffixes of a target are not included: where a C compiler
/// distinguishes only the 31 characters that C99 guarantees (section 5.2.4.1), use at most 18.
pub const IDENTIFIER_LENGTH: usize = 31;

/// An identifier from any name: characters other than letters and digits become an underscore; `axis` where nothing is left.
/// Where it is too long, digits of a hash replace its end, so that two names stay different.
///
/// ```
/// use stiction_export::identifier;
/// assert_eq!(identifier("X-Achse, links (1)"), "X_Achse_links_1");
/// assert_eq!(identifier("../"), "axis");
/// assert_eq!(identifier("2nd"), "axis_2nd");
/// let left = identifier("gantry of the long machine, axis 1, left");
/// assert_eq!(left.len(), 31);
/// assert_ne!(left, identifier("gantry of the long machine, axis 1, right"));
/// ```
pub fn identifier(name: &str) -> String {
    shortened(&uncut(name), IDENTIFIER_LENGTH)
}

/// Whether an identifier holds all letters and digits of a name.
pub fn is_whole(name: &str) -> bool {
    let lost = |c: char| c.is_alphanumeric() && !c.is_ascii();
    uncut(name).len() <= IDENTIFIER_LENGTH && !name.contains(lost)
}

fn uncut(name: &str) -> String {
    let words: Vec<&str> = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    let mut text = words.join("_");
    if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        text.insert_str(0, if text.is_empty() { "axis" } else { "axis_" });
    }
    text
}

/// An identifier of at most `length` characters, more than five: its beginning and four digits of its hash.
pub(crate) fn shortened(identifier: &str, length: usize) -> String {
    if identifier.len() <= length {
        return identifier.to_string();
    }
    let hash = Sha256::digest(identifier.as_bytes());
    let head = identifier[..length - 5].trim_end_matches('_');
    format!("{head}_{:02x}{:02x}", hash[0], hash[1])
}

/// Refuses a name that is not an identifier in every target. (Double underscores are reserved in C and forbidden in
/// IEC 61131-3. Keywords need no check: every target adds a suffix to the name.)
///
/// # Errors
/// With the name.
pub fn check_identifier(name: &str) -> Result<(), Error> {
    if !name.is_empty() && identifier(name) == name {
        return Ok(());
    }
    Err(Error::Identifier {
        found: name.chars().take(80).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Any name gives an identifier, and an identifier gives itself.
        #[test]
        fn any_name_gives_one(name in ".{0,60}") {
            let id = identifier(&name);
            prop_assert!(check_identifier(&id).is_ok());
            prop_assert!(id.len() <= IDENTIFIER_LENGTH && !id.contains("__"));
        }
    }

    #[test]
    fn others_are_refused() {
        for name in [
            "",
            "2nd",
            "a b",
            "a__b",
            "_a",
            "a_",
            "../a",
            "größe",
            "abcdefghijklmnopqrstuvwxyzabcdef",
        ] {
            assert!(check_identifier(name).is_err(), "{name}");
        }
    }
}
