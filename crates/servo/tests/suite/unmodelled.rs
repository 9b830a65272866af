//! Forces beside the law against closed forms.

use stiction_servo::integrator::{Integrator, Quick};
use stiction_servo::known;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_servo::unmodelled::{Beside, Shape, Unmodelled, Wandering, Wave};

/// The integrator of a test: the position goes where it is told, and the force that the axis would feel is kept.
#[derive(Clone, Debug)]
struct Led {
    way: f64,
    felt: f64,
}

impl Integrator<stiction_friction::LuGre<f64>> for &mut Led {
    fn advance(&mut self, _: &Plant, from: Motion, _: f64, load: Load, _: f64) -> Motion {
        self.felt = load.force;
        Motion {
            position: from.position + self.way,
            ..from
        }
    }
}

fn plant() -> Plant {
    let axis = known::find("V5").unwrap();
    Plant::new(axis.mass, axis.law).unwrap()
}

#[test]
fn a_shape_rises_and_falls_with_the_travel() {
    let shape = Shape {
        force: 3.0,
        short: 1e-4,
        long: 1e-3,
    };
    let forces = Unmodelled {
        shapes: vec![shape],
        ..Unmodelled::default()
    };
    let plant = plant();
    let (mut led, step) = (
        Led {
            way: 0.0,
            felt: 0.0,
        },
        1e-7,
    );
    let mut motion = Motion::default();
    let mut beside = Beside::new(&mut led, forces);
    // Far enough in one direction that only the reversal counts, then back.
    let mut go = |way: f64, times: usize| {
        let mut felt = Vec::new();
        for _ in 0..times {
            beside.integrator_mut().way = way;
            motion = beside.advance(&plant, motion, 1e-4, Load::default(), 0.0);
            felt.push(beside.integrator_mut().felt);
        }
        felt
    };
    go(step, 100_000);
    let back = go(-step, 20_000);
    for (k, felt) in back.iter().enumerate().skip(1) {
        let s = step * k as f64;
        let expected = shape.force * ((-s / shape.long).exp() - (-s / shape.short).exp());
        // Against a motion that is negative: it pushes towards positive positions.
        assert!(
            (felt - expected).abs() < 2e-3 * shape.force,
            "{s}: {felt} for {expected}"
        );
    }
}

#[test]
fn without_forces_the_axis_moves_as_without_them() {
    let plant = plant();
    let mut bare = Quick::new(1).unwrap();
    let mut beside = Beside::new(Quick::new(1).unwrap(), Unmodelled::default());
    let (mut a, mut b) = (Motion::default(), Motion::default());
    for k in 0..2000 {
        let load = Load::force(30.0 * (0.01 * f64::from(k)).sin());
        a = bare.advance(&plant, a, 1e-4, load, 0.0);
        b = beside.advance(&plant, b, 1e-4, load, 0.0);
    }
    assert_eq!((a.position, a.velocity), (b.position, b.velocity));
}

#[test]
fn a_wandering_force_has_its_power_and_its_memory() {
    let wandering = Wandering {
        force: 2.0,
        memory: 5e-3,
        seed: 7,
    };
    let wave = Wave {
        force: 1.0,
        length: 0.01,
        phase: std::f64::consts::FRAC_PI_2,
    };
    let forces = Unmodelled {
        waves: vec![wave],
        wandering: Some(wandering),
        ..Unmodelled::default()
    };
    let plant = plant();
    let mut led = Led {
        way: 0.0,
        felt: 0.0,
    };
    let mut beside = Beside::new(&mut led, forces);
    let felt: Vec<f64> = (0..200_000)
        .map(|_| {
            beside.advance(&plant, Motion::default(), 1e-3, Load::default(), 0.0);
            // Less the wave at the origin.
            beside.integrator_mut().felt + 1.0
        })
        .collect();
    let n = felt.len() as f64;
    let power = felt.iter().map(|f| f * f).sum::<f64>() / n;
    let next = felt.windows(2).map(|f| f[0] * f[1]).sum::<f64>() / n;
    assert!((power / 4.0 - 1.0).abs() < 0.05, "{power}");
    assert!(
        (next / power / (-0.2_f64).exp() - 1.0).abs() < 0.02,
        "{}",
        next / power
    );
}
