//! From the study file as typed to the types of the simulation.

mod compensators;
mod contours;
mod controllers;
mod file;
mod machine;
mod paths;

use super::raw::{Source, Table};
use super::result::StudyInput;
use super::wrong::{Belief, Family};
use super::{Machine, Named, Study};
use crate::error::{Error, Warning};
use crate::source::sha256;
use std::path::Path;
use stiction_log::{Dimension, Motion};
use stiction_number::four_digits as short;
use stiction_servo::run::sample_count;

/// Most entries of a list.
const MOST: usize = 32;
/// Most runs of the whole grid.
const MOST_RUNS: usize = 100_000;
/// Most samples of a run.
const MOST_SAMPLES: usize = 1_000_000;

/// Least samples of a period, a move, a turn: fewer do not show what it is.
const LEAST_SAMPLES: f64 = 10.0;

/// Checks a study file; `file` is named in messages and paths in it start from its folder.
pub(super) fn resolve(text: &str, file: &Path) -> Result<Study, Error> {
    let source = Source { file, text };
    let entries = source.parse()?;
    let root = Table::root(source, &entries);
    let name = match root.text("name")?.map(str::trim) {
        None | Some("") => file
            .file_stem()
            .map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
        Some(name) => name.to_string(),
    };
    let seed = root.count("seed", 0, i64::MAX as u64)?.unwrap_or(0);
    let axis = root.table("axis")?;
    let axis = root.required("axis", axis, "a table [axis] with model = \"model.toml\"")?;
    let folder = file.parent().unwrap_or(Path::new(""));
    let machine = machine::machine(&axis, folder, None)?;
    let other = root.table("second_axis")?;
    let second = match &other {
        Some(table) => Some(contours::second(&root, table, folder, &machine)?),
        None => None,
    };
    let mut inputs = vec![file.to_path_buf()];
    for table in [Some(axis), other].iter().flatten() {
        if let Some(model) = table.text("model")? {
            inputs.push(folder.join(model));
        }
    }
    let inputs = inputs.iter().map(|path| input(path));
    let mut study = Study {
        name,
        seed,
        inputs: inputs.collect::<Result<_, Error>>()?,
        warnings: Vec::new(),
        paths: Vec::new(),
        second,
        contours: Vec::new(),
        controllers: Vec::new(),
        compensators: Vec::new(),
        families: Vec::new(),
        machine,
    };
    for table in root.tables("path", MOST)? {
        let path = paths::path(&table, folder, &mut study)?;
        few(&table, path.trajectory.duration(), study.machine.rate)?;
        once(&table, study.paths.iter().map(|p| &p.name), &path.name)?;
        study.paths.push(path);
    }
    for table in root.tables("contour", MOST)? {
        let contour = contours::contour(&table, folder, &mut study)?;
        few(&table, contour.motion.duration(), study.machine.rate)?;
        let paths = study.paths.iter().map(|p| &p.name);
        let taken = paths.chain(study.contours.iter().map(|c| &c.name));
        once(&table, taken, &contour.name)?;
        study.contours.push(contour);
    }
    for table in root.tables("controller", MOST)? {
        contours::controller(&table, &mut study)?;
        let controller = controllers::controller(&table, &study.machine)?;
        once(&table, names(&study.controllers), &controller.name)?;
        study.controllers.push(controller);
    }
    study.compensators.push(compensators::none());
    for table in root.tables("compensator", MOST)? {
        let compensator = compensators::compensator(&table, &study)?;
        once(&table, names(&study.compensators), &compensator.name)?;
        study.compensators.push(compensator);
    }
    for (key, none) in [
        ("path", study.paths.is_empty() && study.contours.is_empty()),
        ("controller", study.controllers.is_empty()),
    ] {
        if none {
            let allowed = format!("give at least one [[{key}]]");
            return Err(root.refuse(key, "is missing".into(), &allowed));
        }
    }
    families(&root, &mut study)?;
    root.end()?;
    let runs = study.jobs().len();
    if runs > MOST_RUNS {
        let found = format!("{runs} runs");
        return Err(root.refuse("path", found, &format!("at most {MOST_RUNS} in all")));
    }
    study.warnings.append(&mut study.machine.model.warnings);
    if let Some(second) = &mut study.second {
        study.warnings.append(&mut second.machine.model.warnings);
    }
    Ok(study)
}

fn input(path: &Path) -> Result<StudyInput, Error> {
    Ok(StudyInput {
        path: path.display().to_string(),
        sha256: sha256(path)?,
    })
}

impl Study {
    /// Notes a file that was read, and what was said of it.
    fn reads(&mut self, file: &Path, warning: Option<Warning>) -> Result<(), Error> {
        let input = input(file)?;
        if !self.inputs.contains(&input) {
            self.inputs.push(input);
        }
        self.warnings.extend(warning);
        Ok(())
    }
}

/// A path is not too long.
fn few(table: &Table<'_>, duration: f64, rate: f64) -> Result<(), Error> {
    if sample_count(duration, rate).is_ok_and(|n| n <= MOST_SAMPLES) {
        return Ok(());
    }
    let allowed = format!("at most {MOST_SAMPLES} samples, duration times rate");
    Err(table.refuse("kind", format!("{} s", short(duration)), &allowed))
}

/// What a motion consists of, such as `a period` of some seconds, is not over within a few samples.
fn sampled(table: &Table<'_>, key: &str, what: &str, seconds: f64, rate: f64) -> Result<(), Error> {
    let samples = seconds * rate;
    if samples >= LEAST_SAMPLES {
        return Ok(());
    }
    let found = format!("{what} of {} s, {} samples", short(seconds), short(samples));
    let allowed = format!("at least {LEAST_SAMPLES} samples at {} Hz", short(rate));
    Err(table.refuse(key, found, &allowed))
}

/// `[[parameter_error]]`: the exact parameters are always there.
fn families(root: &Table<'_>, study: &mut Study) -> Result<(), Error> {
    let mut families = vec![Family::exact(study.machine.truth())];
    let mut others = Vec::new();
    if let Some(second) = &study.second {
        others.push(Family::exact(second.machine.truth()).beliefs);
    }
    for table in root.tables("parameter_error", MOST)? {
        let kind = table.choice("kind", &["corners", "covariance"])?;
        let family = match table.required("kind", kind, "\"corners\" or \"covariance\"")? {
            "corners" => {
                let by = table.value("by", Dimension::ONE)?;
                let by = table.required("by", by, "a part such as \"10 %\"")?;
                if !(by > 0.0 && by < 1.0) {
                    let allowed = "above 0 and below 100 %";
                    return Err(table.refuse("by", by.to_string(), allowed));
                }
                let of = |machine: &Machine| Family::corners(machine.truth(), by);
                others.extend(study.second.as_ref().map(|s| of(&s.machine).beliefs));
                of(&study.machine)
            }
            _ => {
                let draws = table.count("draws", 2, 10_000)?.unwrap_or(100);
                let refused = |found| {
                    table.refuse("kind", found, "a model with a covariance, or \"corners\"")
                };
                if let Some(second) = &study.second {
                    // Draws of its own; a known axis has no covariance and is believed as it is.
                    let seed = study.seed.wrapping_add(1);
                    let machine = &second.machine;
                    others.push(match machine.model.covariance {
                        None => vec![machine.truth(); draws as usize],
                        Some(_) => machine.draws(draws, seed).map_err(refused)?.beliefs,
                    });
                }
                study.machine.draws(draws, study.seed).map_err(refused)?
            }
        };
        table.end()?;
        once(&table, families.iter().map(|f| &f.name), &family.name)?;
        families.push(family);
    }
    study.families = families;
    if let Some(second) = &mut study.second {
        second.families = others;
    }
    Ok(())
}

impl Machine {
    /// What an axis is.
    fn truth(&self) -> Belief {
        Belief {
            law: self.law,
            mass: self.mass,
        }
    }

    /// Draws from the covariance of the model. A mass that the study gives is known.
    fn draws(&self, count: u64, seed: u64) -> Result<Family, String> {
        let given = self.given_mass.then_some(self.mass);
        Family::draws(&self.model, given, count, seed)
    }
}

fn names<T>(all: &[Named<T>]) -> impl Iterator<Item = &String> {
    all.iter().map(|n| &n.name)
}

/// The name of an entry: given, or made of what it is.
fn name(table: &Table<'_>, default: String) -> Result<String, Error> {
    match table.text("name")?.map(str::trim) {
        None => Ok(default),
        Some(name) if !name.is_empty() && name.chars().count() <= 60 => Ok(name.to_string()),
        Some(name) => Err(table.refuse("name", format!("{name:?}"), "1 to 60 characters")),
    }
}

/// Names tell the rows of the result apart.
fn once<'n>(
    table: &Table<'_>,
    mut taken: impl Iterator<Item = &'n String>,
    name: &str,
) -> Result<(), Error> {
    if taken.any(|other| other == name) {
        let allowed = "a name of its own for each: name = \"...\"";
        return Err(table.refuse("name", format!("{name:?} twice"), allowed));
    }
    Ok(())
}

/// Dimensions that depend on the kind of axis.
struct Dimensions {
    length: Dimension,
    speed: Dimension,
    force: Dimension,
    mass: Dimension,
}

impl Dimensions {
    fn of(motion: Motion) -> Self {
        Dimensions {
            length: motion.position(),
            speed: motion.velocity(),
            force: motion.force(),
            mass: match motion {
                Motion::Linear => Dimension::MASS,
                Motion::Rotary => Dimension::INERTIA,
            },
        }
    }

    /// `a` over `b`; the dimensions here are far from overflow.
    fn per(a: Dimension, b: Dimension) -> Dimension {
        a.per(b).unwrap_or(a)
    }
}
