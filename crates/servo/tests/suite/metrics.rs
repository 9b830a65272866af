//! Metrics of motions whose errors are known in closed form.

use stiction_servo::axis::Sample;
use stiction_servo::metrics::{
    Contour, Crawl, Feed, Hunting, Tracking, circular_deviation, reversals, standing_error,
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
    let crawl = Crawl::of(&waving).unwrap();
    assert!(
        (crawl.ripple - 0.2 / 2f64.sqrt()).abs() < 2e-3,
        "{}",
        crawl.ripple
    );
    assert_eq!(crawl.rest_share, 0.0);
    // Ramps alone are no constant velocity, nor is standstill.
    assert_eq!(Crawl::of(&waving[..30]), None);
    assert_eq!(Crawl::of(&[]), None);
}

/// A reference at rest at 1 m, as it stands after a move.
fn standing(seconds: u32, x: impl Fn(f64) -> f64) -> Vec<Sample> {
    (0..=seconds * 1000)
        .map(|k| {
            let time = f64::from(k) * 1e-3;
            Sample {
                time,
                reference: Reference {
                    position: 1.0,
                    ..Reference::default()
                },
                position: x(time),
                ..Sample::default()
            }
        })
        .collect()
}

/// Stick-slip at 1 mm/s: for three quarters of every .1 s the axis creeps at a twentieth of the speed, then it slips so fast
/// that it keeps up. Mean and deviation of two values: .05 for 75 of 100, 3.85 for 25.
#[test]
fn crawl_of_stick_slip() {
    let samples: Vec<Sample> = (0..=2000)
        .map(|k| Sample {
            time: f64::from(k) * 1e-3,
            reference: Reference {
                velocity: -1e-3,
                ..Reference::default()
            },
            velocity: if k % 100 < 75 { -0.05e-3 } else { -3.85e-3 },
            ..Sample::default()
        })
        .collect();
    let crawl = Crawl::of(&samples[..2000]).unwrap();
    assert!((crawl.rest_share - 0.75).abs() < 1e-12);
    // 3.8 sqrt(.75 .25)
    assert!(
        (crawl.ripple - 1.645_448_267_190_434).abs() < 1e-9,
        "{}",
        crawl.ripple
    );
    // An axis that does not break away has no ripple, and rests.
    let stuck: Vec<Sample> = samples
        .iter()
        .map(|s| Sample {
            velocity: 0.0,
            ..*s
        })
        .collect();
    let crawl = Crawl::of(&stuck).unwrap();
    assert_eq!((crawl.ripple, crawl.rest_share), (0.0, 1.0));
    // Too short to be measured.
    assert_eq!(Crawl::of(&samples[..100]), None);
}

/// A sine of 2 pi m/s that the axis follows at 99 % of the velocity, one hundredth of which is missing at the top.
#[test]
fn feed_error_of_an_axis_that_is_slow() {
    let omega = 2.0 * std::f64::consts::PI;
    let slow = samples(|_| 0.0, |t| 0.99 * omega * libm::cos(omega * t));
    let feed = Feed::of(&slow).unwrap();
    assert!((feed.share - 0.01).abs() < 1e-12);
    assert!((feed.peak - 0.01 * omega).abs() < 1e-12);
    assert!((feed.rms - 0.01 * omega / 2f64.sqrt()).abs() < 1e-9);
    // Which way it is off does not matter, and that it goes at all while the reference rests is no error of the feed.
    let fast = samples(|_| 0.0, |t| 1.02 * omega * libm::cos(omega * t));
    assert!((Feed::of(&fast).unwrap().share - 0.02).abs() < 1e-12);
    assert_eq!(Feed::of(&standing(1, |t| t)), None);
}

/// Along a contour: what is across it is no error of the feed. 3 and 4 m/s asked for, 5 along the way; the axes give 4 and 3,
/// which is 24/5 along.
#[test]
fn feed_error_along_a_contour() {
    let axis = |asked: f64, velocity: f64| Sample {
        reference: Reference {
            velocity: asked,
            ..Reference::default()
        },
        velocity,
        ..Sample::default()
    };
    let sample = PlaneSample {
        axes: [axis(3.0, 4.0), axis(4.0, 3.0)],
        ..PlaneSample::default()
    };
    let feed = Feed::along(&[sample, PlaneSample::default()]).unwrap();
    assert!((feed.peak - 0.2).abs() < 1e-15 && (feed.rms - 0.2).abs() < 1e-15);
    assert!((feed.share - 0.04).abs() < 1e-15);
    assert_eq!(Feed::along(&[PlaneSample::default()]), None);
}

/// There and back with half a second after each: 3 um short of the first place in the end, 2 um beyond the second, after both
/// have settled from a millimetre with a time constant of 10 ms.
#[test]
fn standing_error_is_what_is_left() {
    let limits = Limits {
        velocity: 0.05,
        acceleration: 1.0,
        jerk: 50.0,
    };
    let moves = Moves::there_and_back(0.02, 0.5, limits).unwrap();
    let one = 0.5 * moves.duration();
    let course = |dwell: f64| -> Vec<Sample> {
        (0..=(2e3 * one) as usize)
            .map(|k| {
                let time = k as f64 * 1e-3;
                let reference = moves.at(time);
                // At the instant at which the way back begins the axis still stands.
                let (since, left) = match time < one + 5e-4 {
                    true => (time - (one - 0.5), 3e-6),
                    false => (time - (2.0 * one - 0.5), -2e-6),
                };
                let settling = 1e-3 * libm::exp(-since.max(0.0) / 0.01);
                Sample {
                    time,
                    reference,
                    position: reference.position - left - settling,
                    ..Sample::default()
                }
            })
            .filter(|s| s.time < one - 0.5 + dwell)
            .collect()
    };
    let error = standing_error(&course(2.0)).unwrap();
    assert!((error / 3e-6 - 1.0).abs() < 1e-4, "{error}");
    // While it moves, and in a rest of 50 ms, it does not stand anywhere; nor before the first move.
    assert_eq!(standing_error(&course(0.05)), None);
    let waiting: Vec<Sample> = (0..500)
        .map(|k| Sample {
            time: f64::from(k) * 1e-3,
            position: 1e-6,
            ..Sample::default()
        })
        .collect();
    assert_eq!(standing_error(&waiting), None);
}

/// A triangle that stands for a while at each end, as an axis does that sticks and slips about its target: from -4 to 6 um off,
/// once in .8 s.
#[test]
fn hunting_is_a_cycle_that_stays() {
    let off = |t: f64| match libm::fmod(t, 0.8) {
        t if t < 0.3 => -4e-6,
        t if t < 0.4 => -4e-6 + 1e-4 * (t - 0.3),
        t if t < 0.7 => 6e-6,
        t => 6e-6 - 1e-4 * (t - 0.7),
    };
    let hunting = Hunting::of(&standing(10, |t| 1.0 + off(t))).unwrap();
    assert!((hunting.amplitude / 5e-6 - 1.0).abs() < 1e-6);
    assert!((hunting.period.unwrap() - 0.8).abs() < 1e-3);
    // 2 s from the middle of 4 s on hold two cycles and a half at most, 1 s of 2 s hold one: not known to come back.
    let cycles = |seconds: u32| {
        let found = Hunting::of(&standing(seconds, |t| 1.0 + off(t)));
        found.unwrap().period.is_some()
    };
    assert!(cycles(5) && !cycles(2));
    // What rings and dies out, creeps, stands, or goes up and down at random is no limit cycle.
    let none = Hunting {
        amplitude: 0.0,
        period: None,
    };
    let rings = |t: f64| libm::exp(-t) * libm::sin(20.0 * t);
    let creeps = |t: f64| -1e-6 * libm::exp(-t / 3.0);
    let mut state = 1_u32;
    let noise: Vec<f64> = (0..=10_000)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 16) * 1e-9
        })
        .collect();
    let jitters = |t: f64| noise[libm::round(t * 1e3) as usize];
    for still in [&rings as &dyn Fn(f64) -> f64, &creeps, &|_| 3e-6, &jitters] {
        assert_eq!(Hunting::of(&standing(10, |t| 1.0 + still(t))), Some(none));
    }
    // Where the rest is short nothing is known of it.
    assert_eq!(Hunting::of(&standing(10, |t| 1.0 + off(t))[..900]), None);
}
