//! The plant beside another simulator: MuJoCo 4 with the LuGre friction of its `dcmotor`, under the same force.

use std::path::{Path, PathBuf};
use std::process::Command;
use stiction_servo::known;
use stiction_servo::plant::{Load, Motion, Plant};

const MILLISECONDS: usize = 1500;
/// The force, N, Hz: sticks and slips twice in each direction.
const AMPLITUDE: f64 = 40.0;
const FREQUENCY: f64 = 2.0;

/// Position and velocity after each millisecond, by MuJoCo with so many steps in it.
fn mujoco(steps: usize) -> Vec<[f64; 2]> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let local = here.join("../../.venv/bin/python");
    let python = std::env::var_os("STICTION_PYTHON").map_or(local, PathBuf::from);
    let axis = known::find("machine").unwrap();
    let side = axis.law.curve().positive();
    let numbers = [
        axis.mass,
        axis.law.stiffness(),
        axis.law.damping().at_rest(),
        side.viscous,
        side.coulomb,
        side.static_friction,
        side.stribeck_velocity,
        AMPLITUDE,
        FREQUENCY,
    ];
    let output = Command::new(&python)
        .arg(here.join("tests/mujoco/rollout.py"))
        .args([steps, MILLISECONDS].map(|n| n.to_string()))
        .args(numbers.map(|x| format!("{x:?}")))
        .output()
        .unwrap_or_else(|e| panic!("{}: {e}; install with: cargo xtask setup", python.display()));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let number = |text: &str| text.parse::<f64>().unwrap();
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| line.split_once(' ').unwrap())
        .map(|(x, v)| [number(x), number(v)])
        .collect()
}

fn ours() -> Vec<[f64; 2]> {
    let axis = known::find("machine").unwrap();
    let plant = Plant::new(axis.mass, axis.law).unwrap();
    let mut m = Motion::default();
    (0..MILLISECONDS)
        .map(|k| {
            let phase = 2.0 * std::f64::consts::PI * FREQUENCY * 1e-3 * k as f64;
            let load = Load::force(AMPLITUDE * phase.sin());
            for _ in 0..100 {
                m = plant.step(m, 1e-5, load).motion;
            }
            [m.position, m.velocity]
        })
        .collect()
}

/// Largest difference of two motions in position and velocity, of the largest of the first.
fn apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|i| {
        let most = a.iter().fold(0.0_f64, |m, x| m.max(x[i].abs()));
        let off = a.iter().zip(b).map(|(a, b)| (a[i] - b[i]).abs());
        off.fold(0.0, f64::max) / most
    })
}

/// MuJoCo's step is of first order: with half of it, it is half as far from our plant, and what the two say of a step of
/// zero is our plant.
#[test]
fn mujoco_is_off_by_its_own_first_order_error() {
    let ours = ours();
    let (coarse, fine) = (mujoco(10), mujoco(20));
    assert_eq!(fine.len(), MILLISECONDS);
    let limit: Vec<[f64; 2]> = coarse
        .iter()
        .zip(&fine)
        .map(|(c, f)| [0, 1].map(|i| 2.0 * f[i] - c[i]))
        .collect();
    let travel = ours.iter().fold(0.0_f64, |m, x| m.max(x[0].abs()));
    assert!(travel > 1e-2, "{travel} m");
    let [coarse, fine, limit] = [coarse, fine, limit].map(|m| apart(&ours, &m));
    println!("off by {coarse:.6?} at 1e-4 s, {fine:.6?} at 5e-5 s, {limit:.6?} in the limit");
    for i in 0..2 {
        let ratio = coarse[i] / fine[i];
        assert!((ratio - 2.0).abs() < 0.1, "{coarse:?} {fine:?}");
        assert!(limit[i] < 0.05 * coarse[i], "{coarse:?} {limit:?}");
    }
}
