//! A disturbance observer: the force that the motion does not explain.

use crate::{ParamError, Real};

/// The disturbance observer of first order: `d = Q(u) - M s Q(v)` with `Q = w/(s + w)`, u the force applied, v the
/// measured velocity, M the nominal mass (Sariyildiz, Ohnishi 2015, doi 10.1109/TIE.2014.2327009). It has to be started at rest.
///
/// It needs neither a friction model nor a reference, but acts with a delay: disturbances above its bandwidth pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisturbanceObserver<T> {
    mass: T,
    weight: T,
    pull: T,
    limit: T,
}

/// The state of a disturbance observer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DisturbanceState<T> {
    /// `Q(u + M w v)`, N (N m).
    pub filtered: T,
}

impl<T: Real> DisturbanceObserver<T> {
    /// For an axis of `mass` (kg, kg m^2), with a bandwidth in Hz below half the sample rate, at a cycle time in s; the
    /// estimate stays within `limit`, N (N m). All > 0.
    pub fn new(mass: T, bandwidth: T, cycle_time: T, limit: T) -> Result<Self, ParamError> {
        ParamError::positive("mass", mass)?;
        ParamError::positive("bandwidth", bandwidth)?;
        ParamError::positive("cycle_time", cycle_time)?;
        ParamError::positive("limit", limit)?;
        let pull = T::from_f64(2.0 * core::f64::consts::PI) * bandwidth;
        if bandwidth * cycle_time >= T::from_f64(0.5) {
            let allowed = "below half the sample rate";
            return Err(ParamError::new("bandwidth", bandwidth, allowed));
        }
        Ok(DisturbanceObserver {
            mass,
            weight: -(-(pull * cycle_time)).expm1(),
            pull,
            limit,
        })
    }

    /// The estimated disturbance, N (N m): a force against the motion is positive, to be added to the controller's.
    ///
    /// `applied` is the force, N (N m), that acted over the cycle that ends now, `v` the measured velocity now, m/s (rad/s).
    /// A sample that is not finite changes nothing and gives 0.
    pub fn step(&self, state: &mut DisturbanceState<T>, applied: T, v: T) -> T {
        let momentum = self.mass * self.pull * v;
        let next = state.filtered + self.weight * (applied + momentum - state.filtered);
        let estimate = next - momentum;
        if !estimate.is_finite() {
            return T::ZERO;
        }
        state.filtered = next;
        estimate.max(-self.limit).min(self.limit)
    }
}
