//! What a result may be used for, in words that reports and the terminal share.

use stiction_files::result::{Action, CauseEntry, Compensation, Origin, ResultFile, Trust};
use stiction_number::{Percent, counted, four_digits as short, quantity};

/// How well the law predicts friction, and on which motion that was seen.
pub(crate) fn compensation(seen: &Compensation, result: &ResultFile) -> String {
    let [length, speed] = match result.axis.kind.as_str() {
        "rotary" => ["rad", "rad/s"],
        _ => ["m", "m/s"],
    };
    let on = match seen.judged_on.as_str() {
        "held-out" => "samples it was not fitted to",
        "validation" => "the validation data",
        _ => "the samples it was fitted to",
    };
    let mut out = format!(
        "leaves {} of the friction on {on}; seen: speeds up to {} {speed}",
        Percent::error(seen.friction_left_percent).digits(3),
        short(seen.top_speed)
    );
    if let Some(stroke) = seen.stroke {
        out.push_str(&format!(", a stroke of {} {length}", short(stroke)));
    }
    out.push_str(&match seen.reversals {
        0 => ", no reversal".to_string(),
        1 => ", 1 reversal".to_string(),
        n => format!(", {n} reversals"),
    });
    out
}

/// The held-out error and the range of motion that it was seen on.
pub(crate) fn range(seen: &Compensation, result: &ResultFile) -> String {
    let [length, speed] = match result.axis.kind.as_str() {
        "rotary" => ["rad", "rad/s"],
        _ => ["m", "m/s"],
    };
    let on = match seen.judged_on.as_str() {
        "held-out" => "held-out error",
        "validation" => "validation error",
        _ => "fit error",
    };
    let stroke = seen.stroke.map_or(String::new(), |stroke| {
        format!(" over {}", quantity(stroke, length))
    });
    format!(
        "{on} {} of friction; valid up to {}{stroke} ({})",
        Percent::error(seen.friction_left_percent).digits(3),
        quantity(seen.top_speed, speed),
        counted(seen.reversals, "reversal")
    )
}

/// Why a law may not be used: what it leaves and why first, since a cure begins there.
pub(crate) fn why_not(trust: &Trust) -> String {
    let reasons = trust.reasons.iter().cloned();
    let all = trust.cause.iter().map(cause).chain(reasons);
    all.collect::<Vec<_>>().join("; ")
}

/// Whether a law may be used to compensate, in a word and why.
pub(crate) fn use_it(trust: &Trust) -> String {
    match (trust.trustworthy, &trust.cause) {
        (true, None) => "yes".to_string(),
        (true, Some(own)) => format!("yes, though {}", cause(own)),
        (false, _) => format!("NO: {}", why_not(trust)),
    }
}

/// What a law leaves and how much.
pub(crate) fn cause(cause: &CauseEntry) -> String {
    format!("{} ({})", cause.text, cause.size)
}

/// Which parameters are constants of the machine, each called as its name or its symbol.
pub(crate) fn constants(result: &ResultFile, called: impl Fn(&str) -> String) -> String {
    let trust = &result.trust;
    if trust.next == Action::Finish {
        return "none: a search by itself gives no intervals".into();
    }
    if trust.next == Action::Again {
        return "none: the run was stopped before it knew any interval".into();
    }
    let listed = |names: &[String]| {
        let called: Vec<_> = names.iter().map(|name| called(name)).collect();
        called.join(", ")
    };
    let mixed = match mixed_offset(result) {
        true => format!(
            "; {} cannot be told from a difference of friction between the two directions",
            called("offset")
        ),
        false => String::new(),
    };
    let mixed = format!(
        "{mixed}{}{}{}",
        pulled(result),
        unseen_rise(result),
        assumed_exponent(result, &called)
    );
    match (trust.constants.as_slice(), trust.open.as_slice()) {
        ([], []) => "none was identified".into(),
        ([], _) => "none: the log leaves every parameter open".into(),
        (_, []) => format!("every parameter, within its interval{mixed}"),
        (known, open) => format!("{}; left open: {}{mixed}", listed(known), listed(open)),
    }
}

/// That static friction was held, where the data chose so: a table of constants without it is no word against it.
fn unseen_rise(result: &ResultFile) -> &'static str {
    let held = result.law == "dahl" || result.without.iter().any(|held| held == "stribeck");
    match held && result.law_chosen_by == "cross-validation" {
        true => {
            "; static friction is held at Coulomb friction, since this motion shows no rise towards rest, which may be there all \
             the same"
        }
        false => "",
    }
}

/// That what describes the Stribeck curve holds for an exponent that was not fitted.
fn assumed_exponent(result: &ResultFile, called: impl Fn(&str) -> String) -> String {
    let own = result
        .parameters
        .iter()
        .find(|p| p.name == "stribeck_exponent");
    let of_curve = |name: &&String| name.starts_with("static") || name.starts_with("stribeck_v");
    let names: Vec<String> = result
        .trust
        .constants
        .iter()
        .filter(of_curve)
        .map(|name| called(name))
        .collect();
    if names.is_empty() || own.is_some_and(|p| p.origin == Origin::Identified) {
        return String::new();
    }
    let exponent = own.map_or(2.0, |p| p.value);
    let hold = if names.len() == 1 { "holds" } else { "hold" };
    format!(
        "; {} {hold} for {} = {}",
        names.join(", "),
        called("stribeck_exponent"),
        short(exponent)
    )
}

/// That levels of each direction have a constant force in them, where none is fitted beside them.
fn pulled(result: &ResultFile) -> &'static str {
    let has_offset = result.parameters.iter().any(|p| p.name == "offset");
    match result.asymmetric && !has_offset {
        true => {
            "; a constant force, such as a weight or an offset of the sensor, would be half of what the Coulomb levels of the \
             directions differ by"
        }
        false => "",
    }
}

/// Whether there is such a force, which is known but no constant.
fn mixed_offset(result: &ResultFile) -> bool {
    let own = |names: &[String]| names.iter().any(|name| name == "offset");
    let mut all = result.parameters.iter();
    let is_fitted = all.any(|p| p.name == "offset" && p.origin == Origin::Identified);
    is_fitted && !own(&result.trust.constants) && !own(&result.trust.open)
}
