//! LuGre along a known velocity, with its sensitivities: what a design of experiments asks of the law.

use crate::law::{Law, LawKind};
use crate::separable::recursion::trace;

/// The columns that the bristles make along a velocity, one entry a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Along {
    /// Deflection in units of the Coulomb level, `s0 z / Fc`, from 0 at the first sample.
    pub eta: Vec<f64>,
    /// Rate of the deflection, m/s (rad/s), which the micro-damping multiplies.
    pub rate: Vec<f64>,
    /// Derivatives of `eta` with respect to ln(s0/Fc), ln(Fs/Fc - 1) and ln vs; empty where they are not asked for.
    pub eta_slope: Vec<Vec<f64>>,
    /// The same of `rate`.
    pub rate_slope: Vec<Vec<f64>>,
}

/// LuGre with the Gaussian curve along a `velocity` (m/s, rad/s) in steps of `step` s, as a fit of it sees it.
///
/// `kappa` = s0/Fc in 1/m (1/rad), `excess` = Fs/Fc - 1 and `stribeck_velocity` in m/s (rad/s) are above 0; `slopes` asks for the
/// derivatives.
pub fn lugre_along(
    kappa: f64,
    excess: f64,
    stribeck_velocity: f64,
    step: f64,
    velocity: &[f64],
    slopes: bool,
) -> Along {
    let p = [kappa, excess, stribeck_velocity].map(libm::log);
    let trace = trace(&Law::new(LawKind::LuGre), &p, step, velocity, slopes);
    Along {
        eta: trace.eta,
        rate: trace.rate,
        eta_slope: trace.eta_slope,
        rate_slope: trace.rate_slope,
    }
}
