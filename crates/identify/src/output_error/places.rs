//! Where Maxwell-slip elements yield: a descent alone does not move one past another.

use crate::gms::dictionary::{self, Atom};
use crate::output_error::elements::Element;
use crate::output_error::plant::Axis;
use crate::output_error::problem::Point;
use crate::output_error::search::{Found, Search};
use crate::output_error::simulate::Initial;
use crate::output_error::unknowns::{Layout, Unknown};
use crate::watch::Watch;

/// Yield deflections at which an element is tried.
const PLACES: usize = 16;
/// How far those reach beyond the elements there are, as a factor.
const BEYOND: f64 = 3.0;
/// Part of the force of its neighbour that an element takes at a new place.
const TAKEN_SHARES: [f64; 2] = [0.25, 0.5];
/// Tries that are followed by a descent, and its steps.
const FOLLOWED: usize = 6;
const STEPS: usize = 30;
/// Fall of the cost, as a part of it, that is worth another round, and most rounds.
const WORTHWHILE_GAIN: f64 = 0.02;
const MOST_ROUNDS: usize = 8;

/// Fewer elements that come close to these.
pub(crate) fn joined(all: &[Element], most: usize) -> Vec<Element> {
    let atom = |e: &Element| Atom {
        place: libm::log(e.reach),
        force: e.force,
    };
    let mut atoms: Vec<Atom> = all.iter().map(atom).collect();
    atoms.sort_by(|a, b| a.place.total_cmp(&b.place));
    let element = |a: Atom| Element {
        reach: libm::exp(a.place),
        force: a.force,
    };
    let atoms = dictionary::join(atoms, most);
    let mut out: Vec<Element> = atoms.into_iter().map(element).collect();
    // Two of half the force each are the same.
    while out.len() < most && !out.is_empty() {
        let strongest = (0..out.len()).max_by(|a, b| out[*a].force.total_cmp(&out[*b].force));
        let at = strongest.unwrap_or(0);
        out[at].force *= 0.5;
        out.push(Element {
            reach: 1.2 * out[at].reach,
            force: out[at].force,
        });
    }
    out
}

/// The best found, after each element in turn was given to its neighbour and tried at other places.
pub(crate) fn elsewhere(search: &Search, mut best: Found, watch: &mut Watch) -> Found {
    for _ in 0..MOST_ROUNDS {
        let before = best.descent.cost;
        let axis = search.axis(&best);
        let starts = best.descent.at.starts.clone();
        let found = best_of(search, others(&axis), &starts, &best, watch);
        if let Some(found) = found.filter(|found| found.descent.cost < before) {
            best = found;
        }
        if best.descent.cost > (1.0 - WORTHWHILE_GAIN) * before {
            break;
        }
    }
    best
}

/// The lowest end point of descents from the most promising of these axes, with what was found so far as it is weighed.
pub(crate) fn best_of(
    search: &Search,
    axes: Vec<Axis>,
    starts: &[Initial],
    like: &Found,
    watch: &mut Watch,
) -> Option<Found> {
    let mut tries: Vec<(f64, Axis)> = Vec::with_capacity(axes.len());
    for axis in axes {
        if watch.stopped {
            return None;
        }
        let at = Point {
            q: search.layout.read(&axis),
            starts: starts.to_vec(),
        };
        watch.counts.costs += 1;
        let problem = search.problem(&axis, like.substeps, like.weights);
        tries.push((problem.cost(&at, watch), axis));
    }
    tries.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<Found> = None;
    for (_, axis) in tries.into_iter().take(FOLLOWED) {
        let substeps = search.substeps(&axis).max(like.substeps);
        let found = search.descend(axis, starts.to_vec(), substeps, like.weights, STEPS, watch);
        if best
            .as_ref()
            .is_none_or(|b| found.descent.cost < b.descent.cost)
        {
            best = Some(found);
        }
        if watch.stopped {
            break;
        }
    }
    best
}

/// The axis with one element at another place.
fn others(axis: &Axis) -> Vec<Axis> {
    let Some(elements) = &axis.elements else {
        return Vec::new();
    };
    let reaches = || elements.all.iter().map(|e| e.reach);
    let low = reaches().fold(f64::INFINITY, f64::min) / BEYOND;
    let high = reaches().fold(0.0, f64::max) * BEYOND;
    let mut out = Vec::new();
    for gone in 0..elements.all.len() {
        let mut rest = elements.all.clone();
        let removed = rest.remove(gone);
        let Some(heir) = nearest(&rest, removed.reach) else {
            return Vec::new();
        };
        rest[heir].force += removed.force;
        for place in dictionary::steps(libm::log(low), libm::log(high), PLACES) {
            let reach = libm::exp(place);
            for share in TAKEN_SHARES {
                let mut all = rest.clone();
                let giver = nearest(&all, reach).unwrap_or(heir);
                let force = share * all[giver].force;
                all[giver].force -= force;
                all.push(Element { reach, force });
                let mut other = axis.clone();
                if let Some(elements) = &mut other.elements {
                    elements.all = all;
                }
                other.follow_elements();
                out.push(other);
            }
        }
    }
    out
}

/// The same point with its elements in the order in which they yield.
pub(crate) fn in_order(layout: &Layout, mut at: Point) -> Point {
    let of = |at: &Point, unknown| layout.place(unknown).map(|i| at.q[i]);
    let mut all: Vec<(f64, f64)> = (0..)
        .map_while(|k| Some((of(&at, Unknown::Reach(k))?, of(&at, Unknown::Yield(k))?)))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (k, (reach, force)) in all.into_iter().enumerate() {
        for (unknown, value) in [(Unknown::Reach(k), reach), (Unknown::Yield(k), force)] {
            if let Some(i) = layout.place(unknown) {
                at.q[i] = value;
            }
        }
    }
    at
}

/// The element that yields nearest to a deflection.
fn nearest(all: &[Element], reach: f64) -> Option<usize> {
    let far = |e: &Element| libm::log(e.reach / reach).abs();
    (0..all.len()).min_by(|a, b| far(&all[*a]).total_cmp(&far(&all[*b])))
}
