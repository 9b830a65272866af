//! The elasto-plastic law; its steps are in `record` and `realtime`.

mod plasticity;
mod realtime;
mod record;

use crate::error::require;
use crate::{LuGre, ParamError, Real};
use plasticity::Plasticity;

/// The elasto-plastic friction law, validated and immutable: LuGre whose bristles do not creep below break-away.
///
/// ```text
/// z' = v (1 - alpha(z, v) z/z_ss(v))      bristle deflection z, m (rad);  z_ss(v) = sgn(v) g(v)/sigma0
/// F  = sigma0 z + sigma1(v) z' + sigma2 v + F0
/// alpha = 0                                                              where z and v point opposite ways,
/// alpha = 0                                                              for |z| <= z_ba,
/// alpha = sin(pi (|z| - (|z_ss| + z_ba)/2)/(|z_ss| - z_ba))/2 + 1/2      between,
/// alpha = 1                                                              for |z| >= |z_ss|
/// ```
/// Source: Dupont, Hayward, Armstrong, Altpeter 2002, doi 10.1109/TAC.2002.1000274: the state equation with exponent 1,
/// and their example of alpha with the sine.
/// Below break-away the motion is elastic and reversible, so a force that oscillates there causes no drift.
///
/// Where this differs from the source: the break-away deflection there is a constant below every |z_ss(v)|, here it is a
/// constant part of it, `z_ba = breakaway |z_ss(v)|`. The same at low speed, where break-away happens, and valid for
/// every curve: a constant could not exceed Fc/sigma0, however large Fs is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElastoPlastic<T> {
    bristle: LuGre<T>,
    breakaway: T,
    plasticity: Plasticity<T>,
}

impl<T: Real> ElastoPlastic<T> {
    /// `bristle` holds stiffness, micro-damping, steady curve and offset; `breakaway` is z_ba/|z_ss|, dimensionless,
    /// above 0 and below 1.
    pub fn new(bristle: LuGre<T>, breakaway: T) -> Result<Self, ParamError> {
        require(
            breakaway > T::ZERO && breakaway < T::ONE,
            "breakaway_ratio",
            breakaway,
            "above 0 and below 1",
        )?;
        Ok(ElastoPlastic {
            bristle,
            breakaway,
            plasticity: Plasticity::new(breakaway),
        })
    }

    /// The LuGre law with the same stiffness, micro-damping, curve and offset.
    pub fn bristle(&self) -> &LuGre<T> {
        &self.bristle
    }

    /// Break-away deflection over steady deflection, z_ba/|z_ss|, dimensionless.
    pub fn breakaway(&self) -> T {
        self.breakaway
    }

    /// The largest |z| that any motion can lead to, `max(Fs+, Fs-)/sigma0`, m (rad).
    #[inline]
    pub fn bound(&self) -> T {
        self.bristle.bound()
    }

    /// The same law in another number type; an error if a number does not survive the change.
    pub fn cast<U: Real>(&self) -> Result<ElastoPlastic<U>, ParamError> {
        ElastoPlastic::new(self.bristle.cast()?, U::from_f64(self.breakaway.to_f64()))
    }

    /// alpha in 0..=1 at deflection `z` (m, rad) and velocity `v` (m/s, rad/s); at `v = 0` its limit for v falling to
    /// 0.
    #[inline]
    pub fn plasticity(&self, z: T, v: T) -> T {
        let g = self.bristle.curve().level(v);
        self.plasticity.share(self.distance(z, v, g))
    }

    /// `z'` in m/s (rad/s) at deflection `z` (m, rad) and velocity `v` (m/s, rad/s).
    #[inline]
    pub fn deflection_rate(&self, z: T, v: T) -> T {
        self.rate_at_level(z, v, self.bristle.curve().level(v))
    }

    /// Friction force in N (N m) at deflection `z` and velocity `v`, with `z'` from the state equation.
    #[inline]
    pub fn force(&self, z: T, v: T) -> T {
        let g = self.bristle.curve().level(v);
        self.bristle.force_of(
            z,
            self.rate_at_level(z, v, g),
            v,
            self.bristle.micro_damping_at_level(v, g),
        )
    }

    /// Friction force in N (N m) at deflection `z`, a given deflection rate (m/s, rad/s) and velocity `v`.
    #[inline]
    pub fn force_at_rate(&self, z: T, rate: T, v: T) -> T {
        self.bristle.force_at_rate(z, rate, v)
    }

    #[inline]
    fn rate_at_level(&self, z: T, v: T, g: T) -> T {
        let share = self.plasticity.share(self.distance(z, v, g));
        v - v.abs() * (share * (self.bristle.stiffness() * z / g))
    }

    /// `1 - z/z_ss(v)` at the level `g`.
    #[inline]
    fn distance(&self, z: T, v: T, g: T) -> T {
        let along = if v < T::ZERO { -z } else { z };
        T::ONE - self.bristle.stiffness() * along / g
    }
}
