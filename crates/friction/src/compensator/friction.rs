//! The law of a compensator, and the velocity that drives it.

use super::input::Input;
use super::state::LawState;
use crate::error::require;
use crate::record::one_plus_ratio;
use crate::{
    CoulombViscous, ElastoPlastic, Elements, GmsState, LuGre, MaxwellSlip, ParamError, Real, State,
    Stribeck,
};

/// Dead zone of a law that has no velocity of its own, m/s (rad/s).
const SLOWEST: f64 = 1e-5;
/// Dead zone of a Stribeck curve, in Stribeck velocities: the level is that at standstill to 1e-4 there.
const STANDSTILL: f64 = 0.01;
/// Largest deflections of the bristles that an axis moves before it slides.
const SLIDING_LENGTHS: f64 = 4.0;
/// The same for Maxwell-slip elements, in yield deflections of the last: from slip one way to slip the other.
const YIELD_LENGTHS: f64 = 2.0;
/// The same for a law without bristles: the way at its Stribeck velocity in this time, s.
const SLIDING_TIME: f64 = 1e-2;

/// The law whose force is fed forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction<T> {
    /// The sign of the velocity times a level, and a viscous part.
    Coulomb(CoulombViscous<T>),
    /// The steady curve.
    Stribeck(Stribeck<T>),
    /// With bristles: right in presliding too, while the axis reverses.
    LuGre(LuGre<T>),
    /// With bristles that do not creep below break-away.
    ElastoPlastic(ElastoPlastic<T>),
    /// With Maxwell-slip elements: right in reversals inside reversals too.
    Gms(MaxwellSlip<T>),
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
    pub(super) fn rest(&self) -> LawState<T> {
        LawState {
            z: T::ZERO,
            elements: Elements::default(),
            force: self.offset(),
        }
    }

    /// The steady curve; `None` for Coulomb and viscous friction, which has none.
    pub fn curve(&self) -> Option<&Stribeck<T>> {
        match self {
            Friction::Coulomb(_) => None,
            Friction::Stribeck(curve) => Some(curve),
            Friction::LuGre(law) => Some(law.curve()),
            Friction::ElastoPlastic(law) => Some(law.bristle().curve()),
            Friction::Gms(law) => Some(law.curve()),
        }
    }

    /// The bristle, with its stiffness and micro-damping, of a law that has one.
    pub fn bristle(&self) -> Option<&LuGre<T>> {
        match self {
            Friction::LuGre(law) => Some(law),
            Friction::ElastoPlastic(law) => Some(law.bristle()),
            Friction::Coulomb(_) | Friction::Stribeck(_) | Friction::Gms(_) => None,
        }
    }

    /// The same law in another number type.
    ///
    /// # Errors
    /// Where a number does not survive the change.
    pub fn cast<U: Real>(&self) -> Result<Friction<U>, ParamError> {
        let to = |x: T| U::from_f64(x.to_f64());
        Ok(match self {
            Friction::Coulomb(law) => {
                let (coulomb, viscous) = (law.coulomb().map(to), law.viscous().map(to));
                Friction::Coulomb(CoulombViscous::new(coulomb, viscous, to(law.offset()))?)
            }
            Friction::Stribeck(curve) => Friction::Stribeck(curve.cast()?),
            Friction::LuGre(law) => Friction::LuGre(law.cast()?),
            Friction::ElastoPlastic(law) => Friction::ElastoPlastic(law.cast()?),
            Friction::Gms(law) => Friction::Gms(law.cast()?),
        })
    }

    /// The same law without its constant force.
    ///
    /// # Errors
    /// None: its other numbers have been checked.
    pub fn without_offset(&self) -> Result<Self, ParamError> {
        let of = |curve: &Stribeck<T>| {
            Stribeck::new(curve.shape(), *curve.positive(), *curve.negative(), T::ZERO)
        };
        let bristle = |law: &LuGre<T>| LuGre::new(law.stiffness(), law.damping(), of(law.curve())?);
        Ok(match self {
            Friction::Coulomb(law) => {
                Friction::Coulomb(CoulombViscous::new(law.coulomb(), law.viscous(), T::ZERO)?)
            }
            Friction::Stribeck(curve) => Friction::Stribeck(of(curve)?),
            Friction::LuGre(law) => Friction::LuGre(bristle(law)?),
            Friction::ElastoPlastic(law) => Friction::ElastoPlastic(ElastoPlastic::new(
                bristle(law.bristle())?,
                law.breakaway(),
            )?),
            Friction::Gms(law) => {
                let curve = of(law.curve())?;
                Friction::Gms(MaxwellSlip::new(law.elements(), law.attraction(), curve)?)
            }
        })
    }

    /// Constant force beside friction, N (N m).
    pub fn offset(&self) -> T {
        match self {
            Friction::Coulomb(law) => law.offset(),
            _ => self.curve().map_or(T::ZERO, Stribeck::offset),
        }
    }

    /// Coulomb levels forward and back, N (N m).
    pub fn coulomb(&self) -> [T; 2] {
        let of = |curve: &Stribeck<T>| [curve.positive().coulomb, curve.negative().coulomb];
        match self {
            Friction::Coulomb(law) => law.coulomb(),
            _ => self.curve().map_or([T::ZERO; 2], of),
        }
    }

    /// Viscous coefficients forward and back, N s/m (N m s/rad).
    #[inline]
    pub fn viscous(&self) -> [T; 2] {
        let of = |curve: &Stribeck<T>| [curve.positive().viscous, curve.negative().viscous];
        match self {
            Friction::Coulomb(law) => law.viscous(),
            _ => self.curve().map_or([T::ZERO; 2], of),
        }
    }

    /// The part of the force that changes with the level, N (N m): that of the bristles' deflection, or of a law without them
    /// what is neither viscous nor offset, at the velocity `v`.
    #[inline]
    pub(super) fn dry(&self, state: &LawState<T>, v: T) -> T {
        match self {
            Friction::LuGre(law) => law.stiffness() * state.z,
            Friction::ElastoPlastic(law) => law.bristle().stiffness() * state.z,
            Friction::Gms(law) => law.total(&state.elements),
            Friction::Coulomb(_) | Friction::Stribeck(_) => {
                let side = usize::from(v < T::ZERO);
                (state.force - self.offset()) - self.viscous()[side] * v
            }
        }
    }

    /// Largest level at standstill, N (N m).
    pub fn scale(&self) -> T {
        match self {
            Friction::Coulomb(law) => law.coulomb()[0].max(law.coulomb()[1]),
            _ => self.curve().map_or(T::ZERO, Stribeck::largest_static_level),
        }
    }

    /// The way from rest within which the law is still bending, m (rad): the largest deflection of a bristle, the yield
    /// deflection of the last element; `None` for a law without them.
    pub fn presliding(&self) -> Option<T> {
        match self {
            Friction::LuGre(law) => Some(law.bound()),
            Friction::ElastoPlastic(law) => Some(law.bound()),
            Friction::Gms(law) => Some(law.longest_yield()),
            Friction::Coulomb(_) | Friction::Stribeck(_) => None,
        }
    }

    /// Way after a reversal from which on the axis slides, m (rad).
    pub fn sliding(&self) -> T {
        match self {
            Friction::Coulomb(_) => T::from_f64(SLIDING_TIME * SLOWEST),
            Friction::Stribeck(curve) => {
                let (pos, neg) = (curve.positive(), curve.negative());
                T::from_f64(SLIDING_TIME) * pos.stribeck_velocity.max(neg.stribeck_velocity)
            }
            Friction::LuGre(law) => T::from_f64(SLIDING_LENGTHS) * law.bound(),
            Friction::ElastoPlastic(law) => T::from_f64(SLIDING_LENGTHS) * law.bound(),
            Friction::Gms(law) => T::from_f64(YIELD_LENGTHS) * law.longest_yield(),
        }
    }

    /// Twice the largest force at standstill, N (N m).
    pub(super) fn usual_limit(&self) -> T {
        T::from_f64(2.0) * (self.scale() + self.offset().abs())
    }

    /// Speeds at which a law without bristles is told from standstill, m/s (rad/s).
    pub(super) fn usual_dead_zone(&self) -> T {
        match self {
            Friction::Coulomb(_) => T::from_f64(SLOWEST),
            Friction::Stribeck(curve) => {
                let (pos, neg) = (curve.positive(), curve.negative());
                let least = pos.stribeck_velocity.min(neg.stribeck_velocity);
                T::from_f64(STANDSTILL) * least
            }
            Friction::LuGre(_) | Friction::ElastoPlastic(_) | Friction::Gms(_) => T::ZERO,
        }
    }

    /// Advances the law by `h` seconds at the velocity `v`.
    #[inline]
    pub(super) fn step(&self, state: &mut LawState<T>, h: T, v: T) {
        match self {
            Friction::Coulomb(law) => state.force = finite_or(law.force(v), state.force),
            Friction::Stribeck(curve) => state.force = finite_or(curve.force(v), state.force),
            Friction::LuGre(law) => {
                let mut bristle = state.bristle();
                law.step(&mut bristle, h, v);
                state.bend(bristle);
            }
            Friction::ElastoPlastic(law) => step_elasto_plastic(law, state, h, v),
            Friction::Gms(law) => step_gms(law, state, h, v),
        }
    }

    /// Advances the observer's correction c (m, rad) by `h` seconds at the velocity `v`, with `c' = pull - sigma0 |v| c/g`,
    /// and returns the force that it adds; sigma0 c stays within `limit`. Since the law is linear in z, law and
    /// correction together are the observer, and the law's own deflection keeps its bound.
    pub(super) fn correct(&self, c: &mut T, h: T, v: T, pull: T, limit: T) -> T {
        let Friction::LuGre(law) = self else {
            return T::ZERO;
        };
        if h <= T::ZERO {
            return law.stiffness() * *c;
        }
        let a = h * (law.stiffness() * (v.abs() / law.curve().level(v)));
        let e = (-a).expm1();
        let held = T::ONE - one_plus_ratio(a, e);
        let most = limit / law.stiffness();
        let next = (*c + *c * e + pull * h * held).max(-most).min(most);
        let force = law.stiffness() * next + law.micro_damping(v) * ((next - *c) / h);
        if !(next.is_finite() && force.is_finite()) {
            return law.stiffness() * *c;
        }
        *c = next;
        force
    }
}

impl<T: Real> LawState<T> {
    #[inline]
    fn bristle(&self) -> State<T> {
        State {
            z: self.z,
            force: self.force,
        }
    }

    #[inline]
    fn bend(&mut self, State { z, force }: State<T>) {
        self.z = z;
        self.force = force;
    }
}

/// A function of its own, so that it does not slow down the step of the other laws.
#[inline(never)]
fn step_elasto_plastic<T: Real>(law: &ElastoPlastic<T>, state: &mut LawState<T>, h: T, v: T) {
    let mut bristle = state.bristle();
    law.step(&mut bristle, h, v);
    state.bend(bristle);
}

/// As [`step_elasto_plastic`].
#[inline(never)]
fn step_gms<T: Real>(law: &MaxwellSlip<T>, state: &mut LawState<T>, h: T, v: T) {
    let mut own = GmsState {
        elements: state.elements,
        force: state.force,
    };
    law.step(&mut own, h, v);
    state.elements = own.elements;
    state.force = own.force;
}

fn finite_or<T: Real>(value: T, other: T) -> T {
    if value.is_finite() { value } else { other }
}
