//! PID and fuzzy PID in the loop: what linear theory says of the axis without friction, what the rules do to it, and what
//! holds with friction.

use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_servo::axis::{Axis, AxisSettings, Correction, Sample};
use stiction_servo::controller::Controller;
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::fuzzy::FuzzyPid;
use stiction_servo::integrator::Mid;
use stiction_servo::known;
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::Sine;
use stiction_servo::path::Reference;
use stiction_servo::pid::Pid;
use stiction_servo::plant::Plant;
use stiction_servo::run::run;

const MASS: f64 = 4.6;
const BANDWIDTH: f64 = 30.0;
const RATE: f64 = 20_000.0;
const SAMPLES: usize = 10_000;

fn free(controller: Controller) -> AxisSettings {
    let none = Direction {
        coulomb: 1e-12,
        static_friction: 1e-12,
        stribeck_velocity: 1e-3,
        viscous: 0.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, none, 0.0).unwrap();
    let law = LuGre::new(1e-9, Damping::Constant(0.0), curve).unwrap();
    AxisSettings {
        plant: Plant::new(MASS, law).unwrap(),
        drive: Drive::ideal(),
        encoder: Encoder::new(0.0).unwrap(),
        controller,
        substeps: 1,
        ..known::find("motor").unwrap().simulated(RATE, 60.0).unwrap()
    }
}

/// Positions after a step of the reference of `size`, m, for .5 s.
fn step(controller: Controller, size: f64) -> Vec<f64> {
    let mut axis = Axis::new(free(controller), Mid::new(1).unwrap()).unwrap();
    let target = Reference {
        position: size,
        ..Reference::default()
    };
    let samples = (0..SAMPLES).map(|_| axis.step(target, 0.0, Correction::default()));
    samples.map(|s: Sample| s.position).collect()
}

/// The closed loop of a free mass and a PID without filter as differential equations, by Runge-Kutta at a hundredth of a
/// control period: M x'' = Kp (r - x) + Ki int(r - x) - Kd x'.
fn linear(pid: &Pid, size: f64) -> Vec<f64> {
    let h = 1.0 / RATE / 10.0;
    let rates = |y: [f64; 3]| {
        let e = size - y[0];
        let force = pid.proportional * e + pid.integral * y[2] - pid.derivative * y[1];
        [y[1], force / MASS, e]
    };
    let along = |y: [f64; 3], k: [f64; 3], h: f64| [0, 1, 2].map(|i| y[i] + h * k[i]);
    let mut y = [0.0; 3];
    (0..SAMPLES)
        .map(|_| {
            let now = y[0];
            for _ in 0..10 {
                let k1 = rates(y);
                let k2 = rates(along(y, k1, 0.5 * h));
                let k3 = rates(along(y, k2, 0.5 * h));
                let k4 = rates(along(y, k3, h));
                y = [0, 1, 2].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
            }
            now
        })
        .collect()
}

#[test]
fn a_pid_moves_a_free_mass_as_linear_theory_says() {
    let pid = Pid {
        filter: 0.0,
        ..Pid::tuned(MASS, BANDWIDTH, 1e6).unwrap()
    };
    let expected = linear(&pid, 1e-3);
    let off = |rate_scale: f64| {
        let found = step(Controller::Pid(pid), 1e-3 * rate_scale);
        let pairs = found.iter().zip(&expected);
        pairs.fold(0.0_f64, |m, (a, b)| m.max((a / rate_scale - b).abs())) / 1e-3
    };
    // Held over a period of a hundredth of the loop's time constant.
    let off_by = off(1.0);
    println!("PID: off by {:.2} % of the step", 100.0 * off_by);
    assert!(off_by < 0.02, "{off_by}");
    assert!((off(10.0) - off_by).abs() < 1e-9, "the loop is linear");
    let overshoot = expected.iter().fold(0.0_f64, |m, x| m.max(*x)) / 1e-3 - 1.0;
    assert!((0.05..0.4).contains(&overshoot), "{overshoot}");
    assert!((expected[SAMPLES - 1] / 1e-3 - 1.0).abs() < 1e-3);
}

/// With rules that may change nothing it is the PID, bit for bit; with all that they may change, it is another loop, still
/// at rest at its target.
#[test]
fn a_fuzzy_pid_without_range_is_the_pid() {
    let fuzzy = FuzzyPid::tuned(MASS, BANDWIDTH, 1e6, 18.0).unwrap();
    let none = FuzzyPid {
        range: 0.0,
        ..fuzzy
    };
    let plain = step(Controller::Pid(fuzzy.base), 1e-3);
    assert_eq!(step(Controller::Fuzzy(none), 1e-3), plain);
    for range in [0.3, 0.9] {
        let moved = step(Controller::Fuzzy(FuzzyPid { range, ..fuzzy }), 1e-3);
        assert!(moved.iter().zip(&plain).any(|(a, b)| (a - b).abs() > 1e-5));
        assert!((moved[SAMPLES - 1] / 1e-3 - 1.0).abs() < 1e-3, "{range}");
    }
}

/// With friction, under the stage's drive: both have the stiffness of the cascade, so the same error where friction turns
/// round, and neither goes beyond the limit of its force.
#[test]
fn both_track_with_friction() {
    let axis = known::find("motor").unwrap();
    let with = |controller| {
        let settings = AxisSettings {
            controller,
            ..axis.simulated(4000.0, 60.0).unwrap()
        };
        let samples = run(&settings, &Sine::new(5e-3, 0.5, 4.0).unwrap()).unwrap();
        let most = samples.iter().fold(0.0_f64, |m, s| m.max(s.command.abs()));
        assert!(most <= 25.0, "{most} N");
        Tracking::of(&samples[samples.len() / 2..])
    };
    let plain = with(Controller::Pid(Pid::tuned(axis.mass, 60.0, 25.0).unwrap()));
    let fuzzy = FuzzyPid::tuned(axis.mass, 60.0, 25.0, 18.0).unwrap();
    let fuzzy = with(Controller::Fuzzy(fuzzy));
    println!(
        "reversal peak: PID {:.1} um, fuzzy {:.1} um",
        1e6 * plain.reversal_peak,
        1e6 * fuzzy.reversal_peak
    );
    // The cascade of that bandwidth, by an independent prototype.
    for tracking in [plain, fuzzy] {
        let off = tracking.reversal_peak / 58.5e-6 - 1.0;
        assert!(off.abs() < 0.05, "{tracking:?}");
    }
}
