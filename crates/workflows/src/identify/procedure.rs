//! The identifications that need a motion of their own, as workflows.

mod break_away;
mod curve;
mod static_map;
mod step;
mod two_step;

pub(super) use break_away::break_away;
pub(super) use two_step::{TwoStep, two_step};

use super::{Options, Outcome};
use crate::error::Error;
use crate::source::Source;
use std::path::PathBuf;
use std::time::Instant;
use stiction_files::Axis;
use stiction_files::ModelFile;
use stiction_identify as engine;
use stiction_identify::procedure::Run;
use stiction_identify::{LawKind, Observer, Samples};
use stiction_log::Motion;

/// How the parameters are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
    /// All at once, by one of the searches of `stiction_search`, then least squares.
    Searched(&'static str),
}

impl Method {
    /// All but the searches.
    pub const ALL: [Method; 5] = [
        Method::Separable,
        Method::OutputError,
        Method::Static,
        Method::StaticThenDynamic,
        Method::PreslidingStep,
    ];

    /// The method of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        let own = Self::ALL.into_iter();
        let searches = stiction_search::Method::NAMES.map(Method::Searched);
        own.chain(searches).find(|method| method.name() == name)
    }

    /// Name as typed and as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Method::Separable => "separable",
            Method::OutputError => "output-error",
            Method::Static => "static",
            Method::StaticThenDynamic => "static-then-dynamic",
            Method::PreslidingStep => "presliding-step",
            Method::Searched(name) => name,
        }
    }

    /// Whether a law is fitted to the whole record, sample by sample.
    pub(super) fn fits_records(self) -> bool {
        matches!(
            self,
            Method::Separable
                | Method::StaticThenDynamic
                | Method::OutputError
                | Method::Searched(_)
        )
    }
}

/// Refuses a law that the method is not for.
fn require(options: &Options, laws: &[LawKind], allowed: &str) -> Result<(), Error> {
    if options.law.is_some_and(|law| laws.contains(&law)) {
        return Ok(());
    }
    let law = options.law.map_or("auto", LawKind::name);
    let method = options.procedures.method.name();
    let found = format!("--law {law} beside --method {method}");
    Err(Error::usage(found, allowed))
}

/// The method, and what it takes beside the logs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Procedures {
    /// How the parameters are found.
    pub method: Method,
    /// Logs of constant velocities for the static parameters; empty takes the logs themselves.
    pub statics: Vec<PathBuf>,
    /// Model file of an earlier identification, for what is not identified here.
    pub model: Option<PathBuf>,
    /// Logs of force ramps, one break-away each.
    pub break_away: Vec<PathBuf>,
}

/// What stands beside the logs, read.
pub(super) struct Beside {
    pub statics: Vec<Source>,
    pub model: Option<ModelFile>,
    pub break_away: Vec<Source>,
}

impl Beside {
    /// Refuses a model of another kind of axis than the logs.
    pub fn check_model(&self, options: &Options, first: &Source) -> Result<(), Error> {
        let Some(model) = &self.model else {
            return Ok(());
        };
        let (kind, unit) = (first.log.motion.to_string(), &first.log.force_unit);
        if model.kind == kind && model.force_unit == *unit {
            return Ok(());
        }
        let file = options.procedures.model.clone().unwrap_or_default();
        Err(Error::usage(
            format!(
                "{} is of a {} axis with force in {}",
                file.display(),
                model.kind,
                model.force_unit
            ),
            format!("a model like the logs: {kind}, force in {unit}"),
        ))
    }

    pub fn load(options: &Options, axis: &Axis) -> Result<Self, Error> {
        let procedures = &options.procedures;
        if !procedures.statics.is_empty() && procedures.model.is_some() {
            return Err(Error::usage(
                "--static beside --model",
                "the static parameters come from one of the two",
            ));
        }
        let takes_curve = matches!(
            procedures.method,
            Method::StaticThenDynamic | Method::PreslidingStep
        );
        if procedures.model.is_some() && !takes_curve && procedures.break_away.is_empty() {
            return Err(Error::usage(
                format!("--model beside --method {}", procedures.method.name()),
                "only static-then-dynamic, presliding-step and --break-away take anything from a model",
            ));
        }
        if !procedures.statics.is_empty() && !takes_curve {
            return Err(Error::usage(
                format!("--static beside --method {}", procedures.method.name()),
                "only static-then-dynamic and presliding-step take static parameters from other logs",
            ));
        }
        if !procedures.method.fits_records()
            && (!options.validate.is_empty() || options.split.is_some())
        {
            return Err(Error::usage(
                format!(
                    "--validate or --split beside --method {}",
                    procedures.method.name()
                ),
                "validation needs a law for every sample: separable or static-then-dynamic",
            ));
        }
        let model = match &procedures.model {
            Some(file) => Some(ModelFile::read(file)?),
            None => None,
        };
        Ok(Self {
            statics: super::load_all(&procedures.statics, axis)?,
            break_away: super::load_all(&procedures.break_away, axis)?,
            model,
        })
    }
}

/// Runs a procedure that fits no record sample by sample.
pub(super) fn run(
    options: &Options,
    axis: &Axis,
    sources: Vec<Source>,
    beside: &Beside,
    clock: Instant,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    match options.procedures.method {
        Method::Static => static_map::run(options, axis, sources, beside, clock),
        _ => step::run(options, axis, sources, beside, clock, observer),
    }
}

/// Samples of every source, for runs to borrow.
fn samples(sources: &[Source]) -> Result<Vec<Samples>, Error> {
    sources.iter().map(Source::samples).collect()
}

/// A source as a procedure sees it.
fn run_of<'a>(source: &'a Source, samples: &'a Samples, axis: &Axis) -> Run<'a> {
    Run {
        samples,
        reference: source.log.reference.as_deref(),
        resolution: axis.conditioning.resolution.or(source.log.quantum),
    }
}

/// An engine's refusal with the logs it is about.
fn refused(sources: &[Source], source: engine::Error) -> Error {
    // The engine counts logs; people have their names.
    let one = match &source {
        engine::Error::NoStep { log, .. } | engine::Error::NoBreakAway { log, .. } => {
            sources.get(log - 1).map(std::slice::from_ref)
        }
        _ => None,
    };
    let named = one.unwrap_or(sources);
    Error::Identify {
        inputs: named
            .iter()
            .map(|s| s.path.display().to_string())
            .collect::<Vec<_>>()
            .join(", "),
        source,
    }
}

/// The path of a log by its number.
fn path_of(sources: &[Source], log: usize) -> String {
    sources
        .get(log)
        .map_or_else(String::new, |s| s.path.display().to_string())
}

/// A value with its unit of speed, for messages.
fn speed(value: f64, motion: Motion) -> String {
    format!(
        "{} {}",
        stiction_number::four_digits(value),
        stiction_files::symbols::speed_unit(motion)
    )
}
