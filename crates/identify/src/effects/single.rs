//! What one column tells: a spring, dynamics and clocks between force and motion, a mass or a delay that is stated.

use super::{Candidate, Effect, Fitted};
use crate::conditioning::record::extent;
use crate::law::terms::{Delay, Mass, Terms};
use crate::separable::objective::Objective;
use stiction_policy::effect;

pub(super) fn candidates(fitted: &Fitted) -> Vec<Candidate> {
    let all = [spring_force, dynamics, clocks, mass, delay];
    all.into_iter().filter_map(|of| of(fitted)).collect()
}

/// A force that changes smoothly with the position, as that of a spring, a cable chain or a weight does.
fn spring_force(fitted: &Fitted) -> Option<Candidate> {
    let position = &fitted.measures.position;
    let (low, high) = fitted.stroke()?;
    let middle = 0.5 * (low + high);
    let way = |power: i32| position.iter().map(|x| (x - middle).powi(power)).collect();
    let mut candidate = Candidate::new(vec![way(1), way(2)], |c| Some(Effect::SpringForce(c[0])));
    candidate.along = position.to_vec();
    Some(candidate)
}

/// The second derivative of the force: dynamics between force and motion, to second order.
fn dynamics(fitted: &Fitted) -> Option<Candidate> {
    let objective = fitted.objective;
    (objective.is_delayed() && objective.law().layout().kappa.is_some()).then_some(())?;
    let column = objective.bend(fitted.p, &fitted.at.solution.coefficients);
    let square = objective.record().step().powi(2);
    Some(Candidate::new(vec![column], move |c| {
        Some(Effect::Dynamics(c[0] * square))
    }))
}

/// A delay that grows along the log: force and motion stamped by two clocks.
fn clocks(fitted: &Fitted) -> Option<Candidate> {
    let (objective, measures) = (fitted.objective, &fitted.measures);
    let record = objective.record();
    let one_log = record.segments.windows(2).all(|s| s[0].log == s[1].log);
    let shows =
        one_log && objective.is_delayed() && fitted.reversals >= effect::MIN_DELAY_REVERSALS;
    let slope = fitted.at.slopes.last().filter(|_| shows)?;
    let (first, last) = extent(&measures.time);
    let (middle, step) = (0.5 * (first + last), record.step());
    // The unknown is in samples, and larger for a force that is logged later.
    let column = slope
        .iter()
        .zip(&measures.time)
        .map(|(s, t)| s * (t - middle) / step);
    let duration = last - first;
    let mut candidate = Candidate::new(vec![column.collect()], move |c| {
        ((c[0] * duration).abs() > effect::MIN_DELAY_GROWTH * step).then_some(Effect::Clocks(c[0]))
    });
    candidate.along = measures.time.clone();
    Some(candidate)
}

/// Another mass than the one that is stated.
fn mass(fitted: &Fitted) -> Option<Candidate> {
    let Mass::Given(mass) = fitted.terms.mass else {
        return None;
    };
    let force = fitted.objective.inertia(fitted.p);
    let column: Vec<f64> = force.iter().map(|f| f / mass).collect();
    (mass > 0.0 && !column.is_empty()).then_some(())?;
    Some(Candidate::new(vec![column], move |c| {
        (c[0].abs() > effect::MIN_MASS_ERROR * mass).then_some(Effect::Mass(mass + c[0]))
    }))
}

/// Another delay than the one that is stated.
fn delay(fitted: &Fitted) -> Option<Candidate> {
    let Delay::Given(delay) = fitted.terms.delay else {
        return None;
    };
    (delay != 0.0).then_some(())?;
    let record = fitted.objective.record();
    let open = Terms {
        delay: Delay::Fitted,
        ..fitted.terms.clone()
    };
    let objective = Objective::new(record, *fitted.objective.law(), &open);
    let samples = delay / record.step();
    let p: Vec<f64> = fitted.p.iter().copied().chain([samples]).collect();
    let at = objective.evaluate(&p, true);
    let column = at
        .slopes
        .last()
        .filter(|slope| slope.len() == fitted.level.len())?;
    let step = record.step();
    Some(Candidate::new(vec![column.clone()], move |c| {
        (c[0].abs() > effect::MIN_DELAY_ERROR).then_some(Effect::Delay(delay + c[0] * step))
    }))
}
