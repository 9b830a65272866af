//! What the TOML reader refused, in the words of the file.

/// Where, what was found, and what is allowed instead.
pub(crate) struct Refusal {
    pub place: String,
    pub found: String,
    pub allowed: String,
}

/// Longest piece of the file that is quoted.
const QUOTED: usize = 60;

/// Puts an error of the reader into place, found and allowed; `page` lists every key.
pub(crate) fn refusal(text: &str, error: &toml::de::Error, page: &str) -> Refusal {
    let see = || format!("see {page} for every key");
    let span = error.span().unwrap_or(0..0);
    let message = error.message().trim().replace('\n', " ");
    let Some(before) = text.get(..span.start).filter(|_| error.span().is_some()) else {
        return Refusal {
            place: String::new(),
            found: message,
            allowed: see(),
        };
    };
    let number = before.matches('\n').count();
    let line = text.lines().nth(number).unwrap_or("");
    let key = line.split_once('=').map(|(key, _)| key.trim());
    let place = match key.filter(|key| !key.is_empty() && !key.contains(char::is_whitespace)) {
        Some(key) => format!("line {}, {key}: ", number + 1),
        None => format!("line {}: ", number + 1),
    };
    // Only the word `expected` parts what was found from what is allowed.
    let (found, allowed) = match message.split_once(", expected ") {
        Some((found, expected)) => (found.to_string(), plain(expected)),
        None if message.starts_with(super::raw::EXPECTS) => {
            (quote(text.get(span).unwrap_or("")), message)
        }
        None => (message, see()),
    };
    Refusal {
        place,
        found,
        allowed,
    }
}

/// Types of a program in the words of a person.
fn plain(expected: &str) -> String {
    match expected {
        "a string" => "text in quotes, a value with its unit, such as \"4.6 kg\"".into(),
        "a boolean" => "true or false, without quotes".into(),
        "f64" => "a number, without quotes".into(),
        "usize" => "a whole number from 0, without quotes".into(),
        "an array of length 2" => "two values in brackets, such as [\"1 s\", \"20 s\"]".into(),
        other => other.into(),
    }
}

fn quote(found: &str) -> String {
    let line = found.replace(char::is_control, " ");
    if line.chars().count() <= QUOTED {
        return format!("`{line}`");
    }
    let start: String = line.chars().take(QUOTED).collect();
    format!("`{start}...`")
}
