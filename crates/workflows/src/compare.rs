//! Methods beside each other: many seeds of each on one log or one problem whose answer is known.

mod crew;
mod excitation;
mod known;
mod subject;
mod summary;
mod trial;

pub use excitation::Excitation;

use crate::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use stiction_files::compare_file::{CompareFile, Reference, SCHEMA};
use stiction_identify::Observer;
use stiction_identify::candidates::{Candidates, Scheme};
use subject::Subject;
use trial::Trial;

/// What is compared on.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// Logs of one axis.
    Log {
        /// Fitted together.
        logs: Vec<PathBuf>,
        /// Axis file; `None` leaves all to detection.
        axis: Option<PathBuf>,
    },
    /// A problem by name: C95, machine, motor, V2, V3, V5, V6, V7, V10, V16.
    Named(String),
}

/// What the methods minimise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// The six parameters of LuGre, motion in and force out.
    Six,
    /// The nonlinear unknowns of LuGre, everything linear solved.
    Separable,
    /// The six parameters of LuGre, force in and position out.
    Position,
    /// The parameters of a steady curve; for the problems that are one.
    Curve,
}

impl Cost {
    /// Name as typed and as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Cost::Six => "six",
            Cost::Separable => "separable",
            Cost::Position => "position",
            Cost::Curve => "curve",
        }
    }
}

/// Noise of a made record, if nobody says: deviation over the largest force.
pub const NOISE: f64 = 0.01;
/// Sample rate of a made record, if nobody says, Hz.
pub const RATE: f64 = 1000.0;
/// One start of least squares, drawn at random: what `lm` is without its many starts.
pub const ONE_START: &str = "lm-one";

/// Part of the energy by which a cost may be less and still be the same: least squares take theirs from sums of squares,
/// of which so much is rounding. On V5 without noise six searches that end at the same parameters, to nine digits, have
/// costs from 1.815e-12 to 1.822e-12, the reference search, from residuals, 1.825e-12.
const ROUNDING: f64 = 1e-13;

/// What to compare, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct CompareOptions {
    /// On what.
    pub input: Input,
    /// Names of the methods; empty takes all that can work on the cost.
    pub methods: Vec<String>,
    /// Seeds of each method, from 0 on.
    pub seeds: u64,
    /// Most evaluations of a run.
    pub evaluations: u64,
    /// Noise of a made record; `None` takes `NOISE`.
    pub noise: Option<f64>,
    /// Motion of a made record.
    pub excitation: Option<Excitation>,
    /// Sample rate of a made record, Hz; `None` takes `RATE`.
    pub rate: Option<f64>,
    /// Whether a made record follows another law than the one that is fitted.
    pub other_law: bool,
    /// Decades of the box to each side of a point off the answer; `None` takes 1 for a problem, and
    /// the box of `identify` for a log.
    pub decades: Option<f64>,
    /// What integrates the candidates.
    pub integrator: Scheme,
    /// What is minimised.
    pub cost: Option<Cost>,
}

/// Name of an integrator as typed and as written to files.
pub fn integrator_name(scheme: Scheme) -> &'static str {
    match scheme {
        Scheme::Explin => "explin",
        Scheme::Euler => "euler",
        Scheme::RungeKutta => "rk4",
    }
}

/// Runs every method with every seed, side by side on all threads. What comes out, times apart, does
/// not depend on how many there are.
///
/// An observer that stops the comparison leaves the runs that were complete.
///
/// # Errors
/// For input that cannot be read or identified, unknown names, and limits out of range.
pub fn compare(
    options: &CompareOptions,
    observer: &mut dyn Observer,
) -> Result<CompareFile, Error> {
    let clock = Instant::now();
    for (name, found, most) in [
        ("--seeds", options.seeds, 10_000),
        ("--evaluations", options.evaluations, 100_000_000),
    ] {
        if !(1..=most).contains(&found) {
            let allowed = format!("1 to {most}");
            return Err(Error::usage(format!("{name} {found}"), allowed));
        }
    }
    if options.cost == Some(Cost::Separable) && options.integrator != Scheme::Explin {
        return Err(Error::usage(
            format!(
                "--integrator {} beside --cost separable",
                integrator_name(options.integrator)
            ),
            "explin, or --cost six: the separable cost is solved with its own recursion",
        ));
    }
    let subject = Subject::new(options, observer)?;
    let methods = methods(options, &subject)?;
    let (least, by) = subject.reference(observer)?;
    let problem = subject.problem()?;
    let setting = trial::Setting {
        problem: &*problem,
        evaluations: options.evaluations,
        descends: subject.descends(),
    };
    let tasks: Vec<(&str, u64)> = (0..options.seeds)
        .flat_map(|seed| methods.iter().map(move |name| (name.as_str(), seed)))
        .collect();
    let (trials, stopped) = crew::run(&tasks, observer, |&(name, seed), stop| {
        setting.run(name, seed, stop)
    });
    let trials: Vec<Trial> = trials.into_iter().flatten().collect();
    let found = trials.iter().filter_map(|t| t.cost());
    let lowest = found.fold(f64::INFINITY, f64::min);
    // What is less by rounding only is the same optimum.
    let beaten = lowest < least * (1.0 - 1e-6) && least - lowest > ROUNDING;
    let winner = |t: &&Trial| t.cost() == Some(lowest);
    let reference = Reference {
        cost: if beaten { lowest } else { least },
        by: match trials.iter().find(winner).filter(|_| beaten) {
            Some(trial) => trial.method.clone(),
            None => by.into(),
        },
        before: beaten
            .then(|| Some(least).filter(|x| x.is_finite()))
            .flatten(),
        beaten,
    };
    let noisy = match options.input {
        Input::Log { .. } => true,
        Input::Named(_) => options.noise.unwrap_or(NOISE) > 0.0,
    };
    let judge = summary::Judge {
        least: reference.cost,
        truth: &subject.truth,
        by_parameters: !noisy && !options.other_law && !subject.truth.is_empty(),
    };
    let bounds = problem.bounds();
    let ends = bounds.low().iter().zip(bounds.high());
    Ok(CompareFile {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        status: if stopped { "interrupted" } else { "done" }.into(),
        problem: subject.name.clone(),
        source: subject.source.clone(),
        motion: subject.motion.clone(),
        samples: subject.samples,
        rate_hz: subject.rate_hz,
        noise: match options.input {
            Input::Log { .. } => None,
            Input::Named(_) => Some(options.noise.unwrap_or(NOISE)),
        },
        box_decades: options.decades.or(match options.input {
            Input::Log { .. } => None,
            Input::Named(_) => Some(1.0),
        }),
        bounds: ends.map(|(a, b)| [libm::exp(*a), libm::exp(*b)]).collect(),
        cost: subject.cost.name().into(),
        integrator: integrator_name(options.integrator).into(),
        least_squares: subject.descends(),
        coarse_share: problem.coarse_share(),
        truth: subject.truth.clone(),
        seeds: options.seeds,
        evaluations: options.evaluations,
        success: judge.rule().into(),
        reference,
        methods: methods
            .iter()
            .map(|name| judge.method(name, &trials))
            .collect(),
        wall_s: clock.elapsed().as_secs_f64(),
    })
}

/// The methods to run: those asked for, or all that the cost allows.
fn methods(options: &CompareOptions, subject: &Subject) -> Result<Vec<String>, Error> {
    let needs = |name: &str| matches!(name, "niched-ga" | "lm" | ONE_START);
    let known = |name: &str| stiction_search::Method::NAMES.contains(&name) || name == ONE_START;
    if options.methods.is_empty() {
        let all = stiction_search::Method::NAMES.into_iter();
        return Ok(all
            .filter(|name| subject.descends() || !needs(name))
            .map(String::from)
            .collect());
    }
    for (i, name) in options.methods.iter().enumerate() {
        if !known(name) {
            let all = stiction_search::Method::NAMES.join(", ");
            return Err(Error::usage(
                format!("method {name}"),
                format!("one of {all}, {ONE_START}"),
            ));
        }
        if options.methods[..i].contains(name) {
            return Err(Error::usage(format!("method {name} twice"), "each once"));
        }
        if needs(name) && !subject.descends() {
            return Err(Error::usage(
                format!("method {name} where the cost has no derivatives"),
                "the integrator explin and a cost other than position, or a method that takes costs only",
            ));
        }
    }
    Ok(options.methods.clone())
}

/// Any problem, as the runs share it.
type Shared<'a> = dyn Candidates + Sync + 'a;
