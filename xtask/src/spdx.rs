//! SPDX licence expressions: `OR`, `AND`, `WITH`, brackets, and cargo's older `/` for `OR`.

/// Whether the expression can be satisfied by licences that `allowed` accepts; `None` when the
/// text is not an expression. `AND` binds tighter than `OR`, as in SPDX annex D.
pub fn permits(expression: &str, allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    let spaced = expression
        .replace('(', " ( ")
        .replace(')', " ) ")
        .replace('/', " OR ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = &words[..];
    let result = any(&mut rest, allowed)?;
    rest.is_empty().then_some(result)
}

fn any(words: &mut &[&str], allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    let mut result = all(words, allowed)?;
    while take(words, "OR") {
        result |= all(words, allowed)?;
    }
    Some(result)
}

fn all(words: &mut &[&str], allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    let mut result = term(words, allowed)?;
    while take(words, "AND") {
        result &= term(words, allowed)?;
    }
    Some(result)
}

fn term(words: &mut &[&str], allowed: &dyn Fn(&str) -> bool) -> Option<bool> {
    if take(words, "(") {
        let result = any(words, allowed)?;
        return take(words, ")").then_some(result);
    }
    let name = next(words)?;
    if take(words, "WITH") {
        let exception = next(words)?;
        return Some(allowed(&format!("{name} WITH {exception}")));
    }
    Some(allowed(name))
}

fn next<'a>(words: &mut &[&'a str]) -> Option<&'a str> {
    let (first, rest) = words.split_first()?;
    if matches!(*first, "OR" | "AND" | "WITH" | "(" | ")") {
        return None;
    }
    *words = rest;
    Some(first)
}

fn take(words: &mut &[&str], word: &str) -> bool {
    let found = words.first() == Some(&word);
    if found {
        *words = &words[1..];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::permits;

    fn mit_only(expression: &str) -> Option<bool> {
        permits(expression, &|term| term == "MIT" || term == "A WITH e")
    }

    #[test]
    fn expressions_have_their_logical_value() {
        assert_eq!(mit_only("MIT"), Some(true));
        assert_eq!(mit_only("GPL-3.0"), Some(false));
        assert_eq!(mit_only("GPL-3.0/MIT"), Some(true));
        assert_eq!(mit_only("GPL-3.0 AND MIT"), Some(false));
        assert_eq!(mit_only("MIT OR GPL-3.0 AND X"), Some(true));
        assert_eq!(mit_only("(MIT OR GPL-3.0) AND X"), Some(false));
        assert_eq!(mit_only("A WITH e"), Some(true));
        assert_eq!(mit_only("A"), Some(false));
    }

    #[test]
    fn other_text_is_no_expression() {
        for text in ["", "MIT MIT", "OR MIT", "(MIT", "MIT AND", "A WITH"] {
            assert_eq!(mit_only(text), None, "{text}");
        }
    }
}
