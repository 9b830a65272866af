//! From linear intervals to those that a result states: with what the conditioning shifts, and with
//! the profile where a parabola is not good enough.

use crate::agreement::Between;
use crate::conditioning::record::Record;
use crate::estimate::along::Along;
use crate::estimate::conditioned::shift;
use crate::estimate::confused::{
    flag_a_force_that_takes_a_long_wave, flag_a_force_that_takes_the_inertia,
    flag_levels_that_take_viscous_friction,
};
use crate::estimate::curve::{
    end_of_an_open_curve, missing, rises_unseen, spans_all_speeds, stays_within,
};
use crate::estimate::delayed::{flag_what_an_unknown_delay_takes_along, of_jumps};
use crate::estimate::filtered::flag_what_a_filter_hides;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::least::no_surer_than_any_log;
use crate::estimate::profile::{End, Held, Profile};
use crate::estimate::sliding::{self, flag_what_the_motion_hides};
use crate::estimate::unseen::flag_what_an_unseen_element_takes;
use crate::estimate::{Estimate, advice, levels, optimal, pressed, stated};
use crate::held_delay;
use crate::lag;
use crate::law::physical::physical;
use crate::law::transmitted::flag_parts_of_an_open_weight;
use crate::misfit::{Cause, Divisions, Misfit, dynamics};
use crate::parameter::physical::{Physical, propagate};
use crate::parameter::{IntervalKind, Parameter, quantile};
use crate::separable::logs::Logs;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::state_space::{self, Counts, Known};
use crate::watch::Watch;
use stiction_parameters::{Name, Quantity};
use stiction_search::{Observer, Stage};

/// Relative standard deviation from which the profile is followed. Below it the linear interval is
/// accurate: its relative error is of the size of this deviation.
const PROFILED_DEVIATION: f64 = 0.03;

/// States the intervals of an estimate in full: counts what encoder steps, filters and derivatives
/// shift, and replaces linear intervals of the Stribeck velocity and exponent, static friction and
/// micro-damping by those of the profile where they are poorly known.
///
/// Costs some 60 evaluations where the motion comes from a position, and some tens for each profile;
/// they are added to the counts of the estimate.
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
    let between = of_the_force(&objective, optimum, &raw, estimate, observer);
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
            of_the_counts(record, before, &between, estimate, observer);
        }
        _ => {}
    }
    let fitted = &mut estimate.fitted;
    no_surer_than_any_log(fitted);
    if let Some(swing) = fitted.misfit.as_ref().and_then(Misfit::swing) {
        reach_as_far_as(swing, &mut fitted.parameters);
    }
    flag_what_the_residual_doubts(fitted);
    flag_what_the_motion_hides(record, &mut fitted.parameters);
    flag_what_an_unseen_element_takes(record.resolution, &mut fitted.parameters);
    sliding::flag_yields_of_open_elements(&mut fitted.parameters);
    flag_parts_of_an_open_weight(&fitted.terms, &mut fitted.parameters);
    rises_unseen(&fitted.law, &mut fitted.parameters);
    spans_all_speeds(&fitted.law, record.top_speed(), &mut fitted.parameters);
    let at = &optimum.evaluation;
    flag_levels_that_take_viscous_friction(&objective, at, &raw, &mut fitted.parameters);
    flag_a_force_that_takes_the_inertia(record, &mut fitted.parameters);
    flag_a_force_that_takes_a_long_wave(record, &fitted.terms, &mut fitted.parameters);
    let doubted = fitted.misfit.as_ref().and_then(Misfit::cause).is_some();
    end_of_an_open_curve(
        &fitted.law,
        &fitted.covariance,
        doubted,
        &mut fitted.parameters,
    );
    advice::explain(&mut fitted.parameters, &fitted.covariance);
}

/// Asks the counts of an axis that rests: states what they say, starting from the estimate `before` its intervals, or flags
/// what they doubt.
fn of_the_counts(
    record: &Record,
    mut before: Estimate,
    between: &Between,
    estimate: &mut Estimate,
    observer: &mut dyn Observer,
) {
    let mut watch = Watch::new(observer, Stage::Counts);
    let known = Known {
        between,
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
) -> Between {
    let between = conditioned(objective, optimum, raw, estimate, observer);
    let mut watch = Watch::new(observer, Stage::Calibration);
    watch.fraction = 1.0;
    let missing = missing(objective, optimum, &estimate.unknowns, &mut watch);
    let mut along = Along::new(raw);
    for p in raw {
        if watch.stopped {
            break;
        }
        if curve_of(p.name).is_some_and(|side| missing[side]) {
            without_curve(estimate, p.name);
        } else {
            profiled(objective, optimum, p, estimate, (&mut along, &mut watch));
        }
    }
    along.reach(raw, optimum, &levels(objective, raw), estimate);
    estimate.fitted.counts.add(&watch.counts);
    flag_what_a_filter_hides(objective.record(), estimate);
    flag_what_an_unknown_delay_takes_along(objective.record(), estimate);
    let fitted = &mut estimate.fitted;
    stays_within(&fitted.law, optimum, &mut fitted.parameters);
    between
}

/// Counts what the conditioning shifts, what the law leaves systematically, and by how much logs differ; gives the last of these
/// with what is open of a lag of the force.
fn conditioned(
    objective: &Objective,
    optimum: &Optimum,
    raw: &[Physical],
    estimate: &mut Estimate,
    observer: &mut dyn Observer,
) -> Between {
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
    // Where another cause is named, it is what the dynamics come of.
    let cause = misfit.as_ref().and_then(Misfit::cause);
    let dynamics = dynamics.filter(|_| matches!(cause, None | Some(Cause::Dynamics)));
    let spread = misfit.as_ref().map(|misfit| {
        let unknowns = misfit.spread(&estimate.unknowns.bread, left.len());
        propagate(raw, &unknowns)
    });
    estimate.fitted.misfit = misfit;
    // What rests make of the force looks like dynamics; there the counts are asked.
    let dynamics = dynamics.filter(|_| !state_space::rests_much(objective.record()));
    let unit = objective.record().step().powi(4);
    let open = dynamics.map_or(0.0, |found| found.open() / unit);
    let open = lag::beside_a_square(objective, open, &optimum.p, at);
    let pressed = pressed::spread(objective, at, raw, &estimate.unknowns.covariance);
    let stated = &estimate.fitted.covariance.matrix;
    let jumps = of_jumps(objective.record(), &estimate.fitted.law);
    let known: Vec<f64> = (0..raw.len())
        .map(|i| {
            let jumps = match raw[i].name.quantity {
                Quantity::Delay => jumps,
                _ => 0.0,
            };
            let total = shift
                .as_ref()
                .map_or(stated[i][i], |s| s.total(i, stated[i][i]));
            total
                + spread.as_ref().map_or(0.0, |s| s[(i, i)])
                + open.as_ref().map_or(0.0, |s| raw[i].variance(s))
                + pressed.as_ref().map_or(0.0, |s| s[i])
                + jumps
        })
        .collect();
    let mut between = Between::default();
    if let Some(logs) = logs
        && let Some(own) = logs.told(objective, &optimum.p, at, &estimate.unknowns.bread)
    {
        between = own.between(raw, replicas, &known);
        let optimum = (objective, &optimum.p[..], at);
        estimate.fitted.disagreements = logs.disagreements(optimum, &own, replicas);
    }
    if let Some(misfit) = &mut estimate.fitted.misfit
        && !estimate.fitted.disagreements.is_empty()
    {
        // A spring or a gap is told from what one and the same axis leaves.
        misfit.coupling = None;
    }
    // Counts are read behind the same lag.
    if let Some(unknowns) = lag::spread(objective, estimate.terms.lag, &optimum.p, at) {
        for p in raw {
            between.add(p.name, p.variance(&unknowns));
        }
    }
    let bread = &estimate.unknowns.bread;
    if let Some(unknowns) = held_delay::spread(objective, &estimate.terms, &optimum.p, at, bread) {
        for p in raw {
            between.add(p.name, p.variance(&unknowns));
        }
    }
    let against = shift.as_ref().map_or(&[][..], |shift| &shift.against);
    if let Some(unknowns) = stated::spread(objective, &estimate.terms, fit, against) {
        for p in raw {
            between.add(p.name, p.variance(&unknowns));
        }
    }
    let nothing =
        shift.is_none() && spread.is_none() && open.is_none() && pressed.is_none() && jumps == 0.0;
    if nothing && between.is_nothing() {
        return between;
    }
    let levels = levels(objective, raw);
    let matrix = &mut estimate.fitted.covariance.matrix;
    let n = raw.len();
    let widen: Vec<f64> = raw
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let ratio = (known[i] + between.variance(p.name)) / matrix[i][i];
            if ratio.is_finite() { ratio.sqrt() } else { 1.0 }
        })
        .collect();
    for i in 0..n {
        for j in 0..n {
            matrix[i][j] *= widen[i] * widen[j];
        }
    }
    for (i, p) in raw.iter().enumerate() {
        let variance = estimate.covariance.matrix[i][i];
        if let Some(own) = find(estimate, p.name) {
            let bias = shift.as_ref().map(|shift| shift.bias[i]);
            *own = optimal::fitted(p, variance, bias, optimum, levels[i]);
        }
    }
    between
}

/// Widens the intervals of levels of friction to the levels that the log shows, `swing` being by which parts of their mean the
/// least and the largest differ from it: the mean over another log is another one.
fn reach_as_far_as((least, largest): (f64, f64), parameters: &mut [Parameter]) {
    let levels = [Quantity::Coulomb, Quantity::Static];
    for p in parameters.iter_mut().filter(|p| p.identified) {
        if let Some((low, high)) = &mut p.ci95
            && levels.contains(&p.name.quantity)
        {
            *low = low.min(p.value * (1.0 + least));
            *high = high.max(p.value * (1.0 + largest));
        }
    }
}

/// Flags the parameters that describe a shape which the residual shows to be another one, those that stand for a level along the
/// stroke which its terms do not describe, and those that logs have too differently.
fn flag_what_the_residual_doubts(fitted: &mut FittedLaw) {
    let cause = fitted.misfit.as_ref().and_then(Misfit::cause);
    let along_the_stroke = |p: &Parameter| {
        matches!(
            p.name.quantity,
            Quantity::CoulombPosition | Quantity::CoulombPitch(..) | Quantity::CoulombMap(_)
        )
    };
    let undescribed =
        cause == Some(Cause::Position) && fitted.parameters.iter().any(along_the_stroke);
    let truncated = fitted.terms.map().is_some_and(|map| map.is_truncated());
    let differing = &fitted.disagreements;
    let claimed = |p: &&mut Parameter| p.identified && p.identifiable;
    for p in fitted.parameters.iter_mut().filter(claimed) {
        let shape = cause.and_then(|cause| cause.against(p.name.quantity));
        // On strokes the speed goes with the place.
        let place = match p.name.quantity {
            Quantity::Coulomb | Quantity::Static | Quantity::Sigma2 if truncated => {
                Some("the level changes along the stroke faster than its map can follow")
            }
            Quantity::Coulomb | Quantity::Sigma2 if undescribed => Some(
                "takes up part of how friction changes along the stroke, which its terms do not describe",
            ),
            _ => None,
        };
        let level = || differing.iter().find_map(|found| found.against(p.name));
        if let Some(reason) = shape.or(place).map(String::from).or_else(level) {
            p.identifiable = false;
            p.reason = reason;
        }
    }
}

/// The direction of a parameter of the Stribeck curve (the positive one for what is common to both);
/// `None` for other parameters.
fn curve_of(name: Name) -> Option<usize> {
    let curve = [
        Quantity::Static,
        Quantity::StribeckVelocity,
        Quantity::StribeckExponent,
    ];
    curve.contains(&name.quantity).then(|| name.side.index())
}

/// Marks a parameter as unknown, because a fit without the curve is as good.
fn without_curve(estimate: &mut Estimate, name: Name) {
    if let Some(own) = find(estimate, name) {
        own.ci95 = None;
        if own.identifiable {
            own.identifiable = false;
            own.reason = "the fit is hardly better than without a Stribeck curve".into();
        }
    }
}

fn find(estimate: &mut Estimate, name: Name) -> Option<&mut Parameter> {
    let parameters = &mut estimate.fitted.parameters;
    parameters.iter_mut().find(|p| p.name == name)
}

/// Replaces the interval of a parameter by that of its profile, where it may differ from the linear one.
fn profiled(
    objective: &Objective,
    optimum: &Optimum,
    p: &Physical,
    estimate: &mut Estimate,
    (along, watch): (&mut Along, &mut Watch),
) {
    let k = optimum.p.len();
    let curved = [
        Quantity::Sigma1,
        Quantity::Static,
        Quantity::StribeckVelocity,
        Quantity::StribeckExponent,
    ];
    if !curved.contains(&p.name.quantity) {
        return;
    }
    let (held, index) = match (p.nonlinear, p.linear) {
        (Some(i), _) => (Held::Nonlinear(i), i),
        (None, Some(j)) => (Held::Linear(j), k + j),
        (None, None) => return,
    };
    let Some(own) = estimate.covariance.place(p.name) else {
        return;
    };
    let variance = estimate.covariance.matrix[own][own];
    let bread = estimate.unknowns.bread[(index, index)];
    let std = estimate.unknowns.covariance[(index, index)].sqrt();
    let relative = variance.sqrt() / p.value;
    if !(relative > PROFILED_DEVIATION && relative.is_finite() && std.is_finite() && bread > 0.0) {
        return;
    }
    let Some(now) = estimate.parameter(p.name) else {
        return;
    };
    // The part of the parameter's variance that does not come from the unknown that is held: added in
    // quadrature.
    let with = p.with(&estimate.unknowns.covariance, index) / p.value;
    let spread = p.variance(&estimate.unknowns.covariance) / (p.value * p.value);
    let path = if std > 0.0 { with / std } else { 0.0 };
    let apart =
        (variance / (p.value * p.value) - spread).max(0.0) + (spread - path * path).max(0.0);
    let quantile = now
        .bias
        .map_or(quantile(0.0, 1.0), |b| quantile(b, variance.sqrt()));
    let profile = Profile {
        objective,
        optimum,
        held,
        std,
        rise: std * std / bread,
        quantile,
    };
    let Some(ends) = profile.ends(watch) else {
        return;
    };
    let reach = ends.map(|end| match end {
        End::Open => None,
        End::At(p_there, c_there) => {
            let there = physical(
                objective.law(),
                objective.linear(),
                objective.record().step(),
                &p_there,
                &c_there,
            );
            along.passes(&there, p.name);
            there
                .iter()
                .find(|q| q.name == p.name)
                .filter(|q| q.value > 0.0)
                .map(|q| {
                    let way = libm::log(q.value / p.value);
                    (way * way + quantile * quantile * apart).sqrt()
                })
        }
    });
    let free = p
        .nonlinear
        .is_none_or(|i| !optimum.bounds.at_bound(&optimum.p, i));
    if let Some(own) = find(estimate, p.name) {
        state(own, reach, free);
    }
}

/// Writes the lower and upper reach, in the logarithm, into a parameter; `None` is an open side.
fn state(parameter: &mut Parameter, [down, up]: [Option<f64>; 2], free: bool) {
    parameter.interval = IntervalKind::Profile;
    parameter.ci95 = match (down, up) {
        (None, None) => None,
        _ => Some((
            down.map_or(f64::NEG_INFINITY, |d| parameter.value * libm::exp(-d)),
            up.map_or(f64::INFINITY, |d| parameter.value * libm::exp(d)),
        )),
    };
    if down.is_some() && up.is_some() || !parameter.identifiable || !free {
        return;
    }
    parameter.identifiable = false;
    parameter.reason = match (down, up) {
        (None, None) => "the data bound it on no side",
        (None, _) => "the data bound it from above only",
        _ => "the data bound it from below only",
    }
    .into();
}
