//! What stands beside the logs that are fitted: logs for procedures, the model of an earlier identification.

use super::method::Method;
use super::options::Options;
use crate::error::Error;
use crate::source::{Source, load_all};
use crate::wording::{Setting, TOGETHER_WITH};
use stiction_files::Axis;
use stiction_files::model::ReadModel;

/// What stands beside the logs, read.
pub(super) struct Beside {
    pub statics: Vec<Source>,
    pub model: Option<ReadModel>,
    pub break_away: Vec<Source>,
}

impl Beside {
    /// Refuses a model of another kind of axis than the logs.
    pub fn check_model(&self, options: &Options, first: &Source) -> Result<(), Error> {
        let Some(ReadModel { model, .. }) = &self.model else {
            return Ok(());
        };
        let (kind, unit) = (first.log.motion.to_string(), &first.log.force_unit);
        if model.kind == kind && model.force_unit == *unit {
            return Ok(());
        }
        let file = options.procedures.model.clone().unwrap_or_default();
        Err(Error::usage(
            format!(
                "{} is of a {} axis with force in {}",
                file.display(),
                model.kind,
                model.force_unit
            ),
            format!("a model like the logs: {kind}, force in {unit}"),
        ))
    }

    /// Reads what stands beside the logs, and refuses what the method has no use for; `held_out` are the logs to validate on.
    pub fn load(options: &Options, axis: &Axis, held_out: &[Source]) -> Result<Self, Error> {
        let procedures = &options.procedures;
        let method = || Setting::Method.is(procedures.method.name());
        if !procedures.statics.is_empty() && procedures.model.is_some() {
            return Err(Error::usage(
                [
                    Setting::Statics.into(),
                    TOGETHER_WITH.into(),
                    Setting::Model.into(),
                ],
                "the static parameters come from one of the two",
            ));
        }
        let takes_curve = matches!(
            procedures.method,
            Method::StaticThenDynamic | Method::PreslidingStep
        );
        if procedures.model.is_some() && !takes_curve && procedures.break_away.is_empty() {
            return Err(Error::usage(
                [Setting::Model.into(), TOGETHER_WITH.into(), method()],
                [
                    "only static-then-dynamic, presliding-step and ".into(),
                    Setting::BreakAway.into(),
                    " take anything from a model".into(),
                ],
            ));
        }
        if !procedures.statics.is_empty() && !takes_curve {
            return Err(Error::usage(
                [Setting::Statics.into(), TOGETHER_WITH.into(), method()],
                "only static-then-dynamic and presliding-step take static parameters from other logs",
            ));
        }
        if !procedures.method.fits_records() && (!held_out.is_empty() || options.split.is_some()) {
            return Err(Error::usage(
                [
                    Setting::Validate.into(),
                    " or ".into(),
                    Setting::Split.into(),
                    TOGETHER_WITH.into(),
                    method(),
                ],
                "validation needs a law for every sample: separable or static-then-dynamic",
            ));
        }
        let model = match &procedures.model {
            Some(file) => Some(ReadModel::read(file)?),
            None => None,
        };
        Ok(Self {
            statics: load_all(&procedures.statics, axis)?,
            break_away: load_all(&procedures.break_away, axis)?,
            model,
        })
    }
}
