//! What a first model or a first log says of the axis.

use super::law;
use crate::error::Error;
use crate::identify::{Files, Options, identify};
use crate::wording::{Setting, Wording};
use std::path::{Path, PathBuf};
use stiction_files::model::{ModelParameter, ReadModel};
use stiction_files::result::{Action, Trust};
use stiction_files::{ModelFile, Warning};
use stiction_identify::{LawKind, Observer};
use stiction_parameters::{Name, Quantity};
use stiction_plan::{Belief, Candidate, Elements, Nameplate, Subject};
use stiction_policy::plan;
use stiction_say::{Doubt, Notice};
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
    model: ModelFile,
    file: PathBuf,
    /// SHA-256 of what it was read from.
    pub sha256: String,
    /// Rate of the log, Hz, one encoder step, m (rad), and noise of the force, N (N m), where a log shows them.
    pub rate: Option<f64>,
    pub step: Option<f64>,
    pub force_noise: Option<f64>,
    /// Why it should not be planned from as it is.
    pub doubt: Option<Warning>,
}

/// Reads the model, or identifies the log as the axis file says.
pub(super) fn told(
    known: &Known,
    axis_file: &Path,
    (kind, law, asymmetric): (stiction_log::Motion, Option<LawKind>, bool),
    observer: &mut dyn Observer,
) -> Result<Told, Error> {
    match known {
        Known::Model(file) => {
            let model = ReadModel::read(file)?;
            fits(&model.model, file, kind)?;
            if let Some(law) = law.filter(|law| law.name() != model.model.law) {
                let found = format!("the law {}", model.model.law);
                let allowed = [
                    "a model of ".into(),
                    Setting::Law.is(law),
                    ", or that option left out".into(),
                ];
                return Err(refuse(file, found, allowed));
            }
            let kind = LawKind::from_name(&model.model.law);
            if asymmetric && kind.is_some_and(LawKind::has_elements) {
                let found = format!("the law {} with ", model.model.law);
                let found = [found.into(), Setting::Asymmetric.into()];
                return Err(refuse(file, found, law::same_both_ways()));
            }
            Ok(Told {
                doubt: (!model.model.trustworthy).then(|| planned_from(file, Doubt::Untrusted)),
                model: model.model,
                file: file.clone(),
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
                law: Some(law.unwrap_or(LawKind::LuGre)),
                asymmetric,
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
            fits(&model, file, kind)?;
            Ok(Told {
                doubt: misread(&outcome.result.trust).map(|doubt| planned_from(file, doubt)),
                model,
                file: file.clone(),
                sha256: sha256.unwrap_or_default(),
                rate: log.map(|log| log.rate_hz),
                step: log.and_then(|log| log.quantum),
                force_noise: noise.filter(|noise| *noise > 0.0),
            })
        }
    }
}

/// What has to be set right in how a first log is read before anything is planned from it, or what no motion takes out. What its motion
/// leaves open is no reason: a plan is for that.
fn misread(trust: &Trust) -> Option<Doubt> {
    let of_cause = trust.cause.as_ref().and_then(|cause| {
        let cure = match cause.cure.as_ref() {
            Some(Action::Line { table, line, .. }) => Some((line.clone(), table.clone())),
            Some(_) => return None,
            None => None,
        };
        Some(Doubt::Cause {
            text: cause.text.clone(),
            size: cause.size.clone(),
            cure,
        })
    });
    let reasons = trust.reasons.iter();
    let mut reasons = reasons.filter(|_| trust.next == Action::AxisFile);
    of_cause.or_else(|| Some(Doubt::Reason(reasons.next()?.clone())))
}

fn planned_from(file: &Path, doubt: Doubt) -> Warning {
    let file = file.display().to_string();
    Notice::PlannedFrom { file, doubt }.into()
}

fn refuse(file: &Path, found: impl Into<Wording>, allowed: impl Into<Wording>) -> Error {
    Error::usage(
        found.into().behind(format!("{}: ", file.display())),
        allowed,
    )
}

/// Refuses a model of another kind of axis or law, or in another unit of force.
fn fits(model: &ModelFile, file: &Path, kind: stiction_log::Motion) -> Result<(), Error> {
    if model.kind != kind.to_string() {
        let found = format!(
            "a {} axis; the limits are those of a {kind} one",
            model.kind
        );
        let allowed = "a model or log of the axis of the axis file";
        return Err(refuse(file, found, allowed));
    }
    let law = LawKind::from_name(&model.law).filter(|law| law::PLANNED.contains(law));
    let Some(law) = law else {
        return Err(refuse(
            file,
            format!("the law {}", model.law),
            [
                "a law that is planned for: identify with ".into(),
                Setting::Law.is(LawKind::LuGre),
                ", ".into(),
                Setting::Law.is(LawKind::MaxwellSlip),
                " or ".into(),
                Setting::Law.is(LawKind::Gms),
                ", or leave ".into(),
                Setting::Known.into(),
                " out".into(),
            ],
        ));
    };
    if law.has_elements() && model.asymmetric {
        let found = format!("the law {law} with parameters of each direction");
        return Err(refuse(file, found, law::same_both_ways()));
    }
    if model.force_unit != kind.force().si_text() {
        let found = format!("the force in {}", model.force_unit);
        let allowed = format!(
            "{}: give the force of the log a scale",
            kind.force().si_text()
        );
        return Err(refuse(file, found, allowed));
    }
    let stiffness = match law.has_elements() {
        true => Quantity::ElementStiffness(1),
        false => Quantity::Sigma0,
    };
    for name in [stiffness, Quantity::Mass] {
        if find(model, &Name::from(name).to_string()).is_none() {
            return Err(lacks(file, &Name::from(name).to_string()));
        }
    }
    Ok(())
}

fn lacks(file: &Path, name: &str) -> Error {
    let allowed = "a model with all parameters of its law and the mass";
    refuse(file, format!("no {name}"), allowed.to_string())
}

fn find<'a>(model: &'a ModelFile, name: &str) -> Option<&'a ModelParameter> {
    model.parameter.iter().find(|p| p.name == name)
}

impl Told {
    /// Whether each direction has parameters of its own.
    pub fn is_asymmetric(&self) -> bool {
        self.model.asymmetric
    }

    /// Its Maxwell-slip elements.
    pub fn elements(&self) -> Option<Elements> {
        let kind = LawKind::from_name(&self.model.law)?;
        let names = self.model.parameter.iter().map(|p| p.name.parse::<Name>());
        let is_one = |name: &Name| matches!(name.quantity, Quantity::ElementStiffness(_));
        law::elements(kind, names.flatten().filter(is_one).count())
    }

    /// kg (kg m^2)
    pub fn mass(&self) -> Option<f64> {
        find(&self.model, "mass").map(|p| p.value)
    }

    /// What friction or the force of the model depends on and the subject does not have.
    pub fn beyond(&self, subject: &Subject) -> Vec<String> {
        let names = subject.names();
        // Of elements the stiffness of all and the level at rest, or the one level, are sums over them.
        let is_sum = |quantity: Quantity| {
            let sums = [Quantity::Sigma0, Quantity::Static, Quantity::Coulomb];
            subject.elements.is_some()
                && (sums.contains(&quantity) || matches!(quantity, Quantity::ElementForce(_)))
        };
        let counts = |name: &Name| {
            !matches!(
                name.quantity,
                Quantity::Offset | Quantity::Delay | Quantity::StribeckExponent
            ) && !name.quantity.is_a_reference()
                && !is_sum(name.quantity)
                && !names.contains(&name.to_string())
        };
        let parsed = self.model.parameter.iter();
        let parsed = parsed.filter_map(|p| p.name.to_string().parse::<Name>().ok());
        let exponent = find(&self.model, "stribeck_exponent").filter(|p| p.value != 2.0);
        parsed
            .filter(counts)
            .map(|name| name.to_string())
            .chain(exponent.map(|_| "stribeck_exponent".to_string()))
            .collect()
    }

    /// Correlations of parameters by the covariance of the model; those that are not determined go with none.
    fn correlations(&self, names: &[String], deviations: &[Option<f64>]) -> Vec<Vec<f64>> {
        let covariance = &self.model.covariance;
        let places: Vec<Option<usize>> = names
            .iter()
            .zip(deviations)
            .map(|(name, deviation)| {
                deviation.filter(|d| *d > 0.0)?;
                covariance.names.iter().position(|own| own == name)
            })
            .collect();
        let between = |i: usize, j: usize| {
            let (a, b) = (places[i]?, places[j]?);
            let at = |a: usize, b: usize| covariance.matrix.get(a)?.get(b).copied();
            let found = at(a, b)? / (at(a, a)? * at(b, b)?).sqrt();
            found.is_finite().then(|| found.clamp(-1.0, 1.0))
        };
        let row = |i: usize| {
            (0..names.len())
                .map(|j| match i == j {
                    true => 1.0,
                    false => between(i, j).unwrap_or(0.0),
                })
                .collect()
        };
        (0..names.len()).map(row).collect()
    }

    /// The belief that the model gives of an axis with this nameplate.
    pub fn belief(&self, subject: &Subject, plate: &Nameplate) -> Result<Belief, Error> {
        let first_term = subject.first_term();
        let mut values = Vec::new();
        let mut found = Vec::new();
        for (i, name) in subject.names().iter().enumerate() {
            let own = find(&self.model, name);
            // A model of one curve for both directions says little of each.
            let both = name
                .strip_suffix("_pos")
                .or_else(|| name.strip_suffix("_neg"))
                .and_then(|stem| find(&self.model, stem));
            match (own.or(both), i < first_term) {
                (Some(p), _) => values.push(p.value),
                // A term that the model does not have is what the nameplate allows.
                (None, false) => values.push(0.0),
                (None, true) => return Err(lacks(&self.file, name)),
            }
            found.push(own);
        }
        let Some(axis) = Candidate::of(subject, &values) else {
            return Err(lacks(&self.file, "parameter of the law"));
        };
        let axis = plate.at_least(axis);
        let units = axis.units();
        let deviation = |(p, unit): (&Option<&ModelParameter>, &f64)| {
            let p = (*p)?;
            let relative = p.std.map(|std| std / unit);
            let relative =
                relative.filter(|d| d.is_finite() && *d < plan::MAX_DETERMINED_DEVIATION);
            match p.origin.as_str() {
                "given" => Some(0.0),
                _ => relative.filter(|_| p.identifiable),
            }
        };
        let deviations: Vec<Option<f64>> = found.iter().zip(&units).map(deviation).collect();
        let correlations = match subject.elements {
            Some(_) => self.correlations(&subject.names()[..first_term], &deviations),
            None => Vec::new(),
        };
        let belief = Belief {
            axis,
            deviations,
            correlations,
        };
        belief.validate().map_err(|e| {
            let found = format!("{} = {}", e.name, stiction_number::short(e.value));
            let allowed = format!(
                "{}; without a usable first fit plan from the nameplate alone",
                e.allowed
            );
            refuse(&self.file, found, allowed)
        })?;
        Ok(belief)
    }
}
