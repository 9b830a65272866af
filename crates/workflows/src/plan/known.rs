//! What a first model or a first log says of the axis.

use crate::error::Error;
use crate::identify::{Files, Options, identify};
use std::path::{Path, PathBuf};
use stiction_files::ModelFile;
use stiction_files::model::ReadModel;
use stiction_identify::{LawKind, Observer};
use stiction_plan::{Belief, Candidate, NAMES, PARAMETERS};
use stiction_signal::noise_deviation;

/// What is known of an axis beside its nameplate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Known {
    /// A model that was identified before.
    Model(PathBuf),
    /// A first log, which is identified, and will be identified together with that of the motion.
    Log(PathBuf),
}

impl Known {
    /// The file.
    pub fn file(&self) -> &Path {
        match self {
            Known::Model(file) | Known::Log(file) => file,
        }
    }
}

/// What it says.
pub(super) struct Told {
    pub belief: Belief,
    /// SHA-256 of what it was read from.
    pub sha256: String,
    /// Rate of the log, Hz, one encoder step, m (rad), and noise of the force, N (N m), where a log shows them.
    pub rate: Option<f64>,
    pub step: Option<f64>,
    pub force_noise: Option<f64>,
}

/// Reads the model, or identifies the log as the axis file says.
pub(super) fn told(
    known: &Known,
    axis_file: &Path,
    kind: stiction_log::Motion,
    observer: &mut dyn Observer,
) -> Result<Told, Error> {
    match known {
        Known::Model(file) => {
            let model = ReadModel::read(file)?;
            Ok(Told {
                belief: belief(&model.model, file, kind)?,
                sha256: model.sha256,
                rate: None,
                step: None,
                force_noise: None,
            })
        }
        Known::Log(file) => {
            let files = Files {
                logs: vec![file.clone()],
                axis: Some(axis_file.into()),
                ..Files::default()
            };
            let options = Options {
                law: Some(LawKind::LuGre),
                compare_laws: false,
                ..Options::default()
            };
            let outcome = identify(&files, &options, observer)?;
            let source = outcome.sources.first();
            let sha256 = source.map(|source| source.sha256.clone());
            let log = source.map(|source| &source.log);
            let force = log.and_then(|log| log.force.as_deref());
            let noise = force.map(|force| noise_deviation(std::iter::once(force)));
            let model = ModelFile::from_result(&outcome.result);
            Ok(Told {
                belief: belief(&model, file, kind)?,
                sha256: sha256.unwrap_or_default(),
                rate: log.map(|log| log.rate_hz),
                step: log.and_then(|log| log.quantum),
                force_noise: noise.filter(|noise| *noise > 0.0),
            })
        }
    }
}

/// Largest relative deviation with which a parameter counts as determined.
const DETERMINED: f64 = 0.5;

/// The belief that a model gives: a symmetric LuGre law with a mass, in N (N m).
fn belief(model: &ModelFile, file: &Path, kind: stiction_log::Motion) -> Result<Belief, Error> {
    let refuse = |found: String, allowed: &str| {
        Error::usage(format!("{}: {found}", file.display()), allowed.to_string())
    };
    if model.kind != kind.to_string() {
        let found = format!(
            "a {} axis; the limits are those of a {kind} one",
            model.kind
        );
        return Err(refuse(found, "a model or log of the axis of the axis file"));
    }
    if model.law != LawKind::LuGre.name() || model.asymmetric {
        let side = if model.asymmetric { ", asymmetric" } else { "" };
        let found = format!("the law {}{side}", model.law);
        return Err(refuse(
            found,
            "symmetric LuGre: identify with --law lugre, or leave --model out",
        ));
    }
    if model.force_unit != kind.force().si_text() {
        let found = format!("the force in {}", model.force_unit);
        let allowed = format!(
            "{}: give the force of the log a scale",
            kind.force().si_text()
        );
        return Err(refuse(found, &allowed));
    }
    let mut values = [0.0; PARAMETERS];
    let mut deviations = [None; PARAMETERS];
    for (i, name) in NAMES.iter().enumerate() {
        let Some(p) = model.parameter.iter().find(|p| p.name == *name) else {
            return Err(refuse(
                format!("no {name}"),
                "a model with all parameters of LuGre and the mass",
            ));
        };
        values[i] = p.value;
        let relative = p
            .std
            .map(|std| std / p.value)
            .filter(|d| d.is_finite() && *d < DETERMINED);
        deviations[i] = match p.origin.as_str() {
            "given" => Some(0.0),
            _ => relative.filter(|_| p.identifiable),
        };
    }
    let belief = Belief {
        axis: Candidate::from_values(values),
        deviations,
    };
    belief.validate().map_err(|e| {
        let found = format!("{} = {}", e.name, stiction_number::short(e.value));
        refuse(
            found,
            &format!(
                "{}; without a usable first fit plan from the nameplate alone",
                e.allowed
            ),
        )
    })?;
    Ok(belief)
}
