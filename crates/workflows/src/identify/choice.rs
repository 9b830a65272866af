//! The law that was asked for, or the one that the data choose.

use super::heard::Heard;
use super::ladder::{self, Candidate, Climb, Ladder, Rung};
use super::stated::EXPONENT_APART;
use super::trust::{RICHER_LAW_WINS_BELOW, SIMPLER_LAW_WINS_FROM};
use super::unfit;
use stiction_files::result::{BetterLaw, LawEntry};
use stiction_identify as engine;
use stiction_identify::{Delay, Estimate, Law, LawKind, Observer, Optimum, Settings, Status};
use stiction_parameters::{Quantity, Side};

/// The families that the data choose from.
pub(super) const FAMILIES: [LawKind; 4] = [
    LawKind::CoulombViscous,
    LawKind::Stribeck,
    LawKind::Dahl,
    LawKind::LuGre,
];

/// The same in standard deviations.
const SURELY: f64 = 3.0;

/// Why bristle and mass are open where no delay that is looked for fits: what is late, and how, decides most about the slopes of
/// reversals, and viscous friction of a late force looks like a part of the inertia.
const BEYOND_ALL_DELAYS: &str = "the delay of the force came out at the end of those that are looked for, and it moves stiffness \
                                 and damping of the bristles, viscous friction and the mass more than all else";

/// Why static friction is open there too, where the Stribeck velocity is.
const AN_END_BESIDE_IT: &str = "is where a curve ends whose Stribeck velocity is open, and the delay of the force came out at the end \
                                of those that are looked for";

/// Why the delay is open behind a low-pass that was undone: either may be a part of the other.
const BESIDE_A_LOW_PASS: &str = "what the low-pass of the logged force delays and what is late beside it are known together, not each of them";

/// Why what describes the shape of a law is no constant where that shape holds worse than a simpler one.
const ANOTHER_SHAPE: &str =
    "depends on the shape of the law, and a simpler one holds better on held-out samples";

/// Why the best law is not the one that is reported.
const AT_AN_END: &str =
    "one of its parameters came out at the end of what is searched, and another law holds as well";

/// Why a law that holds static friction at Coulomb friction is not taken where the axis rests.
const SHOWN_BY_THE_COUNTS: &str =
    "the counts of the encoder show a static friction above Coulomb friction";

/// Why the stiffness is open beside a micro-damping that is held at none.
const HELD_WITH_DAMPING: &str = "takes up what micro-damping gives, which the law holds at none: with that fitted too it is open";

/// Why the bristles are open where the counts are asked of a law that holds static friction, and do not determine it.
const HELD_FROM_THE_COUNTS: &str = "the counts of the encoder, which this is from, do not tell whether static friction is above Coulomb \
                                    friction, where the law holds it; the bristles would make up for it";

/// Error on held-out samples, percent, from which on a law says nothing of them: as much as without any force.
const NOTHING_HOLDS: f64 = 100.0;

/// A fitted law and the laws it was compared with.
pub(super) struct Choice {
    pub estimate: Estimate,
    /// Empty where laws were not compared, or not to the end.
    pub laws: Vec<LawEntry>,
    /// Who chose the law, as written to `result.json`.
    pub by: &'static str,
    /// Why a compensator should not rely on it.
    pub held_back: Option<String>,
    /// The best of the others that a compensator may rely on, where the law was asked for.
    pub better: Option<BetterLaw>,
    /// Rms residual on held-out samples of the record, where it was cross-validated.
    pub held_out_rmse: Option<f64>,
    /// What of the law is left out, as written to `result.json`.
    pub without: Vec<String>,
}

impl Choice {
    /// A law that was asked for and compared with none.
    pub fn alone(estimate: Estimate) -> Self {
        Self {
            held_back: unfit::unseen_force(&estimate),
            without: ladder::without(&estimate.law, false),
            estimate,
            laws: Vec::new(),
            by: "user",
            better: None,
            held_out_rmse: None,
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
                error.is_none_or(|error| error < NOTHING_HOLDS)
            };
            let best = best.map(|i| &laws[i]);
            let best = best.filter(|best| !best.reported).filter(holds);
            better = best.map(|best| BetterLaw {
                law: best.law.clone(),
                asymmetric: best.asymmetric,
            });
            laws
        }
    } else {
        Vec::new()
    };
    let held_back = unfit::unseen_force(&estimate);
    let without = ladder::without(&estimate.law, false);
    let mut estimate = stated(ladder, &optimum, estimate, observer);
    let of_one_bristle = fitted
        .iter()
        .map(|(one, _)| one)
        .find(|one| !one.law.kind.has_elements());
    if let Some(one) = of_one_bristle.filter(|_| law.kind.has_elements())
        && estimate.fit.rmse > HARDLY_LESS * one.fit.rmse
    {
        estimate.doubt(|p| {
            let level = [Quantity::Coulomb, Quantity::Sigma2].contains(&p.name.quantity);
            (level || is_of_the_shape(p.name.quantity)).then_some(AS_ONE_BRISTLE)
        });
    }
    if simpler_shape_holds_better(&laws) {
        estimate.doubt(|p| is_of_the_shape(p.name.quantity).then_some(ANOTHER_SHAPE));
    }
    Choice {
        estimate,
        laws,
        by: "user",
        held_back,
        better,
        held_out_rmse,
        without,
    }
}

/// What elements leave, in parts of what one bristle leaves, from which on they describe hardly more: of simulated axes with elements
/// they leave up to .43 of it, beside springs and resonances .85 to .93.
const HARDLY_LESS: f64 = 0.7;
const AS_ONE_BRISTLE: &str = "several elements leave hardly less than one bristle does: what that leaves has another cause, which this may take up";

/// Whether a law of another family, with fewer parameters than the one that is reported, holds better on held-out samples.
fn simpler_shape_holds_better(laws: &[LawEntry]) -> bool {
    let Some(own) = laws.iter().find(|law| law.reported) else {
        return false;
    };
    let better = |other: &LawEntry| {
        let errors = own.held_out_error_percent.zip(other.held_out_error_percent);
        errors.is_some_and(|(mine, least)| {
            least < NOTHING_HOLDS && mine > SIMPLER_LAW_WINS_FROM * least
        })
    };
    laws.iter()
        .any(|other| other.law != own.law && other.parameters < own.parameters && better(other))
}

/// Whether a quantity describes the shape of presliding or of the Stribeck curve in any family of laws.
fn is_of_the_shape(quantity: Quantity) -> bool {
    let of_one_family = [Quantity::BreakawayRatio, Quantity::Attraction];
    quantity.is_of_the_shape() || of_one_family.contains(&quantity) || quantity.is_of_an_element()
}

/// Fits the laws that can be exported, each with what it holds, and takes the best that a compensator may rely on.
///
/// In rounds, so that only laws are fitted that may turn out best: the symmetric ones; what these leave open held at
/// nothing, and asymmetric laws of the families that hold best; the same of the best asymmetric one; the best of all with
/// its static friction kept below what the log shows, where it is above that; the best of all with its Stribeck exponent
/// fitted. A law that leaves more than the same with something held is fitted again from there after each round.
pub(super) fn auto(
    base: Law,
    ladder: &Ladder,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Choice, engine::Error> {
    let first: Vec<Candidate> = ladder::symmetric(base, &FAMILIES)
        .into_iter()
        .map(|law| ladder.usual(law))
        .collect();
    let mut climb = ladder.climb(&first, &[], settings, observer);
    for round in [second, third, capped] {
        if climb.stopped {
            break;
        }
        let next = round(&climb, ladder);
        let more = ladder.climb(&next, &[], settings, observer);
        climb = caught_up(climb.and(more), ladder, settings, observer);
    }
    let mut unsure = None;
    // A fit of the force sees another curve in every rest, and must not choose by it.
    let rests = engine::rests_much(ladder.record);
    if !climb.stopped
        && !rests
        && let Some(next) = shaped(&climb, ladder)
        && let Ok((estimate, optimum)) = ladder.fit(&next, settings, observer)
    {
        match shape(&estimate, base.exponent) {
            Shape::AsAssumed => {}
            Shape::Unknown => unsure = Some(estimate),
            Shape::Another => {
                let known = [(&estimate, &optimum)];
                let freer = damped(&climb, &next.law, ladder);
                let next: Vec<Candidate> = [next].into_iter().chain(freer).collect();
                let more = ladder.climb(&next, &known, settings, observer);
                climb = climb.and(more);
            }
        }
    }
    let climb = climb.sorted();
    let (mut laws, best) = climb.entries();
    let Some(best) = best else {
        // Not one could be fitted: the simplest says why.
        let simplest = ladder::symmetric(base, &[LawKind::CoulombViscous])[0];
        return asked(simplest, ladder, &[], false, settings, observer);
    };
    let at = reliable(&climb, &laws, best);
    let left_aside = at != best && laws[best].held_back.is_none();
    let asked = match rests && !climb.stopped {
        true => of_the_counts(&climb, &laws, at, ladder, observer),
        false => None,
    };
    let by_the_force = at;
    let at = match &asked {
        Some(asked) if asked.shows => asked.at,
        _ => by_the_force,
    };
    laws[at].reported = true;
    let Climb { mut rungs, stopped } = climb;
    let held_out = laws.iter().all(|law| law.held_out_error_percent.is_some());
    // Too few samples may be left to hold some out.
    let by = if held_out { "cross-validation" } else { "bic" };
    let before = rungs[at].estimate.clone();
    let capped = rungs[at].capped;
    let is_freer = |rung: &&Rung| {
        let law = &rung.estimate.law;
        holds_less(law, &before.law) || capped && !rung.capped && *law == before.law
    };
    let fitted = rungs.iter().filter(is_freer).map(|rung| &rung.estimate);
    let unsure = unsure.filter(|other| holds_less(&other.law, &before.law));
    let freer: Vec<Estimate> = fitted.cloned().chain(unsure).collect();
    let passed_over = (0..rungs.len()).any(|i| {
        let (own, other) = (&rungs[at], &rungs[i]);
        let (law, fuller) = (&own.estimate.law, &other.estimate.law);
        law.flat
            && !fuller.flat
            && law.kind == fuller.kind
            && laws[i].held_back.is_some()
            && other.held_out_error() < own.held_out_error()
    });
    if left_aside {
        laws[best].held_back = Some(AT_AN_END.into());
    } else if at != by_the_force {
        laws[by_the_force].held_back = Some(SHOWN_BY_THE_COUNTS.into());
    }
    let rung = rungs.swap_remove(at);
    let another_curve = rests.then(|| curved(&rung, ladder)).flatten();
    let held_out_rmse = rung.cross_validated_rmse(ladder);
    let held_back = unfit::unseen_force(&rung.estimate);
    let without = laws[at].without.clone();
    let Rung {
        estimate, optimum, ..
    } = rung;
    let mut estimate = match &asked {
        Some(asked) if asked.shows => asked.estimate.clone(),
        _ => stated(ladder, &optimum, estimate, observer),
    };
    for freer in &freer {
        estimate.doubt_beside(&before, freer);
    }
    // Stiffness takes up what micro-damping gives, and its interval counts none.
    let law = before.law;
    let is_damped = |rung: &&Rung| {
        let own = rung.estimate.law;
        own.has_micro_damping() && own.undamped() == law
    };
    let damped = rungs.iter().find(is_damped);
    if let Some(rung) = damped.filter(|_| law.undamped && !stopped && !estimate.of_the_counts) {
        let damped = stated(ladder, &rung.optimum, rung.estimate.clone(), observer);
        let stiffness = damped.parameters.iter();
        let mut stiffness = stiffness.filter(|p| p.name.quantity == Quantity::Sigma0);
        if stiffness.any(|p| !p.identifiable) {
            estimate.leave_open(&[Quantity::Sigma0], HELD_WITH_DAMPING);
        }
    }
    if asked.is_some_and(|asked| !asked.shows) && estimate.of_the_counts {
        estimate.leave_open(&[Quantity::Sigma0, Quantity::Sigma1], HELD_FROM_THE_COUNTS);
    }
    if let Some(next) = another_curve
        && !stopped
        && estimate.status != Status::Interrupted
        && !estimate.of_the_counts
        && let Ok((freer, _)) = ladder.fit(&next, settings, observer)
        && !matches!(shape(&freer, base.exponent), Shape::AsAssumed)
    {
        // Whether the rests or the axis make that curve is not known.
        estimate.doubt_beside(&before, &freer);
    }
    if passed_over {
        // Bristles that end at a lower level than those of the axis are stiffer or softer, to make up for it.
        estimate.leave_open(
            &[Quantity::Sigma0, Quantity::Sigma1],
            "the log asks for a static friction above any force in it, which was left out; the bristles depend on it",
        );
    }
    if stopped {
        // Not all laws were tried, so even a converged one is only the best so far.
        estimate = estimate.interrupted();
    }
    Ok(Choice {
        estimate,
        laws: if stopped { Vec::new() } else { laws },
        by,
        held_back,
        better: None,
        held_out_rmse,
        without,
    })
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

/// What the symmetric laws suggest: LuGre with what it leaves open held at nothing, and the families that hold best with
/// parameters for each direction.
fn second<'a>(climb: &Climb, ladder: &'a Ladder) -> Vec<Candidate<'a>> {
    let mut next = held(climb, ladder, false);
    let errors = climb.rungs.iter().map(Rung::held_out_error);
    let least = errors.fold(f64::INFINITY, f64::min);
    let close = |rung: &&Rung| RICHER_LAW_WINS_BELOW * rung.held_out_error() <= least;
    // Coulomb and viscous friction stays linear, so it costs next to nothing.
    let wanted = |rung: &&Rung| rung.estimate.law.kind == LawKind::CoulombViscous || close(rung);
    for rung in climb.rungs.iter().filter(wanted) {
        let candidate = ladder.usual(rung.estimate.law.asymmetric());
        next.push(candidate.from(&[rung]));
    }
    next
}

/// What the best of all laws so far suggests where it is asymmetric: the same with what it leaves open held at nothing,
/// and with a constant force beside it.
fn third<'a>(climb: &Climb, ladder: &'a Ladder) -> Vec<Candidate<'a>> {
    let (_, best) = climb.entries();
    let Some(rung) = best.map(|best| &climb.rungs[best]) else {
        return Vec::new();
    };
    let law = rung.estimate.law;
    if !law.asymmetric {
        return Vec::new();
    }
    let mut next = match law.kind {
        LawKind::LuGre => held(climb, ladder, true),
        _ => Vec::new(),
    };
    // Without a bristle the two levels and the constant force cannot be told apart.
    let both = ladder.terms.asymmetric_with_offset.as_ref();
    next.extend(both.filter(|_| law.kind.has_bristle()).map(|terms| {
        let candidate = Candidate {
            terms,
            ..ladder.usual(law)
        };
        candidate.from(&[rung])
    }));
    next
}

/// The best law so far with its static friction kept below the largest friction of the log, where it is above that.
fn capped<'a>(climb: &Climb, ladder: &'a Ladder) -> Vec<Candidate<'a>> {
    let (_, best) = climb.entries();
    let Some(rung) = best.map(|best| &climb.rungs[best]) else {
        return Vec::new();
    };
    let law = rung.estimate.law;
    // Without a Stribeck curve there is no static friction to keep below anything.
    if !law.has_stribeck() || unfit::unseen_force(&rung.estimate).is_none() {
        return Vec::new();
    }
    let values = rung.estimate.values();
    let level = |side| values.on(Quantity::Coulomb, side).unwrap_or(f64::INFINITY);
    let coulomb = [Side::Positive, Side::Negative].map(level);
    let most = unfit::largest_friction(&rung.estimate);
    let candidate = Candidate {
        terms: ladder.beside(rung),
        ..ladder.usual(law)
    };
    let candidate = candidate.from(&[rung]);
    vec![Candidate {
        capped: Some(rung.optimum.bounds_with_static_below(coulomb, most)),
        ..candidate
    }]
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
    let candidate = Candidate {
        terms: ladder.beside(rung),
        ..ladder.usual(law.with_fitted_exponent())
    };
    asks.then(|| candidate.from(&[rung]))
}

/// What a fitted exponent says of the curve that is assumed.
enum Shape {
    /// It is of that shape, or not surely of another.
    AsAssumed,
    /// It is not.
    Another,
    /// The data do not determine the exponent.
    Unknown,
}

fn shape(fitted: &Estimate, assumed: f64) -> Shape {
    let Some(p) = fitted.parameter(Quantity::StribeckExponent) else {
        return Shape::AsAssumed;
    };
    if !p.identifiable {
        return Shape::Unknown;
    }
    let off = libm::log(p.value / assumed).abs();
    let sure = p.std.is_some_and(|std| off > SURELY * std / p.value);
    match off > EXPONENT_APART && sure {
        true => Shape::Another,
        false => Shape::AsAssumed,
    }
}

/// LuGre with what it leaves open held at nothing.
fn held<'a>(climb: &Climb, ladder: &'a Ladder, asymmetric: bool) -> Vec<Candidate<'a>> {
    let of = |kind: LawKind| {
        let is = |rung: &&Rung| {
            rung.estimate.law.kind == kind && rung.estimate.law.asymmetric == asymmetric
        };
        climb.rungs.iter().find(is)
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
        next.push(ladder.usual(law.flat()).from(&near));
    }
    if lugre.leaves_open(Quantity::Sigma1) {
        next.push(ladder.usual(law.undamped()).from(&[lugre]));
    }
    next
}

/// Cost of a law that holds something, in parts of that of the same law without it, from which on the search of the latter has ended
/// beside the best: with one more unknown no less can be explained.
const MISSED: f64 = 0.99;

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
            is_held && cost(other) < MISSED * cost(rung)
        };
        let nearest = climb.rungs.iter().filter(holds_more);
        let nearest = nearest.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        if let Some(nearest) = nearest.filter(|_| !rung.capped) {
            let mut again = ladder.usual(law);
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
    let sought = ladder.usual(estimate.law).terms.delay == Delay::Fitted;
    if sought && estimate.terms.delay == Delay::NONE {
        let moved = [
            Quantity::Sigma0,
            Quantity::Sigma1,
            Quantity::Sigma2,
            Quantity::Mass,
        ];
        estimate.doubt(|p| {
            moved
                .contains(&p.name.quantity)
                .then_some(BEYOND_ALL_DELAYS)
        });
        let widths = estimate.parameters.iter();
        let open: Vec<Side> = widths
            .filter(|p| {
                p.name.quantity == Quantity::StribeckVelocity && p.identified && !p.identifiable
            })
            .map(|p| p.name.side)
            .collect();
        estimate.doubt(|p| {
            let ends = p.name.quantity == Quantity::Static && open.contains(&p.name.side);
            ends.then_some(AN_END_BESIDE_IT)
        });
    }
    if estimate.terms.low_pass_undone {
        estimate.doubt(|p| (p.name.quantity == Quantity::Delay).then_some(BESIDE_A_LOW_PASS));
    }
    estimate
}

/// The best of the laws that a compensator may rely on. Of those that leave at most a tenth more, one without a parameter
/// at the end of its search range comes first.
fn reliable(climb: &Climb, laws: &[LawEntry], best: usize) -> usize {
    let rungs = &climb.rungs;
    let able: Vec<usize> = (0..laws.len())
        .filter(|&i| laws[i].held_back.is_none())
        .collect();
    let best = climb.best_of(&able).unwrap_or(best);
    let inside = |&i: &usize| !unfit::at_its_end(&rungs[i].optimum);
    if inside(&best) {
        return best;
    }
    let errors = able.iter().map(|&i| rungs[i].held_out_error());
    let most = engine::NEVER_EQUAL_RATIO * errors.fold(f64::INFINITY, f64::min);
    let near = |&i: &usize| rungs[i].held_out_error() <= most;
    let within: Vec<usize> = able.into_iter().filter(inside).filter(near).collect();
    climb.best_of(&within).unwrap_or(best)
}

/// A law with a Stribeck curve that the counts of the encoder were asked of.
struct OfTheCounts {
    /// Its place among the laws.
    at: usize,
    estimate: Estimate,
    /// Whether they were used and determine its static friction.
    shows: bool,
}

/// What the counts say of static friction where the law that was chosen by the force, at this place, holds it at Coulomb friction. A fit
/// of the force passes over what happens within a count or two of a rest; the counts do not, and what they see of a rise that the law
/// lacks they give to the stiffness of the bristles.
fn of_the_counts(
    climb: &Climb,
    laws: &[LawEntry],
    at: usize,
    ladder: &Ladder,
    observer: &mut dyn Observer,
) -> Option<OfTheCounts> {
    let own = &climb.rungs[at];
    let law = &own.estimate.law;
    let most = engine::NEVER_EQUAL_RATIO * own.held_out_error();
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
    Some(OfTheCounts {
        at,
        estimate,
        shows,
    })
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
