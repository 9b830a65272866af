//! The load found while running: how well, how fast, and that it stands still without excitation.

use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
use stiction_friction::{Direction, LuGre, Stribeck};
use stiction_servo::axis::{Axis, AxisSettings, Correction, Sample};
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::Mid;
use stiction_servo::known;
use stiction_servo::load::{Load, LoadEstimator, LoadSettings};
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::{Limits, Moves, Sine};
use stiction_servo::trajectory::{Lookahead, Trajectory};

const RATE: f64 = 4000.0;

fn settings() -> AxisSettings {
    let axis = known::find("motor").unwrap();
    AxisSettings {
        position_noise: 20e-9,
        ..axis.simulated(RATE, 60.0).unwrap()
    }
}

/// The law with its whole friction scaled.
fn scaled(law: &LuGre<f64>, by: f64) -> LuGre<f64> {
    let side = law.curve().positive();
    let side = Direction {
        coulomb: by * side.coulomb,
        static_friction: by * side.static_friction,
        viscous: by * side.viscous,
        ..*side
    };
    let curve = Stribeck::symmetric(law.curve().shape(), side, 0.0).unwrap();
    let damping = match law.damping() {
        stiction_friction::Damping::Capped(s1) => stiction_friction::Damping::Capped(by * s1),
        other => other,
    };
    LuGre::new(by * law.stiffness(), damping, curve).unwrap()
}

/// Runs with a load that changes at `change`, s; feeds the estimate to the axis if asked to.
fn run(
    settings: &AxisSettings,
    trajectory: &impl Trajectory,
    change: (f64, f64, f64),
    feed: bool,
) -> Vec<(Sample, Load)> {
    let law = *settings.plant.law();
    let mut estimator =
        LoadEstimator::new(law, 4.6, settings.drive, RATE, LoadSettings::default()).unwrap();
    let mut axis = Axis::new(settings.clone(), Mid::new(1).unwrap()).unwrap();
    let mut reference = Lookahead::new(trajectory, RATE, settings.feedforward.preview);
    let (at, mass, level) = change;
    (0..(trajectory.duration() * RATE) as usize)
        .map(|k| {
            if k == (at * RATE) as usize {
                axis.set_mass(mass).unwrap();
                axis.set_law(scaled(&law, level));
            }
            let (now, ahead) = reference.sample();
            let sample = axis.step(now, ahead, Correction::default());
            let load = estimator.sample(sample.measured, sample.command);
            if feed {
                axis.set_mass_feedforward(load.mass).unwrap();
                axis.set_friction_level(load.level);
            }
            (sample, load)
        })
        .collect()
}

#[test]
fn mass_and_level_after_a_change_of_load() {
    let motion = Sine::new(20e-3, 1.5, 9.0).unwrap();
    for (mass, level) in [(6.9, 1.0), (9.2, 1.0), (4.6, 1.2), (4.6, 1.5), (6.9, 1.3)] {
        let all = run(&settings(), &motion, (3.0, mass, level), false);
        let before = all[11_999].1;
        assert!((before.mass / 4.6 - 1.0).abs() < 0.02, "{before:?}");
        // Settled: from then on within 5 %.
        let late = all
            .iter()
            .rposition(|(_, l)| (l.mass / mass - 1.0).abs() > 0.05);
        let settled = late.map_or(0.0, |k| all[k].0.time - 3.0);
        let tail = &all[18_000..];
        let worst = tail
            .iter()
            .fold(0.0_f64, |m, (_, l)| m.max((l.mass / mass - 1.0).abs()));
        let worst_level = tail
            .iter()
            .fold(0.0_f64, |m, (_, l)| m.max((l.level / level - 1.0).abs()));
        println!(
            "{mass} kg, level {level}: within {:.2} % and {:.2} %, settled in {settled:.3} s",
            100.0 * worst,
            100.0 * worst_level
        );
        assert!(worst < 0.02 && worst_level < 0.02);
        assert!(settled <= 0.6);
    }
}

/// At a standstill between moves, and along a constant speed, nothing is learnt: the estimate keeps its bits.
#[test]
fn frozen_without_excitation() {
    let limits = Limits {
        velocity: 0.1,
        acceleration: 3.0,
        jerk: 300.0,
    };
    let motion = Moves::there_and_back(0.3, 3.0, limits).unwrap();
    let all = run(&settings(), &motion, (1e3, 4.6, 1.0), false);
    let frozen = |from: f64, to: f64| {
        let part = &all[(from * RATE) as usize..(to * RATE) as usize];
        part.windows(2).all(|pair| pair[0].1 == pair[1].1)
    };
    // The move takes 3.04 s; its ramps end at .04 and begin at 3 s.
    assert!(frozen(2.0, 2.9) && frozen(5.0, 6.0));
    assert!(!frozen(0.0, 0.2) && !frozen(6.0, 6.3));
    let last = all[all.len() - 1].1;
    println!("{last:?}");
    assert!((last.mass / 4.6 - 1.0).abs() < 0.05, "{last:?}");
}

/// With the estimate fed to feedforward and compensator a changed load tracks nearly as the nominal one did.
#[test]
fn the_estimate_feeds_the_compensation() {
    let mut axis = settings();
    let compensator = Compensator::new(
        Friction::LuGre(*axis.plant.law()),
        Source::Reference,
        Settings::bare(1.0 / RATE, 200.0),
    );
    axis.feedforward =
        Feedforward::compensator(compensator.unwrap(), axis.drive.preview(1.0 / RATE));
    let motion = Sine::new(20e-3, 1.5, 9.0).unwrap();
    let rms = |change, feed| {
        let all = run(&axis, &motion, change, feed);
        let tail: Vec<Sample> = all[16_000..].iter().map(|(s, _)| *s).collect();
        Tracking::of(&tail).rms
    };
    let nominal = rms((1e3, 4.6, 1.0), false);
    let changed = rms((3.0, 6.9, 1.4), false);
    let fed = rms((3.0, 6.9, 1.4), true);
    println!("rms {nominal:.2e} m, changed {changed:.2e}, with the estimate {fed:.2e}");
    // Nearly all that the change does is taken away; what is left is of the size of the encoder's step.
    assert!(changed > 3.0 * nominal && fed < 0.01 * changed && fed < 1e-7);
}

#[test]
fn bad_samples_are_passed_over() {
    let axis = settings();
    let law = *axis.plant.law();
    let new = || LoadEstimator::new(law, 4.6, axis.drive, RATE, LoadSettings::default()).unwrap();
    let mut estimator = new();
    assert_eq!(
        estimator.sample(f64::NAN, 1.0),
        estimator.sample(0.0, f64::INFINITY)
    );
    let wrong = LoadSettings {
        memory: 0.0,
        ..LoadSettings::default()
    };
    let name = LoadEstimator::new(law, 4.6, axis.drive, RATE, wrong)
        .unwrap_err()
        .name;
    assert_eq!(name, "memory");
}
