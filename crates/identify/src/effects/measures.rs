//! What a motion goes along, at the kept samples.

use crate::conditioning::record::{Record, Segment};

/// What is measured at the kept samples of a record.
pub(super) struct Measures {
    /// s; each log begins where the one before ended.
    pub time: Vec<f64>,
    /// m or rad.
    pub position: Vec<f64>,
    /// m/s or rad/s.
    pub speed: Vec<f64>,
    /// In the unit of the log; empty where a log has none.
    pub load: Vec<f64>,
    /// K; empty where a log has none.
    pub temperature: Vec<f64>,
}

impl Measures {
    pub fn of(record: &Record) -> Self {
        Self {
            time: times(record),
            position: record.pick(|s| &s.position),
            speed: record.pick(|s| &s.velocity),
            load: in_every_log(record, |s| &s.channels.load),
            temperature: in_every_log(record, |s| &s.channels.temperature),
        }
    }
}

/// A channel at the kept samples; empty where a log has none.
fn in_every_log(record: &Record, channel: impl Fn(&Segment) -> &[f64]) -> Vec<f64> {
    let missing = |s: &Segment| channel(s).len() != s.velocity.len();
    match record.segments.iter().any(missing) {
        true => Vec::new(),
        false => record.pick(channel),
    }
}

/// Times of the kept samples, s; each log begins where the one before ended.
fn times(record: &Record) -> Vec<f64> {
    let mut out = Vec::with_capacity(record.kept());
    let (mut shift, mut log, mut last) = (0.0, None, 0.0);
    for segment in &record.segments {
        let Some(&first) = segment.time.first() else {
            continue;
        };
        if log != Some(segment.log) {
            shift = last - first;
            log = Some(segment.log);
        }
        let kept = segment.time.iter().zip(&segment.keep);
        out.extend(kept.filter(|(_, keep)| **keep).map(|(t, _)| t + shift));
        last = segment.time.last().map_or(last, |t| t + shift);
    }
    out
}
