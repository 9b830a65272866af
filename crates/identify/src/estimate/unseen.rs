//! An element of Maxwell slip that no count of the encoder shows.
//!
//! One that slips over within a count is a force that changes its sign with the speed. Friction has it in `Fc`, and a fit puts there
//! what is no friction at all: the phase of a resonance, of a drive that lags, of a force that is logged late. What the other elements
//! and the curve then say of rest and slow motion is what is left beside it.

use crate::parameter::Parameter;
use stiction_parameters::Quantity;

/// Counts of the encoder that an element has to move before it slips for them to show it.
const SHOWN: f64 = 2.0;

/// What such an element makes of the law beside the elements, whose shape is then not that of friction alone.
const MOVED: [Quantity; 5] = [
    Quantity::Sigma0,
    Quantity::Static,
    Quantity::StribeckVelocity,
    Quantity::Attraction,
    Quantity::Delay,
];

/// Flags what an element that slips within two counts of `resolution` m (rad) takes part in, and all elements.
pub(super) fn flag_what_an_unseen_element_takes(
    resolution: Option<f64>,
    parameters: &mut [Parameter],
) {
    let Some(count) = resolution else { return };
    let unseen = parameters.iter().find_map(|p| match p.name.quantity {
        Quantity::ElementYield(k) if p.identified && p.value < SHOWN * count => Some((k, p.value)),
        _ => None,
    });
    let Some((element, deflection)) = unseen else {
        return;
    };
    let claimed = parameters
        .iter_mut()
        .filter(|p| p.identified && p.identifiable);
    let moved =
        |p: &&mut Parameter| MOVED.contains(&p.name.quantity) || p.name.quantity.is_of_an_element();
    for p in claimed.filter(moved) {
        p.identifiable = false;
        p.reason = format!(
            "element {element} slips within {:.1} counts of the encoder, which no count shows: it may stand for a resonance, a drive that \
             lags or a force that is logged late",
            deflection / count
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(first_yield: f64) -> Vec<Parameter> {
        let one = |quantity: Quantity, value: f64| Parameter {
            identified: true,
            ..Parameter::given(quantity, value)
        };
        vec![
            one(Quantity::ElementStiffness(1), 1e7),
            one(Quantity::ElementYield(1), first_yield),
            one(Quantity::ElementYield(2), 3e-5),
            one(Quantity::Coulomb, 20.0),
            one(Quantity::Static, 22.0),
            one(Quantity::Mass, 10.0),
        ]
    }

    #[test]
    fn an_element_within_a_count_opens_what_it_takes_part_in_and_nothing_else() {
        let open = |first: f64, resolution: Option<f64>| {
            let mut parameters = law(first);
            flag_what_an_unseen_element_takes(resolution, &mut parameters);
            let open = parameters.iter().filter(|p| !p.identifiable);
            open.map(|p| p.name.to_string())
                .collect::<Vec<_>>()
                .join(" ")
        };
        assert_eq!(
            open(1.2e-7, Some(1e-7)),
            "stiffness_1 yield_1 yield_2 static"
        );
        assert_eq!(open(3e-7, Some(1e-7)), "");
        assert_eq!(open(1.2e-7, None), "");
    }
}
