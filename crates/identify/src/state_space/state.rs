//! What the likelihood found, stated in an estimate.

use crate::estimate::Estimate;
use crate::exponential::exp;
use crate::parameter::{Added, IntervalKind, NORMAL_Q95, Parameter, too_uncertain};
use crate::state_space::fit::Likely;
use crate::state_space::unknowns::{UNKNOWNS, lanes};
use crate::student;
use nalgebra::{DMatrix, DVector};
use stiction_parameters::{Name, Quantity};
use stiction_policy::interval;

/// A parameter as the likelihood has it.
struct Own {
    /// Its logarithm, the constant force itself.
    value: f64,
    /// 95 % reach of that.
    reach: f64,
    /// Weights of the free unknowns in it.
    weights: DVector<f64>,
}

impl Own {
    /// Adds to the variance of the parameter.
    fn widen(&mut self, name: Name, variance: f64) {
        let size = match name == Quantity::Offset {
            true => 1.0,
            false => exp(self.value),
        };
        self.reach = libm::hypot(self.reach, NORMAL_Q95 * variance.sqrt() / size);
    }
}

/// States the parameters of the likelihood, with what logs add to their variances. The jackknife leaves out parts of logs, of
/// which it takes those of one log for independent.
pub(super) fn state(estimate: &mut Estimate, found: &Likely, more: &Added) {
    let step = estimate.step;
    let parameters = &mut estimate.fitted.parameters;
    let mut owns: Vec<(Name, Own)> = Vec::new();
    for parameter in parameters.iter_mut().filter(|p| p.identified) {
        if let Some(mut own) = own(parameter.name, found) {
            own.widen(parameter.name, more.variance(parameter.name));
            write(parameter, &own);
            owns.push((parameter.name, own));
        } else if let Some([delay, reach]) = found.delay
            && parameter.name == Quantity::Delay
        {
            parameter.value = delay * step;
            let more = NORMAL_Q95 * more.variance(parameter.name).sqrt();
            normal(parameter, libm::hypot(reach * step, more));
        }
    }
    let covariance = &mut estimate.fitted.covariance;
    let correlated = |a: &Own, b: &Own, m: &DMatrix<f64>| a.weights.dot(&(m * &b.weights));
    let deviation = |name: Name| {
        parameters
            .iter()
            .find(|p| p.name == name)
            .and_then(|p| p.std)
    };
    for (i, first) in covariance.names.iter().enumerate() {
        for (j, second) in covariance.names.iter().enumerate() {
            let of = |name: &Name| owns.iter().find(|(own, _)| own == name).map(|(_, own)| own);
            let correlation = match (of(first), of(second)) {
                _ if i == j => 1.0,
                (Some(a), Some(b)) => {
                    let m = &found.sureness.seen;
                    correlated(a, b, m) / (correlated(a, a, m) * correlated(b, b, m)).sqrt()
                }
                _ => 0.0,
            };
            if let (Some(a), Some(b)) = (deviation(*first), deviation(*second)) {
                covariance.matrix[i][j] = if correlation.is_finite() {
                    correlation * a * b
                } else {
                    0.0
                };
            }
        }
    }
}

/// What rests spoil in a fit of the force: all that a bristle deflects by.
const SPOILED: [Quantity; 4] = [
    Quantity::Sigma0,
    Quantity::Sigma1,
    Quantity::Static,
    Quantity::StribeckVelocity,
];

/// Flags the parameters that rests spoil where their interval does not hold what the likelihood says, which is not believed
/// either; where another curve is likelier, all that a curve of another shape moves.
pub(super) fn doubt(estimate: &mut Estimate, found: &Likely) {
    if found.exponent.is_some() {
        let moved = |q: Quantity| ![Quantity::Mass, Quantity::Offset].contains(&q);
        let why = "are likelier with another Stribeck exponent";
        flag(&mut estimate.fitted.parameters, moved, why);
    }
    for parameter in &mut estimate.fitted.parameters {
        if !SPOILED.contains(&parameter.name.quantity) || !parameter.identified {
            continue;
        }
        let interval = parameter.ci95.filter(|_| parameter.identifiable);
        let (Some((low, high)), Some(own)) = (interval, own(parameter.name, found)) else {
            continue;
        };
        let other = exp(own.value);
        if !(low..=high).contains(&other) {
            parameter.identifiable = false;
            parameter.reason = format!(
                "the axis rests in much of this log, where the counts of the encoder contradict this value and are not believed either: {}",
                found.against
            );
        }
    }
}

/// The same beside elements: what makes them late is as little told from what filters make of rests as micro-damping is.
const SPOILED_BESIDE_ELEMENTS: [Quantity; 2] = [Quantity::Attraction, Quantity::Delay];

/// Flags the parameters that rests spoil whatever their interval.
pub(super) fn doubt_all(parameters: &mut [Parameter], why: &str) {
    let of_elements = |p: &Parameter| p.name.quantity.is_of_an_element();
    let has_elements = parameters.iter().any(of_elements);
    let spoiled =
        |q: Quantity| SPOILED.contains(&q) || has_elements && SPOILED_BESIDE_ELEMENTS.contains(&q);
    flag(parameters, spoiled, why);
}

fn flag(parameters: &mut [Parameter], spoiled: impl Fn(Quantity) -> bool, why: &str) {
    let claimed = |p: &&mut Parameter| spoiled(p.name.quantity) && p.identified && p.identifiable;
    for parameter in parameters.iter_mut().filter(claimed) {
        parameter.identifiable = false;
        parameter.reason = format!(
            "the axis rests in much of the logs, and their counts, which would say more than the force, {why}"
        );
    }
}

fn own(name: Name, found: &Likely) -> Option<Own> {
    let lanes = lanes(name)?;
    let weights = DVector::from_iterator(
        found.free.len(),
        found
            .free
            .iter()
            .map(|lane| f64::from(u8::from(lanes.contains(lane)))),
    );
    let deviation = |m: &DMatrix<f64>| weights.dot(&(m * &weights)).max(0.0).sqrt();
    let sum = |at: &[f64; UNKNOWNS]| -> f64 { lanes.iter().map(|&lane| at[lane]).sum() };
    let value = sum(&found.at);
    let other = found.other.as_ref().map_or(value, sum);
    let sureness = &found.sureness;
    let quantile = student::quantile(sureness.freedom(&weights));
    let seen = sureness.wider * quantile * deviation(&sureness.seen);
    let delayed = match name.quantity {
        Quantity::Sigma1 => found.delayed,
        _ => 0.0,
    };
    let chance = seen.max(NORMAL_Q95 * deviation(&sureness.stated));
    Some(Own {
        value,
        // Where another curve is as likely, the interval reaches as far as it has the parameter.
        reach: libm::hypot(chance, delayed) + (other - value).abs(),
        weights,
    })
}

fn write(parameter: &mut Parameter, own: &Own) {
    if parameter.name == Quantity::Offset {
        parameter.value = own.value;
        return normal(parameter, own.reach);
    }
    let relative = own.reach / NORMAL_Q95;
    let value = exp(own.value);
    parameter.value = value;
    parameter.std = Some(relative * value);
    parameter.bias = None;
    parameter.interval = IntervalKind::StateSpace;
    parameter.ci95 = (own.reach <= interval::MAX_LOG_HALF_WIDTH)
        .then(|| (value * exp(-own.reach), value * exp(own.reach)));
    parameter.identifiable = own.reach <= interval::MAX_HALF_WIDTH;
    parameter.reason = match parameter.identifiable {
        true => String::new(),
        false => too_uncertain(own.reach, "its value"),
    };
}

/// The interval of a parameter that may have either sign.
fn normal(parameter: &mut Parameter, reach: f64) {
    parameter.std = Some(reach / NORMAL_Q95);
    parameter.bias = None;
    parameter.interval = IntervalKind::StateSpace;
    parameter.ci95 = Some((parameter.value - reach, parameter.value + reach));
}
