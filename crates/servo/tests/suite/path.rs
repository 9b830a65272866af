//! Reference motions: derivatives, rest at the joints, stated amplitudes; and the encoder.

use proptest::prelude::*;
use stiction_servo::encoder::Encoder;
use stiction_servo::path::{Path, Sine};

proptest! {
    /// Velocity and acceleration are the derivatives of the position, at any instant.
    #[test]
    fn derivatives_match_differences(t in 0.01..2.99, speed in 0.001..1.0) {
        let path = Path::three_segments(speed, 3.0).unwrap();
        let d = 1e-5;
        let (a, b, c) = (path.at(t - d), path.at(t), path.at(t + d));
        let velocity = (c.position - a.position) / (2.0 * d);
        let acceleration = (c.velocity - a.velocity) / (2.0 * d);
        // Largest jerk: 28 Hz at .128 of the speed.
        prop_assert!((velocity - b.velocity).abs() < 1e-6 * speed + 1e-9);
        prop_assert!((acceleration - b.acceleration).abs() < 1e-3 * speed * 28.0);
    }
}

#[test]
fn segments_start_and_end_at_rest_at_the_origin() {
    let path = Path::three_segments(0.196, 3.0).unwrap();
    assert_eq!(path.duration(), 3.0);
    for t in [0.0, 1.0, 2.0, 3.0, -1.0, 9.0] {
        let r = path.at(t);
        assert!(
            r.position.abs() < 1e-15 && r.velocity.abs() < 1e-12 && r.acceleration.abs() < 1e-9,
            "{t}: {r:?}"
        );
    }
}

#[test]
fn amplitudes_are_the_stated_ones_and_never_exceeded() {
    for duration in [3.0, 9.0, 31.0] {
        let each = duration / 3.0;
        let path = Path::three_segments(0.196, duration).unwrap();
        for (part, speed) in [(0.0, 0.196), (1.0, 3.7e-3), (2.0, 25e-3)] {
            let fastest = (0..20_000)
                .map(|i| {
                    path.at(each * (part + f64::from(i) / 20_000.0))
                        .velocity
                        .abs()
                })
                .fold(0.0, f64::max);
            assert!(
                (fastest / speed - 1.0).abs() < 0.01,
                "{duration}: {fastest} {speed}"
            );
        }
    }
}

#[test]
fn settings_out_of_range_are_named() {
    let good = Sine {
        speed: 0.1,
        frequency: 1.0,
        duration: 1.0,
        fade: 0.1,
    };
    let name = |s: Sine| Path::new(vec![good, s]).unwrap_err().name;
    assert_eq!(
        name(Sine {
            speed: -0.1,
            ..good
        }),
        "speed"
    );
    assert_eq!(
        name(Sine {
            frequency: 0.0,
            ..good
        }),
        "frequency"
    );
    assert_eq!(
        name(Sine {
            duration: f64::NAN,
            ..good
        }),
        "duration"
    );
    assert_eq!(name(Sine { fade: 0.6, ..good }), "fade");
    assert_eq!(Path::new(vec![]).unwrap_err().name, "segments");
    assert!(Path::sine(0.1, 0.0, 1.0).is_err());
}

#[test]
fn encoder_reads_the_nearest_count() {
    let encoder = Encoder::new(50e-9).unwrap();
    for (truth, counts) in [
        (0.0, 0.0),
        (24e-9, 0.0),
        (26e-9, 1.0),
        (-26e-9, -1.0),
        (1.0, 2e7),
    ] {
        assert_eq!(encoder.read(truth), counts * 50e-9);
    }
    assert_eq!(Encoder::new(0.0).unwrap().read(0.123), 0.123);
    assert_eq!(Encoder::new(-1.0).unwrap_err().name, "resolution");
}
