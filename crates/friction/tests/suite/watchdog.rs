//! The watchdog among faults of the measurement: a mass with friction under a cascade of a position and a speed loop.

use crate::common::direction;
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::PI;
use stiction_friction::compensator::{Compensator, Friction, Input, Settings, Source, Watchdog};
use stiction_friction::{Damping, LuGre, Shape, State, Stribeck};

/// Cycle of the controller, s; the plant takes four steps in it.
const H: f64 = 1e-3;
const MASS: f64 = 4.6;

/// What an encoder or a bus does to the error, once.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// The error is this much larger for so many samples.
    Burst(f64, usize),
    /// It is not a number.
    Lost(usize),
}

/// A run: the axis, its motion, and what goes wrong.
#[derive(Clone, Debug)]
struct Case {
    law: LuGre<f64>,
    amplitude: f64,
    frequency: f64,
    /// Share of the force that arrives: 1 is right.
    factor: f64,
    gain: f64,
    /// Resolution of the encoder, m.
    count: f64,
    faults: Vec<(usize, Fault)>,
}

fn law() -> LuGre<f64> {
    let curve =
        Stribeck::symmetric(Shape::Gaussian, direction(12.0, 18.0, 3e-3, 30.0), 0.0).unwrap();
    LuGre::new(2e6, Damping::Capped(1.5e3), curve).unwrap()
}

impl Case {
    /// With a static friction of up to twice the Coulomb level: beyond, the axis hunts with the exact force too, and is worse
    /// for it.
    fn random(factor: f64, random: &mut impl Rng) -> Self {
        let curve = Stribeck::symmetric(
            Shape::Gaussian,
            direction(random.random_range(9.0..16.0), 18.0, 3e-3, 30.0),
            0.0,
        );
        Case {
            law: LuGre::new(2e6, Damping::Capped(1.5e3), curve.unwrap()).unwrap(),
            amplitude: 1e-3 * 10f64.powf(random.random_range(0.0..1.0)),
            frequency: random.random_range(0.3..1.0),
            factor,
            gain: 1.0,
            count: 10f64.powf(random.random_range(-9.0..-7.0)),
            faults: Vec::new(),
        }
    }

    /// Samples of a window: the least even number of strokes that takes the window's time.
    fn window(&self) -> usize {
        let strokes = 2.0 * (Watchdog::<f64>::default().window * self.frequency).ceil();
        (0.5 * strokes / self.frequency / H) as usize + 1
    }

    /// When the watchdog had learnt, and when it tripped.
    fn run(&self, samples: usize) -> Outcome {
        let settings = Settings {
            gain: self.gain,
            ..Settings::for_law(&Friction::LuGre(self.law), H)
        };
        let mut compensator =
            Compensator::new(Friction::LuGre(self.law), Source::Reference, settings).unwrap();
        let (mut x, mut v, mut state) = (0.0, 0.0, State { z: 0.0, force: 0.0 });
        let (mut integral, mut force) = (0.0, 0.0);
        let mut outcome = Outcome::default();
        let speed = MASS * 2.0 * PI * 40.0;
        for k in 0..samples {
            let t = k as f64 * H;
            let w = 2.0 * PI * self.frequency;
            let wanted = self.amplitude * (1.0 - (w * t).cos());
            let reference = self.amplitude * w * (w * t).sin();
            let measured = (x / self.count).round() * self.count;
            let error = wanted - measured;
            let slip = reference + 2.0 * PI * 10.0 * error - v;
            integral += H * slip * 2.0 * PI * 10.0;
            let command = speed * (slip + integral);
            for _ in 0..4 {
                let h = 0.25 * H;
                let friction = self.law.step(&mut state, h, v);
                v += h * (command + self.factor * force - friction) / MASS;
                x += h * v;
            }
            let seen = self.faults.iter().fold(error, |seen, (at, fault)| {
                let since = k.checked_sub(*at);
                match (fault, since) {
                    (Fault::Burst(size, n), Some(since)) if since < *n => seen + size,
                    (Fault::Lost(n), Some(since)) if since < *n => f64::NAN,
                    _ => seen,
                }
            });
            force = compensator.step(Input {
                // Of the cycle in which the force will act.
                reference_velocity: self.amplitude * w * (w * (t + H)).sin(),
                measured_velocity: v,
                tracking_error: seen,
                enable: true,
                ..Input::default()
            });
            let watch = &compensator.state().watch;
            if watch.learned() {
                outcome.learnt.get_or_insert(k);
            }
            if watch.tripped() {
                outcome.tripped.get_or_insert(k);
                break;
            }
        }
        outcome
    }
}

/// The samples at which that was.
#[derive(Clone, Copy, Debug, Default)]
struct Outcome {
    learnt: Option<usize>,
    tripped: Option<usize>,
}

/// One fault while it learns and one after, of every kind that an encoder or a bus has.
fn faults(window: usize, random: &mut impl Rng) -> Vec<(usize, Fault)> {
    let mut any = |from: usize, to: usize| {
        let at = random.random_range(from..to);
        let size = 10f64.powf(random.random_range(-5.0..0.0));
        let fault = match random.random_range(0..4) {
            0 => Fault::Burst(size, 1),
            1 => Fault::Burst(-size, 1),
            2 => Fault::Burst(size, random.random_range(2..40)),
            _ => Fault::Lost(random.random_range(1..40)),
        };
        (at, fault)
    };
    vec![any(0, 5 * window), any(6 * window, 10 * window)]
}

fn among_faults(runs: u64, from: u64) {
    let mut latest = 0.0_f64;
    for seed in from..from + runs {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let factor = [1.0, -1.0, 2.0][(seed % 3) as usize];
        let mut case = Case::random(factor, &mut random);
        let samples = 14 * case.window();
        case.faults = faults(case.window(), &mut random);
        let found = case.run(samples);
        let learnt = found.learnt.unwrap_or_else(|| panic!("{seed}: {case:?}"));
        if factor == 1.0 {
            assert!(found.tripped.is_none(), "{seed}: {case:?} {found:?}");
            continue;
        }
        let tripped = found
            .tripped
            .unwrap_or_else(|| panic!("{seed}: never; {case:?}"));
        // A lost sample lets the force fade, and it comes in anew.
        let since = case.faults.iter().filter_map(|(at, fault)| match fault {
            Fault::Lost(n) if (learnt..tripped).contains(at) => Some(at + n),
            _ => None,
        });
        let since = since.max().unwrap_or(learnt);
        latest = latest.max((tripped - since) as f64 / case.window() as f64);
    }
    println!("{runs} runs: trips at the latest {latest:.2} windows after the force comes in");
    // The stroke in which it comes in, the window that is not judged, and the one that is.
    assert!(latest <= 2.5, "{latest}");
}

#[test]
fn faults_neither_blind_nor_trip() {
    among_faults(300, 0);
}

#[test]
#[ignore = "soak: faults_neither_blind_nor_trip with more seeds"]
fn faults_neither_blind_nor_trip_long() {
    among_faults(10_000, 1_000_000);
}

/// One bad sample while it learns: it trips as without.
#[test]
fn one_bad_sample_does_not_blind_it() {
    let clean = Case {
        law: law(),
        amplitude: 5e-3,
        frequency: 0.5,
        factor: -1.0,
        gain: 0.75,
        count: 1e-8,
        faults: vec![],
    };
    let due = clean.run(60_000);
    println!("clean: {due:?}");
    for fault in [
        Fault::Burst(1.0, 1),
        Fault::Burst(-0.1, 1),
        Fault::Burst(1e-2, 30),
        Fault::Lost(5),
    ] {
        for at in [100, 1500, 3333] {
            let faults = vec![(at, fault)];
            let found = Case {
                faults,
                ..clean.clone()
            }
            .run(60_000);
            let took = |o: Outcome| o.tripped.unwrap() - o.learnt.unwrap();
            assert!(
                took(found).abs_diff(took(due)) <= 50,
                "{fault:?} at {at}: {found:?}, clean {due:?}"
            );
        }
    }
}
