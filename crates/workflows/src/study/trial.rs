//! A short simulation of a study while somebody moves a parameter of an axis: one path or contour, without compensation and with
//! one compensator, which keeps the parameters of the model.
//!
//! It is the simulation of the study in every sample. What makes it short is that the path ends early, and that no watchdog
//! learns before it.

use super::contour_trace::ContourTrace;
use super::diverged::Fault;
use super::done::Done;
use super::metrics::metrics;
use super::plane::Plane;
use super::run::Grid;
use super::trace::Course;
use serde::Serialize;
use stiction_files::study::{Family, Job, Knob, Scheme, Study};
use stiction_files::symbols;
use stiction_number::four_digits as short;
use stiction_servo::path::Reference;
use stiction_servo::plane::{Curve, Deviation, Place, PlaneMotion, Station};
use stiction_servo::trajectory::Trajectory;

/// How much is simulated at most: plant steps, of which a control period counts [`OF_A_PERIOD`] more. One core takes some 20 ms
/// for them.
const MOST_WORK: f64 = 2e5;
/// What controller, compensation and drive take in a control period, plant steps.
const OF_A_PERIOD: f64 = 3.0;

/// What is tried of a study: the places in its lists, and parameters of the axes.
#[derive(Clone, Debug, Default)]
pub struct Which {
    /// Path of one axis, or contour; these are numbered after the paths.
    pub path: usize,
    /// Controller.
    pub controller: usize,
    /// Compensator; `None` takes the last that the motion has, which a study has as its best. The first is no compensation.
    pub compensator: Option<usize>,
    /// Parameters of the axis by name, SI; the others are those of the model.
    pub values: Vec<(String, f64)>,
    /// The same of the second axis.
    pub second_values: Vec<(String, f64)>,
}

/// What came of it, SI.
#[derive(Debug, Serialize)]
pub struct Tried {
    /// Names of the paths and contours, controllers and compensators that can be tried.
    pub paths: Vec<String>,
    /// Controllers.
    pub controllers: Vec<String>,
    /// Compensators.
    pub compensators: Vec<String>,
    /// Which of them was.
    pub compensator: usize,
    /// The parameters that can be moved.
    pub knobs: Vec<Knob>,
    /// The same of the second axis, on a contour.
    pub second_knobs: Vec<Knob>,
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
    /// These runs in the plane, on a contour.
    pub plane: Option<Plane>,
}

/// One run.
#[derive(Debug, Serialize)]
pub struct TriedRun {
    /// Name of its compensator.
    pub compensator: String,
    /// Errors, m (rad), as `docs/study.md` defines them; on a contour deviations from it.
    pub rms_error: f64,
    /// The largest.
    pub peak_error: f64,
    /// The largest tracking error about reversals, of each axis.
    pub reversal_peaks: Vec<f64>,
    /// By how much the largest is less than without compensation, percent.
    pub reduction_percent: Option<f64>,
    /// Errors over the time from where they count; of each stretch the least and the largest.
    pub whole: Drawn,
    /// The same about the last reversal but one, on a path.
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
/// Where the study has no such motion, controller or compensator, parameters make no law, or the axis leaves its path.
pub fn trial(mut study: Study, which: &Which) -> Result<Tried, NotTried> {
    let lists = Lists::of(&study);
    let compensator = lists.compensator(&study, which)?;
    move_axes(&mut study, which)?;
    let cut = narrow(&mut study, which.path, compensator);
    let study = study;
    let grid = Grid::of(&study, 1);
    let run = |place: usize| -> Result<(TriedRun, Done), NotTried> {
        let job = Job {
            path: 0,
            controller: which.controller,
            compensator: place,
            coupled: false,
            family: 0,
            belief: 0,
        };
        let name = &lists.compensators[place];
        let done = grid.run(job, &|| true).map_err(|e| refused(name, e))?;
        let done = done.ok_or_else(|| NotTried("stopped".into()))?;
        Ok((tried_run(&study, job, name, &done), done))
    };
    let done = match compensator {
        0 => vec![run(0)?],
        with => {
            let (without, with) = rayon::join(|| run(0), || run(with));
            let (without, mut with) = (without?, with?);
            let left = with.0.peak_error / without.0.peak_error;
            with.0.reduction_percent = left.is_finite().then_some(100.0 * (1.0 - left));
            vec![without, with]
        }
    };
    let (runs, done): (Vec<TriedRun>, Vec<Done>) = done.into_iter().unzip();
    let contours: Vec<&ContourTrace> = done.iter().flat_map(|done| &done.contour).collect();
    let second = study.second.as_ref().filter(|_| study.paths.is_empty());
    Ok(Tried {
        paths: lists.motions,
        controllers: lists.controllers,
        compensators: lists.compensators,
        compensator,
        knobs: study.machine.knobs(),
        second_knobs: second.map_or_else(Vec::new, |second| second.machine.knobs()),
        unit: symbols::length_unit(study.machine.motion).into(),
        seconds: cut.seconds,
        whole_seconds: cut.whole_seconds,
        from_seconds: cut.from_seconds,
        samples: (cut.seconds * study.machine.rate) as usize + 1,
        runs,
        plane: Plane::of(&contours),
    })
}

/// The names of what can be tried.
struct Lists {
    motions: Vec<String>,
    controllers: Vec<String>,
    compensators: Vec<String>,
}

impl Lists {
    fn of(study: &Study) -> Self {
        let paths = study.paths.iter().map(|path| &path.name);
        let contours = study.contours.iter().map(|contour| &contour.name);
        Lists {
            motions: paths.chain(contours).cloned().collect(),
            controllers: study.controllers.iter().map(|c| c.name.clone()).collect(),
            compensators: study.compensators.iter().map(|c| c.name.clone()).collect(),
        }
    }

    /// The place of the compensator that is asked for, where all that is asked for is there.
    fn compensator(&self, study: &Study, which: &Which) -> Result<usize, NotTried> {
        let there = |what: &str, place: usize, all: &[String]| match all.len() {
            count if place < count => Ok(()),
            count => Err(NotTried(format!(
                "{what} {place}; the study has {count}, counted from 0"
            ))),
        };
        there("path", which.path, &self.motions)?;
        there("controller", which.controller, &self.controllers)?;
        let runs = |place: &usize| study.has_runs(which.path, *place);
        let Some(place) = which.compensator else {
            let last = (0..self.compensators.len()).rev().find(runs);
            return Ok(last.unwrap_or(0));
        };
        there("compensator", place, &self.compensators)?;
        match runs(&place) {
            true => Ok(place),
            false => Err(NotTried(format!(
                "{} is for the paths of one axis, and {} is a contour",
                self.compensators[place], self.motions[which.path]
            ))),
        }
    }
}

/// Gives the axes the parameters that are asked for; the compensators keep those of the models.
fn move_axes(study: &mut Study, which: &Which) -> Result<(), NotTried> {
    let on_path = which.path < study.paths.len();
    let moved = study.machine.moved(&which.values).map_err(NotTried)?;
    study.families = vec![Family::moved(study.machine.truth(), moved)];
    if on_path {
        study.second = None;
    }
    match &mut study.second {
        Some(second) => {
            let moved = second.machine.moved(&which.second_values);
            let moved = moved.map_err(|e| NotTried(format!("second axis: {e}")))?;
            second.families = vec![Family::moved(second.machine.truth(), moved)];
        }
        None if which.second_values.is_empty() => {}
        None => {
            return Err(NotTried(
                "a path has one axis: parameters of a second one are for contours".into(),
            ));
        }
    }
    Ok(())
}

/// What is simulated of a motion, s.
struct Cut {
    seconds: f64,
    whole_seconds: f64,
    from_seconds: f64,
}

/// Leaves one motion in the study, of which as much as can be simulated while somebody waits, and no watchdog.
fn narrow(study: &mut Study, path: usize, compensator: usize) -> Cut {
    for scheme in &mut study.compensators {
        if let Scheme::Model(model) = &mut scheme.value {
            model.watchdog = None;
        }
    }
    let passes = match &study.compensators[compensator].value {
        Scheme::None => 0.0,
        Scheme::Learning(_, count) => *count as f64,
        _ => 1.0,
    };
    let of_a_period = (OF_A_PERIOD + f64::from(study.machine.substeps)) * (1.0 + passes);
    let most = MOST_WORK / of_a_period / study.machine.rate;
    match path.checked_sub(study.paths.len()) {
        None => {
            let mut path = study.paths.swap_remove(path);
            let cut = Cut::of(path.trajectory.duration(), path.skip, most);
            path.trajectory = Box::new(Shortened {
                whole: path.trajectory,
                seconds: cut.seconds,
            });
            path.skip = cut.from_seconds;
            study.paths = vec![path];
            study.contours.clear();
            cut
        }
        Some(place) => {
            let mut contour = study.contours.swap_remove(place);
            let cut = Cut::of(contour.motion.duration(), contour.skip, most);
            contour.motion = Box::new(Shortened {
                whole: contour.motion,
                seconds: cut.seconds,
            });
            contour.skip = cut.from_seconds;
            study.paths.clear();
            study.contours = vec![contour];
            cut
        }
    }
}

impl Cut {
    fn of(whole_seconds: f64, skip: f64, most: f64) -> Self {
        let seconds = whole_seconds.min(most);
        Cut {
            seconds,
            whole_seconds,
            from_seconds: skip.min(0.5 * seconds),
        }
    }
}

fn refused(compensator: &str, fault: Fault) -> NotTried {
    NotTried(match fault {
        Fault::Refused(e) => {
            let value = short(e.value);
            format!(
                "{compensator}: {} = {value}; allowed: {}",
                e.name, e.allowed
            )
        }
        Fault::Diverged(time) => format!(
            "{compensator}: with these parameters the axis leaves its path at {} s and does not come back",
            short(time)
        ),
    })
}

fn tried_run(study: &Study, job: Job, name: &str, done: &Done) -> TriedRun {
    let metric = |name: &str| {
        let mut each = metrics(study, job).iter().zip(&done.metrics);
        each.find(|(own, _)| **own == name).map(|(_, x)| *x)
    };
    let [rms, peak] = match done.contour {
        None => ["rms_error", "peak_error"],
        Some(_) => ["contour_rms", "contour_peak"],
    };
    let reversals = ["reversal_peak", "reversal_peak_x", "reversal_peak_y"];
    let path = done.trace.as_ref();
    let drawn = |course: Option<&Course>| {
        course.map_or_else(Drawn::default, |c| Drawn::of(&c.time, &c.error))
    };
    TriedRun {
        compensator: name.into(),
        rms_error: metric(rms).unwrap_or(f64::NAN),
        peak_error: metric(peak).unwrap_or(f64::NAN),
        reversal_peaks: reversals.into_iter().filter_map(metric).collect(),
        reduction_percent: None,
        whole: match &done.contour {
            None => drawn(path.map(|t| &t.whole)),
            Some(contour) => Drawn::of(&contour.time, &contour.deviation),
        },
        reversal: drawn(path.map(|t| &t.reversal)),
    }
}

/// The first part of a motion.
struct Shortened<M: ?Sized> {
    whole: Box<M>,
    seconds: f64,
}

impl Trajectory for Shortened<dyn Trajectory + Send + Sync> {
    fn duration(&self) -> f64 {
        self.seconds
    }

    fn at(&self, t: f64) -> Reference {
        self.whole.at(t)
    }
}

impl PlaneMotion for Shortened<dyn PlaneMotion + Send + Sync> {
    fn duration(&self) -> f64 {
        self.seconds
    }

    fn at(&self, t: f64) -> Station {
        self.whole.at(t)
    }
}

/// The curve is all of it: deviations are from the whole contour.
impl Curve for Shortened<dyn PlaneMotion + Send + Sync> {
    fn end(&self) -> f64 {
        self.whole.end()
    }

    fn place(&self, p: f64) -> Place {
        self.whole.place(p)
    }

    fn corners(&self) -> Vec<f64> {
        self.whole.corners()
    }

    fn deviation(&self, p: f64, error: [f64; 2]) -> Deviation {
        self.whole.deviation(p, error)
    }

    fn true_deviation(&self, position: [f64; 2], p: f64) -> Deviation {
        self.whole.true_deviation(position, p)
    }
}

impl Drawn {
    fn of(time: &[f64], error: &[f64]) -> Self {
        let line = |values: &[f64]| values.iter().map(|x| *x as f32).collect();
        Drawn {
            time: line(time),
            error: line(error),
        }
    }
}
