//! Friction of another shape than that of the law: several bristles, or another curve over the speed.

use super::{Candidate, Effect, Fitted};
use crate::law::terms::ColumnKind;

/// Stiffness of further bristles, in parts of that of the law.
const STIFFNESS: [f64; 4] = [0.2, 0.5, 2.0, 5.0];
/// Speeds between which friction is free, in parts of the top speed.
const SPEEDS: [f64; 5] = [0.02, 0.1, 0.3, 0.6, 1.0];

pub(super) fn candidates(fitted: &Fitted) -> Vec<Candidate> {
    bristles(fitted).into_iter().chain(curve(fitted)).collect()
}

/// Bristles beside the one of the law, as generalized Maxwell-slip has them.
fn bristles(fitted: &Fitted) -> Option<Candidate> {
    let objective = fitted.objective;
    let kappa = objective.law().layout().kappa?;
    if objective.law().kind.has_elements() {
        return None;
    }
    let level = (objective.linear().iter()).position(|term| term.column == ColumnKind::Level)?;
    let column = |stiffness: f64| {
        let mut p = fitted.p.to_vec();
        p[kappa] += libm::log(stiffness);
        objective.columns_at(&p)[level].to_vec()
    };
    let columns = STIFFNESS.map(column).into();
    Some(Candidate::new(columns, |_| Some(Effect::Bristles)))
}

/// Friction that is free at some speeds and straight between them.
fn curve(fitted: &Fitted) -> Option<Candidate> {
    let speed = &fitted.measures.speed;
    let top = speed.iter().fold(0.0_f64, |top, v| top.max(v.abs()));
    if !(top > 0.0 && top.is_finite()) {
        return None;
    }
    let size = fitted
        .level
        .iter()
        .fold(0.0_f64, |most, f| most.max(f.abs()));
    let hat = |k: usize, v: f64| {
        let part = v.abs() / top;
        let way = |from: f64, to: f64| (part - from) / (to - from);
        let rising = k
            .checked_sub(1)
            .map_or(1.0, |below| way(SPEEDS[below], SPEEDS[k]));
        let falling = SPEEDS
            .get(k + 1)
            .map_or(1.0, |above| 1.0 - way(SPEEDS[k], *above));
        rising.min(falling).clamp(0.0, 1.0)
    };
    let column = |k: usize| {
        let both = speed.iter().zip(&fitted.level);
        both.map(|(v, f)| hat(k, *v) * f / size).collect()
    };
    let mut candidate = Candidate::new((0..SPEEDS.len()).map(column).collect(), |_| {
        Some(Effect::Curve)
    });
    candidate.along = speed.clone();
    Some(candidate)
}
