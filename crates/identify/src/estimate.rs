//! The result of a fit: parameters with their uncertainty, residuals, and what to beware of.

pub(crate) mod uncertainty;

use crate::conditioning::record::Record;
use crate::estimate::uncertainty::Covariance;
use crate::fit::Fit;
use crate::law::Law;
use crate::law::physical::{self, Dimension, Physical};
use crate::law::terms::{ColumnKind, Mass, Terms};
use crate::observe::Counts;
use crate::separable::Optimum;
use crate::separable::levenberg::Status;
use crate::separable::objective::Objective;

/// Relative standard deviation above which a parameter counts as not determined by the data.
pub const IDENTIFIABLE: f64 = 0.10;
/// Two-sided 95 % quantile of the normal distribution.
const Q95: f64 = 1.959_963_984_540_054;

/// One parameter of the law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name in files, such as `sigma0` or `coulomb_pos`.
    pub name: String,
    /// What it measures.
    pub dimension: Dimension,
    /// Best value, SI.
    pub value: f64,
    /// Standard deviation with correlated residuals counted; `None` where the data say nothing.
    pub std: Option<f64>,
    /// 95 % interval (log-normal for parameters that are positive by nature); `None` where the data
    /// bound it on no side.
    pub ci95: Option<(f64, f64)>,
    /// Whether the data determine it: standard deviation at most 10 % and not at a bound.
    pub identifiable: bool,
    /// Whether it was fitted; a given parameter has no deviation.
    pub identified: bool,
    /// Why it is not identifiable; empty if it is.
    pub reason: String,
}

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

/// Parameters, uncertainty and residuals at an optimum.
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
    let matrix = physical::propagate(&raw, &unknowns);
    let level = raw
        .iter()
        .filter(|p| p.name.starts_with("coulomb"))
        .map(|p| p.value.abs())
        .fold(0.0, f64::max);
    let mut parameters: Vec<Parameter> = raw
        .iter()
        .enumerate()
        .map(|(i, p)| describe(p, matrix[(i, i)], optimum, level))
        .collect();
    if law.kind.has_stribeck() && !law.exponent_fitted {
        let at = parameters
            .iter()
            .rposition(|p| p.name.starts_with("stribeck_velocity"))
            .map_or(parameters.len(), |i| i + 1);
        parameters.insert(at, given("stribeck_exponent", law.exponent));
    }
    if let Mass::Given(mass) = terms.mass {
        let at = parameters
            .iter()
            .position(|p| p.name == "offset")
            .unwrap_or(parameters.len());
        parameters.insert(
            at,
            Parameter {
                dimension: Dimension::Inertia,
                ..given("mass", mass)
            },
        );
    }
    let names: Vec<String> = raw.iter().map(|p| p.name.clone()).collect();
    let n = names.len();
    let covariance = Covariance {
        names,
        matrix: (0..n)
            .map(|i| (0..n).map(|j| matrix[(i, j)]).collect())
            .collect(),
    };
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
    }
}

/// Signals of another record under a fitted law, nothing fitted again.
pub fn predict(record: &Record, fitted: &Estimate) -> Series {
    let objective = Objective::new(record, fitted.law, &fitted.terms);
    series(&objective, &fitted.p, &fitted.coefficients)
}

fn given(name: &str, value: f64) -> Parameter {
    Parameter {
        name: name.into(),
        dimension: Dimension::One,
        value,
        std: None,
        ci95: None,
        identifiable: true,
        identified: false,
        reason: String::new(),
    }
}

fn describe(p: &Physical, variance: f64, optimum: &Optimum, level: f64) -> Parameter {
    let solution = &optimum.evaluation.solution;
    let mut reason = String::new();
    if let Some(i) = p.nonlinear
        && optimum.bounds.at_bound(&optimum.p, i)
    {
        reason = "stands at the bound of its search range".into();
    }
    if let Some(j) = p.linear {
        if solution.dependent[j] {
            reason = "cannot be told apart from the other terms on this motion".into();
        } else if !solution.active[j] {
            reason = "held at zero: the data ask for a negative value".into();
        }
    }
    let known = reason.is_empty() && variance.is_finite() && variance >= 0.0;
    let std = known.then(|| variance.sqrt());
    if reason.is_empty() && std.is_none() {
        reason = "its deviation is beyond the range of numbers".into();
    }
    let size = if p.positive {
        p.value.abs()
    } else {
        p.value.abs().max(level)
    };
    let relative = std.map(|s| s / size);
    if let Some(r) = relative
        && (r > IDENTIFIABLE || r.is_nan())
    {
        reason = format!(
            "standard deviation {:.0} % of its {}",
            100.0 * r,
            if p.positive {
                "value"
            } else {
                "value or of the Coulomb level"
            }
        );
    }
    let ci95 = std.and_then(|s| {
        if p.positive {
            let r = s / p.value;
            // Wider than a factor of e^4 to each side, the data bound it on no side.
            (r.is_finite() && r * Q95 <= 4.0)
                .then(|| (p.value * libm::exp(-Q95 * r), p.value * libm::exp(Q95 * r)))
        } else {
            Some((p.value - Q95 * s, p.value + Q95 * s))
        }
    });
    Parameter {
        name: p.name.clone(),
        dimension: p.dimension,
        value: p.value,
        std,
        ci95,
        identifiable: reason.is_empty(),
        identified: true,
        reason,
    }
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
