//! The simulated axis against the servo crate, its derivatives against finite differences.

use super::controller::{Controller, Memory, Wanted};
use super::drawn::Drawn;
use super::elements::{Elements, Slipping, spread};
use super::plant::{Axis, Curve, State, Wave};
use super::run::{Hold, Run};
use super::simulate::{Drive, Initial, Plant as _, simulate, simulate_with_slopes};
use super::unknowns::Layout;
use crate::law::terms::{Delay, Mass, Terms};
use crate::law::{Law, LawKind};
use stiction_friction::{Damping, Direction, Gms, LuGre, Shape, Stribeck};
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::path::Reference;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_testkit::MeanOfEnds;

fn axis() -> Axis {
    let side = |coulomb, fixed, velocity, viscous| Curve {
        coulomb,
        fixed,
        velocity,
        viscous,
    };
    Axis {
        stiffness: 1.2e5,
        micro_damping: 600.0,
        sides: [side(20.0, 30.0, 5e-3, 60.0), side(17.0, 24.0, 8e-3, 75.0)],
        exponent: 2.0,
        mass: 10.0,
        offset: 1.5,
        delay: 0.0,
        waves: Vec::new(),
        elements: None,
    }
}

fn plant(axis: &Axis) -> Plant<MeanOfEnds> {
    let side = |c: &Curve| Direction {
        coulomb: c.coulomb,
        static_friction: c.fixed,
        stribeck_velocity: c.velocity,
        viscous: c.viscous,
    };
    let shape = Shape::Power(axis.exponent);
    let curve = Stribeck::new(
        shape,
        side(&axis.sides[0]),
        side(&axis.sides[1]),
        axis.offset,
    );
    let damping = Damping::Constant(axis.micro_damping);
    let law = LuGre::new(axis.stiffness, damping, curve.unwrap()).unwrap();
    Plant::new(axis.mass, MeanOfEnds(law)).unwrap()
}

/// Elements that yield between a tenth of a millimetre and two.
fn elements(many: usize, attracted: bool) -> Elements {
    Elements {
        all: spread(many, 30.0, 4e-4, 20.0),
        ratio: 0.8,
        attraction: if attracted { 60.0 } else { f64::INFINITY },
    }
}

/// With elements, too, and where they follow a Stribeck curve.
#[test]
fn a_step_with_elements_is_that_of_the_servo_crate() {
    for attracted in [false, true] {
        let mut axis = axis();
        axis.elements = Some(elements(3, attracted));
        if !attracted {
            axis.sides.iter_mut().for_each(|s| s.fixed = s.coulomb);
        }
        axis.follow_elements();
        let known = axis.elements.clone().unwrap();
        let side = |c: &Curve| Direction {
            coulomb: c.coulomb,
            static_friction: c.fixed,
            stribeck_velocity: c.velocity,
            viscous: c.viscous,
        };
        let [up, down] = axis.sides.each_ref().map(side);
        let curve = Stribeck::new(Shape::Gaussian, up, down, axis.offset).unwrap();
        let all = [0, 1, 2].map(|i| stiction_friction::Element {
            stiffness: known.all[i].force / known.all[i].reach,
            share: known.all[i].force,
        });
        let law = Gms::new(all, known.attraction * known.force(), 0.0, curve).unwrap();
        let plant = Plant::new(axis.mass, law).unwrap();
        let mine = Slipping::new(&axis, &known);
        let h = 1e-3;
        let mut state = mine.start(&Initial::default());
        let mut theirs = Motion::default();
        let mut furthest = 0.0_f64;
        for k in 0..4000 {
            state = mine.step(state, h, push(k));
            theirs = plant.step(theirs, h, Load::force(push(k))).motion;
            let off = (state.x - theirs.position).abs();
            assert!(off < 1e-10, "{attracted} {k}: {state:?} {theirs:?}");
            furthest = furthest.max(state.x.abs());
        }
        assert!(furthest > 0.05, "the axis slid: {furthest}");
    }
}

/// Reversals, sticking and sliding.
fn push(k: usize) -> f64 {
    let t = k as f64 * 1e-3;
    45.0 * (6.0 * t).sin() + 15.0 * (31.0 * t).sin()
}

#[test]
fn a_step_is_that_of_the_servo_crate() {
    for exponent in [2.0, 1.3] {
        let axis = Axis { exponent, ..axis() };
        let plant = plant(&axis);
        let h = 1e-3;
        let (mut mine, mut theirs) = (State::default(), Motion::default());
        let mut furthest = 0.0_f64;
        for k in 0..4000 {
            mine = axis.step(mine, h, push(k));
            theirs = plant.step(theirs, h, Load::force(push(k))).motion;
            assert!(
                (mine.x - theirs.position).abs() < 1e-12,
                "{k}: {mine:?} {theirs:?}"
            );
            assert!(
                (mine.v - theirs.velocity).abs() < 1e-9,
                "{k}: {mine:?} {theirs:?}"
            );
            assert!(
                (mine.z - theirs.deflection).abs() < 1e-12,
                "{k}: {mine:?} {theirs:?}"
            );
            furthest = furthest.max(mine.x.abs());
        }
        assert!(furthest > 0.05, "the axis slid: {furthest}");
    }
}

#[test]
fn a_force_is_that_of_the_servo_cascade() {
    let cascade = Cascade {
        position_gain: 40.0,
        speed_gain: 3000.0,
        integral_gain: 60_000.0,
        mass_feedforward: 8.0,
        force_limit: 120.0,
    };
    let controller = Controller {
        position_gain: 40.0,
        speed_gain: 3000.0,
        integral_gain: 60_000.0,
        velocity_feedforward: 1.0,
        mass_feedforward: 8.0,
        force_limit: 120.0,
        rate: None,
    };
    let h = 1e-3;
    let mut theirs = CascadeState::default();
    let mut mine = Memory::default();
    let mut limited = 0;
    for k in 0..3000 {
        let t = k as f64 * h;
        let reference = Reference {
            position: 0.02 * (1.0 - (3.0 * t).cos()),
            velocity: 0.06 * (3.0 * t).sin(),
            acceleration: 0.18 * (3.0 * t).cos(),
        };
        let x = 0.019 * (1.0 - (3.0 * t - 0.03).cos()) - 0.019 * (1.0 - 0.03_f64.cos());
        let wanted = Wanted {
            position: reference.position,
            velocity: reference.velocity,
            acceleration: reference.acceleration,
        };
        let ours = controller.force(&mut mine, h, wanted, x);
        limited += usize::from(ours.is_limited);
        let force = cascade.force(&mut theirs, h, reference, x);
        // The sums are added in another order: the difference is rounding and does not accumulate.
        assert!(
            (ours.force - force).abs() < 1e-10,
            "{k}: {} {force}",
            ours.force
        );
    }
    assert!(limited > 10, "the limit was met: {limited}");
}

fn run(n: usize, periods: usize, closed: bool) -> Run {
    let wanted = |k: usize| {
        let t = k as f64 * 2e-3 / periods as f64;
        Wanted {
            position: 0.03 * (1.0 - (5.0 * t).cos()),
            velocity: 0.15 * (5.0 * t).sin(),
            acceleration: 0.75 * (5.0 * t).cos(),
        }
    };
    Run {
        log: 0,
        stretch: 0,
        step: 2e-3,
        time: (0..n).map(|k| k as f64 * 2e-3).collect(),
        position: vec![0.0; n],
        force: (0..n).map(|k| push(2 * k)).collect(),
        wanted: if closed {
            (0..n * periods).map(wanted).collect()
        } else {
            Vec::new()
        },
        external: match closed {
            true => (0..n).map(|k| 7.0 * (0.04 * k as f64).sin()).collect(),
            false => Vec::new(),
        },
        keep: vec![true; n],
    }
}

fn open(hold: Hold, substeps: usize) -> Drive<'static> {
    Drive {
        controller: None,
        hold,
        substeps,
    }
}

/// Every derivative of position and force against central differences of the simulation itself.
/// Differences of three step lengths: a long one can reach across a reversal, where the derivative jumps,
/// and a short one loses digits.
#[test]
fn derivatives_agree_with_differences() {
    let pi = Controller {
        position_gain: 25.0,
        speed_gain: 900.0,
        integral_gain: 9000.0,
        velocity_feedforward: 0.7,
        mass_feedforward: 6.0,
        // An integral that is stopped at the limit jumps with the sample at which it is stopped, which no
        // derivative shows; a force that is only limited does not jump.
        force_limit: f64::INFINITY,
        rate: Some(1000.0),
    };
    let p = Controller {
        integral_gain: 0.0,
        force_limit: 70.0,
        ..pi
    };
    let terms = Terms {
        mass: Mass::Fitted,
        offset: true,
        gravity: true,
        cogging: vec![0.024],
        ..Terms::default()
    };
    let mut checked = 0;
    // Delays inside of a sample; at its ends the derivative jumps.
    for (controller, hold, delay) in [
        (None, Hold::Held, Some(0.7e-3)),
        (None, Hold::Centred, Some(-3.1e-3)),
        (Some(&p), Hold::Held, None),
        (Some(&pi), Hold::Held, Some(-1.7e-3)),
        (Some(&pi), Hold::Held, Some(-0.2e-3)),
        (Some(&pi), Hold::Centred, None),
    ] {
        let terms = Terms {
            delay: delay.map_or(Delay::NONE, |_| Delay::Fitted),
            ..terms.clone()
        };
        for law in [
            Law::new(LawKind::LuGre),
            Law::new(LawKind::LuGre).asymmetric(),
            Law::new(LawKind::Dahl),
            Law {
                exponent: 1.4,
                ..Law::new(LawKind::Stribeck).asymmetric()
            },
            Law::new(LawKind::CoulombViscous),
            Law {
                elements: 3,
                ..Law::new(LawKind::MaxwellSlip).asymmetric()
            },
            Law {
                elements: 4,
                ..Law::new(LawKind::Gms).asymmetric()
            },
        ] {
            let layout = Layout::new(&law, &terms);
            let mut base = axis();
            base.exponent = law.exponent;
            base.delay = delay.unwrap_or(0.0);
            base.waves = layout
                .waves
                .iter()
                .map(|(w, _)| Wave { factor: 2.0, ..*w })
                .collect();
            if !law.asymmetric {
                base.sides[1] = base.sides[0];
            }
            if !law.kind.has_stribeck() {
                base.sides.iter_mut().for_each(|s| s.fixed = s.coulomb);
            }
            if law.kind.has_elements() {
                base.micro_damping = 0.0;
                base.elements = Some(elements(law.elements, law.kind == LawKind::Gms));
                base.follow_elements();
            }
            let q = layout.read(&base);
            let drive = Drive {
                controller,
                hold,
                substeps: 2,
            };
            let run = run(
                400,
                if controller.is_some() { 2 } else { 1 },
                controller.is_some(),
            );
            let initial = Initial([1e-4, 2e-3, 0.4, 3.0]);
            let simulated = |q: &[f64], initial: &Initial| {
                let axis = layout.write(&base, q);
                let mut out = Vec::new();
                simulate(&axis, &drive, &run, initial, |_, s, f| {
                    out.push([s.x, f]);
                    true
                });
                out
            };
            let count = layout.len() + drive.locals();
            let mut slopes = Vec::new();
            let here = layout.write(&base, &q);
            simulate_with_slopes(&here, &layout, &drive, &run, &initial, |_, now| {
                slopes.push((now.position_slopes.to_vec(), now.force_slopes.to_vec()));
                true
            });
            for j in 0..count {
                let size = if j < layout.len() {
                    1e-6 * q[j].abs().max(1.0)
                } else {
                    [1e-8, 1e-7, 1e-6, 1e-4][j - layout.len()]
                };
                let moved = |d: f64| {
                    let (mut q, mut initial) = (q.clone(), initial);
                    match j.checked_sub(layout.len()) {
                        None => q[j] += d,
                        Some(own) => initial.0[own] += d,
                    }
                    simulated(&q, &initial)
                };
                let pairs = [10.0, 1.0, 0.1].map(|part| {
                    let d = part * size;
                    (moved(d), moved(-d), d)
                });
                for channel in 0..if controller.is_some() { 2 } else { 1 } {
                    let exact = slopes
                        .iter()
                        .map(|(x, f)| if channel == 0 { x[j] } else { f[j] });
                    let exact: Vec<f64> = exact.collect();
                    let apart = |(up, down, d): &(Vec<[f64; 2]>, Vec<[f64; 2]>, f64)| {
                        let (mut off, mut norm) = (0.0, 0.0);
                        for ((a, b), e) in up.iter().zip(down).zip(&exact) {
                            let difference = (a[channel] - b[channel]) / (2.0 * d);
                            off += (e - difference) * (e - difference);
                            norm += difference * difference;
                        }
                        off.sqrt() / (norm.sqrt() + 1e-9)
                    };
                    let off = pairs.iter().map(apart).fold(f64::INFINITY, f64::min);
                    let what = layout.unknowns.get(j);
                    assert!(
                        off <= 2e-5,
                        "{law:?} {what:?} ({j}) channel {channel} {hold:?}: off by {off:e}"
                    );
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 250, "{checked}");
}

#[test]
fn what_is_written_is_read_again() {
    for law in [
        Law::new(LawKind::LuGre).asymmetric(),
        Law::new(LawKind::LuGre),
    ] {
        let layout = Layout::new(&law, &Terms::default());
        let mut base = axis();
        if !law.asymmetric {
            base.sides[1] = base.sides[0];
        }
        let q = layout.read(&base);
        for (a, b) in q.iter().zip(layout.read(&layout.write(&base, &q))) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }
}

/// A force that rises by one a sample, as it acts on the axis.
#[test]
fn a_row_acts_where_hold_and_delay_say() {
    let run = Run {
        force: (0..20).map(f64::from).collect(),
        ..run(20, 1, false)
    };
    let step = run.step;
    for substeps in [1, 4] {
        for delay in [-2.5, -1.0, -0.3, 0.0, 0.6, 1.0, 3.2] {
            for (hold, half) in [(Hold::Held, 0.0), (Hold::Centred, 0.5)] {
                let drive = open(hold, substeps);
                let drawn = Drawn::new(&run, &drive, delay * step);
                let mut mean = 0.0;
                for j in 0..substeps {
                    mean += drawn.at(10, j) / substeps as f64;
                }
                // Over a sample the rows that act are those between `later` and `later + 1` samples before.
                assert!(
                    (mean - (10.0 + half + delay)).abs() < 1e-9,
                    "{hold:?} {delay} {mean}"
                );
                let slopes: f64 = (0..substeps).map(|j| drawn.slope(10, j)).sum();
                assert!(
                    (slopes / substeps as f64 * step - 1.0).abs() < 1e-9,
                    "{slopes}"
                );
            }
        }
    }
    // Beyond the ends the end values go on.
    let early = Drawn::new(&run, &open(Hold::Held, 1), -30.0 * step);
    assert_eq!(early.at(5, 0), 0.0);
    let late = Drawn::new(&run, &open(Hold::Held, 1), 30.0 * step);
    assert_eq!(late.at(5, 0), 19.0);
}
