//! Samples whose force depends on the motion before the recording.

use crate::conditioning::record::{Record, Segment};
use stiction_policy::conditioning;

impl Record {
    /// The same record without the start of each stretch, until the position has once traversed its range
    /// (at most half of the stretch).
    ///
    /// What a Maxwell-slip element holds at the start of a recording is not known. It is wiped out by
    /// a motion over twice its yield deflection (Al-Bender, Lampaert and Swevers 2005, section II), so
    /// after that run elements up to half the range do not depend on it.
    #[must_use]
    pub fn settled(&self) -> Self {
        let mut out = self.clone();
        let mut lost = 0;
        for segment in &mut out.segments {
            let end = start(segment).div_ceil(self.decimate.max(1));
            for keep in segment.keep.iter_mut().take(end) {
                lost += usize::from(*keep);
                *keep = false;
            }
        }
        if lost > 0 {
            out.notes.push(format!(
                "{lost} samples at the start not fitted (until the position has run through its range, \
                 the force depends on what was before the recording)"
            ));
        }
        out
    }
}

/// The first sample at the full rate at which the position has traversed its range.
fn start(segment: &Segment) -> usize {
    run_through(&segment.velocity, segment.step)
}

/// How many samples at the start of a stretch of `velocity` (m/s, rad/s) in steps of `step` s the fit of a Maxwell-slip law leaves
/// out: until the position has once traversed its range, at most half of them.
pub fn run_through(velocity: &[f64], step: f64) -> usize {
    let mut at = 0.0_f64;
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    let ranges: Vec<f64> = velocity
        .windows(2)
        .map(|v| {
            at += 0.5 * (v[0] + v[1]) * step;
            low = low.min(at);
            high = high.max(at);
            high - low
        })
        .collect();
    let whole = conditioning::MIN_TRAVERSED_SHARE * (high - low);
    let most = (conditioning::MAX_TRAVERSING_SHARE * velocity.len() as f64) as usize;
    ranges
        .iter()
        .position(|&range| range >= whole)
        .map_or(0, |i| i + 1)
        .min(most)
}
