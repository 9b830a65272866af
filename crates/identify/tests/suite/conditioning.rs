//! Closed-loop logs as drives write them: quantised, noisy, half a sample late, mass and offset unknown.

use crate::common::closed_loop::{axis, encoder, error, identified, three_segments, truth};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{Conditioning, Samples, condition};
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
use stiction_servo::path::{Path, Sine};
use stiction_servo::plant::Plant;

/// Every parameter of each log within `most` percent of the truth, and the intervals hold it as often as
/// chance lets them: nine of ten at least.
fn holds(logs: &[(&str, f64, f64)]) {
    let (mut inside, mut all) = (0, 0);
    for &(name, count, most) in logs {
        let log = three_segments(name, count, 0.5, 0);
        let (tuned, found) = identified(&log, count);
        assert!(!tuned.trials.is_empty(), "{name}: nothing was tried");
        for (parameter, truth) in truth(name) {
            let parameter = found.parameter(parameter).unwrap();
            let (off, covered) = error(parameter, truth);
            println!(
                "{name} {:.0} nm {} {off:+.2} % {covered}",
                1e9 * count,
                parameter.name
            );
            assert!(
                off.abs() < most,
                "{name}, {:.0} nm: {} is off by {off:.2} %",
                1e9 * count,
                parameter.name
            );
            inside += usize::from(covered);
            all += 1;
        }
        // The force is held from its sample to the next.
        let delay = found.value("delay").unwrap();
        assert!((delay + 1.25e-4).abs() < 5e-5, "{name}: delay {delay}");
    }
    assert!(10 * inside >= 9 * all, "{inside} of {all} intervals hold");
}

#[test]
fn fine_encoders_within_two_percent() {
    holds(&[
        ("machine", 50e-9, 2.0),
        ("machine", 100e-9, 2.0),
        ("motor", 50e-9, 2.0),
        ("motor", 100e-9, 2.0),
    ]);
}

#[test]
fn coarse_encoders_within_ten_percent() {
    holds(&[("machine", 1e-6, 10.0), ("motor", 1e-6, 10.0)]);
}

/// Largest error, %, of a parameter of the `machine` axis from one slow sine of 3 s at 10 kHz, and which it is.
///
/// The controller answers the noise of its encoder, which draws the fitted delay and sigma1 with it the more the more of
/// the band is fitted. Replicas have to show it.
fn largest_on_a_sine(count: f64, seed: u64) -> (f64, &'static str) {
    let axis = axis("machine");
    let log = ClosedLoop {
        plant: Plant::new(axis.mass, axis.law).unwrap(),
        controller: Cascade {
            position_gain: 80.0,
            speed_gain: 2000.0,
            integral_gain: 1e5,
            mass_feedforward: 0.0,
            force_limit: 1e3,
        },
        path: Path::sine(0.0503, 1.0, 3.0).unwrap(),
        encoder: encoder(count, seed),
        rate: 1e4,
        substeps: 10,
        force_noise: 0.3,
        force_log: ForceLog::Held,
        seed,
    }
    .run()
    .unwrap();
    let (_, found) = identified(&log, count);
    let errors = truth("machine").map(|(name, truth)| {
        let (off, _) = error(found.parameter(name).unwrap(), truth);
        (off.abs(), name)
    });
    errors
        .into_iter()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap()
}

/// With a common cut-off of 250 to 700 Hz sigma1 is off by 5 and 7 % here.
#[test]
fn the_answer_of_the_controller_keeps_the_cutoff_low() {
    for (count, seed) in [(10e-9, 10), (100e-9, 9)] {
        let (off, name) = largest_on_a_sine(count, seed);
        assert!(
            off < 2.0,
            "{:.0} nm: {name} is off by {off:.2} %",
            1e9 * count
        );
    }
}

/// The best window used throughout leaves 1.31, 1.35 and 1.87 % (docs/conditioning.md).
#[test]
#[ignore = "soak: identifies 36 logs of 3 s"]
fn the_choice_is_better_than_any_window() {
    for (count, window) in [(10e-9, 1.31), (100e-9, 1.35), (1e-6, 1.87)] {
        let off: Vec<f64> = (1..=12)
            .map(|seed| largest_on_a_sine(count, seed).0)
            .collect();
        let square = off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64;
        let worst = off.iter().copied().fold(0.0, f64::max);
        println!(
            "{:.0} nm: {:.2} %, at most {worst:.2} %",
            1e9 * count,
            square.sqrt()
        );
        assert!(square.sqrt() < window, "{:.2} %", square.sqrt());
        assert!(worst < 3.5, "{worst:.2} %");
    }
}

/// A stroke shorter than the way of the bristles from one side to the other shows no sliding: the levels
/// that suit its bend best, 14 N and 27 N here, are not those of the axis, and are not stated as known.
#[test]
fn a_stroke_within_presliding_determines_no_level() {
    let side = Direction {
        coulomb: 9.0,
        static_friction: 14.0,
        stribeck_velocity: 4e-3,
        viscous: 25.0,
    };
    let curve = Stribeck::new(Shape::Gaussian, side, side, 0.0).unwrap();
    let law = LuGre::new(6e5, Damping::Constant(900.0), curve).unwrap();
    let log = ClosedLoop {
        plant: Plant::new(7.0, law).unwrap(),
        controller: Cascade::tuned(7.0, 60.0, 1e3).unwrap(),
        path: Path::sine(20e-6 * std::f64::consts::TAU, 1.0, 3.0).unwrap(),
        encoder: encoder(100e-9, 0),
        rate: 4000.0,
        substeps: 10,
        force_noise: 0.5,
        force_log: ForceLog::Held,
        seed: 0,
    }
    .run()
    .unwrap();
    let (_, found) = identified(&log, 100e-9);
    for (name, truth) in [
        ("stribeck_velocity", 4e-3),
        ("coulomb", 9.0),
        ("static", 14.0),
    ] {
        let p = found.parameter(name).unwrap();
        println!("{name} {} {:?} {:?} {}", p.value, p.std, p.ci95, p.reason);
        assert!(!p.identifiable, "{name} = {}, truth {truth}", p.value);
    }
}

/// Samples of a position at 1 kHz, with the velocity where there is no position.
fn moved(position: &[f64], as_velocity: bool) -> Samples {
    let time: Vec<f64> = (0..position.len()).map(|i| i as f64 * 1e-3).collect();
    let velocity = as_velocity.then(|| {
        let after = |i: usize| position[(i + 1).min(position.len() - 1)];
        (0..position.len())
            .map(|i| (after(i) - position[i]) / 1e-3)
            .collect()
    });
    Samples {
        force: time.clone(),
        position: (!as_velocity).then(|| position.to_vec()),
        velocity,
        time,
        ..Samples::default()
    }
}

/// Slow motion in both directions counts as such whatever else is in the log, and noise does not.
#[test]
fn both_directions_are_told_by_travel() {
    let steps = |x: f64| (x / 1e-6).round() * 1e-6;
    let noise = |i: usize| ((i * 7919 % 1000) as f64 / 1000.0 - 0.5) * 4e-6;
    // Five periods of 2 mm, then 0.5 m in 50 ms: the slow motion is at 0.05 % of the top speed.
    let slow_and_a_jump: Vec<f64> = (0..20_000)
        .map(|i| {
            let t = i as f64 * 1e-3;
            let jump = 0.05 * ((t - 12.0) / 0.05).clamp(0.0, 1.0);
            steps(1e-3 * (std::f64::consts::TAU * t / 4.0).sin() + jump)
        })
        .collect();
    // So slow that noise of the position makes any velocity go to both sides.
    let one_way_in_noise: Vec<f64> = (0..20_000).map(|i| 1e-6 * i as f64 + noise(i)).collect();
    let both = |position: &[f64], as_velocity| {
        let log = moved(position, as_velocity);
        let record = condition(&[log], &Conditioning::default()).unwrap();
        record.moves_both_ways()
    };
    assert!(both(&slow_and_a_jump, false));
    assert!(both(&slow_and_a_jump, true));
    assert!(!both(&one_way_in_noise, false));
    assert!(!both(&one_way_in_noise, true));
}

/// A soft loop on a rotary table whose counts are a fortieth of its presliding: at the chosen cut-offs the fitted delay is -0.9
/// samples (true -0.5), and replicas of a controller that late would take 5 % off sigma0 and add 8 % to Fs that are right.
#[test]
fn a_soft_loop_with_a_coarse_encoder_is_known_as_well_as_is_said() {
    let (count, mass) = (8.7e-6, 0.85);
    let side = Direction {
        coulomb: 6.2,
        static_friction: 8.1,
        stribeck_velocity: 0.02,
        viscous: 1.6,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
    let law = LuGre::new(2.2e4, Damping::Capped(14.0), curve).unwrap();
    let slow = Sine::new(0.41, 0.25, 24.0);
    let quick = Sine::new(0.22, 1.0, 8.0);
    let log = ClosedLoop {
        plant: Plant::new(mass, law).unwrap(),
        controller: Cascade::tuned(mass, 10.0, 100.0).unwrap(),
        path: Path::new(vec![slow, quick]).unwrap(),
        encoder: encoder(count, 1),
        rate: 2000.0,
        substeps: 10,
        force_noise: 0.05,
        force_log: ForceLog::Held,
        seed: 1,
    }
    .run()
    .unwrap();
    let (tuned, found) = identified(&log, count);
    let first = tuned.first_delay.unwrap();
    assert!(
        (first.delay + 0.5).abs() < 2.0 * first.deviation,
        "{first:?}"
    );
    let truth = [
        ("sigma0", 2.2e4),
        ("sigma2", 1.6),
        ("coulomb", 6.2),
        ("static", 8.1),
        ("stribeck_velocity", 0.02),
        ("mass", 0.85),
    ];
    for (name, truth) in truth {
        let p = found.parameter(name).unwrap();
        let (low, high) = p.ci95.unwrap();
        let widths = (p.value - truth).abs() / (high - low);
        println!("{name} {} {:?} {widths:.2}", p.value, p.ci95);
        assert!(widths < 1.0, "{name}: {} in {:?}", p.value, p.ci95);
    }
}
