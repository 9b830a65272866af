//! Metrics of motions whose errors are known in closed form.

use stiction_servo::axis::Sample;
use stiction_servo::metrics::{
    Contour, Tracking, circular_deviation, reversals, ripple_at_constant_velocity, velocity_ripple,
};
use stiction_servo::motion::{Limits, Moves};
use stiction_servo::path::Reference;
use stiction_servo::trajectory::Trajectory;
use stiction_servo::two_axes::PlaneSample;

/// A reference sin(2 pi t), sampled at 1 kHz for 2 s, followed with an error `off(t)` and a velocity `v(t)`.
fn samples(off: impl Fn(f64) -> f64, v: impl Fn(f64) -> f64) -> Vec<Sample> {
    let omega = 2.0 * std::f64::consts::PI;
    (0..2000)
        .map(|k| {
            let t = f64::from(k) * 1e-3;
            let reference = Reference {
                position: libm::sin(omega * t),
                velocity: omega * libm::cos(omega * t),
                acceleration: 0.0,
            };
            Sample {
                time: t,
                reference,
                position: reference.position - off(t),
                velocity: v(t),
                command: if k % 2 == 0 { 3.0 } else { 5.0 },
                ..Sample::default()
            }
        })
        .collect()
}

#[test]
fn rms_peak_and_command_change() {
    let all = samples(
        |t| 2e-6 * libm::sin(20.0 * std::f64::consts::PI * t),
        |_| 1.0,
    );
    let t = Tracking::of(&all);
    assert!((t.rms - 2e-6 / 2f64.sqrt()).abs() < 1e-12);
    assert!((t.peak - 2e-6).abs() < 1e-12);
    assert!((t.command_change - 2.0).abs() < 1e-12);
    assert_eq!(Tracking::of(&[]), Tracking::default());
}

#[test]
fn reversals_and_what_stands_about_them() {
    // Reversals at .25, .75, 1.25 and 1.75 s: .125 s to either side count.
    let all = samples(
        |t| {
            if (0.45..0.55).contains(&t) {
                9e-6
            } else {
                1e-6
            }
        },
        |_| 1.0,
    );
    let at = reversals(&all);
    assert_eq!(at.len(), 4);
    for (got, expected) in at.iter().zip([0.25, 0.75, 1.25, 1.75]) {
        assert!((got - expected).abs() < 1.1e-3);
    }
    assert!((Tracking::of(&all).reversal_peak - 1e-6).abs() < 1e-12);
    let late = samples(|t| if t > 1.3 && t < 1.32 { 5e-6 } else { 0.0 }, |_| 1.0);
    assert!((Tracking::of(&late).reversal_peak - 5e-6).abs() < 1e-12);
    // A single reversal, at 1.25 s of 1 to 1.5 s: a quarter of the ways to either side, which are .25 s long.
    let single = |from: f64, to: f64| {
        let off = samples(|t| if t > from && t < to { 5e-6 } else { 0.0 }, |_| 1.0);
        Tracking::of(&off[1000..1500]).reversal_peak
    };
    for inside in [(1.3, 1.32), (1.19, 1.2)] {
        assert!((single(inside.0, inside.1) - 5e-6).abs() < 1e-12);
    }
    for outside in [(1.32, 1.5), (1.0, 1.18)] {
        assert!(single(outside.0, outside.1) < 1e-12);
    }
}

/// There, a rest, and back: a spike 55 ms after the turn belongs to it, what is left of the first move to settle in the
/// rest before it does not.
#[test]
fn a_reversal_after_a_rest() {
    let limits = Limits {
        velocity: 0.05,
        acceleration: 1.0,
        jerk: 50.0,
    };
    let moves = Moves::there_and_back(0.02, 0.5, limits).unwrap();
    let turn = 0.5 * moves.duration();
    let off = |from: f64, to: f64| {
        let samples: Vec<Sample> = (0..=(moves.duration() * 1e3) as usize)
            .map(|k| {
                let time = k as f64 * 1e-3;
                let reference = moves.at(time);
                let late = (turn + from..turn + to).contains(&time);
                Sample {
                    time,
                    reference,
                    position: reference.position - if late { 5e-6 } else { 0.0 },
                    ..Sample::default()
                }
            })
            .collect();
        Tracking::of(&samples).reversal_peak
    };
    assert!((off(0.05, 0.06) - 5e-6).abs() < 1e-12);
    assert!((off(-0.015, 0.0) - 5e-6).abs() < 1e-12);
    assert!(off(-0.5, -0.03) < 1e-12 && off(0.2, 0.5) < 1e-12);
}

#[test]
fn stick_time_is_the_standstill_about_a_reversal() {
    let stands = |t: f64| (0.24..0.29).contains(&t) || (0.5..0.7).contains(&t);
    let all = samples(|_| 0.0, |t| if stands(t) { 0.0 } else { 1.0 });
    let stick = Tracking::of(&all).stick_time;
    assert!((stick - 0.049).abs() < 1.5e-3, "{stick}");
}

#[test]
fn ripple_of_a_modulated_speed() {
    let omega = 20.0 * std::f64::consts::PI;
    let all = samples(|_| 0.0, |t| 0.1 * (1.0 + 0.02 * libm::sin(omega * t)));
    assert!((velocity_ripple(&all) - 0.02 / 2f64.sqrt()).abs() < 1e-9);
}

#[test]
fn contour_rms_and_peak() {
    let with = |deviation| PlaneSample {
        deviation,
        ..PlaneSample::default()
    };
    let contour = Contour::of(&[with(3e-6), with(-4e-6)]);
    assert!((contour.rms - 12.5e-12_f64.sqrt()).abs() < 1e-18 && contour.peak == 4e-6);
    assert_eq!(Contour::of(&[]), Contour::default());
}

/// Minimum zone of shapes whose zone is known: an ellipse's is the difference of its half axes, wherever it stands; a
/// circle pulled out at one place has a narrower zone than the bump about another centre, but never less than half of it.
#[test]
fn circular_deviation_is_the_minimum_zone() {
    let turn = |r: &dyn Fn(f64) -> [f64; 2]| -> Vec<[f64; 2]> {
        (0..3600)
            .map(|k| r(f64::from(k) * std::f64::consts::PI / 1800.0))
            .collect()
    };
    let ellipse = turn(&|a| [0.3 + 10.01e-3 * libm::cos(a), -0.2 + 10e-3 * libm::sin(a)]);
    let width = circular_deviation(&ellipse);
    assert!((width / 10e-6 - 1.0).abs() < 1e-6, "{width}");
    // Half of the turn only: the mean of the points is far from the centre.
    let half = circular_deviation(&ellipse[..1801]);
    assert!(half <= width * (1.0 + 1e-6), "{half}");
    let circle = turn(&|a| [5e-3 * libm::cos(a), 1.0 + 5e-3 * libm::sin(a)]);
    assert!(circular_deviation(&circle) < 1e-12);
    let bump = turn(&|a| {
        let r = if a < 0.1 { 5.002e-3 } else { 5e-3 };
        [r * libm::cos(a), r * libm::sin(a)]
    });
    let width = circular_deviation(&bump);
    assert!((1e-6..=2e-6).contains(&width), "{width}");
    assert_eq!(circular_deviation(&[[0.0, 1.0]; 2]), 0.0);
    // An axis that was left behind: along a line the centre moves off without end. From the middle the zone is half as
    // wide as the line is long.
    let line = turn(&|a| [libm::cos(a), 1e-6 * libm::sin(3.0 * a)]);
    assert!(circular_deviation(&line) < 1.0);
}

/// Four single samples that stand out, two opposite ones and two across them, among very many: the zone holds them all,
/// and about no centre is it narrower than the mean of what the pairs stand out by.
#[test]
fn circular_deviation_sees_single_samples() {
    let n = 40_000;
    let spikes = [
        (1, 3e-6),
        (n / 2 + 1, 3e-6),
        (n / 4 + 1, -1e-6),
        (3 * n / 4 + 1, -1e-6),
    ];
    let points: Vec<[f64; 2]> = (0..n)
        .map(|k| {
            let spike = spikes.iter().find(|(at, _)| *at == k);
            let r = 10e-3 + spike.map_or(0.0, |(_, height)| *height);
            let a = 2.0 * std::f64::consts::PI * f64::from(k) / f64::from(n);
            [r * libm::cos(a), r * libm::sin(a)]
        })
        .collect();
    let width = circular_deviation(&points);
    assert!((width / 4e-6 - 1.0).abs() < 1e-6, "{width}");
}

/// There and back at 20 mm/s, with a velocity that waves by a tenth on the way there and by a fifth on the way back.
#[test]
fn ripple_where_the_reference_is_constant() {
    let limits = Limits {
        velocity: 0.02,
        acceleration: 0.5,
        jerk: 20.0,
    };
    let moves = Moves::constant_velocity(1.0, limits).unwrap();
    let waving: Vec<Sample> = (0..2400)
        .map(|k| {
            let time = f64::from(k) * 1e-3;
            let reference = moves.at(time);
            let part = if reference.velocity > 0.0 { 0.1 } else { 0.2 };
            let wave = libm::sin(2.0 * std::f64::consts::PI * 50.0 * time);
            Sample {
                time,
                reference,
                velocity: reference.velocity * (1.0 + part * wave),
                ..Sample::default()
            }
        })
        .collect();
    let ripple = ripple_at_constant_velocity(&waving).unwrap();
    assert!((ripple - 0.2 / 2f64.sqrt()).abs() < 2e-3, "{ripple}");
    // Ramps alone are no constant velocity, nor is standstill.
    assert_eq!(ripple_at_constant_velocity(&waving[..30]), None);
    assert_eq!(ripple_at_constant_velocity(&[]), None);
}
