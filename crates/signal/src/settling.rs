//! The settling time of a filter.

use crate::cascade::{Cascade, for_each_length};
use crate::sos::Sos;

/// Fraction of the absolute sum of the impulse response that may come after the settling time.
const SETTLED_WITHIN: f64 = 1e-3;

/// Logarithm of the envelope r^n, per section to allow for repeated poles, at which the impulse response has ended: 1e-9.
const ENVELOPE_LOGARITHM: f64 = -21.0;
/// Longest impulse response that is computed, in samples.
const MAX_SAMPLES: usize = 1 << 26;

impl Sos {
    /// Samples at each end that the unknown signal beyond the end can affect.
    ///
    /// It is the least n such that the impulse response h has at most 1e-3 of its absolute sum
    /// |h| after sample n. Changing the signal beyond an end by at most d then changes the causal
    /// output at depth n by at most 1e-3 d |h|, and the zero-phase output by at most 1e-3 d |h|^2;
    /// |h| is 1.0 to 2.1 for Butterworth low-pass filters up to half the Nyquist frequency.
    /// Identification leaves out this many samples at each end. At most 2^26.
    pub fn settling_samples(&self) -> usize {
        let radius = self
            .sections()
            .iter()
            .map(|s| s.pole_radius())
            .fold(0.0, f64::max);
        let factor = ENVELOPE_LOGARITHM * self.sections().len() as f64;
        let end = if radius > 0.0 {
            factor / libm::log(radius)
        } else {
            2.0
        };
        let end = (end.ceil() as usize).clamp(2 * self.sections().len() + 1, MAX_SAMPLES);
        let total: f64 = self.impulse_response(end).map(f64::abs).sum();
        let mut left = total;
        self.impulse_response(end)
            .position(|h| {
                left -= h.abs();
                left <= SETTLED_WITHIN * total
            })
            .map_or(end, |index| index + 1)
    }

    /// First `length` samples of the impulse response.
    fn impulse_response(&self, length: usize) -> Box<dyn Iterator<Item = f64>> {
        for_each_length!(self.sections(), |sections| {
            let mut cascade = Cascade::<_, 1>::new(sections);
            Box::new((0..length).map(move |n| cascade.step([if n == 0 { 1.0 } else { 0.0 }])[0]))
        })
    }
}
