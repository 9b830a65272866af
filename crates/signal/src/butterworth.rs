//! Butterworth designs by the bilinear transform.

use crate::sos::{Section, Sos};
use crate::{SignalError, check};
use core::f64::consts::PI;

/// Least distance of the cut-off from 0 and from the Nyquist frequency, as a fraction of the latter.
/// Closer to them the rounding of the coefficients moves the poles by more than 1e-7 of their distance
/// from the unit circle.
const MIN_CUTOFF_MARGIN: f64 = 1e-5;

impl Sos {
    /// Butterworth low-pass filter of `order` 1 to 8 for signals sampled at `rate` Hz, with a gain
    /// of 1 at rest and of sqrt(1/2) at `cutoff` Hz. Forward and backward, the gain at the cut-off
    /// is 1/2.
    ///
    /// The sections are those of `scipy.signal.butter(order, cutoff, fs=rate, output="sos")`.
    /// Their common gain is taken from the rounded coefficients, so that a constant passes
    /// unchanged however low the cut-off.
    ///
    /// ```
    /// let filter = stiction_signal::Sos::butterworth_low_pass(4, 100.0, 1000.0)?;
    /// assert!((filter.gain(0.0) - 1.0).abs() < 1e-14);
    /// assert!((filter.gain(100.0 / 1000.0) - 0.5f64.sqrt()).abs() < 1e-14);
    /// # Ok::<(), stiction_signal::SignalError>(())
    /// ```
    ///
    /// # Errors
    /// If the order is not 1 to 8, the rate not positive, or the cut-off not between 1e-5 and
    /// 1 - 1e-5 of half the rate.
    pub fn butterworth_low_pass(order: usize, cutoff: f64, rate: f64) -> Result<Self, SignalError> {
        design(order, cutoff, rate, Zeros::AtNyquist)
    }

    /// Butterworth high-pass filter: gain 0 at rest, sqrt(1/2) at `cutoff` Hz and 1 at half the
    /// `rate`. Otherwise like [`Sos::butterworth_low_pass`].
    ///
    /// # Errors
    /// As for the low-pass filter.
    pub fn butterworth_high_pass(
        order: usize,
        cutoff: f64,
        rate: f64,
    ) -> Result<Self, SignalError> {
        design(order, cutoff, rate, Zeros::AtRest)
    }
}

/// Where all zeros of the filter lie: at z = -1 (low-pass) or z = 1 (high-pass).
#[derive(Clone, Copy)]
enum Zeros {
    AtNyquist,
    AtRest,
}

impl Zeros {
    /// z of the zeros.
    fn place(self) -> f64 {
        match self {
            Zeros::AtNyquist => -1.0,
            Zeros::AtRest => 1.0,
        }
    }
}

/// Rounds a limit to seven significant digits, as many as the margin needs, so that the limit in an error message is
/// exactly the limit that is allowed.
fn rounded(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}

fn design(order: usize, cutoff: f64, rate: f64, zeros: Zeros) -> Result<Sos, SignalError> {
    if !(1..=8).contains(&order) {
        return Err(SignalError::Parameter {
            parameter: "filter order",
            found: order as f64,
            allowed: "1 to 8".into(),
        });
    }
    check::positive("sample rate in Hz", rate)?;
    let nyquist = 0.5 * rate;
    let (lowest, highest) = (
        rounded(MIN_CUTOFF_MARGIN * nyquist),
        rounded((1.0 - MIN_CUTOFF_MARGIN) * nyquist),
    );
    if !(lowest..=highest).contains(&cutoff) {
        return Err(SignalError::Parameter {
            parameter: "cut-off frequency in Hz",
            found: cutoff,
            allowed: format!("from {lowest} to {highest}, below half the sample rate"),
        });
    }
    // The analogue prototype, its cut-off warped so that the bilinear transform lands on `cutoff`.
    let warped = libm::tan(PI * (cutoff / rate));
    let mut denominators = Vec::with_capacity(order.div_ceil(2));
    if order % 2 == 1 {
        denominators.push([(warped - 1.0) / (warped + 1.0), 0.0]);
    }
    for pair in 0..order / 2 {
        // Angle of the pole from the negative real axis, growing with the pole's radius: the
        // sections come in the order of scipy, the sharpest resonance last.
        let steps = (2 * pair + 1 + order % 2) as f64;
        let damping = 2.0 * warped * libm::cos(PI * steps / (2 * order) as f64);
        let square = warped * warped;
        let scale = 1.0 + damping + square;
        denominators.push([
            2.0 * (square - 1.0) / scale,
            (1.0 - damping + square) / scale,
        ]);
    }
    Sos::new(with_numerators(&denominators, order, zeros))
}

/// Adds the numerators, with the gain of the whole filter in the first section.
fn with_numerators(denominators: &[[f64; 2]], order: usize, zeros: Zeros) -> Vec<Section> {
    let place = zeros.place();
    let double = [1.0, -2.0 * place, 1.0];
    let single = [1.0, -place, 0.0];
    let mut sections: Vec<Section> = denominators
        .iter()
        .map(|&a| Section { b: double, a })
        .collect();
    if order % 2 == 1 {
        // An odd order has one zero at the origin to place. scipy gives each section, the sharpest
        // first, the zeros nearest to its pole; the first-order section gets what is left.
        let nearest_is_origin = |s: &Section| {
            let (real, radius_squared) = (-0.5 * s.a[0], s.a[1]);
            radius_squared < radius_squared - 2.0 * real * place + 1.0
        };
        let sharpest = sections.iter().skip(1).rposition(nearest_is_origin);
        sections[sharpest.map_or(0, |index| index + 1)].b = single;
    }
    // Gain 1 at the end of the band opposite to the zeros: at z = 1 for a low-pass, z = -1 for a high-pass filter.
    let gain: f64 = sections
        .iter()
        .map(|s| (1.0 - place * s.a[0] + s.a[1]) / (s.b[0] - place * s.b[1] + s.b[2]))
        .product();
    sections[0].b = sections[0].b.map(|b| b * gain);
    sections
}
