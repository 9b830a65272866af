//! Laws from the counts of an encoder: the last step where an axis rests in much of its log.
//!
//! A fit of the force takes the motion from filtered counts. At rest the axis creeps by parts of a count and by single ones;
//! filtered counts move farther, and a law that sums up `|v|` loses deflection there that the axis keeps. Here the axis is
//! simulated under the force that was logged, and its counts are compared with those of the log: an extended Kalman filter,
//! whose likelihood is maximised (decision 0060).

mod axis;
mod climb;
mod covariance;
mod data;
mod filter;
mod fit;
mod relaxation;
mod response;
mod rests;
mod state;
mod tangent;
mod unknowns;

use crate::conditioning::record::Record;
use crate::estimate::Estimate;
use crate::law::LawKind;
use crate::parameter::Added;
use crate::parameter::Parameter;
use crate::watch::Watch;
use stiction_policy::encoder;

/// What the counts of a log say of a fit.
pub(crate) enum Counts {
    /// Nothing: the axis is not of the kind that is simulated.
    NotAsked,
    /// What is stated now.
    Stated,
    /// What can only be held against the fit of the force.
    Doubted(Doubted),
    /// Nothing: no axis under the force that was logged makes them.
    Unexplained,
}

/// A maximum of the likelihood that is not believed.
pub(crate) struct Doubted(Box<fit::Likely>);

impl Doubted {
    /// The Stribeck exponent that is likelier than that of the law, where there is one.
    pub fn exponent(&self) -> Option<f64> {
        self.0.exponent
    }

    /// Whether it hardly explains the counts.
    pub fn is_hopeless(&self) -> bool {
        self.0.hopeless
    }

    /// Flags the parameters whose interval does not hold what the counts say.
    pub fn flag(&self, estimate: &mut Estimate) {
        state::doubt(estimate, &self.0);
    }
}

/// Flags what rests spoil in a fit of the force whose counts cannot be asked: why, in words that go on from "their counts".
pub(crate) fn flag_what_rests_spoil(estimate: &mut Estimate, why: &str) {
    let kind = estimate.law.kind;
    if kind == LawKind::LuGre || kind.has_elements() {
        state::doubt_all(&mut estimate.fitted.parameters, why);
    }
}

/// Whether an axis rests in so much of a record that its counts are asked.
pub fn rests_much(record: &Record) -> bool {
    rests::share(record) >= encoder::MIN_REST_SHARE
}

/// What a fit of the force knows beside the parameters that the counts state.
pub(crate) struct Known<'a> {
    /// What is added to its variances.
    pub more: &'a Added,
    /// The delay as that fit states it, with what its replicas show.
    pub delay: Option<&'a Parameter>,
}

/// Asks the counts of a record in which the axis [rests much](rests_much) about the fit of its force; states what they say where
/// they can be believed, with what that fit knows.
pub(crate) fn ask(
    record: &Record,
    estimate: &mut Estimate,
    known: &Known,
    watch: &mut Watch,
) -> Counts {
    if !fit::can_be_asked(record, estimate) {
        return Counts::NotAsked;
    }
    match fit::most_likely(record, estimate, known.delay, watch) {
        None if watch.stopped => Counts::NotAsked,
        None => Counts::Unexplained,
        Some(found) if found.against.is_empty() => {
            state::state(estimate, &found, known.more);
            Counts::Stated
        }
        Some(found) => Counts::Doubted(Doubted(Box::new(found))),
    }
}
