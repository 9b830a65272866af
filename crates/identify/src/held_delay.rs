//! A delay of the force that is held beside a law that no descent finds it for.
//!
//! Elements change between stick and slip at instants between samples, where the slope of their force by the delay jumps, so that
//! no descent finds it. The delay belongs to the log, not to friction: LuGre finds it on the same record, from where the elements
//! look for it along their cost ([`crate::gms::delay`]). What is open of it is counted in the intervals of what is fitted beside it.

use crate::estimate::Estimate;
use crate::known_force::moved;
use crate::law::terms::{Delay, DelayFrom, Terms};
use crate::law::{Law, LawKind};
use crate::parameter::physical::Physical;
use crate::parameter::{IntervalKind, Parameter};
use crate::scatter::Variances;
use crate::separable::objective::{Evaluation, Objective};
use nalgebra::DMatrix;
use stiction_parameters::Quantity;

impl Terms {
    /// Whether this law has to be told where to look for the delay that is asked for.
    pub fn asks_delay_of_another(&self, law: &Law) -> bool {
        self.delay == Delay::Fitted && law.kind.has_elements()
    }

    /// The same with the delay that the fit of another law has found; none where that found none.
    #[must_use]
    pub fn holding_delay_of(&self, other: &Estimate) -> Self {
        let own = other.parameter(Quantity::Delay);
        let (delay, deviation) = match (other.terms.delay, own) {
            (Delay::Fitted, Some(own)) => {
                // One that is not determined may be as wrong as a sample.
                let deviation = own.std.filter(|std| std.is_finite());
                (Delay::Given(own.value), deviation.unwrap_or(other.step))
            }
            (Delay::Fitted, None) => (Delay::NONE, 0.0),
            (known, _) => (known, other.terms.delay_deviation),
        };
        Self {
            delay,
            delay_deviation: deviation,
            delay_from: DelayFrom::OtherLaw(other.fit.rmse),
            ..self.clone()
        }
    }
}

impl Law {
    /// The law that finds the delay for one that cannot.
    #[must_use]
    pub fn that_finds_delay(self) -> Self {
        Self {
            kind: LawKind::LuGre,
            elements: 0,
            ..self
        }
    }
}

/// Covariance of the unknowns, nonlinear then linear, that comes of what is open of a delay that is held; `None` where nothing is.
/// `bread` is the inverse of `J^T J`.
///
/// To first order: with the delay one deviation earlier and later the model differs by a column, and the unknowns move against
/// it as in a Gauss-Newton step.
pub(crate) fn spread(
    objective: &Objective,
    terms: &Terms,
    p: &[f64],
    at: &Evaluation,
    bread: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let (Delay::Given(delay), deviation) = (terms.delay, terms.delay_deviation) else {
        return None;
    };
    if deviation.is_nan() || deviation <= 0.0 {
        return None;
    }
    let column = column(objective, terms, (p, at), delay, deviation);
    let moved = moved(at, bread, &column)?;
    let n = moved.len();
    Some(DMatrix::from_fn(n, n, |i, j| moved[i] * moved[j]))
}

/// Half of what the model has more with the delay, s, `by` later than `by` earlier, all else as it is.
pub(crate) fn column(
    objective: &Objective,
    terms: &Terms,
    (p, at): (&[f64], &Evaluation),
    delay: f64,
    by: f64,
) -> Vec<f64> {
    let c = &at.solution.coefficients;
    let model = |delay: f64| {
        let terms = Terms {
            delay: Delay::Given(delay),
            ..terms.clone()
        };
        let moved = Objective::new(objective.record(), *objective.law(), &terms);
        moved.model(p, c)
    };
    let [early, late] = [model(delay - by), model(delay + by)];
    let both = late.iter().zip(&early);
    both.map(|(b, a)| 0.5 * (b - a)).collect()
}

/// The delay that elements have found, as a parameter; `step` is the sample time, s.
pub(crate) fn parameter(terms: &Terms, step: f64) -> Option<Parameter> {
    let Delay::Given(value) = terms.delay else {
        return None;
    };
    let found = Physical {
        name: Quantity::Delay.into(),
        value,
        slope: Vec::new(),
        nonlinear: None,
        linear: None,
    };
    let variance = terms.delay_deviation * terms.delay_deviation;
    let parameter = Parameter::judged(
        &found,
        Variances::known(variance),
        None,
        String::new(),
        step,
    );
    (terms.delay_from == DelayFrom::Elements).then_some(Parameter {
        interval: IntervalKind::Profile,
        ..parameter
    })
}
