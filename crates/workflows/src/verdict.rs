//! What the outcome of a workflow is worth, in one word.

use crate::check::Check;
use crate::export::{Exported, ExportedRobot};
use crate::identify::Outcome;
use crate::plan::Planned;
use crate::reproduce::Reproduction;
use crate::robot::RobotOutcome;
use crate::study::StudyOutcome;
use serde::Serialize;
use stiction_files::batch::BatchFile;
use stiction_files::compare_file::CompareFile;
use stiction_files::drift_file::DriftFile;
use stiction_files::result::Status;

/// Whether an outcome may be used. What a process exits with follows from it, and from nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Verdict {
    /// It may be used.
    Trustworthy,
    /// It is complete, and flagged as not trustworthy; the outcome says why.
    NotTrustworthy,
    /// The user stopped the work; what was done until then is there.
    Interrupted,
}

impl Verdict {
    /// Name as files and Python have it.
    #[doc(hidden)]
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Trustworthy => "trustworthy",
            Verdict::NotTrustworthy => "not-trustworthy",
            Verdict::Interrupted => "interrupted",
        }
    }

    fn new(interrupted: bool, trustworthy: bool) -> Self {
        match (interrupted, trustworthy) {
            (true, _) => Verdict::Interrupted,
            (false, true) => Verdict::Trustworthy,
            (false, false) => Verdict::NotTrustworthy,
        }
    }
}

impl Outcome {
    /// What the identification is worth.
    pub fn verdict(&self) -> Verdict {
        let interrupted = self.result.search.status == Status::Interrupted;
        Verdict::new(interrupted, self.result.trust.trustworthy)
    }
}

impl RobotOutcome {
    /// Whether the model predicts the torque of every joint.
    pub fn verdict(&self) -> Verdict {
        let found = self
            .joints
            .iter()
            .filter_map(|own| own.outcome.as_ref().ok());
        let interrupted = found
            .map(Outcome::verdict)
            .any(|v| v == Verdict::Interrupted);
        Verdict::new(interrupted, self.result.trust.trustworthy)
    }
}

impl Check {
    /// Whether each log determines a law that may be trusted, and no log follows its reference worse than the first.
    pub fn verdict(&self) -> Verdict {
        let trusted = self.logs.iter().all(|log| log.refused.is_none());
        let worse = self.tracking.iter().any(|change| change.worse);
        Verdict::new(false, trusted && !worse)
    }
}

impl StudyOutcome {
    /// Whether runs were made, and exported C gave the force of its model; warnings name what was not so.
    pub fn verdict(&self) -> Verdict {
        let any = !self.file.results.is_empty();
        let exported = self.file.exported_c.as_ref();
        let same = exported.is_none_or(|c| !c.runs.iter().any(|run| run.differs));
        Verdict::new(self.file.status == "interrupted", any && same)
    }
}

impl Planned {
    /// Whether all that is wanted is expected of the motion.
    pub fn verdict(&self) -> Verdict {
        let met = self.file.wanted.iter().all(|wish| wish.met);
        Verdict::new(self.file.status != "complete", met)
    }
}

impl Reproduction {
    /// Whether all numbers are there and within their tolerance.
    pub fn verdict(&self) -> Verdict {
        Verdict::new(self.file.status == "interrupted", self.file.all_within)
    }
}

impl ExportedRobot {
    /// Whether the identification trusts the friction law of every joint.
    pub fn verdict(&self) -> Verdict {
        Verdict::new(false, self.trustworthy)
    }
}

impl Exported {
    /// Whether the identification trusts every number of the law.
    pub fn verdict(&self) -> Verdict {
        Verdict::new(false, self.trustworthy)
    }
}

/// Whether something was identified of every log of a batch, and may be used.
pub fn of_batch(file: &BatchFile) -> Verdict {
    let is_trusted = file.trustworthy == file.logs && file.apart.is_empty();
    Verdict::new(file.status == "interrupted", is_trusted)
}

/// Whether nothing changed, on any machine, and no limit is exceeded.
pub fn of_drift(file: &DriftFile) -> Verdict {
    Verdict::new(false, file.alarms.is_empty() && file.apart.is_empty())
}

/// Whether all runs of a comparison were made.
pub fn of_comparison(file: &CompareFile) -> Verdict {
    Verdict::new(file.status == "interrupted", true)
}
