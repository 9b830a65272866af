//! How well a law predicts friction on motion like that of its logs, and what motion that was.

use super::logs::has_wrong_sign;
use super::trust::{Evidence, Reasons};
use crate::source::Source;
use crate::turns::turns;
use stiction_files::result::{Compensation, Next};
use stiction_identify::Series;
use stiction_number::{Percent, counted};
use stiction_parameters::Quantity;

/// Largest part of the friction that a law may leave on samples that it was not fitted to, dimensionless: with a third left, what is
/// wrong in the compensation is half of what is right.
const MOST_FRICTION_LEFT: f64 = 1.0 / 3.0;
/// Ratio of the error of a validation to that of the fit above which the law does not hold there, dimensionless: a choice.
const VALIDATION_FAILS_ABOVE: f64 = 2.0;
/// Part of the friction that a validation may leave whatever the fit left, dimensionless: a tenth is little for a
/// compensator.
const LITTLE_LEFT: f64 = 0.1;

/// Speed of a record over the top speed of the fitted ones up to which it counts as rest, and part of its samples that has to move
/// faster each way for anything to be identified from it, dimensionless.
const SLOW: f64 = 0.01;
const MOVING_EACH_WAY: f64 = 0.05;
/// Fewest reversals on which a law is relied on that leaves its Coulomb level open: the third may confirm what the first two
/// suggest.
const FEWEST_REVERSALS: usize = 3;

/// What the law leaves of the friction and where that was seen, with the reasons against it; `None` without a force that
/// friction is a part of.
pub(super) fn judged(evidence: &Evidence, reasons: &mut Reasons) -> Option<Compensation> {
    let law = evidence.law;
    let own = &law.series;
    let friction = friction_rms(own)?;
    let fitted = law.fit.rmse / friction;
    let (mut left, mut judged_on) = match evidence.held_out_rmse {
        Some(rmse) => (rmse / friction, "held-out"),
        None => (fitted, "fitted"),
    };
    for (at, (name, series)) in evidence.validation.iter().enumerate() {
        let Some(there) = friction_rms(series) else {
            continue;
        };
        let found = rms(&series.residual()) / there;
        if found > left || judged_on == "fitted" {
            (left, judged_on) = (found, "validation");
        }
        let log = evidence.held_out.iter().find(|log| log.name() == *name);
        let turned = log.is_some_and(has_wrong_sign);
        // Where every simpler law leaves more, nothing is lost with this one.
        let simpler = evidence.simpler.get(at).copied().flatten();
        let loses = turned || simpler.is_none_or(|simpler| found >= simpler / there);
        if found > LITTLE_LEFT && found > VALIDATION_FAILS_ABOVE * fitted && loses {
            // What is one part of a log is no log to type.
            let is_whole = log.is_some_and(|log| log.part.is_none());
            let text = format!(
                "on {name} the law leaves {} of the friction, where it was fitted {}: {}",
                percent(found),
                percent(fitted),
                match turned {
                    true => "its force has the wrong sign",
                    false => "friction, load or motion differ there",
                }
            );
            let next = match evidence.held_out.is_empty() {
                _ if !is_whole => Next::Check,
                true => Next::Check,
                // Nor is one that the axis file never fits.
                false if log.is_some_and(|log| log.never_fitted) => Next::CheckTheOther,
                false if !turned && shows_friction(series, top_speed(own)) => {
                    Next::IdentifyTheOther
                }
                false => Next::CheckTheOther,
            };
            reasons.push_elsewhere(text, next, name);
        }
    }
    if left.is_nan() || left > MOST_FRICTION_LEFT {
        let samples = match judged_on {
            "held-out" => "held-out samples",
            "validation" => "the validation data",
            _ => "the samples it was fitted to",
        };
        let text = format!(
            "the law leaves {} of the friction on {samples}; at most {} may be left to compensate with it",
            percent(left),
            percent(MOST_FRICTION_LEFT)
        );
        reasons.push(text, evidence.where_no_law_predicts());
    }
    if judged_on == "fitted" && evidence.chosen {
        let text = "the log is too short to hold samples out: nothing shows what the law predicts";
        reasons.push(text, evidence.where_no_law_predicts());
    }
    let reversals = reversals(evidence.sources);
    let coulomb = law.parameters.iter();
    let mut coulomb = coulomb.filter(|p| p.name.quantity == Quantity::Coulomb);
    if reversals < FEWEST_REVERSALS && coulomb.any(|p| !p.identifiable) {
        let text = format!(
            "the axis turns back {}, which shows too little of friction: its Coulomb level is not determined",
            match reversals {
                0 => "nowhere".to_string(),
                n => counted(n, "time"),
            }
        );
        reasons.push(text, Next::Check);
    }
    Some(Compensation {
        friction_left_percent: 100.0 * left,
        judged_on: judged_on.into(),
        top_speed: top_speed(own),
        stroke: stroke(own),
        reversals,
    })
}

fn percent(part: f64) -> String {
    Percent::error(100.0 * part).digits(2)
}

/// Whether a record holds what an identification needs: a force, and motion both ways that is not slow beside a top speed, m/s
/// (rad/s).
fn shows_friction(series: &Series, top_speed: f64) -> bool {
    let part = |moves: &dyn Fn(f64) -> bool| {
        let count = series.velocity.iter().filter(|v| moves(**v)).count();
        count as f64 > MOVING_EACH_WAY * series.velocity.len() as f64
    };
    let slow = SLOW * top_speed;
    rms(&series.measured) > 0.0 && part(&|v| v > slow) && part(&|v| v < -slow)
}

/// Rms of the measured force without the terms that stand beside the law; `None` where there is none.
fn friction_rms(series: &Series) -> Option<f64> {
    let friction = series.measured.iter().zip(&series.other);
    let friction: Vec<f64> = friction.map(|(u, other)| u - other).collect();
    Some(rms(&friction)).filter(|rms| *rms > 0.0 && rms.is_finite())
}

pub(super) fn rms(x: &[f64]) -> f64 {
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
fn reversals(sources: &[Source]) -> usize {
    let turns = sources.iter().filter_map(|source| turns(&source.log));
    turns.map(|(_, turns)| turns.len()).sum()
}
