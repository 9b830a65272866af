//! From linear intervals to those that a result states: with what the conditioning shifts, and what another motion changes.

use crate::conditioning::record::Record;
use crate::estimate::conditioned::shift;
use crate::estimate::delayed::of_jumps;
use crate::estimate::filtered::flag_what_a_filter_hides;
use crate::estimate::informed::{flag_what_an_end_holds, flag_what_says_no_more_than_before};
use crate::estimate::sliding::{self, flag_what_the_motion_hides};
use crate::estimate::{Estimate, advice, levels, optimal, pressed, uncertainty};
use crate::held_delay;
use crate::lag;
use crate::law::physical::physical;
use crate::law::transmitted::flag_parts_of_an_open_weight;
use crate::misfit::{Cause, Divisions, Misfit, dynamics};
use crate::parameter::physical::Physical;
use crate::parameter::{Added, NORMAL_Q95};
use crate::scatter::Variances;
use crate::separable::logs::Logs;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::state_space::{self, Counts, Known};
use crate::watch::Watch;
use stiction_parameters::Quantity;
use stiction_search::{Observer, Stage};

/// Least half width of a 95 % interval, in parts of the value. Long logs average noise down to less, but not what a fit leaves
/// of second order: noise of an encoder in the regressors, the force between two samples, how roughly filters are undone. Of 160
/// logs of another simulator, narrower intervals were wrong by up to this, eight of their half widths.
pub const LEAST_HALF_WIDTH: f64 = 5e-4;

/// States the intervals of an estimate in full: counts what encoder steps, filters and derivatives shift, what logs have
/// differently, and what another motion changes.
///
/// Costs some 60 evaluations where the motion comes from a position; they are added to the counts of the estimate.
pub fn intervals(
    record: &Record,
    optimum: &Optimum,
    estimate: &mut Estimate,
    observer: &mut dyn Observer,
) {
    let objective = Objective::new(record, estimate.law, &estimate.terms);
    let c = &optimum.evaluation.solution.coefficients;
    let raw = physical(
        &estimate.law,
        objective.linear(),
        record.step(),
        &optimum.p,
        c,
    );
    let before = state_space::rests_much(record).then(|| estimate.clone());
    let more = of_the_force(&objective, optimum, &raw, estimate, observer);
    // Counts say more than the force of the one axis that the law describes; of another they are as wrong, and surer. A shape that
    // is not that of the law may be what filters make of rests, which the counts then tell.
    let cause = estimate.misfit.as_ref().and_then(Misfit::cause);
    match before {
        Some(_) if !estimate.disagreements.is_empty() => {
            state_space::flag_what_rests_spoil(estimate, "are not those of one axis")
        }
        Some(_) if estimate.law.kind.has_elements() => {
            state_space::flag_what_rests_spoil(estimate, "are simulated for LuGre alone")
        }
        Some(before) if matches!(cause, None | Some(Cause::Shape)) => {
            of_the_counts(record, before, &more, estimate, observer);
        }
        _ => {}
    }
    let fitted = &mut estimate.fitted;
    flag_what_the_motion_hides(record, &mut fitted.parameters);
    sliding::flag_yields_of_open_elements(&mut fitted.parameters);
    flag_parts_of_an_open_weight(&fitted.terms, &mut fitted.parameters);
    advice::explain(&mut fitted.parameters, &fitted.covariance);
}

/// Asks the counts of an axis that rests: states what they say, starting from the estimate `before` its intervals, or flags
/// what they doubt.
fn of_the_counts(
    record: &Record,
    mut before: Estimate,
    more: &Added,
    estimate: &mut Estimate,
    observer: &mut dyn Observer,
) {
    let mut watch = Watch::new(observer, Stage::Counts);
    let known = Known {
        more,
        delay: estimate.parameter(Quantity::Delay),
    };
    let counts = state_space::ask(record, &mut before, &known, &mut watch);
    estimate.fitted.counts.add(&watch.counts);
    let lags = estimate.lag_samples() > 0.0 || estimate.terms.low_pass_undone;
    let unexplained = |estimate: &mut Estimate| {
        let why = match estimate.terms.low_pass_undone {
            true => "are those of a force whose low-pass was undone",
            false => "are those of a force that lags behind the logged one",
        };
        state_space::flag_what_rests_spoil(estimate, why);
    };
    let misfit = estimate.fitted.misfit.as_ref();
    let other_shape = misfit.is_some_and(|misfit| misfit.cause().is_some());
    match counts {
        Counts::Stated => {
            for p in &mut before.fitted.parameters {
                if let Some(own) = estimate.parameter(p.name) {
                    p.scatter_as(own);
                    let variance = p.std.map_or(f64::NAN, |std| std * std);
                    before.fitted.covariance.widen(p.name, variance);
                }
            }
            let misfit = estimate.fitted.misfit.take();
            before.fitted.misfit = misfit.filter(|_| !other_shape);
            before.fitted.counts = estimate.fitted.counts;
            *estimate = before;
            estimate.fitted.of_the_counts = true;
        }
        // What a fit of another shape is worth is known already.
        _ if other_shape => {}
        Counts::Doubted(doubted) => {
            doubted.flag(estimate);
            estimate.fitted.likelier_exponent = doubted.exponent();
            if doubted.is_hopeless() && lags {
                unexplained(estimate);
            }
        }
        Counts::Unexplained if lags => unexplained(estimate),
        Counts::Unexplained | Counts::NotAsked => {}
    }
}

/// The intervals of a fit of the force; gives what logs and a lag of the force add to them.
fn of_the_force(
    objective: &Objective,
    optimum: &Optimum,
    raw: &[Physical],
    estimate: &mut Estimate,
    observer: &mut dyn Observer,
) -> Added {
    estimate.unknowns = uncertainty::with_transfer(objective, &optimum.evaluation);
    let more = conditioned(objective, optimum, raw, estimate, observer);
    flag_what_a_filter_hides(objective.record(), estimate);
    let fitted = &mut estimate.fitted;
    let parameters = &mut fitted.parameters;
    flag_what_says_no_more_than_before(&estimate.unknowns, raw, parameters);
    flag_what_an_end_holds(optimum, &estimate.unknowns, raw, parameters);
    more
}

/// Counts what the conditioning shifts, what the law leaves systematically, and by how much logs differ; gives the last of these
/// with what is open of a lag of the force.
fn conditioned(
    objective: &Objective,
    optimum: &Optimum,
    raw: &[Physical],
    estimate: &mut Estimate,
    observer: &mut dyn Observer,
) -> Added {
    let mut watch = Watch::new(observer, Stage::Calibration);
    let at = &optimum.evaluation;
    let logs = Logs::of(objective.record());
    let divisions = Divisions::of(objective, at, &optimum.p);
    let shift = shift(objective.record(), estimate, raw, logs.as_ref(), &mut watch);
    estimate.fitted.counts.add(&watch.counts);
    let (energies, squares, replicas) = match &shift {
        Some(shift) => (&shift.energies[..], &shift.squares[..], &shift.told[..]),
        None => (&[][..], &[][..], &[][..]),
    };
    // Levels that logs have differently are no misfit of the law; they are counted beside it.
    let within = logs.as_ref().and_then(|logs| logs.within(at));
    let left = within.as_deref().unwrap_or(at.residual());
    let misfit = divisions.misfit(left, energies);
    let fit = (at, &optimum.p[..]);
    let misfit = divisions.waved(misfit, objective, &estimate.terms, at, left);
    let misfit = divisions.coupled(misfit, objective, &estimate.terms, fit, left);
    let misfit = divisions.clocked(misfit, objective, at, left);
    let dynamics = dynamics::sought(objective, fit, left, squares);
    let misfit = divisions.dynamic(misfit, dynamics, left);
    let misfit = divisions.limited(misfit, (objective, &estimate.terms), at, left);
    let misfit = divisions.held(misfit, (objective, &estimate.terms), at, &optimum.p);
    let misfit = divisions.swung(misfit, objective, at, left);
    estimate.fitted.misfit = misfit;
    let pressed = pressed::spread(objective, at, raw, estimate.unknowns.at_once());
    let jumps = of_jumps(objective.record(), &estimate.fitted.law);
    let strokes: Vec<Variances> = raw.iter().map(|p| estimate.unknowns.of(p)).collect();
    let known: Vec<f64> = (0..raw.len())
        .map(|i| {
            let jumps = match raw[i].name.quantity {
                Quantity::Delay => jumps,
                _ => 0.0,
            };
            let own = strokes[i].at_once;
            let least = LEAST_HALF_WIDTH * raw[i].value / NORMAL_Q95;
            let total = shift.as_ref().map_or(own, |s| s.total(i, own));
            total + pressed.as_ref().map_or(0.0, |s| s[i]) + jumps + least * least
        })
        .collect();
    if let Some(logs) = logs
        && let Some(own) = logs.told(objective, &optimum.p, at)
    {
        let optimum = (objective, &optimum.p[..], at);
        estimate.fitted.disagreements = logs.disagreements(optimum, &own, replicas);
    }
    if let Some(misfit) = &mut estimate.fitted.misfit
        && !estimate.fitted.disagreements.is_empty()
    {
        // A spring or a gap is told from what one and the same axis leaves.
        misfit.coupling = None;
    }
    let mut more = Added::default();
    // Counts are read behind the same lag.
    if let Some(unknowns) = lag::spread(objective, estimate.terms.lag, &optimum.p, at) {
        for p in raw {
            more.add(p.name, p.variance(&unknowns));
        }
    }
    let bread = &estimate.unknowns.bread;
    if let Some(unknowns) = held_delay::spread(objective, &estimate.terms, &optimum.p, at, bread) {
        for p in raw {
            more.add(p.name, p.variance(&unknowns));
        }
    }
    let levels = levels(objective, raw);
    let covariance = &mut estimate.fitted.covariance;
    for (i, p) in raw.iter().enumerate() {
        let variances = strokes[i].and(known[i] - strokes[i].at_once + more.variance(p.name));
        covariance.widen(p.name, variances.repeat);
        let own = estimate
            .fitted
            .parameters
            .iter_mut()
            .find(|own| own.name == p.name);
        if let Some(own) = own {
            let bias = shift.as_ref().map(|shift| shift.bias[i]);
            *own = optimal::fitted(p, variances, bias, optimum, levels[i]);
        }
    }
    more
}
