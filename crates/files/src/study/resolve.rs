//! From the study file as typed to the types of the simulation.

mod compensators;
mod contours;
mod controllers;
mod crawl;
mod depends;
mod dimensions;
mod disturbance;
mod drive;
mod entry;
mod events;
mod file;
mod inputs;
mod machine;
mod paths;
mod published;
mod sweeps;
mod usual;

use super::belief::{Belief, Family, Undrawn};
use super::plan::{Machine, Named, Study};
use super::size::MOST_SAMPLES;
use crate::config::{ANY_COUNT, Form, Source, Table};
use crate::error::{Error, Warning};
pub(super) use compensators::whole;
pub(super) use dimensions::Dimensions;
pub(super) use entry::MOST_WAY;
use entry::{few, once, seen};
use inputs::input;
use std::path::Path;
use stiction_formats::Dimension;

/// Most entries of a list of a study: paths, contours, controllers, compensators, kinds of wrong parameters.
const MOST_ENTRIES: usize = 32;
/// Most runs of the whole grid.
const MOST_RUNS: usize = 100_000;
impl Study {
    /// Reads and checks a study file, and the models that it names.
    ///
    /// # Errors
    /// With file, line, column and key, what was found and what is allowed; for one that simulates more than
    /// [`MOST_SAMPLES`](super::MOST_SAMPLES), with what makes it so large.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        Self::read_within(file, MOST_SAMPLES)
    }

    /// [`Study::read`] with at most so many samples to simulate, in [all runs](Study::size) together.
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn read_within(file: impl AsRef<Path>, samples: u64) -> Result<Self, Error> {
        let file = file.as_ref();
        let text = crate::config::read(file, Form::Study)?;
        let study = resolve(&text, file)?;
        study.within(file, samples)?;
        Ok(study)
    }
}

/// Checks a study file; `file` is named in messages and paths in it start from its folder.
fn resolve(text: &str, file: &Path) -> Result<Study, Error> {
    let source = Source {
        file,
        text,
        form: Form::Study,
        swept: None,
    };
    let entries = source.parse()?;
    let root = Table::root(source, &entries);
    let mut study = study(&root, source)?;
    let asked = sweeps::asked(&root)?;
    root.end()?;
    let sweeps = asked.iter().map(|sweep| sweep.resolve(source, &entries));
    study.sweeps = sweeps.collect::<Result<_, _>>()?;
    let runs = study.grids().map(|grid| grid.jobs().len()).sum::<usize>();
    if runs > MOST_RUNS {
        let found = format!("{runs} runs");
        return Err(root.refuse("path", found, &format!("at most {MOST_RUNS} in all")));
    }
    study.warn_of_sweeps();
    Ok(study)
}

/// The study of a file, without its sweeps: for a value of one of these, the study with that value.
fn study(root: &Table<'_>, source: Source<'_>) -> Result<Study, Error> {
    let file = source.file;
    let name = match root.line("name")?.map(str::trim) {
        None | Some("") => file
            .file_stem()
            .map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
        Some(name) => name.to_string(),
    };
    let seed = root.count("seed", 0, ANY_COUNT)?.unwrap_or(0);
    let axis = root.table("axis")?;
    let axis = root.required("axis", axis, "a table [axis] with model = \"model.toml\"")?;
    let folder = file.parent().unwrap_or(Path::new(""));
    let mut inputs = vec![input(file, source.text)];
    let machine = machine::machine(&axis, folder, None, &mut inputs)?;
    let other = root.table("second_axis")?;
    let second = match &other {
        Some(table) => Some(contours::second(
            root,
            table,
            folder,
            &machine,
            &mut inputs,
        )?),
        None if root.table("coupling")?.is_some() => {
            let allowed =
                "give a table [second_axis] as well: two axes are coupled along a contour";
            return Err(root.refuse("coupling", "needs a second axis".into(), allowed));
        }
        None => None,
    };
    let mut study = Study {
        name,
        seed,
        inputs,
        warnings: Vec::new(),
        paths: Vec::new(),
        second,
        contours: Vec::new(),
        controllers: Vec::new(),
        compensators: Vec::new(),
        families: Vec::new(),
        not_promised: None,
        events: Vec::new(),
        sweeps: Vec::new(),
        keeps_courses: root.swept().is_none(),
        machine,
    };
    for table in root.tables("path", MOST_ENTRIES)? {
        for path in paths::paths(&table, folder, &mut study)? {
            let (motion, machine) = (&path.trajectory, &study.machine);
            let span = (motion.duration(), machine.rate);
            few(&table, span.0, span.1)?;
            let unit = machine.motion.position().si_text();
            let step = machine.encoder.resolution();
            seen(&table, span, step, &unit, |t| motion.at(t).position)?;
            once(&table, study.paths.iter().map(|p| &p.name), &path.name)?;
            study.paths.push(path);
        }
    }
    for table in root.tables("contour", MOST_ENTRIES)? {
        let contour = contours::contour(&table, folder, &mut study)?;
        let (motion, machine) = (&contour.motion, &study.machine);
        let span = (motion.duration(), machine.rate);
        few(&table, span.0, span.1)?;
        let unit = machine.motion.position().si_text();
        let second = study.second.as_ref().map(|second| &second.machine);
        for (i, machine) in [Some(machine), second].into_iter().flatten().enumerate() {
            let step = machine.encoder.resolution();
            seen(&table, span, step, &unit, |t| motion.at(t).axes[i].position)?;
        }
        let paths = study.paths.iter().map(|p| &p.name);
        let taken = paths.chain(study.contours.iter().map(|c| &c.name));
        once(&table, taken, &contour.name)?;
        study.contours.push(contour);
    }
    for table in root.tables("controller", MOST_ENTRIES)? {
        contours::controller(&table, &mut study)?;
        let controller = controllers::controller(&table, &study.machine, study.second.is_some())?;
        once(&table, names(&study.controllers), &controller.name)?;
        study.controllers.push(controller);
    }
    study.compensators.push(compensators::none());
    for table in root.tables("compensator", MOST_ENTRIES)? {
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
    families(root, &mut study)?;
    events::events(root, &mut study)?;
    events::of_one_axis(&mut study);
    let mut of_axes = std::mem::take(&mut study.machine.model.warnings);
    if let Some(second) = &mut study.second {
        let of = |axis: &'static str| {
            move |w: Warning| Warning::new(w.code, format!("{axis}: {}", w.message))
        };
        of_axes = of_axes.into_iter().map(of("first axis")).collect();
        let others = std::mem::take(&mut second.machine.model.warnings);
        of_axes.extend(others.into_iter().map(of("second axis")));
    }
    study.warnings.extend(of_axes);
    Ok(study)
}

/// `[[parameter_error]]`: the exact parameters are always there.
fn families(root: &Table<'_>, study: &mut Study) -> Result<(), Error> {
    let mut families = vec![Family::exact(study.machine.truth())];
    let mut others = Vec::new();
    if let Some(second) = &study.second {
        others.push(Family::exact(second.machine.truth()));
    }
    let wrong = root.tables("parameter_error", MOST_ENTRIES)?;
    // A sweep shows what a value does, not what an error of it does.
    for table in wrong.iter().filter(|_| root.swept().is_none()) {
        let kind = table.choice("kind", &["corners", "covariance"])?;
        let family = match table.required("kind", kind, "\"corners\" or \"covariance\"")? {
            "corners" => {
                let by = table.value("by", Dimension::ONE)?;
                let by = table.required("by", by, "a part such as \"10 %\"")?;
                if !(by > 0.0 && by < 1.0) {
                    return Err(table.refused("by", "above 0 and below 100 %"));
                }
                let of = |machine: &Machine| Family::corners(machine.truth(), by);
                others.extend(study.second.as_ref().map(|s| of(&s.machine)));
                of(&study.machine)
            }
            _ => {
                let draws = table.count("draws", 2, 10_000)?.unwrap_or(100);
                let refused = |machine: &Machine, e: Undrawn| {
                    let allowed = "a model with a covariance, or \"corners\"";
                    let asked = table.refuse("kind", e.found.clone(), allowed);
                    match (e.key, &machine.model.read) {
                        (Some(key), Some(model)) => {
                            let found = format!(
                                "{}, and draws from it are asked for in {}",
                                e.found,
                                table.where_is("kind")
                            );
                            model.refuse(&key, found, "a covariance as an identification writes it")
                        }
                        _ => asked,
                    }
                };
                if let Some(second) = &study.second {
                    // Independent draws; a known axis has no covariance, so its exact parameters are assumed.
                    let seed = study.seed.wrapping_add(1);
                    let machine = &second.machine;
                    others.push(match machine.model.covariance {
                        None => Family {
                            beliefs: vec![machine.truth(); draws as usize],
                            ..Family::exact(machine.truth())
                        },
                        Some(_) => {
                            let drawn = machine.draws(draws, seed);
                            drawn.map_err(|e| refused(machine, e))?
                        }
                    });
                }
                let machine = &study.machine;
                let drawn = machine.draws(draws, study.seed);
                drawn.map_err(|e| refused(machine, e))?
            }
        };
        table.end()?;
        once(table, families.iter().map(|f| &f.name), &family.name)?;
        families.push(family);
    }
    if root.swept().is_none() {
        match promised(study) {
            Ok(promised) => {
                let mut each = promised.into_iter();
                families.extend(each.next());
                others.extend(each.next());
            }
            Err(reason) => study.not_promised = Some(reason),
        }
    }
    study.families = families;
    if let Some(second) = &mut study.second {
        second.families = others;
    }
    Ok(())
}

/// What the identifications of the axes allow to promise, for each axis; `Err` is what one lacks.
fn promised(study: &Study) -> Result<Vec<Family>, String> {
    let machines = std::iter::once(&study.machine).chain(study.second.as_ref().map(|s| &s.machine));
    let each = machines.enumerate().map(|(i, machine)| {
        let mass = machine.given_mass.then_some(machine.mass);
        let seed = study.seed.wrapping_add(i as u64);
        let lacks = |e: Undrawn| format!("{}: {}", machine.model.origin, e.found);
        Family::promised(&machine.model, machine.truth(), mass, seed).map_err(lacks)
    });
    each.collect()
}

impl Machine {
    /// What an axis is.
    pub fn truth(&self) -> Belief {
        Belief {
            law: self.law,
            mass: self.mass,
        }
    }

    /// Draws from the covariance of the model. A mass that the study gives is known.
    fn draws(&self, count: u64, seed: u64) -> Result<Family, Undrawn> {
        let given = self.given_mass.then_some(self.mass);
        Family::draws(&self.model, self.truth(), given, count, seed)
    }
}

fn names<T>(all: &[Named<T>]) -> impl Iterator<Item = &String> {
    all.iter().map(|n| &n.name)
}
