//! `--law auto`: on simulated axes of every law the data choose that law, over several seeds.

mod common;

use common::{Bench, noise, options};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::PathBuf;
use stiction_app::{LawKind, Outcome, Silent};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

const SAMPLES: usize = 8000;
const STEP: f64 = 1e-3;
const MASS: f64 = 5.0;

/// Slow and fast motion through many reversals.
fn motion(t: f64) -> [f64; 3] {
    let mut out = [0.0; 3];
    for (a, f) in [(0.03, 0.4), (2e-3, 1.7), (4e-4, 5.3)] {
        let w = TAU * f;
        out[0] += a * (w * t).sin();
        out[1] += a * w * (w * t).cos();
        out[2] -= a * w * w * (w * t).sin();
    }
    out
}

/// Force of a law of this kind along the motion, by the friction crate in steps of 50 us.
fn clean(kind: LawKind, asymmetric: bool) -> Vec<f64> {
    let side = |coulomb: f64, ratio: f64, velocity: f64, viscous: f64| Direction {
        coulomb,
        static_friction: coulomb * if kind.has_stribeck() { ratio } else { 1.0 },
        stribeck_velocity: velocity,
        viscous,
    };
    let forward = side(20.0, 1.4, 8e-3, 60.0);
    let backward = if asymmetric {
        side(23.0, 1.5, 7e-3, 70.0)
    } else {
        forward
    };
    let curve = Stribeck::new(Shape::Gaussian, forward, backward, 0.0).unwrap();
    let damping = if kind == LawKind::LuGre { 600.0 } else { 0.0 };
    let law = LuGre::new(1.2e5, Damping::Constant(damping), curve).unwrap();
    let fine = 20;
    let h = STEP / f64::from(fine);
    let mut z = 0.0;
    (0..SAMPLES)
        .map(|i| {
            let t = i as f64 * STEP;
            if i > 0 {
                for k in 0..fine {
                    let s = t - STEP + f64::from(k) * h;
                    z = law.step_record(z, h, motion(s)[1], motion(s + h)[1]);
                }
            }
            let [_, v, a] = motion(t);
            let friction = if kind.has_bristle() {
                law.force(z, v)
            } else {
                curve.force(v)
            };
            friction + MASS * a
        })
        .collect()
}

/// A log with encoder steps of `count` m and force noise.
fn log(bench: &Bench, kind: LawKind, asymmetric: bool, seed: u64, count: f64) -> PathBuf {
    let force = clean(kind, asymmetric);
    let mut text = String::from("Time [s],Position [um],Force [N]\n");
    for (i, u) in force.iter().enumerate() {
        let t = i as f64 * STEP;
        let x = (motion(t)[0] / count).round() * count;
        // Three uniform numbers come close to a normal one; 1 N rms.
        let e: f64 = (0..3).map(|k| noise(3 * seed + k, i)).sum();
        let _ = writeln!(text, "{t:.4},{:.4},{:.4}", 1e6 * x, u + e);
    }
    bench.write(&format!("{kind}-{asymmetric}-{seed}.csv"), &text)
}

fn auto(log: PathBuf) -> Outcome {
    let mut options = options(&[&log], LawKind::LuGre);
    options.law = None;
    options.compare_laws = true;
    stiction_app::identify(&options, &mut Silent).unwrap()
}

#[test]
fn experiment() {
    let bench = Bench::new();
    for count in [50e-9, 1e-6] {
        for kind in LawKind::ALL {
            for asymmetric in [false, true] {
                for seed in 0..4 {
                    let outcome = auto(log(&bench, kind, asymmetric, seed, count));
                    let r = &outcome.result;
                    let right = r.law == kind.name() && r.asymmetric == asymmetric;
                    println!("{count} {kind} {asymmetric} {seed}: {} {} {right}", r.law, r.asymmetric);
                    for l in &r.laws {
                        println!(
                            "      {:16} {:5} k {:2} fit {:.3} held {:.3} excess {:.3} +- {:.3} aic {:.0} bic {:.0}{}",
                            l.law, l.asymmetric, l.parameters, l.fitted_error_percent,
                            l.held_out_error_percent.unwrap_or(f64::NAN),
                            l.held_out_excess_percent.unwrap_or(f64::NAN),
                            l.held_out_excess_std_percent.unwrap_or(f64::NAN),
                            l.aic_difference.unwrap_or(f64::NAN),
                            l.bic_difference.unwrap_or(f64::NAN),
                            if l.best { " *" } else { "" }
                        );
                    }
                }
            }
        }
    }
}
