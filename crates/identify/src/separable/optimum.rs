//! What a separable search finds.

use crate::conditioning::settling;
use crate::gms::score::ElementsScore;
use crate::law::Law;
use crate::separable::objective::Evaluation;
use crate::separable::search_box::SearchBox;
use crate::separable::secant::Secant;
use stiction_search::{Counts, Status};

/// What a search found.
#[derive(Clone, Debug)]
pub struct Optimum {
    /// The law that was fitted, with the number of its elements.
    pub law: Law,
    /// Nonlinear unknowns (logarithms, in the order of the law).
    pub p: Vec<f64>,
    /// The box that was searched.
    pub bounds: SearchBox,
    /// How it ended.
    pub status: Status,
    /// Evaluations by kind.
    pub counts: Counts,
    /// Steps of all descents.
    pub iterations: usize,
    /// Evaluations and best `rms(residual)/rms(measured)` until then, over the last descent.
    pub history: Vec<(usize, f64)>,
    /// Whether the last nonlinear unknown is the delay.
    pub(crate) delay: bool,
    /// The numbers of elements that were tried for a Maxwell-slip law; empty where it was given.
    pub elements: Vec<ElementsScore>,
    /// What the last descent learnt of the curvature.
    pub(crate) secant: Secant,
    /// The evaluation at the optimum, with sensitivities.
    pub evaluation: Evaluation,
}

impl Optimum {
    /// Where a descent of another law may start from here, for [`fit_law_from`](crate::fit_law_from): the values of the
    /// unknowns that both laws have, those of both directions for each where only the other law is asymmetric, and the
    /// delay. An unknown that this law lacks starts at 0, which a descent moves to the nearest end of its range.
    pub fn start_for(&self, law: &Law) -> Vec<f64> {
        let (own, other) = (self.law.layout(), law.layout());
        let mut start = vec![0.0; other.count];
        let shared = [
            (other.kappa, own.kappa),
            (other.excess[0], own.excess[0]),
            (other.velocity[0], own.velocity[0]),
            (other.ratio, own.ratio),
            (other.excess[1], own.excess[1]),
            (other.velocity[1], own.velocity[1]),
            (other.breakaway, own.breakaway),
            (other.exponent, own.exponent),
        ];
        for (to, from) in shared {
            if let (Some(to), Some(from)) = (to, from) {
                start[to] = self.p[from];
            }
        }
        if self.delay {
            start.extend(self.p.last());
        }
        start
    }

    /// Where descents of a richer law may start from here, whose own search ended at `other`: the unknowns that both have as they
    /// are here, the rest as they are there, and in the middle of their ranges.
    pub fn starts_within(&self, other: &Optimum) -> [Vec<f64>; 2] {
        let (own, law) = (self.law.layout(), other.law.layout());
        let known = self.start_for(&other.law);
        let lacks = |i: usize| {
            let pairs = [
                (law.excess[0], own.excess[0]),
                (law.velocity[0], own.velocity[0]),
                (law.excess[1], own.excess[1]),
                (law.velocity[1], own.velocity[1]),
            ];
            pairs.contains(&(Some(i), None))
        };
        let with = |value: &dyn Fn(usize) -> f64| {
            let each = known.iter().enumerate();
            each.map(|(i, &x)| if lacks(i) { value(i) } else { x })
                .collect()
        };
        let middle = |i: usize| 0.5 * (other.bounds.low(i) + other.bounds.high(i));
        [with(&|i| other.p[i]), with(&middle)]
    }

    /// The distance that the axis must slide until its friction no longer depends on how its bristles were deflected before,
    /// m or rad; 0 for a law without bristles, and for one of several elements.
    pub(crate) fn settling(&self) -> f64 {
        let layout = self.law.layout();
        let Some(kappa) = layout.kappa else {
            return 0.0;
        };
        let level = |i: usize| 1.0 + libm::exp(self.p[i]);
        let levels = layout.excess.into_iter().flatten().map(level);
        settling::distance(levels.fold(1.0, f64::max) * libm::exp(-self.p[kappa]))
    }

    /// Whether the delay was fitted and stands at the bound of its range.
    pub fn delay_at_bound(&self) -> bool {
        let last = self.p.len().checked_sub(1);
        self.delay && last.is_some_and(|i| self.bounds.at_bound(&self.p, i))
    }
}
