//! Numbers of the 1995 paper's experiments (doi 10.1109/9.376053), as far as a velocity drives them. The expected values
//! come from an adaptive Radau integration at a relative tolerance of 1e-9 to 1e-10, not from this crate. The
//! experiments B to G are those of the simulated axis.

use crate::common::c95;
use stiction_friction::Damping;

fn close(got: f64, expected: f64, relative: f64) {
    assert!(
        (got / expected - 1.0).abs() <= relative,
        "got {got}, expected {expected}"
    );
}

/// A: the steady curve.
#[test]
fn static_curve() {
    let law = c95(Damping::Constant);
    close(law.curve().force(1e-3), 1.184340, 1e-6);
    close(law.curve().force(5e-3), 1.002000, 1e-6);
    // The minimum, by golden-section search.
    let (mut a, mut b) = (1e-3, 1e-2);
    let ratio = (5.0_f64.sqrt() - 1.0) / 2.0;
    while b - a > 1e-12 {
        let (c, d) = (b - ratio * (b - a), a + ratio * (b - a));
        if law.curve().force(c) < law.curve().force(d) {
            b = d
        } else {
            a = c
        }
    }
    close(a, 2.98632e-3, 1e-3);
    close(law.curve().force(a), 1.001261, 1e-6);
}

/// Presliding, quasi-static: first loading follows x = -(Fs/sigma0) ln(1 - F/Fs) exactly.
#[test]
fn first_loading() {
    let law = c95(Damping::Constant);
    let (v, h) = (1e-9, 1e-3);
    let (mut z, mut x) = (0.0, 0.0);
    for k in 1..=40_000 {
        z = law.step_record(z, h, v, v);
        x += v * h;
        if k % 4000 == 0 {
            let force = law.stiffness() * z;
            close(x, -1.5e-5 * (-force / 1.5).ln_1p(), 1e-6);
        }
    }
}
