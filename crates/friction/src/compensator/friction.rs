//! Which law, and which velocity drives it.

use super::Input;
use crate::error::require;
use crate::{CoulombViscous, LuGre, ParamError, Real, State, Stribeck};

/// The law whose force is fed forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction<T> {
    /// The sign of the velocity times a level, and a viscous part.
    Coulomb(CoulombViscous<T>),
    /// The steady curve.
    Stribeck(Stribeck<T>),
    /// Bristles: the force also while the axis turns round.
    LuGre(LuGre<T>),
}

/// The velocity that drives the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source<T> {
    /// The reference velocity: a true feedforward, which no parameter can make unstable.
    Reference,
    /// The measured velocity: a positive feedback of friction, which needs a gain below 1.
    Measured,
    /// A share of the measured velocity, 0 to 1, and the rest of the reference velocity.
    Blend(T),
    /// The measured velocity with the bristles corrected by the tracking error:
    /// `z' = v - sigma0 |v| z/g + k (x_ref - x)`, k >= 0 in 1/s (Canudas de Wit et al. 1995, doi 10.1109/9.376053,
    /// section on the friction observer). LuGre only.
    Observer(T),
}

impl<T: Real> Source<T> {
    pub(super) fn validate(&self, friction: &Friction<T>) -> Result<(), ParamError> {
        match *self {
            Source::Blend(share) => require(
                share >= T::ZERO && share <= T::ONE,
                "blend",
                share,
                "0 to 1",
            ),
            Source::Observer(gain) => {
                ParamError::not_negative("observer_gain", gain)?;
                let bristles = matches!(friction, Friction::LuGre(_));
                require(bristles, "observer_gain", gain, "with a LuGre law only")
            }
            Source::Reference | Source::Measured => Ok(()),
        }
    }

    #[inline]
    pub(super) fn velocity(&self, input: &Input<T>) -> T {
        match *self {
            Source::Reference => input.reference_velocity,
            Source::Measured | Source::Observer(_) => input.measured_velocity,
            Source::Blend(share) => {
                share * input.measured_velocity + (T::ONE - share) * input.reference_velocity
            }
        }
    }
}

impl<T: Real> Friction<T> {
    pub(super) fn rest(&self) -> State<T> {
        match self {
            Friction::Coulomb(law) => State {
                z: T::ZERO,
                force: law.offset(),
            },
            Friction::Stribeck(curve) => State {
                z: T::ZERO,
                force: curve.offset(),
            },
            Friction::LuGre(law) => law.rest(),
        }
    }

    /// Advances the law by `h` seconds at the velocity `v`; `error` is the reference less the measured position.
    #[inline]
    pub(super) fn step(&self, state: &mut State<T>, h: T, v: T, source: Source<T>, error: T) {
        match self {
            Friction::Coulomb(law) => state.force = finite_or(law.force(v), state.force),
            Friction::Stribeck(curve) => state.force = finite_or(curve.force(v), state.force),
            Friction::LuGre(law) => {
                law.step(state, h, v);
                if let Source::Observer(gain) = source {
                    correct(law, state, h, v, gain * error);
                }
            }
        }
    }
}

/// Moves the bristles by `rate` (m/s, rad/s) for `h` seconds, within their bound, and the force with them.
fn correct<T: Real>(law: &LuGre<T>, state: &mut State<T>, h: T, v: T, rate: T) {
    if h <= T::ZERO {
        return;
    }
    let z = law.clamp(state.z + rate * h);
    let moved = z - state.z;
    let force = state.force + law.stiffness() * moved + law.micro_damping(v) * (moved / h);
    if z.is_finite() && force.is_finite() {
        *state = State { z, force };
    }
}

fn finite_or<T: Real>(value: T, other: T) -> T {
    if value.is_finite() { value } else { other }
}
