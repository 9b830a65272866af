//! What a compensator keeps while it is off, and what it refuses.

use crate::common::lopsided;
use proptest::prelude::*;
use stiction_friction::compensator::{
    Adaptation, Compensator, Friction, Input, MEMORY, Settings, Source, Watchdog,
};
use stiction_friction::{CoulombViscous, Damping, Real, Shape};

const H: f64 = 1e-3;

fn settings<T: Real>(mass: f64) -> Settings<T> {
    Settings {
        adaptation: Some(Adaptation {
            mass: T::from_f64(mass),
            ..Adaptation::default()
        }),
        watchdog: Some(Watchdog {
            window: T::from_f64(0.4),
            ratio: T::ONE,
        }),
        ..Settings::new(T::from_f64(H), T::from_f64(100.0))
    }
}

fn bristles(shape: Shape<f64>) -> Friction<f64> {
    Friction::LuGre(lopsided(shape, Damping::Capped(600.0)))
}

/// One that has learnt levels of 1.2 and the error without compensation, the force of the drive being that much; `worse` than
/// without it in the end.
fn learnt(worse: bool) -> Compensator<f64> {
    let law = bristles(Shape::Gaussian);
    let mut compensator = Compensator::new(law, Source::Reference, settings(0.0)).unwrap();
    let mut plain = Compensator::new(law, Source::Reference, Settings::bare(H, 1e3)).unwrap();
    let mut before = 0.0;
    for k in 0..12_000 {
        let v = 0.1 * libm::sin(std::f64::consts::PI * f64::from(k) / 400.0);
        let input = Input {
            reference_velocity: v,
            tracking_error: if worse && k > 9000 { 1e-4 } else { 1e-6 },
            enable: true,
            drive_force: 1.2 * before,
            learn: true,
            ..Input::default()
        };
        compensator.step(input);
        before = plain.step(input);
    }
    assert_eq!(compensator.state().watch.tripped(), worse);
    compensator
}

#[test]
fn what_was_learnt_comes_back() {
    let before = learnt(false);
    let mut after = Compensator::new(*before.friction(), Source::Reference, settings(0.0)).unwrap();
    after.recall(&before.memory()).unwrap();
    assert_eq!(after.state().learnt.level, before.state().learnt.level);
    assert!((after.state().learnt.level - 1.2).abs() < 0.05);
    assert_eq!(
        after.state().watch.baseline(),
        before.state().watch.baseline()
    );
    assert_eq!(after.memory(), before.memory());
    // It compensates at once, with the levels, and learns on from them.
    let input = Input {
        reference_velocity: 0.05,
        enable: true,
        ..Input::default()
    };
    for _ in 0..200 {
        after.step(input);
    }
    let mut fresh = Compensator::new(*before.friction(), Source::Reference, settings(0.0)).unwrap();
    assert_eq!(fresh.step(input), 0.0);
    assert!(after.step(input) > 0.8 * 20.0);
    assert_eq!(after.state().learnt.level, before.state().learnt.level);
}

/// Being off for a night does not arm a watchdog again.
#[test]
fn one_that_had_switched_off_still_has() {
    let before = learnt(true);
    let mut after = Compensator::new(*before.friction(), Source::Reference, settings(0.0)).unwrap();
    after.recall(&before.memory()).unwrap();
    assert_eq!(after.state().watch.trip, before.state().watch.trip);
    // Nor does an older memory arm it.
    after.recall(&learnt(false).memory()).unwrap();
    assert!(after.state().watch.tripped());
    after.reset();
    assert!(!after.state().watch.tripped());
}

/// A memory of another law, mass or number type, an empty one and one of another version leave everything as it was.
#[test]
fn foreign_memories_are_refused() {
    let memory = learnt(false).memory();
    let flat = CoulombViscous::new([20.0, 14.0], [60.0, 85.0], -3.0).unwrap();
    let others = [
        (bristles(Shape::Exponential), 0.0),
        (bristles(Shape::Power(2.0 + 1e-15)), 0.0),
        (bristles(Shape::Gaussian), 4.0),
        (Friction::Coulomb(flat), 0.0),
    ];
    for (law, mass) in others {
        let mut other = Compensator::new(law, Source::Reference, settings(mass)).unwrap();
        let was = other;
        assert!(other.recall(&memory).is_err(), "{law:?}");
        assert_eq!(other, was);
    }
    let mut own =
        Compensator::new(bristles(Shape::Gaussian), Source::Reference, settings(0.0)).unwrap();
    assert!(own.recall(&[0.0; MEMORY]).is_err());
    assert!(own.recall(&[f64::NAN; MEMORY]).is_err());
}

/// What cannot have been learnt is refused whole: a level beyond the range of the adaptation, a mean square beyond the square of the
/// peak; and so is a memory that comes while force is let out. Without adaptation levels count for nothing.
#[test]
fn what_cannot_be_is_refused() {
    let memory = learnt(false).memory();
    let narrow = Settings {
        adaptation: Some(Adaptation {
            range: 0.1,
            ..Adaptation::default()
        }),
        ..settings(0.0)
    };
    let law = bristles(Shape::Gaussian);
    let mut held = Compensator::new(law, Source::Reference, narrow).unwrap();
    assert!(held.recall(&memory).is_err());
    assert_eq!(held.state().learnt.level, 1.0);
    let mut own = Compensator::new(law, Source::Reference, settings(0.0)).unwrap();
    for (at, value) in [(1, 5.0), (2, -5.0), (2, 0.0), (3, 1e9)] {
        let mut foreign = memory;
        (foreign[at], foreign[at + MEMORY / 2]) = (value, -value);
        let was = own;
        assert!(own.recall(&foreign).is_err(), "{at}: {value}");
        assert_eq!(own, was);
    }
    own.recall(&memory).unwrap();
    let running = Input {
        reference_velocity: 0.05,
        tracking_error: 1e-9,
        enable: true,
        ..Input::default()
    };
    own.step(running);
    assert!(own.state().share > 0.0);
    assert!(own.recall(&memory).is_err());
    let without = Settings {
        adaptation: None,
        ..narrow
    };
    let mut without = Compensator::new(law, Source::Reference, without).unwrap();
    without.recall(&memory).unwrap();
    assert_eq!(without.state().learnt.level, 1.0);
}

proptest! {
    /// Single precision holds keys and numbers exactly.
    #[test]
    fn single_precision_recalls_its_own(mass in 0.0..10.0_f64) {
        let Friction::LuGre(law) = bristles(Shape::Gaussian) else { unreachable!() };
        let small = Friction::LuGre(law.cast::<f32>().unwrap());
        let mut one = Compensator::new(small, Source::Reference, settings::<f32>(mass)).unwrap();
        let memory = one.memory();
        prop_assert!(one.recall(&memory).is_ok());
        prop_assert_eq!(one.memory(), memory);
    }

    /// Any one number that is changed, by as little as its last digit, is noticed.
    #[test]
    fn damage_is_noticed(at in 0..MEMORY, bits in any::<u64>()) {
        let before = learnt(false);
        let mut memory = before.memory();
        for damaged in [f64::from_bits(bits), f64::from_bits(memory[at].to_bits() ^ 1)] {
            prop_assume!(damaged != memory[at]);
            memory[at] = damaged;
            let mut after = Compensator::new(*before.friction(), Source::Reference, settings(0.0)).unwrap();
            prop_assert!(after.recall(&memory).is_err());
        }
    }
}
