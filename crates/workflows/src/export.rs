//! `stiction export`: a model file to the compensator's code.

mod compile;

use crate::error::Error;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_export::{Model, Parameter, Provenance};
use stiction_files::ModelFile;
use stiction_files::Warning;
use stiction_files::model::ReadModel;
use stiction_files::{sha256_of, write_folder};
use stiction_friction::ParamError;
use stiction_friction::compensator::{Friction, Settings};
use stiction_parameters::{FrictionLaw, LawError, LawKind, Name};

pub use stiction_export::Target;

/// What to export, as typed.
#[derive(Clone, Debug)]
pub struct ExportOptions {
    /// The model file.
    pub model: PathBuf,
    /// The form to write.
    pub target: Target,
    /// Beginning of the names in the code; from the model's name if absent.
    pub name: Option<String>,
    /// Time between two calls, s.
    pub cycle_time: f64,
    /// Largest force, in the unit of the model's; twice the static friction and the offset if absent, in a table as much
    /// as it holds. Not for `mujoco`.
    pub limit: Option<f64>,
    /// Force that the motor is rated for, in the unit of the model's; for `tf5200`, and for no other target.
    pub rated_force: Option<f64>,
}

/// A compensator that was written.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Exported {
    /// The target.
    pub target: &'static str,
    /// Beginning of the names in the code.
    pub name: String,
    /// Law.
    pub law: String,
    /// Time between two calls, s.
    pub cycle_time: f64,
    /// Largest force, in `force_unit`.
    pub limit: f64,
    /// Unit of the force.
    pub force_unit: String,
    /// Files, in the folder named.
    pub written: Vec<String>,
    /// What to know before it runs.
    pub warnings: Vec<Warning>,
    /// Whether the identification found every number of the law trustworthy.
    pub trustworthy: bool,
}

/// Friction that changes with something the compensator does not see.
const NOT_IN_THE_LAW: [&str; 3] = ["quadratic_viscous", "coulomb_", "sigma2_"];

/// Feedforward of its own, beside friction.
const BESIDE: [&str; 4] = ["mass", "delay", "gravity_", "cogging"];

/// Writes the compensator of a model into `dir`, a folder that is new or empty: whole, or not at all.
///
/// # Errors
/// When the model cannot be read or exported, or the folder is not free.
pub fn export(options: &ExportOptions, dir: &Path) -> Result<Exported, Error> {
    if options.rated_force.is_some() && options.target != Target::Tf5200 {
        return Err(Error::Usage {
            found: format!("a rated force for the target {}", options.target.name()),
            allowed: "only tf5200 takes one".into(),
        });
    }
    if options.limit.is_some() && options.target == Target::Mujoco {
        return Err(Error::Usage {
            found: "a limit for the target mujoco".into(),
            allowed: "a joint in MuJoCo has its whole friction".into(),
        });
    }
    let read = ReadModel::read(&options.model)?;
    let file = &read.model;
    let bytes = std::fs::read(&options.model)
        .map_err(|e| stiction_files::Error::output(&options.model, e.to_string()))?;
    let (mut model, mut warnings) = resolve(&read, &bytes, options)?;
    if options.limit.is_none() && options.target == Target::Tf5200 {
        model.settings.limit = stiction_export::largest_force_in_table(&model);
    }
    let found = stiction_export::advice(&model, options.target);
    warnings.extend(found.into_iter().map(|a| Warning::new(a.code, a.message)));
    model.notes = warnings.iter().map(|w| w.message.clone()).collect();
    let files = match options.target {
        Target::Fmu => {
            let mut whole = true;
            let files = stiction_export::fmu(&model, &mut |source| {
                let library = compile::shared_library(source);
                whole &= library.is_some();
                library
            })
            .map_err(|e| place(e, options))?;
            if !whole {
                warnings.push(Warning::new(
                    Code::ExportSource,
                    "gcc for x86-64 Linux was not found or failed: the FMUs hold their C source and no binary; a tool that runs them has to compile it, \
                     or install gcc and export again",
                ));
            }
            files
        }
        target => stiction_export::export(&model, target).map_err(|e| place(e, options))?,
    };
    write_folder(
        dir,
        files.iter().map(|f| (f.path.as_str(), f.bytes.as_slice())),
    )?;
    Ok(Exported {
        target: options.target.name(),
        name: model.identifier,
        law: file.law.clone(),
        cycle_time: model.settings.cycle_time,
        limit: model.settings.limit,
        force_unit: model.force_unit,
        written: files.into_iter().map(|f| f.path).collect(),
        trustworthy: !warnings.iter().any(|w| w.code == Code::ExportUntrusted),
        warnings,
    })
}

fn resolve(
    read: &ReadModel,
    bytes: &[u8],
    options: &ExportOptions,
) -> Result<(Model, Vec<Warning>), Error> {
    let file = &read.model;
    if let Some(p) = file.parameter.iter().find(|p| out_of_the_law(&p.name)) {
        let allowed = "the compensator has no such term; identify without it";
        return Err(read
            .refuse_parameter(&p.name, p.name.as_str(), allowed)
            .into());
    }
    let friction = friction(file).map_err(|e| match e {
        Unfit::Law => read.refuse(
            "law",
            file.law.as_str(),
            "export coulomb-viscous, stribeck, dahl or lugre; identify with --law lugre",
        ),
        Unfit::Missing(name) => read.refuse(
            "parameter",
            format!("no {name}"),
            "every parameter of the law",
        ),
        Unfit::Value(e) => read.refuse_parameter(
            e.name,
            format!("{} = {}", e.name, stiction_number::shortest(e.value)),
            e.allowed,
        ),
    })?;
    let title = file.name.clone().unwrap_or_else(|| "axis".into());
    let identifier = match &options.name {
        Some(name) => name.clone(),
        None => stiction_export::identifier(&title),
    };
    let limit = options.limit.unwrap_or_else(|| default_limit(&friction));
    let mut warnings = doubts(file);
    if options.name.is_none() && !stiction_export::is_whole(&title) {
        warnings.push(Warning::new(
            Code::ExportName,
            format!(
                "the names in the code begin with {identifier}, which is not all of the axis' name '{title}': another axis may get the same; give one with --name"
            ),
        ));
    }
    let model = Model {
        title,
        identifier,
        rotary: file.kind == "rotary",
        force_unit: file.force_unit.replace('*', " "),
        friction,
        settings: Settings::new(options.cycle_time, limit),
        rated_force: options.rated_force,
        top_speed: file.source.top_speed,
        parameters: file
            .parameter
            .iter()
            .map(|p| Parameter {
                name: p.name.clone(),
                value: p.value,
                unit: p.unit.clone(),
                interval: p.ci95,
                identifiable: p.identifiable,
                given: p.origin == "given",
            })
            .collect(),
        notes: vec![],
        provenance: Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            model_sha256: sha256_of(bytes),
            inputs: file
                .source
                .inputs
                .iter()
                .map(|input| (input.path.clone(), input.sha256.clone()))
                .collect(),
        },
    };
    Ok((model, warnings))
}

fn out_of_the_law(name: &str) -> bool {
    NOT_IN_THE_LAW.iter().any(|stem| name.starts_with(stem))
        && !matches!(
            name,
            "coulomb_pos" | "coulomb_neg" | "sigma2_pos" | "sigma2_neg"
        )
}

/// A refusal with the file it came from, where it is of a number in that file.
fn place(source: stiction_export::Error, options: &ExportOptions) -> Error {
    use stiction_export::Error::{Number, Range};
    let name = match &source {
        Range { name, .. } => *name,
        Number { source, .. } => source.name,
        _ => return source.into(),
    };
    if (name == "limit" && options.limit.is_some()) || name == "rated_force" {
        return source.into();
    }
    Error::ExportModel {
        file: options.model.clone(),
        source,
    }
}

/// What the identification flagged as not trustworthy, and what the code leaves out.
fn doubts(file: &ModelFile) -> Vec<Warning> {
    let mut found = Vec::new();
    if !file.trustworthy {
        found.push(Warning::new(
            Code::ExportUntrusted,
            "the identification flagged this model as not trustworthy; a compensation with it may be too strong",
        ));
    }
    let beside = |name: &str| BESIDE.iter().any(|stem| name.starts_with(stem));
    let names = |wanted: &dyn Fn(&stiction_files::model::ModelParameter) -> bool| -> Vec<&str> {
        let chosen = file.parameter.iter().filter(|p| wanted(p));
        chosen.map(|p| p.name.as_str()).collect()
    };
    let loose = names(&|p| !p.identifiable && p.origin != "given" && !beside(&p.name));
    if !loose.is_empty() {
        found.push(Warning::new(
            Code::ExportUntrusted,
            format!(
                "the data do not determine {}; the compensation rests on a guess there",
                loose.join(", ")
            ),
        ));
    }
    let left = names(&|p| beside(&p.name) && p.name != "delay");
    if !left.is_empty() {
        found.push(Warning::new(
            Code::ExportTerms,
            format!(
                "{} is not friction and not in the compensator; feed it forward separately",
                left.join(", ")
            ),
        ));
    }
    found
}

/// Twice the force of standstill: room for the viscous part, far below what a drive can do.
fn default_limit(friction: &Friction<f64>) -> f64 {
    let (level, offset) = match friction {
        Friction::Coulomb(law) => (law.coulomb()[0].max(law.coulomb()[1]), law.offset()),
        Friction::Stribeck(curve) => (curve.largest_static_level(), curve.offset()),
        Friction::LuGre(law) => (law.curve().largest_static_level(), law.curve().offset()),
    };
    2.0 * (level + offset.abs())
}

/// Why the numbers of a model make no law that is exported.
enum Unfit {
    Law,
    Missing(Name),
    Value(ParamError),
}

impl From<LawError> for Unfit {
    fn from(e: LawError) -> Self {
        match e {
            LawError::Missing { name, .. } => Unfit::Missing(name),
            LawError::NotLuGre { .. } => Unfit::Law,
            LawError::Value(e) => Unfit::Value(e),
        }
    }
}

/// The law as it was identified, sigma1 constant: the export caps it, and warns where that counts.
fn friction(file: &ModelFile) -> Result<Friction<f64>, Unfit> {
    let values = file.values().ok_or(Unfit::Law)?;
    match values.kind() {
        LawKind::ElastoPlastic | LawKind::MaxwellSlip | LawKind::Gms => return Err(Unfit::Law),
        LawKind::CoulombViscous | LawKind::Stribeck | LawKind::Dahl | LawKind::LuGre => {}
    }
    match values.law()? {
        FrictionLaw::CoulombViscous(law) => Ok(Friction::Coulomb(law)),
        FrictionLaw::Stribeck(curve) => Ok(Friction::Stribeck(curve)),
        FrictionLaw::LuGre(law) => Ok(Friction::LuGre(law)),
        FrictionLaw::ElastoPlastic(_) | FrictionLaw::MaxwellSlip(_) => Err(Unfit::Law),
    }
}
