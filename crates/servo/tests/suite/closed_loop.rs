//! The closed loop: it tracks, its channels are what they say, and a seed fixes every bit.

use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
use stiction_servo::encoder::Encoder;
use stiction_servo::known;
use stiction_servo::path::{Path, Reference};
use stiction_servo::plant::Plant;

fn setup(name: &str) -> ClosedLoop {
    let axis = known::find(name).unwrap();
    ClosedLoop {
        plant: Plant::new(axis.mass, axis.law).unwrap(),
        controller: Cascade::tuned(axis.mass, 60.0, 1000.0).unwrap(),
        path: Path::three_segments(0.196, 9.0).unwrap(),
        encoder: Encoder::new(50e-9).unwrap(),
        rate: 4000.0,
        substeps: 5,
        force_noise: 0.2,
        force_log: ForceLog::Centred,
        seed: 1,
    }
}

fn rms(x: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = x.fold((0.0, 0.0), |(s, n), x| (s + x * x, n + 1.0));
    f64::sqrt(sum / n)
}

/// The loop's dynamic stiffness |D(j omega)|, N/m: with perfect acceleration feedforward friction is the only disturbance.
fn dynamic_stiffness(c: &Cascade, mass: f64, omega: f64) -> f64 {
    let (kv, kp, ki) = (c.speed_gain, c.position_gain, c.integral_gain);
    let real = kv * kp + ki - mass * omega * omega;
    let imaginary = omega * kv - ki * kp / omega;
    (real * real + imaginary * imaginary).sqrt()
}

#[test]
fn machine_and_motor_track_their_reference() {
    for name in ["machine", "motor"] {
        let setup = setup(name);
        let r = setup.run().unwrap();
        assert_eq!(r.time.len(), 36_001);
        let error =
            |part: std::ops::Range<usize>| rms(part.map(|k| r.reference[k] - r.truth.position[k]));
        let parts = [
            error(0..12_000),
            error(12_000..24_000),
            error(24_000..36_000),
        ];
        println!("{name}: errors {:.2?} um rms", parts.map(|e| 1e6 * e));
        assert!(parts.iter().all(|e| *e < 50e-6), "{name}: {parts:?}");

        // The 28 Hz parts of friction and error over one second, both from the truth, in the ratio that the gains give.
        let omega = 2.0 * std::f64::consts::PI * 28.0;
        let part = |x: &dyn Fn(usize) -> f64| {
            let (mut c, mut s) = (0.0, 0.0);
            for k in 28_000..32_000 {
                c += x(k) * (omega * r.time[k]).cos();
                s += x(k) * (omega * r.time[k]).sin();
            }
            c.hypot(s)
        };
        let lag = part(&|k| r.reference[k] - r.truth.position[k]);
        let stiffness = part(&|k| r.truth.friction[k]) / lag;
        let expected = dynamic_stiffness(&setup.controller, setup.plant.mass(), omega);
        assert!(
            (stiffness / expected - 1.0).abs() < 0.05,
            "{name}: {stiffness} {expected} N/m"
        );

        let fastest = r
            .truth
            .velocity
            .iter()
            .fold(0.0, |m: f64, v| m.max(v.abs()));
        assert!((fastest / 0.196 - 1.0).abs() < 0.05, "{name}: {fastest}");
        let bound = setup.plant.law().bound();
        assert!(r.truth.deflection.iter().all(|z| z.abs() <= bound));
    }
}

#[test]
fn channels_are_what_they_say() {
    let mut loop_ = setup("machine");
    let r = loop_.run().unwrap();
    for (measured, truth) in r.position.iter().zip(&r.truth.position) {
        assert!((measured - truth).abs() <= 25.0e-9 * (1.0 + 1e-6));
        let counts = measured / 50e-9;
        assert!((counts - counts.round()).abs() < 1e-6);
    }
    for k in 0..r.time.len() {
        assert_eq!(r.time[k], k as f64 / 4000.0);
    }
    let noise = rms(r.force.iter().zip(&r.truth.force).map(|(f, t)| f - t));
    assert!((noise / 0.2 - 1.0).abs() < 0.02, "noise {noise}");

    // The log's kind changes the log and nothing else.
    loop_.force_log = ForceLog::Held;
    let held = loop_.run().unwrap();
    assert_eq!(held.position, r.position);
    assert_eq!(held.truth.force, held.force_command);
    assert_ne!(held.force, r.force);
}

/// Without friction the second difference of the position is the mean acceleration around the sample: the centred log
/// agrees with it exactly, the held one is half a sample off.
#[test]
fn centred_force_is_aligned_with_the_position() {
    let both = Direction {
        coulomb: 1e-12,
        static_friction: 1e-12,
        stribeck_velocity: 1e-3,
        viscous: 0.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
    let law = LuGre::new(1e-3, Damping::Constant(0.0), curve).unwrap();
    let mass = 10.0;
    let off = |force_log| {
        let run = ClosedLoop {
            plant: Plant::new(mass, law).unwrap(),
            force_log,
            ..setup("machine")
        };
        let r = run.run().unwrap();
        let (x, h) = (&r.truth.position, 1.0 / 4000.0);
        let residual = rms((1..x.len() - 1)
            .map(|k| mass * (x[k + 1] - 2.0 * x[k] + x[k - 1]) / (h * h) - r.truth.force[k]));
        residual / rms(r.truth.force.iter().copied())
    };
    let (centred, held) = (off(ForceLog::Centred), off(ForceLog::Held));
    assert!(centred < 1e-6, "centred {centred}");
    assert!(held > 1e3 * centred, "held {held}");
}

#[test]
fn a_seed_fixes_every_bit() {
    let first = setup("motor");
    let again = first.run().unwrap();
    assert_eq!(first.run().unwrap(), again);
    let other = ClosedLoop { seed: 2, ..first }.run().unwrap();
    assert_eq!(other.truth, again.truth, "noise is on the log only");
    assert_ne!(other.force, again.force);
}

/// Halving the plant's step hardly changes the run: the simulation, not its step, is what is recorded.
#[test]
fn plant_steps_are_small_enough() {
    let mut coarse = setup("motor");
    coarse.encoder = Encoder::new(0.0).unwrap();
    let fine = ClosedLoop {
        substeps: 20,
        ..coarse.clone()
    };
    let (a, b) = (coarse.run().unwrap(), fine.run().unwrap());
    let moved = rms(a
        .truth
        .position
        .iter()
        .zip(&b.truth.position)
        .map(|(a, b)| a - b));
    assert!(moved < 2e-9, "{moved}");
}

#[test]
fn the_force_limit_holds_and_does_not_wind_up() {
    let mut loop_ = setup("machine");
    loop_.controller.force_limit = 25.0; // Below break-away: the axis cannot follow.
    let r = loop_.run().unwrap();
    assert!(r.force_command.iter().all(|u| u.abs() <= 25.0));

    // A step far beyond the limit for a second, then no error: the integral holds no more than before it.
    let c = Cascade::tuned(10.0, 60.0, 100.0).unwrap();
    let mut state = CascadeState::default();
    let far = Reference {
        position: 1.0,
        ..Reference::default()
    };
    for _ in 0..4000 {
        assert_eq!(c.force(&mut state, 250e-6, far, 0.0), 100.0);
    }
    assert_eq!(c.force(&mut state, 250e-6, Reference::default(), 0.0), 0.0);
}

#[test]
fn settings_out_of_range_are_named() {
    let good = setup("machine");
    let name = |l: ClosedLoop| l.run().unwrap_err().name;
    assert_eq!(
        name(ClosedLoop {
            rate: 0.0,
            ..good.clone()
        }),
        "rate"
    );
    assert_eq!(
        name(ClosedLoop {
            rate: 1e9,
            ..good.clone()
        }),
        "samples"
    );
    assert_eq!(
        name(ClosedLoop {
            substeps: 0,
            ..good.clone()
        }),
        "substeps"
    );
    assert_eq!(
        name(ClosedLoop {
            force_noise: f64::NAN,
            ..good.clone()
        }),
        "force_noise"
    );
    let controller = Cascade {
        force_limit: 0.0,
        ..good.controller
    };
    assert_eq!(name(ClosedLoop { controller, ..good }), "force_limit");
}
