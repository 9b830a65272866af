//! Names and sentences that reports and the terminal share.

use stiction_files::result::{LawEntry, ParameterEntry, ResultFile, SimulationEntry};
use stiction_number::four_digits;
use stiction_parameters::{Name, Quantity};

/// Ratio of two errors from which the larger one is called worse, dimensionless: tables show three digits.
const WORSE: f64 = 1.001;

/// The law of a result, as it stands in a heading.
pub(crate) fn law_of(result: &ResultFile) -> String {
    let mut name = named(&result.law, result.asymmetric, &result.without);
    let mut parameters = result.parameters.iter();
    if parameters.any(|p| p.name.starts_with("quadratic_viscous")) {
        name.push_str(" + v|v|");
    }
    name
}

/// A law of a comparison, with a constant force named where that is not usual.
pub(crate) fn law_beside(entry: &LawEntry) -> String {
    let mut name = named(&entry.law, entry.asymmetric, &entry.without);
    if entry.exponent_fitted {
        name.push_str(", δ fitted");
    }
    if entry.quadratic_viscous {
        name.push_str(" + v|v|");
    }
    if entry.asymmetric && entry.offset {
        name.push_str(", with offset");
    }
    name
}

/// The laws that predict as well as the one of the result; `None` where there are no others.
pub(crate) fn as_good(laws: &[LawEntry]) -> Option<String> {
    // Of a law that was asked for the others may be better.
    laws.iter().find(|law| law.reported && law.as_good)?;
    let others = laws
        .iter()
        .filter(|law| law.as_good && !law.reported && law.held_back.is_none());
    let others: Vec<String> = others.map(law_beside).collect();
    (!others.is_empty()).then(|| others.join("; "))
}

fn named(law: &str, asymmetric: bool, without: &[String]) -> String {
    let mut name = family(law).to_string();
    for held in without {
        name.push_str(match held.as_str() {
            "stribeck" => " with Fs = Fc",
            "sigma1" => " with σ₁ = 0",
            _ => "",
        });
    }
    if asymmetric {
        name.push_str(", asymmetric");
    }
    name
}

/// A family by its name in files.
fn family(law: &str) -> &str {
    match law {
        "coulomb-viscous" => "Coulomb + viscous",
        "stribeck" => "Stribeck",
        "dahl" => "Dahl",
        "lugre" => "LuGre",
        "elasto-plastic" => "Elasto-plastic",
        "maxwell-slip" => "Maxwell slip",
        "gms" => "Generalised Maxwell slip",
        other => other,
    }
}

/// What stands after the name of a law that the data chose.
pub(crate) fn chosen_by(who: &str) -> &'static str {
    match who {
        "cross-validation" => " (chosen by cross-validation)",
        "bic" => " (chosen by the Bayesian criterion: too few samples to hold some out)",
        _ => "",
    }
}

/// Why an asymmetric law fits worse than the symmetric one of its kind, where one does.
pub(crate) fn without_offset(laws: &[LawEntry]) -> Option<String> {
    let symmetric = |own: &LawEntry| {
        let mut others = laws.iter();
        others.find(|l| l.law == own.law && !l.asymmetric && l.without == own.without)
    };
    let worse = laws.iter().find(|own| {
        own.asymmetric
            && !own.offset
            && symmetric(own)
                .is_some_and(|s| own.fitted_error_percent > WORSE * s.fitted_error_percent)
    })?;
    Some(format!(
        "{} fits worse than {}: with levels of its own for each direction, no constant force (offset) is fitted \
         beside it unless the axis file asks for one ([terms] offset = true).",
        law_beside(worse),
        named(&worse.law, false, &worse.without)
    ))
}

/// What the fit simulated: how many runs or pieces, and what was fitted of their starts.
pub(crate) fn simulated_runs(entry: &SimulationEntry) -> String {
    let runs = match (entry.runs, entry.segment_s) {
        (1, _) => "one run from a fitted start".to_string(),
        (n, None) => format!("{n} runs, each from a fitted start"),
        (n, Some(seconds)) => format!(
            "{n} pieces of up to {} s, each from a fitted start",
            four_digits(seconds)
        ),
    };
    format!("{runs} ({} values)", entry.start_values)
}

/// What stands beside the errors of an open loop.
pub(crate) fn force_noise(entry: &SimulationEntry) -> Option<&'static str> {
    let open = entry.kind == "open" && entry.short_horizon.is_some();
    open.then_some(
        "Open loop: noise and errors of the logged force add up along a run, so an axis that slides drifts away even under \
         the right law; over a short time less has added up.",
    )
}

/// Whether parameters come from the counts of the encoder, and not from the fit of the force.
pub fn is_of_the_counts(result: &ResultFile) -> bool {
    let of_counts = |p: &ParameterEntry| p.interval.as_deref() == Some("state-space");
    result.parameters.iter().any(of_counts)
}

/// The parameters that tables show: the parts of a map of the level are shown as the level along the stroke.
pub(crate) fn parameters_shown(result: &ResultFile) -> impl Iterator<Item = &ParameterEntry> {
    let quantity = |p: &ParameterEntry| p.name.parse::<Name>().map(|name| name.quantity);
    let shown = move |p: &&ParameterEntry| !matches!(quantity(p), Ok(Quantity::CoulombMap(_)));
    result.parameters.iter().filter(shown)
}

#[cfg(test)]
mod tests {
    use super::without_offset;
    use stiction_files::result::LawEntry;

    fn entry(asymmetric: bool, error: f64) -> LawEntry {
        LawEntry {
            law: "lugre".into(),
            asymmetric,
            without: Vec::new(),
            exponent_fitted: false,
            offset: !asymmetric,
            quadratic_viscous: false,
            elements: None,
            parameters: 9,
            fitted_error_percent: error,
            held_out_error_percent: None,
            held_out_low_speed_error_percent: None,
            held_out_excess_percent: None,
            held_out_excess_std_percent: None,
            aic_difference: None,
            bic_difference: None,
            determined: true,
            held_back: None,
            best: false,
            as_good: false,
            reported: false,
        }
    }

    #[test]
    fn an_asymmetric_law_that_fits_worse_is_explained() {
        let note = without_offset(&[entry(false, 2.0), entry(true, 2.1)]);
        assert!(note.is_some_and(|n| n.starts_with("LuGre, asymmetric fits worse than LuGre: ")));
        assert_eq!(without_offset(&[entry(false, 2.0), entry(true, 1.9)]), None);
        assert_eq!(without_offset(&[entry(true, 1.9)]), None);
    }
}
