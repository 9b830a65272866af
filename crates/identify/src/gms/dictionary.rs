//! Where the elements are (their yield deflections), found without starting values.

use crate::law::{Law, Layout};
use crate::separable::objective::Evaluation;
use crate::separable::search_box::SearchBox;

/// An element: the logarithm of its yield deflection, and its yield force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Atom {
    pub place: f64,
    pub force: f64,
}

/// The unknowns of a law with this curve and these yield deflections.
pub(super) fn unknowns(curve: &[f64], places: impl IntoIterator<Item = f64>) -> Vec<f64> {
    curve.iter().copied().chain(places).collect()
}

/// Equal steps through the range of the yield deflections of a box, half a step from its ends.
pub(super) fn places(bounds: &SearchBox, layout: &Layout, many: usize) -> Vec<f64> {
    let Some(first) = layout.yields().next() else {
        return Vec::new();
    };
    steps(bounds.low(first), bounds.high(first), many)
}

/// Equal steps from `low` to `high`, half a step from both.
pub(crate) fn steps(low: f64, high: f64, many: usize) -> Vec<f64> {
    (0..many)
        .map(|i| low + (i as f64 + 0.5) / many as f64 * (high - low))
        .collect()
}

/// The elements to which a trial gives a yield force, by their yield deflection. If no element explains
/// the force, one element without force is returned, so that the fit can report this.
pub(super) fn atoms(law: &Law, p: &[f64], at: &Evaluation) -> Vec<Atom> {
    let places = &p[law.layout().yields()];
    let mut out: Vec<Atom> = places
        .iter()
        .zip(&at.solution.coefficients)
        .filter(|(_, c)| **c > 0.0)
        .map(|(&place, &force)| Atom { place, force })
        .collect();
    out.sort_by(|a, b| a.place.total_cmp(&b.place));
    if out.is_empty() {
        let middle = places.get(places.len() / 2).copied().unwrap_or(0.0);
        out.push(Atom {
            place: middle,
            force: 0.0,
        });
    }
    out
}

/// Joins neighbours until no more than `most` are left; each time the pair is joined that moves the
/// smallest force over the shortest distance.
pub(crate) fn join(mut atoms: Vec<Atom>, most: usize) -> Vec<Atom> {
    while atoms.len() > most.max(1) {
        let loss = |pair: &[Atom]| {
            let way = pair[1].place - pair[0].place;
            let force = pair[0].force + pair[1].force;
            pair[0].force * pair[1].force / force * way * way
        };
        let mut at = 0;
        for i in 1..atoms.len() - 1 {
            if loss(&atoms[i..i + 2]) < loss(&atoms[at..at + 2]) {
                at = i;
            }
        }
        let right = atoms.remove(at + 1);
        let left = &mut atoms[at];
        let force = left.force + right.force;
        left.place = (left.force * left.place + right.force * right.place) / force;
        left.force = force;
    }
    atoms
}
