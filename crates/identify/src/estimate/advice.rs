//! Why the data do not determine a parameter: what it moves together with, and the motion that would
//! tell them apart.

use crate::estimate::parameter::Parameter;
use crate::estimate::uncertainty::Covariance;

/// Correlation from which a pair of parameters is named.
const STRONG: f64 = 0.9;
/// Most partners that are named.
const MOST: usize = 2;

/// Adds partners and advice to every parameter that is not identifiable.
pub(crate) fn explain(parameters: &mut [Parameter], covariance: &Covariance) {
    let correlation = covariance.correlation();
    for parameter in parameters.iter_mut().filter(|p| p.identified) {
        if parameter.identifiable {
            parameter.moves_with.clear();
            parameter.advice.clear();
            continue;
        }
        let mut partners: Vec<(String, f64)> = covariance
            .names
            .iter()
            .position(|n| *n == parameter.name)
            .map_or_else(Vec::new, |i| {
                (0..correlation.len())
                    .filter(|&j| j != i && correlation[i][j].abs() >= STRONG)
                    .map(|j| (covariance.names[j].clone(), correlation[i][j]))
                    .collect()
            });
        partners.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        partners.truncate(MOST);
        parameter.moves_with = partners;
        parameter.advice = cure(&parameter.name).into();
    }
}

/// What motion would determine a parameter, by the Cramer-Rao bounds of different excitations
/// (docs/identification.md).
fn cure(name: &str) -> &'static str {
    let stem = name.trim_end_matches("_pos").trim_end_matches("_neg");
    match stem {
        "sigma0" => {
            "Record slow reversals within the presliding range, with a finer encoder or a higher rate"
        }
        "sigma1" => {
            "Record fast reversals of small amplitude, at 20 to 30 Hz, with a finer encoder or a \
             higher rate"
        }
        "sigma2" => "Record constant speeds up to the top speed of the axis",
        "static" | "stribeck_velocity" | "stribeck_exponent" => {
            "Record slow motion through the Stribeck range: speeds well below and above the \
             Stribeck velocity"
        }
        "mass" => "Record faster accelerations",
        "breakaway_ratio" => {
            "Record slow reversals that just break away, with a finer encoder or a higher rate"
        }
        "attraction" => "Record changes of speed while the axis slides slowly",
        "quadratic_viscous" => "Record speeds from slow to the top speed of the axis",
        "coulomb_load" => "Record several loads, each in both directions",
        "coulomb_temperature" | "sigma2_temperature" => {
            "Record the axis cold and warm, at the same speeds"
        }
        "delay" => "Record fast changes of speed",
        "coulomb" => "Record motion in both directions well above the Stribeck velocity",
        _ => "Record motion over more of the stroke in both directions",
    }
}
