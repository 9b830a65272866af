//! Names that are legal in every target.

use crate::Error;

/// Longest identifier: with the longest ending that a target appends it stays distinct within 31 characters, which is
/// what C99 promises (section 5.2.4.1).
pub const IDENTIFIER_LENGTH: usize = 18;

/// An identifier from any name: what is no letter or digit becomes an underscore; `axis` where nothing is left.
///
/// ```
/// assert_eq!(stiction_export::identifier("X-Achse, links (1)"), "X_Achse_links_1");
/// assert_eq!(stiction_export::identifier("../"), "axis");
/// assert_eq!(stiction_export::identifier("2nd"), "axis_2nd");
/// ```
pub fn identifier(name: &str) -> String {
    let words: Vec<&str> = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    let mut text = words.join("_");
    if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        text.insert_str(0, if text.is_empty() { "axis" } else { "axis_" });
    }
    text.truncate(IDENTIFIER_LENGTH);
    text.trim_end_matches('_').to_string()
}

/// Refuses a name that is no identifier in every target. (Double underscores are reserved in C and forbidden in
/// IEC 61131-3. Key words need no care: no target uses the name without an ending of its own.)
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
            "abcdefghijklmnopqrs",
        ] {
            assert!(check_identifier(name).is_err(), "{name}");
        }
    }
}
