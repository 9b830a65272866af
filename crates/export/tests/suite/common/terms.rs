//! Models whose friction depends on load, temperature, place and what is transmitted, with forces beside it, and what comes in for them.

use super::compiled::Sample;
use super::{adapting, laws, model};
use rand::{Rng, RngExt};
use stiction_export::{Backlash, Model};
use stiction_friction::compensator::{
    Channel, Channels, Friction, Levels, Terms, WAVES, Wave, Weight,
};

fn channel(reference: f64, low: f64, high: f64) -> Channel<f64> {
    Channel {
        reference,
        range: [low, high],
        turns: false,
    }
}

fn waves(all: &[Wave<f64>]) -> [Wave<f64>; WAVES] {
    let mut waves = [Wave::default(); WAVES];
    waves[..all.len()].copy_from_slice(all);
    waves
}

fn wave(pitch: f64, whole: bool, sine: f64, cosine: f64) -> Wave<f64> {
    Wave {
        rate: 2.0 * std::f64::consts::PI / pitch,
        whole,
        sine,
        cosine,
    }
}

/// Two waves of cogging over a turn or, on a linear axis, a pitch, and a gap.
pub fn with_cogging_and_gap(mut model: Model) -> Model {
    let turn = if model.rotary {
        2.0 * std::f64::consts::PI
    } else {
        0.024
    };
    model.terms.channels.position = channel(0.3, 0.0, 8.0);
    model.terms.cogging = waves(&[
        wave(turn / 42.0, true, 0.031, -0.012),
        wave(turn, true, -0.004, 0.007),
    ]);
    model.backlash = Some(Backlash {
        width: 2e-5,
        interval: Some([1.8e-5, 2.2e-5]),
        load: Some(0.3),
        range: Some([0.0, 8.0]),
    });
    model
}

/// Everything that friction may depend on.
pub fn depends() -> Terms<f64> {
    Terms {
        channels: Channels {
            load: channel(120.0, 40.0, 200.0),
            temperature: channel(301.5, 290.0, 318.0),
            position: channel(0.05, -0.1, 0.2),
            transmitted: channel(6.0, 0.5, 15.0),
        },
        levels: Some(Levels {
            load: [2e-3, 1e-3],
            temperature: [-0.02, -0.025],
            position: [0.7, -0.4],
            transmitted: [0.03, 0.02],
            driven: [-0.012, 0.008],
            waves: [
                waves(&[wave(0.02, true, 0.08, 0.03), wave(0.9, false, -0.05, 0.02)]),
                waves(&[wave(0.02, true, 0.02, -0.06), wave(0.9, false, 0.04, 0.01)]),
            ],
            viscous: [-1.5, -2.0],
            quadratic: [-20.0, 35.0],
            top_speed: 0.3,
        }),
        ..Terms::default()
    }
}

/// Viscous friction that bends, alone: nothing comes in for it. In one direction it is used up before the top speed.
pub fn bends() -> Terms<f64> {
    Terms {
        levels: Some(Levels {
            quadratic: [25.0, -80.0],
            top_speed: 0.6,
            ..Levels::default()
        }),
        ..Terms::default()
    }
}

/// Everything that is fed forward beside friction.
pub fn feeds() -> Terms<f64> {
    let mut channels = depends().channels;
    channels.position.turns = true;
    Terms {
        channels,
        mass: 4.6,
        weight: Some(Weight {
            constant: 3.5,
            wave: wave(2.0 * std::f64::consts::PI, false, 6.0, -1.5),
        }),
        cogging: waves(&[wave(0.03, true, 0.9, -0.4), wave(0.01, true, 0.3, 0.2)]),
        ..Terms::default()
    }
}

/// The model of a law with terms: its k-th kind of some, of which one has what there is.
pub fn with_terms(friction: Friction<f64>, kind: usize) -> Model {
    let mut model = match kind % 4 {
        0 => {
            let mut model = model(friction.without_offset().unwrap());
            model.terms = Terms {
                levels: depends().levels,
                ..feeds()
            };
            model
        }
        1 => {
            let mut model = model(friction);
            model.terms = depends();
            model
        }
        2 => {
            let mut model = model(friction.without_offset().unwrap());
            model.terms = feeds();
            model
        }
        _ => {
            let mut model = model(friction);
            model.terms = bends();
            model
        }
    };
    model.load_unit = "N".into();
    model
}

/// Some laws with terms, so that each kind is there with levels that follow the machine and without.
pub fn models() -> Vec<(&'static str, Model)> {
    let kinds = [
        ("gaussian", 0, true),
        ("power", 2, false),
        ("stribeck", 1, true),
        ("coulomb", 0, false),
        ("gaussian", 3, true),
        ("coulomb", 3, false),
    ];
    let of = |(wanted, kind, follows): (&'static str, usize, bool)| {
        let (_, law) = laws()
            .into_iter()
            .find(|(name, _)| *name == wanted)
            .unwrap();
        let mut model = with_terms(law, kind);
        if follows {
            model.settings = adapting(model.settings);
        }
        (wanted, model)
    };
    kinds.into_iter().map(of).collect()
}

/// What a model takes beside velocity, error, enable and drive, in the order of the code, and its place in what a program reads
/// for a sample.
pub fn extras(model: &Model) -> Vec<(&'static str, usize)> {
    let changes = (model.terms.levels).filter(|levels| levels.load != [0.0; 2]);
    let [mass, place, conditions] = match (model.terms.mass > 0.0, changes) {
        (mass, Some(_)) => [mass, true, true],
        (mass, None) => [mass, mass, false],
    };
    [
        ("reference_acceleration", 6, mass),
        ("position", 7, place),
        ("load", 8, conditions),
        ("temperature", 9, conditions),
        ("transmitted", 10, conditions),
    ]
    .into_iter()
    .filter_map(|(name, at, there)| there.then_some((name, at)))
    .collect()
}

/// What is transmitted where no sensor or model has a number for it, or one that is none.
const HOSTILE: [f64; 7] = [
    f64::NAN,
    f64::NEG_INFINITY,
    -1e300,
    1e20,
    -0.0,
    5e-324,
    -5e-324,
];

/// Puts load, temperature, place, acceleration and what is transmitted into samples: within their ranges and beyond, huge, and none.
/// The position goes on for `turns`, or stays near its range.
pub fn surround(samples: &mut [Sample], turns: bool, random: &mut impl Rng) {
    let [mut x, mut load, mut temperature] = [0.0_f64, 120.0, 300.0];
    for (k, (_, input)) in samples.iter_mut().enumerate() {
        let step = 1e-3 * input.reference_velocity;
        x = if step.abs() < 0.01 { x + step } else { x };
        x = if x.abs() < 0.5 { x } else { 0.0 };
        load += random.random_range(-2.0..2.0) - 0.01 * (load - 120.0);
        temperature += random.random_range(-0.3..0.3) - 0.01 * (temperature - 300.0);
        // An angle that wraps, or has gone on for some turns.
        let away = [0.0, 0.0, 1.0, -1.0, 2.0, -3.0, 200.0];
        let away = away.map(|n| if turns { n } else { 0.0 });
        input.position = x + std::f64::consts::TAU * away[k % away.len()];
        input.load = load;
        input.temperature = temperature;
        input.transmitted = match k % 23 {
            0 => HOSTILE[k / 23 % HOSTILE.len()],
            _ => 20.0 * (7e-3 * k as f64).sin() + 2.0 * (0.9 * k as f64).sin(),
        };
        input.reference_acceleration = random.random_range(-3.0..3.0);
        if k % 17 == 0 {
            let hostile = [
                f64::NAN,
                f64::INFINITY,
                -1e300,
                1e20,
                -0.0,
                5e-324,
                f64::from_bits(random.random()),
            ];
            let value = hostile[random.random_range(0..hostile.len())];
            match random.random_range(0..4) {
                0 => input.position = value,
                1 => input.load = value,
                2 => input.temperature = value,
                _ => input.reference_acceleration = value,
            }
        }
    }
}
