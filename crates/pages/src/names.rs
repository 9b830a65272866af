//! Names that reports and the terminal share.

/// A law by its name in files, as it stands in a heading.
pub(crate) fn law_name(law: &str, asymmetric: bool) -> String {
    let name = match law {
        "coulomb-viscous" => "Coulomb + viscous",
        "stribeck" => "Stribeck",
        "dahl" => "Dahl",
        "lugre" => "LuGre",
        "elasto-plastic" => "Elasto-plastic",
        "maxwell-slip" => "Maxwell slip",
        "gms" => "Generalised Maxwell slip",
        other => other,
    };
    if asymmetric {
        format!("{name}, asymmetric")
    } else {
        name.to_string()
    }
}

/// What stands after the name of a law that the data chose.
pub(crate) fn chosen_by(who: &str) -> &'static str {
    match who {
        "cross-validation" => " (chosen by cross-validation)",
        "validation" => " (chosen on the validation data)",
        "bic" => " (chosen by the Bayesian criterion: too few samples to hold some out)",
        _ => "",
    }
}
