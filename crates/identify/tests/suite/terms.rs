//! Friction that changes with load, temperature and position, and quadratic viscous friction: known
//! truth by the friction crate on a finer grid, found again within its intervals by every law.

use crate::common::Noise;
use crate::common::chance::neither_too_narrow_nor_too_wide;
use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Conditioning, Cutoff, Dependence, Error, Estimate, Law, LawKind, Mass, Objective, Record,
    Samples, Settings, Silent, Source, Status, Terms, condition, estimate, separable,
};

const STEP: f64 = 1e-3;
const SAMPLES: usize = 12_001;
const PITCH: f64 = 0.03;

/// One direction: Coulomb level at the references and what it changes with, Fs/Fc, vs, viscous.
#[derive(Clone, Copy)]
struct Side {
    coulomb: f64,
    load: f64,
    temperature: f64,
    position: f64,
    pitch: [f64; 2],
    ratio: f64,
    velocity: f64,
    viscous: f64,
    viscous_temperature: f64,
    quadratic: f64,
}

const FORWARD: Side = Side {
    coulomb: 20.0,
    load: 0.08,
    temperature: -0.3,
    position: 25.0,
    pitch: [0.8, -0.5],
    ratio: 1.5,
    velocity: 6e-3,
    viscous: 60.0,
    viscous_temperature: -1.5,
    quadratic: -40.0,
};
const BACKWARD: Side = Side {
    coulomb: 24.0,
    load: 0.12,
    temperature: -0.2,
    position: 15.0,
    pitch: [0.5, 0.4],
    ratio: 1.4,
    velocity: 5e-3,
    viscous: 70.0,
    viscous_temperature: -1.0,
    quadratic: -20.0,
};
const KAPPA: f64 = 6e3;
const SIGMA1: f64 = 600.0;
const MASS: f64 = 5.0;

fn velocity(t: f64) -> f64 {
    0.05 * (TAU * 0.5 * t).sin() + 0.015 * (TAU * 3.7 * t).sin() + 0.1 * (TAU * 0.21 * t).cos()
}

fn acceleration(t: f64) -> f64 {
    let part = |a: f64, f: f64, x: f64| a * TAU * f * x;
    part(0.05, 0.5, (TAU * 0.5 * t).cos()) + part(0.015, 3.7, (TAU * 3.7 * t).cos())
        - part(0.1, 0.21, (TAU * 0.21 * t).sin())
}

fn position(t: f64) -> f64 {
    let part = |a: f64, f: f64, x: f64| a / (TAU * f) * x;
    0.3 - part(0.05, 0.5, (TAU * 0.5 * t).cos()) - part(0.015, 3.7, (TAU * 3.7 * t).cos())
        + part(0.1, 0.21, (TAU * 0.21 * t).sin())
}

fn load(t: f64) -> f64 {
    80.0 + 30.0 * (TAU * 0.33 * t).sin() + 10.0 * (TAU * 1.9 * t).cos()
}

fn temperature(t: f64) -> f64 {
    295.0 + 8.0 * (1.0 - (-t / 4.0).exp())
}

/// The axis: `eta` and its rate by the friction crate, in units of the Coulomb level.
struct Axis {
    kind: LawKind,
    sides: [Side; 2],
}

impl Axis {
    fn new(kind: LawKind, asymmetric: bool) -> Self {
        let back = if asymmetric { BACKWARD } else { FORWARD };
        Self {
            kind,
            sides: [FORWARD, back],
        }
    }

    /// References that the record gives, and the clean force with dependences about them.
    fn force(&self) -> Vec<f64> {
        let [f, b] = self.sides;
        let direction = |s: &Side| Direction {
            coulomb: s.coulomb / f.coulomb,
            static_friction: s.coulomb / f.coulomb
                * if self.kind.has_stribeck() {
                    s.ratio
                } else {
                    1.0
                },
            stribeck_velocity: s.velocity,
            viscous: 0.0,
        };
        let curve = Stribeck::new(Shape::Gaussian, direction(&f), direction(&b), 0.0).unwrap();
        let law = |s1: f64| LuGre::new(KAPPA, Damping::Constant(s1), curve).unwrap();
        let (bare, damped) = (law(0.0), law(1.0));
        let fine = 20;
        let h = STEP / fine as f64;
        let mut z = 0.0;
        let (n0, t0, x0) = references();
        (0..SAMPLES)
            .map(|i| {
                let t = i as f64 * STEP;
                if i > 0 {
                    for k in 0..fine {
                        let s = t - STEP + k as f64 * h;
                        z = bare.step_record(z, h, velocity(s), velocity(s + h));
                    }
                }
                let v = velocity(t);
                let (eta, rate) = if self.kind.has_bristle() {
                    let eta = bare.force(z, v);
                    (eta, damped.force(z, v) - eta)
                } else {
                    (curve.force(v), 0.0)
                };
                let side = &self.sides[usize::from(v < 0.0)];
                let of_level = &self.sides[usize::from(eta < 0.0)];
                // Of an asymmetric law `eta` carries the ratio of the levels already.
                let scale = f.coulomb / of_level.coulomb;
                let x = position(t);
                let (sine, cosine) = (TAU / PITCH * x).sin_cos();
                let level = f.coulomb
                    + scale
                        * (of_level.load * (load(t) - n0)
                            + of_level.temperature * (temperature(t) - t0)
                            + of_level.position * (x - x0)
                            + of_level.pitch[0] * sine
                            + of_level.pitch[1] * cosine);
                let sigma1 = if self.kind == LawKind::LuGre {
                    SIGMA1
                } else {
                    0.0
                };
                let viscous = side.viscous
                    + side.viscous_temperature * (temperature(t) - t0)
                    + side.quadratic * v.abs();
                level * eta + sigma1 * rate + viscous * v + MASS * acceleration(t)
            })
            .collect()
    }

    fn truth(&self, asymmetric: bool) -> Vec<(String, f64)> {
        let mut out = vec![("mass".to_string(), MASS)];
        if self.kind.has_bristle() {
            out.push(("sigma0".into(), KAPPA * FORWARD.coulomb));
        }
        if self.kind == LawKind::LuGre {
            out.push(("sigma1".into(), SIGMA1));
        }
        let suffixes: &[&str] = if asymmetric { &["_pos", "_neg"] } else { &[""] };
        for (suffix, s) in suffixes.iter().zip(&self.sides) {
            let mut push = |name: &str, x: f64| out.push((format!("{name}{suffix}"), x));
            push("coulomb", s.coulomb);
            push("sigma2", s.viscous);
            push("quadratic_viscous", s.quadratic);
            push("coulomb_load", s.load);
            push("coulomb_temperature", s.temperature);
            push("coulomb_position", s.position);
            push("coulomb_pitch1_sin", s.pitch[0]);
            push("coulomb_pitch1_cos", s.pitch[1]);
            push("sigma2_temperature", s.viscous_temperature);
            if self.kind.has_stribeck() {
                push("static", s.coulomb * s.ratio);
                push("stribeck_velocity", s.velocity);
            }
        }
        out
    }
}

/// Mean load, mean temperature, middle of the stroke at the samples.
fn references() -> (f64, f64, f64) {
    let all = |f: fn(f64) -> f64| (0..SAMPLES).map(move |i| f(i as f64 * STEP));
    let mean = |f| all(f).sum::<f64>() / SAMPLES as f64;
    let low = all(position).fold(f64::INFINITY, f64::min);
    let high = all(position).fold(f64::NEG_INFINITY, f64::max);
    (mean(load), mean(temperature), 0.5 * (low + high))
}

fn samples(force: Vec<f64>) -> Samples {
    let all = |f: fn(f64) -> f64| (0..SAMPLES).map(|i| f(i as f64 * STEP)).collect();
    Samples {
        time: (0..SAMPLES).map(|i| i as f64 * STEP).collect(),
        position: Some(all(position)),
        velocity: Some(all(velocity)),
        force,
        load: Some(all(load)),
        temperature: Some(all(temperature)),
        ..Samples::default()
    }
}

fn raw(samples: Samples) -> Record {
    let conditioning = Conditioning {
        source: Some(Source::Velocity),
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    condition(&[samples], &conditioning).unwrap()
}

fn all_terms() -> Terms {
    Terms {
        mass: Mass::Fitted,
        offset: false,
        quadratic_viscous: true,
        dependences: vec![
            Dependence::CoulombLoad(0.0),
            Dependence::CoulombTemperature(0.0),
            Dependence::CoulombPosition(0.0),
            Dependence::CoulombPitch(PITCH),
            Dependence::ViscousTemperature(0.0),
        ],
        ..Terms::default()
    }
}

fn fit(record: &Record, law: Law, terms: &Terms) -> Estimate {
    let terms = terms.about(record);
    let found = separable(record, law, &terms, &Settings::default(), &mut Silent).unwrap();
    assert_eq!(found.status, Status::Converged);
    estimate(record, law, &terms, &found, 0.0)
}

/// Every law that the axis of these tests can follow: its bristle yields from the first.
fn every_law() -> impl Iterator<Item = Law> {
    LawKind::ALL
        .into_iter()
        .filter(|kind| *kind != LawKind::ElastoPlastic && !kind.has_elements())
        .flat_map(|kind| [Law::new(kind), Law::new(kind).asymmetric()])
}

/// Without noise every parameter of every law comes back; the references are what was used.
#[test]
fn every_law_finds_every_dependence() {
    for law in every_law() {
        let axis = Axis::new(law.kind, law.asymmetric);
        let record = raw(samples(axis.force()));
        let estimate = fit(&record, law, &all_terms());
        let (n0, t0, x0) = references();
        for (name, reference) in [
            ("load_reference", n0),
            ("temperature_reference", t0),
            ("position_reference", x0),
        ] {
            let given = estimate.parameter(name).unwrap();
            assert!((given.value / reference - 1.0).abs() < 1e-9, "{name}");
            assert!(!given.identified && given.identifiable);
        }
        for (name, truth) in axis.truth(law.asymmetric) {
            let value = estimate.value(&name).unwrap();
            // What is left is the coarser grid of the record: the bristle in steps of 1 ms.
            let tolerance = if law.kind.has_bristle() { 2e-2 } else { 1e-3 };
            assert!(
                (value / truth - 1.0).abs() < tolerance,
                "{law:?}: {name} = {value} instead of {truth}"
            );
        }
    }
}

/// The reduced gradient with dependences equals central differences of the cost.
#[test]
fn gradient_with_dependences_matches_finite_differences() {
    for law in every_law().filter(|law| law.nonlinear() > 0) {
        let record = raw(samples(Axis::new(law.kind, true).force()));
        let terms = all_terms().about(&record);
        let start: &[f64] = match (law.kind, law.asymmetric) {
            (LawKind::Dahl, false) => &[8.2],
            (LawKind::Dahl, true) => &[8.2, 0.1],
            (LawKind::Stribeck, false) => &[-0.5, -5.0],
            (LawKind::Stribeck, true) => &[-0.5, -5.0, 0.1, -0.8, -4.8],
            (_, false) => &[8.2, -0.5, -5.0],
            (_, true) => &[8.2, -0.5, -5.0, 0.1, -0.8, -4.8],
        };
        let objective = Objective::new(&record, law, &terms);
        let slope = objective.descent(start);
        for (i, slope) in slope.iter().enumerate() {
            let h = 1e-5;
            let cost = |d: f64| {
                let mut p = start.to_vec();
                p[i] += d;
                objective.evaluate(&p, false).cost
            };
            let numeric = -(cost(h) - cost(-h)) / (4.0 * h);
            assert!(
                (slope / numeric - 1.0).abs() < 1e-4,
                "{law:?}: unknown {i}: {slope} against {numeric}"
            );
        }
    }
}

/// From positions and both filters, with noise: the truth lies in its interval as often as it should.
#[test]
fn intervals_hold_the_truth() {
    let seeds = 12;
    let (mut held, mut all) = (0, 0);
    for law in [
        Law::new(LawKind::CoulombViscous),
        Law::new(LawKind::Stribeck).asymmetric(),
        Law::new(LawKind::LuGre),
    ] {
        let axis = Axis::new(law.kind, law.asymmetric);
        let clean = axis.force();
        let (mut inside, mut total) = (0, 0);
        for seed in 0..seeds {
            let mut noise = Noise::new(seed + 1);
            let force = clean.iter().map(|u| u + 2.0 * noise.normal()).collect();
            let estimate = fit(&raw(samples(force)), law, &all_terms());
            for (name, truth) in axis.truth(law.asymmetric) {
                if let Some((low, high)) = estimate.parameter(&name).unwrap().ci95 {
                    total += 1;
                    inside += usize::from(low <= truth && truth <= high);
                }
            }
        }
        let part = f64::from(inside as u32) / f64::from(total as u32);
        println!("{} {}: {inside} of {total}", law.kind, law.asymmetric);
        // 95 % of some 150 to 250 correlated cases.
        assert!(part >= 0.90, "{law:?}: {inside} of {total}");
        held += inside;
        all += total;
    }
    // Too wide is seen in all of them together only.
    neither_too_narrow_nor_too_wide("terms", held, all);
}

/// The product of a channel and the law passes the common filter as a whole: with filters on both
/// sides the coefficients stay where they are.
#[test]
fn the_common_filter_does_not_shift_the_coefficients() {
    let law = Law::new(LawKind::LuGre);
    let axis = Axis::new(law.kind, false);
    let mut samples = samples(axis.force());
    // The force of a load that changes faster than the common filter passes.
    let (n0, ..) = references();
    let fast = |t: f64| 10.0 * (TAU * 60.0 * t).sin();
    let (bare, with) = {
        let mut loaded = Axis::new(law.kind, false);
        loaded.sides[0].load = 0.0;
        loaded.sides[1].load = 0.0;
        (loaded.force(), axis.force())
    };
    for i in 0..SAMPLES {
        let t = i as f64 * STEP;
        let per_newton = (with[i] - bare[i]) / (load(t) - n0);
        if per_newton.is_finite() {
            samples.force[i] += per_newton * fast(t);
        }
        samples.load.as_mut().unwrap()[i] += fast(t);
    }
    let conditioning = Conditioning {
        source: Some(Source::Velocity),
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Hz(40.0),
        ..Conditioning::default()
    };
    let record = condition(&[samples], &conditioning).unwrap();
    let estimate = fit(&record, law, &all_terms());
    for (name, truth) in axis.truth(false) {
        let value = estimate.value(&name).unwrap();
        assert!(
            (value / truth - 1.0).abs() < 2e-2,
            "{name} = {value} instead of {truth}"
        );
    }
}

/// A term without its channel is refused; a channel that does not vary, or shows its noise only, is
/// flagged.
#[test]
fn what_a_log_cannot_tell() {
    let law = Law::new(LawKind::CoulombViscous);
    let force = Axis::new(law.kind, false).force();
    let terms = |dependence| Terms {
        offset: false,
        dependences: vec![dependence],
        ..Terms::default()
    };
    let mut without = samples(force.clone());
    without.load = None;
    without.temperature = None;
    without.position = None;
    let record = raw(without);
    for (dependence, name) in [
        (Dependence::CoulombLoad(0.0), "load"),
        (Dependence::CoulombTemperature(0.0), "temperature"),
        (Dependence::ViscousTemperature(0.0), "temperature"),
        (Dependence::CoulombPosition(0.0), "position"),
        (Dependence::CoulombPitch(PITCH), "position"),
    ] {
        let terms = terms(dependence).about(&record);
        let found = separable(&record, law, &terms, &Settings::default(), &mut Silent);
        let Err(Error::MissingChannel {
            log: 1, channel, ..
        }) = found
        else {
            panic!("{dependence:?}: {found:?}");
        };
        assert_eq!(channel, name);
    }

    let mut noise = Noise::new(3);
    for spread in [0.0, 1e-3] {
        let mut log = samples(force.clone());
        let mut still = |mean: f64, spread: f64| -> Option<Vec<f64>> {
            Some(
                (0..SAMPLES)
                    .map(|_| mean + spread * noise.normal())
                    .collect(),
            )
        };
        log.load = still(80.0, 80.0 * spread);
        log.temperature = still(295.0, 10.0 * spread);
        let record = raw(log);
        for dependence in [
            Dependence::CoulombLoad(0.0),
            Dependence::CoulombTemperature(0.0),
            Dependence::ViscousTemperature(0.0),
        ] {
            let estimate = fit(&record, law, &terms(dependence));
            let flagged = estimate.parameter(dependence.name()).unwrap();
            assert!(!flagged.identifiable, "{spread}: {flagged:?}");
            assert!(estimate.parameter("coulomb").unwrap().identifiable);
        }
    }
}
