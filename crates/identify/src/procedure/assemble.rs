//! A static map and a step fit as estimates, so that what reads one reads all.

use super::static_map::StaticMap;
use super::statics::Statics;
use super::step_fit::{StepFit, StepSettings};
use crate::estimate::parameter::Parameter;
use crate::estimate::{Assembled, Estimate, Series};
use crate::law::physical::Dimension;
use crate::law::terms::{Mass, Terms};
use crate::law::{Law, LawKind};
use crate::observe::Counts;
use crate::separable::levenberg::Status;
use stiction_friction::Direction;

/// Coefficients of a law by their names; what is not found is zero.
fn coefficients(law: &Law, terms: &Terms, parameters: &[Parameter]) -> Vec<f64> {
    let value = |name: &str| parameters.iter().find(|p| p.name == name).map(|p| p.value);
    terms
        .columns(law)
        .iter()
        .map(|term| {
            let own = value(&term.name);
            own.or_else(|| value(&format!("{}_pos", term.name)))
                .unwrap_or(0.0)
        })
        .collect()
}

impl StaticMap {
    /// The map as an estimate of a law without memory; its samples are the points, in order of
    /// velocity.
    pub fn estimate(&self) -> Estimate {
        let law = Law {
            kind: if self.settings.stribeck {
                LawKind::Stribeck
            } else {
                LawKind::CoulombViscous
            },
            asymmetric: self.settings.asymmetric,
            exponent: self.exponent(),
            elements: 0,
            exponent_fitted: false,
        };
        let terms = Terms {
            mass: Mass::Absent,
            offset: self.settings.offset && !self.settings.asymmetric,
            ..Terms::default()
        };
        let linear = terms.columns(&law);
        // A map without friction is no curve, and then no record is predicted from it.
        let p = Statics::from_map(self).map_or(vec![0.0; law.nonlinear()], |statics| {
            statics.unknowns(&law, &linear).0
        });
        let c = coefficients(&law, &terms, &self.parameters);
        let of = |f: &dyn Fn(usize) -> f64| (0..self.points.len()).map(f).collect();
        let offset = self.value("offset").unwrap_or(0.0);
        Assembled {
            series: Series {
                log: self.points.iter().map(|p| p.log).collect(),
                time: of(&|i| 0.5 * (self.points[i].time.0 + self.points[i].time.1)),
                position: of(&|i| self.points[i].position),
                velocity: of(&|i| self.points[i].velocity),
                measured: of(&|i| self.points[i].force),
                model: self.model.clone(),
                other: vec![offset; self.points.len()],
            },
            law,
            terms,
            parameters: self.parameters.clone(),
            covariance: self.covariance.clone(),
            status: Status::Converged,
            counts: Counts::default(),
            unknowns: (p, c),
        }
        .estimate()
    }
}

impl StepFit {
    /// The fit as an estimate of LuGre; its samples are displacements, not forces.
    pub fn estimate(&self, settings: &StepSettings) -> Estimate {
        let law = Law {
            exponent: settings.exponent,
            ..Law::new(LawKind::LuGre)
        };
        let terms = Terms {
            mass: settings.mass.map_or(Mass::Fitted, Mass::Given),
            offset: false,
            ..Terms::default()
        };
        let mut parameters = self.parameters.clone();
        let fixed = self.value("static").unwrap_or(0.0);
        let curve = settings.curve.unwrap_or(Direction {
            coulomb: fixed,
            static_friction: fixed,
            stribeck_velocity: 1.0,
            viscous: 0.0,
        });
        parameters.push(Parameter::given(
            "sigma2",
            Dimension::Damping,
            curve.viscous,
        ));
        parameters.push(Parameter::given("coulomb", Dimension::Force, curve.coulomb));
        if settings.curve.is_some() {
            parameters.push(Parameter::given(
                "static",
                Dimension::Force,
                curve.static_friction,
            ));
            parameters.push(Parameter::given(
                "stribeck_velocity",
                Dimension::Speed,
                curve.stribeck_velocity,
            ));
            parameters.push(Parameter::given(
                "stribeck_exponent",
                Dimension::One,
                settings.exponent,
            ));
        }
        if let Some(mass) = settings.mass {
            parameters.push(Parameter::given("mass", Dimension::Inertia, mass));
        }
        let kappa = self.value("sigma0").unwrap_or(1.0) / curve.coulomb;
        let rise = (curve.static_friction / curve.coulomb - 1.0).max(1e-9);
        let p = vec![
            libm::log(kappa),
            libm::log(rise),
            libm::log(curve.stribeck_velocity),
        ];
        let c = coefficients(&law, &terms, &parameters);
        let mut series = Series::default();
        for (log, response) in self.series.iter().enumerate() {
            let n = response.time.len();
            series.log.extend(std::iter::repeat_n(log, n));
            series.time.extend(&response.time);
            series.position.extend(&response.measured);
            series.velocity.extend(std::iter::repeat_n(0.0, n));
            series.measured.extend(&response.measured);
            series.model.extend(&response.model);
            series.other.extend(std::iter::repeat_n(0.0, n));
        }
        Assembled {
            law,
            terms,
            parameters,
            covariance: self.covariance.clone(),
            series,
            status: self.status,
            counts: self.counts,
            unknowns: (p, c),
        }
        .estimate()
    }
}
