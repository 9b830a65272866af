//! The law that was asked for, or the one that the data choose.

use super::heard::Heard;
use super::ladder::{self, Candidate, Climb, Ladder, Rung};
use stiction_files::result::{BetterLaw, LawEntry};
use stiction_identify as engine;
use stiction_identify::{Estimate, Law, LawKind, Observer, Optimum, Settings, Status};
use stiction_parameters::Quantity;
use stiction_policy::{choice, effect};

/// The families that the data choose from.
pub(super) const FAMILIES: [LawKind; 3] = [LawKind::CoulombViscous, LawKind::Dahl, LawKind::LuGre];

/// Elements with which a law of elements is tried beside one with a bristle: whether they hold better shows with few (of six servo logs
/// each, with 4 to 8 elements of its own choice), and to choose their number takes most of the time of such a fit.
const TRIAL_ELEMENTS: usize = 4;

/// Why a law that holds static friction at Coulomb friction is not taken where the axis rests.
const SHOWN_BY_THE_COUNTS: &str =
    "the counts of the encoder show a static friction above Coulomb friction";

/// A fitted law and the laws it was compared with.
pub(super) struct Choice {
    pub estimate: Estimate,
    /// Empty where laws were not compared, or not to the end.
    pub laws: Vec<LawEntry>,
    /// Who chose the law, as written to `result.json`.
    pub by: &'static str,
    /// The best of the others that a compensator may rely on, where the law was asked for.
    pub better: Option<BetterLaw>,
    /// Rms residual on held-out samples of the record, where it was cross-validated.
    pub held_out_rmse: Option<f64>,
    /// What of the law is left out, as written to `result.json`.
    pub without: Vec<String>,
    /// Laws with fewer parameters that were fitted beside.
    pub simpler: Vec<Estimate>,
}

impl Choice {
    /// A law that was asked for and compared with none.
    pub fn alone(estimate: Estimate) -> Self {
        Self {
            without: ladder::without(&estimate.law),
            estimate,
            laws: Vec::new(),
            by: "user",
            better: None,
            held_out_rmse: None,
            simpler: Vec::new(),
        }
    }
}

/// Fits the law that was asked for and, if wanted, others beside it, of which `fitted` are already.
pub(super) fn asked(
    law: Law,
    ladder: &Ladder,
    fitted: &[(Estimate, Optimum)],
    compare: bool,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Choice, engine::Error> {
    let own = ladder.fit(&ladder.usual(law), settings, observer)?;
    Ok(beside(own, fitted, ladder, compare, settings, observer))
}

/// States a law that was asked for and fitted and, if wanted, fits others beside it.
pub(super) fn fitted_already(
    own: (Estimate, Optimum),
    ladder: &Ladder,
    compare: bool,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Choice {
    beside(own, &[], ladder, compare, settings, observer)
}

fn beside(
    (estimate, optimum): (Estimate, Optimum),
    fitted: &[(Estimate, Optimum)],
    ladder: &Ladder,
    compare: bool,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Choice {
    let law = estimate.law;
    let mut held_out_rmse = None;
    let mut better = None;
    let mut simpler = Vec::new();
    let laws = if compare && optimum.status != Status::Interrupted {
        let others = fitted.iter().map(|(estimate, optimum)| (estimate, optimum));
        let known: Vec<_> = others.chain([(&estimate, &optimum)]).collect();
        let others: Vec<Candidate> = ladder::beside(&law)
            .into_iter()
            .map(|law| ladder.usual(law))
            .collect();
        let climb = ladder.climb(&others, &known, settings, observer);
        // A table with only some of the laws could name the wrong one as best.
        if climb.stopped {
            Vec::new()
        } else {
            let mut laws = climb.entries().0;
            for (entry, rung) in laws.iter_mut().zip(&climb.rungs) {
                entry.reported = rung.estimate.law == law;
                if entry.reported {
                    held_out_rmse = rung.cross_validated_rmse(ladder);
                }
            }
            let able = (0..laws.len()).filter(|&i| laws[i].held_back.is_none());
            let best = climb.best_of(&able.collect::<Vec<_>>());
            let holds = |law: &&LawEntry| {
                let error = law.held_out_error_percent;
                error.is_none_or(|error| error < choice::MAX_HELD_OUT_PERCENT)
            };
            let best = best.map(|i| &laws[i]);
            let best = best.filter(|best| !best.reported).filter(holds);
            better = best.map(|best| BetterLaw {
                law: best.law.clone(),
                asymmetric: best.asymmetric,
            });
            let own = laws.iter().find(|own| own.reported);
            simpler = climb.simpler_than(own.map_or(0, |own| own.parameters));
            laws
        }
    } else {
        Vec::new()
    };
    let without = ladder::without(&estimate.law);
    let estimate = stated(ladder, &optimum, estimate, observer);
    Choice {
        estimate,
        laws,
        by: "user",
        better,
        held_out_rmse,
        without,
        simpler,
    }
}

/// Fits the laws that can be exported, each with what it holds, and takes the best that a compensator may rely on.
///
/// In rounds, so that only laws are fitted that may turn out best: Coulomb and viscous friction, which cost next to nothing, say
/// whether the directions differ by so much that only laws with parameters for each are asked; then the other families, each with
/// and without quadratic viscous friction; what these leave open held at nothing, and asymmetric laws of the families that hold
/// best; the same of the best asymmetric one; the best of all with its Stribeck exponent fitted. A law that leaves more than the
/// same with something held is fitted again from there after each round.
pub(super) fn auto(
    base: Law,
    ladder: &Ladder,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Choice, engine::Error> {
    let linear = ladder::symmetric(base, &FAMILIES[..1])[0];
    let bristles = ladder::symmetric(base, &FAMILIES[1..]);
    let fitted = |laws: &[Law], observer: &mut dyn Observer| {
        let laws: Vec<Candidate> = laws.iter().map(|law| ladder.usual(*law)).collect();
        ladder.climb(&laws, &[], settings, observer)
    };
    let both = [linear, linear.asymmetric()];
    let directions = if ladder.symmetric { &both[..1] } else { &both };
    let mut climb = fitted(directions, observer);
    if !climb.stopped {
        let directed = directions_differ(&climb);
        let next = bristles.iter().map(|law| match directed {
            true => law.asymmetric(),
            false => *law,
        });
        let next: Vec<Law> = next.collect();
        climb = climb.and(fitted(&next, observer));
    }
    for round in [bent, second, third] {
        if climb.stopped {
            break;
        }
        let mut next = round(&climb, ladder);
        next.retain(|candidate| !climb.has(candidate));
        let more = ladder.climb(&next, &[], settings, observer);
        climb = caught_up(climb.and(more), ladder, settings, observer);
    }
    // A fit of the force sees another curve in every rest, and must not choose by it.
    let rests = engine::rests_much(ladder.record);
    if !climb.stopped
        && !rests
        && let Some(next) = shaped(&climb, ladder)
        && let Ok((estimate, optimum)) = ladder.fit(&next, settings, observer)
        && is_another_shape(&estimate, base.exponent)
    {
        let known = [(&estimate, &optimum)];
        let freer = damped(&climb, &next.law, ladder);
        let next: Vec<Candidate> = [next].into_iter().chain(freer).collect();
        let more = ladder.climb(&next, &known, settings, observer);
        climb = climb.and(more);
    }
    let climb = climb.sorted();
    let (mut laws, best) = climb.entries();
    let Some(best) = best else {
        // Not one could be fitted: the simplest says why.
        let simplest = ladder::symmetric(base, &[LawKind::CoulombViscous])[0];
        return asked(simplest, ladder, &[], false, settings, observer);
    };
    let counted = match rests && !climb.stopped {
        true => of_the_counts(&climb, &laws, best, ladder, observer),
        false => None,
    };
    let at = counted.as_ref().map_or(best, |(at, _)| *at);
    if at != best {
        laws[best].held_back = Some(SHOWN_BY_THE_COUNTS.into());
    }
    laws[at].reported = true;
    let simpler = climb.simpler_than(laws[at].parameters);
    let Climb { mut rungs, stopped } = climb;
    let held_out = laws.iter().any(|law| law.held_out_error_percent.is_some());
    // Too few samples may be left to hold some out.
    let by = if held_out { "cross-validation" } else { "bic" };
    let as_good: Vec<bool> = (laws.iter())
        .map(|law| law.as_good && law.held_back.is_none() && !law.reported)
        .collect();
    let others = rungs.iter().zip(as_good).filter(|(_, as_good)| *as_good);
    let others: Vec<Estimate> = others.map(|(rung, _)| rung.estimate.clone()).collect();
    let rung = rungs.swap_remove(at);
    let held_out_rmse = rung.cross_validated_rmse(ladder);
    let without = laws[at].without.clone();
    let Rung {
        estimate, optimum, ..
    } = rung;
    let mut estimate = match counted {
        Some((_, estimate)) => estimate,
        None => stated(ladder, &optimum, estimate, observer),
    };
    estimate = estimate.with_range_over(&others);
    if !stopped && shape_is_left(&estimate) {
        let kind = match estimate.law.has_stribeck() {
            true => LawKind::Gms,
            false => LawKind::MaxwellSlip,
        };
        let elements: Vec<Candidate> = ladder::symmetric(base, &[kind])
            .into_iter()
            .map(|law| Law {
                elements: TRIAL_ELEMENTS,
                ..law
            })
            .map(|law| ladder.usual(law))
            .collect();
        let more = ladder.climb(&elements, &[], settings, observer);
        let entries = more.entries().0.into_iter();
        laws.extend(entries.map(|entry| LawEntry {
            best: false,
            as_good: false,
            // Of the elements alone they say nothing beside the others.
            held_out_excess_percent: None,
            held_out_excess_std_percent: None,
            aic_difference: None,
            bic_difference: None,
            ..entry
        }));
    }
    if stopped {
        // Not all laws were tried, so even a converged one is only the best so far.
        estimate = estimate.interrupted();
    }
    Ok(Choice {
        estimate,
        laws: if stopped { Vec::new() } else { laws },
        by,
        better: None,
        held_out_rmse,
        without,
        simpler,
    })
}

/// Whether what a law with one bristle leaves looks like friction of another shape.
fn shape_is_left(estimate: &Estimate) -> bool {
    let mut effects = estimate.effects.iter();
    let bends = effects.any(|found| found.effect == engine::Effect::Bristles);
    let kind = estimate.law.kind;
    let bristle = kind.has_bristle() && !kind.has_elements();
    bristle && bends && estimate.terms.dependences.is_empty()
}

/// Whether a law is another one with less held: micro-damping, the Stribeck curve or its exponent. Dahl is LuGre that holds all
/// of them.
fn holds_less(law: &Law, than: &Law) -> bool {
    let held = |law: &Law| {
        [
            !law.has_stribeck(),
            !law.has_micro_damping(),
            !law.exponent_fitted,
        ]
    };
    let parts = || held(law).into_iter().zip(held(than));
    let family = |law: &Law| match law.kind {
        LawKind::Dahl => LawKind::LuGre,
        kind => kind,
    };
    family(law) == family(than)
        && law.asymmetric == than.asymmetric
        && parts().all(|(own, other)| other || !own)
        && parts().any(|(own, other)| other && !own)
}

/// Whether Coulomb and viscous friction of each direction hold clearly better than those of both.
fn directions_differ(climb: &Climb) -> bool {
    let of = |asymmetric: bool| {
        let own = climb
            .rungs
            .iter()
            .find(|rung| rung.estimate.law.asymmetric == asymmetric);
        own.map_or(f64::INFINITY, Rung::held_out_error)
    };
    of(true) < choice::MAX_NAMED_RICHER_ERROR * of(false)
}

/// The laws so far with quadratic viscous friction: without it a Stribeck curve bends a viscous line that is none. A Stribeck curve of
/// each direction beside viscous friction that bends leaves no level that is known.
fn bent<'a>(climb: &Climb, ladder: &'a Ladder) -> Vec<Candidate<'a>> {
    let is_known = |rung: &&Rung| {
        let law = &rung.estimate.law;
        !(law.asymmetric && law.has_stribeck())
    };
    let rungs = climb.rungs.iter().filter(is_known);
    let bent = |rung: &Rung| Some(ladder.bent(rung.estimate.law)?.from(&[rung]));
    rungs.filter_map(bent).collect()
}

/// What the symmetric laws suggest: LuGre with what it leaves open held at nothing, and the families that hold best with
/// parameters for each direction.
fn second<'a>(climb: &Climb, ladder: &'a Ladder) -> Vec<Candidate<'a>> {
    let mut next = held(climb, ladder, false);
    let errors = climb.rungs.iter().map(Rung::held_out_error);
    let least = errors.fold(f64::INFINITY, f64::min);
    let close = |rung: &&Rung| choice::MAX_NAMED_RICHER_ERROR * rung.held_out_error() <= least;
    // Coulomb and viscous friction stays linear, so it costs next to nothing.
    let wanted = |rung: &&Rung| match rung.estimate.law.kind {
        LawKind::CoulombViscous => true,
        LawKind::Dahl => close(rung),
        _ => close(rung) && !rung.estimate.terms.quadratic_viscous,
    };
    let symmetric = climb
        .rungs
        .iter()
        .filter(|rung| !rung.estimate.law.asymmetric && !ladder.symmetric);
    for rung in symmetric.filter(wanted) {
        let candidate = ladder.as_beside(rung.estimate.law.asymmetric(), rung);
        next.push(candidate.from(&[rung]));
    }
    next
}

/// The best of all laws so far, where it is asymmetric LuGre, with what it leaves open held at nothing.
fn third<'a>(climb: &Climb, ladder: &'a Ladder) -> Vec<Candidate<'a>> {
    let (_, best) = climb.entries();
    let best = best.map(|best| climb.rungs[best].estimate.law);
    match best {
        Some(law) if law.asymmetric && law.kind == LawKind::LuGre => held(climb, ladder, true),
        _ => Vec::new(),
    }
}

/// The best law so far with its Stribeck exponent fitted, where the data show the curve.
fn shaped<'a>(climb: &Climb, ladder: &'a Ladder) -> Option<Candidate<'a>> {
    let (_, best) = climb.entries();
    let rung = &climb.rungs[best?];
    let shown = |quantity| !rung.leaves_open(quantity);
    let shows = shown(Quantity::Static) && shown(Quantity::StribeckVelocity);
    shows.then(|| curved(rung, ladder)).flatten()
}

/// The same law with the micro-damping that it holds at nothing: under a curve that was not the axis's it seemed to have none.
fn damped<'a>(climb: &Climb, law: &Law, ladder: &'a Ladder) -> Option<Candidate<'a>> {
    let is_damped = |rung: &&Rung| {
        let own = &rung.estimate.law;
        own.kind == law.kind && own.asymmetric == law.asymmetric && !own.undamped && !own.flat
    };
    let rung = climb.rungs.iter().find(is_damped);
    rung.filter(|_| law.undamped)
        .and_then(|rung| curved(rung, ladder))
}

/// A fitted law with its Stribeck exponent fitted too.
fn curved<'a>(rung: &Rung, ladder: &'a Ladder) -> Option<Candidate<'a>> {
    let law = rung.estimate.law;
    let asks = ladder.exponent_is_open && law.has_stribeck() && !law.exponent_fitted;
    let candidate = ladder.as_beside(law.with_fitted_exponent(), rung);
    asks.then(|| candidate.from(&[rung]))
}

/// Whether a fitted exponent is surely another one than that which is assumed.
fn is_another_shape(fitted: &Estimate, assumed: f64) -> bool {
    let exponent = fitted.parameter(Quantity::StribeckExponent);
    exponent.filter(|p| p.identifiable).is_some_and(|p| {
        let off = libm::log(p.value / assumed).abs();
        off > effect::MIN_EXPONENT_ERROR
            && p.std
                .is_some_and(|std| off > choice::MIN_EXPONENT_DEVIATIONS * std / p.value)
    })
}

/// LuGre with what it leaves open held at nothing.
fn held<'a>(climb: &Climb, ladder: &'a Ladder, asymmetric: bool) -> Vec<Candidate<'a>> {
    let of = |kind: LawKind| {
        let is = |rung: &&Rung| {
            rung.estimate.law.kind == kind && rung.estimate.law.asymmetric == asymmetric
        };
        let own = climb.rungs.iter().filter(is);
        own.min_by(|a, b| a.held_out_error().total_cmp(&b.held_out_error()))
    };
    let Some(lugre) = of(LawKind::LuGre) else {
        return Vec::new();
    };
    let law = lugre.estimate.law;
    let mut next = Vec::new();
    if lugre.leaves_open(Quantity::Static) || lugre.leaves_open(Quantity::StribeckVelocity) {
        let near: Vec<&Rung> = [Some(lugre), of(LawKind::Dahl)]
            .into_iter()
            .flatten()
            .collect();
        next.push(ladder.as_beside(law.flat(), lugre).from(&near));
    }
    if lugre.leaves_open(Quantity::Sigma1) {
        next.push(ladder.as_beside(law.undamped(), lugre).from(&[lugre]));
    }
    next
}

/// Laws that leave more than the same law with something held, fitted again from there.
fn caught_up(
    mut climb: Climb,
    ladder: &Ladder,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Climb {
    let cost = |rung: &Rung| rung.optimum.evaluation.cost;
    let mut missed = Vec::new();
    for (at, rung) in climb.rungs.iter().enumerate() {
        let law = rung.estimate.law;
        let holds_more = |other: &&Rung| {
            let own = other.estimate.law;
            let is_held = own.flat && own == law.flat() || own.undamped && own == law.undamped();
            let bent = |rung: &Rung| rung.estimate.terms.quadratic_viscous;
            is_held
                && bent(other) == bent(rung)
                && cost(other) < choice::MAX_SIMPLER_COST * cost(rung)
        };
        let nearest = climb.rungs.iter().filter(holds_more);
        let nearest = nearest.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        if let Some(nearest) = nearest {
            let mut again = ladder.as_beside(law, rung);
            again.starts = nearest.optimum.starts_within(&rung.optimum).into();
            missed.push((at, again));
        }
    }
    let (places, again): (Vec<usize>, Vec<Candidate>) = missed.into_iter().unzip();
    if again.is_empty() || climb.stopped {
        return climb;
    }
    let more = ladder.climb(&again, &[], settings, observer);
    climb.stopped |= more.stopped;
    for (at, rung) in places.into_iter().zip(more.rungs) {
        let is_of_it = rung.estimate.law == climb.rungs[at].estimate.law;
        if is_of_it && cost(&rung) < cost(&climb.rungs[at]) {
            climb.rungs[at] = rung;
        }
    }
    climb
}

/// The estimate with its intervals in full, unless the search was interrupted.
fn stated(
    ladder: &Ladder,
    optimum: &Optimum,
    mut estimate: Estimate,
    observer: &mut dyn Observer,
) -> Estimate {
    if estimate.status != Status::Interrupted {
        let mut heard = Heard::new(observer);
        engine::intervals(ladder.record, optimum, &mut estimate, &mut heard);
        if heard.stopped {
            // What its intervals lack is not told from what they have.
            estimate = estimate.interrupted();
        }
    }
    estimate
}

/// What the counts say of static friction where the law that was chosen by the force, at this place, holds it at Coulomb friction. A fit
/// of the force passes over what happens within a count or two of a rest; the counts do not, and what they see of a rise that the law
/// lacks they give to the stiffness of the bristles. The law that shows it, and its estimate.
fn of_the_counts(
    climb: &Climb,
    laws: &[LawEntry],
    at: usize,
    ladder: &Ladder,
    observer: &mut dyn Observer,
) -> Option<(usize, Estimate)> {
    let own = &climb.rungs[at];
    let law = &own.estimate.law;
    let most = choice::MAX_CERTAIN_ERROR * own.held_out_error();
    let is_as_good = |&i: &usize| {
        let rung = &climb.rungs[i];
        let other = &rung.estimate.law;
        let frees = other.has_stribeck() && !law.has_stribeck() && holds_less(other, law);
        frees && laws[i].held_back.is_none() && rung.held_out_error() <= most
    };
    let able: Vec<usize> = (0..climb.rungs.len()).filter(is_as_good).collect();
    let at = climb.best_of(&able)?;
    let Rung {
        estimate, optimum, ..
    } = &climb.rungs[at];
    let estimate = stated(ladder, optimum, estimate.clone(), observer);
    let mut levels = estimate.parameters.iter();
    let determined = levels.all(|p| p.name.quantity != Quantity::Static || p.identifiable);
    let shows = determined && estimate.of_the_counts && estimate.status != Status::Interrupted;
    shows.then_some((at, estimate))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dahl_is_lugre_that_holds_curve_and_damping() {
        let [dahl, lugre, stribeck] =
            [LawKind::Dahl, LawKind::LuGre, LawKind::Stribeck].map(Law::new);
        for freer in [lugre, lugre.flat(), lugre.undamped()] {
            assert!(holds_less(&freer, &dahl) && !holds_less(&dahl, &freer));
        }
        for other in [dahl, lugre.asymmetric(), stribeck] {
            assert!(!holds_less(&other, &dahl));
        }
    }
}
