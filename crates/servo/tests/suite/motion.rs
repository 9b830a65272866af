//! Test motions: derivatives, limits, rest at both ends, shortest time.

use proptest::prelude::*;
use stiction_friction::compensator::ahead;
use stiction_servo::motion::{Chirp, Limits, Move, Moves, Profile, SetPoints, Sine, Step};
use stiction_servo::sampled::Sampled;
use stiction_servo::trajectory::{Lookahead, Trajectory};

/// Velocity and acceleration are the derivatives of the position, as long as the jerk stays below `jerk`.
fn derivatives_belong(trajectory: &impl Trajectory, speed: f64, jerk: f64) {
    let h = 1e-5;
    for k in 1..500 {
        let t = trajectory.duration() * f64::from(k) / 500.0 + 3e-7;
        let (a, b, c) = (trajectory.at(t - h), trajectory.at(t), trajectory.at(t + h));
        let velocity = (c.position - a.position) / (2.0 * h);
        let acceleration = (c.velocity - a.velocity) / (2.0 * h);
        assert!(
            (velocity - b.velocity).abs() < jerk * h * h + 1e-9 * speed,
            "{t}: {velocity} {b:?}"
        );
        assert!(
            (acceleration - b.acceleration).abs() < 2.0 * jerk * h + 1e-4 * speed,
            "{t}: {acceleration} {b:?}"
        );
    }
}

fn any_limits() -> impl Strategy<Value = Limits> {
    (-3.0..0.5_f64, -1.0..1.5_f64, 0.5..3.5_f64).prop_map(|(v, a, j)| Limits {
        velocity: 10f64.powf(v),
        acceleration: 10f64.powf(a),
        jerk: 10f64.powf(j),
    })
}

proptest! {
    #[test]
    fn a_profile_keeps_its_limits_and_reaches_its_end(limits in any_limits(), e in -6.0..1.0_f64, back: bool) {
        let distance = if back { -10f64.powf(e) } else { 10f64.powf(e) };
        let profile = Profile::new(distance, limits).unwrap();
        let end = profile.duration();
        let (mut most, mut travelled, mut last) = ([0.0_f64; 2], 0.0, profile.at(0.0));
        let n = 4000;
        for k in 0..=n {
            let at = profile.at(end * f64::from(k) / f64::from(n));
            most = [most[0].max(at.velocity.abs()), most[1].max(at.acceleration.abs())];
            // The trapezoid with its correction is exact for the cubic within a phase.
            let h = end / f64::from(n);
            travelled += 0.5 * h * (last.velocity + at.velocity) + h * h / 12.0 * (last.acceleration - at.acceleration);
            prop_assert!((at.acceleration - last.acceleration).abs() <= limits.jerk * h * (1.0 + 1e-9));
            last = at;
        }
        prop_assert!(most[0] <= limits.velocity * (1.0 + 1e-9) && most[1] <= limits.acceleration * (1.0 + 1e-9));
        // What the rule loses in the steps that hold a change of jerk.
        let h = end / f64::from(n);
        let lost = 8.0 * limits.jerk * h * h * h;
        prop_assert!((travelled - distance).abs() < lost + 1e-9 * distance.abs(), "{travelled} {distance}");
        let near = profile.at(end * (1.0 - 1e-12));
        prop_assert!((near.position / distance - 1.0).abs() < 1e-9 && near.velocity.abs() < 1e-6 * limits.velocity);
        prop_assert_eq!(profile.at(2.0 * end).position, distance);
        // Nothing shorter: some limit is reached, and where none but the jerk is, it is on all the time.
        let reached = most[0] > limits.velocity * (1.0 - 1e-3) || most[1] > limits.acceleration * (1.0 - 1e-3);
        let all_jerk = (end - 4.0 * (0.5 * distance.abs() / limits.jerk).cbrt()).abs() < 1e-9 * end;
        prop_assert!(reached || all_jerk);
    }
}

#[test]
fn profile_times_in_closed_form() {
    let limits = Limits {
        velocity: 0.5,
        acceleration: 5.0,
        jerk: 100.0,
    };
    // Ramp: a/j + v/a = .15 s; 1 m at .5 m/s: 2 s + .15 s.
    assert!((Profile::new(1.0, limits).unwrap().duration() - 2.15).abs() < 1e-12);
}

#[test]
fn derivatives() {
    let omega = |f: f64| 2.0 * std::f64::consts::PI * f;
    derivatives_belong(
        &Sine::new(5e-3, 0.5, 2.0).unwrap(),
        0.02,
        5e-3 * omega(0.5).powi(3),
    );
    derivatives_belong(
        &Chirp::new(1e-4, 0.5, 20.0, 3.0).unwrap(),
        0.02,
        3e-4 * omega(20.0).powi(3),
    );
    let limits = Limits {
        velocity: 0.1,
        acceleration: 2.0,
        jerk: 50.0,
    };
    derivatives_belong(&Moves::staircase(0.01, 3, 0.05, limits).unwrap(), 0.1, 50.0);
    let held = Moves::constant_velocity(1.0, limits).unwrap();
    derivatives_belong(&held, 0.1, 50.0);
    let at_speed = (0..10_000)
        .filter(|k| held.at(held.duration() * f64::from(*k) / 1e4).velocity > 0.1 - 1e-12)
        .count() as f64
        / 1e4
        * held.duration();
    assert!((at_speed - 1.0).abs() < 1e-3, "{at_speed}");
    let points = (0..200)
        .map(|k| 1e-3 * libm::sin(0.1 * f64::from(k)))
        .collect();
    derivatives_belong(&SetPoints::new(100.0, points).unwrap(), 0.01, 700.0);
}

/// Uneven times: a parabola is met exactly, a rest stays a rest, and a sine is followed to the third order of the spacing in
/// position, the second in velocity and the first in acceleration: 16 ms at most times the third derivative.
#[test]
fn set_points_at_uneven_times() {
    let time = |k: u32| 0.01 * f64::from(k) + 0.003 * libm::sin(f64::from(k));
    let times: Vec<f64> = (0..200).map(time).collect();
    let begin = times[0];
    let made = |x: &dyn Fn(f64) -> f64| {
        let positions = times.iter().map(|t| x(t - begin)).collect();
        SetPoints::timed(times.iter().map(|t| t + 7.0).collect(), positions).unwrap()
    };
    let (parabola, sine) = (made(&|t| 3.0 + 0.2 * t * t), made(&|t| libm::sin(3.0 * t)));
    let rest = made(&|t| {
        if t < 1.0 {
            0.01 * libm::sin(20.0 * t)
        } else {
            0.3
        }
    });
    for k in 0..1000 {
        let t = 0.1 + 1.5 * f64::from(k) / 1000.0;
        let at = parabola.at(t);
        assert!((at.position - 0.2 * t * t).abs() < 1e-12 && (at.velocity - 0.4 * t).abs() < 1e-11);
        assert!((at.acceleration - 0.4).abs() < 1e-9);
        let at = sine.at(t);
        assert!((at.position - libm::sin(3.0 * t)).abs() < 2e-5, "{t}");
        assert!((at.velocity - 3.0 * libm::cos(3.0 * t)).abs() < 2e-3, "{t}");
        assert!(
            (at.acceleration + 9.0 * libm::sin(3.0 * t)).abs() < 0.016 * 27.0,
            "{t}"
        );
        if t > 1.05 {
            assert_eq!((rest.at(t).velocity, rest.at(t).acceleration), (0.0, 0.0));
        }
    }
    let refused = |times: Vec<f64>| SetPoints::timed(times, vec![0.0; 3]).unwrap_err();
    assert_eq!(refused(vec![0.0, 1.0]).name, "times");
    assert_eq!(refused(vec![0.0, 1.0, 1.0]).value, 1.0);
}

/// Set points of a quadratic are met exactly between its points, away from the ends.
#[test]
fn set_points_reproduce_a_parabola() {
    let points = (0..20).map(|k| 0.5 + 2e-3 * f64::from(k * k)).collect();
    let spline = SetPoints::new(10.0, points).unwrap();
    for k in 0..100 {
        let t = 0.2 + 1.5 * f64::from(k) / 100.0;
        let at = spline.at(t);
        assert!((at.position - 0.2 * t * t).abs() < 1e-12);
        assert!((at.velocity - 0.4 * t).abs() < 1e-12);
        assert!((at.acceleration - 0.4).abs() < 1e-10);
    }
}

#[test]
fn bad_motions_are_named() {
    let limits = Limits {
        velocity: 0.1,
        acceleration: 2.0,
        jerk: 0.0,
    };
    assert_eq!(Profile::new(1.0, limits).unwrap_err().name, "jerk");
    assert_eq!(Moves::new(&[], limits).unwrap_err().name, "moves");
    let late = Move {
        distance: 1.0,
        dwell: -1.0,
    };
    assert_eq!(Moves::new(&[late], limits).unwrap_err().name, "dwell");
    assert_eq!(Sine::new(1.0, 0.0, 1.0).unwrap_err().name, "frequency");
    assert_eq!(
        SetPoints::new(1.0, vec![0.0]).unwrap_err().name,
        "set_points"
    );
    assert_eq!(
        SetPoints::new(1.0, vec![0.0, f64::NAN]).unwrap_err().name,
        "set_point"
    );
    assert_eq!(
        Step::new(1.0, 0.0, f64::INFINITY).unwrap_err().name,
        "duration"
    );
}

/// The velocity ahead is that of the trajectory at the later instant, to the interpolation between samples.
#[test]
fn lookahead_is_the_later_velocity() {
    let sine = Sine::new(5e-3, 0.5, 2.0).unwrap();
    let rate = 1000.0;
    for preview in [0.0, 0.5, 1.5, 2.0, 6.3] {
        let mut lookahead = Lookahead::new(&sine, rate, preview);
        for k in 0..3000 {
            let t = f64::from(k) / rate;
            let (now, ahead) = lookahead.sample();
            assert_eq!(now, sine.at(t));
            let later = sine.at(t + preview / rate).velocity;
            assert!(
                (ahead - later).abs() < 2e-8,
                "{preview} {t}: {ahead} {later}"
            );
        }
    }
}

/// A shared reference is the one of the moment, to the bit, also where the preview looks beyond the end.
#[test]
fn sampled_is_what_a_lookahead_gives() {
    let sine = Sine::new(5e-3, 0.7, 1.0).unwrap();
    let rate = 1000.0;
    let sampled = Sampled::new(&sine, rate).unwrap();
    for preview in [0.0, 0.3, 1.0, 1.64, 2.0, 6.3, 7.0, 9.0] {
        let mut lookahead = Lookahead::new(&sine, rate, preview);
        let mut count = 0;
        for (k, both) in sampled.with_preview(preview).enumerate() {
            assert_eq!(both, lookahead.sample(), "{preview} {k}");
            let velocity = |i: usize| sine.at((k + i) as f64 / rate).velocity;
            let known: Vec<f64> = (0..8).map(velocity).collect();
            assert_eq!(both.1, ahead(&known, preview.min(7.0)), "{preview} {k}");
            count += 1;
        }
        assert_eq!(count, 1429);
    }
    assert_eq!(Sampled::new(&sine, 0.0).unwrap_err().name, "rate");
    assert_eq!(Sampled::new(&sine, 1e9).unwrap_err().name, "samples");
}
