//! Logs to a law.

use crate::progress::Watched;
use crate::{Axis, Check, Error, Fit, Log, Progress, Search};
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use stiction_identify::LawKind;
use stiction_workflows::identify as workflow;
use stiction_workflows::source::{self, Source};
use stiction_workflows::{check, identify::Options};

/// A log to identify from: one that was read, or the path of a file.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Recording<'a> {
    /// One that was read.
    Log(&'a Log),
    /// A file, read when the work begins.
    File(Cow<'a, Path>),
}

impl<'a> From<&'a Log> for Recording<'a> {
    fn from(log: &'a Log) -> Self {
        Recording::Log(log)
    }
}

impl<'a> From<&'a Path> for Recording<'a> {
    fn from(path: &'a Path) -> Self {
        Recording::File(path.into())
    }
}

impl<'a> From<&'a PathBuf> for Recording<'a> {
    fn from(path: &'a PathBuf) -> Self {
        Recording::File(path.into())
    }
}

impl From<PathBuf> for Recording<'_> {
    fn from(path: PathBuf) -> Self {
        Recording::File(path.into())
    }
}

impl<'a> From<&'a str> for Recording<'a> {
    fn from(path: &'a str) -> Self {
        Recording::File(Path::new(path).into())
    }
}

impl Recording<'_> {
    fn file(&self) -> Option<PathBuf> {
        match self {
            Recording::Log(_) => None,
            Recording::File(path) => Some(path.to_path_buf()),
        }
    }

    fn source(&self, axis: &Axis) -> Result<Source, Error> {
        match self {
            Recording::Log(log) => Ok(log.0.clone()),
            Recording::File(path) => source::load(path, &axis.0).map_err(Error::of),
        }
    }
}

/// How the parameters are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// All at once, motion in and force out, by separable least squares.
    #[default]
    Separable,
    /// Force in, position out: the axis is simulated and its position fitted.
    OutputError,
    /// The static map, from constant velocities.
    Static,
    /// The static map first, then sigma0 and sigma1 with it held.
    StaticThenDynamic,
    /// sigma0 and sigma1 from force steps below break-away.
    PreslidingStep,
}

impl Method {
    fn of_workflow(self) -> workflow::Method {
        match self {
            Method::Separable => workflow::Method::Separable,
            Method::OutputError => workflow::Method::OutputError,
            Method::Static => workflow::Method::Static,
            Method::StaticThenDynamic => workflow::Method::StaticThenDynamic,
            Method::PreslidingStep => workflow::Method::PreslidingStep,
        }
    }
}

/// An identification to be run: logs of one axis in, a [`Fit`] out. What is not set is as on the command line: the data choose the law,
/// with separable least squares.
///
/// ```no_run
/// use stiction::{Axis, Identification, LawKind};
/// use std::ops::ControlFlow;
///
/// let axis = Axis::read("axis.toml")?;
/// let fit = Identification::of(["monday.csv", "tuesday.csv"])
///     .axis(&axis)
///     .law(LawKind::LuGre)
///     .validate(["wednesday.csv"])
///     .observer(|progress| {
///         eprintln!("{}: {:.0} %", progress.stage.name(), 100.0 * progress.fraction);
///         ControlFlow::Continue(()) // Break stops the work and keeps what was found
///     })
///     .run()?;
/// println!("{:?}, {:?}", fit.verdict(), fit.status());
/// # Ok::<(), stiction::Error>(())
/// ```
pub struct Identification<'a> {
    logs: Vec<Recording<'a>>,
    validate: Vec<Recording<'a>>,
    axis: Cow<'a, Axis>,
    options: Options,
    search: Option<Search>,
    observer: Watched<'a>,
}

impl<'a> Identification<'a> {
    /// Of logs that are fitted together, read (`&[log]`) or as paths (`["run.csv"]`). An axis file that lists parts of a log under
    /// `[[log]]` holds for it where all logs are paths.
    pub fn of<R: Into<Recording<'a>>>(logs: impl IntoIterator<Item = R>) -> Self {
        Self {
            logs: logs.into_iter().map(Into::into).collect(),
            validate: Vec::new(),
            axis: Cow::Owned(Axis::default()),
            options: Options::default(),
            search: None,
            observer: Watched::default(),
        }
    }

    /// Of the logs that an axis file lists under `[[log]]`, and their parts, as it says.
    pub fn listed(axis: &'a Axis) -> Self {
        Self::of::<&Log>([]).axis(axis)
    }

    /// What is known of the machine: the axis that logs in memory were read with. Default: nothing.
    #[must_use]
    pub fn axis(mut self, axis: &'a Axis) -> Self {
        self.axis = Cow::Borrowed(axis);
        self
    }

    /// Logs that are not fitted: the result says how well the law predicts them, and is not trustworthy where it does not. Default:
    /// none; blocks of the fitted logs are held out in turn.
    #[must_use]
    pub fn validate<R: Into<Recording<'a>>>(mut self, logs: impl IntoIterator<Item = R>) -> Self {
        self.validate.extend(logs.into_iter().map(Into::into));
        self
    }

    /// Fits the first part of the samples, 0 to 1, and validates on the rest.
    #[must_use]
    pub fn split(mut self, part: f64) -> Self {
        self.options.split = Some(part);
        self
    }

    /// The law. Default: the data choose among those that can be exported, symmetric and asymmetric; a [method](Self::method) that does
    /// not choose takes LuGre.
    #[must_use]
    pub fn law(mut self, law: LawKind) -> Self {
        self.options.law = Some(law);
        self
    }

    /// Gives each direction of the named law parameters of its own; takes back [`symmetric`](Self::symmetric).
    #[must_use]
    pub fn asymmetric(mut self) -> Self {
        (self.options.asymmetric, self.options.symmetric) = (true, false);
        self
    }

    /// Lets the data choose only among laws with the same parameters in both directions; takes back [`asymmetric`](Self::asymmetric).
    #[must_use]
    pub fn symmetric(mut self) -> Self {
        (self.options.asymmetric, self.options.symmetric) = (false, true);
        self
    }

    /// Fits no simpler laws beside a law that is named: about half the time, and nothing is said of whether it is needed. Refused where
    /// the data choose the law.
    #[must_use]
    pub fn without_comparison(mut self) -> Self {
        self.options.compare_laws = false;
        self
    }

    /// How the parameters are found. Default: [`Method::Separable`].
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.options.procedures.method = method.of_workflow();
        self
    }

    /// Searches the parameters before least squares: all at once, with [`Method::Static`] and [`Method::StaticThenDynamic`] those of each
    /// step.
    #[must_use]
    pub fn search(mut self, search: Search) -> Self {
        self.search = Some(search);
        self
    }

    /// Seed of the search, 0 by default; the same seed gives the same bits at any number of threads.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.options.seed = seed;
        self
    }

    /// Logs of constant velocities for the static parameters. Default: the logs themselves.
    #[must_use]
    pub fn statics<P: Into<PathBuf>>(mut self, logs: impl IntoIterator<Item = P>) -> Self {
        let paths = logs.into_iter().map(Into::into);
        self.options.procedures.statics.extend(paths);
        self
    }

    /// Logs of force ramps, one break-away each.
    #[must_use]
    pub fn break_away<P: Into<PathBuf>>(mut self, logs: impl IntoIterator<Item = P>) -> Self {
        let paths = logs.into_iter().map(Into::into);
        self.options.procedures.break_away.extend(paths);
        self
    }

    /// Model file of an earlier identification, for what is not identified here.
    #[must_use]
    pub fn model(mut self, file: impl Into<PathBuf>) -> Self {
        self.options.procedures.model = Some(file.into());
        self
    }

    /// The `plan.toml` that a log was recorded by: the result says what ran of it.
    #[must_use]
    pub fn plan(mut self, file: impl Into<PathBuf>) -> Self {
        self.options.procedures.plan = Some(file.into());
        self
    }

    /// Sees the progress, and may stop the work with [`ControlFlow::Break`]: what was found by then is kept, and the
    /// [status](Fit::status) is [`Interrupted`](crate::Status::Interrupted). It is called from one thread at a time, which need not be
    /// the one that started the work.
    #[must_use]
    pub fn observer(
        mut self,
        observer: impl FnMut(&Progress) -> ControlFlow<()> + Send + 'a,
    ) -> Self {
        self.observer = Watched::by(observer);
        self
    }

    /// Identifies the friction of the axis, with intervals and a verdict.
    ///
    /// # Errors
    /// Where a file cannot be read, the logs do not go together or lack a channel, options exclude each other, or nothing can be
    /// identified. A result that should not be trusted is no error: see [`Fit::is_trustworthy`].
    pub fn run(mut self) -> Result<Fit, Error> {
        if let Some(search) = self.search.take() {
            search.into_options(&mut self.options);
        }
        let (axis, observer) = (&self.axis.0, &mut self.observer);
        let files = (files(&self.logs), files(&self.validate));
        let outcome = if let (Some(logs), Some(validate)) = files {
            workflow::identify_files(&self.options, axis, &logs, &validate, observer)
        } else {
            let logs = sources(&self.logs, &self.axis)?;
            let validate = sources(&self.validate, &self.axis)?;
            workflow::identify_logs(&self.options, axis, logs, validate, observer)
        };
        outcome.map(Fit).map_err(Error::of)
    }

    /// Says what was read of the logs, and what they can and cannot determine, without an identification in full: of what is set here it
    /// takes the logs, the axis and the observer.
    ///
    /// # Errors
    /// Where a file cannot be read, or the axis does not go with a log.
    pub fn check(mut self) -> Result<Check, Error> {
        let (axis, observer) = (&self.axis.0, &mut self.observer);
        let found = match files(&self.logs) {
            Some(logs) => check::check_files(&logs, axis, observer),
            None => check::check_logs(&sources(&self.logs, &self.axis)?, axis, observer),
        };
        found.map(Check).map_err(Error::of)
    }
}

/// The paths, where all logs are files.
fn files(logs: &[Recording<'_>]) -> Option<Vec<PathBuf>> {
    logs.iter().map(Recording::file).collect()
}

fn sources(logs: &[Recording<'_>], axis: &Axis) -> Result<Vec<Source>, Error> {
    logs.iter().map(|log| log.source(axis)).collect()
}
