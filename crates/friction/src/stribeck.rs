//! The steady friction-velocity curve.

use crate::error::require;
use crate::{ParamError, Real, Shape};

/// The steady curve in one direction of motion. Plain numbers; [`Stribeck`] validates them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction<T> {
    /// Coulomb level Fc, > 0. N (N m for a rotary axis).
    pub coulomb: T,
    /// Static level Fs >= Fc. N (N m).
    pub static_friction: T,
    /// Stribeck velocity vs, > 0. m/s (rad/s).
    pub stribeck_velocity: T,
    /// Viscous coefficient sigma2, >= 0. N s/m (N m s/rad).
    pub viscous: T,
}

/// How the level of one direction depends on the numbers of its curve: derivatives, each in N (N m) per unit of its
/// parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelGradient<T> {
    /// With respect to Fc, dimensionless.
    pub coulomb: T,
    /// With respect to Fs, dimensionless.
    pub static_friction: T,
    /// With respect to vs, N s/m (N m s/rad).
    pub stribeck_velocity: T,
    /// With respect to the exponent of the shape, N (N m).
    pub stribeck_exponent: T,
}

impl<T: Real> Direction<T> {
    /// Level `Fc + (Fs - Fc) w(speed/vs)`, N (N m), at a speed >= 0 in m/s (rad/s), of any numbers, valid or not.
    #[inline(always)]
    pub fn level(&self, shape: Shape<T>, speed: T) -> T {
        let w = shape.weight(speed / self.stribeck_velocity);
        self.coulomb + (self.static_friction - self.coulomb) * w
    }

    /// Derivatives of [`level`](Self::level) with respect to the numbers of the curve.
    pub fn level_gradient(&self, shape: Shape<T>, speed: T) -> LevelGradient<T> {
        let x = speed / self.stribeck_velocity;
        let (w, slope) = shape.weight_and_slope(x);
        let drop = self.static_friction - self.coulomb;
        LevelGradient {
            coulomb: T::ONE - w,
            static_friction: w,
            stribeck_velocity: if slope == T::ZERO {
                T::ZERO
            } else {
                -drop * slope * x / self.stribeck_velocity
            },
            stribeck_exponent: drop * shape.weight_by_exponent(x),
        }
    }

    fn validate(&self, names: &[&'static str; 4]) -> Result<(), ParamError> {
        ParamError::positive(names[0], self.coulomb)?;
        require(
            self.static_friction.is_finite() && self.static_friction >= self.coulomb,
            names[1],
            self.static_friction,
            "finite and >= the Coulomb level",
        )?;
        ParamError::positive(names[2], self.stribeck_velocity)?;
        ParamError::not_negative(names[3], self.viscous)
    }

    fn cast<U: Real>(&self) -> Direction<U> {
        let to = |x: T| U::from_f64(x.to_f64());
        Direction {
            coulomb: to(self.coulomb),
            static_friction: to(self.static_friction),
            stribeck_velocity: to(self.stribeck_velocity),
            viscous: to(self.viscous),
        }
    }
}

/// The Stribeck curve: `F(v) = sgn(v) g(v) + sigma2 v + F0` with
/// `g(v) = Fc + (Fs - Fc) w(|v|/vs)`, in newtons (newton metres), one set of numbers for each direction.
///
/// Source: Canudas de Wit et al. 1995, doi 10.1109/9.376053, eqs. 4-5. There `sigma0 g` is the force; here g itself is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck<T> {
    shape: Shape<T>,
    pos: Direction<T>,
    neg: Direction<T>,
    offset: T,
}

impl<T: Real> Stribeck<T> {
    /// The same curve in both directions; `offset` F0 in N (N m), any finite value.
    pub fn symmetric(shape: Shape<T>, both: Direction<T>, offset: T) -> Result<Self, ParamError> {
        both.validate(&["coulomb", "static", "stribeck_velocity", "sigma2"])?;
        Self::checked(shape, both, both, offset)
    }

    /// A curve of its own for `v >= 0` (`pos`) and for `v < 0` (`neg`, its numbers positive too).
    pub fn new(
        shape: Shape<T>,
        pos: Direction<T>,
        neg: Direction<T>,
        offset: T,
    ) -> Result<Self, ParamError> {
        pos.validate(&[
            "coulomb_pos",
            "static_pos",
            "stribeck_velocity_pos",
            "sigma2_pos",
        ])?;
        neg.validate(&[
            "coulomb_neg",
            "static_neg",
            "stribeck_velocity_neg",
            "sigma2_neg",
        ])?;
        Self::checked(shape, pos, neg, offset)
    }

    fn checked(
        shape: Shape<T>,
        pos: Direction<T>,
        neg: Direction<T>,
        offset: T,
    ) -> Result<Self, ParamError> {
        shape.validate()?;
        ParamError::finite("offset", offset)?;
        Ok(Stribeck {
            shape,
            pos,
            neg,
            offset,
        })
    }

    /// How the level falls with speed.
    pub fn shape(&self) -> Shape<T> {
        self.shape
    }

    /// The numbers for `v >= 0`.
    pub fn positive(&self) -> &Direction<T> {
        &self.pos
    }

    /// The numbers for `v < 0`.
    pub fn negative(&self) -> &Direction<T> {
        &self.neg
    }

    /// Force at rest F0, N (N m).
    pub fn offset(&self) -> T {
        self.offset
    }

    /// The numbers that hold at velocity `v` (m/s, rad/s).
    #[inline]
    pub fn direction(&self, v: T) -> &Direction<T> {
        self.side(v >= T::ZERO)
    }

    /// Level `g(v) > 0`, N (N m), at velocity `v`; `v >= 0` takes the positive side.
    #[inline]
    pub fn level(&self, v: T) -> T {
        self.level_on(v >= T::ZERO, v.abs())
    }

    /// Level at the limit of zero velocity, N (N m): of the positive side for `sign >= 0`, else of the negative side.
    #[inline]
    pub fn static_level(&self, sign: T) -> T {
        self.side(sign >= T::ZERO).static_friction
    }

    /// The larger of the two static levels, N (N m): no bristle ever carries more.
    #[inline]
    pub fn largest_static_level(&self) -> T {
        self.pos.static_friction.max(self.neg.static_friction)
    }

    /// Level `g(v)` and its derivative with respect to `v`, N and N s/m (N m, N m s/rad).
    #[inline(always)]
    pub fn level_and_slope(&self, v: T) -> (T, T) {
        let positive = v >= T::ZERO;
        let d = self.side(positive);
        let (w, slope) = self.shape.weight_and_slope(v.abs() / d.stribeck_velocity);
        let drop = d.static_friction - d.coulomb;
        let by_speed = drop * slope / d.stribeck_velocity;
        (
            d.coulomb + drop * w,
            if positive { by_speed } else { -by_speed },
        )
    }

    /// Steady friction force at velocity `v`, N (N m), viscous part and offset included; at rest the offset.
    #[inline]
    pub fn force(&self, v: T) -> T {
        if v == T::ZERO {
            return self.offset;
        }
        let g = self.level(v);
        let dry = if v < T::ZERO { -g } else { g };
        dry + self.direction(v).viscous * v + self.offset
    }

    /// The same curve in another number type; an error if a number does not survive the change.
    pub fn cast<U: Real>(&self) -> Result<Stribeck<U>, ParamError> {
        let offset = U::from_f64(self.offset.to_f64());
        Stribeck::new(self.shape.cast(), self.pos.cast(), self.neg.cast(), offset)
    }

    #[inline]
    pub(crate) fn side(&self, positive: bool) -> &Direction<T> {
        if positive { &self.pos } else { &self.neg }
    }

    #[inline(always)]
    pub(crate) fn level_on(&self, positive: bool, speed: T) -> T {
        self.side(positive).level(self.shape, speed)
    }
}
