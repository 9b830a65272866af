//! From simple laws to richer ones: what is nested in a law is fitted first, and its answer is where the law starts.
//!
//! A law started from guesses alone can end far above a simpler one that is nested in it: a descent does not find the
//! bristles of an axis whose level and mass are still wrong. So Coulomb and viscous friction are fitted first, which almost
//! any start finds; bristles and a falling curve are put on top of that, each for itself, then both together. The nested
//! answers themselves, as the richer law can express them, bound its error from above.

use crate::law::terms::Terms;
use crate::law::{Law, LawKind};
use crate::output_error::Simulation;
use crate::output_error::places;
use crate::output_error::plant::Axis;
use crate::output_error::problem::Point;
use crate::output_error::run::Run;
use crate::output_error::search::{Found, Search};
use crate::output_error::start::{self, Scale};
use crate::output_error::unknowns::{Layout, Unknown};
use crate::watch::Watch;

/// Length, in samples, of the pieces of an open-loop run on which starting points are looked for.
const PIECE_SAMPLES: usize = 250;
/// Guesses that are followed by a short descent, and how many of their ends are followed on, for the law that is asked for.
const FOR_THE_LAW: [usize; 2] = [6, 2];
/// The same for a law below it, from which the answer need not be final.
const FOR_A_RUNG: [usize; 2] = [2, 1];
/// The same for other Stribeck curves on short pieces.
const FOR_CURVES: [usize; 2] = [6, 3];
/// Elements that are fitted first where fewer are asked for.
const MANY_ELEMENTS: usize = 8;
/// Most turns of other places and other curves, and the fall of the cost, as a part of it, that is worth another.
const MOST_TURNS: usize = 4;
const TURN_GAIN: f64 = 0.05;
/// Steps of a descent whose end is the starting point of another one.
const RUNG_STEPS: usize = 60;
/// Fs/Fc - 1 where a law with a Stribeck curve is to be one without.
const NO_FALL: f64 = 1e-6;
/// Damping over the critical one where a law with micro-damping is to be one without.
const NO_DAMPING: f64 = 1e-4;

/// What all rungs have in common.
pub(crate) struct Ladder<'a> {
    runs: &'a [Run],
    /// The runs in short pieces; empty where the runs are short themselves, and in closed loop.
    pieces: Vec<Run>,
    simulation: &'a Simulation<'a>,
    scale: &'a Scale,
}

/// A law that was fitted on the way.
struct Rung {
    law: Law,
    axis: Axis,
    found: Found,
}

impl<'a> Ladder<'a> {
    pub fn new(runs: &'a [Run], simulation: &'a Simulation<'a>, scale: &'a Scale) -> Self {
        let pieces: Vec<Run> = match simulation.controller {
            Some(_) => Vec::new(),
            None => runs
                .iter()
                .flat_map(|run| run.clone().cut(PIECE_SAMPLES))
                .collect(),
        };
        let pieces = match pieces.len() > runs.len() {
            true => pieces,
            false => Vec::new(),
        };
        Self {
            runs,
            pieces,
            simulation,
            scale,
        }
    }

    /// A search for the unknowns of a layout.
    pub fn search<'b>(&'b self, runs: &'b [Run], layout: &'b Layout) -> Search<'b> {
        Search {
            runs,
            layout,
            simulation: self.simulation,
            scale: self.scale,
        }
    }

    /// Fits a law by way of those nested in it; `None` without anything to start from.
    pub fn climb(&self, law: &Law, terms: &Terms, watch: &mut Watch) -> Option<Found> {
        let mut rungs: Vec<Rung> = Vec::new();
        for below in nested(law) {
            // Without a constant force of its own, the law of both directions could not be what the asymmetric one starts
            // from.
            let terms = Terms {
                offset: terms.offset || !below.asymmetric,
                ..terms.clone()
            };
            let layout = Layout::new(&below, &terms);
            if let Some(found) = self.rung(&below, &terms, &layout, (&rungs, FOR_A_RUNG), watch) {
                let axis = layout.write(&found.base, &found.descent.at.q);
                rungs.push(Rung {
                    law: below,
                    axis,
                    found,
                });
            }
            if watch.stopped {
                break;
            }
        }
        let layout = Layout::new(law, terms);
        let search = self.search(self.runs, &layout);
        let mut best = self.rung(law, terms, &layout, (&rungs, FOR_THE_LAW), watch)?;
        if law.kind.has_elements() {
            best = self.other_elements(&search, best, watch);
        }
        let best = self.not_worse(&search, best, law, &rungs, watch);
        let settled = search.settle(best, watch);
        // Weights and steps are others now.
        let weighed = (settled.weights, settled.substeps, settled.descent.cost);
        let best = self.not_worse(&search, settled, law, &rungs, watch);
        if (best.weights, best.substeps, best.descent.cost) == weighed {
            return Some(best);
        }
        Some(search.settle(best, watch))
    }

    /// Fits one law from all that is known of those below it.
    fn rung(
        &self,
        law: &Law,
        terms: &Terms,
        layout: &Layout,
        (rungs, follow): (&[Rung], [usize; 2]),
        watch: &mut Watch,
    ) -> Option<Found> {
        let search = self.search(self.runs, layout);
        let mut groups = vec![start::guesses(law, terms, layout, self.scale)];
        let known = self
            .simulation
            .start
            .and_then(|found| start::from_estimate(found, law, terms, layout, self.scale));
        groups.extend(known.map(|axis| around(axis, layout)));
        let below = rungs.iter().filter(|rung| is_next(&rung.law, law));
        groups.extend(below.map(|rung| {
            let axis = without_offset(&rung.axis, layout);
            self.built_on(&axis, &rung.law, law)
        }));
        groups.retain(|group| !group.is_empty());
        if watch.stopped {
            let axis = groups.pop()?.swap_remove(0);
            return Some(search.start(axis, watch));
        }
        // The simulation of a long run drifts away for any rough guess; on short pieces it does not.
        // Presliding of a few counts is only seen in the long run.
        let whole = search.best(&groups, follow, watch);
        let mut best = if self.pieces.is_empty() && whole.len() == 1 {
            whole.into_iter().next()?
        } else {
            let mut finalists: Vec<Vec<Axis>> =
                whole.iter().map(|found| vec![search.axis(found)]).collect();
            if !self.pieces.is_empty() {
                let short = self.search(&self.pieces, layout);
                let found = short.best(&groups, follow, watch);
                finalists.extend(found.iter().map(|found| vec![short.axis(found)]));
            }
            search.best(&finalists, [0, 1], watch).into_iter().next()?
        };
        if follow == FOR_A_RUNG {
            return Some(search.go_on(best, RUNG_STEPS, watch));
        }
        // A curve that falls over the whole range of speeds looks like less viscous friction, and a
        // search that began near it does not leave it.
        if has_curve(layout) && !watch.stopped {
            let here = search.axis(&best);
            let curves = self.other_curves(&here);
            let mut finalists = vec![vec![here]];
            // What elements remember is not known where a piece begins.
            if self.pieces.is_empty() || law.kind.has_elements() {
                finalists.push(curves);
            } else {
                let short = self.search(&self.pieces, layout);
                for found in short.best(&[curves], FOR_CURVES, watch) {
                    let found = short.go_on(found, RUNG_STEPS, watch);
                    finalists.push(vec![short.axis(&found)]);
                }
            }
            best = search
                .best(&finalists, [FOR_THE_LAW[0], 1], watch)
                .into_iter()
                .next()?;
        }
        Some(best)
    }

    /// The best so far, with elements at other places and, where they follow a curve, other curves, in turn.
    fn other_elements(&self, search: &Search, mut best: Found, watch: &mut Watch) -> Found {
        for _ in 0..MOST_TURNS {
            let before = best.descent.cost;
            best = places::elsewhere(search, best, watch);
            if !has_curve(search.layout) || watch.stopped {
                break;
            }
            let curves = self.other_curves(&search.axis(&best));
            let starts = best.descent.at.starts.clone();
            let found = places::best_of(search, curves, &starts, &best, watch);
            if let Some(found) = found.filter(|f| f.descent.cost < best.descent.cost) {
                best = found;
            }
            if best.descent.cost > (1.0 - TURN_GAIN) * before {
                break;
            }
        }
        best
    }

    /// The best so far, or where a descent from a nested law ends, if that law itself is better.
    fn not_worse(
        &self,
        search: &Search,
        mut best: Found,
        law: &Law,
        rungs: &[Rung],
        watch: &mut Watch,
    ) -> Found {
        for rung in rungs {
            if watch.stopped {
                break;
            }
            let axis = without_offset(&rung.axis, search.layout);
            let axis = self.expressed(&axis, &rung.law, law);
            let substeps = best.substeps.max(search.substeps(&axis));
            let problem = search.problem(&axis, substeps, best.weights);
            let at = Point {
                q: search.layout.read(&axis),
                starts: rung.found.descent.at.starts.clone(),
            };
            watch.counts.costs += 1;
            if problem.cost(&at, watch) < best.descent.cost {
                let found =
                    search.descend(axis, at.starts, substeps, best.weights, RUNG_STEPS, watch);
                if found.descent.cost < best.descent.cost {
                    best = found;
                }
            }
        }
        best
    }

    /// Guesses for a law from the answer of one below it: what the simpler law leaves open is tried over the range that the
    /// runs can show.
    fn built_on(&self, axis: &Axis, from: &Law, law: &Law) -> Vec<Axis> {
        let bristles = law.kind.has_bristle() && !from.kind.has_bristle();
        let curve = law.kind.has_stribeck() && !from.kind.has_stribeck();
        let mut out = vec![self.expressed(axis, from, law)];
        let elements = law.kind.has_elements() && !from.kind.has_elements();
        out.extend(match (bristles, elements) {
            (true, _) => start::with_bristles(axis, law, self.scale),
            (false, true) => start::with_elements(axis, law, self.scale),
            (false, false) => start::with_damping(axis, law, self.scale),
        });
        if curve {
            let here = out.clone();
            out.extend(here.iter().flat_map(|axis| self.other_curves(axis)));
        }
        out
    }

    /// The axis of a nested law as this one can express it.
    fn expressed(&self, axis: &Axis, from: &Law, law: &Law) -> Axis {
        let mut out = axis.clone();
        out.exponent = law.exponent;
        if law.kind.has_stribeck() && !from.kind.has_stribeck() {
            for side in &mut out.sides {
                side.fixed = (1.0 + NO_FALL) * side.coulomb;
                side.velocity = 0.1 * self.scale.speed;
            }
        }
        if law.kind.has_elements() {
            if from.kind.has_elements() {
                if let Some(elements) = &mut out.elements {
                    elements.all = places::joined(&elements.all, law.elements);
                    if !elements.attraction.is_finite() {
                        elements.attraction = 1.0 / self.scale.step;
                    }
                }
                out.follow_curves();
            } else if let Some(first) = start::with_elements(&out, law, self.scale).pop() {
                out = first;
            }
            if let Some(elements) = out.elements.as_mut().filter(|_| !law.kind.has_stribeck()) {
                elements.attraction = f64::INFINITY;
            }
        }
        if law.kind == LawKind::LuGre && out.micro_damping <= 0.0 {
            out.micro_damping = NO_DAMPING * 2.0 * (out.stiffness * out.mass).sqrt();
        }
        out
    }

    /// The same axis with other Stribeck curves.
    fn other_curves(&self, axis: &Axis) -> Vec<Axis> {
        let mut out = Vec::new();
        for part in [0.003, 0.01, 0.03, 0.1] {
            for excess in [0.1, 0.5] {
                // Where the curve fell over the whole speed range, its Coulomb level was never reached;
                // then most of its static level is used instead.
                for share in [0.0, 0.7] {
                    let mut other = axis.clone();
                    for side in &mut other.sides {
                        side.coulomb = side.coulomb.max(share * side.fixed.min(self.scale.force));
                        side.fixed = (1.0 + excess) * side.coulomb;
                        side.velocity = part * self.scale.speed;
                    }
                    other.follow_curves();
                    if share == 0.0
                        || other.sides != out.last().map_or(axis.sides, |o: &Axis| o.sides)
                    {
                        out.extend(start::with_attractions(&other, self.scale));
                    }
                }
            }
        }
        out
    }
}

/// The laws nested in this one, simplest first.
fn nested(law: &Law) -> Vec<Law> {
    let of = |kind, asymmetric| Law {
        kind,
        asymmetric,
        ..*law
    };
    let many = |mut below: Vec<Law>| {
        // Few elements stick at wrong places where many find theirs: they are fitted first, and joined.
        if law.kind.has_elements() && law.elements < MANY_ELEMENTS {
            let more = |kind| Law {
                elements: MANY_ELEMENTS,
                ..of(kind, law.asymmetric)
            };
            below.push(more(LawKind::MaxwellSlip));
            below.extend((law.kind == LawKind::Gms).then(|| more(LawKind::Gms)));
        }
        below
    };
    let families: &[LawKind] = match law.kind {
        LawKind::CoulombViscous => &[],
        LawKind::Stribeck | LawKind::Dahl => &[LawKind::CoulombViscous],
        LawKind::MaxwellSlip => &[LawKind::CoulombViscous, LawKind::Dahl],
        LawKind::Gms => &[LawKind::CoulombViscous, LawKind::Stribeck, LawKind::Dahl],
        _ => &[LawKind::CoulombViscous, LawKind::Stribeck, LawKind::Dahl],
    };
    if !law.asymmetric {
        return many(families.iter().map(|&kind| of(kind, false)).collect());
    }
    // The same in both directions first: from there each direction needs only what sets it apart.
    let mut out = vec![of(LawKind::CoulombViscous, false)];
    out.extend(families.iter().map(|&kind| of(kind, true)));
    many(out)
}

/// Whether no other rung stands between two laws.
fn is_next(below: &Law, law: &Law) -> bool {
    match below.kind {
        LawKind::CoulombViscous => match law.kind {
            LawKind::CoulombViscous => below.asymmetric != law.asymmetric,
            LawKind::Stribeck | LawKind::Dahl => below.asymmetric == law.asymmetric,
            _ => false,
        },
        _ => true,
    }
}

/// An axis as a law without a constant force of its own can express it: the difference of the directions is that force.
fn without_offset(axis: &Axis, layout: &Layout) -> Axis {
    let mut out = axis.clone();
    let one_level_each = layout.unknowns.iter().any(|u| match u {
        Unknown::Coulomb(side) => side.index() == 1,
        Unknown::Ratio => true,
        _ => false,
    });
    if layout.place(Unknown::Offset).is_none() && one_level_each {
        for (side, sign) in out.sides.iter_mut().zip([1.0, -1.0]) {
            let level = (side.coulomb + sign * axis.offset).max(0.1 * side.coulomb);
            side.fixed *= level / side.coulomb;
            side.coulomb = level;
        }
        out.follow_curves();
        out.offset = 0.0;
    }
    out
}

/// A known axis, and the same with other bristle parameters: those are the ones that an
/// equation-error fit determines worst.
fn around(axis: Axis, layout: &Layout) -> Vec<Axis> {
    let mut out = vec![axis.clone()];
    if layout.place(Unknown::Stiffness).is_some() {
        for factor in [0.1, 10.0] {
            let mut other = axis.clone();
            other.stiffness *= factor;
            other.micro_damping *= libm::sqrt(factor);
            out.push(other);
        }
    }
    out
}

fn has_curve(layout: &Layout) -> bool {
    let falls = |u: &Unknown| matches!(u, Unknown::Velocity(_));
    layout.unknowns.iter().any(falls)
}
