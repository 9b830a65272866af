//! The force of a known controller that acts a while after the controller asked for it.

use crate::output_error::drawn::{Place, places};
use crate::output_error::unknowns::MOST;

/// The forces asked for lately, each held for a control period, as they act on the axis a dead time later. What was asked
/// for before the first instant is not known; it is taken to be what was asked for then.
pub(crate) struct Late {
    steps: Vec<Place>,
    /// Plant steps in one second.
    rate: f64,
    /// A ring of forces with their derivatives, and the place of the newest.
    asked: Vec<(f64, [f64; MOST])>,
    newest: Option<usize>,
}

impl Late {
    /// With the delay of the logged force in seconds: 0, or negative where the force acts after it was logged.
    pub fn new(delay: f64, period: f64, substeps: usize) -> Self {
        let steps = places(substeps, (delay / period).min(0.0));
        let first = steps.first().map_or(0, |place| place.begins[0]);
        Self {
            steps,
            rate: substeps as f64 / period,
            asked: vec![(0.0, [0.0; MOST]); 1 + first.unsigned_abs()],
            newest: None,
        }
    }

    /// Takes in the force of the next control instant, with its derivatives.
    #[inline]
    pub fn ask(&mut self, force: f64, slopes: &[f64; MOST]) {
        match self.newest {
            None => {
                self.asked.fill((force, *slopes));
                self.newest = Some(0);
            }
            Some(last) => {
                let next = if last + 1 == self.asked.len() {
                    0
                } else {
                    last + 1
                };
                self.asked[next] = (force, *slopes);
                self.newest = Some(next);
            }
        }
    }

    /// What was asked for `by` instants from the newest; nothing later is known.
    #[inline]
    fn row(&self, by: isize) -> &(f64, [f64; MOST]) {
        let n = self.asked.len();
        let back = (-by).clamp(0, n as isize - 1) as usize;
        let newest = self.newest.unwrap_or(0);
        let at = if newest >= back {
            newest - back
        } else {
            newest + n - back
        };
        &self.asked[at]
    }

    /// The mean force over plant step `j` of the control period.
    #[inline]
    pub fn at(&self, j: usize) -> f64 {
        let place = &self.steps[j];
        let here = self.row(place.row).0;
        if place.share == 1.0 {
            return here;
        }
        place.share * here + (1.0 - place.share) * self.row(place.row + 1).0
    }

    /// Its derivatives. `own` is the place of the delay among the unknowns; where a held force begins with a step, the
    /// derivative jumps, and the side is that of a longer dead time.
    #[inline]
    pub fn slopes(&self, j: usize, own: Option<usize>, out: &mut [f64]) {
        let place = &self.steps[j];
        let here = &self.row(place.row).1;
        if place.share == 1.0 {
            out.copy_from_slice(&here[..out.len()]);
        } else {
            let next = &self.row(place.row + 1).1;
            for ((out, a), b) in out.iter_mut().zip(here).zip(next) {
                *out = place.share * a + (1.0 - place.share) * b;
            }
        }
        if let Some(own) = own {
            out[own] += self.rate * (self.row(place.ends[0]).0 - self.row(place.begins[0]).0);
        }
    }
}
