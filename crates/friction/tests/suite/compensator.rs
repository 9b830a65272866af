//! The compensator: what it lets through, what it does with bad input, and that it creates no energy.

use crate::common::*;
use proptest::prelude::*;
use stiction_friction::compensator::{
    Adaptation, Compensator, DisturbanceObserver, DisturbanceState, Friction, Input, Settings,
    Source, Watchdog,
};
use stiction_friction::{CoulombViscous, Damping, ElastoPlastic, Element, LuGre, MaxwellSlip};

const H: f64 = 250e-6;

fn moving(velocity: f64) -> Input<f64> {
    Input {
        reference_velocity: velocity,
        measured_velocity: velocity,
        tracking_error: 0.0,
        enable: true,
        ..Input::default()
    }
}

fn bare(law: LuGre<f64>, source: Source<f64>) -> Compensator<f64> {
    let settings = Settings::bare(H, 1e12);
    Compensator::new(Friction::LuGre(law), source, settings).unwrap()
}

/// Every law, from a LuGre law.
fn every_law(law: LuGre<f64>) -> [Friction<f64>; 5] {
    let curve = *law.curve();
    let sides = [curve.positive(), curve.negative()];
    let [coulomb, viscous] = [sides.map(|s| s.coulomb), sides.map(|s| s.viscous)];
    let part = |k: f64, share: f64| Element {
        stiffness: k * law.stiffness(),
        share,
    };
    let elements = [part(0.6, 0.3), part(0.3, 0.3), part(0.1, 0.4)];
    [
        Friction::LuGre(law),
        Friction::ElastoPlastic(ElastoPlastic::new(law, 0.7).unwrap()),
        Friction::Gms(MaxwellSlip::new(&elements, 50.0 * sides[0].coulomb, curve).unwrap()),
        Friction::Stribeck(curve),
        Friction::Coulomb(CoulombViscous::new(coulomb, viscous, curve.offset()).unwrap()),
    ]
}

fn any_source() -> impl Strategy<Value = Source<f64>> {
    prop_oneof![
        Just(Source::Reference),
        Just(Source::Measured),
        (0.0..=1.0).prop_map(Source::Blend),
        (0.0..1e3).prop_map(Source::Observer),
    ]
}

fn any_settings() -> impl Strategy<Value = Settings<f64>> {
    (
        (1e-5..1e-2, 0.0..=1.0, 0.0..1e-3, 1e-3..1e3),
        prop_oneof![Just(f64::MAX), 1.0..1e6],
        prop_oneof![Just(0.0), 0.0..1.0],
        prop::option::of((1e-3..1e3, 0.01..0.9, prop_oneof![Just(0.0), 1e-3..1e3])),
        prop::option::of((1e-3..1.0, 0.1..10.0)),
    )
        .prop_map(
            |((cycle_time, gain, dead_zone, limit), slew, ramp, adaptation, watchdog)| Settings {
                cycle_time,
                gain,
                dead_zone,
                limit,
                slew,
                ramp,
                adaptation: adaptation.map(|(memory, range, mass)| Adaptation {
                    memory,
                    range,
                    mass,
                }),
                watchdog: watchdog.map(|(window, ratio)| Watchdog { window, ratio }),
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Whatever comes in, the force is finite, within the limit, and changes no faster than allowed.
    #[test]
    fn limits_hold_whatever_comes_in(
        law in any_law(),
        which in 0..5usize,
        source in any_source(),
        settings in any_settings(),
        samples in prop::collection::vec(
            (any::<f64>(), any::<f64>(), any::<f64>(), any::<f64>(), any::<f64>(), any::<bool>(), any::<bool>()), 1..60),
    ) {
        let friction = every_law(law)[which];
        let source = match source {
            Source::Observer(_) if which > 0 => Source::Measured,
            source => source,
        };
        let mut compensator = Compensator::new(friction, source, settings).unwrap();
        let mut last = 0.0;
        for (h, v, w, e, u, enable, usual) in samples {
            let (h, v, w, e) = if usual { (settings.cycle_time, v % 1.0, w % 1.0, e % 1e-3) } else { (h, v, w, e) };
            let input = Input { reference_velocity: v, measured_velocity: w, tracking_error: e, enable, drive_force: u, learn: true, ..Input::default() };
            let force = compensator.step_in(h, input);
            prop_assert!(force.is_finite() && force.abs() <= settings.limit);
            let most = if h.is_finite() && h >= 0.0 { h * settings.slew } else { 0.0 };
            prop_assert!((force - last).abs() <= most * (1.0 + 1e-12) + 1e-12 * settings.limit);
            let state = compensator.state();
            prop_assert!(state.law.z.abs() <= law.bound() * (1.0 + 1e-12));
            let elements = state.law.elements.force.iter().map(|f| f.abs()).sum::<f64>();
            prop_assert!(elements <= friction.scale() * (1.0 + 1e-12));
            last = force;
        }
        compensator.reset();
        prop_assert_eq!(compensator, Compensator::new(friction, source, settings).unwrap());
    }

    /// With nothing to hold it back the force is the law's, bit for bit.
    #[test]
    fn bare_is_the_law(law in any_law(), motion in motion()) {
        for source in [Source::Reference, Source::Measured, Source::Blend(1.0), Source::Observer(7.0)] {
            let mut compensator = bare(law, source);
            let mut state = law.rest();
            for &v in &motion {
                prop_assert_eq!(compensator.step(moving(v)), law.step(&mut state, H, v));
            }
        }
    }

    /// The same for the laws that creep less and remember more.
    #[test]
    fn bare_is_every_law(law in any_law(), motion in motion()) {
        for friction in every_law(law) {
            let mut compensator = Compensator::new(friction, Source::Reference, Settings::bare(H, 1e12)).unwrap();
            let (mut bristle, mut elements) = (law.rest(), None);
            for &v in &motion {
                let due = match &friction {
                    Friction::LuGre(law) => law.step(&mut bristle, H, v),
                    Friction::ElastoPlastic(law) => law.step(&mut bristle, H, v),
                    Friction::Gms(law) => law.step(elements.get_or_insert(law.rest()), H, v),
                    Friction::Stribeck(curve) => curve.force(v),
                    Friction::Coulomb(law) => law.force(v),
                };
                prop_assert_eq!(compensator.step(moving(v)), due);
            }
        }
    }

    /// A reference-driven compensator does not see the axis: no measurement changes its force.
    #[test]
    fn feedforward_is_blind(law in any_law(), motion in motion(), noise in prop::collection::vec(-1.0..1.0, 30)) {
        let (mut seeing, mut blind) = (bare(law, Source::Reference), bare(law, Source::Reference));
        for (&v, n) in motion.iter().zip(noise) {
            let noisy = Input { measured_velocity: n, tracking_error: 1e-3 * n, ..moving(v) };
            prop_assert_eq!(seeing.step(noisy), blind.step(moving(v)));
        }
    }
}

/// `f64` and `f32` agree to single precision: 2000 samples through reversals.
#[test]
fn single_precision_agrees() {
    let law = lopsided(stiction_friction::Shape::Gaussian, Damping::Capped(600.0));
    let small = Compensator::new(
        Friction::LuGre(law.cast::<f32>().unwrap()),
        Source::Reference,
        Settings {
            watchdog: None,
            ..Settings::new(H as f32, 60.0)
        },
    );
    let large = Compensator::new(
        Friction::LuGre(law),
        Source::Reference,
        Settings {
            watchdog: None,
            ..Settings::new(H, 60.0)
        },
    );
    let (mut small, mut large) = (small.unwrap(), large.unwrap());
    for k in 0..20_000 {
        let v = 0.02 * libm::sin(2.0 * std::f64::consts::PI * 3.0 * f64::from(k) * H);
        let input = Input {
            reference_velocity: v as f32,
            enable: true,
            ..Input::default()
        };
        let (a, b) = (large.step(moving(v)), small.step(input));
        assert!((a - f64::from(b)).abs() < 5e-3, "{k}: {a} {b}");
    }
    assert_eq!(large.state().share, 0.75);
}

/// Enabled and disabled at speed, the force comes and goes in steps of its share of the ramp.
#[test]
fn the_ramp_is_bumpless() {
    let law = Friction::Coulomb(CoulombViscous::symmetric(20.0, 0.0, 0.0).unwrap());
    let settings = Settings {
        gain: 1.0,
        ramp: 100.0 * H,
        watchdog: None,
        ..Settings::new(H, 50.0)
    };
    let mut compensator = Compensator::new(law, Source::Reference, settings).unwrap();
    for k in 1..=300 {
        let enable = k <= 150;
        let force = compensator.step(Input {
            enable,
            ..moving(0.1)
        });
        let expected = match k {
            ..=100 => 0.2 * f64::from(k),
            101..=150 => 20.0,
            _ => (20.0 - 0.2 * f64::from(k - 150)).max(0.0),
        };
        assert!((force - expected).abs() < 1e-10, "{k}: {force} {expected}");
    }
}

/// A sensor that fails takes the force with it, and brings it back; one that comes and goes costs no jump.
#[test]
fn bad_samples_fade() {
    let settings = Settings {
        gain: 1.0,
        ramp: 100.0 * H,
        watchdog: None,
        ..Settings::new(H, 50.0)
    };
    let law = Friction::LuGre(c95(Damping::Capped));
    let mut compensator = Compensator::new(law, Source::Reference, settings).unwrap();
    for _ in 0..200 {
        compensator.step(moving(0.1));
    }
    let whole = compensator.state().output;
    let bad = [
        Input {
            reference_velocity: f64::NAN,
            ..moving(0.1)
        },
        Input {
            measured_velocity: f64::INFINITY,
            ..moving(0.1)
        },
        Input {
            tracking_error: f64::NAN,
            ..moving(0.1)
        },
    ];
    for k in 1..=100 {
        let law_before = compensator.state().law;
        let force = compensator.step(bad[k % 3]);
        assert!((force - whole * (1.0 - 0.01 * k as f64)).abs() < 1e-12);
        assert_eq!(compensator.state().law, law_before);
    }
    for _ in 0..100 {
        compensator.step(moving(0.1));
    }
    assert!((compensator.state().output - whole).abs() < 1e-9);
}

/// Below the dead zone a chattering measurement moves no bristle.
#[test]
fn the_dead_zone_stills_chatter() {
    let settings = Settings {
        dead_zone: 2e-4,
        ..Settings::bare(H, 50.0)
    };
    let law = Friction::LuGre(c95(Damping::Capped));
    let mut compensator = Compensator::new(law, Source::Measured, settings).unwrap();
    for k in 0..1000 {
        let chatter = if k % 3 == 0 { 2e-4 } else { -1e-4 };
        assert_eq!(compensator.step(moving(chatter)), 0.0);
    }
    assert!(compensator.step(moving(3e-4)) > 0.0);
}

/// The observer's correction `c' = k e - sigma0 |v| c/g` at constant error in closed form, at a standstill and sliding:
/// with the law it is a solution of the observer's equation. At its limit it stands.
#[test]
fn the_observer_corrects_by_its_gain() {
    let law = c95(Damping::Constant);
    let (gain, error) = (10.0, 1e-6);
    for v in [0.0, 2e-4, 0.01] {
        let mut compensator = bare(law, Source::Observer(gain));
        let mut alone = law.rest();
        let input = Input {
            tracking_error: error,
            ..moving(v)
        };
        let decay = law.stiffness() * v / law.curve().level(v);
        for k in 1..=4000 {
            let t = f64::from(k) * H;
            let force = compensator.step(input);
            let law_force = law.step(&mut alone, H, v);
            let grown = |t: f64| {
                if v == 0.0 {
                    t
                } else {
                    -(-decay * t).exp_m1() / decay
                }
            };
            let c = gain * error * grown(t);
            let rate = gain * error * (grown(t) - grown(t - H)) / H;
            let expected = law_force + law.stiffness() * c + law.micro_damping(v) * rate;
            assert!(
                (force - expected).abs() < 1e-8,
                "{v} {k}: {force} {expected}"
            );
        }
    }
    let settings = Settings::bare(H, 0.3);
    let mut limited =
        Compensator::new(Friction::LuGre(law), Source::Observer(gain), settings).unwrap();
    for _ in 0..100_000 {
        limited.step(Input {
            tracking_error: 1e-3,
            ..moving(0.0)
        });
    }
    assert_eq!(limited.state().correction, 0.3 / law.stiffness());
}

/// A reference that turns round every 200 samples.
fn to_and_fro(k: usize) -> f64 {
    if (k / 200).is_multiple_of(2) {
        0.1
    } else {
        -0.1
    }
}

fn watched(gain: f64) -> Settings<f64> {
    Settings {
        gain,
        watchdog: Some(Watchdog {
            window: 0.1,
            ratio: 1.0,
        }),
        ..Settings::bare(H, 50.0)
    }
}

fn coulomb(settings: Settings<f64>) -> Compensator<f64> {
    let law = Friction::Coulomb(CoulombViscous::symmetric(10.0, 0.0, 0.0).unwrap());
    Compensator::new(law, Source::Reference, settings).unwrap()
}

/// It learns first, lets a better run go on, switches a worse one off, and stays off until a reset.
#[test]
fn the_watchdog_trips_on_worse_and_not_on_better() {
    for (with, takes) in [(0.9e-5, None), (1.1e-5, Some(1000)), (1.6e-5, Some(801))] {
        let trips = takes.is_some();
        let mut compensator = coulomb(watched(1.0));
        let mut on = 0;
        for k in 0..6000 {
            let error = if compensator.state().output == 0.0 {
                1e-5
            } else {
                with
            };
            let force = compensator.step(Input {
                tracking_error: error,
                ..moving(to_and_fro(k))
            });
            on += usize::from(force != 0.0);
        }
        assert_eq!(compensator.state().watch.tripped(), trips);
        // From the first turn at 200 a window takes 400 samples: five to learn; with compensation from the next turn on one
        // that is not judged, and one to find out, unless the error is far beyond for half of that.
        let expected = takes.unwrap_or(3800);
        assert!(on.abs_diff(expected) <= 2, "{on} {expected}");
        assert_eq!(compensator.step(moving(0.1)) == 0.0, trips);
        compensator.reset();
        assert!(!compensator.state().watch.tripped());
    }
}

/// Running at once is what a compensator comes to that has learnt, is enabled, and stands for longer than its ramp.
#[test]
fn running_is_as_after_a_while() {
    let mut waited = coulomb(watched(0.75));
    let error = |k: usize| 1e-6 * (1.0 + to_and_fro(k).signum());
    let step = |compensator: &mut Compensator<f64>, k: usize, enable: bool| {
        compensator.step(Input {
            reference_velocity: to_and_fro(k),
            tracking_error: error(k),
            enable,
            ..Input::default()
        })
    };
    let learnt = (0..).find(|k| {
        step(&mut waited, *k, false);
        waited.state().watch.allows()
    });
    assert!(learnt.is_some());
    let mut running = coulomb(watched(0.75)).running(&waited.state().watch);
    for _ in 0..8000 {
        waited.step(Input {
            enable: true,
            ..Input::default()
        });
    }
    for k in 0..20_000 {
        assert_eq!(step(&mut waited, k, true), step(&mut running, k, true));
    }
    assert_eq!(waited.state(), running.state());
}

/// Enabled with a gain of 0 it adds nothing: what it sees is what is normal, however the error changes, and a gain set
/// later is judged by it.
#[test]
fn a_gain_of_nothing_is_without() {
    let mut compensator = coulomb(watched(0.0));
    let run = |compensator: &mut Compensator<f64>, error: f64, spike: f64| {
        for k in 0..3000 {
            let grows = error * (1.0 + 1e-3 * k as f64);
            compensator.step(Input {
                tracking_error: if k == 700 { spike * grows } else { grows },
                ..moving(to_and_fro(k))
            });
        }
        compensator.state().watch
    };
    let learnt = run(&mut compensator, 1e-5, 10.0);
    assert!(learnt.without > 1e-10 && !learnt.tripped() && !learnt.with);
    compensator.set_gain(0.5).unwrap();
    assert!(!run(&mut compensator, 0.5e-5, 1.0).tripped());
    compensator.set_gain(0.8).unwrap();
    assert!(run(&mut compensator, 4e-5, 1.0).tripped());
    assert_eq!(compensator.set_gain(1.1).unwrap_err().name, "gain");
    assert_eq!(compensator.settings().gain, 0.8);
}

/// The first window with a gain is not judged, whatever it takes the controller to let go; nor is one in which the
/// speed stays within the dead zone, where nothing is added.
#[test]
fn the_force_may_come_in() {
    let settings = Settings {
        ramp: 0.05,
        dead_zone: 0.01,
        ..watched(1.0)
    };
    let mut compensator = coulomb(settings);
    let mut since = 0;
    for k in 0..6000 {
        since += usize::from(compensator.state().share > 0.0);
        let error = match since {
            0 => 1e-5,
            1..400 => 9e-5,
            _ => 0.9e-5,
        };
        compensator.step(Input {
            tracking_error: error,
            ..moving(to_and_fro(k))
        });
        assert!(!compensator.state().watch.tripped(), "{k}");
    }
    assert!(since > 3000 && compensator.state().watch.judged);
    for k in 0..4000 {
        // The error of the first sample is that of the force before.
        compensator.step(Input {
            tracking_error: if k == 0 { 0.9e-5 } else { 9e-5 },
            ..moving(0.05 * to_and_fro(k))
        });
    }
    assert!(!compensator.state().watch.tripped());
}

/// What is learnt holds two reversals, however slow the motion: here a stroke is twice as long as the window, and
/// the error is only at the turns. Where there are none, ten windows do.
#[test]
fn a_window_holds_reversals() {
    let mut compensator = coulomb(watched(1.0));
    let mut first = None;
    for k in 0..20_000_usize {
        let at_a_turn = k >= 800 && k % 800 < 20;
        let peak = if compensator.state().output == 0.0 {
            1e-5
        } else {
            0.9e-5
        };
        compensator.step(Input {
            tracking_error: if at_a_turn { peak } else { 1e-7 },
            ..moving(if (k / 800).is_multiple_of(2) {
                0.1
            } else {
                -0.1
            })
        });
        if compensator.state().watch.allows() {
            first = first.or(Some((k, compensator.state().watch.peak_without)));
        }
    }
    assert_eq!(first, Some((8800, 1e-5)));
    assert!(!compensator.state().watch.tripped());
    let mut one_way = coulomb(watched(1.0));
    let learnt = (0..21_000_usize).find(|_| {
        one_way.step(moving(0.1));
        one_way.state().watch.allows()
    });
    assert!(learnt.unwrap().abs_diff(19_999) <= 5, "{learnt:?}");
}

/// Slow there and fast back, with an error that is larger one way: a window of an odd number of strokes would hold now more
/// of the one, now of the other, and what is better would be switched off.
#[test]
fn windows_hold_as_many_strokes_each_way() {
    let mut compensator = coulomb(watched(1.0));
    let mut judged = 0;
    for k in 0..40_000_usize {
        // A window of .1 s is 400 samples, more than two strokes.
        let there = k % 320 < 180;
        let error = if there { 3e-5 } else { 1e-5 };
        let with = if compensator.state().output == 0.0 {
            1.0
        } else {
            0.95
        };
        compensator.step(Input {
            tracking_error: with * error,
            ..moving(if there { 0.1 } else { -0.1 })
        });
        assert!(!compensator.state().watch.tripped(), "{k}");
        judged += usize::from(compensator.state().watch.judged);
    }
    assert!(judged > 30_000, "{judged}");
}

/// A gain that is changed in motion changes the force in steps of its ramp.
#[test]
fn a_new_gain_comes_by_its_ramp() {
    let settings = Settings {
        gain: 0.0,
        ramp: 100.0 * H,
        watchdog: None,
        ..Settings::new(H, 50.0)
    };
    let mut compensator = coulomb(settings);
    let mut last = 0.0;
    for (gain, takes) in [(0.5, 50), (0.8, 30), (0.2, 60), (0.0, 20)] {
        compensator.set_gain(gain).unwrap();
        for k in 1..=150 {
            let force = compensator.step(moving(0.1));
            assert!((force - last).abs() < 0.1 + 1e-12, "{gain} {k}: {force}");
            assert_eq!(
                (force - 10.0 * gain).abs() < 1e-12,
                k >= takes,
                "{gain} {k}"
            );
            last = force;
        }
    }
}

/// A limit that is lowered holds from the next step on, whatever the slew limit and the time of the step; one out of range changes
/// nothing.
#[test]
fn a_lowered_limit_acts_at_once() {
    let settings = Settings {
        slew: 100.0,
        ..Settings::bare(H, 50.0)
    };
    let mut compensator = coulomb(settings);
    for _ in 0..1000 {
        compensator.step(moving(0.1));
    }
    assert_eq!(compensator.step(moving(0.1)), 10.0);
    compensator.set_limit(2.5).unwrap();
    assert_eq!(compensator.step(moving(0.1)), 2.5);
    assert_eq!(compensator.set_limit(0.0).unwrap_err().name, "limit");
    assert_eq!(compensator.settings().limit, 2.5);
    compensator.set_limit(1.5).unwrap();
    for no_time in [f64::NAN, -1.0, f64::INFINITY] {
        assert_eq!(compensator.step_in(no_time, moving(0.1)), 1.5);
    }
}

/// A set speed that is nothing but rounding gets no force from a law without bristles, and no jump of the reference more
/// than a cycle's share of 2 ms of the limit.
#[test]
fn settings_of_a_law() {
    let curve = *c95(Damping::Capped).curve();
    for law in [
        Friction::Stribeck(curve),
        Friction::Coulomb(CoulombViscous::symmetric(10.0, 1.0, 0.0).unwrap()),
    ] {
        let settings = Settings {
            watchdog: None,
            ..Settings::for_law(&law, H)
        };
        let mut compensator = Compensator::new(law, Source::Reference, settings).unwrap();
        for k in 0..1000 {
            let rounding = if k % 2 == 0 { 1e-9 } else { -1e-9 };
            assert_eq!(compensator.step(moving(rounding)), 0.0);
        }
        let mut last = 0.0;
        for k in 0..1000 {
            let force = compensator.step(moving(if k % 50 < 25 { 10.0 } else { -10.0 }));
            let most = settings.limit * H / 2e-3;
            assert!(
                (force - last).abs() <= most * (1.0 + 1e-12),
                "{force} {last}"
            );
            last = force;
        }
    }
    let bristles = Friction::LuGre(c95(Damping::Capped));
    assert_eq!(Settings::for_law(&bristles, H).dead_zone, 0.0);
    assert_eq!(Settings::for_law(&bristles, H).limit, 3.0);
}

/// At standstill under a constant force the estimate is `F (1 - exp(-w t))`; at constant acceleration without friction it
/// settles at the momentum lost in one cycle.
#[test]
fn disturbance_observer_in_closed_form() {
    let observer = DisturbanceObserver::new(10.0, 60.0, H, 100.0).unwrap();
    let mut state = DisturbanceState::default();
    let w = 2.0 * std::f64::consts::PI * 60.0;
    for k in 1..=400 {
        let estimate = observer.step(&mut state, 25.0, 0.0);
        let expected = 25.0 * (1.0 - (-w * f64::from(k) * H).exp());
        assert!(
            (estimate - expected).abs() < 1e-10,
            "{k}: {estimate} {expected}"
        );
    }
    assert_eq!(observer.step(&mut state, 25.0, f64::NAN), 0.0);
    assert!((observer.step(&mut state, 25.0, 0.0) - 25.0).abs() < 1e-10);

    let mut state = DisturbanceState::default();
    let mut v = 0.0;
    let mut last = f64::MAX;
    for _ in 0..4000 {
        v += H * 50.0 / 10.0;
        last = observer.step(&mut state, 50.0, v);
    }
    assert!(last.abs() < 0.05 * 50.0, "{last}");
}

#[test]
fn what_cannot_run_is_named() {
    let law = Friction::LuGre(c95(Damping::Capped));
    let good = Settings::new(H, 50.0);
    let name = |s: Settings<f64>| {
        Compensator::new(law, Source::Reference, s)
            .unwrap_err()
            .name
    };
    assert_eq!(
        name(Settings {
            cycle_time: 0.0,
            ..good
        }),
        "cycle_time"
    );
    assert_eq!(name(Settings { gain: 1.01, ..good }), "gain");
    assert_eq!(
        name(Settings {
            dead_zone: -1.0,
            ..good
        }),
        "dead_zone"
    );
    assert_eq!(
        name(Settings {
            limit: f64::INFINITY,
            ..good
        }),
        "limit"
    );
    assert_eq!(name(Settings { slew: 0.0, ..good }), "slew");
    assert_eq!(
        name(Settings {
            ramp: f64::NAN,
            ..good
        }),
        "ramp"
    );
    let adaptation = Some(Adaptation {
        range: 1.0,
        ..Adaptation::default()
    });
    assert_eq!(name(Settings { adaptation, ..good }), "adaptation_range");
    let watchdog = Some(Watchdog {
        window: 0.0,
        ratio: 1.0,
    });
    assert_eq!(name(Settings { watchdog, ..good }), "watchdog_window");

    let of = |friction, source| Compensator::new(friction, source, good).unwrap_err().name;
    assert_eq!(of(law, Source::Blend(-0.1)), "blend");
    let plain = Friction::Coulomb(CoulombViscous::symmetric(1.0, 0.0, 0.0).unwrap());
    assert_eq!(of(plain, Source::Observer(1.0)), "observer_gain");
}

/// Work of the compensating force over closed cycles: 10 000 random motions that end where they began, run until the
/// bristles repeat too. Whatever is returned in a part of the cycle is less than what was taken in the rest.
#[test]
fn no_energy_is_gained_over_closed_cycles() {
    let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::with_cases(10_000));
    let case = (
        any_law(),
        -3.0..6.0_f64,
        prop_oneof![1e-6..1e-4, 1e-4..1e-2],
        prop::collection::vec((-7.0..1.0_f64, any::<bool>()), 2..30),
        0.1..=1.0_f64,
    );
    let cycles = |(law, s1, h, parts, gain): (LuGre<f64>, f64, f64, Vec<(f64, bool)>, f64)| {
        let law = law.with_damping(Damping::Capped(10f64.powf(s1))).unwrap();
        let settings = Settings {
            gain,
            ..Settings::bare(h, 1e12)
        };
        let mut compensator =
            Compensator::new(Friction::LuGre(law), Source::Reference, settings).unwrap();
        let mut motion: Vec<f64> = parts
            .iter()
            .map(|&(e, up)| if up { 10f64.powf(e) } else { -10f64.powf(e) })
            .collect();
        motion.push(-motion.iter().sum::<f64>());
        for _ in 0..50 {
            let (before, mut work, mut scale) = (compensator.state().law.z, 0.0, 0.0);
            for &v in &motion {
                let force = compensator.step(moving(v)) - gain * law.curve().offset();
                work += force * v * h;
                scale += force.abs() * v.abs() * h;
            }
            let z = compensator.state().law.z;
            let stored = 0.5 * gain * law.stiffness() * (z - before) * (z + before);
            let rounding = 1e-12
                * (scale
                    + law.stiffness() * law.bound() * law.bound()
                    + law.curve().offset().abs() * motion.iter().map(|v| v.abs() * h).sum::<f64>());
            prop_assert!(work - stored >= -rounding, "{work} {stored}");
            if z == before {
                prop_assert!(work >= -rounding, "{work} J in a closed cycle");
                break;
            }
        }
        Ok(())
    };
    runner.run(&case, cycles).unwrap();
}

/// A factor that takes the force of a velocity that no machine has beyond the number type makes none, least of all while it is
/// not enabled.
#[test]
fn a_force_beyond_the_number_type_is_none() {
    let law = lopsided(stiction_friction::Shape::Gaussian, Damping::Capped(600.0));
    let settings = Settings {
        adaptation: Some(Adaptation::default()),
        ..Settings::bare(H, 1e12)
    };
    let mut compensator =
        Compensator::new(Friction::LuGre(law), Source::Reference, settings).unwrap();
    let mut kept = compensator.memory();
    for (k, level) in [(1, 1.5), (2, 1.5), (7, -1.5), (8, -1.5)] {
        kept[k] = level;
    }
    compensator.recall(&kept).unwrap();
    let fast = Input {
        enable: false,
        ..moving(2.5e306)
    };
    assert_eq!(compensator.step(fast), 0.0);
    assert_eq!(compensator.step(moving(2.5e306)), 0.0);
    assert!(compensator.step(moving(0.1)) > 0.0);
}
