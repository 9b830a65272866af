//! What the likelihood compares: the force that the axis felt, and what its encoder showed.

use crate::conditioning::record::{Record, Segment};
use crate::reaction::Logging;
use crate::state_space::filter::Stretch;
use crate::state_space::response::{Felt, Response, felt};
use std::ops::Range;
use stiction_policy::encoder;

/// Standard deviation of a reading beside its steps, counts: edges of real encoders are not exact.
const EDGE: f64 = 0.03;

/// The samples of a record under the force that its axis felt.
pub(super) struct Data {
    pub stretches: Vec<Stretch>,
    /// Standard deviation of the noise of the force sensor, N (N m), and of what the response misses at this delay.
    pub noise: f64,
    /// Encoder count, m or rad.
    pub count: f64,
}

impl Data {
    /// With a force that is logged `late` samples after it was held; `None` where the log has no counts.
    pub fn of(record: &Record, late: f64) -> Option<Self> {
        let count = record.resolution.filter(|count| *count > 0.0)?;
        let logging = Logging::new(late);
        let response = Response::of(record, logging);
        let steps = count * count / 12.0;
        let analogue = (record.position_noise * record.position_noise - steps).max(0.0);
        let beside = if analogue > steps { analogue } else { 0.0 };
        let edge = EDGE * EDGE * count * count + beside;
        let mut out = Vec::new();
        let (mut power, mut samples) = (0.0, 0_usize);
        for segment in &record.segments {
            if segment.reading.is_empty() {
                return None;
            }
            let Felt { force, noise } = felt(segment, logging, response.as_ref());
            let runs = runs(&segment.reading, count);
            let variance = |k: usize| match counts(segment, record.decimate, k) {
                true => steps * runs[k] + edge,
                false => f64::INFINITY,
            };
            for range in stretches(segment, record.decimate) {
                power += noise[range.clone()].iter().map(|x| x * x).sum::<f64>();
                samples += range.len();
                let first = segment.reading[range.start];
                let read = &segment.reading[range.clone()];
                out.push(Stretch {
                    force: force[range.clone()].to_vec(),
                    reading: read.iter().map(|x| x - first).collect(),
                    variance: range.clone().map(variance).collect(),
                    velocity: segment.velocity[range.start],
                });
            }
        }
        (samples > 0).then(|| Self {
            stretches: out,
            noise: (power / samples as f64).sqrt(),
            count,
        })
    }
}

/// Whether a sample of the full rate counts.
fn counts(segment: &Segment, decimate: usize, k: usize) -> bool {
    segment.valid.get(k) != Some(&false)
        && segment.at_rest.get(k) != Some(&true)
        && segment.keep.get(k / decimate) == Some(&true)
}

/// Ranges of samples without long gaps.
fn stretches(segment: &Segment, decimate: usize) -> Vec<Range<usize>> {
    let mut out: Vec<Range<usize>> = Vec::new();
    let n = segment.reading.len();
    for k in (0..n).filter(|&k| counts(segment, decimate, k)) {
        match out.last_mut() {
            Some(last) if k - last.end < encoder::MAX_MISSING_READINGS => last.end = k + 1,
            _ => out.push(k..k + 1),
        }
    }
    out.retain(|range| range.len() >= encoder::MIN_STRETCH);
    out
}

/// The number of equal steps in a row that each reading lies among: at rest the samples on one count, at whole counts in
/// a sample the beat between both. Their errors are the same, so that together they tell as much as one.
fn runs(reading: &[f64], count: f64) -> Vec<f64> {
    let steps: Vec<i64> = reading
        .windows(2)
        .map(|x| ((x[1] - x[0]) / count).round() as i64)
        .collect();
    let mut out = vec![1.0_f64; reading.len()];
    let mut at = 0;
    for run in steps.chunk_by(|a, b| a == b) {
        for own in &mut out[at..=at + run.len()] {
            *own = own.max(run.len() as f64);
        }
        at += run.len();
    }
    out
}
