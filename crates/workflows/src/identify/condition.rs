//! The second step: logs to the record that is fitted, and the records that are validated on.

use super::conditioning::{self, conditioned};
use super::ladder::LinearTerms;
use super::load::{Asked, Loaded, check_size, check_together};
use super::logs::paths;
use crate::error::Error;
use crate::source::{Source, load_all};
use crate::wording::{Setting, Wording};
use std::path::PathBuf;
use stiction_files::{Axis, symbols};
use stiction_identify as engine;
use stiction_identify::{Conditioning, Law, LawKind, Observer, Record, Settings, Terms};
use stiction_log::{Found, Motion};
use stiction_number::counted;

/// What is fitted, and what it is validated on.
pub(super) struct Conditioned {
    /// How every log was conditioned.
    pub conditioning: Conditioning,
    pub record: Record,
    /// Records that are not fitted.
    pub unseen: Vec<Record>,
    /// Their names.
    pub unseen_names: Vec<String>,
    /// Linear terms beside the laws.
    pub terms: LinearTerms,
    /// Speed below which a sample counts as slow, m/s or rad/s.
    pub low_speed: f64,
    /// Settings of every fit of the record.
    pub settings: Settings,
    /// How the cut-offs were chosen.
    pub note: Option<String>,
    /// Whether the same command would see the same record: the choice of the cut-offs was not stopped.
    pub repeatable: bool,
}

impl Conditioned {
    /// The linear terms beside a law.
    pub fn terms(&self, asymmetric: bool) -> &Terms {
        self.terms.beside(asymmetric)
    }
}

/// Conditions the logs, and sets aside what is not to be fitted.
pub(super) fn condition(
    asked: Asked,
    loaded: &Loaded,
    observer: &mut dyn Observer,
) -> Result<Conditioned, Error> {
    let Asked { options, axis, .. } = asked;
    let sources = &loaded.sources;
    let terms = |asymmetric| axis.terms_for(&sources[0].log, asymmetric);
    let (mut symmetric, mut asymmetric) = (terms(false)?, terms(true)?);
    let settings = settings(options.seed);
    let wanted = conditioning::wanted(sources, axis);
    let chosen = conditioning::choose(sources, &wanted, &symmetric, &settings, observer)?;
    for terms in [&mut symmetric, &mut asymmetric] {
        (terms.lag, terms.first_delay) = (chosen.lag, chosen.first_delay);
        terms.lag.variance += loaded.filter.map_or(0.0, |filter| filter.variance);
        terms.low_pass_undone = loaded.filter.is_some();
    }
    // A Maxwell-slip law depends on past motion: it is fitted from where the start no longer has an effect.
    let settle = |record: Record| match options.law.is_some_and(LawKind::has_elements) {
        true => record.settled(),
        false => record,
    };
    let full = settle(conditioned(sources, &chosen.conditioning)?);
    let (record, split) = match options.split {
        None => (full.clone(), None),
        Some(part) => {
            let (first, rest) = split(&full, part)?;
            (first, Some(rest))
        }
    };
    refuse_rest(&record, sources, loaded.motion())?;
    let low_speed = axis
        .low_speed
        .unwrap_or_else(|| engine::low_speed_bound(&full));
    let (unseen_names, unseen) = match split {
        Some(rest) => (vec!["rest of the log".to_string()], vec![rest]),
        None => {
            let one = |source: &Source| {
                conditioned(std::slice::from_ref(source), &chosen.conditioning).map(settle)
            };
            let records: Result<Vec<Record>, Error> = loaded.held_out.iter().map(one).collect();
            let names = loaded.held_out.iter().map(Source::name);
            (names.collect(), records?)
        }
    };
    let settings = Settings {
        near: chosen.near,
        ..settings
    };
    let symmetric = mapped(&symmetric, &record, &settings, observer);
    let asymmetric = Terms {
        dependences: symmetric.dependences.clone(),
        ..asymmetric.about(&record)
    };
    Ok(Conditioned {
        terms: LinearTerms {
            symmetric,
            asymmetric,
        },
        record,
        unseen,
        unseen_names,
        low_speed,
        conditioning: chosen.conditioning,
        settings,
        note: chosen.note,
        repeatable: !chosen.interrupted,
    })
}

/// Terms about a record, with as much of a map of the level as it carries beside the law that the cut-offs are chosen with.
fn mapped(
    terms: &Terms,
    record: &Record,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Terms {
    let law = Law::new(LawKind::LuGre);
    terms.about(record).mapped(record, law, settings, observer)
}

/// Settings of the engine with a seed.
pub(super) fn settings(seed: u64) -> Settings {
    Settings {
        seed,
        ..Settings::default()
    }
}

/// Logs of one axis as the fit of the symmetric LuGre law sees them, and what stands beside it.
pub(crate) fn record_of(
    logs: &[PathBuf],
    axis: &Axis,
    observer: &mut dyn Observer,
) -> Result<(Vec<Source>, Record, Terms), Error> {
    let sources = load_all(logs, axis)?;
    check_together(&sources, &[])?;
    check_size(&sources, &[])?;
    for source in &sources {
        source.check_axis(axis)?;
    }
    let terms = axis.terms_for(&sources[0].log, false)?;
    let wanted = conditioning::wanted(&sources, axis);
    let chosen = conditioning::choose(&sources, &wanted, &terms, &Settings::default(), observer)?;
    let record = conditioned(&sources, &chosen.conditioning)?;
    refuse_rest(&record, &sources, sources[0].log.motion)?;
    let terms = Terms {
        lag: chosen.lag,
        first_delay: chosen.first_delay,
        ..mapped(&terms, &record, &Settings::default(), observer)
    };
    Ok((sources, record, terms))
}

/// Refuses what is no share of the samples.
pub(crate) fn check_share(part: f64) -> Result<(), Error> {
    if part > 0.0 && part < 1.0 {
        return Ok(());
    }
    let allowed = [
        "a number between 0 and 1, such as ".into(),
        Setting::Split.is(0.5),
    ];
    Err(Error::usage(Setting::Split.is(part), allowed))
}

/// What is allowed where one part of a split has fewer than `least` samples: the share in the middle of those that leave `needed`
/// of the `usable` to fit and enough to validate on, where there are such shares.
pub(super) fn enough(least: usize, (needed, usable): (usize, usize)) -> Wording {
    let of = |samples: usize| samples as f64 / usable as f64;
    let (low, high) = (
        of(needed),
        1.0 - of(stiction_policy::conditioning::MIN_HELD_OUT_SAMPLES),
    );
    let share = (50.0 * (low + high)).round() / 100.0;
    let wanted = format!("at least {least} of the {usable} usable ones");
    match low < share && share < high {
        true => [
            format!("{wanted}, as with ").into(),
            Setting::Split.is(share),
        ]
        .into(),
        false => format!("{wanted}: this log is too short to be split").into(),
    }
}

/// The part of a record that is fitted, and the rest.
fn split(full: &Record, part: f64) -> Result<(Record, Record), Error> {
    check_share(part)?;
    let at = first_of_rest(full, part);
    let rest = full.masked(|i| i >= at);
    if rest.kept() < stiction_policy::conditioning::MIN_HELD_OUT_SAMPLES {
        return Err(Error::usage(
            [
                Setting::Split.is(part),
                format!(" leaves {} to validate on", counted(rest.kept(), "sample")).into(),
            ],
            enough(
                stiction_policy::conditioning::MIN_HELD_OUT_SAMPLES,
                (0, full.kept()),
            ),
        ));
    }
    Ok((full.masked(|i| i < at), rest))
}

/// The sample before which this part of the usable ones lies. Samples that do not count, such as the start of a record
/// whose law depends on what was before it, belong to neither part.
fn first_of_rest(full: &Record, part: f64) -> usize {
    let fitted = (part * full.kept() as f64) as usize;
    let counts = full.segments.iter().flat_map(|segment| &segment.keep);
    let mut usable = counts.enumerate().filter(|(_, counts)| **counts);
    usable.nth(fitted).map_or(full.len(), |(index, _)| index)
}

/// Refuses a log without motion, with a message in the unit of the log.
fn refuse_rest(record: &Record, sources: &[Source], motion: Motion) -> Result<(), Error> {
    let top = record.top_speed();
    let still = sources
        .iter()
        .all(|s| s.log.finds(|f| matches!(f, Found::NoMotion { .. })));
    if top > 0.0 && !still {
        return Ok(());
    }
    let source = engine::Error::NoMotion {
        bound: top,
        unit: symbols::speed_unit(motion),
    };
    Err(Error::identify(paths(sources).join(", "), source))
}
