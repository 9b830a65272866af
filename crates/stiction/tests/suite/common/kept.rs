//! A promise of compensation, and whether the axis keeps it that the log came from.

use super::identified::identified;
use std::fmt;
use stiction_files::Axis;
use stiction_files::study::Study;
use stiction_friction::LuGre;
use stiction_identify::Silent;
use stiction_servo::integrator::Integrator;
use stiction_servo::plant::{Load, Motion as State, Plant};
use stiction_testkit::worlds::{Machine, Motion, Running, Setup, record};
use stiction_workflows::identify::Options;
use stiction_workflows::study::simulate;
use stiction_workflows::study::simulate_on;

/// What becomes of a log.
pub enum Told {
    /// Why nothing is promised.
    Nothing(String),
    /// What is, of the whole law on each path.
    Promised {
        /// Whether the identification may be used.
        trusted: bool,
        /// One for each path.
        kept: Vec<Kept>,
    },
}

/// What is left of the largest error on a path, in percent of that without compensation.
pub struct Kept {
    /// The path.
    pub path: String,
    /// The promised interval.
    pub promised: [f64; 2],
    /// What is left on the axis itself.
    pub found: f64,
}

impl Kept {
    /// Whether it lies in the interval.
    pub fn is_kept(&self) -> bool {
        self.promised[0] <= self.found && self.found <= self.promised[1]
    }
}

impl fmt::Display for Kept {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let ([least, most], found) = (self.promised, self.found);
        let mark = if self.is_kept() { "" } else { " !" };
        write!(
            f,
            "{}: {least:.1} to {most:.1} % promised, {found:.1} %{mark}",
            self.path
        )
    }
}

/// The compensator that is judged.
const JUDGED: &str = "lugre";
const ERROR: &str = "peak_error";

/// The axis of a world in place of the plant of a study.
struct Real(Running);

impl Integrator<LuGre<f64>> for Real {
    fn advance(&mut self, _: &Plant, _: State, span: f64, load: Load, _: f64) -> State {
        let (position, velocity) = self.0.advance(load.force, span);
        State {
            position,
            velocity,
            deflection: 0.0,
        }
    }
}

/// Identifies the log of a world, takes what the study beside the model promises, and measures it on the axis of the world.
pub fn kept(machine: &Machine, motion: Motion, setup: impl Into<Setup>, seed: u64) -> Told {
    let setup = setup.into();
    let fit = match identified(
        machine,
        &[record(machine, motion, setup, seed)],
        &Axis::default(),
        &Options::default(),
    ) {
        Ok(fit) => fit,
        Err(e) => return Told::Nothing(e.to_string()),
    };
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("fit");
    let files = stiction_pages::bundle::identification_in(&fit.0, &kept);
    files.write(&kept).unwrap();
    let study = match Study::read(folder.path().join("fit/study.toml")) {
        Ok(study) => study,
        Err(e) => return Told::Nothing(e.to_string()),
    };
    let file = simulate(&study, &mut Silent).file;
    if let Some(why) = file.not_promised {
        return Told::Nothing(why);
    }
    let axis = || Real(Running::after(machine, motion, setup, seed));
    let runs = match simulate_on(&study, &axis) {
        Ok(runs) => runs,
        Err(e) => return Told::Nothing(format!("on the axis itself: {e}")),
    };
    let error = |path: &str, compensator: &str| {
        let run = runs.iter().find(|(job, _)| {
            let [p, _, c] = study.names(*job);
            (p, c) == (path, compensator)
        });
        let metric = run.and_then(|(_, metrics)| metrics.iter().find(|m| m.0 == ERROR));
        metric.map_or(f64::NAN, |m| m.1)
    };
    let promises = file.promise.iter().filter(|p| p.compensator == JUDGED);
    let kept = promises.map(|promise| Kept {
        path: promise.path.clone(),
        promised: promise.left90_percent,
        found: 100.0 * error(&promise.path, JUDGED) / error(&promise.path, "none"),
    });
    Told::Promised {
        trusted: fit.is_trustworthy(),
        kept: kept.collect(),
    }
}
