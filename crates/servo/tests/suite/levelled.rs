//! Friction that depends on load, temperature and position, against closed forms and against the compensator's own words.

use stiction_friction::compensator::{
    Channel, Channels, Compensator, Friction, Input, Levels, Settings, Source, Terms, Wave,
};
use stiction_friction::{Held, Pace};
use stiction_servo::axis::AxisSettings;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::{Integrator, Mid};
use stiction_servo::known;
use stiction_servo::law::OfAxis;
use stiction_servo::levelled::{Depending, Depends, Levelled};
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::Sine;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_servo::run::run_with;
use stiction_servo::surroundings::Surroundings;

type Law = stiction_friction::LuGre<f64>;

fn law() -> Law {
    known::find("motor").unwrap().capped_law()
}

/// 20 % more a metre and 1 % less a kelvin, a wave of 3 % with a pitch of 20 mm, and half as much again of the load.
fn depends() -> Depends {
    let channel = |reference: f64, range: [f64; 2]| Channel {
        reference,
        range,
        turns: false,
    };
    let mut levels = Levels {
        load: [0.004, 0.005],
        temperature: [-0.01; 2],
        position: [0.2, 0.3],
        viscous: [-0.4; 2],
        quadratic: [11.0, -7.0],
        top_speed: 0.15,
        ..Levels::default()
    };
    for side in 0..2 {
        levels.waves[side][0] = Wave {
            rate: std::f64::consts::TAU / 20e-3,
            whole: true,
            sine: 0.03,
            cosine: 0.0,
        };
    }
    Depends {
        levels,
        channels: Channels {
            load: channel(100.0, [0.0, 200.0]),
            temperature: channel(300.0, [290.0, 320.0]),
            position: channel(0.5, [0.0, 1.0]),
            ..Channels::default()
        },
        surroundings: Surroundings {
            load: 150.0,
            temperature: 310.0,
            origin: 0.5,
        },
    }
}

/// In steady sliding the friction is level times Coulomb friction, and the viscous part, worked out by hand.
#[test]
fn a_sliding_axis_feels_the_level_of_its_place() {
    let law = law();
    let curve = *law.curve();
    let depends = depends();
    let mut axis = Depending::new(Mid::new(1).unwrap(), depends.clone());
    let plant = Plant::new(
        4.6,
        <Levelled<Law>>::of(&stiction_servo::law::AxisLaw::LuGre(law)).unwrap(),
    );
    let plant = plant.unwrap();
    for (v, side, slopes) in [(0.2, 0, [0.004, 0.2]), (-0.2, 1, [0.005, 0.3])] {
        let mut motion = Motion {
            position: -v * 0.5,
            velocity: v,
            deflection: 0.0,
        };
        let h = 1e-4;
        let mut force = 0.0;
        let mut known = 0.0;
        for _ in 0..5000 {
            let x = motion.position + 0.5 * h * motion.velocity;
            let level = 1.0 + slopes[0] * 50.0 - 0.01 * 10.0
                + slopes[1] * x
                + 0.03 * libm::sin(std::f64::consts::TAU * (0.5 + x) / 20e-3);
            let steady = if side == 0 { 1.0 } else { -1.0 };
            known = steady * level * curve.level(v)
                + (curve.direction(v).viscous - 0.4 * 10.0) * v
                // The speed is beyond that up to which viscous friction bends.
                + [11.0, -7.0][side] * 0.15 * v
                + curve.offset();
            // A drive that gives what friction is keeps the speed.
            let before = motion.velocity;
            motion = axis.advance(&plant, motion, h, Load::force(known), 0.0);
            force = known - 4.6 * (motion.velocity - before) / h;
            motion.velocity = v;
        }
        assert!((force / known - 1.0).abs() < 1e-6, "{v}: {force} {known}");
    }
}

/// Unchanged, it is the law that it has, bit for bit; the derivative of what a level adds agrees with differences.
#[test]
fn its_derivatives_are_those_of_its_force() {
    let law = law();
    let same = Levelled::unchanged(law);
    let depends = depends();
    let changes = depends
        .levels
        .changes(&depends.channels, [150.0, 310.0, 0.9], [30.0; 2]);
    let other = same.with_changes(changes);
    let pace = Pace {
        h: 1e-4,
        start: 2e-3,
        mass: 4.6,
    };
    for z in [-5e-6, -1e-7, 0.0, 2e-6, 6e-6] {
        for v in [-0.1, -1e-3, 1e-5, 2e-3, 0.3] {
            assert_eq!(
                same.mean_force_slope(z, &pace, v),
                law.mean_force_slope(z, &pace, v)
            );
            // What is added to the law: its own derivative is good enough for Newton's method only.
            let added = |v: f64| {
                let ([force, own], [slope, own_slope]) = {
                    let (a, b) = other.mean_force_slope(z, &pace, v);
                    let (c, d) = law.mean_force_slope(z, &pace, v);
                    ([a, c], [b, d])
                };
                (force - own, slope - own_slope)
            };
            let d = 1e-5 * v.abs();
            let slope = (added(v + d).0 - added(v - d).0) / (2.0 * d);
            let told = added(v).1;
            assert!(
                (told - slope).abs() < 1e-4 * slope.abs() + 1e-3,
                "{z} {v}: {told} {slope}"
            );
        }
    }
}

/// A compensator that is told load, temperature and position takes more of the error off than one that is not.
#[test]
fn a_compensator_that_is_told_does_better() {
    let axis = known::find("motor").unwrap();
    let depends = depends();
    let of = |told: Option<bool>| {
        let mut settings = axis.simulated(4000.0, 60.0).unwrap();
        let friction = Friction::LuGre(law());
        if let Some(told) = told {
            let bare = Settings::bare(1.0 / 4000.0, 200.0);
            let mut compensator = Compensator::new(friction, Source::Reference, bare).unwrap();
            if told {
                compensator = compensator
                    .with_terms(Terms {
                        channels: depends.channels,
                        levels: Some(depends.levels),
                        ..Terms::default()
                    })
                    .unwrap();
            }
            settings.feedforward = Feedforward {
                surroundings: told.then_some(depends.surroundings),
                ..Feedforward::compensator(compensator, settings.drive.preview(1.0 / 4000.0))
            };
        }
        let plant = settings.plant.mass();
        let settings = AxisSettings {
            plant: Plant::new(plant, Levelled::unchanged(law())).unwrap(),
            drive: settings.drive,
            encoder: settings.encoder,
            position_noise: settings.position_noise,
            cogging: settings.cogging,
            disturbance: settings.disturbance.clone(),
            controller: settings.controller,
            feedforward: settings.feedforward.clone(),
            rate: settings.rate,
            substeps: settings.substeps,
            seed: settings.seed,
        };
        let sine = Sine::new(0.2, 0.25, 2.0).unwrap();
        let moves = Depending::new(Mid::new(1).unwrap(), depends.clone());
        let samples = run_with(&settings, &sine, moves).unwrap();
        Tracking::of(&samples[samples.len() / 2..]).rms
    };
    let (none, untold, told) = (of(None), of(Some(false)), of(Some(true)));
    assert!(untold < 0.6 * none, "{none} {untold} {told}");
    assert!(told < 0.3 * untold, "{none} {untold} {told}");
}

/// What the axis feels is what the compensator gives: a compensator along the motion of the axis, with its own words.
#[test]
fn axis_and_compensator_mean_the_same() {
    let law = law();
    let depends = depends();
    let h = 1e-4;
    let bare = Settings::bare(h, 1e6);
    let friction = Friction::LuGre(law);
    let mut compensator = Compensator::new(friction, Source::Reference, bare)
        .unwrap()
        .with_terms(Terms {
            channels: depends.channels,
            levels: Some(depends.levels),
            ..Terms::default()
        })
        .unwrap()
        .running(&stiction_friction::compensator::Watch::default());
    let levelled = Levelled::unchanged(law);
    let (mut z, mut x) = (0.0, 0.0);
    for i in 0..40_000 {
        let t = f64::from(i) * h;
        let v = 0.1 * libm::sin(3.0 * t);
        let seen = depends.surroundings.seen(x);
        let curve = law.curve();
        let sigma2 = [curve.positive(), curve.negative()].map(|side| side.viscous);
        let now = levelled.with_changes(depends.levels.changes(&depends.channels, seen, sigma2));
        let to = now.hold(z, h, v);
        let [load, temperature, position] = seen;
        let told = compensator.step(Input {
            reference_velocity: v,
            enable: true,
            load,
            temperature,
            position,
            ..Input::default()
        });
        // The compensator gives the force at the end of the step, with the mean rate over it.
        let feels = now.mean_force(to, to, h, v) + law.micro_damping(v) * (to - z) / h;
        assert!((told - feels).abs() < 1e-9 * 40.0, "{i}: {told} {feels}");
        z = to;
        x += h * v;
    }
}
