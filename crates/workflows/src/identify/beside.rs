//! What stands beside the logs that are fitted: logs for procedures, the model of an earlier identification.

use super::method::Method;
use super::options::Options;
use crate::error::Error;
use crate::source::{Source, load_all};
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

    pub fn load(options: &Options, axis: &Axis) -> Result<Self, Error> {
        let procedures = &options.procedures;
        if !procedures.statics.is_empty() && procedures.model.is_some() {
            return Err(Error::usage(
                "--static together with --model",
                "the static parameters come from one of the two",
            ));
        }
        let takes_curve = matches!(
            procedures.method,
            Method::StaticThenDynamic | Method::PreslidingStep
        );
        if procedures.model.is_some() && !takes_curve && procedures.break_away.is_empty() {
            return Err(Error::usage(
                format!(
                    "--model together with --method {}",
                    procedures.method.name()
                ),
                "only static-then-dynamic, presliding-step and --break-away take anything from a model",
            ));
        }
        if !procedures.statics.is_empty() && !takes_curve {
            return Err(Error::usage(
                format!(
                    "--static together with --method {}",
                    procedures.method.name()
                ),
                "only static-then-dynamic and presliding-step take static parameters from other logs",
            ));
        }
        if !procedures.method.fits_records()
            && (!options.validate.is_empty() || options.split.is_some())
        {
            return Err(Error::usage(
                format!(
                    "--validate or --split together with --method {}",
                    procedures.method.name()
                ),
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
