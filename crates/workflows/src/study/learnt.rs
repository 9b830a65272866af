//! When a watchdog has learnt what is normal.

use stiction_files::study::Scheme;
use stiction_servo::axis::Sample;

/// When a watchdog has learnt what is normal and the force has come in, s; infinite where the motion is too short,
/// `None` without a watchdog.
pub(super) fn learnt(scheme: &Scheme, samples: &[Sample], rate: f64) -> Option<f64> {
    let Scheme::Model(model) = scheme else {
        return None;
    };
    let window = model.watchdog.as_ref()?.window;
    // Its windows: moving time from a turn of the reference to one of the same sense, ten times as long without turns.
    let (mut time, mut turns, mut forward) = (0.0, 0, false);
    for s in samples.iter().filter(|s| s.reference.velocity != 0.0) {
        let now = s.reference.velocity > 0.0;
        let turned = now != forward && time > 0.0;
        forward = now;
        if turned {
            turns += 1;
            if turns == 1 {
                time = 0.0;
            }
        }
        time += 1.0 / rate;
        let whole = turned && turns >= 3 && turns % 2 == 1;
        if whole && time >= window || time >= 10.0 * window {
            return Some(s.time + model.ramp);
        }
    }
    Some(f64::INFINITY)
}
