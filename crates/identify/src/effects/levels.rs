//! A level of friction that changes with time, place, load or temperature.

use super::{Candidate, Effect, Fitted};
use crate::conditioning::record::extent;
use crate::law::dependence::Dependence;
use std::f64::consts::PI;
use stiction_policy::effect;

/// Waves by which a level changes, in halves of what it changes with.
const WAVES: usize = 3;

pub(super) fn candidates(fitted: &Fitted) -> Vec<Candidate> {
    let measures = &fitted.measures;
    let has = |wanted: &str| (fitted.terms.dependences.iter()).any(|own| own.name() == wanted);
    let mut out = Vec::new();
    let (from, to) = extent(&measures.time);
    if to - from >= effect::MIN_DRIFT_TIME {
        out.extend(smooth(fitted, &measures.time, |levels, _| {
            Effect::Drift(levels)
        }));
    }
    if fitted.stroke().is_some() {
        out.extend(smooth(fitted, &measures.position, Effect::Position));
    }
    let load = Dependence::CoulombLoad(0.0).name();
    if !measures.load.is_empty() && !has(load) {
        out.extend(straight(fitted, &measures.load, Effect::Load));
    }
    let warmth = Dependence::CoulombTemperature(0.0).name();
    if !measures.temperature.is_empty() && !has(warmth) {
        out.extend(straight(fitted, &measures.temperature, Effect::Temperature));
    }
    out
}

/// A level that changes smoothly along something.
fn smooth(
    fitted: &Fitted,
    along: &[f64],
    effect: impl Fn([f64; 2], bool) -> Effect + 'static,
) -> Option<Candidate> {
    let (low, high) = extent(along);
    (high > low).then_some(())?;
    let wave = |k: usize, part: f64| libm::cos(PI * (k + 1) as f64 * part);
    let column = |k: usize| {
        let both = along.iter().zip(&fitted.level);
        both.map(|(x, level)| level * wave(k, (x - low) / (high - low)))
            .collect()
    };
    let made = move |c: &[f64]| {
        let at = |part: f64| (0..WAVES).map(|k| c[k] * wave(k, part)).sum::<f64>();
        let levels: Vec<f64> = (0..=32).map(|i| at(f64::from(i) / 32.0)).collect();
        let (low, high) = extent(&levels);
        // Regression of the course on a line.
        let lines = (0..=32).map(|i| f64::from(i) / 16.0 - 1.0);
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        let mean = levels.iter().sum::<f64>() / levels.len() as f64;
        for (x, y) in lines.zip(&levels) {
            xx += x * x;
            xy += x * (y - mean);
            yy += (y - mean) * (y - mean);
        }
        Some(effect(
            [low, high],
            xy * xy >= effect::MIN_LINEAR_PART * xx * yy,
        ))
    };
    let mut candidate = Candidate::new((0..WAVES).map(column).collect(), made);
    (candidate.along, candidate.is_of_level) = (along.to_vec(), true);
    Some(candidate)
}

/// A level that changes in proportion to something.
fn straight(
    fitted: &Fitted,
    along: &[f64],
    effect: impl Fn([f64; 2]) -> Effect + 'static,
) -> Option<Candidate> {
    let (low, high) = extent(along);
    (high > low).then_some(())?;
    let middle = 0.5 * (low + high);
    let column = along
        .iter()
        .zip(&fitted.level)
        .map(|(x, level)| level * (x - middle));
    let half = 0.5 * (high - low);
    let made = move |c: &[f64]| Some(effect([-(c[0] * half).abs(), (c[0] * half).abs()]));
    let mut candidate = Candidate::new(vec![column.collect()], made);
    (candidate.along, candidate.is_of_level) = (along.to_vec(), true);
    Some(candidate)
}
