//! Models, and motions that a compensator does not like.
#![allow(dead_code)]

pub mod compiled;
pub mod reserved;
pub mod terms;

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::io::Read;
use stiction_export::{Domain, File, Model, Parameter, Provenance};
use stiction_friction::compensator::{
    Adaptation, Compensator, Friction, Input, Settings, Source, Trip, Watchdog,
};
use stiction_friction::{
    CoulombViscous, Damping, Direction, ElastoPlastic, Element, LuGre, MaxwellSlip, Shape, Stribeck,
};

pub fn side(
    coulomb: f64,
    static_friction: f64,
    stribeck_velocity: f64,
    viscous: f64,
) -> Direction<f64> {
    Direction {
        coulomb,
        static_friction,
        stribeck_velocity,
        viscous,
    }
}

/// Bristles with a curve of its own in each direction.
pub fn lugre(shape: Shape<f64>) -> LuGre<f64> {
    let (pos, neg) = (side(20.0, 31.0, 5e-3, 60.0), side(14.0, 17.0, 2e-3, 85.0));
    let curve = Stribeck::new(shape, pos, neg, -3.0).unwrap();
    LuGre::new(1.2e5, Damping::Capped(600.0), curve).unwrap()
}

/// Elements of which each is softer and later to yield than the one before.
pub fn elements(count: usize) -> Vec<Element<f64>> {
    let element = |k: usize| Element {
        stiffness: 8e4 / 1.5_f64.powi(k as i32),
        share: 0.4 + 0.1 * k as f64,
    };
    (0..count).map(element).collect()
}

/// Bristles that do not creep, with a curve of its own in each direction.
pub fn elasto_plastic(shape: Shape<f64>) -> Friction<f64> {
    Friction::ElastoPlastic(ElastoPlastic::new(lugre(shape), 0.7).unwrap())
}

/// The same with elements that take a hundredth of a second to follow the curve.
pub fn gms(shape: Shape<f64>, count: usize) -> Friction<f64> {
    let law = MaxwellSlip::new(&elements(count), 2e3, *lugre(shape).curve());
    Friction::Gms(law.unwrap())
}

/// Elements that follow at once, one level for each direction.
pub fn maxwell_slip(count: usize) -> Friction<f64> {
    let (pos, neg) = (side(20.0, 20.0, 1.0, 60.0), side(14.0, 14.0, 1.0, 85.0));
    let curve = Stribeck::new(Shape::Gaussian, pos, neg, -3.0).unwrap();
    Friction::Gms(MaxwellSlip::new(&elements(count), f64::INFINITY, curve).unwrap())
}

/// Every law and shape that is exported.
pub fn laws() -> Vec<(&'static str, Friction<f64>)> {
    let stage = Stribeck::symmetric(Shape::Gaussian, side(12.0, 18.0, 3e-3, 30.0), 0.0).unwrap();
    vec![
        (
            "lugre",
            Friction::LuGre(LuGre::new(2e6, Damping::Capped(1.5e3), stage).unwrap()),
        ),
        ("gaussian", Friction::LuGre(lugre(Shape::Gaussian))),
        ("elasto-plastic", elasto_plastic(Shape::Exponential)),
        ("power", Friction::LuGre(lugre(Shape::Power(1.3)))),
        ("gms", gms(Shape::Lorentzian, 4)),
        ("maxwell-slip", maxwell_slip(3)),
        (
            "stribeck",
            Friction::Stribeck(*lugre(Shape::Gaussian).curve()),
        ),
        (
            "coulomb",
            Friction::Coulomb(CoulombViscous::new([20.0, 14.0], [60.0, 85.0], -3.0).unwrap()),
        ),
    ]
}

/// Every law with every shape, and elements of every number.
pub fn all_laws() -> Vec<(&'static str, Friction<f64>)> {
    let mut all = laws();
    for shape in [
        Shape::Gaussian,
        Shape::Exponential,
        Shape::Power(0.7),
        Shape::Lorentzian,
    ] {
        all.push(("lugre", Friction::LuGre(lugre(shape))));
        all.push(("elasto-plastic", elasto_plastic(shape)));
        all.push(("gms", gms(shape, 3)));
        all.push(("stribeck", Friction::Stribeck(*lugre(shape).curve())));
    }
    for count in 1..=10 {
        all.push(("gms", gms(Shape::Gaussian, count)));
        all.push(("maxwell-slip", maxwell_slip(count)));
    }
    let flat = side(12.0, 12.0, 1.0, 30.0);
    let flat = Stribeck::symmetric(Shape::Gaussian, flat, 0.0).unwrap();
    let dahl = LuGre::new(2e6, Damping::Capped(0.0), flat).unwrap();
    all.push(("dahl", Friction::LuGre(dahl)));
    all
}

/// The model of every law; some of them a second time with levels that follow the machine.
pub fn models() -> Vec<(&'static str, Model)> {
    let following = ["gaussian", "gms", "stribeck", "coulomb"];
    let again = laws()
        .into_iter()
        .filter(|(name, _)| following.contains(name))
        .map(|(name, law)| {
            let mut model = model(law);
            model.settings = adapting(model.settings);
            (name, model)
        });
    laws()
        .into_iter()
        .map(|(name, law)| (name, model(law)))
        .chain(again)
        .chain(terms::models())
        .collect()
}

pub fn model(friction: Friction<f64>) -> Model {
    Model {
        title: "X axis".into(),
        identifier: "x_axis".into(),
        rotary: false,
        force_unit: "N".into(),
        friction,
        terms: stiction_friction::compensator::Terms::default(),
        load_unit: String::new(),
        backlash: None,
        settings: Settings::new(1e-3, 60.0),
        rated_force: Some(221.0),
        top_speed: None,
        parameters: vec![
            Parameter {
                name: "sigma0".into(),
                value: 1.2e5,
                unit: "N/m".into(),
                interval: Some([1.1e5, 1.3e5]),
                identifiable: true,
                given: false,
            },
            Parameter {
                name: "sigma1".into(),
                value: 600.0,
                unit: "N s/m".into(),
                interval: None,
                identifiable: false,
                given: false,
            },
        ],
        domain: Domain::default(),
        draws: None,
        notes: vec![],
        provenance: Provenance {
            version: "0.0.0".into(),
            model_sha256: "00".repeat(32),
            inputs: vec![("log.csv".into(), "11".repeat(32))],
        },
    }
}

/// Settings with which everything acts.
pub fn busy() -> Settings<f64> {
    Settings {
        gain: 0.9,
        dead_zone: 1e-5,
        limit: 33.0,
        slew: 8000.0,
        ramp: 0.02,
        watchdog: Some(Watchdog {
            window: 0.5,
            ratio: 1.0,
        }),
        ..Settings::new(1e-3, 60.0)
    }
}

/// The same with levels that follow the machine.
pub fn adapting(settings: Settings<f64>) -> Settings<f64> {
    Settings {
        adaptation: Some(Adaptation {
            mass: 4.6,
            ..Adaptation::default()
        }),
        ..settings
    }
}

pub fn random(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

/// Samples in runs of a kind each: sines through reversals, standstill, creep, jumps, noise, and, where `wild`, numbers
/// that are huge, denormal or none. With the time since the sample before, s.
pub fn adversarial(samples: usize, wild: bool, random: &mut impl Rng) -> Vec<(f64, Input<f64>)> {
    let mut out = Vec::with_capacity(samples);
    while out.len() < samples {
        let kind = random.random_range(0..if wild { 10 } else { 7 });
        let size = 10f64.powf(random.random_range(-7.0..0.5));
        let cycles = random.random_range(3.0..300.0);
        let enable = random.random_range(0..6) != 0;
        let error = 10f64.powf(random.random_range(-7.0..-5.0));
        let varying = random.random_range(0..8) == 0;
        let force = 10f64.powf(random.random_range(-1.0..3.0));
        for k in 0..random.random_range(1..400) {
            let k = f64::from(k);
            let v = match kind {
                0 | 1 => size * (k / cycles).sin(),
                2 => 0.0,
                3 => size * 1e-3,
                4 => size * random.random_range(-1.0..1.0),
                5 => size * [1.0, -1.0, 0.0, 50.0][random.random_range(0..4)],
                6 => size + 0.1 * size * (k / cycles).sin(),
                7 => [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.0][random.random_range(0..4)],
                8 => f64::from_bits(random.random()),
                _ => [1e300, -1e155, 5e-324, -1e-310, -0.0, f64::MAX][random.random_range(0..6)],
            };
            let h = match kind {
                8 if varying => f64::from_bits(random.random()),
                _ if varying => 1e-3 * random.random_range(0.0..3.0),
                _ => 1e-3,
            };
            let tracking_error = match kind {
                8 if !varying => f64::from_bits(random.random()),
                _ => error * random.random_range(-1.0..1.0),
            };
            let input = Input {
                reference_velocity: v,
                measured_velocity: 0.0,
                tracking_error,
                enable,
                drive_force: match kind {
                    8 if !varying => f64::from_bits(random.random()),
                    _ => force * random.random_range(-1.0..1.0),
                },
                learn: random.random_range(0..9) != 0,
                ..Input::default()
            };
            out.push((h, input));
        }
    }
    out.truncate(samples);
    out
}

/// What the error with compensation is, of that without, in [`guarded`]: better, worse on average, worse at its peaks.
pub const GUARDED: [(f64, Option<Trip>); 3] = [
    (0.6, None),
    (1.2, Some(Trip::Mean)),
    (2.0, Some(Trip::Peak)),
];

/// Samples of a reference that goes to and fro, with an error at its turns that is `factor` times as large where a force is
/// added, and faults of the measurement: the watchdog learns, judges, and does what it has to.
pub fn guarded(
    friction: Friction<f64>,
    settings: Settings<f64>,
    (factor, trip): (f64, Option<Trip>),
    random: &mut impl Rng,
) -> Vec<(f64, Input<f64>)> {
    let h = settings.cycle_time;
    let mut compensator = Compensator::new(friction, Source::Reference, settings).unwrap();
    let faults = [1234, 3210, 5050, 9999].map(|at| at + random.random_range(0..100));
    let mut out = Vec::new();
    for k in 0..20_000_usize {
        let phase = 2.0 * std::f64::consts::PI * k as f64 * h;
        let since_turn = (k as f64 * h * 2.0).fract();
        let size = 1e-6 + 1e-5 * (-since_turn / 0.04).exp() + 1e-8 * random.random_range(-1.0..1.0);
        let with = compensator.state().output != 0.0;
        let mut tracking_error = if with { factor * size } else { size };
        for (i, at) in faults.into_iter().enumerate() {
            if (at..=at + 7 * i).contains(&k) {
                tracking_error += 1e-3;
            }
        }
        let input = Input {
            reference_velocity: 0.02 * phase.sin(),
            measured_velocity: 0.0,
            tracking_error,
            enable: true,
            ..Input::default()
        };
        compensator.step(input);
        out.push((h, input));
    }
    assert_eq!(compensator.state().watch.trip, trip, "{factor}");
    assert!(compensator.state().watch.learned());
    out
}

/// Samples of an axis whose friction is not that of the law: it goes to and fro with a force of the drive that is
/// larger, with its mass, and has faults of the measurement; the factors follow.
pub fn following(
    friction: Friction<f64>,
    settings: Settings<f64>,
    random: &mut impl Rng,
) -> Vec<(f64, Input<f64>)> {
    let h = settings.cycle_time;
    let settings = Settings {
        watchdog: None,
        limit: 1e3,
        ..settings
    };
    let mut axis = Compensator::new(friction, Source::Reference, settings).unwrap();
    let mut after = Compensator::new(friction, Source::Reference, adapting(settings)).unwrap();
    let mut out = Vec::new();
    for k in 0..20_000_usize {
        let phase = 2.0 * std::f64::consts::PI * k as f64 * h;
        let inertia = 5.5 * 0.02 * 2.0 * std::f64::consts::PI * phase.cos();
        let noise = random.random_range(-1.0..1.0);
        let fault = if k % 3_111 == 0 { 1e6 } else { 0.0 };
        let input = Input {
            reference_velocity: 0.02 * phase.sin(),
            measured_velocity: 0.0,
            tracking_error: 1e-7 * noise,
            enable: true,
            drive_force: 1.3 * axis.state().law.force + inertia + noise + fault,
            learn: k % 5_000 > 500,
            ..Input::default()
        };
        axis.step(input);
        after.step(input);
        out.push((h, input));
    }
    let level = after.state().learnt.level;
    assert!(level > 1.2, "{level}");
    out
}

/// The files in an FMU.
pub fn parts(archive: &File) -> Vec<File> {
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(&archive.bytes)).unwrap();
    (0..zip.len())
        .map(|i| {
            let mut entry = zip.by_index(i).unwrap();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            File {
                path: entry.name().unwrap().into_owned(),
                bytes,
            }
        })
        .collect()
}
