//! `[[compensator]]`

use super::dimensions::Dimensions;
use super::entry::{MOST_SAMPLES, below_half_the_rate, name};
use crate::config::Table;
use crate::error::Error;
use crate::study::plan::{ModelKind, ModelScheme, Named, Scheme, Study};
use stiction_formats::Dimension;
use stiction_friction::compensator::{Adaptation, Settings, Source, Watchdog};
use stiction_number::short;
use stiction_parameters::LawKind;
use stiction_servo::law::AxisLaw;
use stiction_servo::learning::Learning;
use stiction_servo::trajectory::MAX_PREVIEW;

const KINDS: [&str; 9] = [
    "coulomb",
    "stribeck",
    "simplified",
    "lugre",
    "elasto-plastic",
    "maxwell-slip",
    "gms",
    "disturbance-observer",
    "learning",
];

/// The kind of a compensator with the whole law of an axis.
pub(in crate::study) fn whole(law: LawKind) -> &'static str {
    match law {
        LawKind::Dahl => LawKind::LuGre.name(),
        law => law.name(),
    }
}

/// What all others are compared with.
pub(super) fn none() -> Named<Scheme> {
    Named {
        name: "none".into(),
        value: Scheme::None,
    }
}

pub(super) fn compensator(table: &Table<'_>, study: &Study) -> Result<Named<Scheme>, Error> {
    let kind = table.choice("kind", &KINDS)?;
    let kind = table.required("kind", kind, &format!("one of {}", KINDS.join(", ")))?;
    let scheme = match kind {
        "coulomb" => Scheme::Model(model(table, study, ModelKind::Coulomb)?),
        "stribeck" => Scheme::Model(model(table, study, ModelKind::Stribeck)?),
        "simplified" => Scheme::Model(model(table, study, ModelKind::Simplified)?),
        "lugre" | "elasto-plastic" | "maxwell-slip" | "gms" => {
            let own = whole(study.machine.model.kind);
            if kind != own {
                let allowed = format!("\"{own}\", which the axis has, or a simpler one");
                return Err(table.refuse("kind", format!("\"{kind}\""), &allowed));
            }
            Scheme::Model(model(table, study, ModelKind::Whole)?)
        }
        "learning" => learning(table, study)?,
        _ => {
            let bandwidth = below_half_the_rate(table, "bandwidth", study.machine.rate)?;
            Scheme::Observer(table.required("bandwidth", bandwidth, "one such as \"60 Hz\"")?)
        }
    };
    let named = Named {
        name: name(table, kind.into())?,
        value: scheme,
    };
    table.end()?;
    Ok(named)
}

fn learning(table: &Table<'_>, study: &Study) -> Result<Scheme, Error> {
    let lead = table.not_negative("lead", Dimension::TIME)?;
    let lead = table.required(
        "lead",
        lead,
        "1/(2 pi) of the bandwidth, such as \"2.5 ms\"",
    )?;
    if lead > 1.0 {
        return Err(table.refuse("lead", format!("{lead} s"), "at most 1 s"));
    }
    let cutoff = table.positive("cutoff", Dimension::FREQUENCY)?;
    let learning = Learning {
        gain: table.number("gain", 0.0, 1.0)?.unwrap_or(0.5),
        lead: libm::round(lead * study.machine.rate) as usize,
        cutoff: table.required("cutoff", cutoff, "one such as \"250 Hz\"")?,
    };
    let passes = table.count("passes", 2, 50)?.unwrap_or(6);
    Ok(Scheme::Learning(learning, passes))
}

fn model(table: &Table<'_>, study: &Study, kind: ModelKind) -> Result<ModelScheme, Error> {
    let is = Dimensions::of(study.machine.motion);
    // The settings of a compensator to start with, where the file says nothing.
    let usual = Settings::new(1.0 / study.machine.rate, 1.0);
    let adaptation = adaptation(table)?;
    // Levels that follow need no margin.
    let gain = adaptation.map_or(usual.gain, |_| 1.0);
    let scheme = ModelScheme {
        kind,
        source: source(table, matches!(study.machine.law, AxisLaw::LuGre(_)), kind)?,
        gain: table.number("gain", 0.0, 1.0)?.unwrap_or(gain),
        dead_zone: table.not_negative("dead_zone", is.speed)?,
        limit: table.positive("limit", is.force)?,
        slew: table.positive("slew", Dimensions::per(is.force, Dimension::TIME))?,
        ramp: table
            .not_negative("ramp", Dimension::TIME)?
            .unwrap_or(usual.ramp),
        adaptation,
        watchdog: watchdog(table, study.machine.rate)?,
        inputs: inputs(table, study)?,
        load_estimate: load_estimate(table)?,
        preview: table.number("preview", 0.0, MAX_PREVIEW)?,
        observer: below_half_the_rate(table, "observer_bandwidth", study.machine.rate)?,
    };
    Ok(scheme)
}

fn watchdog(table: &Table<'_>, rate: f64) -> Result<Option<Watchdog<f64>>, Error> {
    let usual = Watchdog::default();
    let is_off = table.flag("watchdog")? == Some(false);
    let Some(window) = table.positive("watchdog_window", Dimension::TIME)? else {
        return Ok((!is_off).then_some(usual));
    };
    if is_off {
        let found = "is given beside watchdog = false".into();
        let allowed = "a window of a watchdog that is there: leave out one of both";
        return Err(table.refuse("watchdog_window", found, allowed));
    }
    // It learns over so many samples before a run.
    let longest = MOST_SAMPLES as f64 / rate;
    if window > longest {
        let allowed = format!("at most {} s, {MOST_SAMPLES} samples", short(longest));
        return Err(table.refused("watchdog_window", &allowed));
    }
    Ok(Some(Watchdog { window, ..usual }))
}

fn source(table: &Table<'_>, bristles: bool, kind: ModelKind) -> Result<Source<f64>, Error> {
    let words = ["reference", "measured", "blend", "observer"];
    match table.choice("source", &words)? {
        None | Some("reference") => Ok(Source::Reference),
        Some("measured") => Ok(Source::Measured),
        Some("blend") => {
            let share = table.number("measured_share", 0.0, 1.0)?;
            let share = table.required("measured_share", share, "a number from 0 to 1")?;
            Ok(Source::Blend(share))
        }
        Some(_) if !(bristles && matches!(kind, ModelKind::Simplified | ModelKind::Whole)) => {
            let allowed = "with kind = \"simplified\" or \"lugre\" only: the others have no bristles to observe";
            Err(table.refuse("source", "\"observer\"".into(), allowed))
        }
        Some(_) => {
            let gain = table.not_negative("observer_gain", Dimension::FREQUENCY)?;
            let gain = table.required("observer_gain", gain, "one such as \"10 1/s\"")?;
            Ok(Source::Observer(gain))
        }
    }
}

/// Whether the compensator is told what friction depends on.
fn inputs(table: &Table<'_>, study: &Study) -> Result<bool, Error> {
    let asked = table.flag("inputs")?;
    let second = study.second.iter().map(|second| &second.machine);
    let depends = std::iter::once(&study.machine)
        .chain(second)
        .any(|machine| machine.depends.is_some());
    if asked.is_some() && !depends {
        let allowed = "only with a model whose friction depends on load, temperature or position";
        return Err(table.refused("inputs", allowed));
    }
    Ok(asked.unwrap_or(true))
}

/// Whether the load is estimated; it sets the level that an adaptation would.
fn load_estimate(table: &Table<'_>) -> Result<bool, Error> {
    let asked = table.flag("load_estimate")?.unwrap_or(false);
    if asked && table.get("adaptation").is_some() {
        let allowed = "one of them: both set the level of the force";
        return Err(table.refuse("load_estimate", "stands beside adaptation".into(), allowed));
    }
    Ok(asked)
}

/// The mass is that of the axis as it is believed, which only a run knows.
fn adaptation(table: &Table<'_>) -> Result<Option<Adaptation<f64>>, Error> {
    let usual = Adaptation::default();
    let Some(given) = table.get("adaptation") else {
        return Ok(None);
    };
    let Some(table) = given.as_table() else {
        let Ok(asked) = given.flag() else {
            return Err(given
                .refused("true, false, or a table such as { memory = \"0.25 s\", range = 0.5 }"));
        };
        return Ok(asked.then_some(usual));
    };
    let adaptation = Adaptation {
        memory: table
            .positive("memory", Dimension::TIME)?
            .unwrap_or(usual.memory),
        range: table.number("range", 0.0, 1.0)?.unwrap_or(usual.range),
        ..usual
    };
    table.end()?;
    let settings = Settings {
        adaptation: Some(adaptation),
        ..Settings::new(1.0, 1.0)
    };
    settings.validate().map_err(|e| table.together(&e))?;
    Ok(Some(adaptation))
}
