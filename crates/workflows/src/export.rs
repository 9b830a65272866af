//! `stiction export`: a model file to the compensator's code.

mod adapting;
mod reserve;
mod terms;
mod wrapped;

use crate::compile;
use crate::error::Error;
use std::path::Path;
use stiction_codes::Code;
use stiction_export::{Model, Parameter, Provenance};
use stiction_files::ModelFile;
use stiction_files::Warning;
use stiction_files::model::{Lowered, ReadModel};
use stiction_files::{write_folder, write_into_folder};
use stiction_friction::ParamError;
use stiction_friction::compensator::{
    Adaptation, Compensator, Friction, Levels, Settings, Terms, Watchdog,
};
use stiction_parameters::{FrictionLaw, LawError, Name, ParameterSet, Quantity, Side};

pub use stiction_export::{Error as ExportError, File, Platform, Target};
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
    /// table the largest force that it can hold. Not for a simulated joint ([`Target::is_simulated`]) or `drive-table`.
    pub limit: Option<f64>,
    /// Force that the motor is rated for, in the unit of the model's; for `tf5200`, and for no other target.
    pub rated_force: Option<f64>,
    /// Share of the friction that is compensated, 0 to 1; 0.75 if absent. Not for a simulated joint or `drive-table`.
    pub gain: Option<f64>,
    /// Settings of the compensator; not for simulated joints, `tf5200` and `drive-table`, which have none of them.
    pub safety: Safety,
    /// Levels that follow the machine while it runs ([`Adaptation`]), from the force of the drive; not for
    /// simulated joints, `tf5200` and `drive-table`.
    pub adapt: bool,
    /// What is fed forward beside friction, of what the model has; not for simulated joints, `tf5200` and `drive-table`.
    pub feedforward: Feedforward,
}

/// Settings of a compensator; those that are absent follow from the law ([`Settings::for_law`]).
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

/// Longest ramp and window, and longest time in which the slew limit lets friction at standstill through, s.
const LONGEST: f64 = 3600.0;
/// Shortest ramp that is one, and shortest such time, s: below any cycle time.
const SHORTEST: (f64, f64) = (1e-6, 1e-9);

/// Parameters that need a feedforward of their own, beside that of friction.
const BESIDE: [&str; 4] = ["mass", "delay", "gravity_", "cogging"];

impl Exported {
    /// Writes the files into `dir`, a folder that is new or empty: whole, or not at all.
    ///
    /// # Errors
    /// When the folder is not free or cannot be written.
    pub fn write(&self, dir: impl AsRef<Path>) -> Result<(), Error> {
        let files = self.files.iter();
        Ok(write_folder(
            dir.as_ref(),
            files.map(|f| (f.path.as_str(), f.bytes.as_slice())),
        )?)
    }

    /// Writes the files into `dir`, which may hold something: files of the same names are replaced, others are kept.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub fn write_over(&self, dir: impl AsRef<Path>) -> Result<(), Error> {
        let files = self.files.iter();
        Ok(write_into_folder(
            dir.as_ref(),
            files.map(|f| (f.path.as_str(), f.bytes.as_slice())),
        )?)
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
    compensator_of(&ReadModel::of(model)?, options)
}

/// The same of a model that was read.
pub(crate) fn compensator_of(
    read: &ReadModel,
    options: &ExportOptions,
) -> Result<Compensator<f64>, Error> {
    let (model, _) = resolve(read, options)?;
    model.in_rust().map_err(|e| place(e, read, options))
}

/// Refuses options that the target has no use for.
pub(crate) fn check(options: &ExportOptions) -> Result<(), Error> {
    if options.rated_force.is_some() && options.target != Target::Tf5200 {
        let found = format!("a rated force for the target {}", options.target.name());
        return Err(Error::usage(found, "only tf5200 takes one"));
    }
    let target = options.target.name();
    let simulated = options.target.is_simulated();
    let numbers = options.target == Target::DriveTable;
    if numbers && (options.limit.is_some() || options.gain.is_some()) {
        let what = if options.limit.is_some() {
            "limit"
        } else {
            "gain"
        };
        return Err(Error::usage(
            format!("a {what} for the target {target}"),
            "it has the whole friction; write a share of the numbers into the drive, and let the drive limit its torque",
        ));
    }
    if options.limit.is_some() && simulated {
        return Err(Error::usage(
            format!("a limit for the target {target}"),
            "the friction of a simulated joint is not limited",
        ));
    }
    if options.gain.is_some() && simulated {
        return Err(Error::usage(
            format!("a gain for the target {target}"),
            "the friction of a simulated joint is the whole friction",
        ));
    }
    let safety = &options.safety;
    let given = [
        ("ramp", safety.ramp),
        ("dead zone", safety.dead_zone),
        ("slew", safety.slew),
        ("window", safety.window),
    ];
    let none = simulated || numbers || options.target == Target::Tf5200;
    if let Some((name, _)) = given.iter().find(|(_, value)| none && value.is_some()) {
        return Err(Error::usage(
            format!("a {name} for the target {target}"),
            "it has none",
        ));
    }
    let window = safety.window.filter(|window| *window != 0.0);
    let ramp = safety.ramp.filter(|ramp| *ramp != 0.0);
    for (name, value, least, allowed) in [
        (
            "window",
            window,
            options.cycle_time,
            "from the cycle time to 3600 s, or 0 for no watchdog",
        ),
        ("ramp", ramp, SHORTEST.0, "0, or from 1e-6 to 3600 s"),
    ] {
        // A block that needs longer to learn, or to come in, never compensates.
        if let Some(value) = value.filter(|value| !(*value >= least && *value <= LONGEST)) {
            let found = format!("a {name} of {} s", stiction_number::shortest(value));
            return Err(Error::usage(found, allowed));
        }
    }
    if none && options.adapt {
        return Err(Error::usage(
            format!("levels that follow the machine for the target {target}"),
            "c, cpp, ros2, st, tcpou, plcopen, rust, hal, fmu and matlab have them",
        ));
    }
    if none && options.feedforward != Feedforward::default() {
        return Err(Error::usage(
            format!("a feedforward beside friction for the target {target}"),
            "c, cpp, ros2, st, tcpou, plcopen, rust, hal, fmu and matlab have one",
        ));
    }
    Ok(())
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
                warnings.push(Warning::new(
                    Code::ExportSource,
                    "no C compiler of this machine makes a binary: the FMUs hold their C source only; a tool that runs them has to compile it, \
                     or install gcc and export again",
                ));
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
        || matches!(options.target, Target::Tf5200 | Target::DriveTable);
    let of_law = settings_of_law(&friction, file, &lowered);
    let (friction, terms, beside) = match table {
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
    let settings = asked(of_all, options);
    if let Some(slew) = options.safety.slew {
        let least = friction.scale() / LONGEST;
        let most = friction.scale() / SHORTEST.1;
        if !(least..=most).contains(&slew) {
            let unit = file.force_unit.replace('*', " ");
            return Err(Error::usage(
                format!("a slew of {} {unit}/s", stiction_number::shortest(slew)),
                format!(
                    "from {} {unit}/s, with which the force reaches friction at standstill within an hour, to {} {unit}/s, within a nanosecond",
                    stiction_number::four_digits(least),
                    stiction_number::four_digits(most)
                ),
            ));
        }
    }
    if let (Some(zone), Some(top)) = (options.safety.dead_zone, file.top_speed())
        && zone >= top
    {
        let speed = match file.kind.as_str() {
            "rotary" => "rad/s",
            _ => "m/s",
        };
        return Err(Error::usage(
            format!("a dead zone of {} {speed}", stiction_number::shortest(zone)),
            format!(
                "below {} {speed}, the top speed of the log: at and above it nothing would be compensated",
                stiction_number::four_digits(top)
            ),
        ));
    }
    if let Some(limit) = options.limit {
        holds(limit, &terms, file)?;
    }
    let mut settings = settings;
    let mut taken = beside.as_ref().map_or(Vec::new(), |b| b.taken.clone());
    if table && terms.levels.is_some() {
        taken.extend(quadratic(file));
    }
    let mut warnings = doubts(file, beside.as_ref(), &taken);
    warnings.extend(beside.as_ref().and_then(|b| wrapped::doubt(file, b)));
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
    warnings.extend(less(&lowered, options.limit.is_none()));
    if options.name.is_none() && !stiction_export::is_whole(&title) {
        warnings.push(Warning::new(
            Code::ExportName,
            format!(
                "the names in the code begin with {identifier}, only a part of the axis name '{title}': another axis may get the same; give a name"
            ),
        ));
    }
    let model = Model {
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
            .collect(),
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

/// Refuses a limit that the weight alone exceeds: an axis that is held by less falls.
fn holds(limit: f64, terms: &Terms<f64>, file: &ModelFile) -> Result<(), Error> {
    let Some(weight) = terms.weight else {
        return Ok(());
    };
    let wave = libm::hypot(weight.wave.sine, weight.wave.cosine);
    let most = weight.constant.abs() + wave;
    if limit.is_nan() || limit >= most {
        return Ok(());
    }
    let unit = file.force_unit.replace('*', " ");
    let [limit, most] = [limit, most].map(stiction_number::four_digits);
    Err(Error::usage(
        format!("a limit of {limit} {unit} below the weight that is fed forward"),
        format!(
            "above {most} {unit}, which hold the axis, with room for friction; or --feedforward without gravity"
        ),
    ))
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

/// What should not be used, what the log leaves open, and what the code leaves out.
fn doubts(file: &ModelFile, beside: Option<&terms::Beside>, taken: &[String]) -> Vec<Warning> {
    let is_taken = |name: &String| taken.contains(name);
    let mut found = Vec::new();
    if !file.trustworthy {
        found.push(Warning::new(
            Code::ExportUntrusted,
            "the identification flagged this model as not trustworthy; a compensation with it may be too strong",
        ));
    }
    let aside = |name: &str| BESIDE.iter().any(|stem| name.starts_with(stem));
    let names = |wanted: &dyn Fn(&stiction_files::model::ModelParameter) -> bool| -> Vec<&str> {
        let chosen = file.parameter.iter().filter(|p| wanted(p));
        chosen.map(|p| p.name.as_str()).collect()
    };
    let loose = names(&|p| !p.identifiable && p.origin != "given" && !aside(&p.name));
    if !loose.is_empty() {
        found.push(Warning::new(
            Code::NotIdentifiable,
            format!(
                "the log leaves {} open: the law predicts friction on motion like that of the log, and may be wrong on \
                 any other",
                loose.join(", ")
            ),
        ));
    }
    let left = names(&|p| aside(&p.name) && p.name != "delay" && !is_taken(&p.name));
    if !left.is_empty() {
        found.push(Warning::new(
            Code::ExportTerms,
            format!(
                "{} is not friction and not in the compensator; feed it forward separately{}",
                left.join(", "),
                with_it(&left, beside.map(|b| b.taken.as_slice()))
            ),
        ));
    }
    let lacking = beside.map_or(&[][..], |b| &b.lacking);
    found.extend(at_reference(file, taken, lacking));
    found
}

/// Quadratic viscous friction of what holds the steady force and nothing else: tables, and joints with two numbers of it.
fn bent(file: &ModelFile, friction: &Friction<f64>, target: Target) -> Terms<f64> {
    let steady = !matches!(target, Target::Mujoco | Target::Modelica);
    let levels = file.dependences(friction.coulomb()).levels;
    let levels = levels.filter(|l| steady && l.quadratic != [0.0; 2]);
    Terms {
        levels: levels.map(|l| Levels {
            quadratic: l.quadratic,
            top_speed: l.top_speed,
            ..Levels::default()
        }),
        ..Terms::default()
    }
}

/// The parameters of quadratic viscous friction.
fn quadratic(file: &ModelFile) -> impl Iterator<Item = String> + '_ {
    let names = file.parameter.iter().map(|p| &p.name);
    let is = |name: &Name| name.quantity == Quantity::QuadraticViscous;
    names
        .filter(move |name| name.parse().is_ok_and(|name: Name| is(&name)))
        .cloned()
}

/// How the compensator would feed forward what it leaves out.
fn with_it(left: &[&str], taken: Option<&[String]>) -> String {
    let Some(taken) = taken else {
        return String::new();
    };
    let parts = ["mass", "gravity", "cogging"].into_iter().filter(|part| {
        let mine = |name: &str| name.starts_with(part);
        left.iter().any(|name| mine(name)) || taken.iter().any(|name| mine(name))
    });
    let parts: Vec<&str> = std::iter::once("friction").chain(parts).collect();
    format!(", or with it: --feedforward {}", parts.join(","))
}

/// What changes friction and is no input of the code: the code has friction as it is at the reference.
fn at_reference(file: &ModelFile, taken: &[String], lacking: &[&str]) -> Option<Warning> {
    let at = |name: &str| {
        let found = file.parameter.iter().find(|p| p.name == name);
        found.map_or("the mean of the log".into(), |p| {
            format!("{} {}", stiction_number::four_digits(p.value), p.unit)
        })
    };
    let left = file.parameter.iter().filter(|p| !taken.contains(&p.name));
    let each = left.filter_map(|p| {
        let quantity = p.name.parse::<Name>().ok()?.quantity;
        let held = match quantity {
            Quantity::CoulombLoad => format!("at a load of {}", at("load_reference")),
            Quantity::CoulombTemperature | Quantity::Sigma2Temperature => {
                format!("at {}", at("temperature_reference"))
            }
            Quantity::CoulombTransmitted => {
                format!("where {} is transmitted", at("transmitted_reference"))
            }
            Quantity::CoulombDriven => "as where the motor drives".into(),
            Quantity::CoulombPosition => {
                format!("at the position {}", at("position_reference"))
            }
            Quantity::CoulombPitch(..) => "in its mean over the pitch".into(),
            Quantity::CoulombLog(_) | Quantity::Sigma1Log(_) | Quantity::Sigma2Log(_) => {
                "of the first log".into()
            }
            Quantity::QuadraticViscous => {
                "without the part that grows with the square of the velocity".into()
            }
            _ => return None,
        };
        Some(format!(
            "{} = {} {}: {held}",
            p.name,
            stiction_number::four_digits(p.value),
            p.unit
        ))
    });
    let each = each.collect::<Vec<_>>().join("; ");
    let cure = match lacking {
        [] => String::new(),
        lines => format!(
            ". With what the log has seen in the model file the code has it: {}",
            lines.join("; ")
        ),
    };
    (!each.is_empty()).then(|| {
        Warning::new(
            Code::ExportTerms,
            format!(
                "friction changes with what the code does not see, so it has friction as it is there ({each}). Where the axis \
                 works elsewhere it is off by that much: identify the axis as it works{cure}"
            ),
        )
    })
}

/// The mass of the model, unless the log leaves it open.
fn known_mass(file: &ModelFile) -> Option<f64> {
    let mass = file.parameter.iter().find(|p| p.name == "mass")?;
    let known = mass.value > 0.0 && (mass.identifiable || mass.origin == "given");
    known.then_some(mass.value)
}

/// Where less is used than was identified; `limited` where the limit follows from it.
fn less(lowered: &[Lowered], limited: bool) -> Option<Warning> {
    let each = lowered.iter().map(|l| {
        let [from, to] = [l.from, l.to].map(stiction_number::four_digits);
        format!("{} = {to} {} instead of {from}", l.name, l.unit)
    });
    let each = each.collect::<Vec<_>>().join(", ");
    let limit = match limited {
        true => ", and its limit is the largest friction up to the speeds of the log",
        false => "",
    };
    (!lowered.is_empty()).then(|| {
        Warning::new(
            Code::ExportSupported,
            format!(
                "the code makes the least force that the log supports: {each}{limit}. A log that determines them gives more: \
                 stiction check LOG names the motion"
            ),
        )
    })
}

/// The largest friction up to the speeds of the log; at standstill where those are not known.
fn seen(friction: &Friction<f64>, top_speed: Option<f64>, levels: Levels<f64>) -> f64 {
    let top = top_speed.unwrap_or(0.0);
    let (coulomb, viscous) = (friction.coulomb(), friction.viscous());
    let statics = friction.curve().map_or(coulomb, |curve| {
        [curve.positive(), curve.negative()].map(|side| side.static_friction)
    });
    let of = |i: usize| {
        let bent = levels.quadratic_force(viscous, [top, -top][i]).abs();
        statics[i].max(coulomb[i] + viscous[i] * top + bent)
    };
    of(0).max(of(1)) + friction.offset().abs()
}

/// Dead zone of a law without a Stribeck velocity, of the top speed of the recordings.
const SLOW: f64 = 1e-3;

/// What follows from the law.
fn settings_of_law(
    friction: &Friction<f64>,
    file: &ModelFile,
    lowered: &[Lowered],
) -> Settings<f64> {
    let top_speed = file.top_speed();
    // The cycle time is put in later.
    let mut settings = Settings::for_law(friction, 1e-3);
    if let (Friction::Coulomb(_), Some(top)) = (friction, top_speed) {
        settings.dead_zone = SLOW * top;
    }
    if !lowered.is_empty() {
        let levels = file.dependences(friction.coulomb()).levels;
        settings.limit = seen(friction, top_speed, levels.unwrap_or_default());
    }
    settings
}

/// What was asked for in the place of what follows from the model.
fn asked(mut settings: Settings<f64>, options: &ExportOptions) -> Settings<f64> {
    settings.cycle_time = options.cycle_time;
    let safety = &options.safety;
    for (setting, asked) in [
        (&mut settings.limit, options.limit),
        (&mut settings.gain, options.gain),
        (&mut settings.ramp, safety.ramp),
        (&mut settings.dead_zone, safety.dead_zone),
        (&mut settings.slew, safety.slew),
    ] {
        *setting = asked.unwrap_or(*setting);
    }
    if let Some(window) = safety.window {
        settings.watchdog = (window != 0.0).then(|| Watchdog {
            window,
            ..Watchdog::default()
        });
    }
    settings
}

/// Why no law that can be exported follows from the numbers of a model.
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
fn friction(file: &ModelFile, cycle_time: f64) -> Result<(Friction<f64>, Vec<Lowered>), Unfit> {
    let (mut values, mut lowered) = file.supported().ok_or(Unfit::Law)?;
    if let Some(stiffness) = resolved(file, &mut values, cycle_time) {
        // Of one that was lowered before, this is the lower value.
        lowered.retain(|l| l.name != stiffness.name);
        lowered.push(stiffness);
    }
    let friction = match values.law()? {
        FrictionLaw::CoulombViscous(law) => Friction::Coulomb(law),
        FrictionLaw::Stribeck(curve) => Friction::Stribeck(curve),
        FrictionLaw::LuGre(law) => Friction::LuGre(law),
        FrictionLaw::ElastoPlastic(law) => Friction::ElastoPlastic(law),
        FrictionLaw::MaxwellSlip(law) => Friction::Gms(law),
    };
    Ok((friction, lowered))
}

/// A stiffness that the data leave open is no stiffer than a cycle resolves: at the Stribeck velocity the presliding length is
/// passed in one.
fn resolved(file: &ModelFile, values: &mut ParameterSet, cycle_time: f64) -> Option<Lowered> {
    let from = values.get(Quantity::Sigma0)?;
    let speed = values.on(Quantity::StribeckVelocity, Side::Positive)?;
    let level = values.on(Quantity::Coulomb, Side::Positive)?;
    let to = level / (speed * cycle_time);
    let name = Name::from(Quantity::Sigma0);
    if !(file.leaves_open(name) && to > 0.0 && to < from) {
        return None;
    }
    values.insert(name, to);
    let p = file.parameter.iter().find(|p| p.name == name.to_string())?;
    Some(Lowered {
        name,
        from: p.value,
        to,
        unit: p.unit.clone(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use stiction_friction::{Damping, Shape};

    /// A study and an export use the same law for the same model, whatever its Stribeck exponent; the only difference
    /// is that sigma1 is capped where the axis is simulated.
    #[test]
    fn a_study_and_an_export_have_one_law() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.toml");
        for (exponent, shape) in [
            (1.0, Shape::Exponential),
            (1.3, Shape::Power(1.3)),
            (2.0, Shape::Gaussian),
        ] {
            let mut text = String::from(
                "schema = \"stiction.model/1\"\nkind = \"linear\"\nlaw = \"lugre\"\nasymmetric = true\n\
                 force_unit = \"N\"\ntrustworthy = true\n[source]\nversion = \"0\"\nmethod = \"separable\"\n\
                 seed = 0\ninputs = []\n",
            );
            for (name, value, unit) in [
                ("sigma0", 2e6, "N/m"),
                ("sigma1", 1500.0, "N*s/m"),
                ("sigma2", 30.0, "N*s/m"),
                ("coulomb_pos", 12.0, "N"),
                ("coulomb_neg", 13.0, "N"),
                ("static", 18.0, "N"),
                ("stribeck_velocity", 3e-3, "m/s"),
                ("stribeck_exponent", exponent, "1"),
                ("offset", -1.0, "N"),
                ("mass", 4.6, "kg"),
            ] {
                text += &format!(
                    "[[parameter]]\nname = \"{name}\"\nsymbol = \"\"\nvalue = {value:?}\nunit = \"{unit}\"\n\
                     identifiable = true\norigin = \"identified\"\n"
                );
            }
            text += "[covariance]\nnames = []\nmatrix = []\n";
            std::fs::write(&path, &text).unwrap();
            let file = ModelFile::read(&path).unwrap();
            let Ok((Friction::LuGre(exported), _)) = friction(&file, 1e-3) else {
                panic!("no law is exported");
            };
            assert_eq!(exported.curve().shape(), shape);
            assert_eq!(exported.curve().negative().coulomb, 13.0);
            assert_eq!(exported.damping(), Damping::Constant(1500.0));
            let study = stiction_files::study::Model::read(&path).unwrap();
            assert_eq!(study.values().lugre().unwrap(), exported);
        }
    }
}
