//! A log that wrapped, and what depends on the place without having that period.

use super::terms::Beside;
use std::f64::consts::TAU;
use stiction_files::{ModelFile, Warning};
use stiction_friction::compensator::Wave;
use stiction_parameters::{Name, Quantity};
use stiction_policy::export;
use stiction_say::Notice;

/// What cannot be told from a position that wraps as that of the log did, if anything.
pub(super) fn doubt(file: &ModelFile, beside: &Beside) -> Option<Warning> {
    let wrap = file.range.wrap.filter(|wrap| *wrap > 0.0)?;
    let place = beside.terms.channels.position;
    if place.turns && repeats(wrap, TAU) {
        return None;
    }
    let told = |wave: &Wave<f64>| wave.rate == 0.0 || wave.whole && repeats(wrap, TAU / wave.rate);
    let levels = beside.terms.levels.unwrap_or_default();
    let weight = beside.terms.weight.unwrap_or_default();
    let waves_told = levels.waves.iter().flatten().all(told);
    let lost = |name: &String| match name.parse::<Name>().ok()?.quantity {
        Quantity::CoulombPosition => Some(name.clone()),
        Quantity::CoulombPitch(..) | Quantity::CoulombMap(_) => (!waves_told).then(|| name.clone()),
        Quantity::Cogging(..) => (!beside.terms.cogging.iter().all(told)).then(|| name.clone()),
        Quantity::Gravity(_) => (!told(&weight.wave)).then(|| name.clone()),
        _ => None,
    };
    let lost: Vec<String> = beside.taken.iter().filter_map(lost).collect();
    if lost.is_empty() {
        return None;
    }
    let unit = match file.kind.as_str() {
        "rotary" => "rad",
        _ => "m",
    };
    let notice = Notice::WrappedPosition {
        travel: wrap,
        unit,
        names: lost,
        range: place.range,
    };
    Some(notice.into())
}

/// Whether a travel is a whole number of periods.
fn repeats(travel: f64, period: f64) -> bool {
    let times = travel / period;
    times.round() >= 1.0 && (times - times.round()).abs() <= export::MAX_WRAP_ERROR
}
