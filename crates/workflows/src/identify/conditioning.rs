//! Logs to records: cut-offs chosen once, the same for every log of the axis.

use super::logs::refused;
use crate::error::Error;
use crate::source::Source;
use stiction_files::Axis;
use stiction_identify as engine;
use stiction_identify::{
    Conditioning, Cutoff, FirstDelay, Lag, Law, LawKind, Mass, Observer, Record, Settings, Terms,
    Tuned,
};

/// Conditions logs together as the axis asks; the encoder step of the log is used where the axis
/// states none.
pub(super) fn conditioned(
    sources: &[Source],
    conditioning: &Conditioning,
) -> Result<Record, Error> {
    let samples = sources
        .iter()
        .map(Source::fitted)
        .collect::<Result<Vec<_>, _>>()?;
    engine::condition(&samples, conditioning).map_err(|source| refused(sources, source))
}

/// What the axis file asks, with the encoder step of the logs.
pub(super) fn wanted(sources: &[Source], axis: &Axis) -> Conditioning {
    let mut conditioning = axis.conditioning;
    if conditioning.resolution.is_none() {
        let steps = sources.iter().filter_map(|s| s.log.quantum);
        conditioning.resolution = steps.reduce(f64::min);
    }
    conditioning
}

/// The conditioning of a fit.
pub(super) struct Chosen {
    pub conditioning: Conditioning,
    /// The lag of the force, for every fit of these logs.
    pub lag: Lag,
    /// The delay of the force in the first fit of the choice, for every fit too.
    pub first_delay: Option<FirstDelay>,
    /// Where its last fit ended.
    pub near: Option<(Law, Vec<f64>)>,
    /// How it was chosen.
    pub note: Option<String>,
    /// Whether the choice was stopped; the conditioning is then the default one.
    pub interrupted: bool,
}

impl Chosen {
    fn stated(conditioning: Conditioning) -> Self {
        Self {
            conditioning,
            lag: Lag::NONE,
            first_delay: None,
            near: None,
            note: None,
            interrupted: false,
        }
    }
}

/// Chooses the cut-offs that the axis file leaves open, and says how.
///
/// The choice is made with LuGre, the same in both directions and with `terms` beside it, whatever law is asked for: it
/// is the law whose parameters a wrong filter biases, and all laws that are compared must see the same record.
pub(super) fn choose(
    sources: &[Source],
    wanted: &Conditioning,
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Chosen, Error> {
    let samples = sources
        .iter()
        .map(Source::fitted)
        .collect::<Result<Vec<_>, _>>()?;
    let law = Law::new(LawKind::LuGre);
    let plain = Terms {
        quadratic_viscous: false,
        ..terms.clone()
    };
    // What cannot be fitted at all is reported by the fit itself.
    let as_stated = terms.mass == Mass::Absent || wanted.min_speed > 0.0;
    let choice = if as_stated {
        engine::settle
    } else {
        engine::tune
    };
    let Ok(tuned) = choice(&samples, wanted, law, &plain, settings, observer) else {
        return Ok(Chosen::stated(*wanted));
    };
    let note = match tuned.interrupted {
        true if as_stated => None,
        true => Some(
            "cut-offs not chosen: the run was stopped before; these follow from the sample rate"
                .into(),
        ),
        false => note(&tuned),
    };
    let lag = (tuned.lag.square > 0.0).then(|| lag_note(&tuned.lag));
    Ok(Chosen {
        conditioning: tuned.conditioning,
        lag: tuned.lag,
        first_delay: tuned.first_delay,
        near: tuned.near,
        note: match (note, lag) {
            (Some(note), Some(lag)) => Some(format!("{note}; {lag}")),
            (note, lag) => note.or(lag),
        },
        interrupted: tuned.interrupted,
    })
}

fn note(tuned: &Tuned) -> Option<String> {
    let hertz = |cutoff| match cutoff {
        Cutoff::Hz(f) => Some(f),
        Cutoff::Auto | Cutoff::Off => None,
    };
    let used = tuned.trials.iter().find(|trial| {
        hertz(tuned.conditioning.source_cutoff) == Some(trial.source_hz)
            && hertz(tuned.conditioning.common_cutoff) == Some(trial.common_hz)
    })?;
    let highest = tuned.trials.iter().map(|t| t.source_hz).fold(0.0, f64::max);
    let lowest = tuned.trials.iter().map(|t| t.source_hz);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    Some(format!(
        "cut-offs chosen among {} pairs, {} to {} Hz on the position, on simulated logs of the fitted axis with this \
         encoder and noise: parameters off by {} (rms) there",
        tuned.trials.len(),
        hertz_of(lowest),
        hertz_of(highest),
        stiction_number::Percent::error(100.0 * used.error).decimals(2)
    ))
}

/// A frequency in whole Hz, where that leaves it two digits.
fn hertz_of(frequency: f64) -> String {
    match frequency < 10.0 {
        true => stiction_number::short(frequency),
        false => format!("{frequency:.0}"),
    }
}

fn lag_note(lag: &Lag) -> String {
    format!(
        "{} ms of the delay of the force are taken for a lag, as of a current loop; what is open of that counts in the \
         intervals",
        stiction_number::four_digits(1e3 * lag.time())
    )
}
