//! The result of a fit: parameters with their uncertainty, residuals, and what to beware of.

pub(crate) mod uncertainty;

use crate::conditioning::record::Record;
use crate::estimate::uncertainty::Covariance;
use crate::fit::Fit;
use crate::gms::choose::ElementsScore;
use crate::law::Law;
use crate::law::dependence::Dependence;
use crate::law::physical::{self, Dimension, Physical};
use crate::law::terms::{ColumnKind, Delay, Mass, Terms};
use crate::observe::Counts;
use crate::separable::Optimum;
use crate::separable::levenberg::Status;
use crate::separable::objective::Objective;
use nalgebra::DMatrix;

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
    /// 95 % interval (log-normal for parameters that are positive by nature, normal in the
    /// logarithm of the odds for shares); `None` where the data
    /// bound it on no side.
    pub ci95: Option<(f64, f64)>,
    /// What was added to the least-squares value to undo the bias of conditioning and noise; 0 if
    /// nothing.
    pub correction: f64,
    /// Whether the data determine it: standard deviation at most 10 % of the value (of a signed
    /// parameter also of the value that would be worth the Coulomb level in use), not at a bound.
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
    /// The numbers of elements that were tried for a Maxwell-slip law; empty where it was given.
    pub elements: Vec<ElementsScore>,
    /// Sample time of the record, s.
    pub(crate) step: f64,
    pub(crate) p: Vec<f64>,
    pub(crate) coefficients: Vec<f64>,
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

    /// How many unknowns were fitted; some laws have parameters that follow from others.
    pub fn fitted_unknowns(&self) -> usize {
        self.p.len() + self.coefficients.len()
    }

    pub(crate) fn unknowns(&self) -> &[f64] {
        &self.p
    }

    pub(crate) fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Delay of the force against the motion, in samples.
    pub(crate) fn delay_samples(&self) -> f64 {
        match (self.terms.delay, self.p.last()) {
            (Delay::Fitted, Some(&delay)) => delay,
            (Delay::Fitted, None) => 0.0,
            (Delay::Given(time), _) => time / self.step,
        }
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
    let found = Found::optimum(optimum);
    assemble(record, law, terms, optimum, low_speed_bound, &found)
}

/// The numbers that an estimate states, and what is known of their error beside the residual.
pub(crate) struct Found {
    /// Nonlinear unknowns.
    pub p: Vec<f64>,
    /// Linear ones.
    pub c: Vec<f64>,
    /// Covariance of both over replicas: the stated variances are no smaller.
    pub scatter: Option<DMatrix<f64>>,
    /// Covariance of the error of the numbers themselves, to be added.
    pub doubt: Option<DMatrix<f64>>,
}

impl Found {
    /// What the search found, as it stands.
    pub fn optimum(optimum: &Optimum) -> Self {
        Self {
            p: optimum.p.clone(),
            c: optimum.evaluation.solution.coefficients.clone(),
            scatter: None,
            doubt: None,
        }
    }
}

/// An estimate that states other numbers than the optimum, near it.
pub(crate) fn assemble(
    record: &Record,
    law: Law,
    terms: &Terms,
    optimum: &Optimum,
    low_speed_bound: f64,
    found: &Found,
) -> Estimate {
    // The number of elements is a result where the data chose it.
    let law = Law {
        elements: optimum.law.elements,
        ..law
    };
    let objective = Objective::new(record, law, terms);
    let at = &optimum.evaluation;
    let c = &found.c;
    let step = record.step();
    let raw = physical::physical(&law, objective.linear(), step, &found.p, c);
    let mut unknowns = uncertainty::unknowns(&objective, at);
    if let Some(scatter) = &found.scatter {
        unknowns = uncertainty::widened(&unknowns, scatter);
    }
    if let Some(doubt) = &found.doubt {
        unknowns += doubt;
    }
    let matrix = physical::propagate(&raw, &unknowns);
    let plain = Found::optimum(optimum);
    let before = physical::physical(&law, objective.linear(), step, &plain.p, &plain.c);
    let level = raw
        .iter()
        .filter(|p| matches!(p.name.as_str(), "coulomb" | "coulomb_pos" | "coulomb_neg"))
        .map(|p| p.value.abs())
        .fold(0.0, f64::max);
    let spans = objective.spans();
    let mut parameters: Vec<Parameter> = raw
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let span = p.linear.map_or(1.0, |j| spans[j]);
            Parameter {
                correction: p.value - before[i].value,
                ..describe(p, matrix[(i, i)], optimum, level / span, step)
            }
        })
        .collect();
    if law.kind.has_stribeck() {
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
    for (name, value) in terms.dependences.iter().filter_map(Dependence::reference) {
        if parameters.iter().all(|p| p.name != name) {
            let dimension = match name {
                "load_reference" => Dimension::Load,
                "temperature_reference" => Dimension::Temperature,
                _ => Dimension::Length,
            };
            parameters.push(Parameter {
                dimension,
                ..given(name, value)
            });
        }
    }
    let names: Vec<String> = raw.iter().map(|p| p.name.clone()).collect();
    let n = names.len();
    let covariance = Covariance {
        names,
        matrix: (0..n)
            .map(|i| (0..n).map(|j| matrix[(i, j)]).collect())
            .collect(),
    };
    let series = series(&objective, &found.p, c);
    let residual = &series.residual();
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
        step,
        p: found.p.clone(),
        elements: optimum.elements.clone(),
        coefficients: c.clone(),
    }
}

/// Signals of another record under a fitted law, nothing fitted again.
pub fn predict(record: &Record, fitted: &Estimate) -> Series {
    let objective = Objective::new(record, fitted.law, &fitted.terms);
    series(&objective, &fitted.p, &fitted.coefficients)
}

pub(crate) fn given(name: &str, value: f64) -> Parameter {
    Parameter {
        name: name.into(),
        dimension: Dimension::One,
        value,
        std: None,
        ci95: None,
        correction: 0.0,
        identifiable: true,
        identified: false,
        reason: String::new(),
    }
}

fn describe(p: &Physical, variance: f64, optimum: &Optimum, level: f64, step: f64) -> Parameter {
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
    let level = match p.dimension {
        Dimension::Time => step,
        _ => level,
    };
    judge(p, variance, reason, level)
}

/// A parameter with its deviation, interval and flag; `reason` says what already speaks against it, and
/// `level` is what a parameter that may be zero is measured by: the Coulomb level, the sample time.
pub(crate) fn judge(p: &Physical, variance: f64, mut reason: String, level: f64) -> Parameter {
    let known = reason.is_empty() && variance.is_finite() && variance >= 0.0;
    let std = known.then(|| variance.sqrt());
    if reason.is_empty() && std.is_none() {
        reason = "its deviation is beyond the range of numbers".into();
    }
    let (size, what) = match p.dimension {
        _ if p.positive => (p.value.abs(), "value"),
        Dimension::Time => (level, "the sample time"),
        _ => (p.value.abs().max(level), "value or of the Coulomb level"),
    };
    let relative = std.map(|s| s / size);
    if let Some(r) = relative
        && (r > IDENTIFIABLE || r.is_nan())
    {
        let of = if p.dimension == Dimension::Time {
            ""
        } else {
            "its "
        };
        reason = format!("standard deviation {:.0} % of {of}{what}", 100.0 * r);
    }
    let ci95 = std.and_then(|s| {
        if p.share {
            // Normal in the logarithm of the odds, so that it stays between 0 and 1.
            let odds = p.value / (1.0 - p.value);
            let r = s / (p.value * (1.0 - p.value));
            let at = |x: f64| 1.0 / (1.0 + libm::exp(-x) / odds);
            (r.is_finite() && r * Q95 <= 4.0).then(|| (at(-Q95 * r), at(Q95 * r)))
        } else if p.positive {
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
        correction: 0.0,
        identifiable: reason.is_empty(),
        identified: true,
        reason,
    }
}

fn series(objective: &Objective, p: &[f64], coefficients: &[f64]) -> Series {
    let record = objective.record();
    let parts = objective.parts(p, coefficients);
    let n = objective.force().len();
    let mut other = objective.inertia(p);
    other.resize(n, 0.0);
    let mut model = other.clone();
    for (term, part) in objective.linear().iter().zip(&parts) {
        let friction = matches!(
            term.column,
            ColumnKind::Level
                | ColumnKind::Element(_)
                | ColumnKind::Sign(_)
                | ColumnKind::Rate
                | ColumnKind::Speed(_)
                | ColumnKind::Square(_)
                | ColumnKind::LevelTimes(..)
                | ColumnKind::SpeedTimes(..)
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
        position: record.pick(|s| &s.position),
        velocity: record.pick(|s| &s.velocity),
        measured: objective.force().to_vec(),
        model,
        other,
    }
}

/// What a procedure other than the joint fit has found, as an estimate.
pub(crate) struct Assembled {
    pub law: Law,
    pub terms: Terms,
    pub parameters: Vec<Parameter>,
    pub covariance: Covariance,
    pub series: Series,
    pub status: Status,
    pub counts: Counts,
    /// Nonlinear unknowns and coefficients, in the order of the law.
    pub unknowns: (Vec<f64>, Vec<f64>),
}

impl Assembled {
    /// The estimate; the fit is that of the series.
    pub fn estimate(mut self) -> Estimate {
        self.parameters.sort_by_key(|p| physical::rank(&p.name));
        let residual = self.series.residual();
        let fit = Fit::new(&self.series.measured, &residual).unwrap_or(Fit {
            rmse: f64::MAX,
            relative_error_percent: f64::MAX,
            r2: f64::NAN,
            samples: residual.len(),
            effective_samples: 1.0,
        });
        Estimate {
            law: self.law,
            terms: self.terms,
            parameters: self.parameters,
            covariance: self.covariance,
            fit,
            low_speed: None,
            low_speed_bound: 0.0,
            series: self.series,
            status: self.status,
            counts: self.counts,
            iterations: self.counts.total(),
            history: Vec::new(),
            elements: Vec::new(),
            step: 0.0,
            p: self.unknowns.0,
            coefficients: self.unknowns.1,
        }
    }
}
