//! Order of convergence and exactness of the steps.

use crate::common::*;
use stiction_friction::{Damping, LuGre, Shape, explicit};

/// Deflection along `v(t)` at the times `k dt`, by RK4 with steps far inside its stability limit: an integrator that
/// shares nothing with EXPLIN but the state equation.
fn reference(
    law: &LuGre<f64>,
    v: impl Fn(f64) -> f64,
    z0: f64,
    dt: f64,
    n: usize,
    sub: usize,
) -> Vec<f64> {
    let h = dt / sub as f64;
    let rate = |z: f64, t: f64| law.deflection_rate(z, v(t));
    let mut z = z0;
    let mut out = vec![z];
    for k in 0..n {
        for j in 0..sub {
            let t = k as f64 * dt + j as f64 * h;
            let k1 = rate(z, t);
            let k2 = rate(z + h / 2.0 * k1, t + h / 2.0);
            let k3 = rate(z + h / 2.0 * k2, t + h / 2.0);
            let k4 = rate(z + h * k3, t + h);
            z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        out.push(z);
    }
    out
}

/// Root-mean-square error against the reference at the coarsest grid's instants.
fn rms_error(law: &LuGre<f64>, v: impl Fn(f64) -> f64, truth: &[f64], dt: f64, per: usize) -> f64 {
    let h = dt / per as f64;
    let (mut z, mut sum) = (truth[0], 0.0);
    for (k, t) in truth.iter().enumerate().skip(1) {
        for j in 0..per {
            let i = ((k - 1) * per + j) as f64;
            z = law.step_record(z, h, v(i * h), v((i + 1.0) * h));
        }
        sum += (z - t) * (z - t);
    }
    (sum / truth.len() as f64).sqrt()
}

fn observed_orders(law: &LuGre<f64>, v: impl Fn(f64) -> f64 + Copy, dt: f64, n: usize) -> Vec<f64> {
    let truth = reference(law, v, 0.0, dt, n, 4000);
    let errors: Vec<f64> = [4, 8, 16, 32]
        .map(|per| rms_error(law, v, &truth, dt, per))
        .to_vec();
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

#[test]
fn explin_is_of_second_order_while_sliding_one_way() {
    let law = c95(Damping::Constant);
    let v = |t: f64| 1e-3 * (1.5 + (25.0 * t).cos());
    for order in observed_orders(&law, v, 4e-3, 120) {
        assert!((order - 2.0).abs() < 0.1, "order {order}");
    }
}

#[test]
fn explin_is_of_second_order_through_reversals() {
    for shape in [Shape::Gaussian, Shape::Power(1.5), Shape::Lorentzian] {
        let law = lopsided(shape, Damping::Constant(600.0));
        // Zeros at no multiple of any step used.
        let v = |t: f64| 8e-3 * (2.0 * std::f64::consts::PI * 1.03 * t + 0.3).sin();
        for order in observed_orders(&law, v, 4e-3, 400) {
            assert!((order - 2.0).abs() < 0.1, "{shape:?}: order {order}");
        }
    }
}

/// At constant velocity the law is linear: z(t) = z_ss (1 - exp(-|v| t sigma0/g)), with numbers worked out by hand.
#[test]
fn both_steps_are_exact_at_constant_velocity() {
    let law = c95(Damping::Constant);
    for v in [1e-3_f64, -1e-3] {
        // g(vs) = 1 + 0.5/e
        let steady = v.signum() * 1.183_939_720_585_721e-5;
        for (h, n) in [(1e-6, 30_000), (1e-3, 30), (0.03, 1)] {
            let (mut z, mut held) = (0.0, 0.0);
            for _ in 0..n {
                z = law.step_record(z, h, v, v);
                held = law.step_held(held, h, v);
            }
            // 0.03 s * 1e-3 m/s / 1.18394e-5 m
            let exact = steady * -(-2.533912789509109_f64).exp_m1();
            assert!((z / exact - 1.0).abs() < 1e-11, "h {h}: {z} {exact}");
            assert!((held / exact - 1.0).abs() < 1e-11);
        }
    }
}

type Step = fn(&LuGre<f64>, f64, f64, f64, f64) -> f64;

/// The steps that this crate warns of do what they are said to do.
#[test]
fn explicit_steps_agree_when_slow_and_diverge_when_stiff() {
    let v = |t: f64| 5e-3 * (2.0 * std::f64::consts::PI * t).sin();
    let run = |law: &LuGre<f64>, step: Step| {
        let h = 1e-4;
        (0..2500).fold(0.0, |z, k| {
            step(law, z, h, v(k as f64 * h), v((k + 1) as f64 * h))
        })
    };

    let soft = c95(Damping::Constant);
    let truth = run(&soft, LuGre::step_record);
    assert!((run(&soft, explicit::rk4::<f64>) / truth - 1.0).abs() < 1e-5);
    assert!((run(&soft, explicit::euler::<f64>) / truth - 1.0).abs() < 1e-2);

    let stiff = LuGre::new(1e8, Damping::Constant(0.0), *soft.curve()).unwrap();
    assert!(run(&stiff, LuGre::step_record).abs() <= stiff.bound());
    for step in [explicit::rk4::<f64> as Step, explicit::euler::<f64>] {
        let z = run(&stiff, step);
        assert!(z.is_nan() || z.abs() > 10.0 * stiff.bound(), "{z}");
    }
}

/// The derivative that implicit simulation uses, against central differences.
#[test]
fn slope_of_the_held_step_matches_differences() {
    for shape in [
        Shape::Gaussian,
        Shape::Exponential,
        Shape::Power(1.4),
        Shape::Lorentzian,
    ] {
        let law = lopsided(shape, Damping::Constant(0.0));
        for v in [-0.2, -3e-3, -1e-5, 1e-5, 2e-3, 6e-3, 0.3] {
            for z in [-2e-4, 0.0, 1.1e-4] {
                let h = 1e-4;
                let slope = law.step_held_slope(z, h, v).1;
                let d = 1e-4 * v;
                let at = |v| law.step_held_slope(z, h, v).0;
                // Fourth-order central difference.
                let numeric = (8.0 * (at(v + d) - at(v - d)) - (at(v + 2.0 * d) - at(v - 2.0 * d)))
                    / (12.0 * d);
                let scale = slope.abs().max(1e-3 * h);
                assert!(
                    (slope - numeric).abs() < 1e-6 * scale,
                    "{shape:?} v {v} z {z}: {slope} {numeric}"
                );
            }
        }
    }
}
