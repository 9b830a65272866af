//! The result of a fit: parameters with their uncertainty, residuals, and warnings.

pub(crate) mod advice;
mod autoregression;
mod conditioned;
mod delayed;
mod filtered;
pub(crate) mod fitted;
mod informed;
pub(crate) mod intervals;
mod optimal;
mod pressed;
pub(crate) mod searched;
pub(crate) mod series;
pub(crate) mod sliding;
mod stroke;
pub(crate) mod uncertainty;
mod windows;

pub use stroke::LevelAlong;

use crate::conditioning::record::Record;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::series::Series;
use crate::fit::Fit;
use crate::held_delay;
use crate::law::Law;
use crate::law::dependence::Dependence;
use crate::law::physical::physical;
use crate::law::terms::{ColumnKind, Delay, Mass, Terms};
use crate::law::transmitted;
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use crate::parameter::physical::{Physical, propagate};
use crate::scatter::Scatter;
use crate::separable::fixed::Column;
use crate::separable::logs::Logs;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use std::ops::Deref;
use stiction_parameters::{Dimension, Quantity};
use stiction_search::{Counts, Status};

/// A law fitted to the force of a record: what any fit states, and what it takes to predict the force of
/// another record ([`predict`]).
#[derive(Clone, Debug)]
pub struct Estimate {
    pub(crate) fitted: FittedLaw,
    /// Sample time of the record, s.
    pub(crate) step: f64,
    pub(crate) p: Vec<f64>,
    pub(crate) coefficients: Vec<f64>,
    pub(crate) unknowns: Scatter,
    /// Root mean square of the residual within the logs; of a single one that of the fit.
    pub(crate) within: f64,
}

impl Estimate {
    /// Leaves parameters open for what this fit does not see: where `why` gives a reason, and they were identified.
    pub fn doubt(&mut self, why: impl Fn(&Parameter) -> Option<&'static str>) {
        for p in &mut self.fitted.parameters {
            if let Some(reason) = why(p).filter(|_| p.identified && p.identifiable) {
                p.identifiable = false;
                p.reason = reason.into();
            }
        }
    }
}

impl Deref for Estimate {
    type Target = FittedLaw;

    fn deref(&self) -> &FittedLaw {
        &self.fitted
    }
}

impl From<Estimate> for FittedLaw {
    fn from(estimate: Estimate) -> Self {
        estimate.fitted
    }
}

impl Estimate {
    /// Counts in the half widths for another motion how far laws that predict as well have each parameter from this one.
    #[must_use]
    pub fn with_range_over(mut self, as_good: &[Estimate]) -> Self {
        for own in &mut self.fitted.parameters {
            let Some(half) = &mut own.half else { continue };
            let others = as_good.iter().filter_map(|other| other.value(own.name));
            let range = others.fold(0.0_f64, |most, value| most.max((value - own.value).abs()));
            half.transfer = libm::hypot(half.transfer, range);
        }
        self
    }

    /// The same estimate as one whose search was stopped early: its values are what was found until then, without intervals.
    #[must_use]
    pub fn interrupted(mut self) -> Self {
        self.fitted.stopped();
        self
    }

    /// Adds evaluations that led to it.
    pub fn count(&mut self, more: &Counts) {
        self.fitted.counts.add(more);
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

    /// Time constant of the lag of the force, in samples.
    pub(crate) fn lag_samples(&self) -> f64 {
        match self.terms.delay {
            Delay::Fitted => self.terms.lag.time() / self.step,
            Delay::Given(_) => 0.0,
        }
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
    // The number of elements is a result where the data chose it.
    let law = Law {
        elements: optimum.law.elements,
        ..law
    };
    let objective = Objective::new(record, law, terms);
    let at = &optimum.evaluation;
    let c = &at.solution.coefficients;
    let raw = physical(&law, objective.linear(), record.step(), &optimum.p, c);
    let unknowns = uncertainty::unknowns(&objective, at);
    let matrix = propagate(&raw, &unknowns.repeat());
    let levels = levels(&objective, &raw);
    let mut parameters: Vec<Parameter> = raw
        .iter()
        .zip(&levels)
        .map(|(p, level)| optimal::fitted(p, unknowns.of(p), None, optimum, *level))
        .collect();
    if law.has_stribeck() && !law.exponent_fitted {
        let at = parameters
            .iter()
            .rposition(|p| p.name.quantity == Quantity::StribeckVelocity)
            .map_or(parameters.len(), |i| i + 1);
        let given = Parameter::given(Quantity::StribeckExponent, law.exponent);
        parameters.insert(at, given);
    }
    if law.undamped {
        let at = parameters
            .iter()
            .position(|p| p.name.quantity.place() > Quantity::Sigma1.place())
            .unwrap_or(parameters.len());
        parameters.insert(at, Parameter::given(Quantity::Sigma1, 0.0));
    }
    if let Mass::Given(mass) = terms.mass {
        let at = parameters
            .iter()
            .position(|p| p.name == Quantity::Offset)
            .unwrap_or(parameters.len());
        parameters.insert(at, Parameter::given(Quantity::Mass, mass));
    }
    if let Some(delay) = held_delay::parameter(terms, record.step()) {
        let after = |p: &Parameter| p.name.quantity.place() > Quantity::Delay.place();
        let at = parameters
            .iter()
            .position(after)
            .unwrap_or(parameters.len());
        parameters.insert(at, delay);
    }
    for (name, value) in terms.dependences.iter().flat_map(Dependence::references) {
        if parameters.iter().all(|p| p.name != name) {
            parameters.push(Parameter::given(name, value));
        }
    }
    let covariance = Covariance::new(raw.iter().map(|p| p.name).collect(), &matrix);
    sliding::flag_what_the_motion_hides(record, &mut parameters);
    transmitted::flag_parts_of_an_open_weight(terms, &mut parameters);
    advice::explain(&mut parameters, &covariance);
    let series = series(&objective, &optimum.p, c, &at.columns);
    let residual = at.residual();
    // The search refuses a force that is zero throughout; the remaining case is a residual too large to square.
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
    let within = Logs::of(record).and_then(|logs| logs.within(at));
    let within = within.and_then(|within| Fit::new(&series.measured, &within));
    let found = Estimate {
        within: within.map_or(fit.rmse, |within| within.rmse),
        fitted: FittedLaw {
            law,
            terms: terms.clone(),
            parameters,
            covariance,
            fit,
            low_speed,
            low_speed_bound,
            effects: Vec::new(),
            disagreements: Vec::new(),
            likelier_exponent: None,
            of_the_counts: false,
            series,
            status: optimum.status,
            counts: optimum.counts,
            iterations: optimum.iterations,
            history: optimum.history.clone(),
            elements: optimum.elements.clone(),
        },
        step: record.step(),
        p: optimum.p.clone(),
        coefficients: c.clone(),
        unknowns,
    };
    match optimum.status {
        Status::Interrupted => found.interrupted(),
        _ => found,
    }
}

/// Signals of another record under a law that was fitted to the force of one, nothing fitted again. A
/// channel that the law depends on and that the other record does not have counts as at its reference.
///
/// A fit of the position ([`SimulationFit`](crate::SimulationFit)) has no linear terms to predict a force
/// from; [`simulate_unseen`](crate::simulate_unseen) simulates another recording with it:
///
/// ```compile_fail,E0308
/// use stiction_identify::{Record, SimulationFit, predict};
///
/// fn force(record: &Record, simulated: &SimulationFit) {
///     predict(record, &simulated.fitted);
/// }
/// ```
pub fn predict(record: &Record, fitted: &Estimate) -> Series {
    let objective = Objective::new(record, fitted.law, &fitted.terms);
    let columns = objective.columns_at(&fitted.p);
    series(&objective, &fitted.p, &fitted.coefficients, &columns)
}

/// Friction of an identified law along a record, and how it changes with the law.
#[derive(Clone, Debug, Default)]
pub struct FrictionAlong {
    /// At the samples that count, without a constant force, N or N m.
    pub force: Vec<f64>,
    /// Its derivatives at these samples by what the law was fitted with, nonlinear unknowns, then linear ones.
    pub slopes: Vec<Vec<f64>>,
}

/// The friction of a law that was fitted to the force of one record along a record, nothing fitted again.
pub fn friction_along(record: &Record, fitted: &Estimate) -> FrictionAlong {
    let objective = Objective::new(record, fitted.law, &fitted.terms);
    let (columns, mut slopes) = objective.linearised(&fitted.p, &fitted.coefficients);
    let mut force = vec![0.0; objective.force().len()];
    let parts = columns.iter().zip(&fitted.coefficients);
    for (term, (column, c)) in objective.linear().iter().zip(parts) {
        if is_friction(term.column) {
            for (y, x) in force.iter_mut().zip(column.iter()) {
                *y += c * x;
            }
            slopes.push(column.to_vec());
        }
    }
    FrictionAlong { force, slopes }
}

/// Whether the friction of a law that was fitted to a record outweighs the inertia, at the samples that count. Of a joint whose rigid body
/// acts from outside the armature alone says nothing of the inertia: there it counts as outweighed.
pub(crate) fn outweighs_inertia(record: &Record, fitted: &Estimate) -> Vec<bool> {
    let mut segments = record.segments.iter();
    if segments.any(|segment| !segment.channels.external.is_empty()) {
        return vec![true; record.kept()];
    }
    let objective = Objective::new(record, fitted.law, &fitted.terms);
    let n = objective.force().len();
    let mut inertia = objective.inertia(&fitted.p);
    inertia.resize(n, 0.0);
    let mut friction = vec![0.0; n];
    let columns = objective.columns_at(&fitted.p);
    let parts = columns.iter().zip(&fitted.coefficients);
    for (term, (column, c)) in objective.linear().iter().zip(parts) {
        let sum = match term.column {
            ColumnKind::Acceleration => &mut inertia,
            own if is_friction(own) => &mut friction,
            _ => continue,
        };
        sum.iter_mut()
            .zip(column.iter())
            .for_each(|(y, x)| *y += c * x);
    }
    let both = friction.iter().zip(&inertia);
    both.map(|(f, i)| f.abs() > i.abs()).collect()
}

/// Whether a term of the force is friction: not inertia, weight or an offset.
fn is_friction(column: ColumnKind) -> bool {
    matches!(
        column,
        ColumnKind::Level
            | ColumnKind::Element(_)
            | ColumnKind::Sign(_)
            | ColumnKind::Rate
            | ColumnKind::Speed(_)
            | ColumnKind::Square(_)
            | ColumnKind::LevelTimes(..)
            | ColumnKind::RateTimes(_)
            | ColumnKind::SpeedTimes(..)
    )
}

/// The value that each parameter which may be zero is compared with: the largest Coulomb level, for a
/// coefficient divided by the span of its column in use; the sample time for a delay.
fn levels(objective: &Objective, raw: &[Physical]) -> Vec<f64> {
    let coulomb = raw
        .iter()
        .filter(|p| p.name.quantity == Quantity::Coulomb)
        .map(|p| p.value.abs())
        .fold(0.0, f64::max);
    let spans = objective.spans();
    raw.iter()
        .map(|p| match (p.name.dimension(), p.linear) {
            (Dimension::Time, _) => objective.record().step(),
            (_, Some(j)) => coulomb / spans[j],
            (_, None) => coulomb,
        })
        .collect()
}

/// Signals of a record, from the columns of the regression there.
fn series(objective: &Objective, p: &[f64], coefficients: &[f64], columns: &[Column]) -> Series {
    let record = objective.record();
    let n = objective.force().len();
    let mut other = objective.inertia(p);
    other.resize(n, 0.0);
    let mut model = other.clone();
    let parts = columns.iter().zip(coefficients);
    for (term, (column, c)) in objective.linear().iter().zip(parts) {
        for (y, x) in model.iter_mut().zip(column.iter()) {
            *y += c * x;
        }
        if !is_friction(term.column) {
            for (y, x) in other.iter_mut().zip(column.iter()) {
                *y += c * x;
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
