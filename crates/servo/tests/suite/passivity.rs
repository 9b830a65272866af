//! What the plant's friction does with energy, as the plant steps it: the velocity held, the mean force over the step.

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use stiction_friction::{Damping, Direction, Held, LuGre, Shape, Stribeck};
use stiction_servo::known;

/// Work on the law over a step less what its bristles store in addition (offset apart), J; and the deflection after it.
fn dissipated(law: &LuGre<f64>, z: f64, h: f64, v: f64) -> (f64, f64) {
    let end = law.hold(z, h, v);
    let force = law.mean_force(z, end, h, v) - law.curve().offset();
    let stored = 0.5 * law.stiffness() * (end - z) * (end + z);
    (force * v * h - stored, end)
}

/// The creep to z = Fs/sigma0 and the jump to 10 m/s of the 1995 block: with sigma1 capped no step of the jump gives
/// energy back, with a constant one the law does.
#[test]
fn a_jump_releases_no_energy() {
    let axis = known::find("C95").unwrap();
    let least = |law: &LuGre<f64>| {
        let (mut z, mut lost) = (0.0, 0.0);
        for _ in 0..75_000 {
            let (loss, end) = dissipated(law, z, 1e-5, 2e-4);
            (z, lost) = (end, lost + loss);
        }
        assert!(z > 0.95 * law.bound(), "{z}");
        let mut least = f64::INFINITY;
        for _ in 0..1000 {
            let (loss, end) = dissipated(law, z, 1e-8, 10.0);
            (z, least) = (end, least.min(loss));
        }
        least
    };
    let (capped, constant) = (least(&axis.capped_law()), least(&axis.law));
    println!("least of a step: capped {capped:.2e} J, constant {constant:.2e} J");
    assert!(capped >= 0.0, "{capped} J");
    assert!(constant < 0.0, "{constant} J");
}

fn any_law() -> impl Strategy<Value = LuGre<f64>> {
    let direction = || {
        (-1.0..2.0, 0.0..2.0, -4.0..-1.0, 0.0..100.0).prop_map(|(fc, excess, vs, s2)| {
            let coulomb = 10f64.powf(fc);
            Direction {
                coulomb,
                static_friction: coulomb * (1.0 + excess),
                stribeck_velocity: 10f64.powf(vs),
                viscous: s2,
            }
        })
    };
    let shape = prop::sample::select(vec![Shape::Gaussian, Shape::Exponential, Shape::Lorentzian]);
    let curve = (shape, direction(), direction(), any::<bool>()).prop_map(|(shape, a, b, same)| {
        Stribeck::new(shape, a, if same { a } else { b }, 0.0).unwrap()
    });
    (curve, -5.0..-2.0, -1.0..5.0).prop_map(|(curve, length, s1): (Stribeck<f64>, f64, f64)| {
        let stiffness = curve.positive().coulomb / 10f64.powf(length);
        LuGre::new(stiffness, Damping::Capped(10f64.powf(s1)), curve).unwrap()
    })
}

/// A step in parts no longer than the deflection in steady motion.
fn cut(law: &LuGre<f64>, (v, h): (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    let way = law.curve().level(v) / law.stiffness();
    let parts = (v.abs() * h / way).ceil().clamp(1.0, 1e4);
    std::iter::repeat_n((v, h / parts), parts as usize)
}

/// 10 000 random motions, each run over and over until the bristles repeat as well: the work on friction over a closed
/// cycle is never negative. Steps are cut to the way over which the bristles turn round: a longer one takes the mean of a
/// large force at its beginning and a small one at its end for a stretch on which the force is small, and may create energy
/// (from sticking at Fs the other way round into fast sliding at Fc, say).
#[test]
fn no_energy_is_gained_over_any_closed_cycle() {
    let mut runner = TestRunner::new(ProptestConfig::with_cases(10_000));
    let part = (-6.0..0.0_f64, -6.0..-2.0_f64, any::<bool>());
    let case = (any_law(), prop::collection::vec(part, 2..20));
    let closed = std::cell::Cell::new(0);
    let cycles = |(law, parts): (LuGre<f64>, Vec<(f64, f64, bool)>)| {
        // Steps of their own length each, the last one back to where the cycle began.
        let mut motion: Vec<(f64, f64)> = parts
            .iter()
            .map(|&(v, h, up)| (if up { 1.0 } else { -1.0 } * 10f64.powf(v), 10f64.powf(h)))
            .collect();
        let way: f64 = motion.iter().map(|(v, h)| v * h).sum();
        motion.push((-way / 1e-3, 1e-3));
        let motion: Vec<(f64, f64)> = motion.iter().flat_map(|&step| cut(&law, step)).collect();
        let mut z = 0.0;
        for _ in 0..200 {
            let (before, mut lost, mut scale) = (z, 0.0, 0.0);
            for &(v, h) in &motion {
                let (loss, end) = dissipated(&law, z, h, v);
                prop_assert!(end.abs() <= law.bound());
                (z, lost) = (end, lost + loss);
                scale += law.stiffness() * law.bound() * (v.abs() * h + law.bound());
            }
            let stored = 0.5 * law.stiffness() * (z - before) * (z + before);
            let rounding = 1e-12 * scale;
            prop_assert!(lost >= -rounding, "{lost} J lost");
            if (z - before).abs() <= 1e-13 * law.bound() {
                prop_assert!(lost + stored >= -rounding, "{lost} J in a closed cycle");
                closed.set(closed.get() + 1);
                break;
            }
        }
        Ok(())
    };
    runner.run(&case, cycles).unwrap();
    println!("{} of 10000 cycles closed", closed.get());
    assert!(closed.get() > 5000);
}
