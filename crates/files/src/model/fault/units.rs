//! Whether a parameter stands in the unit that an identification writes it in.

use super::Fault;
use crate::model::form::ModelFile;
use crate::symbols;
use stiction_formats::Unit;
use stiction_log::Motion;
use stiction_parameters::{Dimension, Quantity};

/// Whether two texts are one unit, however written.
pub(in crate::model) fn same_unit(found: &str, wanted: &str) -> bool {
    let parsed =
        |text| Unit::parse(text).map(|unit| (unit.dimension(), unit.to_si(0.0), unit.factor()));
    found == wanted || matches!((parsed(found), parsed(wanted)), (Ok(a), Ok(b)) if a == b)
}

/// What is wrong with the unit of a parameter, of which the quantity is known.
pub(super) fn fault(
    model: &ModelFile,
    motion: Motion,
    quantity: Quantity,
    i: usize,
) -> Option<Fault> {
    let p = &model.parameter[i];
    let of = |load: &str| symbols::unit(quantity.dimension(), motion, &model.force_unit, load);
    let reference = model.parameter.iter().find(|p| p.name == "load_reference");
    let (good, wanted) = match (quantity.dimension(), reference) {
        // A load is in whatever the log has it in.
        (Dimension::Load, _) => (is_coherent(&p.unit), "an SI unit such as \"N\"".to_string()),
        // Of a load in an unknown unit that is what is said.
        (Dimension::ForcePerLoad, Some(load)) if !is_coherent(&load.unit) => return None,
        (Dimension::ForcePerLoad, Some(load)) => {
            let wanted = of(&load.unit);
            let beside = format!(
                "{wanted:?}, with its value, beside load_reference in {:?}",
                short(&load.unit)
            );
            (same_unit(&p.unit, &wanted), beside)
        }
        (Dimension::ForcePerLoad, None) => {
            let force = &model.force_unit;
            let wanted = format!("\"1\" or such as \"{force}/kg\", with its value");
            (is_coherent(&p.unit), wanted)
        }
        _ => (
            same_unit(&p.unit, &of("")),
            format!("{:?}, with its value", of("")),
        ),
    };
    (!good).then(|| {
        let found = format!("{} in {:?}", p.name, short(&p.unit));
        (format!("parameter[{}].unit", i + 1), found, wanted)
    })
}

/// Whether a unit is made of SI units alone.
fn is_coherent(text: &str) -> bool {
    Unit::parse(text).is_ok_and(|unit| unit.factor() == 1.0 && unit.to_si(0.0) == 0.0)
}

fn short(text: &str) -> String {
    text.chars().take(60).collect()
}
