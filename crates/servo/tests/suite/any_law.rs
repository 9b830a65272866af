//! The plant with laws other than LuGre: order, energy, closed forms, cost.

use proptest::prelude::*;
use stiction_friction::compensator::{Compensator, Input, Settings, Source};
use stiction_friction::{
    Damping, Direction, ElastoPlastic, Element, Gms, Held, LuGre, MaxwellSlip, Shape, Stribeck,
};
use stiction_servo::known;
use stiction_servo::law::AxisLaw;
use stiction_servo::plant::{Load, Motion, Plant};

fn elasto_plastic(name: &str, ratio: f64) -> Plant<ElastoPlastic<f64>> {
    let axis = known::find(name).unwrap();
    Plant::new(axis.mass, ElastoPlastic::new(axis.law, ratio).unwrap()).unwrap()
}

fn curve(fs: f64) -> Stribeck<f64> {
    let both = Direction {
        coulomb: 20.0,
        static_friction: fs,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap()
}

const ELEMENTS: [Element<f64>; 3] = [
    Element {
        stiffness: 8e4,
        share: 0.4,
    },
    Element {
        stiffness: 3e4,
        share: 0.35,
    },
    Element {
        stiffness: 1e4,
        share: 0.25,
    },
];

fn gms(fs: f64, attraction: f64) -> Plant<Gms<f64, 3>> {
    Plant::new(
        10.0,
        Gms::new(ELEMENTS, attraction, 600.0, curve(fs)).unwrap(),
    )
    .unwrap()
}

/// A law whose elements are counted when the program runs moves an axis as that of their number.
#[test]
fn counted_elements_move_an_axis_as_known_ones() {
    for attraction in [300.0, f64::INFINITY] {
        let counted = MaxwellSlip::new(&ELEMENTS, attraction, curve(30.0)).unwrap();
        let known = Plant::new(10.0, counted.gms::<3>().unwrap()).unwrap();
        let counted = Plant::new(10.0, counted).unwrap();
        let (mut a, mut b) = (Motion::default(), Motion::default());
        let mut farthest = 0.0_f64;
        for k in 0..20_000 {
            let load = Load::force(60.0 * (1e-3 * f64::from(k)).sin());
            a = known.step(a, 1e-4, load).motion;
            b = counted.step(b, 1e-4, load).motion;
            assert!((a.position - b.position).abs() < 1e-12, "{k}");
            farthest = farthest.max(a.position.abs());
        }
        assert!(farthest > 1e-2, "{farthest}");
    }
}

/// Scaled friction is that many times as large in whatever state; wrong laws are of the family of the right one.
#[test]
fn laws_of_an_axis_are_scaled_and_made_wrong() {
    let lugre = known::find("motor").unwrap().capped_law();
    let slip = MaxwellSlip::new(&ELEMENTS, 300.0, curve(30.0)).unwrap();
    for law in [
        AxisLaw::LuGre(lugre),
        AxisLaw::ElastoPlastic(ElastoPlastic::new(lugre, 0.7).unwrap()),
        AxisLaw::MaxwellSlip(slip),
    ] {
        let through = |law: &AxisLaw| -> Vec<f64> {
            let settings = Settings::bare(1e-4, 1e6);
            let law = law.friction();
            let mut law = Compensator::new(law, Source::Reference, settings).unwrap();
            let at = |k: i32| Input {
                reference_velocity: 5e-3 * (3e-3 * f64::from(k)).sin(),
                enable: true,
                ..Input::default()
            };
            (0..6000).map(|k| law.step(at(k))).collect()
        };
        let scaled = law.scaled(1.3).unwrap();
        assert!((scaled.stiffness() / law.stiffness() - 1.3).abs() < 1e-12);
        for (larger, force) in through(&scaled).into_iter().zip(through(&law)) {
            assert!((larger - 1.3 * force).abs() < 1e-9, "{larger} {force}");
        }
        let corners = law.corners(0.1);
        assert!(corners.len() == 64 || corners.len() == 32);
        for corner in corners {
            assert_eq!(
                std::mem::discriminant(&corner),
                std::mem::discriminant(&law)
            );
            let off = (corner.stiffness() / law.stiffness() - 1.0).abs();
            assert!((off - 0.1).abs() < 1e-12);
        }
    }
}

/// The same motion by classical Runge-Kutta on the equations of motion, with steps far below the bristle's time constants.
fn runge_kutta(
    plant: &Plant<ElastoPlastic<f64>>,
    force: impl Fn(f64) -> f64,
    dt: f64,
    n: usize,
    sub: usize,
) -> Vec<f64> {
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
    let mut out = vec![0.0];
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
        out.push(y[0]);
    }
    out
}

/// Positions every `dt` with `per` steps each.
fn run<L: Held<f64>>(
    plant: &Plant<L>,
    force: impl Fn(f64) -> f64,
    dt: f64,
    n: usize,
    per: u32,
) -> Vec<f64> {
    let h = dt / f64::from(per);
    let (mut m, mut step) = (Motion::default(), 0);
    let mut out = vec![0.0];
    for _ in 0..n {
        for _ in 0..per {
            m = plant
                .step(m, h, Load::force(force((f64::from(step) + 0.5) * h)))
                .motion;
            step += 1;
        }
        out.push(m.position);
    }
    out
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b) * (a - b))
        .sum::<f64>()
        .sqrt()
}

#[test]
fn elasto_plastic_motion_is_of_second_order() {
    for (name, ratio, mean, swing, dt) in [
        ("C95", 0.6, 2.0, 0.3, 2e-3),
        ("machine", 0.8, 60.0, 12.0, 4e-3),
    ] {
        let plant = elasto_plastic(name, ratio);
        let force = |t: f64| mean * (1.0 - libm::exp(-t / 0.05)) + swing * libm::sin(20.0 * t);
        let truth = runge_kutta(&plant, force, dt, 200, 1000);
        let errors = [8, 16, 32, 64].map(|per| distance(&run(&plant, force, dt, 200, per), &truth));
        for e in errors.windows(2) {
            let order = (e[0] / e[1]).log2();
            assert!((order - 2.0).abs() < 0.2, "{name}: order {order}");
        }
    }
}

/// GMS against itself at steps far smaller, breaking away and sliding one way.
#[test]
fn gms_motion_converges_with_second_order() {
    let plant = gms(30.0, 2000.0);
    let force = |t: f64| 60.0 * (1.0 - libm::exp(-t / 0.05)) + 12.0 * libm::sin(20.0 * t);
    let truth = run(&plant, force, 4e-3, 100, 2000);
    let errors = [8, 16, 32, 64].map(|per| distance(&run(&plant, force, 4e-3, 100, per), &truth));
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!((order - 2.0).abs() < 0.3, "{errors:?}");
}

/// A slow ramp of the force follows the virgin curve, sum of min(k_i x, nu_i Fs), worked out by hand.
#[test]
fn a_slow_ramp_follows_the_virgin_curve() {
    let plant = gms(30.0, 1e6);
    let mut m = Motion::default();
    let h = 1e-3;
    for k in 0..27_000 {
        let force = (f64::from(k) + 0.5) * h;
        m = plant.step(m, h, Load::force(force)).motion;
        let x = m.position;
        let virgin = (8e4 * x).min(12.0) + (3e4 * x).min(10.5) + (1e4 * x).min(7.5);
        // 1 N/s is slow, not still: micro-damping and inertia take a share.
        assert!((virgin - force).abs() < 0.1, "{force} N at {x}: {virgin}");
    }
    assert!(
        m.position > 4e-4,
        "well beyond the first two break-aways: {}",
        m.position
    );
}

/// With a flat curve no law gains energy on a spring: kinetic, spring's and elements' together only fall.
#[test]
fn a_gms_axis_on_a_spring_comes_to_rest() {
    let plant = gms(20.0, 500.0);
    let stiffness = 4e3;
    let energy = |m: &Motion<_>| {
        let at: &stiction_friction::Elements<f64, 3> = &m.deflection;
        let stored: f64 = at
            .force
            .iter()
            .zip(plant.law().elements())
            .map(|(f, e)| 0.5 * f * f / e.stiffness)
            .sum();
        5.0 * m.velocity * m.velocity + 0.5 * stiffness * m.position * m.position + stored
    };
    let mut m = Motion {
        position: 0.05,
        ..Motion::default()
    };
    let start = energy(&m);
    let mut last = start;
    for k in 0..40_000 {
        m = plant
            .step(
                m,
                1e-4,
                Load {
                    force: 0.0,
                    stiffness,
                },
            )
            .motion;
        let now = energy(&m);
        assert!(now <= last + 1e-12 * start, "step {k}: {last} {now}");
        last = now;
    }
    assert!(m.velocity.abs() < 1e-9, "{}", m.velocity);
    assert!(m.position.abs() < 20.0 / stiffness, "{}", m.position);
}

proptest! {
    /// The solution balances the forces: kinetic energy changes by exactly the work of drive and friction.
    #[test]
    fn work_is_kinetic_energy(
        ratio in 0.05..0.95,
        speed in -1.0..1.0,
        load in -1.0..1.0,
        force in -100.0..100.0,
        h in 1e-6..1e-3,
    ) {
        let axis = known::find("machine").unwrap();
        let plant = elasto_plastic("machine", ratio);
        let from = Motion { position: 0.0, velocity: speed, deflection: load * plant.law().bound() };
        let step = plant.step(from, h, Load::force(force));
        let v = step.motion.velocity;
        let kinetic = 0.5 * axis.mass * (v - speed) * (v + speed);
        let work = h * step.mean_velocity * (force - step.friction);
        let scale = axis.mass * (speed * speed + v * v) + h * step.mean_velocity.abs() * (force.abs() + step.friction.abs());
        prop_assert!((kinetic - work).abs() <= 1e-11 * scale, "{kinetic} {work}");
    }

    /// Left alone on a spring, no elasto-plastic axis gains energy.
    #[test]
    fn energy_only_falls(
        which in prop::sample::select(vec!["C95", "V5", "V10", "machine", "motor"]),
        ratio in 0.05..0.95,
        speed in -0.5..0.5,
        stretch in -0.01..0.01,
        stiffness in 0.0..1e4,
        h in 1e-5..5e-4,
    ) {
        let axis = known::find(which).unwrap();
        let law = ElastoPlastic::new(axis.capped_law(), ratio).unwrap();
        let plant = Plant::new(axis.mass, law).unwrap();
        let energy = |m: Motion| {
            0.5 * plant.mass() * m.velocity * m.velocity
                + 0.5 * stiffness * m.position * m.position
                + 0.5 * law.bristle().stiffness() * m.deflection * m.deflection
        };
        let mut m = Motion { position: stretch, velocity: speed, deflection: 0.0 };
        let start = energy(m);
        for _ in 0..1000 {
            let before = energy(m);
            m = plant.step(m, h, Load { force: 0.0, stiffness }).motion;
            prop_assert!(energy(m) <= before + 1e-12 * start, "{which}: {before} {}", energy(m));
        }
    }
}

/// What a step costs, in evaluations of the force balance: shows when the solver becomes dearer.
#[test]
fn evaluations_per_step() {
    fn mean<L: Held<f64>>(plant: &Plant<L>) -> (f64, u32) {
        let (mut m, mut total, mut most) = (Motion::default(), 0, 0);
        for k in 0..40_000 {
            let t = (f64::from(k) + 0.5) * 5e-5;
            let force = 60.0 * libm::sin(2.0 * std::f64::consts::PI * 3.0 * t);
            let step = plant.step(m, 5e-5, Load::force(force));
            m = step.motion;
            total += step.evaluations;
            most = most.max(step.evaluations);
        }
        (f64::from(total) / 40_000.0, most)
    }
    let bristle = LuGre::new(1.2e5, Damping::Constant(600.0), curve(30.0)).unwrap();
    let law = ElastoPlastic::new(bristle, 0.7).unwrap();
    let costs = [
        ("elasto-plastic", mean(&Plant::new(10.0, law).unwrap())),
        ("GMS", mean(&gms(30.0, 2000.0))),
        ("Maxwell slip", mean(&gms(30.0, f64::INFINITY))),
    ];
    for (name, (mean, most)) in costs {
        println!("{name}: mean {mean} most {most}");
        assert!(mean < 4.0, "{name}: mean {mean}");
        assert!(most < 100, "{name}: {most}");
    }
}
