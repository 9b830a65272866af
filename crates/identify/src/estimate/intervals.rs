//! From linear intervals to those that a result states: with what the conditioning shifts, and what another motion changes.

use crate::conditioning::record::Record;
use crate::effects::{self, Found};
use crate::estimate::conditioned::shift;
use crate::estimate::delayed::of_jumps;
use crate::estimate::filtered::flag_what_a_filter_hides;
use crate::estimate::informed::{flag_what_an_end_holds, flag_what_says_no_more_than_before};
use crate::estimate::sliding::{self, flag_what_the_motion_hides};
use crate::estimate::{Estimate, advice, levels, optimal, pressed, uncertainty};
use crate::held_delay;
use crate::known_force;
use crate::lag;
use crate::law::physical::physical;
use crate::law::transmitted::flag_parts_of_an_open_weight;
use crate::parameter::physical::Physical;
use crate::parameter::{Added, NORMAL_Q95};
use crate::scatter::Variances;
use crate::separable::logs::Logs;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::state_space::{self, Counts, Known};
use crate::watch::Watch;
use stiction_parameters::Quantity;
use stiction_policy::interval;
use stiction_search::{Observer, Stage};

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
    let other_force = estimate
        .effects
        .iter()
        .any(|found| !found.effect.is_a_shape());
    match before {
        Some(_) if !estimate.disagreements.is_empty() => {
            state_space::flag_what_rests_spoil(estimate, "are not those of one axis")
        }
        Some(_) if estimate.law.kind.has_elements() => {
            state_space::flag_what_rests_spoil(estimate, "are simulated for LuGre alone")
        }
        Some(before) if !other_force => {
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

/// What the residual of a fit shows, the largest first.
pub fn effects(record: &Record, optimum: &Optimum, estimate: &Estimate) -> Vec<Found> {
    let objective = Objective::new(record, estimate.law, &estimate.terms);
    let at = &optimum.evaluation;
    let logs = Logs::of(record);
    // Levels that logs have differently are no effect within them; they are counted beside it.
    let within = logs.as_ref().and_then(|logs| logs.within(at));
    let left = within.as_deref().unwrap_or(at.residual());
    effects::sought(&objective, &estimate.terms, (at, &optimum.p), left)
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
    let other_shape = !estimate.effects.is_empty();
    match counts {
        Counts::Stated => {
            for p in &mut before.fitted.parameters {
                if let Some(own) = estimate.parameter(p.name) {
                    p.scatter_as(own);
                    let variance = p.std.map_or(f64::NAN, |std| std * std);
                    before.fitted.covariance.widen(p.name, variance);
                }
            }
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
    let shows = effects(objective.record(), optimum, estimate);
    let asked = (logs.as_ref(), !shows.is_empty());
    let shift = shift(objective.record(), estimate, raw, asked, &mut watch);
    estimate.fitted.counts.add(&watch.counts);
    let by_conditioning = shift.as_ref().map_or(&[][..], |shift| &shift.effects);
    estimate.fitted.effects = effects::beyond(shows, by_conditioning);
    let replicas = shift.as_ref().map_or(&[][..], |shift| &shift.told);
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
            let least = interval::MIN_HALF_WIDTH * raw[i].value / NORMAL_Q95;
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
    if let Some(unknowns) = known_force::spread(objective, at, bread) {
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
