//! `stiction export`: a model file to the compensator's code.

mod adapting;
mod asked;
mod domain;
mod doubts;
mod law;
mod reserve;
mod robot;
mod settings;
mod terms;
mod wrapped;

use crate::compile;
use crate::error::Error;
use std::path::Path;
use stiction_export::{Backlash, Domain, Model, Parameter, Provenance};
use stiction_files::ModelFile;
use stiction_files::Warning;
use stiction_files::model::ReadModel;
use stiction_files::write_folder;
use stiction_friction::ParamError;
use stiction_friction::compensator::{Adaptation, Compensator};
use stiction_say::Notice;

use asked::{few_enough, within};
use doubts::{another_rate, doubts, less, untrusted};
use law::{Unfit, bent, friction, quadratic};
use settings::{asked, settings_of_law};

pub(crate) use asked::check;
pub use robot::{ExportedJoint, ExportedRobot, export_robot_file};
pub use stiction_export::{Draws, Error as ExportError, File, Platform, Target, Width};
pub use terms::Feedforward;

/// What code to write, and the settings of the compensator.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ExportOptions {
    /// The form to write.
    pub target: Target,
    /// Beginning of the names in the code; from the model's name if absent.
    pub name: Option<String>,
    /// Time between two calls, s.
    pub cycle_time: f64,
    /// Largest force, in the unit of the model's. If absent: twice the sum of static friction and offset, or for a
    /// table the largest force that it can hold. Not for a simulated joint ([`Target::is_simulated`]), `drive-table`
    /// or a map ([`Target::is_map`]).
    pub limit: Option<f64>,
    /// Force that the motor is rated for, in the unit of the model's; for `tf5200`, and for no other target.
    pub rated_force: Option<f64>,
    /// Share of the friction that is compensated, 0 to 1; 0.75 if absent. Not for a simulated joint, `drive-table` or a map.
    pub gain: Option<f64>,
    /// Settings of the compensator; not for simulated joints, maps, `tf5200` and `drive-table`, which have none of them.
    pub safety: Safety,
    /// Levels that follow the machine while it runs ([`Adaptation`]), from the force of the drive; not for
    /// simulated joints, maps, `tf5200` and `drive-table`.
    pub adapt: bool,
    /// Draws of what simulators take; for `domain-json`, `mujoco`, `isaaclab`, `newton` and `bam` ([`Target::takes_draws`]).
    pub draws: Option<Draws>,
    /// What is fed forward beside friction, of what the model has; not for simulated joints, maps, `tf5200` and `drive-table`.
    pub feedforward: Feedforward,
}

/// Settings of a compensator; those that are absent follow from the law ([`Settings::for_law`](stiction_friction::compensator::Settings::for_law)).
#[derive(Clone, Copy, Debug, Default)]
pub struct Safety {
    /// Time in which the compensation goes from 0 to its full value, s.
    pub ramp: Option<f64>,
    /// Speeds up to this count as standstill, m/s (rad/s). If absent, for a law without a Stribeck velocity a thousandth of
    /// the top speed of the recordings, where the model has it.
    pub dead_zone: Option<f64>,
    /// Fastest change of the force, in the unit of the model's force per second.
    pub slew: Option<f64>,
    /// Moving time that the watchdog compares, s; 0: no watchdog.
    pub window: Option<f64>,
}

impl ExportOptions {
    /// A form with the time between two calls, s; names from the model's, limit from its law.
    pub fn new(target: Target, cycle_time: f64) -> Self {
        Self {
            target,
            name: None,
            cycle_time,
            limit: None,
            rated_force: None,
            gain: None,
            safety: Safety::default(),
            adapt: false,
            draws: None,
            feedforward: Feedforward::default(),
        }
    }
}

/// The code of a compensator.
#[derive(Clone, Debug, serde::Serialize)]
#[non_exhaustive]
pub struct Exported {
    /// The target.
    pub target: &'static str,
    /// Beginning of the names in the code.
    pub name: String,
    /// Whether nothing gave that name: it is the file name of the log.
    pub named_after_log: bool,
    /// Law.
    pub law: String,
    /// Time between two calls, s.
    pub cycle_time: f64,
    /// Largest force, in `force_unit`.
    pub limit: f64,
    /// Unit of the force.
    pub force_unit: String,
    /// Platforms that FMUs have a binary for, by their names in FMI 3.0.
    #[serde(serialize_with = "names", skip_serializing_if = "Vec::is_empty")]
    pub binaries: Vec<Platform>,
    /// Paths of the files, relative to their folder.
    pub written: Vec<String>,
    /// The files.
    #[serde(skip)]
    pub files: Vec<File>,
    /// What to know before it runs.
    pub warnings: Vec<Warning>,
    /// Whether the identification found that the law may be used to compensate.
    pub trustworthy: bool,
    /// Where the default gain leaves more of the friction than the identification leaves open: that gain, and how well friction is
    /// known, percent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reserve: Option<Reserve>,
}

/// A gain with a margin that the identification does not need.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Reserve {
    /// Fraction of the friction that is compensated.
    pub gain: f64,
    /// Half of the widest 95 % interval of the levels of friction, or how far friction was from its mean in the log, percent.
    pub known_within_percent: f64,
}

impl Exported {
    /// Writes the files into `dir`, a folder that is new, empty or of an earlier export: whole, or not at all. Files that an export
    /// wrote there are replaced, with `force` any of the same names; others are kept.
    ///
    /// # Errors
    /// When the folder holds something else, a file to be replaced was changed, or it cannot be written.
    pub fn write(&self, dir: impl AsRef<Path>, force: bool) -> Result<(), Error> {
        let files = self.files.iter();
        let files = files.map(|f| (f.path.as_str(), f.bytes.as_slice()));
        Ok(write_folder(dir, files, force)?)
    }
}

/// The compensator of a model in memory, as code.
///
/// # Errors
/// When the model cannot be exported in this form, or an option is out of range. A number of the model is named by its
/// key.
pub fn export(model: &ModelFile, options: &ExportOptions) -> Result<Exported, Error> {
    check(options)?;
    code(&ReadModel::of(model)?, options)
}

/// The compensator of a model file, as code.
///
/// # Errors
/// As [`export`], and when the file cannot be read.
pub fn export_file(file: impl AsRef<Path>, options: &ExportOptions) -> Result<Exported, Error> {
    check(options)?;
    code(&ReadModel::read(file)?, options)
}

/// The compensator of a model as a Rust value: what [`export`] writes for [`Target::Rust`], to be stepped once a cycle.
///
/// # Errors
/// As [`export`].
pub fn compensator(model: &ModelFile, options: &ExportOptions) -> Result<Compensator<f64>, Error> {
    check(options)?;
    let read = ReadModel::of(model)?;
    let (model, _) = resolve(&read, options)?;
    // The code has ranges of its own, such as that of the cycle time, which are checked where it is written.
    let written = stiction_export::export(&model, Target::Rust);
    let made = written.and_then(|_| model.in_rust());
    made.map_err(|e| place(e, &read, options))
}

/// The same of a model that was read.
pub(crate) fn compensator_of(
    read: &ReadModel,
    options: &ExportOptions,
) -> Result<Compensator<f64>, Error> {
    let (model, _) = resolve(read, options)?;
    model.in_rust().map_err(|e| place(e, read, options))
}

/// The code of a model; `file` is for messages.
fn code(read: &ReadModel, options: &ExportOptions) -> Result<Exported, Error> {
    let (mut model, mut warnings) = resolve(read, options)?;
    if options.limit.is_none() && options.target == Target::Tf5200 {
        model.settings.limit = stiction_export::largest_force_in_table(&model);
    }
    let found = stiction_export::advice(&model, options.target);
    warnings.extend(found.into_iter().map(|a| Warning::new(a.code, a.message)));
    model.notes = warnings.iter().map(|w| w.message.clone()).collect();
    let mut tried = Vec::new();
    let files = match options.target {
        Target::Fmu => {
            let files = stiction_export::fmu(&model, &mut |source, platform| {
                let library = compile::shared_library(source, platform);
                tried.push((platform, library.is_some()));
                library
            })
            .map_err(|e| place(e, read, options))?;
            if !tried.iter().any(|(_, is_made)| *is_made) {
                warnings.push(Notice::SourceOnly.into());
            }
            files
        }
        target => stiction_export::export(&model, target).map_err(|e| place(e, read, options))?,
    };
    let gain = model.settings.gain;
    Ok(Exported {
        target: options.target.name(),
        name: model.identifier,
        named_after_log: options.name.is_none() && read.model.name.is_none(),
        law: read.model.law.clone(),
        cycle_time: model.settings.cycle_time,
        limit: model.settings.limit,
        force_unit: model.force_unit,
        binaries: inside(&tried),
        written: files.iter().map(|f| f.path.clone()).collect(),
        files,
        trustworthy: read.model.trustworthy,
        reserve: reserve::of(&read.model, options, gain),
        warnings,
    })
}

/// Platforms for which every binary that was tried was made.
fn inside(tried: &[(Platform, bool)]) -> Vec<Platform> {
    let of = |platform| tried.iter().filter(move |(p, _)| *p == platform);
    let all = Platform::ALL.into_iter();
    all.filter(|p| of(*p).next().is_some() && of(*p).all(|(_, is_made)| *is_made))
        .collect()
}

fn names<S: serde::Serializer>(platforms: &[Platform], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(platforms.iter().map(|platform| platform.name()))
}

fn resolve(read: &ReadModel, options: &ExportOptions) -> Result<(Model, Vec<Warning>), Error> {
    if options.feedforward.rigid {
        return Err(Error::usage(
            "a feedforward of the rigid body for the model of one axis",
            "the robot.toml of a robot; of one axis mass and gravity",
        ));
    }
    let file = &read.model;
    let (friction, lowered) = friction(file, options.cycle_time).map_err(|e| match e {
        Unfit::Law => read.refuse("law", file.law.as_str(), "a law that stiction identifies"),
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
    let title = title(file);
    let identifier = match &options.name {
        Some(name) => name.clone(),
        None => stiction_export::identifier(&title),
    };
    let table = options.target.is_simulated()
        || options.target.is_map()
        || matches!(options.target, Target::Tf5200 | Target::DriveTable);
    let of_law = settings_of_law(&friction, file, &lowered);
    let (friction, terms, beside) = match table {
        _ if options.target == Target::CoggingMap => (friction, terms::of_cogging(file)?, None),
        true => (friction, bent(file, &friction, options.target), None),
        false => {
            let beside = terms::beside(read, friction, options.feedforward)?;
            (beside.friction, beside.terms, Some(beside))
        }
    };
    if let Some(beside) = beside
        .as_ref()
        .filter(|b| !b.has_limit() && options.limit.is_none())
    {
        return Err(Error::usage(
            format!(
                "a mass of {} fed forward without a limit",
                stiction_number::four_digits(beside.terms.mass)
            ),
            "a limit, or the largest acceleration of the log in the model: [range] acceleration = LARGEST",
        ));
    }
    let of_all = match &beside {
        Some(beside) => beside.settings(of_law, &friction),
        None => of_law,
    };
    let mut settings = asked(of_all, options);
    within(options, &friction, &terms, file)?;
    let mut taken = beside.as_ref().map_or(Vec::new(), |b| b.taken.clone());
    if table && terms.levels.is_some() {
        taken.extend(quadratic(file));
        if options.target == Target::Bam {
            taken.extend(law::of_the_transmitted(file));
        }
    }
    let mut warnings = match options.target.is_map() {
        true => untrusted(file).into_iter().collect(),
        false => doubts(file, beside.as_ref(), &taken),
    };
    warnings.extend(beside.as_ref().and_then(|b| wrapped::doubt(file, b)));
    warnings.extend(
        (!table)
            .then(|| another_rate(file, options.cycle_time))
            .flatten(),
    );
    if options.adapt {
        // What a smaller gain guards against, levels that are wrong, is found; what it leaves would stay.
        settings.gain = options.gain.unwrap_or(1.0);
        let mass = known_mass(file);
        settings.adaptation = Some(Adaptation {
            mass: mass.unwrap_or(0.0),
            ..Adaptation::default()
        });
        warnings.extend(adapting::taken_for_friction(
            file,
            mass,
            options.feedforward,
        ));
    }
    if !options.target.is_map() {
        warnings.extend(less(&lowered, options.limit.is_none()));
    }
    if options.name.is_none() && !stiction_export::is_whole(&title) {
        let short = Notice::ShortName {
            identifier: identifier.clone(),
            title: title.clone(),
        };
        warnings.push(short.into());
    }
    let mut model = Model {
        title,
        identifier,
        rotary: file.kind == "rotary",
        force_unit: file.force_unit.replace('*', " "),
        friction,
        terms,
        load_unit: file
            .parameter
            .iter()
            .find(|p| p.name == "load_reference")
            .map_or(String::new(), |p| p.unit.replace('*', " ")),
        backlash: file.backlash.map(|gap| Backlash {
            width: gap.width,
            interval: gap.ci95,
            load: gap.load,
            range: file.range.position,
        }),
        settings,
        rated_force: options.rated_force,
        top_speed: file.top_speed(),
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
            .chain(file.backlash.map(|gap| Parameter {
                name: "backlash".into(),
                value: gap.width,
                unit: terms::length_unit(file).into(),
                interval: gap.ci95,
                identifiable: true,
                given: gap.ci95.is_none(),
            }))
            .collect(),
        domain: Domain::default(),
        draws: options.draws,
        notes: vec![],
        provenance: Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            model_sha256: read.sha256.clone(),
            inputs: file
                .source
                .inputs
                .iter()
                .map(|input| (input.path.clone(), input.sha256.clone()))
                .collect(),
        },
    };
    if options.target.is_simulated() {
        model.domain = domain::of(file, &model, None);
        few_enough(options, [&model].into_iter())?;
    }
    Ok((model, warnings))
}

/// The name of the axis, else that of its first log, so that two axes have two names.
fn title(file: &ModelFile) -> String {
    let log = file
        .source
        .inputs
        .first()
        .map(|input| Path::new(&input.path));
    let stem = log
        .and_then(Path::file_stem)
        .map(|stem| stem.to_string_lossy().into_owned());
    file.name.clone().or(stem).unwrap_or_else(|| "axis".into())
}

/// An error with its file and the place in it, if it is about something in that file.
fn place(source: stiction_export::Error, read: &ReadModel, options: &ExportOptions) -> Error {
    use stiction_export::Error::{ForceUnit, Law, Number, Range};
    // On the target a Dahl law is a LuGre law; in the file it is not.
    let source = match source {
        Law {
            target,
            law,
            allowed,
        } if read.model.law == "dahl" => Law {
            target,
            law: law.replacen("lugre", "dahl", 1),
            allowed,
        },
        other => other,
    };
    let place = match &source {
        Law { .. } => read.place("law"),
        ForceUnit { .. } => read.place("force_unit"),
        Range { name, .. }
        | Number {
            source: ParamError { name, .. },
            ..
        } => {
            let asked = *name == "limit" && options.limit.is_some();
            let of_no_parameter = [
                "rated_force",
                "cycle_time",
                "gain",
                "ramp",
                "dead_zone",
                "slew",
                "watchdog_window",
            ];
            if asked || of_no_parameter.contains(name) {
                return source.into();
            }
            // Of a level that changes the part of it: the parameter comes first.
            let parameter = name.split(" / ").next().unwrap_or(name);
            read.place_of_parameter(parameter)
        }
        _ => return source.into(),
    };
    Error::ExportModel {
        file: read.file().to_path_buf(),
        place,
        source,
    }
}

/// The mass of the model, unless the log leaves it open.
fn known_mass(file: &ModelFile) -> Option<f64> {
    let mass = file.parameter.iter().find(|p| p.name == "mass")?;
    let known = mass.value > 0.0 && (mass.identifiable || mass.origin == "given");
    known.then_some(mass.value)
}
