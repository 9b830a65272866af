//! Digital filters as cascades of second-order sections.

use crate::{SignalError, cascade};

/// One second-order section,
/// `H(z) = (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Numerator `b0, b1, b2`.
    pub b: [f64; 3],
    /// Denominator `a1, a2`; the leading coefficient is 1.
    pub a: [f64; 2],
}

impl Section {
    /// Largest distance of a pole from the origin; below 1 for a stable section.
    pub(crate) fn pole_radius(&self) -> f64 {
        let [a1, a2] = self.a;
        let discriminant = a1 * a1 - 4.0 * a2;
        if discriminant < 0.0 {
            a2.sqrt()
        } else {
            0.5 * (a1.abs() + discriminant.sqrt())
        }
    }

    /// State `s0, s1` of the transposed direct form II at rest under a constant input of 1, by the
    /// recurrence of `scipy.signal.lfilter_zi`.
    fn settled(&self) -> [f64; 2] {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        let first = b1 - a1 * b0;
        let s0 = (first + (b2 - a2 * b0)) / (1.0 + a1 + a2);
        [s0, (1.0 + a1) * s0 - first]
    }
}

/// A stable filter of one to four second-order sections, applied in order.
///
/// Made by a design such as [`Sos::butterworth_low_pass`] or from given coefficients by
/// [`Sos::new`]. Used forward and backward by [`Sos::zero_phase`], which neither delays nor
/// advances the signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Sos {
    sections: Vec<Section>,
}

/// Most sections of a filter: order 8.
pub(crate) const MAX_SECTIONS: usize = 4;

impl Sos {
    /// A filter from its sections.
    ///
    /// # Errors
    /// If there are none or more than four, or if one is not finite or not stable.
    pub fn new(sections: Vec<Section>) -> Result<Self, SignalError> {
        if !(1..=MAX_SECTIONS).contains(&sections.len()) {
            return Err(SignalError::Parameter {
                parameter: "number of sections",
                found: sections.len() as f64,
                allowed: format!("1 to {MAX_SECTIONS}"),
            });
        }
        for section in &sections {
            let mut coefficients = section.b.iter().chain(&section.a);
            if let Some(&found) = coefficients.find(|value| !value.is_finite()) {
                let allowed = "finite".into();
                return Err(SignalError::Parameter {
                    parameter: "section coefficient",
                    found,
                    allowed,
                });
            }
            let [a1, a2] = section.a;
            // The stability triangle.
            if !(a2 < 1.0 && a1.abs() < 1.0 + a2) {
                return Err(SignalError::Parameter {
                    parameter: "pole radius of a section",
                    found: section.pole_radius(),
                    allowed: "below 1 (stable)".into(),
                });
            }
        }
        Ok(Self { sections })
    }

    /// The sections in the order in which they are applied.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// Magnitude of the response of one pass at `frequency`, in cycles per sample (0 to 0.5);
    /// multiply by the sample rate for Hz. A zero-phase filter has the square of it.
    pub fn gain(&self, frequency: f64) -> f64 {
        let half_angle = core::f64::consts::PI * frequency;
        let (sin, cos) = (libm::sin(half_angle), libm::cos(half_angle));
        // |c0 + c1 z^-1 + c2 z^-2| on the unit circle is |c0 z + c1 + c2 z^-1|. Near z = 1 the
        // terms of a slow filter cancel, near z = -1 those of a fast one: the sum at that point is
        // taken first, and is exact there.
        let modulus = |c0: f64, c1: f64, c2: f64| {
            let real = if sin < cos {
                (c0 + c1 + c2) - 2.0 * (c0 + c2) * sin * sin
            } else {
                2.0 * (c0 + c2) * cos * cos - (c0 - c1 + c2)
            };
            libm::hypot(real, 2.0 * (c0 - c2) * sin * cos)
        };
        let of = |s: &Section| modulus(s.b[0], s.b[1], s.b[2]) / modulus(1.0, s.a[0], s.a[1]);
        self.sections.iter().map(of).product()
    }

    /// States of all sections at rest under a constant input of 1, equal to
    /// `scipy.signal.sosfilt_zi`.
    pub fn settled_state(&self) -> Vec<[f64; 2]> {
        let mut level = 1.0;
        let settle = |section: &Section| {
            let state = section.settled().map(|s| s * level);
            level *= section.b.iter().sum::<f64>() / (1.0 + section.a[0] + section.a[1]);
            state
        };
        self.sections.iter().map(settle).collect()
    }

    /// Filters in place, causally and from rest, as `scipy.signal.sosfilt` does. This delays the
    /// signal: for identification use [`Sos::zero_phase`].
    pub fn filter(&self, signal: &mut [f64]) {
        cascade::filter(&self.sections, signal);
    }
}
