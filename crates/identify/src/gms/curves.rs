//! Starting values for the Stribeck curve, without starting values of the elements.

use super::dictionary::{self, Atom};
use super::ladder::Search;
use crate::error::Error;
use crate::law::{Law, Layout};
use crate::separable::objective::Objective;
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use stiction_search::Control;

/// Elements of the dictionary over the whole range of yield deflections.
const ELEMENTS_ANYWHERE: usize = 24;
/// Elements of the dictionary over the range that matters.
const ELEMENTS_IN_RANGE: usize = 12;
/// Curves that are followed from each third of the range of Stribeck velocities.
const FOLLOWED_PER_THIRD: usize = 2;
/// Part of the yield force that an element must have to widen that range.
const LEAST_FORCE_SHARE: f64 = 0.01;
/// How far the range of yield deflections reaches below its elements, in logarithms.
const RANGE_BELOW: f64 = 0.3;
/// And above: the limit at rest may be some times that of a curve that hardly falls.
const RANGE_ABOVE: f64 = 1.0;

/// Scans the curves of a symmetric law, each with the elements that fit it best. Returns the curves with
/// the smallest residual, best first, in the unknowns of the law that is asked for.
pub(super) fn curves(search: &Search, watch: &mut Watch) -> Result<Vec<Vec<f64>>, Error> {
    let law = |elements| Law {
        elements,
        asymmetric: false,
        ..search.law
    };
    let from = law(0).layout();
    let to = Law {
        elements: 0,
        ..search.law
    }
    .layout();
    if from.count == 0 {
        return Ok(vec![vec![0.0; to.count]]);
    }
    let wide = law(ELEMENTS_ANYWHERE);
    let bounds = SearchBox::from_record(search.record, &wide)?;
    let places = dictionary::places(&bounds, &wide.layout(), ELEMENTS_ANYWHERE);
    let flat = flat(&bounds, &from);
    let p = dictionary::unknowns(&flat, places.iter().copied());
    let objective = Objective::new(search.record, wide, search.terms);
    let at = objective.evaluate(&p, false);
    watch.count(&objective, false);
    let (low, high) = range(&dictionary::atoms(&wide, &p, &at));
    let first = wide.layout().yields().start;
    let low = (low - RANGE_BELOW).clamp(bounds.low(first), bounds.high(first));
    let high = (high + RANGE_ABOVE).clamp(bounds.low(first), bounds.high(first));
    let places = dictionary::steps(low, high, ELEMENTS_IN_RANGE);
    let objective = Objective::new(search.record, law(ELEMENTS_IN_RANGE), search.terms);
    let seed = (search.settings.seed ^ (search.settings.seed >> 32)) as u32;
    let many = search.settings.scan / 2;
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    for i in 0..=many {
        let curve = match i {
            0 => flat.clone(),
            _ => (0..from.count)
                .map(|d| {
                    let unit = f64::from(sobol_burley::sample(i as u32, d as u32, seed));
                    bounds.low(d) + unit * (bounds.high(d) - bounds.low(d))
                })
                .collect(),
        };
        let p = dictionary::unknowns(&curve, places.iter().copied());
        let cost = objective.evaluate(&p, false).cost;
        watch.count(&objective, false);
        watch.fraction = i as f64 / many.max(1) as f64;
        found.push((if cost.is_nan() { f64::INFINITY } else { cost }, curve));
        if watch.report(objective.relative(cost)) == Control::Stop {
            break;
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Minima at slow and at fast Stribeck velocities may lie close together, so some of each are
    // followed.
    let third = |p: &[f64]| match from.velocity[0] {
        Some(i) => {
            let part = (p[i] - bounds.low(i)) / (bounds.high(i) - bounds.low(i));
            ((3.0 * part) as usize).min(2)
        }
        _ => 0,
    };
    let mut taken = [0; 3];
    found.retain(|(_, p)| {
        let third = third(p);
        taken[third] += 1;
        taken[third] <= FOLLOWED_PER_THIRD
    });
    let best = found.iter();
    Ok(best.map(|(_, p)| both_ways(p, &from, &to)).collect())
}

/// A curve with almost no Stribeck effect, in the middle of the speed range.
fn flat(bounds: &SearchBox, layout: &Layout) -> Vec<f64> {
    (0..layout.count)
        .map(|d| {
            if layout.excess[0] == Some(d) {
                bounds.low(d)
            } else {
                0.5 * (bounds.low(d) + bounds.high(d))
            }
        })
        .collect()
}

/// The range of the yield deflections (logarithms) of the elements that carry a relevant force.
fn range(atoms: &[Atom]) -> (f64, f64) {
    let total: f64 = atoms.iter().map(|a| a.force).sum();
    atoms
        .iter()
        .filter(|a| a.force >= LEAST_FORCE_SHARE * total)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), a| {
            (low.min(a.place), high.max(a.place))
        })
}

/// A curve of a symmetric law, written for a law that may differ by direction.
fn both_ways(curve: &[f64], from: &Layout, to: &Layout) -> Vec<f64> {
    let mut out = vec![0.0; to.count];
    let mut copy = |to: Option<usize>, from: Option<usize>| {
        if let (Some(to), Some(from)) = (to, from) {
            out[to] = curve[from];
        }
    };
    for side in 0..2 {
        copy(to.excess[side], from.excess[side]);
        copy(to.velocity[side], from.velocity[side]);
    }
    copy(to.attraction, from.attraction);
    out
}
