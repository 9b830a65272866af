//! The implicit-midpoint step: order, energy, closed forms, cost.

use proptest::prelude::*;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_servo::known;
use stiction_servo::plant::{Load, Motion, Plant};

fn plant(name: &str) -> Plant {
    let axis = known::find(name).unwrap();
    Plant::new(axis.mass, axis.law).unwrap()
}

/// The same motion by classical Runge-Kutta with steps far below the bristle's time constants.
fn runge_kutta(
    plant: &Plant,
    force: impl Fn(f64) -> f64,
    dt: f64,
    n: usize,
    sub: usize,
) -> Vec<Motion> {
    let law = plant.law();
    let rate = |y: [f64; 3], t: f64| {
        let [_, v, z] = y;
        [
            v,
            (force(t) - law.force(z, v)) / plant.mass(),
            law.deflection_rate(z, v),
        ]
    };
    let add =
        |y: [f64; 3], k: [f64; 3], h: f64| [y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2]];
    let h = dt / sub as f64;
    let mut y = [0.0; 3];
    let mut out = vec![Motion::default()];
    for i in 0..n {
        for j in 0..sub {
            let t = i as f64 * dt + j as f64 * h;
            let k1 = rate(y, t);
            let k2 = rate(add(y, k1, h / 2.0), t + h / 2.0);
            let k3 = rate(add(y, k2, h / 2.0), t + h / 2.0);
            let k4 = rate(add(y, k3, h), t + h);
            for (k, w) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
                y = add(y, k, w * h / 6.0);
            }
        }
        out.push(Motion {
            position: y[0],
            velocity: y[1],
            deflection: y[2],
        });
    }
    out
}

/// Sum of squared position errors of MID with steps of dt/8 to dt/64 over the motion under `force`.
fn squared_errors(plant: &Plant, force: impl Fn(f64) -> f64 + Copy, dt: f64, n: usize) -> [f64; 4] {
    let truth = runge_kutta(plant, force, dt, n, 1000);
    [8, 16, 32, 64].map(|per| {
        let h = dt / f64::from(per);
        let (mut m, mut sum, mut step) = (Motion::default(), 0.0, 0);
        for t in &truth[1..] {
            for _ in 0..per {
                m = plant
                    .step(m, h, Load::force(force((f64::from(step) + 0.5) * h)))
                    .motion;
                step += 1;
            }
            sum += (m.position - t.position) * (m.position - t.position);
        }
        sum
    })
}

fn orders(squared: [f64; 4]) -> impl Iterator<Item = f64> {
    (0..3).map(move |i| 0.5 * (squared[i] / squared[i + 1]).log2())
}

#[test]
fn second_order_from_presliding_into_sliding() {
    for (name, mean, swing, dt) in [
        ("C95", 2.0, 0.3, 2e-3),
        ("machine", 60.0, 12.0, 4e-3),
        ("motor", 40.0, 8.0, 2e-4),
    ] {
        let force = |t: f64| mean * (1.0 - libm::exp(-t / 0.05)) + swing * libm::sin(20.0 * t);
        for order in orders(squared_errors(&plant(name), force, dt, 200)) {
            assert!((order - 2.0).abs() < 0.1, "{name}: order {order}");
        }
    }
}

/// Through reversals the error of a run depends on where in its step each reversal falls: the order shows over many runs
/// and a wide range of steps.
#[test]
fn second_order_through_reversals_on_average() {
    for (name, amplitude) in [("C95", 1.2), ("machine", 60.0), ("motor", 40.0)] {
        let mut sum = [0.0; 4];
        for run in 0..100 {
            let w = 2.0 * std::f64::consts::PI * (3.0 + 0.01 * f64::from(run));
            let errors = squared_errors(&plant(name), |t| amplitude * libm::sin(w * t), 4e-3, 80);
            (0..4).for_each(|i| sum[i] += errors[i]);
        }
        let order = orders(sum).sum::<f64>() / 3.0;
        assert!((order - 2.0).abs() < 0.1, "{name}: order {order}");
    }
}

/// Constant force against friction without Stribeck effect, bristles stiff: M v' = u - Fc - sigma2 v in closed form.
#[test]
fn terminal_speed_and_time_constant() {
    let both = Direction {
        coulomb: 20.0,
        static_friction: 20.0,
        stribeck_velocity: 1e-3,
        viscous: 60.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
    let law = LuGre::new(1e9, Damping::Constant(0.0), curve).unwrap();
    let plant = Plant::new(10.0, law).unwrap();
    let mut m = Motion {
        velocity: 0.1,
        deflection: law.bound(),
        ..Motion::default()
    };
    for _ in 0..5000 {
        m = plant.step(m, 1e-4, Load::force(50.0)).motion;
    }
    // v = .5 + (.1 - .5) exp(-60 t/10) at t = .5 s, where .5 = (50 - 20)/60
    let expected = 0.5 - 0.4 * (-3.0_f64).exp();
    assert!(
        (m.velocity / expected - 1.0).abs() < 1e-7,
        "{} {expected}",
        m.velocity
    );
}

/// With next to no friction a spring swings on: the midpoint rule keeps its energy.
#[test]
fn a_spring_keeps_its_energy() {
    let both = Direction {
        coulomb: 1e-14,
        static_friction: 1e-14,
        stribeck_velocity: 1e-3,
        viscous: 0.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
    let plant = Plant::new(2.0, LuGre::new(1.0, Damping::Constant(0.0), curve).unwrap()).unwrap();
    let spring = Load {
        force: 0.0,
        stiffness: 800.0,
    };
    let mut m = Motion {
        position: 0.01,
        ..Motion::default()
    };
    let energy = |m: Motion| 1.0 * m.velocity * m.velocity + 400.0 * m.position * m.position;
    let start = energy(m);
    for _ in 0..100_000 {
        m = plant.step(m, 1e-3, spring).motion;
    }
    assert!((energy(m) / start - 1.0).abs() < 1e-9);
}

proptest! {
    /// Left alone on a spring, no axis gains energy: kinetic, spring's and bristles' together only fall.
    #[test]
    fn energy_only_falls(
        which in prop::sample::select(vec!["C95", "V5", "V6", "V10", "V16", "machine", "motor"]),
        speed in -0.5..0.5,
        stretch in -0.01..0.01,
        stiffness in 0.0..1e4,
        h in 1e-5..5e-4,
    ) {
        let axis = known::find(which).unwrap();
        let plant = Plant::new(axis.mass, axis.capped_law()).unwrap();
        let energy = |m: Motion| {
            0.5 * plant.mass() * m.velocity * m.velocity
                + 0.5 * stiffness * m.position * m.position
                + 0.5 * plant.law().stiffness() * m.deflection * m.deflection
        };
        let mut m = Motion { position: stretch, velocity: speed, deflection: 0.0 };
        let start = energy(m);
        for _ in 0..3000 {
            let before = energy(m);
            let step = plant.step(m, h, Load { force: 0.0, stiffness });
            m = step.motion;
            prop_assert!(energy(m) <= before + 1e-12 * start, "{which}: {before} {}", energy(m));
        }
    }

    /// The solution balances the forces: kinetic energy changes by exactly the work of drive and friction.
    #[test]
    fn work_is_kinetic_energy(
        which in prop::sample::select(vec!["C95", "V5", "V6", "V10", "V16", "machine", "motor"]),
        speed in -1.0..1.0,
        load in -1.0..1.0,
        force in -100.0..100.0,
        h in 1e-6..1e-3,
        capped: bool,
    ) {
        let axis = known::find(which).unwrap();
        let law = if capped { axis.capped_law() } else { axis.law };
        let plant = Plant::new(axis.mass, law).unwrap();
        let from = Motion { position: 0.0, velocity: speed, deflection: load * law.bound() };
        let step = plant.step(from, h, Load::force(force));
        let v = step.motion.velocity;
        let kinetic = 0.5 * axis.mass * (v - speed) * (v + speed);
        let work = h * step.mean_velocity * (force - step.friction);
        let scale = axis.mass * (speed * speed + v * v) + h * step.mean_velocity.abs() * (force.abs() + step.friction.abs());
        prop_assert!((kinetic - work).abs() <= 1e-11 * scale, "{kinetic} {work}");
        prop_assert!(step.motion.deflection.abs() <= law.bound());
    }
}

/// At rest under a force below break-away the block holds: no drift that comes from the solver.
#[test]
fn a_held_load_stays_where_it_is() {
    let plant = plant("machine");
    let mut m = Motion::default();
    let mut settled = 0.0;
    for k in 0..80_000 {
        if k == 40_000 {
            settled = m.position;
        }
        m = plant.step(m, 2.5e-4, Load::force(10.0)).motion;
    }
    assert!(
        (m.position - settled).abs() < 1e-12,
        "{}",
        m.position - settled
    );
    assert!((m.deflection * 1.2e5 - 10.0).abs() < 1e-6);
}

/// What a step costs, in evaluations of the force balance: shows when the solver becomes dearer.
#[test]
fn evaluations_per_step() {
    for (name, amplitude, capped) in [
        ("C95", 1.6, false),
        ("machine", 60.0, false),
        ("motor", 40.0, false),
        ("motor", 40.0, true),
    ] {
        let axis = known::find(name).unwrap();
        let law = if capped { axis.capped_law() } else { axis.law };
        let plant = Plant::new(axis.mass, law).unwrap();
        let (mut m, mut total, mut most) = (Motion::default(), 0, 0);
        for k in 0..40_000 {
            let t = (f64::from(k) + 0.5) * 5e-5;
            let force = amplitude * libm::sin(2.0 * std::f64::consts::PI * 3.0 * t);
            let step = plant.step(m, 5e-5, Load::force(force));
            m = step.motion;
            total += step.evaluations;
            most = most.max(step.evaluations);
        }
        println!(
            "{name} capped {capped}: mean {} most {most}",
            f64::from(total) / 40_000.0
        );
        assert!(
            total < 4 * 40_000,
            "{name}: mean {}",
            f64::from(total) / 40_000.0
        );
        assert!(most < 40, "{name}: {most}");
    }
}
