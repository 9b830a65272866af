//! Factors on friction that are found while the axis runs: against an axis whose force is known in closed form.

use crate::common::lopsided;
use stiction_friction::compensator::{
    Adaptation, Compensator, Friction, Input, Settings, Source, Watchdog,
};
use stiction_friction::{Damping, LuGre, Shape};

const H: f64 = 1e-3;
const MASS: f64 = 4.0;

/// An axis that follows its reference exactly, with a level, viscous friction and a mass other than those that were identified.
struct Sliding {
    law: LuGre<f64>,
    state: stiction_friction::State<f64>,
    level: f64,
    viscous: f64,
    mass: f64,
    /// Velocities of the two samples before.
    velocity: [f64; 2],
    /// Friction at the sample before.
    friction: f64,
}

impl Sliding {
    fn new(level: f64, viscous: f64, mass: f64) -> Self {
        let law = lopsided(Shape::Gaussian, Damping::Capped(600.0));
        Sliding {
            state: law.rest(),
            law,
            level,
            viscous,
            mass,
            velocity: [0.0; 2],
            friction: 0.0,
        }
    }

    /// The command that was given at the sample before this velocity.
    fn force(&mut self, v: f64) -> f64 {
        let offset = self.law.curve().offset();
        let a = (v - self.velocity[1]) / (2.0 * H);
        let command = self.friction + self.mass * a;
        let viscous = self.law.curve().direction(v).viscous * v;
        let dry = self.law.step(&mut self.state, H, v) - offset - viscous;
        self.friction = offset + self.level * dry + self.viscous * viscous;
        self.velocity = [v, self.velocity[0]];
        command
    }

    fn compensator(&self) -> Compensator<f64> {
        let settings = Settings {
            adaptation: Some(Adaptation {
                mass: MASS,
                ..Adaptation::default()
            }),
            ..Settings::bare(H, 1e3)
        };
        Compensator::new(Friction::LuGre(self.law), Source::Reference, settings).unwrap()
    }
}

/// Forward and back, 0.4 s each way.
fn velocity(k: usize) -> f64 {
    0.1 * libm::sin(std::f64::consts::PI * k as f64 / 400.0)
}

fn input(v: f64, drive_force: f64) -> Input<f64> {
    Input {
        reference_velocity: v,
        enable: true,
        drive_force,
        learn: true,
        ..Input::default()
    }
}

fn error(found: f64, truth: f64) -> f64 {
    (found / truth - 1.0).abs()
}

/// The level is within 3 % after twenty reversals and 1 % for good, viscous friction within 3 % and the mass within 10 %. No
/// closer: viscous friction and mass are held a little.
#[test]
fn factors_and_mass_are_found() {
    for (level, viscous, mass) in [
        (0.6, 0.6, MASS),
        (1.4, 0.7, MASS),
        (1.3, 1.4, 7.0),
        (1.0, 1.0, 2.0),
    ] {
        let mut axis = Sliding::new(level, viscous, mass);
        let mut compensator = axis.compensator();
        for k in 0..80_000 {
            let v = velocity(k);
            compensator.step(input(v, axis.force(v)));
            let learnt = &compensator.state().learnt;
            if k == 8000 {
                assert!(error(learnt.level, level) < 0.03, "{learnt:?}");
            }
        }
        let learnt = &compensator.state().learnt;
        assert!(error(learnt.level, level) < 0.01, "{learnt:?}");
        assert!(error(learnt.viscous, viscous) < 0.03, "{learnt:?}");
        assert!(error(learnt.mass, mass) < 0.1, "{learnt:?}");
    }
}

/// The force is that of the axis, while it slides either way, but for what holds viscous friction and mass.
#[test]
fn the_force_has_the_factors() {
    let mut axis = Sliding::new(1.3, 1.2, MASS);
    let mut compensator = axis.compensator();
    for k in 0..40_000 {
        let v = velocity(k);
        let command = axis.force(v);
        let force = compensator.step(input(v, command));
        if k > 20_000 && v.abs() > 0.05 {
            let friction = axis.friction;
            assert!(
                (force - friction).abs() < 2e-3 * friction.abs(),
                "{k} {force} {friction}"
            );
        }
    }
}

/// Exactly those samples are learnt from that the axis slides in: what stands in the way keeps the factors bit for bit.
#[test]
fn nothing_is_learnt_where_the_force_says_nothing() {
    type Change = fn(&mut Input<f64>, usize);
    let changes: [(&str, Change); 4] = [
        ("not asked", |i, _| i.learn = false),
        ("at rest", |i, _| i.reference_velocity = 0.0),
        ("not a number", |i, _| i.drive_force = f64::NAN),
        // The error grows as the reference moves: the axis sticks.
        ("stuck", |i, k| {
            i.tracking_error = 0.1 * H * (0..=k).map(|k| velocity(k) / 0.1).sum::<f64>();
        }),
    ];
    for (name, change) in changes {
        let mut axis = Sliding::new(0.6, 0.6, MASS);
        let mut compensator = axis.compensator();
        for k in 0..3000 {
            let v = velocity(k);
            let mut input = input(v, axis.force(v));
            change(&mut input, k);
            compensator.step(input);
        }
        let learnt = &compensator.state().learnt;
        assert_eq!([learnt.level, learnt.viscous], [1.0; 2], "{name}");
    }
    // At the limit of the force.
    let mut axis = Sliding::new(0.6, 0.6, MASS);
    let mut compensator = axis.compensator();
    compensator.set_limit(1e-3).unwrap();
    for k in 0..3000 {
        let v = velocity(k);
        compensator.step(input(v, axis.force(v)));
    }
    assert!(error(compensator.state().learnt.level, 1.0) < 0.02);
    // After the watchdog has switched off.
    let settings = Settings {
        watchdog: Some(Watchdog {
            window: 0.4,
            ratio: 1.0,
        }),
        ..*axis.compensator().settings()
    };
    let mut compensator =
        Compensator::new(Friction::LuGre(axis.law), Source::Reference, settings).unwrap();
    let mut tripped = None;
    for k in 0..40_000 {
        let v = velocity(k);
        let error = if k < 15_000 { 1e-6 } else { 1e-4 };
        let mut sample = input(v, axis.force(v));
        sample.tracking_error = error;
        compensator.step(sample);
        if compensator.state().watch.tripped() && tripped.is_none() {
            tripped = Some(compensator.state().learnt.level);
            axis.level = 1.4;
        }
    }
    assert_eq!(Some(compensator.state().learnt.level), tripped);
}

/// A force in the wrong unit or direction, or a single sample that is wild, keeps the levels in their range; after the one
/// sample they come back.
#[test]
fn levels_keep_their_range() {
    for factor in [-1.0, 1e3, 1e-3, 0.0, -1e300] {
        let mut axis = Sliding::new(1.0, 1.0, MASS);
        let mut compensator = axis.compensator();
        for k in 0..20_000 {
            let v = velocity(k);
            compensator.step(input(v, factor * axis.force(v)));
            let learnt = &compensator.state().learnt;
            let found = [learnt.level, learnt.viscous];
            assert!(found.iter().all(|factor| (0.5..=1.5).contains(factor)));
        }
    }
    let mut axis = Sliding::new(1.0, 1.0, MASS);
    let mut compensator = axis.compensator();
    let mut most = 0.0_f64;
    for k in 0..20_000 {
        let v = velocity(k);
        let due = axis.force(v);
        let wild = if k == 10_200 { 1e6 } else { due };
        compensator.step(input(v, wild));
        most = most.max(error(compensator.state().learnt.level, 1.0));
    }
    // One sample of 250 in memory, as if twice the friction.
    assert!(most < 0.01, "{most}");
    assert!(error(compensator.state().learnt.level, 1.0) < 1e-4);
}
