//! A drive that is off, and forces that are small beside the largest of their log without being that.

use crate::mapping_common::{column, noise, table, warnings};
use std::f64::consts::TAU;
use stiction_formats::Table;
use stiction_log::{Log, Mapping};

/// Samples a second, Hz, and seconds.
const RATE: f64 = 1000.0;
const SECONDS: f64 = 8.0;
/// Most that the drive gives, N.
const LIMIT: f64 = 14.0;

/// A mass of 5 kg with friction of 8 N and a spring (N/m) that follows jumps of its reference, under a drive that is at its limit
/// whenever it does; what is logged is what the controller asked for, with some noise (N). A second of it is without force.
fn asked_for(spring: f64, noisy: f64, off: bool) -> Table {
    let (mass, friction) = (5.0, 8.0);
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    let (mut time, mut position, mut force) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..(SECONDS * RATE) as usize {
        let t = i as f64 / RATE;
        let reference = if (0.5 * t).fract() < 0.5 { 0.0 } else { 0.08 };
        // A slow way beside the jumps, in which the force is friction and the spring alone.
        let reference = reference + 0.01 * (0.5 * TAU * t).sin();
        let asked = 2e4 * (reference - x) - 1500.0 * v;
        let is_off = off && (3.0..4.0).contains(&t);
        time.push(t);
        position.push(x);
        force.push(noisy * noise(i) + if is_off { 0.0 } else { asked });
        for _ in 0..50 {
            let h = 1.0 / RATE / 50.0;
            let drives = asked.clamp(-LIMIT, LIMIT) - spring * x;
            v += h / mass * (drives - friction * (v / 1e-3).tanh());
            x += h * v;
        }
    }
    table(vec![
        column("time [s]", time),
        column("position [m]", position),
        column("force [N]", force),
    ])
}

fn is_named(table: &Table) -> bool {
    let log = Log::from_table(table, &Mapping::default()).unwrap();
    warnings(&log).contains(&"force-dead")
}

/// A controller that asks for many times what the drive gives makes friction and springs small beside the largest force.
#[test]
fn what_is_small_beside_a_force_that_was_only_asked_for_is_no_drive_that_is_off() {
    for spring in [0.0, 30.0, 60.0] {
        for noisy in [0.0, 0.5, 2.0] {
            let log = asked_for(spring, noisy, false);
            assert!(!is_named(&log), "{spring} N/m, {noisy} N");
        }
        // Beside such forces a drive that is off is told from friction where little noise is logged.
        let log = asked_for(spring, 0.1, true);
        assert!(is_named(&log), "{spring} N/m: off");
    }
}

/// The force of a spring, logged alone.
#[test]
fn a_force_that_follows_the_position_is_none_that_is_off() {
    let time: Vec<f64> = (0..8000).map(|i| f64::from(i) / RATE).collect();
    let position: Vec<f64> = time
        .iter()
        .map(|t| {
            if *t < 3.0 {
                0.03 * (TAU * t).sin()
            } else {
                4e-4 * (2.0 * TAU * t).sin()
            }
        })
        .collect();
    let force = position.iter().map(|x| 3000.0 * x).collect();
    assert!(!is_named(&table(vec![
        column("time [s]", time),
        column("position [m]", position),
        column("force [N]", force),
    ])));
}
