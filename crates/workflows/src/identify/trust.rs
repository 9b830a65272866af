//! Whether a result may be used: every rule that can say no, in one place. What a process exits with follows from it.

use super::choice::FAMILIES;
use super::compensation;
use super::disagree;
use super::lacking;
use super::left;
use super::turned;
use super::unfit;
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::result::{BetterLaw, CauseEntry, Compensation, LawEntry, Next, Trust};
use stiction_files::symbols;
use stiction_identify::procedure::StepFit;
use stiction_identify::{Effect, Fit, FittedLaw, LawKind, Series, SimulationFit, Status, Unseen};
use stiction_identify::{NO_INTERVAL, Parameter};
use stiction_log::Motion;
use stiction_number::{Percent, short};
use stiction_parameters::Quantity;

/// Part of the variance of what was fitted that a law must explain, dimensionless: half. A law that leaves more than it
/// explains is not the law of this axis.
pub(super) const LEAST_R2: f64 = 0.5;
/// Part of the points of a static map that may lie off its curve, dimensionless: a third. What two thirds agree on may still
/// be the curve; with fewer it is one of several.
const MOST_OUTLYING_SHARE: f64 = 1.0 / 3.0;
/// Part of the samples whose force may be cut off at a limit, dimensionless. Those are left out; with more of them the
/// accelerations, which determine the mass, are missing.
const MOST_SATURATED_SHARE: f64 = 0.2;
/// Ratio of the held-out error of the law to that of a simpler one above which a warning names the simpler one,
/// dimensionless: 2 % more, twice what the choice of a law counts as the same.
pub(super) const SIMPLER_LAW_WINS_FROM: f64 = 1.02;

/// Ratio of the held-out error of a richer law to that of this one below which a warning names the richer one,
/// dimensionless: a fifth less, which biases parameters visibly.
pub(super) const RICHER_LAW_WINS_BELOW: f64 = 0.8;
/// The same ratio below which this law is not trusted, dimensionless: another law has less than half the error.
const UNTRUSTED_BELOW: f64 = 0.5;
/// Shift of a parameter by encoder, filters and noise, as a part of its value, above which a warning names it,
/// dimensionless.
const NAMED_SHIFT: f64 = 0.05;
/// Effective number of independent samples in the residual for each unknown, below which an open loop is not trusted:
/// with fewer, the parameters fit the slow position error that a force error integrated twice makes.
const LEAST_SAMPLES_PER_UNKNOWN: f64 = 5.0;
/// Ratio of the rms residual to that of the encoder steps alone, below which the residual is the encoder's,
/// dimensionless.
const ENCODER_ONLY_BELOW: f64 = 2.0;
/// Ratio of the rms position error on unseen data to that of the fit over the same horizon, or to that of encoder steps alone
/// where this is larger, above which the law is not trusted, dimensionless.
const UNTRUSTED_VALIDATION_ERROR: f64 = 3.0;
/// Part of the samples that is near rest, above which a static law gets a warning, dimensionless.
const WARNED_REST_SHARE: f64 = 0.05;
/// Ratio of the rms residual near rest to that of all samples, above which a static law gets a warning,
/// dimensionless.
const WARNED_REST_ERROR: f64 = 1.5;

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
        Reasons {
            reasons,
            elsewhere,
            other,
            few_levels,
            estimated_offset,
        }: Reasons,
        warnings: Vec<Warning>,
    ) -> Self {
        let names = |determined: bool| -> Vec<String> {
            let identified = law.parameters.iter().filter(|p| p.identified);
            // Between two renewals of a held position a controller has moved the axis in ways that the log does not show.
            let held = warnings.iter().any(|w| w.code == Code::HeldPosition);
            // A law that explains less than half has no constants of the machine, whatever its curvature says.
            // Nor does a parameter beside an assumed curve, whose error no interval knows.
            let assumed = warnings.iter().any(|w| w.code == Code::StaticsAssumed);
            let holds = law.status == Status::Converged
                && !elsewhere
                && !few_levels
                && !held
                && !assumed
                && law.fit.r2 >= LEAST_R2
                && match motion {
                    Shown::Sliding => !law.stays_in_presliding(),
                    Shown::Presliding => true,
                    Shown::TooLittle => false,
                };
            // What an estimated offset is off is part of the delay, and no interval of the fit counts it.
            let of_clocks = |p: &Parameter| estimated_offset && p.name == Quantity::Delay;
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
        let next = reasons.first().map_or(Next::Export, |(_, next)| *next);
        let trust = Trust {
            trustworthy: reasons.is_empty(),
            next,
            other: match next {
                Next::IdentifyTheOther | Next::CheckTheOther => other,
                _ => Vec::new(),
            },
            reasons: reasons.into_iter().map(|(text, _)| text).collect(),
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
        let first = [Next::AxisFile, Next::Again, Next::Finish];
        // Nor where the logs have different signs, which is all that is left.
        if turned::named(evidence.sources, &evidence.law.disagreements).is_some() {
            return self;
        }
        self.trust.better = match self.trust.next {
            Next::AnotherLaw => evidence.better.cloned(),
            _ => evidence.clearly_better().cloned(),
        };
        if evidence.shows_friction() && !first.contains(&self.trust.next) {
            let own = left::cause(evidence.law, evidence.sources, evidence.laws);
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

/// Reasons against a result, each with what leads on from it.
#[derive(Default)]
pub(super) struct Reasons {
    reasons: Vec<(String, Next)>,
    /// Whether data contradict the law, some that were not fitted or a mass or delay that was not: what it holds for constants differs
    /// there.
    elsewhere: bool,
    /// The logs that do, as far as the first of these reasons leads to them.
    other: Vec<String>,
    /// Whether the force that was fitted takes a few values only.
    few_levels: bool,
    /// Whether the offset between the clocks of two files was estimated, which a delay then makes up for.
    estimated_offset: bool,
}

impl Reasons {
    /// None yet against a force that is fitted.
    fn of_force(sources: &[Source]) -> Self {
        Self {
            few_levels: sources.iter().any(|s| s.log.has_few_force_levels()),
            estimated_offset: sources
                .iter()
                .flat_map(|source| &source.log.findings)
                .any(|finding| finding.code == Code::OffsetEstimated),
            ..Self::default()
        }
    }

    pub fn push(&mut self, text: impl Into<String>, next: Next) {
        self.reasons.push((text.into(), next));
    }

    /// Data that were not fitted contradict the law.
    pub fn push_elsewhere(&mut self, text: String, next: Next, name: &str) {
        // One command is about logs of one kind.
        if self.reasons.first().is_none_or(|(_, first)| *first == next) {
            self.other.push(name.to_string());
        }
        self.push(text, next);
        self.elsewhere = true;
    }
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
    fn another_law(&self) -> Next {
        let own = self.laws.iter().find(|law| law.reported);
        let held_back = own.is_some_and(|own| own.held_back.is_some());
        if self.chosen {
            self.where_no_law_predicts()
        } else if own.is_none() || held_back && FAMILIES.contains(&self.law.law.kind) {
            Next::LetTheDataChoose
        } else if self.better.is_some() {
            Next::AnotherLaw
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
            true => mine > SIMPLER_LAW_WINS_FROM * least,
            false => least < RICHER_LAW_WINS_BELOW * mine,
        }
        .then_some(better)
    }

    /// What leads on where no law does: a coarse encoder is not differentiated by a simulation; motion in one direction
    /// stays that.
    pub fn where_no_law_predicts(&self) -> Next {
        match self.can_be_simulated && self.moves_both_ways {
            true => Next::Simulate,
            false => Next::Check,
        }
    }
}

/// What half a search has found: it says nothing of the machine yet, and nothing else is concluded from it.
fn stopped(law: &FittedLaw, mut warnings: Vec<Warning>) -> Judged {
    let mut reasons = Reasons::default();
    interrupted(law, &mut warnings, &mut reasons);
    Judged::new(law, Shown::Sliding, None, reasons, warnings)
}

/// A law that was fitted to the force.
pub(super) fn of_force(evidence: &Evidence, mut warnings: Vec<Warning>) -> Judged {
    if evidence.law.status == Status::Interrupted {
        return stopped(evidence.law, warnings);
    }
    let mut reasons = Reasons::of_force(evidence.sources);
    of_a_search_alone(evidence.law, &mut reasons);
    let compensation = record(evidence, &mut warnings, &mut reasons);
    Judged::new(
        evidence.law,
        Shown::Sliding,
        compensation,
        reasons,
        warnings,
    )
    .with_cause(evidence)
}

/// The same with static parameters found first; `changed` where the motion has another steady friction than these.
pub(super) fn of_two_steps(
    evidence: &Evidence,
    changed: bool,
    mut warnings: Vec<Warning>,
) -> Judged {
    if evidence.law.status == Status::Interrupted {
        return stopped(evidence.law, warnings);
    }
    let mut reasons = Reasons::of_force(evidence.sources);
    of_a_search_alone(evidence.law, &mut reasons);
    let compensation = record(evidence, &mut warnings, &mut reasons);
    if changed {
        let text = "the motion has another friction than the static parameters, and one model holds both: see what the motion says by \
                    itself";
        reasons.push(text, Next::LetTheDataChoose);
    } else if evidence
        .law
        .parameter("sigma0")
        .is_some_and(|p| !p.identifiable && p.reason != NO_INTERVAL)
    {
        let text = "sigma0 is not determined, and it is what the second step is for";
        reasons.push(text, Next::Check);
    }
    Judged::new(
        evidence.law,
        Shown::Sliding,
        compensation,
        reasons,
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
    let mut reasons = Reasons::default();
    whole_record(evidence, &mut warnings, &mut reasons);
    let biased = open_loop(found, &mut warnings, &mut reasons);
    if evidence.law.law.kind == LawKind::Gms {
        let text = "simulated, this law jumps where slipping elements begin to stick: its search may end beside the truth, and \
                    its intervals do not say so. Take maxwell-slip, or the fit of the force";
        reasons.push(text, Next::Check);
    }
    let mut fitted = evidence.law.parameters.iter().filter(|p| p.identified);
    if fitted.all(|p| !p.identifiable) {
        let text = match found.is_closed_loop() {
            true => {
                "the position says nothing certain of any parameter; what follows the reference through a stiff controller \
                 hardly shows the axis"
            }
            false => {
                "the position says nothing certain of any parameter: under the force of these logs many axes would move \
                 alike; record a motion with reversals over several speeds"
            }
        };
        reasons.push(text, Next::Check);
    }
    for (name, one) in unseen {
        if let Some(text) = position_fails(found, name, one) {
            reasons.push(text, Next::Check);
        }
    }
    let shown = match found.never_breaks_away || biased {
        true => Shown::TooLittle,
        false => Shown::Sliding,
    };
    if found.never_breaks_away && !evidence.law.stays_in_presliding() {
        let text = "the axis never breaks away: friction stays below its static level, and what it is there and beyond is not seen";
        reasons.push(text, Next::Record);
    }
    // What a check has to say has led here.
    reasons.reasons.iter_mut().for_each(|(_, next)| {
        if *next == Next::Check {
            *next = Next::Record;
        }
    });
    Judged::new(evidence.law, shown, None, reasons, warnings).with_cause(evidence)
}

/// A steady curve through points of constant velocity, of which some lie off it.
pub(super) fn of_static_map(
    law: &FittedLaw,
    outlying: usize,
    sources: &[Source],
    motion: Motion,
    mut warnings: Vec<Warning>,
) -> Judged {
    let mut reasons = Reasons::of_force(sources);
    of_a_search_alone(law, &mut reasons);
    interrupted(law, &mut warnings, &mut reasons);
    saturation(sources, &mut reasons);
    unidentifiable(law, motion, &mut warnings);
    let left_out = outlying as f64 / law.series.measured.len().max(1) as f64;
    if left_out > MOST_OUTLYING_SHARE {
        let text = format!(
            "{} of the points lie off the curve and hardly count",
            Percent::error(100.0 * left_out).digits(2)
        );
        reasons.push(text, Next::Check);
    }
    slides_freely(law, &mut reasons, Next::Check);
    if let Some(why) = unfit::above_every_force(law, sources) {
        reasons.push(why, Next::Check);
    }
    if law.fit.r2.is_nan() || law.fit.r2 < LEAST_R2 {
        let text = "the curve explains less than half of the variance of the forces";
        warnings.push(Warning::new(Code::PoorFit, text));
        reasons.push(text, Next::Check);
    }
    Judged::new(law, Shown::Sliding, None, reasons, warnings)
}

/// Stiffness and micro-damping from force steps.
pub(super) fn of_steps(
    law: &FittedLaw,
    fit: &StepFit,
    motion: Motion,
    mut warnings: Vec<Warning>,
) -> Judged {
    let mut reasons = Reasons::default();
    unidentifiable(law, motion, &mut warnings);
    if fit.status != Status::Converged {
        let code = match fit.status {
            Status::Interrupted => Code::Interrupted,
            _ => Code::NotConverged,
        };
        let text = format!("the search did not converge (status {})", fit.status.name());
        let next = match fit.status {
            Status::Interrupted => Next::Again,
            _ => Next::Check,
        };
        warnings.push(Warning::new(code, text.clone()));
        reasons.push(text, next);
    }
    if fit.delay.1.is_none() {
        warnings.push(Warning::new(
            Code::DelayOutOfRange,
            "the delay between force and position is at the end of its range, two samples: it takes the place of something that the \
             law does not explain, such as another force held before the step than the one of the model",
        ));
    }
    if warnings.iter().any(|w| w.code == Code::StaticsAssumed) {
        let text = "the steady curve is assumed, not known, and no interval includes what that is off by: record constant velocities \
                    and give them with --static speeds.csv, or the model of them with --model DIR/model.toml";
        reasons.push(text, Next::Record);
    }
    for p in fit.parameters.iter().filter(|p| p.name == "sigma0") {
        if !p.identifiable {
            let text = format!("sigma0 is not determined by these steps: {}", p.reason);
            reasons.push(text, Next::Check);
        }
    }
    Judged::new(law, Shown::Presliding, None, reasons, warnings)
}

/// What can be said of a law that was fitted to the force of whole records.
fn record(
    evidence: &Evidence,
    warnings: &mut Vec<Warning>,
    reasons: &mut Reasons,
) -> Option<Compensation> {
    whole_record(evidence, warnings, reasons);
    compensation::judged(evidence, reasons)
}

/// What can be said of any law that was fitted to whole records.
fn whole_record(evidence: &Evidence, warnings: &mut Vec<Warning>, reasons: &mut Reasons) {
    let law = evidence.law;
    // All else that logs with different signs have differently, and that a law leaves of both, comes of that.
    let turned = turned::named(evidence.sources, &law.disagreements);
    if let Some(why) = &turned {
        let of_another = |w: &Warning| {
            let mut others = evidence.held_out.iter();
            others.any(|log| w.message.contains(&*log.path.to_string_lossy()))
        };
        warnings.retain(|w| w.code != Code::ForceSign || of_another(w));
        warnings.insert(0, Warning::new(Code::ForceSign, why.clone()));
        reasons.push(why.clone(), Next::FirstLog);
    } else if let Some(why) = disagree::of_two_axes(&law.disagreements) {
        reasons.push(why, Next::FirstLog);
    }
    overflown(evidence.sources, reasons);
    if let Some(why) = evidence.apart {
        reasons.push(why.to_string(), Next::FirstLog);
    }
    if let Some(why) = evidence.unused {
        reasons.push(why.to_string(), Next::FirstLog);
    }
    if let Some(stated) = evidence.contradicted {
        warnings.insert(0, stated.clone());
        reasons.push(&*stated.message, Next::AxisFile);
        reasons.elsewhere = true;
    }
    let gravity = turned.is_none() && lacking::named(evidence, reasons);
    search_ended(evidence, warnings, reasons);
    explains_little(evidence, warnings, reasons);
    if !evidence.moves_both_ways {
        let text = "the axis moves in one direction only: friction cannot be separated from a constant \
                    force";
        if !warnings.iter().any(|w| w.code == Code::OneDirection) {
            warnings.push(Warning::new(Code::OneDirection, text));
        }
        reasons.push(text, Next::Check);
    }
    slides_freely(law, reasons, evidence.where_no_law_predicts());
    if law.stays_in_presliding() {
        let text = "the axis never slides: its stroke is shorter than the travel of the bristles from one side to the other";
        reasons.push(text, Next::Check);
    }
    saturation(evidence.sources, reasons);
    limited(law, reasons);
    no_machine(evidence.sources, reasons);
    another_wins(evidence, warnings, reasons);
    // Causes first: what they leave open, and what else shows them, comes after.
    let mut causes = Vec::new();
    left::named(law, evidence.sources, evidence.laws, &mut causes);
    // A weight on a lever repeats with the angle: cogging would take it up in part.
    causes.retain(|cause| !gravity || cause.code != Code::PositionRipple);
    causes.extend(disagree::named(
        &law.disagreements,
        evidence.sources,
        evidence.motion,
        (&evidence.options, disagree::has_one_level(law)),
    ));
    if turned.is_some() || evidence.contradicted.is_some() {
        causes.clear();
    }
    let place = match evidence.shows_friction() {
        true => 0,
        false => warnings.len(),
    };
    warnings.splice(place..place, causes);
    shifted(law, warnings);
    static_at_rest(law, evidence.motion, warnings);
    unidentifiable(law, evidence.motion, warnings);
}

fn search_ended(evidence: &Evidence, warnings: &mut Vec<Warning>, reasons: &mut Reasons) {
    let estimate = evidence.law;
    match estimate.status {
        Status::Converged | Status::Interrupted => {}
        Status::Budget | Status::Stalled | Status::Exhausted | Status::Target => {
            let text = format!(
                "the search did not converge (status {})",
                estimate.status.name()
            );
            warnings.push(Warning::new(Code::NotConverged, text.clone()));
            reasons.push(text, evidence.another_law());
        }
    }
}

/// Refuses a law without Coulomb friction: it leaves nothing to compensate at a reversal, and no compensator takes it.
fn slides_freely(law: &FittedLaw, reasons: &mut Reasons, next: Next) {
    let levels = law.parameters.iter();
    let mut levels = levels.filter(|p| p.name.quantity == Quantity::Coulomb);
    if levels.any(|p| p.value.is_nan() || p.value <= 0.0) {
        reasons.push("its Coulomb friction is zero", next);
    }
}

/// What a search gives has no intervals: how far it is off nothing says.
fn of_a_search_alone(law: &FittedLaw, reasons: &mut Reasons) {
    if law.status != Status::Interrupted && law.parameters.iter().any(|p| p.reason == NO_INTERVAL) {
        let text =
            "what a search finds by itself has no intervals: least squares after it were left out";
        reasons.push(text, Next::Finish);
    }
}

fn interrupted(law: &FittedLaw, warnings: &mut Vec<Warning>, reasons: &mut Reasons) {
    if law.status == Status::Interrupted {
        let text = "the search was interrupted; the best found so far is given, without intervals";
        warnings.push(Warning::new(Code::Interrupted, text));
        reasons.push(text, Next::Again);
    }
}

fn explains_little(evidence: &Evidence, warnings: &mut Vec<Warning>, reasons: &mut Reasons) {
    let (estimate, signal) = (evidence.law, evidence.signal);
    if estimate.fit.r2 < LEAST_R2 || estimate.fit.r2.is_nan() {
        let text = format!(
            "the law explains {:.0} % of the variance of the {signal}; at least {:.0} % are needed \
             to trust its parameters",
            100.0 * estimate.fit.r2.max(0.0),
            100.0 * LEAST_R2
        );
        warnings.push(Warning::new(Code::PoorFit, text.clone()));
        reasons.push(text, evidence.another_law());
    }
}

fn saturation(sources: &[Source], reasons: &mut Reasons) {
    let total: usize = sources.iter().map(|s| s.log.time.len()).sum();
    let saturated: usize = sources
        .iter()
        .flat_map(|s| s.log.excluded.iter().filter(|e| e.code == Code::Saturation))
        .map(|e| e.samples.len())
        .sum();
    let part = saturated as f64 / total.max(1) as f64;
    if part > MOST_SATURATED_SHARE {
        let text = format!(
            "the force is saturated in {:.0} % of the samples (at most {:.0} % can be left out)",
            100.0 * part,
            100.0 * MOST_SATURATED_SHARE
        );
        reasons.push(text, Next::Check);
    }
}

/// Refuses what was fitted to force that the drive did not give.
fn limited(law: &FittedLaw, reasons: &mut Reasons) {
    let mut effects = law.effects.iter();
    let limit = effects.find_map(|found| match found.effect {
        Effect::Limit(_, beyond) => Some(beyond),
        _ => None,
    });
    if let Some(beyond) = limit {
        let text = format!(
            "{} of the samples hold more force than the drive gave",
            Percent::error(100.0 * beyond).digits(2)
        );
        reasons.push(text, Next::Check);
    }
}

/// Refuses logs with a rate, travel, speed or force that no machine has: a unit is wrong, and every number with it.
fn no_machine(sources: &[Source], reasons: &mut Reasons) {
    let mut findings = sources.iter().flat_map(|source| &source.log.findings);
    if let Some(found) = findings.find(|finding| finding.code == Code::UnlikelySize) {
        reasons.push(found.message.clone(), Next::AxisFile);
    }
}

/// Refuses logs whose position begins again, as a counter that overflows does: what is between two overflows is not how the axis
/// moved.
fn overflown(sources: &[Source], reasons: &mut Reasons) {
    if let Some(refused) = sources.iter().find_map(|source| source.log.overflow()) {
        reasons.push(refused.found, Next::AxisFile);
    }
}

/// Names each parameter that the data do not determine, what it is confused with, and the cure.
fn unidentifiable(estimate: &FittedLaw, motion: Motion, warnings: &mut Vec<Warning>) {
    let unknown = || estimate.parameters.iter().filter(|p| !p.identifiable);
    if unknown().any(|p| p.reason == NO_INTERVAL) {
        let text = "no parameter has an interval: least squares after the search were left out";
        warnings.push(Warning::new(Code::NotIdentifiable, text));
        return;
    }
    let of_an_element = |p: &&Parameter| p.name.quantity.is_of_an_element();
    let elements: Vec<String> = unknown()
        .filter(of_an_element)
        .map(|p| p.name.to_string())
        .collect();
    // Parameters that are open for one reason stand together.
    let mut each: Vec<(Vec<String>, String)> = Vec::new();
    let mut advice: Vec<&str> = Vec::new();
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
        let own = parameter.advice.as_str();
        if !own.is_empty() && !advice.contains(&own) {
            advice.push(own);
        }
    }
    if !each.is_empty() {
        let each = each.iter();
        let each = each.map(|(names, reason)| format!("{}: {reason}", names.join(", ")));
        let text = [each.collect::<Vec<_>>().join("; ")]
            .into_iter()
            .chain(advice.into_iter().map(String::from));
        let text = text.collect::<Vec<_>>().join(". ");
        warnings.push(Warning::new(Code::NotIdentifiable, text));
    }
    if !elements.is_empty() {
        warnings.push(Warning::new(
            Code::NotIdentifiable,
            format!(
                "{}: the data determine the sum of the elements, not each of them. Record slow \
                 reversals of several amplitudes, or ask for fewer elements ([terms] gms_elements)",
                elements.join(", ")
            ),
        ));
    }
}

fn another_wins(evidence: &Evidence, warnings: &mut Vec<Warning>, reasons: &mut Reasons) {
    let laws = evidence.laws;
    let (Some(chosen), Some(best)) = (
        laws.iter().find(|l| l.reported),
        laws.iter().find(|l| l.best),
    ) else {
        return;
    };
    let (Some(mine), Some(least)) = (chosen.held_out_error_percent, best.held_out_error_percent)
    else {
        return;
    };
    let side = if best.asymmetric { ", asymmetric," } else { "" };
    let errors = format!(
        "on held-out samples the law {}{side} has an error of {}, this law of {}",
        best.law,
        Percent::error(least).decimals(2),
        Percent::error(mine).decimals(2)
    );
    if best.parameters < chosen.parameters && mine > SIMPLER_LAW_WINS_FROM * least {
        warnings.push(Warning::new(
            Code::SimplerLawHoldsBetter,
            format!("{errors}: the richer law is not supported by this log"),
        ));
    } else if best.parameters > chosen.parameters && least < RICHER_LAW_WINS_BELOW * mine {
        warnings.push(Warning::new(
            Code::RicherLawHoldsBetter,
            format!("{errors}: this law is too simple for the axis, its parameters are biased"),
        ));
    }
    // What the choice itself passed over is no way on.
    let passed_over = evidence.chosen && best.held_back.is_some();
    if least < UNTRUSTED_BELOW * mine && !passed_over {
        reasons.push(errors, evidence.another_law());
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
            && part > NAMED_SHIFT
    };
    let names: Vec<String> = estimate
        .parameters
        .iter()
        .filter(far)
        .map(|p| {
            let part = Percent::error(100.0 * p.bias.unwrap_or(0.0) / p.value);
            format!("{} {}", p.name, part.signed(0))
        })
        .collect();
    if !names.is_empty() {
        warnings.push(Warning::new(
            Code::LargeShift,
            format!(
                "encoder steps, filters and noise bias {}: the bias was subtracted, but one of this size \
                 is known only roughly",
                names.join(", ")
            ),
        ));
    }
}

/// An error of the logged force drives the simulated axis of an open loop like the force itself, is integrated twice
/// on its way to the position, and so biases the parameters: whether by more than their intervals say.
fn open_loop(found: &SimulationFit, warnings: &mut Vec<Warning>, reasons: &mut Reasons) -> bool {
    let fit = &found.position;
    let encoder_only = found
        .floor
        .is_some_and(|floor| fit.rmse < ENCODER_ONLY_BELOW * floor);
    let shared = found.fitted.parameters.iter().filter(|p| p.identified);
    let unknowns = shared.count() + found.starts();
    if found.is_closed_loop()
        || encoder_only
        || fit.effective_samples >= LEAST_SAMPLES_PER_UNKNOWN * unknowns as f64
    {
        return false;
    }
    let worth = format!(
        "the residual has {:.0} effective samples for {unknowns} unknowns, the starts of the runs \
         included",
        fit.effective_samples
    );
    warnings.push(Warning::new(
        Code::CorrelatedResidual,
        format!(
            "{worth}: the logged force drives the simulated axis, so its noise, and any force that is \
             not in it, adds up to a slow error of the position and biases the parameters by more than \
             their intervals. Cut the log into shorter runs ([simulation] segment in the axis file), or \
             record a closed loop and give its controller ([controller]), which no force noise drives"
        ),
    ));
    let text = format!(
        "{worth}: noise of the logged force biases the parameters, and their intervals do not include that"
    );
    reasons.push(text, Next::Check);
    true
}

/// What an unseen position has against a fitted law: an error far above that of the fit over the same horizon, or a motion
/// that is mostly unexplained.
fn position_fails(found: &SimulationFit, name: &str, unseen: &Unseen) -> Option<String> {
    let fitted = found.whole.as_ref().unwrap_or(&found.position);
    let least = found.floor.unwrap_or(0.0);
    let beyond = |unseen: &Fit, fitted: &Fit| {
        unseen.rmse > UNTRUSTED_VALIDATION_ERROR * fitted.rmse.max(least)
    };
    let times = |unseen: &Fit, fitted: &Fit| match fitted.rmse > least {
        true => format!("{} times that of the fit", short(unseen.rmse / fitted.rmse)),
        false => format!(
            "{} times what encoder steps alone leave",
            short(unseen.rmse / least)
        ),
    };
    let allowed = UNTRUSTED_VALIDATION_ERROR;
    if beyond(&unseen.position, fitted) {
        return Some(format!(
            "on {name}, simulated whole, the position error is {} (at most {allowed} times)",
            times(&unseen.position, fitted)
        ));
    }
    if let (Some(mine), Some(theirs)) = (&found.short, &unseen.short)
        && beyond(&theirs.position, &mine.position)
    {
        return Some(format!(
            "on {name}, simulated over {} s at a time, the position error is {} (at most {allowed} times)",
            short(theirs.seconds),
            times(&theirs.position, &mine.position)
        ));
    }
    let explained = unseen.position.r2;
    let resolved = unseen.position.rmse > UNTRUSTED_VALIDATION_ERROR * least;
    (resolved && (explained.is_nan() || explained < LEAST_R2)).then(|| {
        format!(
            "on {name}, simulated whole, the law explains {:.0} % of the variance of the position; at least {:.0} % are \
             needed",
            100.0 * explained.max(0.0),
            100.0 * LEAST_R2
        )
    })
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
    if part > WARNED_REST_SHARE && slow.rmse > WARNED_REST_ERROR * estimate.fit.rmse {
        warnings.push(Warning::new(
            Code::StaticLawAtRest,
            format!(
                "{:.0} % of the samples are slower than {} {}, where a static law does not \
                 describe friction and most of the residual is: leave them out with [conditioning] min_speed in the axis \
                 file, or identify the law lugre",
                100.0 * part,
                short(estimate.low_speed_bound),
                symbols::speed_unit(motion)
            ),
        ));
    }
}
