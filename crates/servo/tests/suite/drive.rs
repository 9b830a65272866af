//! The drive against closed forms: delay, lag, limits; and the other forces.

use proptest::prelude::*;
use stiction_servo::disturbance::{Cogging, Disturbance, Recorded};
use stiction_servo::drive::{Drive, RunningDrive};

const H: f64 = 250e-6;

/// Forces of the first periods after a step of the command, each period in `parts` stretches.
fn step_response(drive: Drive, force: f64, periods: usize, parts: u32) -> Vec<f64> {
    let mut running = RunningDrive::new(drive, H, parts).unwrap();
    let mut forces = Vec::new();
    for _ in 0..periods {
        running.command(force);
        forces.extend((0..parts as usize).map(|i| running.force(i)));
    }
    forces
}

#[test]
fn an_ideal_drive_gives_what_is_asked() {
    assert_eq!(step_response(Drive::ideal(), 37.0, 3, 2), vec![37.0; 6]);
}

#[test]
fn delay_in_whole_periods_and_parts() {
    let late = |periods: f64| Drive {
        delay: periods * H,
        ..Drive::ideal()
    };
    assert_eq!(step_response(late(1.0), 8.0, 3, 1), [0.0, 8.0, 8.0]);
    assert_eq!(step_response(late(1.25), 8.0, 3, 1), [0.0, 6.0, 8.0]);
    assert_eq!(step_response(late(0.5), 8.0, 1, 4), [0.0, 0.0, 8.0, 8.0]);
    assert_eq!(
        step_response(late(3.0), 8.0, 5, 1),
        [0.0, 0.0, 0.0, 8.0, 8.0]
    );
}

proptest! {
    /// Mean force over any stretch of a first-order lag after a step, in closed form, however the period is cut.
    #[test]
    fn current_loop_lag(lag in 1e-5..1e-3, delay in 0.0..4.0, parts in 1_u32..9) {
        let drive = Drive { current_lag: lag, delay: delay * H, ..Drive::ideal() };
        let forces = step_response(drive, 10.0, 12, parts);
        let area = |t: f64| if t > 0.0 { 10.0 * (t - lag * (1.0 - (-t / lag).exp())) } else { 0.0 };
        let each = H / f64::from(parts);
        for (i, force) in forces.iter().enumerate() {
            let t = i as f64 * each - delay * H;
            let expected = (area(t + each) - area(t)) / each;
            prop_assert!((force - expected).abs() < 1e-9, "{i}: {force} {expected}");
        }
    }
}

proptest! {
    /// A force told ahead is the one that comes, and that of the next command is not told.
    #[test]
    fn the_next_force(lag in 0.0..1e-3, delay in 0.0..4.0, parts in 1_u32..5, commands in prop::collection::vec(-50.0..50.0, 1..40)) {
        let drive = Drive { current_lag: lag, delay: delay * H, ..Drive::ideal() };
        let mut plain = RunningDrive::new(drive, H, parts).unwrap();
        let mut asked = plain.clone();
        let mut told = None;
        for command in commands {
            plain.command(command);
            asked.command(command);
            for i in 0..parts as usize {
                let force = asked.force(i);
                prop_assert_eq!(force, plain.force(i));
                prop_assert!(told.is_none_or(|told| told == force));
                told = asked.next_force(i);
                prop_assert!(told.is_some() || i + 1 == parts as usize && delay < 1.0);
            }
            let first = f64::from(parts).recip();
            prop_assert!(told.is_none() || delay >= first);
        }
    }
}

#[test]
fn peak_and_rated_current() {
    let drive = Drive {
        current_lag: 0.0,
        thermal_time: 0.1,
        ..Drive::linear_motor(0.0)
    };
    assert_eq!(drive.gain(), 172.8);
    let forces = step_response(drive, 1e6, 4000, 1);
    assert_eq!(forces[0], 1248.0);
    // The mean of the square passes the rated one when 1 - exp(-t/T) = (221/1248)^2.
    let hot = -0.1 * (1.0 - (221.0_f64 / 1248.0).powi(2)).ln() / H;
    let first = forces.iter().position(|f| *f < 1248.0).unwrap();
    assert!((first as f64 - hot).abs() <= 2.0, "{first} {hot}");
    // From then on the rms stays at the rated force.
    let tail = &forces[2000..];
    let rms = (tail.iter().map(|f| f * f).sum::<f64>() / tail.len() as f64).sqrt();
    assert!((rms / 221.0 - 1.0).abs() < 0.05, "{rms}");
}

#[test]
fn drives_that_cannot_be_are_named() {
    let name = |d: Drive| RunningDrive::new(d, H, 1).unwrap_err().name;
    let good = Drive::linear_motor(H);
    for substeps in [0, 100_001] {
        let refused = RunningDrive::new(good, H, substeps).unwrap_err();
        assert_eq!(refused.name, "substeps");
    }
    assert_eq!(
        name(Drive {
            force_constant: 0.0,
            ..good
        }),
        "force_constant"
    );
    assert_eq!(
        name(Drive {
            amplifier_gain: f64::NAN,
            ..good
        }),
        "amplifier_gain"
    );
    assert_eq!(
        name(Drive {
            peak_current: -1.0,
            ..good
        }),
        "peak_current"
    );
    assert_eq!(
        name(Drive {
            rated_current: f64::NAN,
            ..good
        }),
        "rated_current"
    );
    assert_eq!(
        name(Drive {
            current_lag: -1.0,
            ..good
        }),
        "current_lag"
    );
    assert_eq!(
        name(Drive {
            delay: 33.0 * H,
            ..good
        }),
        "delay"
    );
}

#[test]
fn cogging_repeats_with_its_pitch_and_disturbances_follow_time() {
    let cogging = Cogging {
        amplitude: 3.0,
        pitch: 0.02,
        phase: 0.0,
    };
    assert_eq!(cogging.validate(), Ok(()));
    assert!((cogging.force(0.005) - 3.0).abs() < 1e-12);
    assert!((cogging.force(0.123) - cogging.force(0.103)).abs() < 1e-12);
    let sine = Disturbance::Sine {
        amplitude: 2.0,
        frequency: 10.0,
        phase: 0.0,
    };
    assert_eq!(sine.validate(), Ok(()));
    assert!((sine.force(0.025) - 2.0).abs() < 1e-12);
    assert!((sine.force(0.325) - 2.0).abs() < 1e-12);
    let recorded = Recorded::new(vec![1.0, 2.0, 4.0], vec![5.0, 7.0, -1.0]).unwrap();
    let recorded = Disturbance::Recorded(recorded);
    let at = [0.0, 1.0, 1.25, 2.0, 3.0, 4.0, 9.0].map(|t| recorded.force(t));
    assert_eq!(at, [5.0, 5.0, 5.5, 7.0, 3.0, -1.0, -1.0]);
    let name = |times: &[f64], forces: &[f64]| {
        Recorded::new(times.into(), forces.into()).unwrap_err().name
    };
    assert_eq!(name(&[], &[]), "times");
    assert_eq!(name(&[0.0, 0.0], &[1.0, 1.0]), "time");
    assert_eq!(name(&[0.0, 1.0], &[1.0, f64::NAN]), "disturbance");
}
