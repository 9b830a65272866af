//! A law as a search found it, without the least squares that give it intervals.

use crate::conditioning::record::Record;
use crate::estimate::{Estimate, estimate};
use crate::law::terms::{Delay, Terms};
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use crate::procedure::StaticMap;
use crate::separable::linear;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::SearchBox;
use crate::separable::secant::Secant;
use stiction_parameters::{Name, Quantity, Side};
use stiction_search::Status;

/// Why a parameter that a search found by itself has no interval.
pub const NO_INTERVAL: &str = "as the search found it: without least squares it has no interval";

fn without_interval(parameter: &mut Parameter) {
    if !parameter.identified {
        return;
    }
    *parameter = Parameter {
        identified: true,
        identifiable: false,
        reason: NO_INTERVAL.into(),
        ..Parameter::given(parameter.name, parameter.value)
    };
}

fn nothing() -> Covariance {
    Covariance {
        names: Vec::new(),
        matrix: Vec::new(),
    }
}

impl Estimate {
    /// The same law on the same record with these nonlinear unknowns, in the order of the law, and these coefficients;
    /// coefficients that are not named are solved for. A delay that is to be fitted is left out, as searches leave it out.
    ///
    /// # Errors
    /// As [`separable`](crate::separable()): a record without motion.
    pub fn as_searched(
        &self,
        record: &Record,
        unknowns: &[f64],
        named: &[(Name, f64)],
    ) -> Result<Self, crate::Error> {
        let bounds = SearchBox::from_record(record, &self.law)?;
        let terms = &match self.terms.delay {
            Delay::Fitted => Terms {
                delay: Delay::NONE,
                ..self.terms.clone()
            },
            Delay::Given(_) => self.terms.clone(),
        };
        let objective = Objective::new(record, self.law, terms);
        let p = unknowns.to_vec();
        let columns = objective.columns_at(&p);
        let value = |name: Name| named.iter().find(|(n, _)| *n == name).map(|(_, x)| *x);
        let given: Vec<Option<f64>> = (objective.linear().iter())
            .map(|term| value(term.name))
            .collect();
        let mut target = objective.target_at(&p).into_owned();
        for (column, c) in columns.iter().zip(&given) {
            for (t, x) in target.iter_mut().zip(column.iter()) {
                *t -= c.unwrap_or(0.0) * x;
            }
        }
        let free: Vec<usize> = (0..given.len()).filter(|&i| given[i].is_none()).collect();
        let views: Vec<&[f64]> = free.iter().map(|&i| columns[i].as_slice()).collect();
        let nonnegative: Vec<bool> = free.iter().map(|&i| objective.nonnegative()[i]).collect();
        let solved = linear::solve(&views, &nonnegative, &target);
        let mut c: Vec<f64> = given.iter().map(|x| x.unwrap_or(0.0)).collect();
        for (&i, x) in free.iter().zip(&solved.coefficients) {
            c[i] = *x;
        }
        let mut evaluation = objective.evaluate(&p, false);
        evaluation.cost = solved.cost;
        evaluation.solution.residual = solved.residual;
        evaluation.solution.coefficients = c;
        let optimum = Optimum {
            law: self.law,
            elements: Vec::new(),
            p,
            bounds,
            status: Status::Converged,
            counts: self.counts,
            iterations: self.iterations,
            history: Vec::new(),
            delay: false,
            secant: Secant::default(),
            evaluation,
        };
        let mut out = estimate(record, self.law, terms, &optimum, self.low_speed_bound);
        out.fitted.parameters.iter_mut().for_each(without_interval);
        out.fitted.covariance = nothing();
        Ok(out)
    }
}

impl StaticMap {
    /// The map with the curve that a search found; a constant force is the mean of what the curve leaves.
    #[must_use]
    pub fn as_searched(&self, values: &[(Name, f64)]) -> Self {
        let mut out = self.clone();
        for parameter in &mut out.parameters {
            if let Some((_, value)) = values.iter().find(|(name, _)| *name == parameter.name) {
                parameter.value = *value;
            }
            without_interval(parameter);
        }
        let curve = |v: f64| {
            let of = |quantity| {
                let side = match self.settings.asymmetric {
                    true if v < 0.0 => Side::Negative,
                    _ => Side::Positive,
                };
                let side = if self.settings.asymmetric {
                    side
                } else {
                    Side::Both
                };
                out.value(Name::new(quantity, side)).unwrap_or(0.0)
            };
            let (coulomb, fixed) = (of(Quantity::Coulomb), of(Quantity::Static));
            let ratio = v.abs() / of(Quantity::StribeckVelocity);
            let fall = libm::exp(-libm::pow(ratio, out.exponent()));
            v.signum() * (coulomb + (fixed - coulomb) * fall) + of(Quantity::Sigma2) * v
        };
        let left = self.points.iter().map(|p| p.force - curve(p.velocity));
        let offset = match self.settings.offset {
            true => left.sum::<f64>() / self.points.len().max(1) as f64,
            false => 0.0,
        };
        let model = self.points.iter().map(|p| curve(p.velocity) + offset);
        out.model = model.collect();
        for parameter in &mut out.parameters {
            if parameter.name == Quantity::Offset {
                parameter.value = offset;
            }
        }
        out.covariance = nothing();
        out
    }
}
