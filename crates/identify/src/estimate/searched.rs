//! A law as a search found it, without the least squares that give it intervals.

use crate::conditioning::record::Record;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::{Estimate, estimate};
use crate::law::terms::{Delay, Terms};
use crate::parameter::covariance::Covariance;
use crate::parameter::{IntervalKind, Parameter};
use crate::separable::linear;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::SearchBox;
use crate::separable::secant::Secant;
use stiction_parameters::Name;
use stiction_search::{Counts, Status};

/// Takes the interval off a parameter that a search found by itself, or that was found by the time a search was stopped: how far it is
/// from the optimum nothing says.
pub(crate) fn without_interval(parameter: &mut Parameter, stopped: bool) {
    if !parameter.identified {
        return;
    }
    let (interval, reason) = match stopped {
        true => (
            parameter.interval,
            "the run was stopped before its interval was known",
        ),
        false => (
            IntervalKind::Searched,
            "as the search found it: without least squares it has no interval",
        ),
    };
    *parameter = Parameter {
        identified: true,
        identifiable: false,
        interval,
        reason: reason.into(),
        ..Parameter::given(parameter.name, parameter.value)
    };
}

impl FittedLaw {
    /// Takes the intervals off all parameters that were fitted.
    fn leave_open(&mut self, stopped: bool) {
        for parameter in &mut self.parameters {
            without_interval(parameter, stopped);
        }
        self.covariance = Covariance::default();
    }

    /// The values that a stopped search has found so far, without intervals: those about another point than the optimum say nothing
    /// of how far it is.
    pub(crate) fn stopped(&mut self) {
        self.status = Status::Interrupted;
        self.leave_open(true);
    }
}

impl Estimate {
    /// The same law beside other linear terms, for [`as_searched`](Self::as_searched), which gives it numbers.
    #[must_use]
    pub fn beside(mut self, terms: Terms) -> Self {
        self.fitted.terms = terms;
        self.fitted.counts = Counts::default();
        self.fitted.iterations = 0;
        self
    }

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
        let mut terms = self.terms.clone();
        if terms.delay == Delay::Fitted {
            terms.delay = Delay::NONE;
        }
        let terms = &terms;
        let objective = Objective::new(record, self.law, terms);
        let columns = objective.columns_at(unknowns);
        let value = |name: Name| named.iter().find(|(n, _)| *n == name).map(|(_, x)| *x);
        let given: Vec<Option<f64>> = (objective.linear().iter())
            .map(|term| value(term.name))
            .collect();
        let mut target = objective.target_at(unknowns).into_owned();
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
        let mut evaluation = objective.evaluate(unknowns, false);
        evaluation.cost = solved.cost;
        evaluation.solution.residual = solved.residual;
        evaluation.solution.coefficients = c;
        let optimum = Optimum {
            law: self.law,
            elements: Vec::new(),
            p: unknowns.to_vec(),
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
        out.fitted.leave_open(false);
        Ok(out)
    }
}
