//! An identified law with everything that is known of it.

use crate::{Error, Log, Parameter, bundle};
use std::path::{Path, PathBuf};
use stiction_files::result::{CovarianceEntry, FitEntry, ResultFile};
use stiction_files::{Bundle, ModelFile, Warning};
use stiction_friction::compensator::Compensator;
use stiction_identify::Series;
use stiction_pages::report;
use stiction_parameters::{FrictionLaw, LawError, LawKind, ParameterSet};
use stiction_workflows::Verdict;
use stiction_workflows::export::{self, ExportOptions, Target};
use stiction_workflows::identify::{self, Outcome, Prediction};

/// What an identification found: the law, its parameters with intervals and flags, how well it fits, and whether it may be
/// trusted.
#[derive(Clone, Debug)]
pub struct Fit {
    pub(crate) outcome: Outcome,
}

impl Fit {
    /// The parameters, in the order of tables.
    pub fn parameters(&self) -> impl ExactSizeIterator<Item = Parameter<'_>> {
        self.outcome.result.parameters.iter().map(Parameter)
    }

    /// The parameter of this name, such as `coulomb`.
    pub fn parameter(&self, name: &str) -> Option<Parameter<'_>> {
        self.parameters().find(|p| p.name() == name)
    }

    /// Covariance of the identified parameters, in the squares and products of their units.
    pub fn covariance(&self) -> &CovarianceEntry {
        &self.outcome.result.covariance
    }

    /// The family of the law: the one that was asked for, or that the data chose.
    pub fn law_kind(&self) -> LawKind {
        self.outcome.law().law.kind
    }

    /// Whether the result may be used; if not, [`reasons`](Self::reasons) says why.
    pub fn is_trustworthy(&self) -> bool {
        self.outcome.result.trust.trustworthy
    }

    /// Why the result may not be used; empty if it may.
    pub fn reasons(&self) -> &[String] {
        &self.outcome.result.trust.reasons
    }

    /// What to know although the identification went on, each with its code.
    pub fn warnings(&self) -> &[Warning] {
        &self.outcome.result.warnings
    }

    /// How well the law fits the samples that it was fitted to.
    pub fn quality(&self) -> &FitEntry {
        &self.outcome.result.fit
    }

    /// The signals at the samples that were fitted.
    pub fn series(&self) -> &Series {
        &self.outcome.law().series
    }

    /// What the law makes of another log, conditioned in the same way; nothing is fitted again.
    ///
    /// # Errors
    /// Where the log is of another kind of axis, or lacks a channel that the law needs; and after a method that does not
    /// model the force sample by sample.
    pub fn predict(&self, log: &Log) -> Result<Prediction, Error> {
        identify::predict(&self.outcome, &log.source)
    }

    /// The law as `stiction-friction` runs it, with a constant sigma1 as it was identified;
    /// [`FrictionLaw::capped`] is the form for simulation and control.
    ///
    /// # Errors
    /// Where an identified value is none that the law can have, such as a static friction below the Coulomb level.
    pub fn law(&self) -> Result<FrictionLaw, LawError> {
        let values = self.parameters().map(|p| (p.name(), p.value()));
        ParameterSet::from_text(self.law_kind(), values).law()
    }

    /// The compensator that [`export`](crate::export()) writes, as a value to be stepped every `cycle_time` seconds, driven
    /// by the reference velocity, with its limit and watchdog. Until the watchdog has seen the axis reverse without it, the
    /// force is 0. Other settings:
    /// [`Compensator::new`] with [`law`](Self::law).
    ///
    /// # Errors
    /// Where the law cannot be exported, or the cycle time is out of range.
    pub fn compensator(&self, cycle_time: f64) -> Result<Compensator<f64>, Error> {
        export::compensator(&self.model(), &ExportOptions::new(Target::Rust, cycle_time))
    }

    /// The law as `model.toml` keeps it: what [`export`](crate::export()) and studies take.
    pub fn model(&self) -> ModelFile {
        ModelFile::from_result(&self.outcome.result)
    }

    /// Everything that was found, as `result.json` keeps it.
    pub fn result(&self) -> &ResultFile {
        &self.outcome.result
    }

    /// The report, one HTML file without scripts.
    pub fn report(&self) -> String {
        report::identification(&self.outcome).to_html()
    }

    /// As the command line prints it: parameters, fit, what it may be used for.
    pub fn text(&self) -> String {
        stiction_pages::text::outcome(&self.outcome)
    }

    /// What the result is worth, in one word.
    pub fn verdict(&self) -> Verdict {
        self.outcome.verdict()
    }

    /// The files that [`write`](Self::write) writes: `result.json`, `model.toml`, `report.html`, `fit.csv`, and where a study
    /// takes the law `study.toml`.
    pub fn bundle(&self) -> Bundle {
        bundle::identification(&self.outcome)
    }

    /// The same for a folder, by which the commands in the report call those that follow.
    pub fn bundle_in(&self, folder: &Path) -> Bundle {
        bundle::identification_in(&self.outcome, folder)
    }

    /// The logs that were fitted, as they were given.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.outcome.sources.iter().map(|s| s.path.as_path())
    }

    /// Writes `result.json`, `model.toml`, `report.html` and `fit.csv` into a folder, whole or not at all.
    ///
    /// # Errors
    /// Where the folder cannot be written, or holds something that stiction did not write.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        let folder = folder.as_ref();
        stiction_files::check_folder(folder, false)?;
        stiction_files::check_inputs(folder, self.inputs())?;
        Ok(self.bundle_in(folder).write(folder)?)
    }
}
