//! How a direction is marked on a symbol.

/// Sign of a direction by the suffix of its parameters.
pub(super) fn sign(side: &str) -> &'static str {
    match side {
        "_pos" => "+",
        "_neg" => "−",
        _ => "",
    }
}
