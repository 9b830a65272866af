//! By how much parameters come out beside the truth of the replicas that were fitted.

use crate::estimate::Estimate;
use crate::parameter::physical::Physical;
use crate::replica::Replica;

/// Replicas that a shift is averaged over (decision 0014).
pub(crate) const REPLICA_COUNT: u64 = 10;
/// Factor by which a variance from ten replicas is enlarged because they are few: the square of Student's
/// 97.5 % quantile of 9 degrees of freedom over the normal one.
pub(crate) const TEN_REPLICAS_FACTOR: f64 = 1.332;
/// Part of a shift that counts as one standard deviation of its own error: on simulated closed loops
/// the replicas show the shift to about a tenth of its value.
pub(crate) const SHIFT_DOUBT: f64 = 0.1;

/// Shifts of all parameters, SI, replica by replica.
#[derive(Default)]
pub(crate) struct Shifts(pub Vec<Vec<f64>>);

impl Shifts {
    /// The number of replicas.
    pub fn count(&self) -> f64 {
        self.0.len() as f64
    }

    pub fn mean(&self, i: usize) -> f64 {
        self.0.iter().map(|s| s[i]).sum::<f64>() / self.count()
    }

    /// Variance from one replica to the next.
    pub fn variance(&self, i: usize) -> f64 {
        let mean = self.mean(i);
        let spread: f64 = self.0.iter().map(|s| (s[i] - mean).powi(2)).sum();
        spread / (self.count() - 1.0)
    }

    /// Square of the difference of the means, less the part that chance explains: by how much a shift is another one elsewhere
    /// (an iterated bootstrap: Hall 1992, doi 10.1007/978-1-4612-4384-7, section 1.4).
    pub fn change(&self, other: &Self, i: usize) -> f64 {
        let difference = self.mean(i) - other.mean(i);
        let chance = self.variance(i) / self.count() + other.variance(i) / other.count();
        // NaN with fewer than two replicas; `max` then gives zero.
        (difference * difference - chance).max(0.0)
    }
}

/// From true values to those that were found: differences, of logarithms where both are positive by nature.
pub(crate) fn between(truth: &[Physical], found: &[Physical]) -> Vec<f64> {
    let step = |(from, to): (&Physical, &Physical)| {
        if from.is_positive() && from.value > 0.0 && to.value > 0.0 {
            from.value * libm::log(to.value / from.value)
        } else {
            to.value - from.value
        }
    };
    truth.iter().zip(found).map(step).collect()
}

/// An estimate with what the fit of a replica found in place of its own: unknowns, coefficients and parameters.
pub(crate) fn as_found(
    fitted: &Estimate,
    replica: &Replica,
    (p, c): (&[f64], &[f64]),
    parameters: &[Physical],
) -> Estimate {
    let mut out = fitted.clone();
    out.p = p.to_vec();
    out.coefficients = c.to_vec();
    out.fitted.terms = replica.terms.clone();
    for found in parameters {
        let mut own = out.fitted.parameters.iter_mut();
        if let Some(own) = own.find(|own| own.name == found.name) {
            own.value = found.value;
        }
    }
    out
}
