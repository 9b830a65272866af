//! The steady curve that a procedure takes as known: from a static map, or from an earlier model.

use super::static_map::{LEAST_RISE, StaticMap};
use crate::error::Error;
use crate::law::Law;
use crate::law::terms::LinearTerm;
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use nalgebra::DMatrix;
use stiction_friction::Direction;
use stiction_parameters::{Name, Quantity, Side};

/// Steady friction that is known, with what is known of its uncertainty.
#[derive(Clone, Debug)]
pub struct Statics {
    /// Numbers for positive and negative velocity.
    pub sides: [Direction<f64>; 2],
    /// Whether the two differ.
    pub asymmetric: bool,
    /// Stribeck exponent, > 0.
    pub exponent: f64,
    /// The parameters as they were identified; those of other names are passed over.
    pub parameters: Vec<Parameter>,
    /// Their covariance.
    pub covariance: Covariance,
}

impl Statics {
    /// Takes the steady curve out of parameters with the names of `result.json`.
    ///
    /// # Errors
    /// For a name that is missing or a number out of range ([`Error::Setting`]).
    pub fn new(
        parameters: Vec<Parameter>,
        covariance: Covariance,
        exponent: f64,
    ) -> Result<Self, Error> {
        let asymmetric = parameters
            .iter()
            .any(|p| p.name == Name::new(Quantity::Coulomb, Side::Positive));
        let value = |quantity: Quantity, side: usize| {
            let name = Name::new(quantity, direction(asymmetric, side));
            let found = parameters.iter().find(|p| p.name == name);
            found.map(|p| p.value)
        };
        let need = |quantity: Quantity, name: &'static str, side: usize| {
            value(quantity, side)
                .filter(|x| x.is_finite())
                .ok_or(Error::Setting {
                    name,
                    found: f64::NAN,
                    allowed: "a number in the static parameters that are taken over",
                })
        };
        let side = |side: usize| {
            let coulomb = need(Quantity::Coulomb, "coulomb", side)?;
            let fixed = value(Quantity::Static, side).unwrap_or(coulomb);
            Ok::<_, Error>(Direction {
                coulomb,
                static_friction: fixed.max(coulomb * (1.0 + LEAST_RISE)),
                stribeck_velocity: value(Quantity::StribeckVelocity, side).unwrap_or(1.0),
                viscous: need(Quantity::Sigma2, "sigma2", side)?,
            })
        };
        let (pos, neg) = (side(0)?, side(1)?);
        if !(exponent > 0.0 && exponent.is_finite()) {
            return Err(Error::Setting {
                name: "stribeck_exponent",
                found: exponent,
                allowed: "a finite number above 0",
            });
        }
        for side in [pos, neg] {
            let positive = [
                ("coulomb", side.coulomb),
                ("stribeck_velocity", side.stribeck_velocity),
            ];
            if let Some((name, found)) = positive.into_iter().find(|(_, x)| x.is_nan() || *x <= 0.0)
            {
                let allowed = "a static parameter above 0";
                return Err(Error::Setting {
                    name,
                    found,
                    allowed,
                });
            }
        }
        Ok(Self {
            sides: [pos, neg],
            asymmetric,
            exponent,
            parameters,
            covariance,
        })
    }

    /// The curve of a static map.
    ///
    /// # Errors
    /// As [`Statics::new`]: a map without friction is no curve.
    pub fn from_map(map: &StaticMap) -> Result<Self, Error> {
        let exponent = map.exponent();
        Self::new(map.parameters.clone(), map.covariance.clone(), exponent)
    }

    /// Nonlinear unknowns and coefficients of a law with this curve; what is not of the curve is zero.
    pub(super) fn unknowns(&self, law: &Law, linear: &[LinearTerm]) -> (Vec<f64>, Vec<f64>) {
        let layout = law.layout();
        let mut p = vec![0.0; layout.count];
        for (k, side) in self.sides.iter().enumerate() {
            if let Some(i) = layout.excess[k] {
                p[i] = libm::log(side.static_friction / side.coulomb - 1.0);
            }
            if let Some(i) = layout.velocity[k] {
                p[i] = libm::log(side.stribeck_velocity);
            }
        }
        if let Some(i) = layout.ratio {
            p[i] = libm::log(self.sides[1].coulomb / self.sides[0].coulomb);
        }
        let c = linear
            .iter()
            .map(|term| {
                let side = &self.sides[term.name.side.index()];
                match term.name.quantity {
                    Quantity::Coulomb => side.coulomb,
                    Quantity::Sigma2 => side.viscous,
                    _ => 0.0,
                }
            })
            .collect();
        (p, c)
    }

    /// Whether a parameter is one of the curve.
    pub(super) fn holds(quantity: Quantity) -> bool {
        quantity.is_of_the_steady_curve() || Self::owns_quantity(quantity)
    }

    /// Which coefficients belong to the curve.
    pub(super) fn owns(term: &LinearTerm) -> bool {
        Self::owns_quantity(term.name.quantity)
    }

    fn owns_quantity(quantity: Quantity) -> bool {
        matches!(
            quantity,
            Quantity::Coulomb
                | Quantity::CoulombLoad
                | Quantity::CoulombTemperature
                | Quantity::CoulombPosition
                | Quantity::CoulombPitch(..)
                | Quantity::CoulombMap(_)
                | Quantity::CoulombTransmitted
                | Quantity::CoulombDriven
                | Quantity::Sigma2
                | Quantity::Sigma2Temperature
        )
    }

    /// Slopes of the unknowns `(p, c)` with the parameters of the covariance, one row per unknown.
    pub(super) fn slopes(&self, law: &Law, linear: &[LinearTerm]) -> DMatrix<f64> {
        let layout = law.layout();
        let names = &self.covariance.names;
        let mut out = DMatrix::zeros(layout.count + linear.len(), names.len());
        let at = |quantity, side: usize| {
            let name = Name::new(quantity, direction(self.asymmetric, side));
            self.covariance.place(name)
        };
        for (k, side) in self.sides.iter().enumerate() {
            let rise = side.static_friction - side.coulomb;
            if let Some(i) = layout.excess[k] {
                if let Some(j) = at(Quantity::Static, k) {
                    out[(i, j)] = 1.0 / rise;
                }
                if let Some(j) = at(Quantity::Coulomb, k) {
                    out[(i, j)] = -side.static_friction / (side.coulomb * rise);
                }
            }
            if let (Some(i), Some(j)) = (layout.velocity[k], at(Quantity::StribeckVelocity, k)) {
                out[(i, j)] = 1.0 / side.stribeck_velocity;
            }
            if let (Some(i), Some(j)) = (layout.ratio, at(Quantity::Coulomb, k)) {
                out[(i, j)] = if k == 0 { -1.0 } else { 1.0 } / side.coulomb;
            }
        }
        let positive = Name::new(Quantity::Coulomb, Side::Positive);
        for (i, term) in linear.iter().enumerate() {
            // A coefficient without suffix is that of the positive direction.
            let own = names.iter().position(|n| {
                *n == term.name || (term.name == Quantity::Coulomb && *n == positive)
            });
            if let (true, Some(j)) = (Self::owns(term), own) {
                out[(layout.count + i, j)] = 1.0;
            }
        }
        out
    }
}

/// The direction of a side (0 positive, 1 negative) in the names of a curve.
fn direction(asymmetric: bool, side: usize) -> Side {
    match (asymmetric, side) {
        (false, _) => Side::Both,
        (true, 0) => Side::Positive,
        (true, _) => Side::Negative,
    }
}
