//! Explicit steps, for comparison only.
//!
//! Both become unstable, without showing it, once `h sigma0 |v|/g` exceeds 2 (Euler) or 2.785 (Runge-Kutta): at 50 mm/s,
//! g = 12 N and h = 0.1 ms the latter is a stiffness of 6.7e6 N/m. For actual use there is [`LuGre::step_record`].

use crate::{LuGre, Real};

/// Forward Euler, first order. Arguments as for [`LuGre::step_record`]; `vb` is not used.
pub fn euler<T: Real>(law: &LuGre<T>, z: T, h: T, va: T, _vb: T) -> T {
    z + h * law.deflection_rate(z, va)
}

/// The classical fourth-order Runge-Kutta step with the velocity linear from `va` to `vb`.
pub fn rk4<T: Real>(law: &LuGre<T>, z: T, h: T, va: T, vb: T) -> T {
    let half = T::from_f64(0.5);
    let two = T::from_f64(2.0);
    let vm = half * (va + vb);
    let k1 = law.deflection_rate(z, va);
    let k2 = law.deflection_rate(z + half * h * k1, vm);
    let k3 = law.deflection_rate(z + half * h * k2, vm);
    let k4 = law.deflection_rate(z + h * k3, vb);
    z + h / T::from_f64(6.0) * (k1 + two * k2 + two * k3 + k4)
}
