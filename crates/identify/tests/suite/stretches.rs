//! Constant-velocity stretches in whole logs: an axis in closed loop, from log to static map.

use crate::common::Noise;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::Samples;
use stiction_identify::procedure::{Run, StaticSettings, Unsteady, static_map, stretches};
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::encoder::Encoder;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_servo::speeds::Speeds;

struct Log {
    samples: Samples,
    reference: Vec<f64>,
}

/// Position in steps and force with noise and cogging, along constant speeds, at 1 kHz.
fn drive(
    plant: &Plant,
    pd: &Cascade,
    speeds: &Speeds,
    count: f64,
    noise: f64,
    cogging: (f64, f64),
) -> Log {
    let h = 1e-3;
    let encoder = Encoder::new(count).unwrap();
    let mut random = Noise::new(11);
    let mut log = Log {
        samples: Samples::default(),
        reference: Vec::new(),
    };
    let (mut state, mut motion) = (CascadeState::default(), Motion::default());
    let mut positions = Vec::new();
    for k in 0..(speeds.duration() / h) as usize {
        let t = k as f64 * h;
        let asked = speeds.at(t);
        let x = encoder.read(motion.position);
        let u = pd.force(&mut state, h, asked, x);
        let ripple = cogging.0 * (std::f64::consts::TAU * motion.position / cogging.1).sin();
        log.samples.time.push(t);
        log.samples.force.push(u + noise * random.normal());
        log.reference.push(asked.position);
        positions.push(x);
        for _ in 0..4 {
            motion = plant.step(motion, h / 4.0, Load::force(u - ripple)).motion;
        }
    }
    log.samples.position = Some(positions);
    log
}

/// V3 of the published sets: J .2 kg m^2, PD with kp 200 and kd 100, 1 ms.
fn v3() -> (Plant, Cascade) {
    let side = |coulomb, static_friction, viscous| Direction {
        coulomb,
        static_friction,
        stribeck_velocity: 0.05,
        viscous,
    };
    let (pos, neg) = (side(0.15, 0.60, 0.02), side(0.20, 0.70, 0.03));
    let curve = Stribeck::new(Shape::Gaussian, pos, neg, 0.0).unwrap();
    let law = LuGre::new(2000.0, Damping::Constant(40.0), curve).unwrap();
    let pd = Cascade {
        position_gain: 2.0,
        speed_gain: 100.0,
        integral_gain: 0.0,
        mass_feedforward: 0.0,
        force_limit: 100.0,
    };
    (Plant::new(0.2, law).unwrap(), pd)
}

const TRUTH: [(&str, f64); 8] = [
    ("coulomb_pos", 0.15),
    ("static_pos", 0.60),
    ("sigma2_pos", 0.02),
    ("stribeck_velocity_pos", 0.05),
    ("coulomb_neg", 0.20),
    ("static_neg", 0.70),
    ("sigma2_neg", 0.03),
    ("stribeck_velocity_neg", 0.05),
];

/// V3 as a whole procedure, without noise and with: every stretch is found in the measured position
/// and in the reference alike, and the map has the parameters within 1 %, or within its intervals.
#[test]
fn v3_from_a_closed_loop_log() {
    let (plant, pd) = v3();
    let speeds = Speeds::ladder((0.01, 8.0), 14, 1.0, (5.0, 8.0), 0.1).unwrap();
    for (count, noise) in [(0.0, 0.0), (1e-6, 0.01)] {
        let log = drive(&plant, &pd, &speeds, count, noise, (0.0, 1.0));
        for reference in [None, Some(log.reference.as_slice())] {
            let run = Run {
                samples: &log.samples,
                reference,
                resolution: Some(count).filter(|c| *c > 0.0),
            };
            let found = stretches(&[run], &[]).unwrap();
            for p in &found.points {
                println!(
                    "{:.4} {:+.4} {:.5} +- {:.5}, {} dropped {:.3}",
                    p.time.0, p.velocity, p.force, p.error, p.samples, p.dropped
                );
            }
            println!("{:?}", found.rejected);
            assert_eq!(found.points.len(), 28, "{:?}", found.rejected);
            for (p, run) in found.points.iter().zip(speeds.runs()) {
                assert!((p.velocity / run.velocity - 1.0).abs() < 5e-3);
                assert!(p.time.1 - p.time.0 > 0.4 * run.hold, "{p:?}");
            }
            let settings = StaticSettings {
                asymmetric: true,
                offset: false,
                ..StaticSettings::default()
            };
            let map = static_map(&found.points, &settings).unwrap();
            for (name, truth) in TRUTH {
                let p = map.parameters.iter().find(|p| p.name == name).unwrap();
                println!("{name} {} {:?} {:?}", p.value, p.std, p.ci95);
                assert!(p.identifiable, "{name}: {}", p.reason);
                let off = (p.value / truth - 1.0).abs();
                if noise == 0.0 {
                    assert!(off < 0.01, "{name}: {}", p.value);
                } else {
                    assert!(
                        (p.value - truth).abs() < 4.0 * p.std.unwrap(),
                        "{name}: {}",
                        p.value
                    );
                }
            }
        }
    }
}

/// Cogging of 5 N disappears when whole pitches are averaged, and is scatter when they are not.
#[test]
fn whole_pitches_average_cogging_out() {
    let axis = stiction_servo::known::find("machine").unwrap();
    let plant = Plant::new(axis.mass, axis.law).unwrap();
    let pd = Cascade::tuned(axis.mass, 40.0, 500.0).unwrap();
    let pitch = 0.013;
    let speeds = Speeds::ladder((0.01, 0.2), 8, 0.045, (0.4, 5.0), 0.1).unwrap();
    let log = drive(&plant, &pd, &speeds, 0.0, 0.1, (5.0, pitch));
    let run = Run {
        samples: &log.samples,
        reference: Some(&log.reference),
        resolution: None,
    };
    let plain = static_map(
        &stretches(&[run], &[]).unwrap().points,
        &StaticSettings::default(),
    )
    .unwrap();
    let found = stretches(&[run], &[pitch]).unwrap();
    assert!(found.points.iter().filter(|p| p.pitches >= 2).count() >= 14);
    let averaged = static_map(&found.points, &StaticSettings::default()).unwrap();
    let worst = |map: &stiction_identify::procedure::StaticMap| {
        let off = |p: &stiction_identify::procedure::StaticPoint| {
            (p.force - axis.law.curve().force(p.velocity)).abs()
        };
        map.points.iter().map(off).fold(0.0, f64::max)
    };
    println!("{} {}", worst(&plain), worst(&averaged));
    assert!(worst(&averaged) < 0.5 && worst(&averaged) < 0.5 * worst(&plain));
}

fn made(n: usize, position: impl Fn(f64) -> f64, force: impl Fn(f64) -> f64) -> Samples {
    let time: Vec<f64> = (0..n).map(|i| i as f64 * 1e-3).collect();
    Samples {
        position: Some(time.iter().map(|&t| position(t)).collect()),
        force: time.iter().map(|&t| force(t)).collect(),
        time,
        ..Samples::default()
    }
}

fn found(samples: &Samples, resolution: Option<f64>) -> stiction_identify::procedure::Stretches {
    let run = Run {
        samples,
        reference: None,
        resolution,
    };
    stretches(&[run], &[]).unwrap()
}

/// What is no constant velocity gives no point: rest, ramps, fast sines; stick-slip is said to be.
#[test]
fn what_is_not_steady_gives_no_point() {
    let noise = |t: f64| 0.1 * ((1e4 * t).sin() + (2.3e4 * t).sin());
    for (what, log) in [
        ("rest", made(4000, |_| 0.3, |t| 5.0 + noise(t))),
        (
            "a ramp of velocity",
            made(4000, |t| 0.2 * t * t, |t| 20.0 + noise(t)),
        ),
        (
            "a sweep",
            made(4000, |t| 0.01 * (20.0 * t + 10.0 * t * t).sin(), noise),
        ),
    ] {
        let found = found(&log, None);
        let long: f64 = found.points.iter().map(|p| p.time.1 - p.time.0).sum();
        assert!(long < 0.1, "{what}: {:?}", found.points);
    }
    let jerky = made(8000, |t| 1e-3 * (t + 0.9 / 12.0 * (12.0 * t).sin()), noise);
    let all = found(&jerky, Some(1e-7));
    assert!(all.points.is_empty(), "{:?}", all.points);
    assert!(
        all.rejected.iter().any(|r| r.reason == Unsteady::StickSlip),
        "{:?}",
        all.rejected
    );
    // A force that drifts all the way is not a mean.
    let warming = made(4000, |t| 0.1 * t, |t| 20.0 - 2.0 * t + noise(t));
    let all = found(&warming, None);
    assert!(all.points.is_empty());
    assert_eq!(all.rejected[0].reason, Unsteady::Unsettled);
}

#[test]
fn channels_that_do_not_fit_are_refused() {
    let log = made(100, |t| t, |_| 1.0);
    let short = vec![0.0; 50];
    let run = Run {
        samples: &log,
        reference: Some(&short),
        resolution: None,
    };
    assert!(stretches(&[run], &[]).is_err());
    for n in [0, 1, 3, 39, 40, 41] {
        let log = made(n, |t| t, |_| 1.0);
        let run = Run {
            samples: &log,
            reference: None,
            resolution: None,
        };
        let _ = stretches(&[run], &[0.01]);
    }
    // Huge numbers are no panic.
    let log = made(500, |t| 1e300 * t, |_| 1e300);
    let _ = found(&log, Some(1e-300));
}

/// Four speeds each way that an axis with a position gain of 80 1/s approaches and leaves, by an
/// encoder of .1 um: however far a stretch has grown over either end, each is a point of its own.
#[test]
fn a_stretch_beside_a_rest_is_found() {
    let h = 1.0 / 4000.0;
    for first in (0..10).map(|i| 400 + 37 * i) {
        let mut wanted = vec![0.0; first];
        let mut asked = Vec::new();
        for speed in [0.02_f64, 0.04, 0.08, 0.16] {
            for velocity in [speed, -speed] {
                let from = wanted[wanted.len() - 1];
                let samples = ((0.06 / speed).max(0.8) / h) as usize;
                wanted.extend((1..=samples).map(|k| from + velocity * h * k as f64));
                let rest = wanted[wanted.len() - 1];
                wanted.extend(vec![rest; 600]);
                asked.push(velocity);
            }
        }
        let mut x = 0.0;
        let mut position = Vec::new();
        for goal in &wanted {
            position.push(1e-7 * (x / 1e-7_f64).round());
            x += 80.0 * h * (goal - x);
        }
        let samples = Samples {
            time: (0..position.len()).map(|k| k as f64 * h).collect(),
            force: vec![9.0; position.len()],
            position: Some(position),
            ..Samples::default()
        };
        for reference in [None, Some(wanted.as_slice())] {
            let run = Run {
                samples: &samples,
                reference,
                resolution: Some(1e-7),
            };
            let found = stretches(&[run], &[]).unwrap();
            let velocities: Vec<f64> = found.points.iter().map(|p| p.velocity).collect();
            assert_eq!(velocities.len(), asked.len(), "{first}: {velocities:?}");
            for (found, asked) in velocities.iter().zip(&asked) {
                assert!((found / asked - 1.0).abs() < 0.01, "{found} {asked}");
            }
        }
    }
}
