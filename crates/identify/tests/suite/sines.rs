//! Slow sines alone: an axis that moves in presliding by what its controller answers to single counts.

use crate::common::closed_loop::{encoder, error, identified};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
use stiction_servo::path::{Path, Sine};
use stiction_servo::plant::Plant;

/// An axis, its encoder and controller.
struct Machine {
    mass: f64,
    stiffness: f64,
    damping: f64,
    side: Direction<f64>,
    count: f64,
    /// Bandwidth of the speed loop, Hz.
    bandwidth: f64,
    noise: f64,
}

/// By how many half-widths of its interval each parameter that is stated is off.
fn off(machine: &Machine, sine: Sine, seed: u64) -> Vec<(&'static str, f64)> {
    let Machine { mass, side, .. } = *machine;
    let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
    let law = LuGre::new(machine.stiffness, Damping::Constant(machine.damping), curve).unwrap();
    let log = ClosedLoop {
        plant: Plant::new(mass, law).unwrap(),
        controller: Cascade::tuned(mass, machine.bandwidth, 500.0).unwrap(),
        path: Path::new(vec![sine]).unwrap(),
        encoder: encoder(machine.count, seed),
        rate: 1000.0,
        substeps: 40,
        force_noise: machine.noise,
        force_log: ForceLog::Held,
        seed,
    }
    .run()
    .unwrap();
    let (_, found) = identified(&log, machine.count);
    let truth = [
        ("sigma0", machine.stiffness),
        ("sigma1", machine.damping),
        ("sigma2", side.viscous),
        ("coulomb", side.coulomb),
        ("static", side.static_friction),
        ("stribeck_velocity", side.stribeck_velocity),
        ("mass", mass),
    ];
    let stated = truth.into_iter().filter_map(|(name, truth)| {
        let p = found.parameter(name).unwrap();
        let (low, high) = p.ci95?;
        let widths = (truth - 0.5 * (low + high)) / (0.5 * (high - low));
        println!(
            "{seed} {name} {:.1} % {widths:.1} {}",
            error(p, truth).0,
            p.reason
        );
        p.identifiable.then_some((name, widths))
    });
    let stated = stated.collect();
    let of = |name| found.parameter(name).unwrap();
    if of("sigma1").reason.starts_with("held at zero") {
        // A fit that knew sigma1 to be zero would know sigma0 to 1 %.
        let relative = of("sigma0").std.unwrap() / of("sigma0").value;
        assert!(relative > 0.03, "{seed}: {relative}");
    }
    stated
}

/// Counts of a seventieth of the presliding travel and a stiff controller: micro-damping and mass come out up to twice too large
/// or a fifth, and what is not known is not stated.
#[test]
fn what_slow_sines_leave_open_is_not_stated() {
    let stage = Machine {
        mass: 8.0,
        stiffness: 3e5,
        damping: 800.0,
        side: Direction {
            coulomb: 15.0,
            static_friction: 22.0,
            stribeck_velocity: 4e-3,
            viscous: 40.0,
        },
        count: 1e-6,
        bandwidth: 60.0,
        noise: 0.3,
    };
    for seed in 1..=3 {
        let stated = off(&stage, Sine::new(0.0126, 0.1, 30.0), seed);
        assert!(stated.len() >= 3, "{stated:?}");
        for (name, widths) in stated {
            assert!(widths.abs() < 2.0, "{seed}: {name} {widths}");
        }
    }
}

/// The same on a ball screw, where the micro-damping is pressed to zero or hardly known.
#[test]
fn a_micro_damping_at_zero_is_not_taken_for_known() {
    let screw = Machine {
        mass: 60.0,
        stiffness: 4e6,
        damping: 9e3,
        side: Direction {
            coulomb: 90.0,
            static_friction: 125.0,
            stribeck_velocity: 3e-3,
            viscous: 600.0,
        },
        count: 1e-6,
        bandwidth: 50.0,
        noise: 1.5,
    };
    for seed in 1..=3 {
        let stated = off(&screw, Sine::new(0.0283, 0.3, 26.0), seed);
        assert!(stated.len() >= 4, "{stated:?}");
        for (name, widths) in stated {
            assert!(widths.abs() < 3.0, "{seed}: {name} {widths}");
        }
    }
}
