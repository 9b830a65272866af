//! Intervals from the cost along one parameter, all others fitted again at each of its values.
//!
//! A linear interval assumes that the cost around the optimum is a parabola. Where a parameter is poorly
//! known the cost rises steeply on one side and slowly on the other, or not at all: the profile follows
//! it (Venzon and Moolgavkar 1988, doi 10.2307/2347496; Raue et al. 2009, doi 10.1093/bioinformatics/btp358).
//! The end of the interval is where the cost has risen by what the long-run noise makes of one standard deviation,
//! squared times the quantile.

use crate::parameter::WIDEST_INTERVAL;
use crate::separable::descent::{Descent, descend_as, settings};
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::watch::Watch;
use stiction_search::descent::Settings;

/// Trial values to each side, at most.
const MOST_TRIALS: usize = 6;
/// Steps of each descent; it starts where the last one ended.
const DESCENT_STEPS: usize = 6;
/// Allowed relative error of the square root of the rise at an end: the end is then accurate to 2 % of
/// the width.
const RISE_TOLERANCE: f64 = 0.02;
/// Predicted gain, as a part of the rise that is looked for, that no longer matters: it moves the square root of the rise by
/// a twentieth of its tolerance.
const NO_GAIN: f64 = 0.1 * RISE_TOLERANCE;
/// Step of a logarithm up to which such a gain is believed without a trial.
const TRUSTED_STEP: f64 = 0.1;

/// What is held at a value while all else is fitted.
#[derive(Clone, Copy, Debug)]
pub(super) enum Held {
    /// A nonlinear unknown, by its place.
    Nonlinear(usize),
    /// A coefficient that is not negative, by its place.
    Linear(usize),
}

/// One end of an interval.
#[derive(Clone, Debug)]
pub(super) enum End {
    /// Unknowns and coefficients there.
    At(Vec<f64>, Vec<f64>),
    /// The cost does not rise that far inside the search range.
    Open,
}

/// The profile of one unknown.
pub(super) struct Profile<'a> {
    pub objective: &'a Objective<'a>,
    pub optimum: &'a Optimum,
    pub held: Held,
    /// Standard deviation of the unknown (of the logarithm of a nonlinear one).
    pub std: f64,
    /// Rise of the cost at one standard deviation where the cost is a parabola.
    pub rise: f64,
    /// Wanted end, standard deviations.
    pub quantile: f64,
}

impl Profile<'_> {
    /// The lower and the upper end; `None` where the descents do not reach them or are stopped.
    pub fn ends(&self, watch: &mut Watch) -> Option<[End; 2]> {
        if !(self.std > 0.0 && self.rise > 0.0 && self.rise.is_finite()) {
            return None;
        }
        Some([self.end(-1.0, watch)?, self.end(1.0, watch)?])
    }

    /// Value of the unknown at the optimum, and the furthest it may go to one side.
    fn range(&self, side: f64) -> (f64, f64) {
        match self.held {
            Held::Nonlinear(i) => {
                let bounds = &self.optimum.bounds;
                let at = self.optimum.p[i];
                let far = if side < 0.0 {
                    bounds.low(i).max(at - WIDEST_INTERVAL)
                } else {
                    bounds.high(i).min(at + WIDEST_INTERVAL)
                };
                (at, far)
            }
            Held::Linear(j) => {
                let at = self.optimum.evaluation.solution.coefficients[j];
                let far = if side < 0.0 {
                    0.0
                } else {
                    at * libm::exp(WIDEST_INTERVAL)
                };
                (at, far)
            }
        }
    }

    fn end(&self, side: f64, watch: &mut Watch) -> Option<End> {
        let (at, far) = self.range(side);
        let reach = (far - at).abs();
        let tolerance = 1e-9 * self.std;
        if reach <= tolerance {
            return Some(End::Open);
        }
        let mut start = self.optimum.p.clone();
        let (mut inner, mut outer) = ((0.0, 0.0), None::<(f64, f64)>);
        let mut distance = (self.quantile * self.std).min(reach);
        for _ in 0..MOST_TRIALS {
            let value = at + side * distance;
            let found = fit_with(
                self.objective,
                self.optimum,
                (self.held, value),
                &start,
                self.quantile * self.quantile * self.rise,
                watch,
            );
            if watch.stopped {
                return None;
            }
            let risen = found.evaluation.cost - self.optimum.evaluation.cost;
            if !risen.is_finite() {
                return None;
            }
            let deviations = (risen.max(0.0) / self.rise).sqrt();
            start.clone_from(&found.p);
            if (deviations / self.quantile - 1.0).abs() <= RISE_TOLERANCE {
                return Some(End::At(found.p, found.evaluation.solution.coefficients));
            }
            if deviations < self.quantile {
                if distance >= reach - tolerance {
                    return Some(End::Open);
                }
                inner = (distance, deviations);
            } else {
                outer = Some((distance, deviations));
            }
            distance = match outer {
                // The square root of the rise is nearly linear in the unknown.
                Some(outer) => {
                    let part = (self.quantile - inner.1) / (outer.1 - inner.1);
                    inner.0 + part * (outer.0 - inner.0)
                }
                None => {
                    let stretch = (self.quantile / deviations.max(1e-3)).clamp(1.1, 3.0);
                    (stretch * distance).min(reach)
                }
            };
        }
        None
    }
}

/// All others fitted with one held at a value, from the end of another such fit: as closely as the rise of the cost that
/// is looked for asks for.
pub(super) fn fit_with(
    objective: &Objective,
    optimum: &Optimum,
    (held, value): (Held, f64),
    start: &[f64],
    rise: f64,
    watch: &mut Watch,
) -> Descent {
    let bounds = &optimum.bounds;
    let no_gain = NO_GAIN * rise / optimum.evaluation.cost;
    let usual = settings(objective.energy(), DESCENT_STEPS);
    let settings = match no_gain.is_finite() {
        true => Settings {
            trusted_gain: no_gain,
            trusted_step: TRUSTED_STEP,
            ..usual
        },
        false => usual,
    };
    // The curvature that the fit of all has learnt is that of its neighbours.
    let secant = optimum.secant.clone();
    match held {
        Held::Nonlinear(i) => {
            let bounds = bounds.holding(i, value);
            descend_as(objective, &bounds, start, &settings, secant, watch)
        }
        Held::Linear(j) => {
            let objective = objective.holding(j, value);
            descend_as(&objective, bounds, start, &settings, secant, watch)
        }
    }
}
