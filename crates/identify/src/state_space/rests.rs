//! Rests of an axis in a log.

use crate::conditioning::record::{Record, Segment};
use stiction_policy::encoder;
use stiction_signal::Travel;

/// Part of the samples of a record at which its axis rests, by its readings; 0 where the log has none. An axis whose encoder follows
/// it, by a count in each sample or more, is under way, however slow it is.
pub(crate) fn share(record: &Record) -> f64 {
    let slow =
        encoder::MAX_REST_SPEED * record.top_speed() * encoder::REST_WINDOW as f64 * record.step();
    let counts = encoder::REST_WINDOW as f64 * record.resolution.unwrap_or(0.0);
    let noise = Travel::shortest_movement(0.0, record.position_noise);
    let farthest = slow.min(counts.max(noise));
    let at_rest = |segment: &Segment| {
        let windows = segment.reading.windows(encoder::REST_WINDOW + 1);
        let moved = windows.map(|x| (x[encoder::REST_WINDOW] - x[0]).abs());
        moved.filter(|moved| *moved <= farthest).count()
    };
    let resting: usize = record.segments.iter().map(at_rest).sum();
    let samples: usize = record.segments.iter().map(|s| s.velocity.len()).sum();
    resting as f64 / samples.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::record::Samples;
    use crate::conditioning::{Conditioning, condition};

    fn shares(speed: impl Fn(f64) -> f64) -> f64 {
        let step = 1e-3;
        let mut x = 0.0;
        let position: Vec<f64> = (0..8000)
            .map(|k| {
                x += step * speed(k as f64 * step);
                libm::round(x / 1e-6) * 1e-6
            })
            .collect();
        let time: Vec<f64> = (0..position.len()).map(|k| k as f64 * step).collect();
        let samples = Samples {
            force: time.iter().map(|t| speed(*t).signum()).collect(),
            time,
            position: Some(position),
            ..Samples::default()
        };
        let conditioning = Conditioning {
            resolution: Some(1e-6),
            ..Conditioning::default()
        };
        share(&condition(&[samples], &conditioning).unwrap())
    }

    #[test]
    fn dwells_are_rests_and_reversals_are_not() {
        let sine = |t: f64| 0.1 * libm::sin(6.0 * t);
        assert!(shares(sine) < 0.02);
        // One second in two.
        let dwells = |t: f64| if t % 2.0 < 1.0 { sine(t) } else { 0.0 };
        let found = shares(dwells);
        assert!((found - 0.5).abs() < 0.05, "{found}");
    }

    #[test]
    fn slow_motion_that_the_encoder_follows_is_no_rest() {
        // One second in two at a four-hundredth of the top speed, 1.2 counts in a sample.
        let slow = |t: f64| {
            if t % 2.0 < 1.0 {
                0.5 * libm::sin(6.3 * t)
            } else {
                1.2e-3
            }
        };
        let found = shares(slow);
        assert!(found < 0.02, "{found}");
    }
}
