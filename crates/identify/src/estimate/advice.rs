//! Why the data do not determine a parameter: with which other parameters it is correlated, and the
//! motion that would separate them.

use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use stiction_parameters::{Name, Quantity};
use stiction_policy::interval;

/// Adds correlated parameters and advice to every parameter that is not identifiable.
pub(crate) fn explain(parameters: &mut [Parameter], covariance: &Covariance) {
    let correlation = covariance.correlation();
    for parameter in parameters.iter_mut().filter(|p| p.identified) {
        if parameter.identifiable {
            parameter.moves_with.clear();
            parameter.advice.clear();
            continue;
        }
        let mut partners: Vec<(Name, f64)> =
            covariance.place(parameter.name).map_or_else(Vec::new, |i| {
                (0..correlation.len())
                    .filter(|&j| {
                        j != i && correlation[i][j].abs() >= interval::MIN_NAMED_CORRELATION
                    })
                    .map(|j| (covariance.names[j], correlation[i][j]))
                    .collect()
            });
        partners.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        partners.truncate(interval::MAX_NAMED_PARTNERS);
        parameter.moves_with = partners;
        parameter.advice = cure(parameter.name.quantity).into();
    }
}

/// What motion would determine a parameter, by the Cramer-Rao bounds of different excitations
/// (docs/identification.md).
fn cure(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Sigma0 => {
            "Record slow reversals within the presliding range, with a finer encoder or a higher rate"
        }
        Quantity::Sigma1 => {
            "Record fast reversals of small amplitude, at 20 to 30 Hz, with a finer encoder or a \
             higher rate"
        }
        Quantity::Sigma2 => "Record constant speeds up to the top speed of the axis",
        Quantity::Static | Quantity::StribeckVelocity | Quantity::StribeckExponent => {
            "Record slow motion through the Stribeck range: speeds well below and above the \
             Stribeck velocity"
        }
        Quantity::Mass => "Record faster accelerations",
        Quantity::BreakawayRatio => {
            "Record slow reversals that just break away, with a finer encoder or a higher rate"
        }
        Quantity::Attraction => "Record changes of speed while the axis slides slowly",
        Quantity::QuadraticViscous => "Record speeds from slow to the top speed of the axis",
        Quantity::CoulombLoad => "Record several loads, each in both directions",
        Quantity::CoulombTransmitted => {
            "Record the axis under little and much load, each in both directions"
        }
        Quantity::CoulombDriven => {
            "A weight that is fitted takes up what differs between driving and being driven: give what the load asks for as a \
             column of its own ([columns] external) and leave gravity out of [terms]"
        }
        Quantity::CoulombTemperature | Quantity::Sigma2Temperature => {
            "Record the axis cold and warm, at the same speeds"
        }
        Quantity::Delay => "Record fast changes of speed",
        Quantity::Coulomb => "Record motion in both directions well above the Stribeck velocity",
        _ => "Record motion over more of the stroke in both directions",
    }
}
