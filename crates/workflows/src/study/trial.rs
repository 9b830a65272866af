//! A short simulation of a study while somebody moves a parameter of its axis: one path, without compensation and with one
//! compensator, which keeps the parameters of the model.
//!
//! It is the simulation of the study in every sample. What makes it short is that the path ends early, and that no watchdog
//! learns before it.

use super::diverged::Fault;
use super::metrics::metrics;
use super::run::Grid;
use super::trace::Course;
use serde::Serialize;
use stiction_files::study::{Family, Job, Knob, Scheme, Study};
use stiction_files::symbols;
use stiction_number::four_digits as short;
use stiction_servo::path::Reference;
use stiction_servo::trajectory::Trajectory;

/// How much is simulated at most: plant steps, of which a control period counts [`OF_A_PERIOD`] more. One core takes some 20 ms
/// for them.
const MOST_WORK: f64 = 2e5;
/// What controller, compensation and drive take in a control period, plant steps.
const OF_A_PERIOD: f64 = 3.0;

/// What is tried of a study: the places in its lists, and parameters of the axis.
#[derive(Clone, Debug, Default)]
pub struct Which {
    /// Path of one axis.
    pub path: usize,
    /// Controller.
    pub controller: usize,
    /// Compensator; `None` takes the last, which a study has as its best. The first is no compensation.
    pub compensator: Option<usize>,
    /// Parameters of the axis by name, SI; the others are those of the model.
    pub values: Vec<(String, f64)>,
}

/// What came of it, SI.
#[derive(Debug, Serialize)]
pub struct Tried {
    /// Names of the paths, controllers and compensators that can be tried.
    pub paths: Vec<String>,
    /// Controllers.
    pub controllers: Vec<String>,
    /// Compensators.
    pub compensators: Vec<String>,
    /// Which of them was.
    pub compensator: usize,
    /// The parameters that can be moved.
    pub knobs: Vec<Knob>,
    /// Unit of positions and errors.
    pub unit: String,
    /// How long the motion is that was simulated, s ...
    pub seconds: f64,
    /// ... that of the study, s, and from when on errors count, s.
    pub whole_seconds: f64,
    /// From when on errors count, s.
    pub from_seconds: f64,
    /// Control periods of a run.
    pub samples: usize,
    /// Without compensation, and with it where that is another one.
    pub runs: Vec<TriedRun>,
}

/// One run.
#[derive(Debug, Serialize)]
pub struct TriedRun {
    /// Name of its compensator.
    pub compensator: String,
    /// Errors, m (rad), as `docs/study.md` defines them.
    pub rms_error: f64,
    /// The largest.
    pub peak_error: f64,
    /// The largest about reversals.
    pub reversal_peak: f64,
    /// By how much the largest is less than without compensation, percent.
    pub reduction_percent: Option<f64>,
    /// Errors over the time from where they count; of each stretch the least and the largest.
    pub whole: Drawn,
    /// The same about the last reversal but one.
    pub reversal: Drawn,
}

/// A line, to be drawn: with as many digits as that needs.
#[derive(Debug, Default, Serialize)]
pub struct Drawn {
    /// s
    pub time: Vec<f32>,
    /// m (rad)
    pub error: Vec<f32>,
}

/// Why nothing was tried.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct NotTried(String);

/// Simulates what was asked for.
///
/// # Errors
/// Where the study has no such path, controller or compensator, parameters make no law, or the axis leaves its path.
pub fn trial(mut study: Study, which: &Which) -> Result<Tried, NotTried> {
    let paths: Vec<String> = study.paths.iter().map(|p| p.name.clone()).collect();
    let controllers: Vec<String> = study.controllers.iter().map(|c| c.name.clone()).collect();
    let compensators: Vec<String> = study.compensators.iter().map(|c| c.name.clone()).collect();
    let last = compensators.len().saturating_sub(1);
    let compensator = which.compensator.unwrap_or(last);
    if paths.is_empty() {
        return Err(NotTried(
            "the study has contours only, which are not tried here: simulate it, or give a [[path]]".into(),
        ));
    }
    for (what, place, all) in [
        ("path", which.path, &paths),
        ("controller", which.controller, &controllers),
        ("compensator", compensator, &compensators),
    ] {
        if place >= all.len() {
            let count = all.len();
            return Err(NotTried(format!(
                "{what} {place}; the study has {count}, counted from 0"
            )));
        }
    }
    let moved = study.machine.moved(&which.values).map_err(NotTried)?;
    study.families = vec![Family::moved(study.machine.truth(), moved)];
    study.second = None;
    study.contours.clear();
    let mut passes = 1.0;
    for scheme in &mut study.compensators {
        if let Scheme::Model(model) = &mut scheme.value {
            model.watchdog = None;
        }
    }
    if let Scheme::Learning(_, count) = &study.compensators[compensator].value {
        passes = *count as f64;
    }
    let rate = study.machine.rate;
    let both = 1.0 + if compensator == 0 { 0.0 } else { passes };
    let of_a_period = (OF_A_PERIOD + f64::from(study.machine.substeps)) * both;
    let mut path = study.paths.swap_remove(which.path);
    let whole_seconds = path.trajectory.duration();
    let seconds = whole_seconds.min(MOST_WORK / of_a_period / rate);
    path.trajectory = Box::new(Shortened {
        whole: path.trajectory,
        seconds,
    });
    path.skip = path.skip.min(0.5 * seconds);
    let from_seconds = path.skip;
    study.paths = vec![path];
    let study = study;
    let grid = Grid::of(&study, 1);
    let job = |compensator: usize| Job {
        path: 0,
        controller: which.controller,
        compensator,
        coupled: false,
        family: 0,
        belief: 0,
    };
    let run = |place: usize| -> Result<TriedRun, NotTried> {
        let name = &compensators[place];
        let done = grid.run(job(place), &|| true).map_err(|fault| {
            NotTried(match fault {
                Fault::Refused(e) => {
                    format!("{name}: {} = {}; allowed: {}", e.name, short(e.value), e.allowed)
                }
                Fault::Diverged(time) => format!(
                    "{name}: with these parameters the axis leaves its path at {} s and does not come back",
                    short(time)
                ),
            })
        })?;
        let done = done.ok_or_else(|| NotTried("stopped".into()))?;
        let metric = |name: &str| {
            let mut each = metrics(&study, job(place)).iter().zip(&done.metrics);
            each.find(|(own, _)| **own == name)
                .map_or(f64::NAN, |(_, x)| *x)
        };
        let trace = done.trace.as_ref();
        let drawn = |course: Option<&Course>| course.map_or_else(Drawn::default, Drawn::of);
        Ok(TriedRun {
            compensator: name.clone(),
            rms_error: metric("rms_error"),
            peak_error: metric("peak_error"),
            reversal_peak: metric("reversal_peak"),
            reduction_percent: None,
            whole: drawn(trace.map(|t| &t.whole)),
            reversal: drawn(trace.map(|t| &t.reversal)),
        })
    };
    let runs = match compensator {
        0 => vec![run(0)?],
        with => {
            let (without, with) = rayon::join(|| run(0), || run(with));
            let (without, mut with) = (without?, with?);
            let left = with.peak_error / without.peak_error;
            with.reduction_percent = left.is_finite().then_some(100.0 * (1.0 - left));
            vec![without, with]
        }
    };
    Ok(Tried {
        paths,
        controllers,
        compensators,
        compensator,
        knobs: study.machine.knobs(),
        unit: symbols::length_unit(study.machine.motion).into(),
        seconds,
        whole_seconds,
        from_seconds,
        samples: (seconds * rate) as usize + 1,
        runs,
    })
}

/// The first part of a motion.
struct Shortened {
    whole: Box<dyn Trajectory + Send + Sync>,
    seconds: f64,
}

impl Trajectory for Shortened {
    fn duration(&self) -> f64 {
        self.seconds
    }

    fn at(&self, t: f64) -> Reference {
        self.whole.at(t)
    }
}

impl Drawn {
    fn of(course: &Course) -> Self {
        let line = |values: &[f64]| values.iter().map(|x| *x as f32).collect();
        Drawn {
            time: line(&course.time),
            error: line(&course.error),
        }
    }
}
