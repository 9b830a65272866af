//! Whether a measured acceleration says more than the second derivative of the position.
//!
//! Both pass the filters of the record, and are compared where samples count:
//!
//! ```text
//! measured(t + lag) - offset = gain a(t) + noise_m,     derivative(t) = a(t) + noise_d
//! ```
//!
//! The noise of the derivative follows from that of the position and from what the filters and derivatives make of white
//! noise; that of the measured one is what is left of the variance of the difference. So whatever else an accelerometer
//! shows, vibration or a tilt that changes, counts against it.

use crate::conditioning::record::Record;
use crate::conditioning::shift::Shift;
use crate::conditioning::{Cutoff, ORDER};
use stiction_policy::conditioning;
use stiction_signal::{Sos, gradient, gradient_sixth_order};

/// Largest lag of the measured acceleration that is looked for, either way, in samples: a sensor of its own with a filter.
const MOST_LAG: i32 = 20;
/// Samples of the impulse whose energy is the gain of white noise, in settling times of the filters.
const IMPULSE_SETTLINGS: usize = 4;

/// What a measured acceleration is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerometer {
    /// Whether it is the better one, and was taken.
    pub taken: bool,
    /// Standard deviation of its noise after the filters, m/s^2 or rad/s^2.
    pub noise: f64,
    /// The same of the derivative of the position.
    pub derivative_noise: f64,
    /// How much later it shows the motion than the position does, s.
    pub lag: f64,
    /// What it shows for an acceleration of 1, dimensionless.
    pub gain: f64,
    /// What it shows without acceleration, m/s^2 or rad/s^2.
    pub offset: f64,
}

/// A comparison at one lag.
#[derive(Clone, Copy)]
struct Compared {
    gain: f64,
    offset: f64,
    /// Variance of measured over gain less derivative.
    apart: f64,
}

impl Record {
    /// The record with the measured acceleration in the place of the derivative, where that is the better one, and what both
    /// are worth. `None` where there is none to compare: no such channel in one of the logs, or a motion that was logged as a
    /// velocity; and of one that does not show the motion at all.
    pub fn with_accelerometer(&self) -> Option<(Self, Accelerometer)> {
        let again = self.conditioning.as_ref()?;
        let n = self.kept();
        if n < 4 * MOST_LAG as usize {
            return None;
        }
        let mut pairs = Vec::new();
        for segment in &self.segments {
            let measured = &segment.channels.acceleration;
            if measured.len() != segment.acceleration.len() {
                return None;
            }
            let mut columns = [measured.clone(), segment.acceleration.clone()];
            self.filter(&mut columns);
            pairs.push(columns);
        }
        let hz = |cutoff| match cutoff {
            Cutoff::Hz(f) => Some(f),
            Cutoff::Auto | Cutoff::Off => None,
        };
        let derivative_noise = self.position_noise * self.gain_of_noise(hz(again.source_cutoff))?;
        let compared = |samples: f64| self.compared(&pairs, samples, derivative_noise);
        let all: Vec<(i32, Compared)> = (-MOST_LAG..=MOST_LAG)
            .filter_map(|lag| Some((lag, compared(f64::from(lag))?)))
            .collect();
        let (best, at) = all
            .iter()
            .min_by(|a, b| a.1.apart.total_cmp(&b.1.apart))
            .copied()?;
        let near = |lag: i32| all.iter().find(|(l, _)| *l == lag).map(|(_, c)| c.apart);
        let part = match (near(best - 1), near(best + 1)) {
            (Some(before), Some(after)) => vertex(before, at.apart, after),
            _ => 0.0,
        };
        let lag = f64::from(best) + part;
        let found = compared(lag).unwrap_or(at);
        if !conditioning::ACCELEROMETER_GAIN.contains(&found.gain) {
            return None;
        }
        let noise = (found.apart - derivative_noise * derivative_noise)
            .max(0.0)
            .sqrt();
        let is_it = (found.gain - 1.0).abs() <= conditioning::MAX_ACCELEROMETER_GAIN_ERROR
            && best.abs() < MOST_LAG;
        let taken = is_it && noise < derivative_noise;
        let mut out = self.clone();
        if taken {
            let shift = Shift::earlier(-lag);
            for segment in &mut out.segments {
                let measured = &segment.channels.acceleration;
                let at = |i| (shift.at(measured, i) - found.offset) / found.gain;
                segment.acceleration = (0..measured.len()).map(at).collect();
            }
        }
        let accelerometer = Accelerometer {
            taken,
            noise,
            derivative_noise,
            lag: lag * self.step(),
            gain: found.gain,
            offset: found.offset,
        };
        Some((out, accelerometer))
    }

    /// Regression of the measured acceleration, so many samples later, on the derivative, whose noise is known; `None` where
    /// the derivative is noise alone.
    fn compared(&self, pairs: &[[Vec<f64>; 2]], lag: f64, noise: f64) -> Option<Compared> {
        let shift = Shift::earlier(-lag);
        let (mut n, mut sums) = (0.0, [0.0; 5]);
        for (segment, [measured, derivative]) in self.segments.iter().zip(pairs) {
            let kept = segment.keep.iter().enumerate().filter(|(_, keep)| **keep);
            for (k, _) in kept {
                let at = k * self.decimate;
                let (m, d) = (shift.at(measured, at), derivative[at]);
                n += 1.0;
                for (sum, x) in sums.iter_mut().zip([m, d, m * m, d * d, m * d]) {
                    *sum += x;
                }
            }
        }
        let [m, d, mm, dd, md] = sums.map(|x| x / n);
        let (mm, dd, md) = (mm - m * m, dd - d * d, md - m * d);
        // Noise of what it is compared with would make the gain too small.
        let true_variance = dd - noise * noise;
        if true_variance <= 0.0 {
            return None;
        }
        let gain = md / true_variance;
        let apart = mm / (gain * gain) + dd - 2.0 * md / gain;
        let found = Compared {
            gain,
            offset: m - gain * d,
            apart: apart.max(0.0),
        };
        (gain.is_finite() && gain != 0.0 && apart.is_finite()).then_some(found)
    }

    /// The standard deviation, in 1/s^2, that a white noise of 1 of the position has as an acceleration after all filters.
    fn gain_of_noise(&self, source_hz: Option<f64>) -> Option<f64> {
        let step = self.step();
        let source = match source_hz {
            Some(f) => Some(Sos::butterworth_low_pass(ORDER, f, 1.0 / step).ok()?),
            None => None,
        };
        let filters = || [&source, &self.common].into_iter().flatten();
        let settling = filters().map(Sos::settling_samples).max().unwrap_or(0);
        let middle = IMPULSE_SETTLINGS * settling.max(64);
        let mut impulse = vec![0.0; 2 * middle + 1];
        impulse[middle] = 1.0;
        let derivative = |x: &[f64]| match source {
            Some(_) => gradient_sixth_order(x, step).ok(),
            None => gradient(x, step).ok(),
        };
        if let Some(filter) = &source {
            filter.zero_phase_in_place(&mut impulse).ok()?;
        }
        let mut acceleration = derivative(&derivative(&impulse)?)?;
        if let Some(filter) = &self.common {
            filter.zero_phase_in_place(&mut acceleration).ok()?;
        }
        Some(acceleration.iter().map(|a| a * a).sum::<f64>().sqrt())
    }
}

/// Where a parabola through three values at -1, 0, 1 is least, the middle one being the least of them.
fn vertex(before: f64, here: f64, after: f64) -> f64 {
    let bend = before - 2.0 * here + after;
    match bend > 0.0 {
        true => (0.5 * (before - after) / bend).clamp(-0.5, 0.5),
        false => 0.0,
    }
}
