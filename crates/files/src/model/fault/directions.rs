//! What is wrong with the directions of a model: a parameter is the same in both, or has one of each.

use super::Fault;
use crate::model::form::ModelFile;
use stiction_parameters::{Name, Quantity, Side};

/// Everything that is wrong with them.
pub(super) fn faults(model: &ModelFile) -> Vec<Fault> {
    let mut all = Vec::new();
    let names: Vec<Option<Name>> = (model.parameter.iter())
        .map(|p| p.name.parse().ok())
        .collect();
    let has = |quantity: Quantity, side: Side| {
        let is_it = |name: &Name| name.quantity == quantity && name.side == side;
        names.iter().flatten().any(is_it)
    };
    let steady = |name: &Name| name.quantity.is_of_the_steady_curve();
    let curve_is_sided =
        (names.iter().flatten()).any(|name| steady(name) && name.side != Side::Both);
    let mut told = Vec::new();
    for (i, name) in names.iter().enumerate() {
        let Some(name) = name.filter(|name| name.quantity.may_differ_by_side()) else {
            continue;
        };
        let quantity = name.quantity;
        if told.contains(&quantity) {
            continue;
        }
        told.push(quantity);
        let sides = [Side::Both, Side::Positive, Side::Negative].map(|side| has(quantity, side));
        let stem = quantity.stem();
        if matches!(sides, [true, false, false] | [false, true, true]) {
            // A slope that differs by direction is one of a level that does.
            if sides[1] && !curve_is_sided && !steady(&name) {
                let found = format!(
                    "{stem}_pos and {stem}_neg in a model without a level for each direction"
                );
                let allowed = format!("{stem}, or coulomb_pos and coulomb_neg beside them");
                all.push((key(i), found, allowed));
            }
            continue;
        }
        let present: Vec<String> = ([Side::Both, Side::Positive, Side::Negative].into_iter())
            .zip(sides)
            .filter(|(_, there)| *there)
            .map(|(side, _)| Name { quantity, side }.to_string())
            .collect();
        let allowed = format!("{stem}, or {stem}_pos and {stem}_neg");
        all.push((key(i), present.join(" and "), allowed));
    }
    if all.is_empty() {
        all.extend(against(model, &names, curve_is_sided));
    }
    all
}

/// Directions against what the model says of itself.
fn against(model: &ModelFile, names: &[Option<Name>], sided: bool) -> Option<Fault> {
    let of_the_curve = |name: &Name| name.quantity.is_of_the_steady_curve();
    if !model.asymmetric {
        let name = names
            .iter()
            .flatten()
            .find(|name| name.side != Side::Both && name.quantity.may_differ_by_side())?;
        return Some((
            "asymmetric".into(),
            format!("false beside {name}"),
            "true".into(),
        ));
    }
    let any = names.iter().flatten().any(of_the_curve);
    (any && !sided).then(|| {
        let found = "true, and no parameter has a direction".into();
        let allowed = "coulomb_pos and coulomb_neg and so on, or false".into();
        ("asymmetric".into(), found, allowed)
    })
}

fn key(i: usize) -> String {
    format!("parameter[{}].name", i + 1)
}
