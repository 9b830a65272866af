//! Break-away under force ramps: the 1995 experiment, and what is no ramp.

use stiction_identify::procedure::{BreakAway, Run, break_away, predict_break_away};
use stiction_identify::{Error, Samples};
use stiction_servo::known;
use stiction_servo::plant::{Load, Motion, Plant};

fn block() -> Plant {
    let axis = known::find("C95").unwrap();
    Plant::new(axis.mass, axis.law).unwrap()
}

/// Experiment D, from an adaptive Radau integration: rate, N/s, and first maximum of friction, N.
const D: [(f64, f64); 8] = [
    (0.1, 1.4852),
    (1.0, 1.4324),
    (2.0, 1.3944),
    (5.0, 1.3132),
    (10.0, 1.2200),
    (20.0, 1.0986),
    (30.0, 1.0245),
    (50.0, 1.007),
];

#[test]
fn the_prediction_is_the_1995_experiment() {
    for (rate, expected) in D {
        let found = predict_break_away(&block(), rate, 1e-3 / 3.0).unwrap();
        println!("{rate}: {found:?}");
        assert!(
            (found.friction / expected - 1.0).abs() < 5e-3,
            "{rate}: {found:?}"
        );
    }
    for (rate, threshold) in [
        (0.0, 1.0),
        (-1.0, 1.0),
        (f64::NAN, 1.0),
        (1.0, 0.0),
        (1e300, 1e300),
        (1e-300, 1.0),
    ] {
        let _ = predict_break_away(&block(), rate, threshold);
    }
}

/// A log of a ramp after a tenth of its time at rest.
fn ramp(rate: f64, step: f64, count: f64) -> Samples {
    let plant = block();
    let mut motion = Motion::default();
    let mut out = Samples::default();
    let mut position = Vec::new();
    let n = (2.0 / rate / step) as usize;
    let wait = n / 10;
    let fine = (step / 2e-5).ceil();
    for k in 0..n + wait {
        let t = (k as f64 - wait as f64) * step;
        out.time.push(k as f64 * step);
        out.force.push(rate * t.max(0.0));
        let x = motion.position;
        position.push(if count > 0.0 {
            (x / count).round() * count
        } else {
            x
        });
        for i in 0..fine as usize {
            let at = t + (i as f64 + 0.5) * step / fine;
            let load = Load::force(rate * at.max(0.0));
            motion = plant.step(motion, step / fine, load).motion;
        }
    }
    out.position = Some(position);
    out
}

fn found(log: &Samples, count: f64, threshold: Option<f64>) -> Result<BreakAway, Error> {
    let run = Run {
        samples: log,
        reference: None,
        resolution: Some(count),
    };
    break_away(&run, threshold, 0)
}

/// From the log of a fine encoder the criterion gives what it gives on the exact motion; at the rates
/// at which friction peaks before the axis is fast, that is the peak of friction.
#[test]
fn break_away_is_found_in_a_log() {
    for (rate, peak) in D.into_iter().take(4) {
        for count in [0.0, 1e-8] {
            let log = ramp(rate, 1e-3_f64.min(2e-4 / rate * 4.0), count);
            let hit = found(&log, count, Some(1e-3 / 3.0)).unwrap();
            let exact = predict_break_away(&block(), rate, hit.threshold).unwrap();
            println!("{rate} {count}: {hit:?}, {exact:?}, peak {peak}");
            assert!((hit.force / exact.force - 1.0).abs() < 0.01);
            assert!((hit.rate / rate - 1.0).abs() < 1e-3);
            if rate <= 2.0 {
                assert!((hit.force / peak - 1.0).abs() < 0.03);
            }
        }
    }
    // Turned round, everything has the other sign.
    let mut log = ramp(1.0, 1e-3, 0.0);
    let forth = found(&log, 0.0, Some(3e-4)).unwrap();
    log.force.iter_mut().for_each(|f| *f = -*f);
    log.position
        .as_mut()
        .unwrap()
        .iter_mut()
        .for_each(|x| *x = -*x);
    let back = found(&log, 0.0, Some(3e-4)).unwrap();
    assert_eq!((back.force, back.rate), (-forth.force, -forth.rate));
}

/// Pulled by a spring that is pulled itself, an axis sticks and slips, and at the end of the ramp it may just stick.
#[test]
fn stick_slip_is_an_answer() {
    let plant = block();
    let (mut motion, mut log, mut position) = (Motion::default(), Samples::default(), Vec::new());
    // Experiment B of 1995: the far end of the spring moves at 0.1 m/s, and the log shows the force of the drive.
    let (pull, spring) = (0.1, 2.0);
    for k in 0..20_000 {
        let t = f64::from(k) * 2e-3;
        log.time.push(t);
        log.force.push(spring * pull * t);
        position.push(motion.position);
        for _ in 0..20 {
            let load = Load {
                force: spring * pull * t,
                stiffness: spring,
            };
            motion = plant.step(motion, 1e-4, load).motion;
        }
    }
    log.position = Some(position);
    let hit = found(&log, 1e-9, Some(1e-3 / 3.0)).unwrap();
    println!("{hit:?}");
    assert!(hit.slips >= 2, "{hit:?}");
    // The first of them, at the static level of 1.5 N.
    assert!((hit.force / 1.5 - 1.0).abs() < 0.05, "{hit:?}");
    // A ramp that goes on moving has none.
    let on = found(&ramp(1.0, 1e-3, 0.0), 0.0, Some(1e-3 / 3.0)).unwrap();
    assert_eq!(on.slips, 0);
}

#[test]
fn what_is_no_break_away_is_refused() {
    let good = ramp(1.0, 1e-3, 0.0);
    let n = good.time.len();
    let refused = |samples: &Samples| match found(samples, 1e-9, None) {
        Err(Error::NoBreakAway { reason, .. }) => reason,
        other => panic!("{other:?}"),
    };
    let still = Samples {
        position: Some(vec![0.0; n]),
        ..good.clone()
    };
    assert!(refused(&still).contains("does not break away"));
    let moving = Samples {
        position: Some((0..n).map(|i| 1e-3 * i as f64).collect()),
        ..good.clone()
    };
    assert!(refused(&moving).contains("from the start"));
    let steps = Samples {
        force: (0..n)
            .map(|i| {
                if i < 2 * n / 3 {
                    0.2
                } else {
                    1.0 + 1e-6 * i as f64
                }
            })
            .collect(),
        ..good.clone()
    };
    let _ = refused(&steps);
    let none = Samples {
        position: None,
        velocity: Some(vec![0.0; n]),
        ..good.clone()
    };
    assert!(refused(&none).contains("no position"));
    // Under control friction rises through zero at every reversal, and that is no ramp: the axis came from the other side.
    let wait = n / 11;
    let mut reversal = good.clone();
    reversal.force[..wait].fill(-1.0);
    assert!(refused(&reversal).contains("after a force of -1"));
    let mut coasting = good.clone();
    let position = coasting.position.as_mut().unwrap();
    for (i, x) in position[..3 * wait / 2].iter_mut().enumerate() {
        *x = 1e-4 * (3 * wait / 2 - i) as f64;
    }
    assert!(refused(&coasting).contains("still moves"));
    for size in [1e-300, 1e300] {
        let mut log = good.clone();
        log.force.iter_mut().for_each(|f| *f *= size);
        log.position
            .as_mut()
            .unwrap()
            .iter_mut()
            .for_each(|x| *x *= size);
        let _ = found(&log, 0.0, None);
    }
}

/// The faster the force rises, the more of it accelerates the axis: the force at the threshold rises with the rate, while the
/// friction that is left without mass times acceleration is that of the axis.
#[test]
fn inertia_is_no_friction() {
    for rate in [5.0, 20.0] {
        let log = ramp(rate, 2e-4, 1e-8);
        let hit = found(&log, 1e-8, Some(1e-3 / 3.0)).unwrap();
        let exact = predict_break_away(&block(), rate, hit.threshold).unwrap();
        let inertia = block().mass() * hit.acceleration;
        let friction = hit.force - inertia;
        println!("{rate}: {hit:?}, {exact:?}, inertia {inertia}");
        assert!(inertia > 0.0);
        assert!(
            (friction / exact.at_threshold - 1.0).abs() < 0.03,
            "{rate}: {friction}, {}",
            exact.at_threshold
        );
    }
}
