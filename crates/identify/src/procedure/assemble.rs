//! A static map and a step fit in the form of any fitted law, so that the same code can read all of them.

use super::parameter::Found;
use super::static_map::StaticMap;
use super::step_fit::{StepFit, StepSettings};
use crate::estimate::fitted::FittedLaw;
use crate::estimate::series::Series;
use crate::fit::Fit;
use crate::law::terms::{Mass, Terms};
use crate::law::{Law, LawKind};
use crate::parameter::covariance::Covariance;
use crate::parameter::{NORMAL_Q95, Parameter};
use stiction_friction::Direction;
use stiction_parameters::Quantity;
use stiction_search::{Counts, Status};

/// The fit is that of the series; parameters come in the order of tables.
fn fitted_law(
    law: Law,
    terms: Terms,
    mut parameters: Vec<Parameter>,
    covariance: &Covariance,
    series: Series,
    (status, counts): (Status, Counts),
) -> FittedLaw {
    parameters.sort_by_key(|p| p.name.quantity.place());
    let residual = series.residual();
    let fit = Fit::new(&series.measured, &residual).unwrap_or(Fit {
        rmse: f64::MAX,
        relative_error_percent: f64::MAX,
        r2: f64::NAN,
        samples: residual.len(),
        effective_samples: 1.0,
    });
    FittedLaw {
        law,
        terms,
        parameters,
        covariance: covariance.clone(),
        fit,
        low_speed: None,
        low_speed_bound: 0.0,
        effects: Vec::new(),
        disagreements: Vec::new(),
        likelier_exponent: None,
        of_the_counts: false,
        series,
        status,
        counts,
        iterations: counts.total(),
        history: Vec::new(),
        elements: Vec::new(),
    }
}

impl StaticMap {
    /// The map as a law without memory; its samples are the points, in order of velocity.
    pub fn fitted_law(&self) -> FittedLaw {
        let law = Law {
            kind: if self.settings.stribeck {
                LawKind::Stribeck
            } else {
                LawKind::CoulombViscous
            },
            asymmetric: self.settings.asymmetric,
            exponent: self.exponent(),
            ..Law::new(LawKind::Stribeck)
        };
        let terms = Terms {
            mass: Mass::Absent,
            offset: self.settings.offset && !self.settings.asymmetric,
            ..Terms::default()
        };
        let of = |f: &dyn Fn(usize) -> f64| (0..self.points.len()).map(f).collect();
        let offset = self.value(Quantity::Offset).unwrap_or(0.0);
        let series = Series {
            log: self.points.iter().map(|p| p.log).collect(),
            time: of(&|i| 0.5 * (self.points[i].time.0 + self.points[i].time.1)),
            position: of(&|i| self.points[i].position),
            velocity: of(&|i| self.points[i].velocity),
            measured: of(&|i| self.points[i].force),
            model: self.model.clone(),
            other: vec![offset; self.points.len()],
        };
        let ended = (Status::Converged, Counts::default());
        let parameters = self.parameters.clone();
        fitted_law(law, terms, parameters, &self.covariance, series, ended)
    }
}

impl StepFit {
    /// The fit as a LuGre law; its samples are displacements, not forces.
    pub fn fitted_law(&self, settings: &StepSettings) -> FittedLaw {
        let law = Law {
            exponent: settings.exponent,
            ..Law::new(LawKind::LuGre)
        };
        let is_known = self.covariance.place(Quantity::Offset.into()).is_some();
        let offset = (is_known || settings.offset != 0.0).then_some(settings.offset);
        let terms = Terms {
            mass: settings.mass.map_or(Mass::Fitted, Mass::Given),
            offset: offset.is_some(),
            ..Terms::default()
        };
        let mut parameters = self.parameters.clone();
        let fixed = self.value(Quantity::Static).unwrap_or(0.0);
        let curve = settings.curve.unwrap_or(Direction {
            coulomb: fixed,
            static_friction: fixed,
            stribeck_velocity: 1.0,
            viscous: 0.0,
        });
        // What is given and not exact was identified before.
        let known = |quantity: Quantity, value: f64| match self.covariance.place(quantity.into()) {
            Some(i) => Found {
                name: quantity.into(),
                value,
                variance: self.covariance.matrix[i][i],
                reason: "",
            }
            .parameter(curve.coulomb, NORMAL_Q95),
            None => Parameter::given(quantity, value),
        };
        parameters.push(known(Quantity::Sigma2, curve.viscous));
        parameters.push(known(Quantity::Coulomb, curve.coulomb));
        if settings.curve.is_some() {
            parameters.extend([
                known(Quantity::Static, curve.static_friction),
                known(Quantity::StribeckVelocity, curve.stribeck_velocity),
                known(Quantity::StribeckExponent, settings.exponent),
            ]);
        }
        if let Some(mass) = settings.mass {
            parameters.push(known(Quantity::Mass, mass));
        }
        if let Some(offset) = offset {
            parameters.push(known(Quantity::Offset, offset));
        }
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
        let ended = (self.status, self.counts);
        let covariance = self.covariance.in_order();
        fitted_law(law, terms, parameters, &covariance, series, ended)
    }
}
