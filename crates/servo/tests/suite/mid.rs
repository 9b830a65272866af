//! The implicit-midpoint step: order, energy, closed forms, cost.

use proptest::prelude::*;
use stiction_friction::{Damping, Direction, Held, LuGre, Shape, Stribeck};
use stiction_servo::known;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_testkit::MeanOfEnds;

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

/// Positions each tenth of a second from rest, under a load given as force and stiffness.
fn positions<L: Held<f64, State = f64>>(
    plant: &Plant<L>,
    load: impl Fn(f64) -> (f64, f64),
    h: f64,
    seconds: f64,
) -> Vec<f64> {
    let per = (0.1 / h).round() as u32;
    let mut m = Motion::default();
    (0..(seconds * 10.0) as u32)
        .map(|tenth| {
            for i in 0..per {
                let t = (f64::from(tenth * per + i) + 0.5) * h;
                let (force, stiffness) = load(t);
                m = plant.step(m, h, Load { force, stiffness }).motion;
            }
            m.position
        })
        .collect()
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

/// What the bend of the deflection within a step is worth, on axes of many kinds and steps of any length: pulled by a
/// spring, driven by a force, swung on a spring.
#[test]
fn the_bend_is_worth_counting() {
    // Spread over the ranges: multiples of the powers of a generalised golden ratio, x^9 = x + 1.
    let spread = |i: u32, k: i32| (f64::from(i) * 1.0853_f64.powi(-k)).fract();
    let between = |low: f64, high: f64, share: f64| low + (high - low) * share;
    let (h, seconds) = (1e-3, 4.0);
    let mut ratios = Vec::new();
    for i in 1..=60 {
        let at = |k: i32, low: f64, high: f64| between(low, high, spread(i, k));
        let (mass, coulomb) = (10f64.powf(at(1, -0.5, 1.5)), 10f64.powf(at(2, -0.5, 1.5)));
        let side = Direction {
            coulomb,
            static_friction: coulomb * at(3, 1.1, 2.0),
            stribeck_velocity: 10f64.powf(at(4, -3.0, -1.5)),
            viscous: coulomb * at(5, 0.0, 1.0),
        };
        // From a twentieth to all of what a step may be for the bristles.
        let stiffness = mass * (10f64.powf(at(6, -1.0, 0.3)) / h).powi(2);
        let sigma1 = at(7, 0.3, 1.5) * (stiffness * mass).sqrt();
        let damping = if i % 2 == 0 {
            Damping::Constant(sigma1)
        } else {
            Damping::Capped(sigma1)
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
        let law = LuGre::new(stiffness, damping, curve).unwrap();
        let spring = mass * (2.0 * std::f64::consts::PI * at(8, 0.2, 3.0)).powi(2);
        let (pull, rate) = (at(9, 5.0, 50.0) * side.stribeck_velocity, at(10, 0.3, 2.0));
        let push = side.static_friction * at(9, 1.2, 3.0);
        let load = |t: f64| {
            let wave = libm::sin(2.0 * std::f64::consts::PI * rate * t);
            match i % 3 {
                0 => (spring * pull * t, spring),
                1 => (push * wave, 0.0),
                _ => (5.0 * side.static_friction * wave, spring),
            }
        };
        let plant = Plant::new(mass, law).unwrap();
        let right = positions(&plant, load, h / 50.0, seconds);
        let off = |found: Vec<f64>| {
            let squares = found.iter().zip(&right).map(|(x, y)| (x - y) * (x - y));
            squares.sum::<f64>().sqrt()
        };
        let bent = off(positions(&plant, load, h, seconds));
        let plain = off(positions(
            &Plant::new(mass, MeanOfEnds(law)).unwrap(),
            load,
            h,
            seconds,
        ));
        ratios.push(bent / plain);
    }
    let mean = (ratios.iter().map(|r| r.ln()).sum::<f64>() / 60.0).exp();
    ratios.sort_by(f64::total_cmp);
    println!(
        "errors by those of the mean of both ends: {mean:.2} in the geometric mean, {ratios:.2?}"
    );
    // Where the plain step is right by chance the other one is worse.
    assert!(mean < 0.8 && ratios[30] < 0.8, "{mean} {ratios:?}");
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

    /// Any law, any state, any step: a solution that is found, and no energy gained from capped bristles in a step that
    /// is not long for them.
    #[test]
    fn any_step_ends_and_gains_nothing(
        shape in prop::sample::select(vec![Shape::Gaussian, Shape::Exponential, Shape::Power(0.6), Shape::Lorentzian]),
        mass in -3.0..3.0_f64,
        coulomb in -2.0..3.0_f64,
        drop in 1.0..4.0_f64,
        slow in -5.0..0.0_f64,
        swings in -2.0..1.0_f64,
        damped in 0.0..2.0_f64,
        load in -1.0..1.0_f64,
        speed in -3.0..3.0_f64,
        negative: bool,
        push in -20.0..20.0_f64,
        h in -5.0..-2.0_f64,
    ) {
        let [mass, coulomb, slow, h] = [mass, coulomb, slow, h].map(|x| 10f64.powf(x));
        let side = Direction {
            coulomb,
            static_friction: drop * coulomb,
            stribeck_velocity: slow,
            viscous: 0.0,
        };
        let stiffness = mass * (10f64.powf(swings) / h).powi(2);
        let damping = Damping::Capped(damped * (stiffness * mass).sqrt());
        let curve = Stribeck::symmetric(shape, side, 0.0).unwrap();
        let plant = Plant::new(mass, LuGre::new(stiffness, damping, curve).unwrap()).unwrap();
        let bound = plant.law().bound();
        let velocity = 10f64.powf(speed) * bound / h * if negative { -1.0 } else { 1.0 };
        let from = Motion { position: 0.0, velocity, deflection: load * bound };
        let force = push * coulomb;
        let step = plant.step(from, h, Load::force(force));
        prop_assert!(step.evaluations < 120, "{}", step.evaluations);
        let to = step.motion;
        prop_assert!(to.velocity.is_finite() && to.deflection.abs() <= bound);
        let energy = |m: Motion| {
            0.5 * mass * m.velocity * m.velocity + 0.5 * stiffness * m.deflection * m.deflection
        };
        let g = curve.level(step.mean_velocity);
        if step.mean_velocity.abs() * h <= g / stiffness {
            let work = force * step.mean_velocity * h;
            let scale = energy(from) + energy(to) + work.abs();
            // The velocity is found to a millionth of a millionth of vs.
            let found = mass * (velocity.abs() + to.velocity.abs()) * 2e-12 * slow;
            let room = 1e-11 * scale + found;
            prop_assert!(energy(to) <= energy(from) + work + room, "{from:?} {step:?}");
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
