//! The 1995 experiments (doi 10.1109/9.376053): every number within its tolerance. The references come from an adaptive Radau
//! integration at a relative tolerance of 1e-9 to 1e-10, not from this crate.

use stiction_friction::{Damping, ElastoPlastic, Element, Gms, Held};
use stiction_servo::c95;
use stiction_servo::known;
use stiction_servo::plant::{Load, Motion, Plant};

#[test]
fn an_experiment_may_be_stopped() {
    for run in c95::ALL {
        assert_eq!(run(&|| false), Ok(None));
    }
}

#[test]
fn every_number_of_1995() {
    let mut off = Vec::new();
    let mut counts = Vec::new();
    for run in c95::ALL {
        let experiment = run(&|| true).unwrap().unwrap();
        counts.push((experiment.letter, experiment.checks.len()));
        for check in &experiment.checks {
            println!(
                "{} {}: {} {}, should be {}",
                experiment.letter, check.name, check.found, check.unit, check.reference
            );
            if !check.holds() {
                off.push(format!("{} {}", experiment.letter, check.name));
            }
        }
        for curve in &experiment.curves {
            assert_eq!(curve.x.len(), curve.y.len());
            assert!(
                curve.x.len() >= 8 && curve.x.len() < 5000,
                "{}",
                curve.label
            );
        }
    }
    assert!(off.is_empty(), "{off:?}");
    // None may go missing unseen.
    assert_eq!(
        counts,
        [('B', 8), ('C', 12), ('D', 8), ('E', 11), ('F', 8), ('G', 2)]
    );
}

/// A number that is off is said to be off, and so is one that is no number.
#[test]
fn a_check_can_fail() {
    let check = |found| c95::Check {
        name: String::new(),
        unit: "N",
        reference: 2.0,
        found,
        tolerance: 2e-3,
    };
    assert!(check(2.0019).holds() && check(1.9981).holds());
    assert!(!check(2.0021).holds() && !check(f64::NAN).holds());
}

/// Positions every second under G's force, .9 + .3 sin(2 pi t) N, up to 20 s.
fn under_oscillating_force<L: Held<f64>>(plant: &Plant<L>) -> Vec<f64> {
    let h = 1e-4;
    let force = |t: f64| 0.9 + 0.3 * libm::sin(2.0 * std::f64::consts::PI * t);
    let mut m = Motion::default();
    let mut at = Vec::new();
    for k in 0..=200_000 {
        if k % 10_000 == 0 {
            at.push(m.position);
        }
        m = plant
            .step(m, h, Load::force(force((k as f64 + 0.5) * h)))
            .motion;
    }
    at
}

/// G with bristles that are elastic up to 1.35 N = .9 Fs: the block stays (Dupont et al. 2002,
/// doi 10.1109/TAC.2002.1000274, is about this). Position and deflection are the same number, bit for bit.
#[test]
fn an_elasto_plastic_block_does_not_drift() {
    let axis = known::find("C95").unwrap();
    let law = ElastoPlastic::new(axis.law, 0.9).unwrap();
    let at = under_oscillating_force(&Plant::new(axis.mass, law).unwrap());
    // Held by the spring alone at the mean force, .9 N/1e5 N/m, at every full second.
    assert!((at[20] / 9e-6 - 1.0).abs() < 1e-2, "{}", at[20]);
    for second in 2..20 {
        // Steps of 1e-4 s hit the same phases each second to rounding.
        let moved = at[second + 1] - at[second];
        assert!(moved.abs() < 1e-18, "{second} s: {moved} m");
    }
    // Above break-away it is no longer elastic: the same block with .5 Fs creeps on.
    let weak = ElastoPlastic::new(axis.law, 0.5).unwrap();
    let at = under_oscillating_force(&Plant::new(axis.mass, weak).unwrap());
    assert!((at[20] - at[10]) / 10.0 > 1e-6, "{}", at[20] - at[10]);
}

/// G with Maxwell slip: after the first swing the hysteresis loop closes, nothing drifts.
#[test]
fn a_maxwell_slip_block_does_not_drift() {
    let axis = known::find("C95").unwrap();
    let element = |stiffness, share| Element { stiffness, share };
    let elements = [element(6e4, 0.3), element(3e4, 0.4), element(1e4, 0.3)];
    let Damping::Constant(sigma1) = axis.law.damping() else {
        panic!("C95 has a constant sigma1");
    };
    let law = Gms::new(elements, f64::INFINITY, sigma1, *axis.law.curve()).unwrap();
    let at = under_oscillating_force(&Plant::new(axis.mass, law).unwrap());
    assert!((at[20] - at[10]).abs() < 1e-12, "{:?}", at);
}
