//! How well a law predicts friction on motion like that of its logs, and what motion that was.

use super::logs::has_wrong_sign;
use super::trust::Evidence;
use super::verdict::{HeldOut, Validation};
use crate::source::Source;
use crate::turns::turns;
use stiction_files::result::{Action, Compensation};
use stiction_identify::Series;
use stiction_policy::motion;
use stiction_say::On;

/// What the law leaves of the friction and where that was seen, as it is stated and as a verdict depends on it; `None` without a force
/// that friction is a part of.
pub(super) fn held_out(evidence: &Evidence) -> Option<(Compensation, HeldOut)> {
    let law = evidence.law;
    let own = &law.series;
    let friction = friction_rms(own)?;
    let fitted = law.fit.rmse / friction;
    let (mut error, mut on) = match evidence.held_out_rmse {
        Some(rmse) => (rmse / friction, On::HeldOut),
        None => (fitted, On::Fitted),
    };
    let mut validations = Vec::new();
    for (at, (name, series)) in evidence.validation.iter().enumerate() {
        let Some(there) = friction_rms(series) else {
            continue;
        };
        let found = rms(&series.residual()) / there;
        if found > error || on == On::Fitted {
            (error, on) = (found, On::Validation);
        }
        let log = evidence.held_out.iter().find(|log| log.name() == *name);
        let inverted = log.is_some_and(has_wrong_sign);
        let simpler = evidence.simpler.get(at).copied().flatten();
        let logs = vec![name.clone()];
        let next = match log {
            // What is one part of a log is no log to type.
            None => Action::CHECK,
            Some(log) if log.part.is_some() => Action::CHECK,
            // Nor is one that the axis file never fits.
            Some(log) if log.never_fitted || inverted => Action::Check { logs },
            Some(_) if shows_friction(series, top_speed(own)) => Action::Identify { logs },
            Some(_) => Action::Check { logs },
        };
        validations.push(Validation {
            log: name.clone(),
            error: found,
            simpler: simpler.map(|rmse| rmse / there),
            inverted,
            next,
        });
    }
    let stated = Compensation {
        friction_left_percent: 100.0 * error,
        judged_on: match on {
            On::HeldOut => "held-out",
            On::Validation => "validation",
            On::Fitted => "fitted",
        }
        .into(),
        top_speed: top_speed(own),
        stroke: stroke(own),
        reversals: reversals(evidence.sources),
    };
    let held_out = HeldOut {
        error,
        on,
        fitted,
        chosen: evidence.chosen,
        validations,
    };
    Some((stated, held_out))
}

/// Whether a record holds what an identification needs: a force, and motion both ways that is not slow beside a top speed, m/s
/// (rad/s).
fn shows_friction(series: &Series, top_speed: f64) -> bool {
    let part = |moves: &dyn Fn(f64) -> bool| {
        let count = series.velocity.iter().filter(|v| moves(**v)).count();
        count as f64 > motion::MIN_FITTED_SHARE * series.velocity.len() as f64
    };
    let slow = motion::MAX_FITTED_REST_SPEED * top_speed;
    rms(&series.measured) > 0.0 && part(&|v| v > slow) && part(&|v| v < -slow)
}

/// Rms of the measured force without the terms that stand beside the law; `None` where there is none.
fn friction_rms(series: &Series) -> Option<f64> {
    let friction = series.measured.iter().zip(&series.other);
    let friction: Vec<f64> = friction.map(|(u, other)| u - other).collect();
    Some(rms(&friction)).filter(|rms| *rms > 0.0 && rms.is_finite())
}

/// Root mean square.
pub(crate) fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|x| x * x).sum::<f64>() / x.len().max(1) as f64).sqrt()
}

/// Largest speed of a record, m/s or rad/s.
pub(super) fn top_speed(series: &Series) -> f64 {
    series
        .velocity
        .iter()
        .fold(0.0, |top: f64, v| top.max(v.abs()))
}

/// The longest stroke of a log, m or rad: where another log has its origin is not known.
fn stroke(series: &Series) -> Option<f64> {
    let mut strokes = Vec::new();
    let mut at = series.log.iter().zip(&series.position).peekable();
    while let Some((log, &first)) = at.next() {
        let (mut low, mut high) = (first, first);
        while let Some((_, &x)) = at.next_if(|(own, _)| *own == log) {
            (low, high) = (low.min(x), high.max(x));
        }
        strokes.push(high - low);
    }
    strokes.into_iter().reduce(f64::max)
}

/// How often the axis turns back.
pub(super) fn reversals(sources: &[Source]) -> usize {
    let turns = sources.iter().filter_map(|source| turns(&source.log));
    turns.map(|(_, turns)| turns.len()).sum()
}
