//! Pieces: position, velocity, acceleration and jerk belong together, and every piece begins and ends at rest.

use proptest::prelude::*;
use stiction_plan::{Atom, Motion};

fn atoms() -> impl Strategy<Value = Atom> {
    let sine = (-6.0..-1.0_f64, 0.3..30.0_f64, 0.2..3.0_f64, 0.05..0.9_f64).prop_map(
        |(size, frequency, duration, fade)| Atom::Sine {
            amplitude: libm::exp10(size),
            frequency,
            duration,
            fade_in: fade * duration,
            fade_out: 0.999 * (1.0 - fade) * duration,
        },
    );
    let there = (
        -4.0..-0.5_f64,
        any::<bool>(),
        -3.0..0.0_f64,
        -1.0..1.5_f64,
        1.0..4.0_f64,
    )
        .prop_map(|(size, back, speed, acceleration, jerk)| Atom::Move {
            distance: if back { -1.0 } else { 1.0 } * libm::exp10(size),
            speed: libm::exp10(speed),
            acceleration: libm::exp10(acceleration),
            jerk: libm::exp10(jerk),
        });
    prop_oneof![sine, there]
}

proptest! {
    /// The differences of each over a short time are the mean of the next; where the jerk steps in between, the
    /// acceleration still does not jump.
    #[test]
    fn derivatives_belong_together(atom in atoms(), at in 0.001..0.999_f64) {
        let h = 1e-6 * atom.duration();
        let t = at * atom.duration();
        let (a, b) = (atom.at(t - h), atom.at(t + h));
        let bounds = atom.extremes();
        let near = |difference: f64, mean: f64, scale: f64| (difference - mean).abs() <= 2e-5 * scale;
        prop_assert!(near((b.position - a.position) / (2.0 * h), 0.5 * (a.velocity + b.velocity), bounds.speed));
        prop_assert!(near((b.velocity - a.velocity) / (2.0 * h), 0.5 * (a.acceleration + b.acceleration), bounds.acceleration));
        prop_assert!((b.acceleration - a.acceleration).abs() <= 2.0 * h * bounds.jerk * (1.0 + 1e-6) + 1e-9 * bounds.acceleration);
    }

    /// A motion is where it began, at rest, between two pieces and after the last.
    #[test]
    fn pieces_join_at_rest(first in atoms(), second in atoms()) {
        let motion = Motion::new(vec![first, second]).unwrap();
        for t in [0.0, first.duration(), motion.duration(), motion.duration() + 1.0] {
            let at = motion.at(t);
            let bounds = motion.extremes();
            let size = bounds.position[1].max(-bounds.position[0]);
            prop_assert!(at.position.abs() <= 1e-12 * size, "{at:?}");
            prop_assert!(at.velocity.abs() <= 1e-9 * bounds.speed, "{at:?}");
            prop_assert!(at.acceleration.abs() <= 1e-9 * bounds.acceleration, "{at:?}");
        }
    }
}
