//! The steady curve as a procedure takes it over: from a static map, or from an earlier model.

use super::static_map::StaticMap;
use crate::error::Error;
use crate::estimate::parameter::Parameter;
use crate::estimate::uncertainty::Covariance;
use crate::law::Law;
use crate::law::terms::LinearTerm;
use nalgebra::DMatrix;
use stiction_friction::Direction;

/// A rise that counts as none stands for this part of the Coulomb level, so that it has a logarithm.
const LEAST_RISE: f64 = 1e-9;

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
        let asymmetric = parameters.iter().any(|p| p.name == "coulomb_pos");
        let value = |name: &'static str, side: usize| {
            let suffix = match (asymmetric, side) {
                (false, _) => "",
                (true, 0) => "_pos",
                (true, _) => "_neg",
            };
            let found = parameters
                .iter()
                .find(|p| p.name.strip_prefix(name) == Some(suffix));
            found.map(|p| p.value)
        };
        let need = |name: &'static str, side: usize| {
            value(name, side)
                .filter(|x| x.is_finite())
                .ok_or(Error::Setting {
                    name,
                    found: f64::NAN,
                    allowed: "a number in the static parameters that are taken over",
                })
        };
        let side = |side: usize| {
            let coulomb = need("coulomb", side)?;
            let fixed = value("static", side).unwrap_or(coulomb);
            Ok::<_, Error>(Direction {
                coulomb,
                static_friction: fixed.max(coulomb * (1.0 + LEAST_RISE)),
                stribeck_velocity: value("stribeck_velocity", side).unwrap_or(1.0),
                viscous: need("sigma2", side)?,
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
            .map(|term| match term.name.as_str() {
                "coulomb" | "coulomb_pos" => self.sides[0].coulomb,
                "coulomb_neg" => self.sides[1].coulomb,
                "sigma2" | "sigma2_pos" => self.sides[0].viscous,
                "sigma2_neg" => self.sides[1].viscous,
                _ => 0.0,
            })
            .collect();
        (p, c)
    }

    /// Which coefficients belong to the curve.
    pub(super) fn owns(term: &LinearTerm) -> bool {
        term.name.starts_with("coulomb") || term.name.starts_with("sigma2")
    }

    /// Slopes of the unknowns `(p, c)` with the parameters of the covariance, one row per unknown.
    pub(super) fn slopes(&self, law: &Law, linear: &[LinearTerm]) -> DMatrix<f64> {
        let layout = law.layout();
        let names = &self.covariance.names;
        let mut out = DMatrix::zeros(layout.count + linear.len(), names.len());
        let at = |stem: &str, side: usize| {
            let suffix = match (self.asymmetric, side) {
                (false, _) => "",
                (true, 0) => "_pos",
                (true, _) => "_neg",
            };
            names
                .iter()
                .position(|n| n.strip_prefix(stem) == Some(suffix))
        };
        for (k, side) in self.sides.iter().enumerate() {
            let rise = side.static_friction - side.coulomb;
            if let Some(i) = layout.excess[k] {
                if let Some(j) = at("static", k) {
                    out[(i, j)] = 1.0 / rise;
                }
                if let Some(j) = at("coulomb", k) {
                    out[(i, j)] = -side.static_friction / (side.coulomb * rise);
                }
            }
            if let (Some(i), Some(j)) = (layout.velocity[k], at("stribeck_velocity", k)) {
                out[(i, j)] = 1.0 / side.stribeck_velocity;
            }
            if let (Some(i), Some(j)) = (layout.ratio, at("coulomb", k)) {
                out[(i, j)] = if k == 0 { -1.0 } else { 1.0 } / side.coulomb;
            }
        }
        for (i, term) in linear.iter().enumerate() {
            // A coefficient without suffix is that of the positive direction.
            let own = names
                .iter()
                .position(|n| *n == term.name || (term.name == "coulomb" && n == "coulomb_pos"));
            if let (true, Some(j)) = (Self::owns(term), own) {
                out[(layout.count + i, j)] = 1.0;
            }
        }
        out
    }
}
