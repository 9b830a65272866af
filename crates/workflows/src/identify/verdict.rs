//! Whether a law may be used for compensation: pure functions of facts and thresholds.

use stiction_files::result::Action;
use stiction_identify::Status;
use stiction_policy::verdict;
use stiction_say::{On, Reason};

/// A reason against a law.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Against {
    /// Why.
    pub reason: Reason,
    /// What leads on from it.
    pub next: Action,
    /// Whether data contradict the law, so that its constants do not hold.
    pub contradicts: bool,
}

impl Against {
    fn new(reason: Reason, next: Action) -> Self {
        Self {
            reason,
            next,
            contradicts: false,
        }
    }
}

/// What is known of a law that was fitted to whole records, and of its logs.
#[derive(Clone, Debug)]
pub(super) struct Facts {
    /// How the search ended.
    pub status: Status,
    /// Whether a search was not followed by least squares.
    pub lacks_intervals: bool,
    /// What was fitted: `force` or `position`.
    pub signal: &'static str,
    /// Explained part of its variance.
    pub explained: f64,
    /// Relative error of the fit, dimensionless.
    pub error: f64,
    /// Whether the axis moves in both directions.
    pub moves_both_ways: bool,
    /// Reversals of all logs.
    pub reversals: usize,
    /// Whether a Coulomb level is zero.
    pub lacks_coulomb: bool,
    /// Whether a Coulomb level is not determined.
    pub coulomb_is_open: bool,
    /// Whether mass, Coulomb and viscous friction are all zero or less.
    pub is_negative: bool,
    /// Whether the law stays in presliding.
    pub stays_in_presliding: bool,
    /// Part of the samples with saturated force.
    pub saturated: f64,
    /// Part of the samples in which the drive gave less than the logged force, where it did.
    pub not_given: Option<f64>,
    /// Whether the force comes from another file with time stamps of its own.
    pub has_other_clock: bool,
    /// Findings about the logs and the axis file that a verdict depends on.
    pub found: Findings,
    /// How the law holds samples that it was not fitted to, where the force was fitted.
    pub held_out: Option<HeldOut>,
    /// The best of the laws beside it, where they were compared.
    pub best: Option<Best>,
    /// What leads on where another law may do.
    pub another_law: Action,
    /// What leads on where no law does.
    pub no_law: Action,
}

/// Findings about logs and axis file, each in its own words where it was made.
#[derive(Clone, Debug, Default)]
pub(super) struct Findings {
    /// Logs whose force has the other sign than that of the others, and those others.
    pub mixed_signs: Option<(String, String)>,
    /// A parameter that differs between the logs, and its ratio.
    pub several_axes: Option<(String, f64)>,
    /// The position begins again, as a counter that overflows does.
    pub overflow: Option<String>,
    /// No delay is that of all logs.
    pub delays_apart: Option<String>,
    /// A log has no sample that is fitted.
    pub unused: Option<String>,
    /// The log contradicts a value of the axis file.
    pub contradicted: Option<String>,
    /// The position jumps.
    pub jump: Option<String>,
    /// The force does negative work.
    pub force_sign: Option<String>,
    /// A column that says where the axis is enabled is not used.
    pub enable: Option<String>,
    /// A size is one that no machine has.
    pub unlikely: Option<String>,
}

/// How a law holds samples that it was not fitted to.
#[derive(Clone, Debug)]
pub(super) struct HeldOut {
    /// Part of the friction that it leaves.
    pub error: f64,
    /// On which samples.
    pub on: On,
    /// The same on the fitted samples.
    pub fitted: f64,
    /// Whether the data chose the law.
    pub chosen: bool,
    /// Each validation.
    pub validations: Vec<Validation>,
}

/// How a law holds a log that was not fitted.
#[derive(Clone, Debug)]
pub(super) struct Validation {
    /// Its name.
    pub log: String,
    /// Part of its friction that the law leaves.
    pub error: f64,
    /// The least that a simpler law leaves there, where there is one.
    pub simpler: Option<f64>,
    /// Whether its force has the other sign than that of the fitted logs.
    pub inverted: bool,
    /// What leads on where the law does not hold there.
    pub next: Action,
}

/// The law with the least held-out error.
#[derive(Clone, Debug)]
pub(super) struct Best {
    /// Its name.
    pub law: String,
    /// Whether it has parameters for each direction.
    pub asymmetric: bool,
    /// Its held-out error, percent.
    pub error: f64,
    /// That of the law that is judged, percent.
    pub own: f64,
    /// Whether the choice passed it over.
    pub passed_over: bool,
}

/// All that speaks against a law that was fitted to whole records, what has to be set right first before the rest.
pub(super) fn of_records(facts: &Facts) -> Vec<Against> {
    let mut all = Vec::new();
    let mut say = |reason: Reason, next: Action| all.push(Against::new(reason, next));
    if facts.lacks_intervals {
        say(Reason::NoIntervals, Action::Finish);
    }
    of_logs(&facts.found, &mut say);
    if let Some(text) = &facts.found.contradicted {
        all.push(Against {
            contradicts: true,
            ..Against::new(Reason::Finding(text.clone()), Action::AxisFile)
        });
    }
    let mut say = |reason: Reason, next: Action| all.push(Against::new(reason, next));
    if facts.found.mixed_signs.is_none() {
        of_axis_file(facts, &mut say);
        if facts.found.force_sign.is_some() {
            // All else follows from the sign.
            return all;
        }
    }
    if !matches!(facts.status, Status::Converged | Status::Interrupted) {
        let status = facts.status.name();
        say(Reason::NotConverged { status }, facts.another_law.clone());
    }
    if facts.explained.is_nan() || facts.explained < verdict::MIN_R2 {
        let reason = Reason::PoorFit {
            explained: facts.explained,
            least: verdict::MIN_R2,
            signal: facts.signal,
        };
        say(reason, facts.another_law.clone());
    }
    if !facts.moves_both_ways {
        say(Reason::OneDirection, Action::CHECK);
    }
    if facts.lacks_coulomb {
        say(Reason::NoCoulomb, facts.no_law.clone());
    }
    if facts.stays_in_presliding {
        say(Reason::NeverSlides, Action::CHECK);
    }
    of_saturation(facts.saturated, &mut say);
    if let Some(part) = facts.not_given {
        say(Reason::ForceNotGiven { part }, Action::CHECK);
    }
    if let Some(text) = &facts.found.unlikely {
        say(Reason::Finding(text.clone()), Action::AxisFile);
    }
    if let Some(best) = &facts.best
        && best.error < verdict::MAX_BETTER_ERROR * best.own
        && !best.passed_over
    {
        let reason = Reason::BetterLaw {
            law: best.law.clone(),
            asymmetric: best.asymmetric,
            error: best.error,
            own: best.own,
        };
        say(reason, facts.another_law.clone());
    }
    if let Some(held_out) = &facts.held_out {
        all.extend(of_held_out(held_out, facts));
    }
    all
}

/// What is wrong with the logs together.
fn of_logs(found: &Findings, say: &mut impl FnMut(Reason, Action)) {
    if let Some((inverted, others)) = found.mixed_signs.clone() {
        say(Reason::MixedSigns { inverted, others }, Action::FirstLog);
    } else if let Some((parameter, ratio)) = found.several_axes.clone() {
        say(Reason::SeveralAxes { parameter, ratio }, Action::FirstLog);
    }
    for (text, next) in [
        (&found.overflow, Action::AxisFile),
        (&found.delays_apart, Action::FirstLog),
        (&found.unused, Action::FirstLog),
    ] {
        if let Some(text) = text {
            say(Reason::Finding(text.clone()), next);
        }
    }
}

/// What the axis file lacks where the law explains little.
fn of_axis_file(facts: &Facts, say: &mut impl FnMut(Reason, Action)) {
    let found = &facts.found;
    let poor = facts.error.is_nan() || facts.error > verdict::MAX_FIT_ERROR;
    let mut finding = |text: &String| say(Reason::Finding(text.clone()), Action::AxisFile);
    // Where the position jumps, all else is seen in pieces; one that begins again is refused whatever is left.
    if let Some(text) = &found.jump
        && found.overflow.is_none()
        && (poor || found.force_sign.is_some())
    {
        finding(text);
    }
    if let Some(text) = found
        .force_sign
        .as_ref()
        .or(found.enable.as_ref().filter(|_| poor))
    {
        finding(text);
    } else if poor && facts.moves_both_ways && facts.is_negative {
        say(Reason::InvertedForce, Action::AxisFile);
    } else if poor && facts.has_other_clock {
        say(Reason::UnalignedClocks, Action::AxisFile);
    }
}

/// Refuses a force that is saturated in too many samples.
fn of_saturation(saturated: f64, say: &mut impl FnMut(Reason, Action)) {
    if saturated > verdict::MAX_SATURATED_SHARE {
        let reason = Reason::Saturated {
            part: saturated,
            most: verdict::MAX_SATURATED_SHARE,
        };
        say(reason, Action::CHECK);
    }
}

fn of_held_out(held_out: &HeldOut, facts: &Facts) -> Vec<Against> {
    let HeldOut {
        error, on, fitted, ..
    } = *held_out;
    let fails = |v: &&Validation| {
        // Where every simpler law leaves more, nothing is lost with this one.
        let loses = v.inverted || v.simpler.is_none_or(|simpler| v.error >= simpler);
        v.error > verdict::MIN_HELD_OUT_ERROR
            && v.error > verdict::MAX_VALIDATION_ERROR * fitted
            && loses
    };
    let failed = held_out.validations.iter().filter(fails);
    let failed = failed.map(|v| Against {
        reason: Reason::ValidationFails {
            log: v.log.clone(),
            error: v.error,
            fitted,
            inverted: v.inverted,
        },
        next: v.next.clone(),
        contradicts: true,
    });
    let mut all: Vec<Against> = failed.collect();
    let mut say = |reason: Reason, next: Action| all.push(Against::new(reason, next));
    let most = verdict::MAX_HELD_OUT_ERROR;
    if error.is_nan() || error > most {
        say(
            Reason::FrictionLeft { error, most, on },
            facts.no_law.clone(),
        );
    }
    if on == On::Fitted && held_out.chosen {
        say(Reason::NothingHeldOut, facts.no_law.clone());
    }
    let reversals = facts.reversals;
    if (reversals as f64) < verdict::MIN_REVERSALS && facts.coulomb_is_open {
        say(Reason::FewReversals { reversals }, Action::CHECK);
    }
    all
}

/// What is known of a law whose static parameters were found first.
pub(super) fn of_two_steps(statics_differ: bool, stiffness_is_open: bool) -> Option<Against> {
    match (statics_differ, stiffness_is_open) {
        (true, _) => Some(Against::new(
            Reason::StaticsDiffer,
            Action::LetTheDataChoose,
        )),
        (false, true) => Some(Against::new(
            Reason::OpenStiffness { why: None },
            Action::CHECK,
        )),
        (false, false) => None,
    }
}

/// What is known of a law that was fitted to a simulated position, beside the facts of any.
#[derive(Clone, Debug)]
pub(super) struct SimulatedFacts {
    /// Whether the force follows the simulated controller.
    pub closed_loop: bool,
    /// Whether elements stick and slip one by one.
    pub jumps: bool,
    /// Whether no parameter is determined.
    pub nothing_determined: bool,
    /// Whether the simulated axis never exceeds static friction.
    pub never_breaks_away: bool,
    /// Independent samples of the residual, and unknowns.
    pub samples: (f64, usize),
    /// Ratio of the residual to that of encoder steps alone; infinite without an encoder.
    pub over_encoder: f64,
    /// Each unseen log.
    pub unseen: Vec<UnseenFacts>,
}

/// How a simulated law holds an unseen log.
#[derive(Clone, Debug)]
pub(super) struct UnseenFacts {
    /// Its name.
    pub log: String,
    /// Position error over that of the fit or of encoder steps, the larger, simulated whole.
    pub ratio: f64,
    /// The same over stretches of this length, s.
    pub short: Option<(f64, f64)>,
    /// Whether the encoder steps are the larger, whole and over stretches.
    pub of_encoder: [bool; 2],
    /// Position error over that of encoder steps alone; infinite without an encoder.
    pub over_encoder: f64,
    /// Explained part of the variance of the position.
    pub explained: f64,
}

impl SimulatedFacts {
    /// Whether noise of the logged force, integrated twice, biases the parameters beyond their intervals.
    pub fn is_biased(&self) -> bool {
        let (samples, unknowns) = self.samples;
        let enough = samples >= verdict::MIN_SAMPLES_PER_UNKNOWN * unknowns as f64;
        !(self.closed_loop || self.over_encoder < verdict::MAX_ENCODER_RESIDUAL || enough)
    }
}

/// All that speaks against a law that was fitted to a simulated position, beside what does against any.
pub(super) fn of_simulation(facts: &Facts, simulated: &SimulatedFacts) -> Vec<Against> {
    let mut all = of_records(facts);
    let mut say = |reason: Reason, next: Action| all.push(Against::new(reason, next));
    if simulated.is_biased() {
        let (samples, unknowns) = simulated.samples;
        say(
            Reason::CorrelatedResidual { samples, unknowns },
            Action::CHECK,
        );
    }
    if simulated.jumps {
        say(Reason::SimulationJumps, Action::CHECK);
    }
    if simulated.nothing_determined {
        let closed_loop = simulated.closed_loop;
        say(Reason::NothingDetermined { closed_loop }, Action::CHECK);
    }
    for unseen in &simulated.unseen {
        if let Some(reason) = of_unseen(unseen) {
            say(reason, Action::CHECK);
        }
    }
    if simulated.never_breaks_away && !facts.stays_in_presliding {
        say(Reason::NeverBreaksAway, Action::Record);
    }
    // What a check has to say has led here.
    for against in &mut all {
        if against.next == Action::CHECK {
            against.next = Action::Record;
        }
    }
    all
}

fn of_unseen(unseen: &UnseenFacts) -> Option<Reason> {
    let most = verdict::MAX_POSITION_ERROR;
    let fails = |ratio: f64, seconds: Option<f64>, of_encoder: bool| Reason::PositionFails {
        log: unseen.log.clone(),
        seconds,
        ratio,
        of_encoder,
        most,
    };
    let [whole, short] = unseen.of_encoder;
    if unseen.ratio > most {
        return Some(fails(unseen.ratio, None, whole));
    }
    if let Some((seconds, ratio)) = unseen.short
        && ratio > most
    {
        return Some(fails(ratio, Some(seconds), short));
    }
    let explained = unseen.explained;
    let is_poor = explained.is_nan() || explained < verdict::MIN_R2;
    (unseen.over_encoder > most && is_poor).then(|| Reason::PositionUnexplained {
        log: unseen.log.clone(),
        explained,
        least: verdict::MIN_R2,
    })
}

/// What is known of a steady curve through points of constant velocity.
#[derive(Clone, Debug)]
pub(super) struct CurveFacts {
    /// How the search ended.
    pub status: Status,
    /// Whether a search was not followed by least squares.
    pub lacks_intervals: bool,
    /// Part of the samples with saturated force.
    pub saturated: f64,
    /// Part of the points that lie far off the curve.
    pub outlying: f64,
    /// Whether a Coulomb level is zero.
    pub lacks_coulomb: bool,
    /// The largest level of friction and its ratio to the largest force of the logs.
    pub level: (&'static str, f64),
    /// Explained part of the variance of the forces.
    pub explained: f64,
}

/// All that speaks against a steady curve.
pub(super) fn of_curve(facts: &CurveFacts) -> Vec<Against> {
    let mut all = Vec::new();
    let mut say = |reason: Reason, next: Action| all.push(Against::new(reason, next));
    if facts.lacks_intervals {
        say(Reason::NoIntervals, Action::Finish);
    }
    if facts.status == Status::Interrupted {
        say(Reason::Interrupted, Action::Again);
    }
    of_saturation(facts.saturated, &mut say);
    let part = facts.outlying;
    if part > verdict::MAX_OUTLYING_SHARE {
        say(Reason::OutlyingPoints { part }, Action::CHECK);
    }
    if facts.lacks_coulomb {
        say(Reason::NoCoulomb, Action::CHECK);
    }
    let (level, ratio) = facts.level;
    if ratio > verdict::MAX_EXTRAPOLATION {
        say(Reason::Extrapolated { level, ratio }, Action::CHECK);
    }
    if facts.explained.is_nan() || facts.explained < verdict::MIN_R2 {
        let least = verdict::MIN_R2;
        say(Reason::PoorCurve { least }, Action::CHECK);
    }
    all
}

/// All that speaks against stiffness and micro-damping from force steps.
pub(super) fn of_steps(
    status: Status,
    curve_is_assumed: bool,
    open_stiffness: impl Iterator<Item = String>,
) -> Vec<Against> {
    let mut all = Vec::new();
    match status {
        Status::Converged => {}
        Status::Interrupted => all.push(Against::new(Reason::Interrupted, Action::Again)),
        other => {
            let status = other.name();
            all.push(Against::new(Reason::NotConverged { status }, Action::CHECK));
        }
    }
    if curve_is_assumed {
        all.push(Against::new(Reason::AssumedCurve, Action::Record));
    }
    all.extend(
        open_stiffness
            .map(|why| Against::new(Reason::OpenStiffness { why: Some(why) }, Action::CHECK)),
    );
    all
}

/// A search that the user stopped: nothing else is concluded from what it has.
pub(super) fn of_a_stop() -> Vec<Against> {
    vec![Against::new(Reason::Interrupted, Action::Again)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A law that nothing speaks against.
    fn sound() -> Facts {
        Facts {
            status: Status::Converged,
            lacks_intervals: false,
            signal: "force",
            explained: 0.99,
            error: 0.05,
            moves_both_ways: true,
            reversals: 10,
            lacks_coulomb: false,
            coulomb_is_open: false,
            is_negative: false,
            stays_in_presliding: false,
            saturated: 0.0,
            not_given: None,
            has_other_clock: false,
            found: Findings::default(),
            held_out: Some(HeldOut {
                error: 0.05,
                on: On::HeldOut,
                fitted: 0.05,
                chosen: true,
                validations: Vec::new(),
            }),
            best: None,
            another_law: Action::LetTheDataChoose,
            no_law: Action::Simulate,
        }
    }

    fn with(change: impl Fn(&mut Facts)) -> Vec<Against> {
        let mut facts = sound();
        change(&mut facts);
        of_records(&facts)
    }

    #[test]
    fn each_fact_has_its_reason_and_what_leads_on() {
        assert_eq!(with(|_| ()), []);
        let only = |change: &dyn Fn(&mut Facts)| match <[Against; 1]>::try_from(with(change)) {
            Ok([own]) => (own.reason, own.next),
            Err(all) => panic!("{all:?}"),
        };
        let (reason, next) = only(&|facts| facts.moves_both_ways = false);
        assert_eq!((reason, next), (Reason::OneDirection, Action::CHECK));
        let (reason, next) = only(&|facts| facts.explained = f64::NAN);
        assert!(matches!(reason, Reason::PoorFit { .. }) && next == Action::LetTheDataChoose);
        let (reason, _) = only(&|facts| (facts.error, facts.is_negative) = (0.3, true));
        assert_eq!(reason, Reason::InvertedForce);
        let (reason, next) = only(&|facts| {
            facts.reversals = 2;
            facts.coulomb_is_open = true;
        });
        assert_eq!(reason, Reason::FewReversals { reversals: 2 });
        assert_eq!(next, Action::CHECK);
    }

    #[test]
    fn a_validation_refuses_only_what_a_simpler_law_holds_as_well() {
        let validated = |simpler: Option<f64>, inverted: bool| {
            let all = with(|facts| {
                let held_out = facts.held_out.as_mut().unwrap();
                held_out.validations = vec![Validation {
                    log: "b.csv".into(),
                    error: 0.2,
                    simpler,
                    inverted,
                    next: Action::IDENTIFY,
                }];
            });
            all.iter().any(|own| own.contradicts)
        };
        assert!(validated(None, false));
        assert!(validated(Some(0.1), false));
        assert!(!validated(Some(0.3), false));
        assert!(validated(Some(0.3), true));
    }

    /// What stands first decides where to go on: a wrong axis file makes all else meaningless.
    #[test]
    fn the_axis_file_comes_before_the_fit() {
        let all = with(|facts| {
            facts.found.contradicted = Some("mass".into());
            facts.explained = 0.1;
            facts.error = 0.9;
        });
        assert_eq!(all[0].next, Action::AxisFile);
        assert!(all[0].contradicts && all.len() == 2);
    }
}
