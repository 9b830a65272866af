//! Methods beside each other: many seeds of each on one log or one problem whose answer is known.

mod crew;
mod excitation;
mod genome;
mod known;
mod logged;
mod made;
mod options;
mod subject;
mod summary;
mod trial;

pub use excitation::Excitation;
pub use options::{CompareOptions, Cost, Input, ONE_START, integrator_name};

use crate::error::Error;
use crate::wording::{Setting, TOGETHER_WITH};
use known::Known;
use options::USUAL_NOISE;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;
use stiction_files::compare_file::{CompareFile, Reference, SCHEMA};
use stiction_files::{Axis, Hash, Runs, Work};
use stiction_identify::Observer;
use stiction_identify::candidates::Scheme;
use stiction_number::{counted, short};
use stiction_policy::comparison;
use subject::Subject;
use trial::Trial;

/// Runs every method with every seed, side by side on all threads. Apart from the times, the results do not depend on
/// how many threads there are.
///
/// An observer that stops the comparison leaves the runs that were complete.
///
/// # Errors
/// For input that cannot be read or identified, unknown names, and limits out of range.
pub fn compare(
    options: &CompareOptions,
    observer: &mut dyn Observer,
) -> Result<CompareFile, Error> {
    Comparison::new(options, observer)?.run(observer)
}

/// Most samples that the candidates of a comparison are computed on unless more are allowed: fifty times what one of all methods on
/// a known axis takes with the usual seeds and evaluations.
pub const MOST_SAMPLES: u64 = 1_000_000_000_000;

/// A comparison whose input is read: how large it is, before it runs.
pub struct Comparison<'a> {
    options: &'a CompareOptions,
    axis: Axis,
    subject: Subject,
    methods: Vec<String>,
    clock: Instant,
}

/// How large a comparison is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompareSize {
    /// Each method with each seed.
    pub runs: u64,
    /// Samples on which candidates are computed, at most: runs times evaluations times samples of the record.
    pub samples: u64,
}

impl<'a> Comparison<'a> {
    /// Reads or makes what is compared on.
    ///
    /// # Errors
    /// As [`compare()`]; also for one that is larger than the options allow.
    pub fn new(options: &'a CompareOptions, observer: &mut dyn Observer) -> Result<Self, Error> {
        let clock = Instant::now();
        check(options)?;
        let axis = options.axis.as_deref();
        let axis = axis.map_or_else(|| Ok(Axis::default()), Axis::read)?;
        let subject = subject(options, &axis, observer)?;
        let methods = methods(options, &subject)?;
        let comparison = Self {
            options,
            axis,
            subject,
            methods,
            clock,
        };
        let CompareSize { runs, samples } = comparison.size();
        if samples > options.max_samples {
            let found = format!(
                "{runs} runs compute candidates on up to {} samples: {} x {} x {} evaluations x {} samples",
                short(samples as f64),
                counted(comparison.methods.len(), "method"),
                counted(options.seeds as usize, "seed"),
                options.evaluations,
                comparison.subject.samples,
            );
            return Err(Error::File(stiction_files::Error::TooLarge {
                what: comparison.subject.name,
                found,
                needed: samples,
                allowed: options.max_samples,
            }));
        }
        Ok(comparison)
    }

    /// How large it is.
    pub fn size(&self) -> CompareSize {
        let runs = self.options.seeds * self.methods.len() as u64;
        let each = self.options.evaluations * self.subject.samples as u64;
        CompareSize {
            runs,
            samples: runs.saturating_mul(each),
        }
    }

    /// Runs it.
    ///
    /// # Errors
    /// As [`compare()`].
    pub fn run(self, observer: &mut dyn Observer) -> Result<CompareFile, Error> {
        run(&self, None, observer)
    }

    /// The same, where the runs are [kept](Self::keep) as they are done, and those that were kept before are taken.
    ///
    /// # Errors
    /// As [`compare()`].
    pub fn run_keeping(
        self,
        runs: &Runs,
        observer: &mut dyn Observer,
    ) -> Result<CompareFile, Error> {
        run(&self, Some(runs), observer)
    }

    /// Keeps the runs in the folder that the outcome goes to; `resume` takes those that an earlier call has left there.
    ///
    /// # Errors
    /// Where the folder cannot be written, another call is at work in it, or the runs in it are of another comparison or version.
    pub fn keep(&self, dir: &Path, resume: bool) -> Result<Runs, Error> {
        let work = Work {
            kind: "comparison".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            of: self.depends_on(),
            runs: usize::try_from(self.size().runs).unwrap_or(usize::MAX),
            beside: 0,
        };
        Ok(match resume {
            true => Runs::resume(dir, &work)?,
            false => Runs::begin(dir, &work)?,
        })
    }
}

impl Comparison<'_> {
    /// SHA-256 of all that its runs depend on.
    fn depends_on(&self) -> String {
        let mut options = self.options.clone();
        // It does not matter how many could have been run, nor what its files are called.
        options.max_samples = 0;
        if let Input::Log { logs } = &mut options.input {
            logs.clear();
        }
        let mut hash = Text(Hash::default());
        // It has the settings of the methods: as it was read, whatever stands there by now.
        options.axis = None;
        let axis = self.axis.sha256().unwrap_or_default();
        hash.0.take(axis.as_bytes());
        let Subject {
            data, law, bounds, ..
        } = &self.subject;
        let methods = &self.methods;
        let written = write!(hash, "{options:?} {methods:?} {law:?} {bounds:?} {data:?}");
        written.expect("a hash takes all");
        hash.0.finish()
    }
}

/// A text of which only the hash is kept.
struct Text(Hash);

impl std::fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.take(text.as_bytes());
        Ok(())
    }
}

/// Refuses options that are out of range or do not go together.
fn check(options: &CompareOptions) -> Result<(), Error> {
    for (setting, found, most) in [
        (Setting::Seeds, options.seeds, 10_000),
        (Setting::Evaluations, options.evaluations, 100_000_000),
    ] {
        if !(1..=most).contains(&found) {
            let allowed = format!("1 to {most}");
            return Err(Error::usage(setting.is(found), allowed));
        }
    }
    if options.cost == Some(Cost::Separable) && options.integrator != Scheme::Explin {
        return Err(Error::usage(
            [
                Setting::Integrator.is(integrator_name(options.integrator)),
                TOGETHER_WITH.into(),
                Setting::Cost.is(Cost::Separable.name()),
            ],
            [
                "explin, or ".into(),
                Setting::Cost.is(Cost::Six.name()),
                ": the separable cost is solved with its own recursion".into(),
            ],
        ));
    }
    Ok(())
}

/// A run that an earlier call of the same comparison has kept.
fn taken(runs: Option<&Runs>, place: usize, name: &str, seed: u64) -> Option<Trial> {
    let trial: Trial = serde_json::from_str(runs?.taken(place)?).ok()?;
    (trial.method == name && trial.seed == seed).then_some(trial)
}

fn run(
    comparison: &Comparison,
    runs: Option<&Runs>,
    observer: &mut dyn Observer,
) -> Result<CompareFile, Error> {
    let Comparison {
        options,
        axis,
        subject,
        methods,
        clock,
    } = comparison;
    let (least, by) = subject.reference(observer)?;
    let problem = subject.problem()?;
    let setting = trial::Setting {
        problem: &*problem,
        evaluations: options.evaluations,
        descends: subject.descends(),
        axis,
    };
    let tasks = (0..options.seeds)
        .flat_map(|seed| methods.iter().map(move |name| (name.as_str(), seed)))
        .enumerate();
    let tasks: Vec<(usize, (&str, u64))> = tasks.collect();
    let (trials, stopped) = crew::run(&tasks, observer, |&(place, (name, seed)), stop| {
        if let Some(trial) = taken(runs, place, name, seed) {
            return Some(trial);
        }
        let trial = setting.run(name, seed, stop)?;
        if let Some(runs) = runs {
            let text = serde_json::to_string(&trial).expect("plain data");
            runs.add(place, &text);
        }
        Some(trial)
    });
    let trials: Vec<Trial> = trials.into_iter().flatten().collect();
    let found = trials.iter().filter_map(|t| t.cost());
    let lowest = found.fold(f64::INFINITY, f64::min);
    // A cost that is lower by rounding only belongs to the same optimum.
    let beaten = lowest < least * (1.0 - comparison::MAX_OPTIMUM_DIFFERENCE)
        && least - lowest > comparison::MAX_COST_DIFFERENCE;
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
        Input::Named(_) => options.noise.unwrap_or(USUAL_NOISE) > 0.0,
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
            Input::Named(_) => Some(options.noise.unwrap_or(USUAL_NOISE)),
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

/// Reads or makes what is compared on.
fn subject(
    options: &CompareOptions,
    axis: &Axis,
    observer: &mut dyn Observer,
) -> Result<Subject, Error> {
    match &options.input {
        Input::Log { logs } => logged::subject(options, logs, axis, observer),
        Input::Named(name) => match known::find(name) {
            Some(Known::Axis(axis)) => made::from_axis(options, &axis),
            Some(Known::Curve(curve)) => made::from_curve(options, curve),
            None => Err(Error::usage(
                Setting::Problem.is(name),
                format!("one of {}", known::names().join(", ")),
            )),
        },
    }
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
