//! Logs to a law.

use crate::{Axis, Error, Fit, LawKind, Log, Observer, Procedures, Searching, Silent};
use stiction_workflows::identify as workflow;

/// What to identify, and how; change what differs from the default, which is that of the command line:
///
/// ```
/// let mut options = stiction::Options::default();
/// options.law = None; // the data choose
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// Family of the law, LuGre by default; `None` lets the data choose it, and whether it is asymmetric.
    pub law: Option<LawKind>,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// Logs to validate on.
    pub validate: Vec<Log>,
    /// Fit the first part of the samples (0 to 1) and validate on the rest.
    pub split: Option<f64>,
    /// Seed of the search; the same seed gives the same bits.
    pub seed: u64,
    /// Whether simpler laws are fitted beside it and compared on held-out samples: about doubles the time.
    pub compare_laws: bool,
    /// The method, separable least squares by default, and the files that it takes beside the logs.
    pub procedures: Procedures,
    /// How far a search goes, and where it keeps its state.
    pub searching: Searching,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            law: Some(LawKind::LuGre),
            asymmetric: false,
            validate: Vec::new(),
            split: None,
            seed: 0,
            compare_laws: true,
            procedures: Procedures::default(),
            searching: Searching::default(),
        }
    }
}

/// Identifies the friction of an axis from its logs, with intervals and a verdict.
///
/// The logs have been read with the same `axis`: it also says which terms stand beside the friction law, and how the
/// logs are filtered.
///
/// # Errors
/// Where the logs do not go together, lack a channel, or nothing can be identified from them. A result that should not be
/// trusted is not an error: see [`Fit::is_trustworthy`].
pub fn identify(logs: &[Log], axis: &Axis, options: &Options) -> Result<Fit, Error> {
    identify_observed(logs, axis, options, &mut Silent)
}

/// [`identify`], with someone who sees the progress and may stop the work; what was found by then is kept, with
/// `interrupted` as the status of the search.
///
/// # Errors
/// As [`identify`].
pub fn identify_observed(
    logs: &[Log],
    axis: &Axis,
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<Fit, Error> {
    let asked = workflow::Options {
        logs: Vec::new(),
        axis: None,
        law: options.law,
        asymmetric: options.asymmetric,
        validate: Vec::new(),
        split: options.split,
        seed: options.seed,
        compare_laws: options.compare_laws,
        procedures: options.procedures.clone(),
        searching: options.searching.clone(),
    };
    let sources = |logs: &[Log]| logs.iter().map(|log| log.source.clone()).collect();
    let (fitted, held_out) = (sources(logs), sources(&options.validate));
    let outcome = workflow::identify_logs(&asked, axis, fitted, held_out, observer)?;
    Ok(Fit { outcome })
}
