//! Whether the data show a Stribeck curve.
//!
//! Where no speed lies in the Stribeck range, a search still finds some curve that fits the noise a
//! little better than none, and the linear deviation there says how well *that* curve is known. The
//! question is whether the cost is really higher without it.

use crate::estimate::profile::{Held, fit_with};
use crate::estimate::uncertainty::Unknowns;
use crate::law::Law;
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::watch::Watch;
use stiction_parameters::{Name, Quantity, Side};

/// Standard deviation of ln(Fs/Fc - 1) below which the curve counts as present without a further test:
/// its rise is ten standard deviations away from zero.
const PLAIN_EXCESS_DEVIATION: f64 = 0.1;
/// Rise of the cost without the curve below which it may be noise, in squared standard deviations. The
/// two unknowns of a curve were searched for over decades, so chance lowers the cost more than for one
/// unknown at a known place: a rise of 12 occurs by chance less than once in a hundred times.
const CHANCE_RISE: f64 = 12.0;

/// For each direction (the same twice for a symmetric law) whether the cost is hardly higher with the
/// Stribeck velocity, or the excess of the static friction, at the lower end of its range.
pub(super) fn missing(
    objective: &Objective,
    optimum: &Optimum,
    unknowns: &Unknowns,
    watch: &mut Watch,
) -> [bool; 2] {
    let layout = objective.law().layout();
    let mut of_side = |side: usize| {
        let (Some(e), Some(v)) = (layout.excess[side], layout.velocity[side]) else {
            return false;
        };
        let variance = unknowns.covariance[(e, e)];
        let rise = variance / unknowns.bread[(e, e)];
        // A rise that is not finite belongs to an unknown that is flagged already.
        if variance.sqrt() < PLAIN_EXCESS_DEVIATION || !rise.is_finite() {
            return false;
        }
        [v, e].into_iter().any(|i| {
            let low = optimum.bounds.low(i);
            let found = fit_with(
                objective,
                optimum,
                (Held::Nonlinear(i), low),
                &optimum.p,
                CHANCE_RISE * rise,
                watch,
            );
            found.evaluation.cost - optimum.evaluation.cost < CHANCE_RISE * rise
        })
    };
    let first = of_side(0);
    let second = if layout.excess[0] == layout.excess[1] {
        first
    } else {
        of_side(1)
    };
    [first, second]
}

/// Flags static friction that may be Coulomb friction, where the Stribeck velocity is open: the motion shows no rise towards zero
/// speed, and says nothing of one at speeds that it does not dwell at.
pub(super) fn rises_unseen(law: &Law, parameters: &mut [Parameter]) {
    for &side in Side::all(law.asymmetric) {
        let of = |quantity| {
            let name = Name::new(quantity, side);
            parameters.iter().position(|p| p.name == name)
        };
        let (Some(most), Some(level), Some(velocity)) = (
            of(Quantity::Static),
            of(Quantity::Coulomb),
            of(Quantity::StribeckVelocity),
        ) else {
            continue;
        };
        let open = |at: usize| parameters[at].identified && !parameters[at].identifiable;
        let low = parameters[most].ci95.map(|(low, _)| low);
        let seen = low.is_some_and(|low| low > parameters[level].value);
        if open(velocity) && parameters[most].identifiable && !seen {
            let p = &mut parameters[most];
            p.identifiable = false;
            p.reason =
                "no rise above Coulomb friction is seen; one at lower speeds would not show here"
                    .into();
        }
    }
}

/// Correlation of a static friction with its Stribeck velocity from which it is known only as well: at .95 its deviation is three
/// times what it would be at a known velocity.
const GOES_ALONG: f64 = 0.95;

/// Flags the static friction of a direction whose Stribeck velocity is open, where it goes along with that velocity: of a curve that
/// shows its foot alone, neither a width that is hardly known nor an end that is extrapolated with it has an interval about the
/// best fit. And where something else than the law is left of the force (`doubted`): a curve of another width ends at another
/// static friction.
pub(super) fn end_of_an_open_curve(
    law: &Law,
    covariance: &Covariance,
    doubted: bool,
    parameters: &mut [Parameter],
) {
    let correlation = covariance.correlation();
    for &side in Side::all(law.asymmetric) {
        let width = Name::new(Quantity::StribeckVelocity, side);
        let end = Name::new(Quantity::Static, side);
        let open = |p: &Parameter| p.name == width && p.identified && !p.identifiable;
        if !parameters.iter().any(open) {
            continue;
        }
        let both = covariance.place(width).zip(covariance.place(end));
        let along = both.is_some_and(|(width, end)| correlation[width][end].abs() >= GOES_ALONG);
        let reason = match (doubted, along) {
            (true, _) => {
                "is where a curve ends whose Stribeck velocity is open, in a log that the law does not explain alone"
            }
            (false, true) => {
                "is where a curve ends of which the motion shows the foot alone: it moves together with the Stribeck velocity, which is open"
            }
            (false, false) => continue,
        };
        for p in parameters.iter_mut().filter(|p| p.name == end) {
            if p.identified && p.identifiable {
                p.identifiable = false;
                p.reason = reason.into();
            }
        }
    }
}

/// Top speed over the Stribeck velocity below which the Coulomb level is not seen: at twice the Stribeck velocity of a Gaussian
/// curve a fiftieth of the rise is left.
const BEYOND: f64 = 2.0;

/// Flags the Coulomb level and the viscous friction of a direction whose Stribeck velocity lies at the
/// top speed: the motion stays inside the Stribeck range, so neither is ever seen separately.
pub(super) fn stays_within(law: &Law, optimum: &Optimum, parameters: &mut [Parameter]) {
    let layout = law.layout();
    for side in 0..2 {
        let Some(i) = layout.velocity[side] else {
            continue;
        };
        let (low, high) = (optimum.bounds.low(i), optimum.bounds.high(i));
        if !(optimum.bounds.at_bound(&optimum.p, i) && optimum.p[i] > 0.5 * (low + high)) {
            continue;
        }
        let Some(&direction) = Side::all(law.asymmetric).get(side) else {
            continue;
        };
        let names = [Quantity::Coulomb, Quantity::Sigma2].map(|q| Name::new(q, direction));
        for p in parameters.iter_mut().filter(|p| names.contains(&p.name)) {
            if p.identifiable {
                p.identifiable = false;
                p.reason = "the motion is not faster than the Stribeck velocity".into();
            }
        }
    }
}

/// Flags the curve beyond standstill of a direction whose Stribeck velocity lies near the top speed: friction beyond the rise is not seen,
/// and a rise over the whole range of speeds may be another effect, such as backlash.
pub(super) fn spans_all_speeds(law: &Law, top_speed: f64, parameters: &mut [Parameter]) {
    for &side in Side::all(law.asymmetric) {
        let name = Name::new(Quantity::StribeckVelocity, side);
        let near = parameters
            .iter()
            .any(|p| p.name == name && p.identified && BEYOND * p.value > top_speed);
        let curve = [
            Quantity::Coulomb,
            Quantity::StribeckVelocity,
            Quantity::Sigma2,
        ]
        .map(|quantity| Name::new(quantity, side));
        for p in parameters
            .iter_mut()
            .filter(|p| near && curve.contains(&p.name))
        {
            if p.identifiable {
                p.identifiable = false;
                p.reason = "the motion is not twice as fast as the Stribeck velocity: friction beyond the rise is not seen".into();
            }
        }
    }
}
