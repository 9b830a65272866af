//! What a result may be used for, and what to beware of. What a process exits with follows from it.

use super::choice::FAMILIES;
use super::compensation;
use super::disagree;
use super::effects;
use super::extrapolation;
use super::inverted_sign;
use super::logs::log_warnings;
use super::verdict::{
    self, Against, Best, CurveFacts, Facts, Findings, SimulatedFacts, UnseenFacts,
};
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::result::{Action, BetterLaw, CauseEntry, Compensation, LawEntry, Trust};
use stiction_files::symbols;
use stiction_identify::procedure::StepFit;
use stiction_identify::{Effect, Fit, FittedLaw, LawKind, Series, SimulationFit, Status, Unseen};
use stiction_identify::{IntervalKind, Parameter};
use stiction_log::Motion;
use stiction_parameters::Quantity;
use stiction_policy::{choice, interval};
use stiction_say::{Notice, Reason};

/// A verdict, and what to beware of.
pub(super) struct Judged {
    pub trust: Trust,
    pub warnings: Vec<Warning>,
}

impl Judged {
    /// The result is trustworthy if there is no reason against it. The next step is that of the first reason.
    fn new(
        law: &FittedLaw,
        motion: Shown,
        compensation: Option<Compensation>,
        against: Vec<Against>,
        doubts: Doubts,
        warnings: Vec<Warning>,
    ) -> Self {
        let contradicted = against.iter().any(|own| own.contradicts);
        let names = |determined: bool| -> Vec<String> {
            let identified = law.parameters.iter().filter(|p| p.identified);
            // A law that explains less than half has no constants of the machine, whatever its curvature says.
            let holds = law.status == Status::Converged
                && !contradicted
                && !doubts.few_levels
                && !doubts.held_position
                && !doubts.assumed_curve
                && law.fit.r2 >= stiction_policy::verdict::MIN_R2
                && match motion {
                    Shown::Sliding => !law.stays_in_presliding(),
                    Shown::Presliding => true,
                    Shown::TooLittle => false,
                };
            // What an estimated offset is off is part of the delay, and no interval of the fit counts it.
            let of_clocks = |p: &Parameter| doubts.estimated_offset && p.name == Quantity::Delay;
            let known = |p: &Parameter| p.identifiable && holds && !of_clocks(p);
            // What one log has more than another may be open, but is none of the machine's.
            // With one level for both directions, what they differ by passes for half of a constant force.
            let mixed = |p: &Parameter| p.name == Quantity::Offset && !law.law.asymmetric;
            // A part of a map is no constant, whether it is known or not.
            let of_map = |p: &Parameter| matches!(p.name.quantity, Quantity::CoulombMap(_));
            let is_listed = |p: &Parameter| {
                !of_map(p) && (!determined || !(p.name.quantity.is_of_a_log() || mixed(p)))
            };
            identified
                .filter(|p| known(p) == determined && is_listed(p))
                .map(|p| p.name.to_string())
                .collect()
        };
        let next = first(&against);
        let trust = Trust {
            trustworthy: against.is_empty(),
            next,
            reasons: against.iter().map(|own| own.reason.to_string()).collect(),
            cause: None,
            compensation,
            constants: names(true),
            open: names(false),
            better: None,
        };
        Judged { trust, warnings }
    }

    /// The same with the cause of what the law leaves; not where the search has to end, the axis file to be set right or
    /// another motion to be recorded first, which changes what is left.
    fn with_cause(mut self, evidence: &Evidence) -> Self {
        let first = [Action::AxisFile, Action::Again, Action::Finish];
        // Nor where the logs have different signs, which is all that is left.
        if inverted_sign::named(evidence.sources, &evidence.law.disagreements).is_some() {
            return self;
        }
        self.trust.better = match &self.trust.next {
            Action::Law { .. } => evidence.better.cloned(),
            _ => evidence.clearly_better().cloned(),
        };
        if evidence.shows_friction() && !first.contains(&self.trust.next) {
            let own = effects::cause(evidence.law, evidence.sources, evidence.laws);
            let between = disagree::cause(evidence.law);
            let levels = between
                .as_ref()
                .is_some_and(|between| between.cure.is_some());
            // What of another shape is left may be of levels that differ.
            let is_first =
                |own: &CauseEntry| own.cure.is_some() && !(levels && own.code == Code::LawShape);
            let found = match own {
                Some(own) if is_first(&own) => Some(own),
                own => between.or(own),
            };
            // All else is in the wrong unit until the force is scaled.
            self.trust.cause = evidence.unscaled.clone().or(found);
        }
        self
    }
}

/// What kind of motion a result has to have come from.
#[derive(Clone, Copy, PartialEq)]
enum Shown {
    /// Sliding, without which the level of the friction is open.
    Sliding,
    /// Force steps below break-away, for stiffness and micro-damping.
    Presliding,
    /// Sliding too, but no interval counts the noise of the force: the axis never broke away, or an open loop integrates it.
    TooLittle,
}

/// What the first reason leads to; where it names a log, the others that lead to the same are named with it: one command is about
/// logs of one kind.
fn first(against: &[Against]) -> Action {
    let mut all = against.iter().map(|own| &own.next);
    let mut next = all.next().cloned().unwrap_or_default();
    for other in all {
        match (&mut next, other) {
            (Action::Check { logs }, Action::Check { logs: others })
            | (Action::Identify { logs }, Action::Identify { logs: others })
                if !logs.is_empty() =>
            {
                logs.extend(others.iter().cloned());
            }
            _ => {}
        }
    }
    next
}

/// What no interval knows, so that no parameter is a constant of the machine.
#[derive(Clone, Copy, Debug, Default)]
struct Doubts {
    /// The force that was fitted takes a few values only.
    few_levels: bool,
    /// Between two renewals of a held position a controller has moved the axis in ways that the log does not show.
    held_position: bool,
    /// Parameters stand beside a curve that was assumed.
    assumed_curve: bool,
    /// The offset between the clocks of two files was estimated, which a delay then makes up for.
    estimated_offset: bool,
}

impl Doubts {
    fn of(sources: &[Source]) -> Self {
        let found = |code: Code| has_finding(sources, code);
        Self {
            few_levels: sources.iter().any(|s| s.log.has_few_force_levels()),
            held_position: found(Code::HeldPosition),
            assumed_curve: false,
            estimated_offset: found(Code::OffsetEstimated),
        }
    }

    /// Of a fit to the position.
    fn of_position(sources: &[Source]) -> Self {
        Self {
            held_position: has_finding(sources, Code::HeldPosition),
            ..Self::default()
        }
    }
}

fn has_finding(sources: &[Source], code: Code) -> bool {
    finding(sources, code).is_some()
}

/// The first finding of a kind, in its words.
fn finding(sources: &[Source], code: Code) -> Option<String> {
    let mut findings = sources.iter().flat_map(|source| &source.log.findings);
    findings
        .find(|finding| finding.code() == code)
        .map(ToString::to_string)
}

/// What a fit is judged by.
pub(super) struct Evidence<'a> {
    pub law: &'a FittedLaw,
    /// What was fitted: the force, or the position.
    pub signal: &'static str,
    pub moves_both_ways: bool,
    pub sources: &'a [Source],
    /// Laws side by side; empty where they were not compared.
    pub laws: &'a [LawEntry],
    /// How the logs differ in when their force was logged, where no delay is that of all.
    pub apart: Option<&'a str>,
    /// What the axis file states and the log contradicts.
    pub contradicted: Option<&'a Warning>,
    /// Which of several logs have no sample that is fitted.
    pub unused: Option<&'a str>,
    pub motion: Motion,
    /// Whether the data chose the law.
    pub chosen: bool,
    /// The best of the other laws that a compensator may rely on, where this one was asked for.
    pub better: Option<&'a BetterLaw>,
    /// Rms residual on held-out samples, where the law was fitted without them in turn.
    pub held_out_rmse: Option<f64>,
    /// Signals of each validation, with its name.
    pub validation: &'a [(String, Series)],
    /// Least rms residual of simpler laws on each of them; none where there are no simpler ones.
    pub simpler: &'a [Option<f64>],
    /// The logs that those are of, unless they are of a part of the fitted ones.
    pub held_out: &'a [Source],
    /// The options of the run, as they are typed.
    pub options: String,
    /// What the column of the force lacks where its unit does not fit the axis.
    pub unscaled: Option<CauseEntry>,
    /// Whether the axis can be simulated: its position and its inertia are known or fitted.
    pub can_be_simulated: bool,
}

impl Evidence<'_> {
    /// Whether the motion shows friction at all, without which it is no use to know what else the law leaves.
    fn shows_friction(&self) -> bool {
        self.moves_both_ways && !self.law.stays_in_presliding()
    }

    /// What leads on where this law will not do. No law leads to one that leads back to it: one that the data choose leads to
    /// another only as the cure of its shape, and one that was asked for to the best of those that it was compared with, or, where
    /// it is held back, to the choice, which has more of its kind.
    fn another_law(&self) -> Action {
        let own = self.laws.iter().find(|law| law.reported);
        let held_back = own.is_some_and(|own| own.held_back.is_some());
        if self.chosen {
            self.where_no_law_predicts()
        } else if own.is_none() || held_back && FAMILIES.contains(&self.law.law.kind) {
            Action::LetTheDataChoose
        } else if let Some(BetterLaw { law, asymmetric }) = self.better {
            Action::Law {
                law: law.clone(),
                asymmetric: *asymmetric,
            }
        } else {
            self.where_no_law_predicts()
        }
    }

    /// A law that holds clearly better than this one, which was asked for.
    fn clearly_better(&self) -> Option<&BetterLaw> {
        let better = self.better?;
        let is_it =
            |law: &&LawEntry| (&law.law, law.asymmetric) == (&better.law, better.asymmetric);
        let [own, other] = [
            self.laws.iter().find(|law| law.reported)?,
            self.laws.iter().find(is_it)?,
        ];
        let [mine, least] = [own, other].map(|law| law.held_out_error_percent);
        let (mine, least) = (mine?, least?);
        match other.parameters <= own.parameters {
            true => mine > choice::MIN_NAMED_SIMPLER_ERROR * least,
            false => least < choice::MAX_NAMED_RICHER_ERROR * mine,
        }
        .then_some(better)
    }

    /// What leads on where no law does: a coarse encoder is not differentiated by a simulation; motion in one direction
    /// stays that.
    pub fn where_no_law_predicts(&self) -> Action {
        match self.can_be_simulated && self.moves_both_ways {
            true => Action::Simulate,
            false => Action::CHECK,
        }
    }
}

impl Evidence<'_> {
    /// The facts that a verdict depends on.
    fn facts(&self) -> Facts {
        let (law, sources) = (self.law, self.sources);
        let coulomb = || {
            let levels = law.parameters.iter();
            levels.filter(|p| p.name.quantity == Quantity::Coulomb)
        };
        let best = || {
            let own = self.laws.iter().find(|law| law.reported)?;
            let best = self.laws.iter().find(|law| law.best)?;
            Some(Best {
                law: best.law.clone(),
                asymmetric: best.asymmetric,
                error: best.held_out_error_percent?,
                own: own.held_out_error_percent?,
                // What the choice itself passed over is no way on.
                passed_over: self.chosen && best.held_back.is_some(),
            })
        };
        let overflow = sources.iter().find_map(|source| source.log.overflow());
        Facts {
            status: law.status,
            lacks_intervals: lacks_intervals(law),
            signal: self.signal,
            explained: law.fit.r2,
            error: law.fit.relative_error_percent / 100.0,
            moves_both_ways: self.moves_both_ways,
            reversals: compensation::reversals(sources),
            lacks_coulomb: lacks_coulomb(law),
            coulomb_is_open: coulomb().any(|p| !p.identifiable),
            is_negative: is_negative(law),
            stays_in_presliding: law.stays_in_presliding(),
            saturated: saturated(sources),
            not_given: law.effects.iter().find_map(|found| match found.effect {
                Effect::Limit(_, beyond) => Some(beyond),
                _ => None,
            }),
            has_other_clock: sources.iter().any(|s| s.log.force_as_stamped),
            found: Findings {
                mixed_signs: inverted_sign::named(sources, &law.disagreements),
                several_axes: disagree::of_two_axes(&law.disagreements),
                overflow: overflow.map(|refused| refused.found),
                delays_apart: self.apart.map(String::from),
                unused: self.unused.map(String::from),
                contradicted: self.contradicted.map(|stated| stated.message.clone()),
                jump: finding(sources, Code::PositionJump),
                force_sign: finding(sources, Code::ForceSign),
                enable: finding(sources, Code::EnableIgnored),
                unlikely: finding(sources, Code::UnlikelySize),
            },
            held_out: None,
            best: best(),
            another_law: self.another_law(),
            no_law: self.where_no_law_predicts(),
        }
    }
}

/// What half a search has found: it says nothing of the machine yet, and nothing else is concluded from it.
fn stopped(law: &FittedLaw, mut warnings: Vec<Warning>) -> Judged {
    let against = verdict::of_a_stop();
    warn(&against, &mut warnings);
    Judged::new(
        law,
        Shown::Sliding,
        None,
        against,
        Doubts::default(),
        warnings,
    )
}

/// Warns of what a verdict says that has a code of its own.
fn warn(against: &[Against], warnings: &mut Vec<Warning>) {
    for reason in against.iter().map(|own| &own.reason) {
        // A log that moves in one direction has said so itself.
        let is_said = || warnings.iter().any(|own| own.code == Code::OneDirection);
        let warns = match reason {
            Reason::NotConverged { .. } | Reason::Interrupted => true,
            Reason::PoorFit { .. } | Reason::PoorCurve { .. } => true,
            Reason::OneDirection => !is_said(),
            _ => false,
        };
        if warns {
            warnings.push(Notice::Against(Box::new(reason.clone())).into());
        }
    }
}

/// A law that was fitted to the force.
pub(super) fn of_force(evidence: &Evidence, warnings: Vec<Warning>) -> Judged {
    of_the_force(evidence, None, warnings)
}

/// The same with static parameters found first; `changed` where the motion has another steady friction than these.
pub(super) fn of_two_steps(evidence: &Evidence, changed: bool, warnings: Vec<Warning>) -> Judged {
    let stiffness = evidence.law.parameter("sigma0");
    let is_open =
        stiffness.is_some_and(|p| !p.identifiable && p.interval != IntervalKind::Searched);
    of_the_force(evidence, verdict::of_two_steps(changed, is_open), warnings)
}

fn of_the_force(evidence: &Evidence, more: Option<Against>, mut warnings: Vec<Warning>) -> Judged {
    if evidence.law.status == Status::Interrupted {
        return stopped(evidence.law, warnings);
    }
    let (compensation, held_out) = compensation::held_out(evidence).unzip();
    let facts = Facts {
        held_out,
        ..evidence.facts()
    };
    let mut against = verdict::of_records(&facts);
    whole_record(evidence, &facts, &against, &mut warnings);
    against.extend(more);
    let doubts = Doubts::of(evidence.sources);
    Judged::new(
        evidence.law,
        Shown::Sliding,
        compensation,
        against,
        doubts,
        warnings,
    )
    .with_cause(evidence)
}

/// A law that was fitted to the position of a simulated axis.
pub(super) fn of_position(
    evidence: &Evidence,
    found: &SimulationFit,
    unseen: &[(String, Unseen)],
    mut warnings: Vec<Warning>,
) -> Judged {
    if evidence.law.status == Status::Interrupted {
        return stopped(evidence.law, warnings);
    }
    let facts = Facts {
        lacks_intervals: false,
        ..evidence.facts()
    };
    let simulated = simulated(evidence, found, unseen);
    let against = verdict::of_simulation(&facts, &simulated);
    whole_record(evidence, &facts, &against, &mut warnings);
    let biased = simulated.is_biased();
    if biased {
        warnings.push(Notice::CorrelatedResidual.into());
    }
    let shown = match found.never_breaks_away || biased {
        true => Shown::TooLittle,
        false => Shown::Sliding,
    };
    let doubts = Doubts::of_position(evidence.sources);
    Judged::new(evidence.law, shown, None, against, doubts, warnings).with_cause(evidence)
}

fn simulated(
    evidence: &Evidence,
    found: &SimulationFit,
    unseen: &[(String, Unseen)],
) -> SimulatedFacts {
    let least = found.floor.unwrap_or(0.0);
    let over = |rmse: f64| match least > 0.0 {
        true => rmse / least,
        false => f64::INFINITY,
    };
    let of = |unseen: &Fit, fitted: &Fit| unseen.rmse / fitted.rmse.max(least);
    let fitted = found.whole.as_ref().unwrap_or(&found.position);
    let each = unseen.iter().map(|(log, one)| {
        let short = found.short.as_ref().zip(one.short.as_ref());
        UnseenFacts {
            log: log.clone(),
            ratio: of(&one.position, fitted),
            short: short.map(|(own, one)| (one.seconds, of(&one.position, &own.position))),
            of_encoder: [
                fitted.rmse <= least,
                short.is_some_and(|(own, _)| own.position.rmse <= least),
            ],
            over_encoder: over(one.position.rmse),
            explained: one.position.r2,
        }
    });
    let shared = found.fitted.parameters.iter().filter(|p| p.identified);
    let mut own = evidence.law.parameters.iter().filter(|p| p.identified);
    SimulatedFacts {
        closed_loop: found.is_closed_loop(),
        jumps: evidence.law.law.kind == LawKind::Gms,
        nothing_determined: own.all(|p| !p.identifiable),
        never_breaks_away: found.never_breaks_away,
        samples: (
            found.position.effective_samples,
            shared.count() + found.starts(),
        ),
        over_encoder: over(found.position.rmse),
        unseen: each.collect(),
    }
}

/// A steady curve through points of constant velocity, of which some lie off it.
pub(super) fn of_static_map(
    law: &FittedLaw,
    outlying: usize,
    sources: &[Source],
    motion: Motion,
    mut warnings: Vec<Warning>,
) -> Judged {
    let facts = CurveFacts {
        status: law.status,
        lacks_intervals: lacks_intervals(law),
        saturated: saturated(sources),
        outlying: outlying as f64 / law.series.measured.len().max(1) as f64,
        lacks_coulomb: lacks_coulomb(law),
        level: extrapolation::largest_level(law, sources),
        explained: law.fit.r2,
    };
    let against = verdict::of_curve(&facts);
    let (stopped, rest): (Vec<Against>, Vec<Against>) =
        (against.iter().cloned()).partition(|own| own.reason == Reason::Interrupted);
    warn(&stopped, &mut warnings);
    unidentifiable(law, motion, &mut warnings);
    warn(&rest, &mut warnings);
    Judged::new(
        law,
        Shown::Sliding,
        None,
        against,
        Doubts::of(sources),
        warnings,
    )
}

/// Stiffness and micro-damping from force steps.
pub(super) fn of_steps(
    law: &FittedLaw,
    fit: &StepFit,
    (sources, motion): (&[Source], Motion),
    mut warnings: Vec<Warning>,
) -> Judged {
    let assumed_curve = warnings.iter().any(|w| w.code == Code::StaticsAssumed);
    let mut stiffness = fit.parameters.iter().filter(|p| p.name == "sigma0");
    let open = stiffness.by_ref().filter(|p| !p.identifiable);
    let open = open.map(|p| p.reason.clone());
    let against = verdict::of_steps(fit.status, assumed_curve, open);
    unidentifiable(law, motion, &mut warnings);
    warn(&against, &mut warnings);
    if fit.delay.1.is_none() {
        warnings.push(Notice::DelayOfStep.into());
    }
    let doubts = Doubts {
        assumed_curve,
        ..Doubts::of_position(sources)
    };
    Judged::new(law, Shown::Presliding, None, against, doubts, warnings)
}

/// What to beware of in a law that was fitted to whole records.
fn whole_record(
    evidence: &Evidence,
    facts: &Facts,
    against: &[Against],
    warnings: &mut Vec<Warning>,
) {
    let law = evidence.law;
    // All else that logs with different signs have differently, and that a law leaves of both, comes of that.
    let mixed = against
        .iter()
        .find(|own| matches!(own.reason, Reason::MixedSigns { .. }));
    if let Some(mixed) = mixed {
        // Those of logs that are not fitted stay.
        let own = log_warnings(evidence.sources);
        warnings.retain(|w| w.code != Code::ForceSign || !own.contains(w));
        let notice = Notice::Against(Box::new(mixed.reason.clone()));
        warnings.insert(0, notice.into());
    }
    if let Some(stated) = evidence.contradicted {
        warnings.insert(0, stated.clone());
    }
    warn(against, warnings);
    another_wins(facts, evidence.laws, warnings);
    // Causes first: what they leave open, and what else shows them, comes after.
    let mut causes = Vec::new();
    if mixed.is_none() && evidence.contradicted.is_none() {
        effects::named(law, evidence.sources, evidence.laws, &mut causes);
        causes.extend(disagree::named(
            &law.disagreements,
            evidence.sources,
            evidence.motion,
            (&evidence.options, disagree::has_one_level(law)),
        ));
    }
    let place = match evidence.shows_friction() {
        true => 0,
        false => warnings.len(),
    };
    warnings.splice(place..place, causes);
    if law.terms.map().is_some_and(|map| map.terms == 0) {
        warnings.push(Notice::NoMap.into());
    }
    shifted(law, warnings);
    static_at_rest(law, evidence.motion, warnings);
    unidentifiable(law, evidence.motion, warnings);
}

/// Whether a law has no Coulomb friction: it leaves nothing to compensate at a reversal, and no compensator takes it.
fn lacks_coulomb(law: &FittedLaw) -> bool {
    let levels = law.parameters.iter();
    let mut levels = levels.filter(|p| p.name.quantity == Quantity::Coulomb);
    levels.any(|p| p.value.is_nan() || p.value <= 0.0)
}

/// Whether inertia and each friction of a law that has both come out at nothing, as where the force has the other sign.
fn is_negative(law: &FittedLaw) -> bool {
    let parameters = || law.parameters.iter().filter(|p| p.identified);
    let none = |quantity: Quantity| {
        let mut own = parameters()
            .filter(|p| p.name.quantity == quantity)
            .peekable();
        own.peek().is_some() && own.all(|p| p.value <= 0.0)
    };
    [Quantity::Mass, Quantity::Coulomb, Quantity::Sigma2]
        .into_iter()
        .all(none)
}

/// Whether a law comes from a search alone: how far it is off nothing says.
fn lacks_intervals(law: &FittedLaw) -> bool {
    law.status != Status::Interrupted
        && law
            .parameters
            .iter()
            .any(|p| p.interval == IntervalKind::Searched)
}

/// Part of the samples with saturated force.
fn saturated(sources: &[Source]) -> f64 {
    let total: usize = sources.iter().map(|s| s.log.time.len()).sum();
    let saturated = sources.iter().flat_map(|s| {
        let excluded = s.log.excluded.iter();
        excluded.filter(|e| e.code == Code::Saturation)
    });
    let saturated: usize = saturated.map(|e| e.samples.len()).sum();
    saturated as f64 / total.max(1) as f64
}

/// Names each parameter that the data do not determine, what it is confused with, and the cure.
fn unidentifiable(estimate: &FittedLaw, motion: Motion, warnings: &mut Vec<Warning>) {
    let unknown = || estimate.parameters.iter().filter(|p| !p.identifiable);
    if unknown().any(|p| p.interval == IntervalKind::Searched) {
        warnings.push(Notice::NoIntervals.into());
        return;
    }
    let of_an_element = |p: &&Parameter| p.name.quantity.is_of_an_element();
    let elements: Vec<String> = unknown()
        .filter(of_an_element)
        .map(|p| p.name.to_string())
        .collect();
    // Parameters that are open for one reason stand together.
    let mut each: Vec<(Vec<String>, String)> = Vec::new();
    let mut record: Vec<String> = Vec::new();
    for parameter in unknown().filter(|p| !of_an_element(p)) {
        let meaning = symbols::meaning_of(parameter.name, motion);
        let name = format!("{} ({meaning})", parameter.name);
        let mut reason = parameter.reason.clone();
        let partners: Vec<String> = parameter
            .moves_with
            .iter()
            .map(|(name, correlation)| format!("{name} (correlation {correlation:+.2})"))
            .collect();
        if !partners.is_empty() {
            reason.push_str(&format!(", moves together with {}", partners.join(" and ")));
        }
        match each.iter_mut().find(|(_, same)| *same == reason) {
            Some((names, _)) => names.push(name),
            None => each.push((vec![name], reason)),
        }
        // Several parameters may be determined by one motion.
        let own = &parameter.advice;
        if !own.is_empty() && !record.contains(own) {
            record.push(own.clone());
        }
    }
    if !each.is_empty() {
        warnings.push(Notice::Open { each, record }.into());
    }
    if !elements.is_empty() {
        warnings.push(Notice::OpenElements { names: elements }.into());
    }
}

/// Names a law that holds held-out samples clearly better.
fn another_wins(facts: &Facts, laws: &[LawEntry], warnings: &mut Vec<Warning>) {
    let (Some(best), Some(own), Some(other)) = (
        &facts.best,
        laws.iter().find(|law| law.reported),
        laws.iter().find(|law| law.best),
    ) else {
        return;
    };
    let (own_error, error) = (best.own, best.error);
    let law = match best.asymmetric {
        true => format!("{}, asymmetric,", best.law),
        false => best.law.clone(),
    };
    if other.parameters < own.parameters && own_error > choice::MIN_NAMED_SIMPLER_ERROR * error {
        warnings.push(
            Notice::SimplerLaw {
                law,
                error,
                own: own_error,
            }
            .into(),
        );
    } else if other.parameters > own.parameters
        && error < choice::MAX_NAMED_RICHER_ERROR * own_error
    {
        warnings.push(
            Notice::RicherLaw {
                law,
                error,
                own: own_error,
            }
            .into(),
        );
    }
}

/// Names the parameters with a large bias by encoder, filters and noise.
fn shifted(estimate: &FittedLaw, warnings: &mut Vec<Warning>) {
    let far = |p: &&stiction_identify::Parameter| {
        let part = p.bias.map_or(0.0, |bias| (bias / p.value).abs());
        // A part of what may be zero says nothing, and of one part of a map as little.
        let from_zero = p.ci95.is_none_or(|(low, high)| low > 0.0 || high < 0.0);
        p.identifiable
            && from_zero
            && p.name != Quantity::Offset
            && p.name != Quantity::Delay
            && !matches!(p.name.quantity, Quantity::CoulombMap(_))
            && part > interval::MIN_NAMED_SHIFT
    };
    let biased = estimate.parameters.iter().filter(far).map(|p| {
        let percent = 100.0 * p.bias.unwrap_or(0.0) / p.value;
        (p.name.to_string(), percent)
    });
    let parameters: Vec<(String, f64)> = biased.collect();
    if !parameters.is_empty() {
        warnings.push(Notice::Biased { parameters }.into());
    }
}

/// A static law says nothing of an axis at rest or in presliding.
fn static_at_rest(estimate: &FittedLaw, motion: Motion, warnings: &mut Vec<Warning>) {
    let Some(slow) = estimate
        .low_speed
        .filter(|_| !estimate.law.kind.has_bristle())
    else {
        return;
    };
    let part = slow.samples as f64 / estimate.fit.samples as f64;
    if part > choice::MAX_STATIC_REST_SHARE
        && slow.rmse > choice::MAX_STATIC_REST_ERROR * estimate.fit.rmse
    {
        let notice = Notice::StaticLawAtRest {
            part,
            speed: estimate.low_speed_bound,
            unit: symbols::speed_unit(motion),
        };
        warnings.push(notice.into());
    }
}
