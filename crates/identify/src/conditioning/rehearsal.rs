//! A motion like that of a record, known exactly, and the same read by the encoder and conditioned.

use crate::conditioning::condition;
use crate::conditioning::record::{Record, Samples, Segment};
use stiction_signal::Sos;

/// Order of the low-pass that makes the motion smooth. Its cut-off is that of the common filter, half
/// that of the source filter by default: the noise of an encoder in a velocity grows with the cube of
/// the cut-off, so an eighth is left, and what the fit sees of the motion stays.
const ORDER: usize = 4;

impl Record {
    /// This record with its motion smoothed, and taken for exact: no encoder, no filter, no
    /// difference stands between it and its velocity and acceleration. The force is as it was.
    ///
    /// `None` where the motion does not come from a position with a known resolution.
    pub(crate) fn smoothed(&self) -> Option<Self> {
        self.conditioning?;
        self.resolution.filter(|q| *q > 0.0)?;
        let mut out = self.clone();
        for segment in &mut out.segments {
            let rate = 1.0 / segment.step;
            let cutoff = self.cutoff().unwrap_or(0.25 * rate);
            let low = Sos::butterworth_low_pass(ORDER, cutoff, rate).ok()?;
            segment.velocity = low.zero_phase(&segment.velocity).ok()?;
            let mut acceleration = derivative(&segment.velocity, segment.step);
            if let Some(common) = &self.common {
                acceleration = common.zero_phase(&acceleration).ok()?;
            }
            let thin = |x: &[f64]| x.iter().step_by(self.decimate).copied().collect::<Vec<_>>();
            segment.speed = thin(&segment.velocity);
            segment.acceleration = thin(&acceleration);
        }
        Some(out)
    }

    /// The motion of this record read by the encoder, its counts lying `phase` (0 to 1) counts beside
    /// zero, and conditioned as the log was; the force is as it was. `None` where the segments do not
    /// come out of the conditioning as they went in.
    pub(crate) fn read_again(&self, phase: f64) -> Option<Self> {
        let conditioning = self.conditioning?;
        let count = self.resolution.filter(|q| *q > 0.0)?;
        let mut out = self.clone();
        for segment in &mut out.segments {
            let position: Vec<f64> = integral(segment)
                .iter()
                .map(|x| count * (libm::floor(x / count + 0.5 + phase) - phase))
                .collect();
            let samples = Samples {
                time: (0..position.len())
                    .map(|i| i as f64 * segment.step)
                    .collect(),
                force: vec![0.0; position.len()],
                position: Some(position),
                ..Samples::default()
            };
            let mut again = condition(&[samples], &conditioning).ok()?.segments;
            let read = again.pop().filter(|_| again.is_empty())?;
            let same = read.velocity.len() == segment.velocity.len()
                && read.acceleration.len() == segment.acceleration.len();
            if !same {
                return None;
            }
            segment.velocity = read.velocity;
            segment.speed = read.speed;
            segment.acceleration = read.acceleration;
        }
        Some(out)
    }

    /// Cut-off of the last filter that the motion has passed, Hz.
    fn cutoff(&self) -> Option<f64> {
        let conditioning = self.conditioning?;
        [conditioning.common_cutoff, conditioning.source_cutoff]
            .into_iter()
            .find_map(|cutoff| match cutoff {
                super::Cutoff::Hz(f) => Some(f),
                _ => None,
            })
    }
}

/// Derivative of fourth order inside, of second at the ends (which the conditioning drops).
fn derivative(v: &[f64], h: f64) -> Vec<f64> {
    let last = v.len().saturating_sub(1);
    (0..v.len())
        .map(|i| {
            if i >= 2 && i + 2 <= last {
                (8.0 * (v[i + 1] - v[i - 1]) - (v[i + 2] - v[i - 2])) / (12.0 * h)
            } else {
                let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
                (v[b] - v[a]) / ((b - a).max(1) as f64 * h)
            }
        })
        .collect()
}

/// Position by integration of the velocity, m or rad from the start: the trapezoid rule with its end
/// correction, of fourth order, so that the velocity is its derivative.
fn integral(segment: &Segment) -> Vec<f64> {
    let (v, h) = (&segment.velocity, segment.step);
    let slope = derivative(v, h);
    let mut x = 0.0;
    let mut out = Vec::with_capacity(v.len());
    for i in 0..v.len() {
        if i > 0 {
            x += 0.5 * h * (v[i - 1] + v[i]) - h * h * (slope[i] - slope[i - 1]) / 12.0;
        }
        out.push(x);
    }
    out
}

#[cfg(test)]
mod tests {
    use crate::conditioning::record::Samples;
    use crate::conditioning::{Conditioning, Cutoff, condition};
    use std::f64::consts::TAU;

    /// A sine of 10 Hz at 4 kHz comes out of smoothing and reading as it went in, up to what filters
    /// and differences of second order do: (w h)^2/3 of the acceleration.
    #[test]
    fn a_slow_motion_comes_back() {
        let h = 1.0 / 4000.0;
        let w = TAU * 10.0;
        let time: Vec<f64> = (0..8000).map(|i| i as f64 * h).collect();
        let samples = Samples {
            position: Some(time.iter().map(|t| 1e-3 * (w * t).sin()).collect()),
            force: time.iter().map(|t| (w * t).cos()).collect(),
            time,
            ..Samples::default()
        };
        let filters = Conditioning {
            source_cutoff: Cutoff::Hz(400.0),
            common_cutoff: Cutoff::Hz(200.0),
            resolution: Some(1e-9),
            ..Conditioning::default()
        };
        let record = condition(&[samples], &filters).unwrap();
        let smooth = record.smoothed().unwrap();
        let again = smooth.read_again(0.3).unwrap();
        let size = 1e-3 * w * w;
        let s = &smooth.segments[0];
        for (i, keep) in s.keep.iter().enumerate() {
            if !keep || s.time[i] < 0.1 || s.time[i] > 1.9 {
                continue;
            }
            let truth = -size * (w * s.time[i]).sin();
            assert!((s.acceleration[i] - truth).abs() < 3e-4 * size);
            let read = again.segments[0].acceleration[i];
            let lost = truth * (w * h) * (w * h) / 3.0;
            assert!((read - s.acceleration[i] + lost).abs() < 1e-4 * size);
        }
        assert_eq!(again.segments[0].force, record.segments[0].force);
    }

    #[test]
    fn a_logged_velocity_is_not_read_again() {
        let samples = Samples {
            time: (0..100).map(|i| f64::from(i) * 1e-3).collect(),
            velocity: Some(vec![1.0; 100]),
            force: vec![1.0; 100],
            ..Samples::default()
        };
        let record = condition(&[samples], &Conditioning::default()).unwrap();
        assert!(record.smoothed().is_none());
    }
}
