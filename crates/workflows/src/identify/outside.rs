//! Parameters outside the ranges that the axis file gives a search: least squares are not kept within them.

use stiction_files::Warning;
use stiction_files::symbols;
use stiction_identify::FittedLaw;
use stiction_log::Log;
use stiction_parameters::{ParameterSet, Quantity, Side};
use stiction_say::{Notice, Outside, Value};

/// Parameters of a law outside the ranges of `[search.box]`, which are for sigma0, sigma1, sigma2, Fc, Fs - Fc and vs, SI.
pub(super) fn named(ranges: &[Option<[f64; 2]>; 6], law: &FittedLaw, log: &Log) -> Option<Warning> {
    let values = law.values();
    let keys = [
        ("sigma0", Quantity::Sigma0),
        ("sigma1", Quantity::Sigma1),
        ("sigma2", Quantity::Sigma2),
        ("coulomb", Quantity::Coulomb),
        ("static_excess", Quantity::Static),
        ("stribeck_velocity", Quantity::StribeckVelocity),
    ];
    let both = [(Side::Positive, "_pos"), (Side::Negative, "_neg")];
    let mut said = Vec::new();
    for ((key, quantity), range) in keys.into_iter().zip(ranges) {
        let Some([low, high]) = range else { continue };
        let values = both.map(|(side, end)| (value(&values, quantity, side), end));
        let same = values[0].0 == values[1].0;
        for (value, end) in values.into_iter().take(if same { 1 } else { 2 }) {
            let Some(value) = value.filter(|x| !(low..=high).contains(&x)) else {
                continue;
            };
            let unit = symbols::unit(quantity.dimension(), log.motion, &log.force_unit, "");
            let end = if same { "" } else { end };
            said.push(Outside {
                name: format!("{key}{end}"),
                value: Value::new(value, unit),
                range: [*low, *high],
            });
        }
    }
    (!said.is_empty()).then(|| Notice::OutsideBox { each: said }.into())
}

/// The value of a key of the box.
fn value(values: &ParameterSet, quantity: Quantity, side: Side) -> Option<f64> {
    let value = values.on(quantity, side)?;
    match quantity {
        Quantity::Static => Some(value - values.on(Quantity::Coulomb, side)?),
        _ => Some(value),
    }
}
