//! An identified law with everything that is known of it.

use crate::findings::findings;
use crate::{Error, Law, Log, Model, Prediction, Quality, Series};
use std::path::{Path, PathBuf};
use stiction_files::ModelFile;
use stiction_friction::compensator::Compensator;
use stiction_pages::{bundle, report, text};
use stiction_workflows::Verdict;
use stiction_workflows::identify::{Outcome, predict};

/// What an identification found: the law, its parameters with intervals, friction by velocity, how well it fits, and whether it may
/// be trusted.
#[derive(Clone, Debug)]
pub struct Fit(pub(crate) Outcome);

findings!(Fit, |fit| &fit.0.result);

impl Fit {
    /// What the result is worth, in one word.
    pub fn verdict(&self) -> Verdict {
        self.0.verdict()
    }

    /// The signals at the samples that were fitted.
    pub fn series(&self) -> Series {
        Series::of(self.0.law().series.clone())
    }

    /// What the law makes of another log, conditioned in the same way; nothing is fitted again.
    ///
    /// # Errors
    /// Where the log is of another kind of axis, or lacks a channel that the law needs; and after a method that does not
    /// model the force sample by sample.
    pub fn predict(&self, log: &Log) -> Result<Prediction, Error> {
        let found = predict(&self.0, &log.0).map_err(Error::of)?;
        Ok(Prediction {
            quality: Quality::of(&found.quality),
            series: Series::of(found.series),
        })
    }

    /// The law with its numbers, sigma1 constant as it was identified; [`Law::stepped`] is the form for simulation and control.
    ///
    /// # Errors
    /// Where an identified value is one that the law cannot have, such as a static friction below the Coulomb level.
    pub fn law(&self) -> Result<Law, Error> {
        self.model().law()
    }

    /// The compensator that [`Export`](crate::Export) writes, as a value to be stepped every `cycle_time` seconds, driven by the
    /// reference velocity, with its limit and watchdog. Until the watchdog has seen the axis reverse without it, the force is 0.
    ///
    /// # Errors
    /// Where the law cannot be exported, or the cycle time is out of range.
    pub fn compensator(&self, cycle_time: f64) -> Result<Compensator<f64>, Error> {
        self.model().compensator(cycle_time)
    }

    /// The law as `model.toml` keeps it: what [`Export`](crate::Export) and studies take.
    pub fn model(&self) -> Model {
        Model(ModelFile::from_result(&self.0.result))
    }

    /// The report, one HTML file without scripts.
    pub fn report(&self) -> String {
        report::identification(&self.0).to_html()
    }

    /// As the command line prints it: parameters, fit, what it may be used for.
    pub fn text(&self) -> String {
        text::outcome(&self.0)
    }

    /// Writes `result.json`, `model.toml`, `report.html`, `fit.csv`, and where a study takes the law `study.toml` into a folder, whole
    /// or not at all; their paths.
    ///
    /// # Errors
    /// Where the folder cannot be written, or holds something that stiction did not write.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        let folder = folder.as_ref();
        let inputs = self.0.sources.iter().map(|source| source.path.as_path());
        let written = stiction_files::check_folder(folder, false)
            .and_then(|()| stiction_files::check_inputs(folder, inputs))
            .and_then(|()| bundle::identification_in(&self.0, folder).write(folder));
        written.map_err(Error::of)
    }
}
