//! What friction depends on beside the velocity, and what is fed forward beside it.

use crate::common::*;
use proptest::prelude::*;
use stiction_friction::compensator::{
    Adaptation, Channel, Channels, Compensator, Friction, Input, Levels, Settings, Source, Terms,
    WAVES, Watchdog, Wave, Weight,
};
use stiction_friction::{CoulombViscous, Damping, Direction, LuGre, Shape, Stribeck};

const H: f64 = 1e-3;

fn channel(reference: f64, low: f64, high: f64) -> Channel<f64> {
    Channel {
        reference,
        range: [low, high],
        turns: false,
    }
}

fn channels() -> Channels<f64> {
    Channels {
        load: channel(100.0, 20.0, 300.0),
        temperature: channel(300.0, 290.0, 320.0),
        position: channel(0.1, 0.0, 0.2),
        transmitted: channel(5.0, 1.0, 10.0),
    }
}

fn waves(first: Wave<f64>) -> [Wave<f64>; WAVES] {
    let mut waves = [Wave::default(); WAVES];
    waves[0] = first;
    waves
}

fn levels() -> Levels<f64> {
    let wave = |sine, cosine| Wave {
        rate: 2.0 * std::f64::consts::PI / 0.05,
        whole: true,
        sine,
        cosine,
    };
    Levels {
        load: [2e-3, 1e-3],
        temperature: [-0.01, -0.02],
        position: [0.5, 0.7],
        waves: [waves(wave(0.1, 0.05)), waves(wave(0.02, 0.1))],
        viscous: [-0.5, -1.0],
        ..Levels::default()
    }
}

fn offset_free(damping: f64) -> Friction<f64> {
    let side = |coulomb| Direction {
        coulomb,
        static_friction: 1.5 * coulomb,
        stribeck_velocity: 3e-3,
        viscous: 30.0,
    };
    let curve = Stribeck::new(Shape::Gaussian, side(20.0), side(14.0), 0.0).unwrap();
    Friction::LuGre(LuGre::new(1e6, Damping::Capped(damping), curve).unwrap())
}

fn bare(terms: Terms<f64>) -> Compensator<f64> {
    Compensator::new(
        offset_free(300.0),
        Source::Reference,
        Settings::bare(H, 1e4),
    )
    .unwrap()
    .with_terms(terms)
    .unwrap()
}

fn at(v: f64, load: f64, temperature: f64, position: f64) -> Input<f64> {
    Input {
        reference_velocity: v,
        enable: true,
        load,
        temperature,
        position,
        ..Input::default()
    }
}

/// The steady force of the law that has the level of this load, temperature and place, from decision 0013.
fn due(v: f64, load: f64, temperature: f64, position: f64) -> f64 {
    let l = levels();
    let (s, coulomb) = if v > 0.0 { (0, 20.0) } else { (1, 14.0) };
    let angle = l.waves[s][0].rate * position;
    let level = coulomb
        + coulomb * l.load[s] * (load - 100.0)
        + coulomb * l.temperature[s] * (temperature - 300.0)
        + coulomb * l.position[s] * (position - 0.1)
        + coulomb * (l.waves[s][0].sine * angle.sin() + l.waves[s][0].cosine * angle.cos());
    let viscous = 30.0 + l.viscous[s] * (temperature - 300.0);
    level.max(0.0) * v.signum() + viscous.max(0.0) * v
}

fn with_levels() -> Terms<f64> {
    Terms {
        channels: channels(),
        levels: Some(levels()),
        ..Terms::default()
    }
}

/// While it slides the force is that of the level there, either way; and what comes in beyond the range counts as its end.
#[test]
fn the_level_is_that_of_load_temperature_and_place() {
    for (load, temperature, position) in [
        (100.0, 300.0, 0.1),
        (250.0, 295.0, 0.03),
        (30.0, 318.0, 0.17),
    ] {
        let mut compensator = bare(with_levels());
        for v in [0.2, -0.2] {
            let force = (0..400).fold(0.0, |_, _| {
                compensator.step(at(v, load, temperature, position))
            });
            let due = due(v, load, temperature, position);
            assert!((force - due).abs() < 1e-9 * due.abs(), "{force} {due}");
        }
    }
    let mut compensator = bare(with_levels());
    for _ in 0..400 {
        compensator.step(at(0.2, 100.0, 500.0, 0.1));
    }
    let force = compensator.step(at(0.2, 1e9, 500.0, 0.1));
    assert!((force - due(0.2, 300.0, 320.0, 0.1)).abs() < 1e-8);
}

/// Static friction follows in proportion, and the way after a reversal in which friction turns round is the same: the force of the
/// bristles is that of the law times the level, all the time.
#[test]
fn presliding_is_that_of_the_law_times_the_level() {
    let terms = with_levels();
    let free = || Compensator::new(offset_free(0.0), Source::Reference, Settings::bare(H, 1e4));
    let (mut changed, mut plain) = (free().unwrap().with_terms(terms).unwrap(), free().unwrap());
    let mut most: f64 = 0.0;
    for k in 0..4000 {
        let v = 2e-3 * libm::sin(0.01 * k as f64);
        let force = changed.step(at(v, 200.0, 300.0, 0.1)) - 30.0 * v;
        let of_law = plain.step(at(v, 0.0, 0.0, 0.0)) - 30.0 * v;
        let side = usize::from(of_law < 0.0);
        let angle = levels().waves[side][0].rate * 0.1;
        let wave = levels().waves[side][0];
        let level =
            1.0 + levels().load[side] * 100.0 + wave.sine * angle.sin() + wave.cosine * angle.cos();
        assert!(
            (force - level * of_law).abs() < 1e-9,
            "{k}: {force} {of_law}"
        );
        most = most.max(of_law.abs());
    }
    assert!(most > 28.0, "near the static level of 30 N: {most}");
}

/// Friction of a gear: what is transmitted counts by its size, within its range, and otherwise where it drives the axis
/// (decision 0077).
#[test]
fn the_level_is_that_of_what_is_transmitted() {
    let [forward, back] = [(20.0, 0.12, -0.05), (14.0, 0.2, 0.04)];
    let part = |of: fn((f64, f64, f64)) -> f64| [of(forward) / forward.0, of(back) / back.0];
    let terms = Terms {
        channels: channels(),
        levels: Some(Levels {
            transmitted: part(|side| side.1),
            driven: part(|side| side.2),
            ..Levels::default()
        }),
        ..Terms::default()
    };
    let mut compensator = bare(terms);
    let mut slide = |v: f64, transmitted: f64| {
        let input = Input {
            transmitted,
            ..at(v, 0.0, 0.0, 0.0)
        };
        (0..400).fold(0.0, |_, _| compensator.step(input))
    };
    let due = |v: f64, transmitted: f64| {
        let (coulomb, all, driven) = if v > 0.0 { forward } else { back };
        let size = transmitted.abs().clamp(1.0, 10.0);
        let drives = if transmitted * v < 0.0 { driven } else { 0.0 };
        (coulomb + all * (size - 5.0) + drives * size) * v.signum() + 30.0 * v
    };
    // Before anything came in it is the reference.
    assert!((slide(0.2, f64::NAN) - due(0.2, 5.0)).abs() < 1e-9);
    for transmitted in [-12.0, -7.0, -0.1, 0.3, 4.0, 9.0, 1e9] {
        for v in [0.2, -0.2] {
            let (force, due) = (slide(v, transmitted), due(v, transmitted));
            assert!((force - due).abs() < 1e-9, "{transmitted}: {force} {due}");
        }
    }
    assert!((slide(-0.2, f64::INFINITY) - due(-0.2, 10.0)).abs() < 1e-9);
}

/// Viscous friction that bends: v |v| up to the top speed, straight beyond, and never negative (worked out by hand).
#[test]
fn viscous_friction_bends_up_to_the_top_speed() {
    let terms = Terms {
        levels: Some(Levels {
            quadratic: [40.0, -50.0],
            top_speed: 0.8,
            ..Levels::default()
        }),
        ..Terms::default()
    };
    let mut compensator = bare(terms);
    for (v, viscous) in [
        (0.2, 30.0 * 0.2 + 40.0 * 0.04),
        (0.8, 30.0 * 0.8 + 40.0 * 0.64),
        (2.0, (30.0 + 40.0 * 0.8) * 2.0),
        (-0.2, -(30.0 * 0.2 - 50.0 * 0.04)),
        (-0.5, -(30.0 * 0.5 - 50.0 * 0.25)),
        // 30 - 50 * 0.7 is below 0.
        (-0.7, 0.0),
        (-3.0, 0.0),
    ] {
        let force = (0..400).fold(0.0, |_, _| compensator.step(at(v, 0.0, 0.0, 0.0)));
        let level: f64 = if v > 0.0 { 20.0 } else { -14.0 };
        let due = level + viscous;
        assert!((force - due).abs() < 1e-9, "{v}: {force} {due}");
    }
}

/// What is not a number counts as what came in last, and as the reference before anything came in.
#[test]
fn what_is_not_a_number_counts_as_the_last_that_was() {
    let mut compensator = bare(with_levels());
    let nan = f64::NAN;
    let slide = |compensator: &mut Compensator<f64>, load, temperature, position| {
        (0..400).fold(0.0, |_, _| {
            compensator.step(at(0.2, load, temperature, position))
        })
    };
    let force = slide(&mut compensator, nan, f64::INFINITY, -f64::INFINITY);
    assert!((force - due(0.2, 100.0, 300.0, 0.1)).abs() < 1e-9);
    slide(&mut compensator, 200.0, 310.0, 0.15);
    let force = slide(&mut compensator, nan, nan, nan);
    assert!((force - due(0.2, 200.0, 310.0, 0.15)).abs() < 1e-9);
}

/// A level that a dependence would take below 0 is 0, and so is viscous friction.
#[test]
fn no_level_is_below_zero() {
    let terms = Terms {
        channels: channels(),
        levels: Some(Levels {
            temperature: [-0.2; 2],
            viscous: [-10.0; 2],
            ..Levels::default()
        }),
        ..Terms::default()
    };
    let mut compensator = bare(terms);
    for v in [0.2, -0.2] {
        let force = (0..400).fold(0.0, |_, _| compensator.step(at(v, 0.0, 319.0, 0.0)));
        assert!(force.abs() < 1e-9, "{force}");
    }
}

fn fed() -> Terms<f64> {
    Terms {
        channels: channels(),
        mass: 4.0,
        weight: Some(Weight {
            constant: 9.0,
            wave: Wave {
                rate: 1.0,
                whole: false,
                sine: 3.0,
                cosine: -2.0,
            },
        }),
        cogging: waves(Wave {
            rate: 100.0,
            whole: true,
            sine: 0.5,
            cosine: 0.25,
        }),
        ..Terms::default()
    }
}

fn weight(x: f64) -> f64 {
    9.0 + 3.0 * x.sin() - 2.0 * x.cos()
}

fn cogging(x: f64) -> f64 {
    0.5 * (100.0 * x).sin() + 0.25 * (100.0 * x).cos()
}

/// The sum has mass times acceleration, the weight and the cogging, whole, beside the share of friction; the weight is that of
/// the end of the range beyond it, and a wave that was seen whole goes on.
#[test]
fn what_is_fed_forward_is_in_the_sum_and_in_its_parts() {
    let settings = Settings {
        gain: 0.5,
        ..Settings::bare(H, 1e4)
    };
    let compensator = Compensator::new(offset_free(300.0), Source::Reference, settings).unwrap();
    let mut compensator = compensator.with_terms(fed()).unwrap();
    for (x, seen) in [(0.15, 0.15), (0.31, 0.2)] {
        for a in [2.0, -3.0] {
            let force = (0..400).fold(0.0, |_, _| {
                compensator.step(Input {
                    reference_acceleration: a,
                    ..at(0.2, 0.0, 0.0, x)
                })
            });
            let due = [0.5 * 26.0, 4.0 * a, weight(seen), cogging(x)];
            let parts = compensator.state().beside.parts;
            let parts = [parts.friction, parts.mass, parts.gravity, parts.cogging];
            for (part, due) in parts.into_iter().zip(due) {
                assert!((part - due).abs() < 1e-9, "{part} {due}");
            }
            assert!((force - due.iter().sum::<f64>()).abs() < 1e-9);
        }
    }
}

/// One second each way, with an error that is larger with compensation.
fn error(k: usize, with: bool) -> f64 {
    if with && k > 20_000 { 3e-3 } else { 1e-3 }
}

/// Where the watchdog switches off, friction, mass and cogging fade within the ramp and the weight stays, through a reset too;
/// it goes within the ramp where the compensator is disabled.
#[test]
fn a_weight_does_not_fall_with_the_watchdog() {
    let settings = Settings {
        ramp: 0.05,
        watchdog: Some(Watchdog {
            window: 1.0,
            ratio: 1.0,
        }),
        ..Settings::bare(H, 1e4)
    };
    let compensator = Compensator::new(offset_free(300.0), Source::Reference, settings).unwrap();
    let mut compensator = compensator.with_terms(fed()).unwrap();
    let sample = |k: usize, with: bool| Input {
        reference_velocity: if (k / 1000).is_multiple_of(2) {
            0.1
        } else {
            -0.1
        },
        reference_acceleration: 2.0,
        tracking_error: error(k, with),
        ..at(0.0, 0.0, 0.0, 0.05)
    };
    let (mut tripped, mut last, mut learnt) = (None, 0.0, false);
    for k in 0..40_000 {
        let before = compensator.state().watch.learned();
        let force = compensator.step(sample(k, compensator.state().share > 0.0));
        let state = compensator.state();
        learnt = learnt || state.watch.learned();
        if !learnt && k > 100 {
            // The weight is there from the first ramp on: what is learnt is the error beside it.
            assert!((force - weight(0.05)).abs() < 1e-12);
        }
        if before && state.watch.tripped() && tripped.is_none() {
            tripped = Some(k);
        }
        if let Some(at) = tripped {
            let parts = state.beside.parts;
            assert!((parts.gravity - weight(0.05)).abs() < 1e-12);
            if k > at + 51 {
                assert!((force - weight(0.05)).abs() < 1e-12, "{k}: {force}");
                break;
            }
            assert!(parts.mass <= last, "{k}");
        }
        last = compensator.state().beside.parts.mass;
    }
    assert!(tripped.is_some());
    compensator.reset();
    assert!(!compensator.state().watch.tripped());
    assert!((compensator.state().output - weight(0.05)).abs() < 1e-12);
    let force = compensator.step(sample(0, false));
    assert!((force - weight(0.05)).abs() < 1e-12);
    let mut last = force;
    for _ in 0..50 {
        let input = Input {
            enable: false,
            ..sample(0, false)
        };
        let next = compensator.step(input);
        assert!(next <= last && last - next <= weight(0.05) / 49.0);
        last = next;
    }
    assert!(last.abs() < 1e-12);
}

/// Levels that follow the machine are times those of load, temperature and place: on an axis that has 1.25 times the friction of
/// the model everywhere they are 1.25, whatever else the drive gives for weight and cogging.
#[test]
fn levels_that_follow_are_times_those_that_are_known() {
    let settings = Settings {
        adaptation: Some(Adaptation {
            mass: 4.0,
            ..Adaptation::default()
        }),
        ..Settings::bare(H, 1e4)
    };
    let terms = Terms {
        levels: Some(levels()),
        ..fed()
    };
    let follows = Compensator::new(offset_free(300.0), Source::Reference, settings).unwrap();
    let mut follows = follows.with_terms(terms).unwrap();
    let mut truth = bare(with_levels());
    let (mut x, mut command, mut force) = (0.1, 0.0, 0.0);
    for k in 0..20_000 {
        let angle = std::f64::consts::PI * k as f64 / 400.0;
        let v = 0.1 * libm::sin(angle);
        let a = 0.1 * std::f64::consts::PI / 0.4 * libm::cos(angle);
        x += H * v;
        let input = Input {
            reference_acceleration: a,
            drive_force: command,
            learn: true,
            ..at(v, 150.0, 295.0, x)
        };
        force = follows.step(input);
        let friction = 1.25 * truth.step(input);
        command = friction + 4.0 * a + weight(x) + cogging(x);
    }
    let learnt = &follows.state().learnt;
    let found = [learnt.level];
    assert!(
        found.iter().all(|level| (level - 1.25).abs() < 5e-3),
        "{found:?}"
    );
    // It is held a little.
    assert!((learnt.viscous - 1.25).abs() < 0.04, "{learnt:?}");
    assert!((force / command - 1.0).abs() < 0.01, "{force} {command}");
}

/// Terms that hold nothing change no bit.
#[test]
fn no_terms_are_no_change() {
    let law = lopsided(Shape::Gaussian, Damping::Capped(600.0));
    let settings = Settings {
        watchdog: None,
        ..Settings::new(H, 40.0)
    };
    let plain = Compensator::new(Friction::LuGre(law), Source::Reference, settings).unwrap();
    let (mut plain, mut other) = (plain, plain.with_terms(Terms::default()).unwrap());
    for k in 0..20_000 {
        let v = 0.01 * libm::sin(0.02 * k as f64);
        let input = Input {
            tracking_error: 1e-5 * v,
            reference_acceleration: f64::NAN,
            ..at(v, f64::NAN, 1e300, -5.0)
        };
        assert_eq!(plain.step(input), other.step(input));
    }
    assert_eq!(plain.state().share, 0.75);
}

/// A joint that was identified within 5.28 to 7.48 rad, whose encoder wraps at a turn, gets the same weight and the same level from
/// the signal that wraps as from the one that does not; beyond the range the end that is nearer by the turn.
#[test]
fn whole_turns_of_an_angle_do_not_count() {
    let turn = core::f64::consts::TAU;
    let place = Channel {
        reference: 6.4,
        range: [5.283, 7.483],
        turns: true,
    };
    let gravity = Wave {
        rate: 1.0,
        whole: false,
        sine: 7.0,
        cosine: -2.0,
    };
    let ripple = Wave {
        rate: 7.0,
        whole: true,
        ..gravity
    };
    let terms = Terms {
        channels: Channels {
            position: place,
            ..Channels::default()
        },
        levels: Some(Levels {
            position: [0.05, 0.02],
            ..Levels::default()
        }),
        weight: Some(Weight {
            constant: 0.0,
            wave: gravity,
        }),
        cogging: waves(ripple),
        ..Terms::default()
    };
    let force = |q: f64| {
        let mut compensator = bare(terms);
        (0..400).fold(0.0, |_, _| compensator.step(at(0.2, 0.0, 0.0, q)));
        let parts = compensator.state().beside.parts;
        [parts.gravity, parts.cogging, parts.friction]
    };
    for q in [5.3, 6.0, turn, 6.4, 1.19 + turn] {
        let due = force(q);
        assert!((due[0] - (7.0 * q.sin() - 2.0 * q.cos())).abs() < 1e-12);
        for turns in [-1000.0, -2.0, -1.0, 1.0, 30.0] {
            let found = force(q + turns * turn);
            for (a, b) in due.iter().zip(found) {
                assert!((a - b).abs() < 1e-9, "{q} {turns}: {a} {b}");
            }
        }
    }
    // Half a turn from the middle the nearer end changes; what is farther than any turn is the end.
    let gravity = |q: f64| force(q)[0];
    assert!((gravity(6.383 + 3.1) - gravity(7.483)).abs() < 1e-12);
    assert!((gravity(6.383 + 3.2) - gravity(5.283)).abs() < 1e-12);
    assert!((gravity(1e300) - gravity(7.483)).abs() < 1e-12);
    // An axis that was moved by more than a turn is where its position says.
    let wide = Channel {
        range: [0.0, 8.0],
        turns: false,
        ..place
    };
    let mut open = terms;
    open.channels.position = wide;
    open.weight = Some(Weight {
        constant: 0.0,
        wave: Wave {
            whole: true,
            ..terms.weight.unwrap().wave
        },
    });
    let mut compensator = bare(open);
    let q = 25.0_f64;
    compensator.step(at(0.2, 0.0, 0.0, q));
    let parts = compensator.state().beside;
    assert!((parts.parts.gravity - parts.held * (7.0 * q.sin() - 2.0 * q.cos())).abs() < 1e-12);
}

/// What cannot be is refused by name.
#[test]
fn numbers_out_of_range_are_refused() {
    let frictionless = CoulombViscous::symmetric(0.0, 1.0, 0.0).unwrap();
    let heavy = CoulombViscous::symmetric(5.0, 1.0, 2.0).unwrap();
    let refused = |law, terms| {
        let law = Friction::Coulomb(law);
        let new = Compensator::new(law, Source::Reference, Settings::bare(H, 1e4));
        new.unwrap().with_terms(terms).unwrap_err().name
    };
    assert_eq!(refused(frictionless, with_levels()), "coulomb");
    assert_eq!(refused(heavy, fed()), "offset");
    let mut outside = with_levels();
    outside.channels.temperature.reference = 400.0;
    assert_eq!(refused(heavy, outside), "temperature_reference");
    let negative = Terms {
        mass: -1.0,
        ..Terms::default()
    };
    assert_eq!(refused(heavy, negative), "mass");
}

proptest! {
    /// Whatever comes in, the force is finite and within the limit.
    #[test]
    fn the_sum_is_limited_whatever_comes_in(
        samples in prop::collection::vec(
            (any::<f64>(), any::<f64>(), any::<f64>(), any::<f64>(), any::<f64>(), any::<f64>(), any::<bool>(), any::<bool>()), 1..60),
    ) {
        let settings = Settings { slew: 3e4, ..Settings::new(H, 30.0) };
        let terms = Terms { levels: Some(levels()), ..fed() };
        let compensator = Compensator::new(offset_free(300.0), Source::Reference, settings).unwrap();
        let mut compensator = compensator.with_terms(terms).unwrap();
        let mut last = 0.0;
        for (v, a, load, temperature, position, e, enable, usual) in samples {
            let v = if usual { v % 1.0 } else { v };
            let input = Input { reference_acceleration: a, tracking_error: e, enable, ..at(v, load, temperature, position) };
            let force: f64 = compensator.step(input);
            prop_assert!(force.is_finite() && force.abs() <= 30.0);
            prop_assert!((force - last).abs() <= 30.0 * (1.0 + 1e-12));
            last = force;
        }
    }
}
