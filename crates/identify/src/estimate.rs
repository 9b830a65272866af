//! The result of a fit: parameters with their uncertainty, residuals, and what to beware of.

mod advice;
mod autoregression;
mod conditioned;
mod curve;
pub(crate) mod intervals;
pub(crate) mod parameter;
mod profile;
pub(crate) mod uncertainty;

use crate::conditioning::record::Record;
use crate::estimate::parameter::Parameter;
use crate::estimate::uncertainty::{Covariance, Unknowns};
use crate::fit::Fit;
use crate::law::Law;
use crate::law::physical::{self, Dimension, Physical};
use crate::law::terms::{ColumnKind, Mass, Terms};
use crate::observe::Counts;
use crate::separable::Optimum;
use crate::separable::levenberg::Status;
use crate::separable::objective::Objective;

/// Signals at the samples of the fit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Which log each sample comes from, counted from 0.
    pub log: Vec<usize>,
    /// Time, s.
    pub time: Vec<f64>,
    /// Position, m or rad.
    pub position: Vec<f64>,
    /// Velocity, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Measured force.
    pub measured: Vec<f64>,
    /// Model of the force.
    pub model: Vec<f64>,
    /// Part of the model that is not friction: inertia, offset, gravity, cogging.
    pub other: Vec<f64>,
}

impl Series {
    /// Measured minus model.
    pub fn residual(&self) -> Vec<f64> {
        self.measured
            .iter()
            .zip(&self.model)
            .map(|(u, y)| u - y)
            .collect()
    }
}

/// A fitted law: enough to predict another record.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The law.
    pub law: Law,
    /// The linear terms beside it.
    pub terms: Terms,
    /// Its parameters, in the order of tables.
    pub parameters: Vec<Parameter>,
    /// Covariance of the identified parameters.
    pub covariance: Covariance,
    /// Fit over all kept samples.
    pub fit: Fit,
    /// Fit over the kept samples slower than `low_speed_bound`.
    pub low_speed: Option<Fit>,
    /// That bound, m/s or rad/s.
    pub low_speed_bound: f64,
    /// Signals at the kept samples.
    pub series: Series,
    /// How the search ended.
    pub status: Status,
    /// Evaluations by kind.
    pub counts: Counts,
    /// Steps of all descents.
    pub iterations: usize,
    /// Evaluations and relative residual over the last descent.
    pub history: Vec<(usize, f64)>,
    p: Vec<f64>,
    coefficients: Vec<f64>,
    unknowns: Unknowns,
}

impl Estimate {
    /// The parameter of this name.
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|p| p.name == name)
    }

    /// The value of this name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.parameter(name).map(|p| p.value)
    }

    pub(crate) fn unknowns(&self) -> &[f64] {
        &self.p
    }
}

/// Parameters, linear uncertainty and residuals at an optimum.
pub fn estimate(
    record: &Record,
    law: Law,
    terms: &Terms,
    optimum: &Optimum,
    low_speed_bound: f64,
) -> Estimate {
    let objective = Objective::new(record, law, terms);
    let at = &optimum.evaluation;
    let c = &at.solution.coefficients;
    let raw = physical::physical(&law, objective.linear(), &optimum.p, c);
    let unknowns = uncertainty::unknowns(&objective, at);
    let matrix = physical::propagate(&raw, &unknowns.covariance);
    let level = level(&raw);
    let mut parameters: Vec<Parameter> = raw
        .iter()
        .enumerate()
        .map(|(i, p)| Parameter::fitted(p, matrix[(i, i)], None, optimum, level))
        .collect();
    if law.kind.has_stribeck() && !law.exponent_fitted {
        let at = parameters
            .iter()
            .rposition(|p| p.name.starts_with("stribeck_velocity"))
            .map_or(parameters.len(), |i| i + 1);
        let given = Parameter::given("stribeck_exponent", Dimension::One, law.exponent);
        parameters.insert(at, given);
    }
    if let Mass::Given(mass) = terms.mass {
        let at = parameters
            .iter()
            .position(|p| p.name == "offset")
            .unwrap_or(parameters.len());
        parameters.insert(at, Parameter::given("mass", Dimension::Inertia, mass));
    }
    let names: Vec<String> = raw.iter().map(|p| p.name.clone()).collect();
    let n = names.len();
    let covariance = Covariance {
        names,
        matrix: (0..n)
            .map(|i| (0..n).map(|j| matrix[(i, j)]).collect())
            .collect(),
    };
    curve::stays_within(&law, optimum, &mut parameters);
    advice::explain(&mut parameters, &covariance);
    let series = series(&objective, &optimum.p, c);
    let residual = at.residual();
    // The search refuses a force without energy; what is left is a residual too large to square.
    let fit = Fit::new(&series.measured, residual).unwrap_or(Fit {
        rmse: f64::MAX,
        relative_error_percent: f64::MAX,
        r2: f64::NAN,
        samples: residual.len(),
        effective_samples: 1.0,
    });
    let low_speed = Fit::slow(
        &series.measured,
        residual,
        &series.velocity,
        low_speed_bound,
    );
    Estimate {
        law,
        terms: terms.clone(),
        parameters,
        covariance,
        fit,
        low_speed,
        low_speed_bound,
        series,
        status: optimum.status,
        counts: optimum.counts,
        iterations: optimum.iterations,
        history: optimum.history.clone(),
        p: optimum.p.clone(),
        coefficients: c.clone(),
        unknowns,
    }
}

/// Signals of another record under a fitted law, nothing fitted again.
pub fn predict(record: &Record, fitted: &Estimate) -> Series {
    let objective = Objective::new(record, fitted.law, &fitted.terms);
    series(&objective, &fitted.p, &fitted.coefficients)
}

/// The largest Coulomb level, which measures parameters that may be zero.
fn level(raw: &[Physical]) -> f64 {
    raw.iter()
        .filter(|p| p.name.starts_with("coulomb"))
        .map(|p| p.value.abs())
        .fold(0.0, f64::max)
}

fn series(objective: &Objective, p: &[f64], coefficients: &[f64]) -> Series {
    let record = objective.record();
    let parts = objective.parts(p, coefficients);
    let n = objective.force().len();
    let mut other = objective.inertia().to_vec();
    other.resize(n, 0.0);
    let mut model = other.clone();
    for (term, part) in objective.linear().iter().zip(&parts) {
        let friction = matches!(
            term.column,
            ColumnKind::Level | ColumnKind::Sign(_) | ColumnKind::Rate | ColumnKind::Speed(_)
        );
        for (i, x) in part.iter().enumerate() {
            model[i] += x;
            if !friction {
                other[i] += x;
            }
        }
    }
    let mut log = Vec::with_capacity(n);
    for segment in &record.segments {
        log.extend(segment.keep.iter().filter(|&&k| k).map(|_| segment.log));
    }
    Series {
        log,
        time: record.gather(|s| &s.time),
        position: record.gather(|s| &s.position),
        velocity: record.gather(|s| &s.speed),
        measured: objective.force().to_vec(),
        model,
        other,
    }
}
