//! Iterative learning control: the force that was missing in one pass is fed forward in the next.

use crate::axis::Sample;
use stiction_friction::ParamError;

/// Learning from pass to pass: `u <- Q[u + gain f(t + lead)]`, with f the force that feedback had to add in the last pass
/// and Q a zero-phase low-pass (Bristow, Tharayil, Alleyne 2006, doi 10.1109/MCS.2006.1636313).
///
/// Feedback supplies the missing force as far as the loop can follow; the rest comes in the next passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learning {
    /// Fraction of the missing force that is added per pass, 0 to 1.
    pub gain: f64,
    /// Samples by which feedback lags behind the force that was missing.
    pub lead: usize,
    /// Cut-off of the filter, > 0, Hz: where the loop no longer follows.
    pub cutoff: f64,
}

impl Learning {
    /// Refuses settings out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        if !(0.0..=1.0).contains(&self.gain) {
            return Err(ParamError::new("learning_gain", self.gain, "0 to 1"));
        }
        ParamError::positive("learning_cutoff", self.cutoff)
    }

    /// The force for the next pass, N (N m), from that of the last (empty: none yet) and the last pass itself, in which
    /// `mass` was fed forward (kg, kg m^2), one value a sample at `rate` Hz.
    pub fn learn(
        &self,
        force: &[f64],
        pass: &[Sample],
        mass: f64,
        rate: f64,
    ) -> Result<Vec<f64>, ParamError> {
        self.validate()?;
        ParamError::positive("rate", rate)?;
        let last = pass.len().saturating_sub(1);
        let feedback = |k: usize| {
            let s = &pass[k.min(last)];
            s.command - s.compensation - mass * s.reference.acceleration
        };
        let before = |k: usize| force.get(k).copied().unwrap_or(0.0);
        let mut next: Vec<f64> = (0..pass.len())
            .map(|k| before(k) + self.gain * feedback(k + self.lead))
            .collect();
        let weight = -libm::expm1(-2.0 * std::f64::consts::PI * self.cutoff / rate);
        lag(next.iter_mut(), weight);
        lag(next.iter_mut().rev(), weight);
        Ok(next)
    }
}

/// A lag of first order, in place.
fn lag<'a>(values: impl Iterator<Item = &'a mut f64>, weight: f64) {
    let mut state = None;
    for value in values {
        let old = state.unwrap_or(*value);
        let new = old + weight * (*value - old);
        *value = new;
        state = Some(new);
    }
}
