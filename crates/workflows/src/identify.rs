//! The identification workflow: logs in, result, model and report out.

mod assemble;
mod choice;
mod conditioning;
mod ladder;
mod procedure;
mod relay;
mod searched;
mod simulate;
mod trust;

pub use procedure::{Method, Procedures};
pub use searched::{CostKind, Searching};

use crate::error::Error;
use crate::source::{self, Source};
use choice::Choice;
use conditioning::condition;
use ladder::Ladder;
pub use simulate::Simulated;
use std::path::PathBuf;
use std::time::Instant;
use stiction_codes::Code;
use stiction_files::Axis;
use stiction_files::Warning;
use stiction_files::result::{ResolvedAxis, ResultFile};
use stiction_identify as engine;
use stiction_identify::{
    Delay, FittedLaw, Law, LawKind, Observer, Record, Series, Settings, Status, Terms,
};
use stiction_log::{Motion, Severity};

/// What to identify, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Logs to fit together; all of one axis.
    pub logs: Vec<PathBuf>,
    /// Axis file; `None` leaves all to detection.
    pub axis: Option<PathBuf>,
    /// Family of the law; `None` lets the data choose it, and whether it is asymmetric.
    pub law: Option<LawKind>,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// Logs to validate on.
    pub validate: Vec<PathBuf>,
    /// Fit the first part of the samples (0 to 1) and validate on the rest.
    pub split: Option<f64>,
    /// Seed of the search.
    pub seed: u64,
    /// Whether simpler laws are fitted beside it and compared on held-out samples.
    pub compare_laws: bool,
    /// The method, and the logs and models that it takes beside the logs.
    pub procedures: Procedures,
    /// How far a search goes, and where it keeps its state.
    pub searching: Searching,
}

/// Fewest samples that a split may leave to validate on.
const LEAST_HELD_OUT: usize = 20;

/// Everything that came out, in memory.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What goes into `result.json`.
    pub result: ResultFile,
    /// The fitted law with its signals.
    pub estimate: FittedLaw,
    /// Signals of each validation, with its name.
    pub validation: Vec<(String, Series)>,
    /// The simulated axis, where the method simulates one.
    pub simulation: Option<Simulated>,
    /// The logs.
    pub sources: Vec<Source>,
    /// Linear or rotary.
    pub motion: Motion,
    /// Unit of the force.
    pub force_unit: String,
    /// Known values to compare with, by parameter name; empty unless the axis is simulated.
    pub truth: Vec<(String, f64)>,
}

/// Reads, conditions, fits, compares laws and validates.
///
/// # Errors
/// Where an input cannot be read or nothing can be identified from it. A fit that should not be
/// trusted is not an error: see [`ResultFile::trust`].
pub fn identify(options: &Options, observer: &mut dyn Observer) -> Result<Outcome, Error> {
    let clock = Instant::now();
    let axis = match &options.axis {
        Some(file) => Axis::read(file)?,
        None => Axis::default(),
    };
    let sources = load_all(&options.logs, &axis)?;
    let held_out = load_all(&options.validate, &axis)?;
    fit(options, &axis, sources, held_out, clock, observer)
}

/// The same for logs that are in memory already, on a clock that started with the work.
pub(crate) fn fit(
    options: &Options,
    axis: &Axis,
    sources: Vec<Source>,
    held_out: Vec<Source>,
    clock: Instant,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    if options.law.is_none() && options.asymmetric {
        return Err(Error::usage(
            "--law auto with --asymmetric",
            "leave one out: auto tries every law symmetric and asymmetric",
        ));
    }
    let beside = procedure::Beside::load(options, axis)?;
    check_together(
        &sources,
        &[held_out.as_slice(), &beside.statics, &beside.break_away].concat(),
    )?;
    beside.check_model(options, &sources[0])?;
    for source in sources.iter().chain(&held_out) {
        source.check_channels(&axis.terms)?;
    }
    let elements = options.law.is_some_and(LawKind::has_elements);
    if axis.exponent_fitted && (elements || options.procedures.method != Method::Separable) {
        return Err(Error::usage(
            "stribeck_exponent = \"fit\" with another method than separable, or a Maxwell-slip law",
            "a number; only the separable method fits it, beside laws with one curve",
        ));
    }
    searched::check(options)?;
    if !options.procedures.method.fits_records() {
        return procedure::run(options, axis, sources, &beside, clock, observer);
    }
    if options.procedures.method == Method::OutputError {
        return simulate::fit(options, axis, sources, &held_out, clock, observer);
    }
    let motion = sources[0].log.motion;
    let force_unit = sources[0].log.force_unit.clone();
    let terms = axis.terms_for(&sources[0].log, options.asymmetric)?;
    let other = axis.terms_for(&sources[0].log, !options.asymmetric)?;
    let settings = Settings {
        seed: options.seed,
        ..Settings::default()
    };
    let wanted = conditioning::wanted(&sources, axis);
    let plain = if options.asymmetric { &other } else { &terms };
    let chosen = conditioning::choose(&sources, &wanted, plain, &settings, observer)?;
    let (note, keep) = (chosen.note, !chosen.interrupted);
    let chosen = chosen.conditioning;
    // A Maxwell-slip law remembers its past: it is fitted from where the motion has wiped that out.
    let settle = |record: Record| match options.law {
        Some(law) if law.has_elements() => record.settled(),
        _ => record,
    };
    let full = settle(condition(&sources, &chosen)?);
    let (record, split) = match options.split {
        None => (full.clone(), None),
        Some(part) => {
            let at = cut(&full, part)?;
            let rest = full.masked(|i| i >= at);
            if rest.kept() < LEAST_HELD_OUT {
                return Err(Error::usage(
                    format!(
                        "--split {part} leaves {} samples to validate on",
                        rest.kept()
                    ),
                    format!(
                        "at least {LEAST_HELD_OUT} of the {} usable ones",
                        full.kept()
                    ),
                ));
            }
            (full.masked(|i| i < at), Some(rest))
        }
    };
    refuse_rest(&record, &sources, motion)?;
    let (terms, other) = (terms.about(&record), other.about(&record));
    let low_speed = axis
        .low_speed
        .unwrap_or_else(|| engine::low_speed_bound(&full));
    let settings = Settings {
        seed: options.seed,
        ..Settings::default()
    };
    let mut names = vec!["rest of the log".to_string()];
    let mut unseen: Vec<Record> = split.into_iter().collect();
    if unseen.is_empty() {
        names = paths(&held_out);
        unseen = held_out
            .iter()
            .map(|source| condition(std::slice::from_ref(source), &chosen).map(settle))
            .collect::<Result<_, _>>()?;
    }
    let [symmetric, asymmetric] = if options.asymmetric {
        [&other, &terms]
    } else {
        [&terms, &other]
    };
    let ladder = Ladder {
        record: &record,
        held_out: &unseen,
        symmetric,
        asymmetric,
        low_speed,
    };
    let mut two_step = None;
    let (mut searched, mut lost) = (None, None);
    let choice = if options.procedures.method == Method::StaticThenDynamic {
        let found = procedure::two_step(
            procedure::TwoStep {
                options,
                axis,
                sources: &sources,
                beside: &beside,
                record: &record,
                terms: [&terms, &other],
                low_speed,
                settings: &settings,
            },
            observer,
        )?;
        let estimate = found.estimate.clone();
        two_step = Some(found);
        Choice::alone(estimate)
    } else {
        let law = Law {
            kind: options.law.unwrap_or(LawKind::LuGre),
            asymmetric: options.asymmetric,
            exponent: axis.stribeck_exponent,
            exponent_fitted: axis.exponent_fitted,
            elements: axis.gms_elements.unwrap_or(0),
        };
        let choice = match options.law {
            Some(_) if matches!(options.procedures.method, Method::Searched(_)) => {
                let found = searched::search(
                    searched::Task {
                        options,
                        inputs: &sources,
                        record: &record,
                        law,
                        terms: &terms,
                        low_speed,
                        settings: &settings,
                        clock,
                        keep,
                    },
                    observer,
                )?;
                searched = Some(found.entry);
                lost = found.lost;
                let compare = options.compare_laws;
                let fitted = (found.estimate, found.optimum);
                Ok(choice::fitted_already(
                    fitted, &ladder, compare, &settings, observer,
                ))
            }
            Some(_) => choice::asked(law, &ladder, options.compare_laws, &settings, observer),
            None => choice::auto(law, &ladder, &settings, observer),
        };
        choice.map_err(|source| Error::Identify {
            inputs: paths(&sources).join(", "),
            source,
        })?
    };
    let compare_laws = options.compare_laws && two_step.is_none();
    let Choice { estimate, laws, by } = choice;
    let validation: Vec<(String, Series)> = names
        .into_iter()
        .zip(&unseen)
        .map(|(name, record)| (name, engine::predict(record, &estimate)))
        .collect();
    let mut warnings = log_warnings(&sources);
    if axis.terms.delay == Delay::Fitted && estimate.terms.delay == Delay::NONE {
        let text = "the delay between force and motion would be more than four samples, which is \
                    something else that the law does not explain; it is taken as none";
        warnings.push(Warning::new(Code::DelayOutOfRange, text));
    }
    if let Some(error) = lost {
        let text = format!("the state of the search could not be kept: {error}");
        warnings.push(Warning::new(Code::BadCheckpoint, text));
    }
    if laws.is_empty() && compare_laws && estimate.status != Status::Interrupted {
        let text = "the comparison of laws was interrupted and is left out; the fit is complete";
        warnings.push(Warning::new(Code::Interrupted, text));
    }
    let mut trust = trust::judge(
        &estimate,
        record.moves_both_ways(),
        &sources,
        &laws,
        motion,
        &mut warnings,
    );
    let lost = |p: &stiction_identify::Parameter| !p.identifiable;
    if two_step.is_some() && estimate.parameter("sigma0").is_some_and(lost) {
        trust.trustworthy = false;
        let text = "sigma0 is not determined, and it is what the second step is for";
        trust.reasons.push(text.into());
    }
    let resolved = ResolvedAxis {
        name: axis.name.clone(),
        kind: motion.to_string(),
        force_unit: force_unit.clone(),
        columns: sources[0].log.detected.clone(),
        conditioning: record
            .notes
            .iter()
            .cloned()
            .chain(note)
            .chain(assemble::correction_note(&estimate))
            .chain(assemble::delay_note(&estimate))
            .collect(),
        terms: assemble::term_names(&estimate, motion),
    };
    let break_away = procedure::break_away(&beside, &estimate, motion)?;
    let mut result = assemble::result(assemble::Parts {
        options,
        sources: &sources,
        axis: resolved,
        motion,
        force_unit: &force_unit,
        estimate: &estimate,
        validation: &validation,
        laws,
        law_chosen_by: by,
        trust,
        warnings,
        wall_s: clock.elapsed().as_secs_f64(),
    });
    result.break_away = break_away;
    result.searched = searched;
    if let Some(found) = two_step {
        found.into_result(&mut result, motion);
    }
    Ok(Outcome {
        result,
        estimate: estimate.into(),
        validation,
        simulation: None,
        sources,
        motion,
        force_unit,
        truth: Vec::new(),
    })
}

/// Logs of one axis as the fit of the symmetric LuGre law sees them, and what stands beside it.
pub(crate) fn record_of(
    logs: &[PathBuf],
    axis: &Axis,
    observer: &mut dyn Observer,
) -> Result<(Vec<Source>, Record, Terms), Error> {
    let sources = load_all(logs, axis)?;
    check_together(&sources, &[])?;
    for source in &sources {
        source.check_channels(&axis.terms)?;
    }
    let terms = axis.terms_for(&sources[0].log, false)?;
    let wanted = conditioning::wanted(&sources, axis);
    let settings = Settings::default();
    let chosen = conditioning::choose(&sources, &wanted, &terms, &settings, observer)?;
    let record = condition(&sources, &chosen.conditioning)?;
    refuse_rest(&record, &sources, sources[0].log.motion)?;
    let terms = terms.about(&record);
    Ok((sources, record, terms))
}

fn load_all(paths: &[PathBuf], axis: &Axis) -> Result<Vec<Source>, Error> {
    paths.iter().map(|path| source::load(path, axis)).collect()
}

/// All logs must be of one kind of axis, with force in one unit, and no log may count twice.
fn check_together(sources: &[Source], held_out: &[Source]) -> Result<(), Error> {
    let Some(first) = sources.first() else {
        return Err(Error::usage("no log given", "name at least one log file"));
    };
    let all: Vec<&Source> = sources.iter().chain(held_out).collect();
    for (i, log) in all.iter().enumerate() {
        if let Some(twin) = all[..i].iter().find(|other| other.sha256 == log.sha256) {
            return Err(Error::usage(
                format!(
                    "{} and {} are the same log",
                    twin.path.display(),
                    log.path.display()
                ),
                "give each log once, and validate on logs that are not fitted",
            ));
        }
    }
    for other in sources.iter().chain(held_out).skip(1) {
        if other.log.motion != first.log.motion || other.log.force_unit != first.log.force_unit {
            return Err(Error::usage(
                format!(
                    "{} is {} with force in {}, {} is {} with force in {}",
                    first.path.display(),
                    first.log.motion,
                    first.log.force_unit,
                    other.path.display(),
                    other.log.motion,
                    other.log.force_unit
                ),
                "logs that are fitted or validated together must be of one axis",
            ));
        }
    }
    Ok(())
}

/// Index of the first sample of the regression that is held out.
fn cut(record: &Record, part: f64) -> Result<usize, Error> {
    if !(part > 0.0 && part < 1.0) {
        return Err(Error::usage(
            format!("--split {part}"),
            "a number between 0 and 1, such as 0.5",
        ));
    }
    Ok((part * record.len() as f64) as usize)
}

/// Refuses a log without motion, in the words of its own unit.
fn refuse_rest(record: &Record, sources: &[Source], motion: Motion) -> Result<(), Error> {
    let top = record.top_speed();
    let still = sources
        .iter()
        .all(|s| s.log.findings.iter().any(|f| f.code == Code::NoMotion));
    if top > 0.0 && !still {
        return Ok(());
    }
    Err(Error::Identify {
        inputs: sources
            .iter()
            .map(|s| s.path.display().to_string())
            .collect::<Vec<_>>()
            .join(", "),
        source: engine::Error::NoMotion {
            bound: top,
            unit: stiction_files::symbols::speed_unit(motion),
        },
    })
}

fn log_warnings(sources: &[Source]) -> Vec<Warning> {
    sources
        .iter()
        .flat_map(|s| {
            s.log
                .findings
                .iter()
                .filter(|f| f.severity == Severity::Warning)
                .map(|f| Warning::new(f.code, format!("{}: {}", s.path.display(), f.message)))
        })
        .collect()
}

fn paths(sources: &[Source]) -> Vec<String> {
    sources
        .iter()
        .map(|s| s.path.display().to_string())
        .collect()
}
