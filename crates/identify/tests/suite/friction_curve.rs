//! Friction by speed, against the steady curve of the law that a log is simulated with.

use crate::common::{MACHINE, Noise};
use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Conditioning, Cutoff, FrictionCurve, Law, LawKind, Level, Record, Samples, Settings, Silent,
    Terms, condition, friction_curve, identify,
};

const STEP: f64 = 1e-3;
const SECONDS: f64 = 16.0;
const MASS: f64 = 5.0;
const OFFSET: f64 = 2.0;
const FINE: u32 = 10;

fn law() -> LuGre<f64> {
    let side = Direction {
        coulomb: MACHINE.coulomb,
        static_friction: MACHINE.fixed,
        stribeck_velocity: MACHINE.velocity,
        viscous: MACHINE.sigma2,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, side, OFFSET).unwrap();
    LuGre::new(MACHINE.sigma0, Damping::Constant(MACHINE.sigma1), curve).unwrap()
}

/// A log of this axis, whose level wanders by `wave` to either side.
fn record(motion: impl Fn(f64) -> [f64; 2], wave: f64, seed: u64) -> Record {
    record_of(&law(), motion, wave, seed)
}

/// The same of another law.
fn record_of(law: &LuGre<f64>, motion: impl Fn(f64) -> [f64; 2], wave: f64, seed: u64) -> Record {
    let viscous = law.curve().positive().viscous;
    let mut noise = Noise::new(seed);
    let h = STEP / f64::from(FINE);
    let mut z = 0.0;
    let mut samples = Samples::default();
    let mut velocity = Vec::new();
    for i in 0..(SECONDS / STEP) as usize {
        let t = i as f64 * STEP;
        for k in 0..FINE {
            let s = t - STEP + f64::from(k) * h;
            z = law.step_record(z, h, motion(s)[0], motion(s + h)[0]);
        }
        let [v, a] = motion(t);
        let bristle = law.force(z, v) - OFFSET - viscous * v;
        let level = 1.0 + wave * (TAU * 0.13 * t).sin();
        samples.time.push(t);
        velocity.push(v);
        let friction = level * bristle + viscous * v + OFFSET;
        samples
            .force
            .push(friction + MASS * a + 0.2 * noise.normal());
    }
    samples.velocity = Some(velocity);
    let raw = Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    condition(&[samples], &raw).unwrap()
}

/// Strokes of two lengths and speeds.
fn strokes(t: f64) -> [f64; 2] {
    let sine = |speed: f64, hertz: f64| {
        let w = TAU * hertz;
        [speed * (w * t).sin(), speed * w * (w * t).cos()]
    };
    let [a, b] = [sine(0.12, 0.5), sine(0.04, 0.75)];
    [a[0] + b[0], a[1] + b[1]]
}

fn curve(record: &Record, kind: LawKind) -> Option<FrictionCurve> {
    let law = Law::new(kind);
    let settings = Settings::default();
    let fitted = identify(record, law, &Terms::default(), 1e-3, &settings, &mut Silent).unwrap();
    friction_curve(record, &fitted, &settings, &mut Silent).unwrap()
}

/// Half of the sum of both directions is the steady curve, half of their difference the constant force, whatever the law.
#[test]
fn the_curve_is_that_of_the_axis() {
    let record = record(strokes, 0.0, 1);
    let law = law();
    for kind in [LawKind::LuGre, LawKind::CoulombViscous] {
        let found = curve(&record, kind).unwrap();
        assert_eq!(found.directions.len(), 2);
        // At the speeds of the Stribeck curve the log has few samples.
        let seen = |level: &&Level| level.speed > 0.02;
        for level in found.both.iter().chain(&found.at).filter(seen) {
            let truth = law.curve().force(level.speed) - OFFSET;
            let error = (level.force / truth - 1.0).abs();
            assert!(error < 0.01, "{kind:?} {level:?} {truth}");
            assert!((level.force - truth).abs() < level.half.repeat);
            assert!(
                level.half.at_once < level.half.repeat && level.half.repeat <= level.half.transfer
            );
        }
        for level in found.constant.iter().filter(seen) {
            assert!((level.force - OFFSET).abs() < 0.2, "{level:?}");
        }
    }
}

/// Of flat friction what another day changes is in closed form: its level by .02 of itself and its tilt by .015 (2 v/top - 1), so that
/// the Coulomb part has the variance .02^2 + .015^2, and its covariance with the viscous one is -2 .015^2/top.
#[test]
fn coulomb_and_viscous_friction_go_against_each_other() {
    let flat = Direction {
        coulomb: MACHINE.coulomb,
        static_friction: MACHINE.coulomb,
        stribeck_velocity: 1.0,
        viscous: 0.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, flat, OFFSET).unwrap();
    let law = LuGre::new(MACHINE.sigma0, Damping::Constant(0.0), curve).unwrap();
    let found = self::curve(&record_of(&law, strokes, 0.0, 5), LawKind::CoulombViscous).unwrap();
    let (of_both, with_mass) = found.correlation.unwrap();
    assert!((of_both + 0.6).abs() < 0.03, "{of_both}");
    // The mass does not depend on either: its force has another phase.
    let with_mass = with_mass.unwrap();
    assert!(with_mass.iter().all(|own| own.abs() < 0.3), "{with_mass:?}");
}

/// What strokes of one kind have differently widens the band: a level that wanders.
#[test]
fn what_strokes_have_differently_scatters() {
    let half = |wave: f64| {
        let found = curve(&record(strokes, wave, 2), LawKind::LuGre).unwrap();
        found.at[1].half.at_once / found.at[1].force
    };
    let (flat, waved) = (half(0.0), half(0.05));
    assert!(waved > 10.0 * flat && waved < 0.1, "{flat} {waved}");
}

/// One direction has no sum, and an axis that stays in presliding no curve.
#[test]
fn there_is_no_more_than_the_log_shows() {
    let forward = |t: f64| {
        let w = TAU * 0.5;
        [0.08 + 0.06 * (w * t).sin(), 0.06 * w * (w * t).cos()]
    };
    let found = curve(&record(forward, 0.0, 3), LawKind::CoulombViscous).unwrap();
    assert!(found.both.is_empty() && found.constant.is_empty());
    assert_eq!(found.directions.len(), 1);
    let truth = law().curve().force(found.at[1].speed);
    assert!((found.at[1].force / truth - 1.0).abs() < 0.01);
    let tiny = |t: f64| {
        let w = TAU * 0.5;
        [2e-6 * (w * t).sin(), 2e-6 * w * (w * t).cos()]
    };
    assert_eq!(curve(&record(tiny, 0.0, 4), LawKind::LuGre), None);
}

/// From one day to the next friction changes by some 2 %: no noise makes less of the band of a log that never turns back, though
/// its bristle says nothing after the start.
#[test]
fn a_log_of_one_direction_has_a_band() {
    let w = TAU * 0.5;
    let forward = |t: f64| [0.2 + 0.15 * (w * t).sin(), 0.15 * w * (w * t).cos()];
    for seed in 0..24 {
        let found = curve(&record(forward, 0.0, seed), LawKind::CoulombViscous).unwrap();
        for level in &found.directions[0].level {
            let part = level.half.repeat / level.force;
            assert!((0.03..0.3).contains(&part), "seed {seed}: {level:?}");
        }
    }
}

/// Back and forth, a quarter of a second each way, at the speed of each time, with ramps of a duration in s.
fn moves(speed: impl Fn(i32) -> f64, ramp: f64, t: f64) -> [f64; 2] {
    let way = (4.0 * t).floor() as i32;
    let of = |way: i32| {
        if way % 2 == 0 {
            speed(way)
        } else {
            -speed(way)
        }
    };
    let (before, after) = (of(way - 1), of(way));
    let since = (t - 0.25 * f64::from(way)) / ramp;
    let a = if since < 1.0 {
        (after - before) / ramp
    } else {
        0.0
    };
    [before + (after - before) * since.min(1.0), a]
}

/// Whether all that a curve states has the friction of a law in its band for another motion.
fn assert_true(found: &FrictionCurve, law: &LuGre<f64>, offset: f64) {
    for level in found.both.iter().chain(&found.at) {
        let truth = law.curve().force(level.speed) - offset;
        let off = (level.force - truth).abs();
        assert!(off < level.half.transfer, "{level:?} {truth}");
    }
    for level in &found.constant {
        assert!((level.force - offset).abs() < 0.05 * offset, "{level:?}");
    }
}

/// Speeds that are only passed, with an inertia that outweighs friction, are no part of the curve: half a sample of delay would be a third
/// of the friction there, in every stroke the same.
#[test]
fn speeds_that_are_only_passed_are_not_stated() {
    for (speeds, line) in [([0.1, 0.06], true), ([0.1; 2], false)] {
        let motion = |t| moves(|way| speeds[usize::from(way % 8 > 3)], 8e-3, t);
        let late = |t: f64| [motion(t - 0.5 * STEP)[0], motion(t)[1]];
        let found = curve(&record(late, 0.0, 6), LawKind::CoulombViscous).unwrap();
        assert!(found.speed[0] > 0.3 * speeds[0], "{:?}", found.speed);
        assert_eq!(found.line.is_some(), line);
        let ends = found.speed[0]..=speeds[0];
        assert!(found.at.iter().all(|own| ends.contains(&own.speed)));
        assert_true(&found, &law(), OFFSET);
    }
}

/// What the outer knots hold beside their own speed is not stated: break-away below, a few fast samples above.
#[test]
fn break_away_and_a_short_fast_move_bend_no_curve() {
    let of = |way: i32| [0.025, 0.05, 0.1][way.rem_euclid(12) as usize / 4];
    let slow = |t: f64| moves(of, 0.04, t);
    let fast = |t: f64| moves(|way| if way < 1 { 0.3 } else { of(way) }, 0.04, t);
    for (seed, motion) in [(7, &slow as &dyn Fn(f64) -> [f64; 2]), (8, &fast)] {
        let found = curve(&record(motion, 0.0, seed), LawKind::LuGre).unwrap();
        assert_true(&found, &law(), OFFSET);
        let viscous = found.line.unwrap()[1];
        let off = (viscous.force - MACHINE.sigma2).abs();
        assert!(off < viscous.half.transfer, "{viscous:?}");
    }
}

/// A weight that is larger than friction is half of the difference of the directions.
#[test]
fn an_axis_that_hangs_has_a_curve() {
    let weight = 60.0;
    let side = *law().curve().positive();
    let curve = Stribeck::symmetric(Shape::Gaussian, side, weight).unwrap();
    let law = LuGre::new(MACHINE.sigma0, Damping::Constant(MACHINE.sigma1), curve).unwrap();
    let found = self::curve(&record_of(&law, strokes, 0.0, 9), LawKind::LuGre).unwrap();
    assert_true(&found, &law, weight);
}
