//! The study that an identification begins: its axis on motion like that of the log, without and with compensation.

use super::model::is_simulated_law;
use super::resolve::{MOST_WAY, whole};
use crate::config::machine::{FORCES, MASSES};
use crate::result::ResultFile;
use crate::symbols;
use std::f64::consts::TAU;
use stiction_log::Motion;
use stiction_number::short;
use stiction_parameters::LawKind;

/// Bandwidth of the controller, Hz: that of a usual servo axis ...
const BANDWIDTH: f64 = 30.0;
/// ... and its least ratio to the control rate, below which the delay of a period no longer counts.
const RATE_OVER_BANDWIDTH: f64 = 30.0;
/// Least bandwidth that is asked of a coarse encoder, Hz.
const SLOWEST: f64 = 1.0;
/// Largest change of the command with a count of the encoder, over the largest force of the log, dimensionless: with more the
/// command shakes between counts.
const COUNT_OVER_FORCE: f64 = 0.5;
/// Least ratio of the bandwidth to the frequency of a path, dimensionless: what is slower is tracked.
const BANDWIDTH_OVER_FREQUENCY: f64 = 20.0;
/// Least control rate of a study, Hz.
const LEAST_RATE: f64 = 10.0;
/// Most samples of a path: a study of seconds.
const MOST_SAMPLES: f64 = 2e5;
/// Cycles of a path, where it gives none.
const CYCLES: f64 = 4.0;
/// Force limit over the largest force of the log, dimensionless.
const LIMIT_OVER_FORCE: f64 = 3.0;

/// What a log shows of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// Linear or rotary.
    pub motion: Motion,
    /// Sample rate, Hz.
    pub rate: f64,
    /// Encoder step, m or rad, where it is known.
    pub step: Option<f64>,
    /// Largest force, N or N m.
    pub force: f64,
}

/// The text of a study of `model.toml` beside it; `None` where a study does not take the law, the unit of its force or a
/// mass that is not known.
pub fn template(result: &ResultFile, shown: &Shown) -> Option<String> {
    let value = |name: &str| {
        let found = result.parameters.iter().find(|p| p.name == name);
        found.map(|p| p.value).filter(|x| x.is_finite() && *x > 0.0)
    };
    let mass = value("mass")?;
    value("sigma0")?;
    let seen = result.trust.compensation.as_ref()?;
    let stroke = seen.stroke.filter(|x| *x > 0.0)?;
    let levels = ["coulomb", "coulomb_pos", "coulomb_neg"];
    let mut levels = result
        .parameters
        .iter()
        .filter(|p| levels.contains(&p.name.as_str()));
    let slides = levels.all(|p| p.value > 0.0);
    let unit_fits = result.axis.force_unit == symbols::force_unit(shown.motion);
    let moves = seen.top_speed > 0.0 && shown.force > 0.0 && shown.rate >= LEAST_RATE;
    // With a unit that is wrong by many powers of ten the study would be refused.
    let is_credible = MASSES.contains(&mass) && FORCES.contains(&(LIMIT_OVER_FORCE * shown.force));
    let law = LawKind::from_name(&result.law).filter(|law| is_simulated_law(*law))?;
    if !unit_fits || !slides || !moves || !is_credible {
        return None;
    }
    // A count in a sample is a speed, and the speed gain is the mass times the bandwidth.
    let quiet = shown.step.map_or(f64::INFINITY, |step| {
        COUNT_OVER_FORCE * shown.force / (TAU * mass * step * shown.rate)
    });
    let bandwidth = BANDWIDTH
        .min(shown.rate / RATE_OVER_BANDWIDTH)
        .min(quiet.max(SLOWEST));
    // A sine of the stroke that reaches the top speed; where that is too fast for the controller or too slow to wait for, one of
    // the same speed with another stroke.
    let mut frequency = seen.top_speed / (TAU * 0.5 * stroke);
    frequency = frequency.min(bandwidth / BANDWIDTH_OVER_FREQUENCY);
    while CYCLES / frequency * shown.rate > MOST_SAMPLES {
        frequency *= 2.0;
    }
    let amplitude = seen.top_speed / (TAU * frequency);
    if 2.0 * amplitude > MOST_WAY {
        return None;
    }
    let (length, force) = (
        symbols::length_unit(shown.motion),
        symbols::force_unit(shown.motion),
    );
    let encoder = shown.step.map_or(String::new(), |step| {
        format!(
            "encoder = \"{} {length}\"    # as the log shows it\n",
            short(step)
        )
    });
    let path = |name: &str, part: f64| {
        format!(
            "\n[[path]]\nname      = \"{name}\"\nkind      = \"sine\"\namplitude = \"{} {length}\"\nfrequency = \"{} Hz\"\n",
            short(part * amplitude),
            short(frequency),
        )
    };
    Some(format!(
        "# What compensation does on this axis, simulated:\n#\n#     stiction simulate study.toml --out study\n#\n\
         # Every key: docs/study.md. Rate, stroke and top speed are those of the log. Put in the bandwidth of your controller and\n\
         # the motion that matters.\n\n\
         [axis]\nmodel   = \"model.toml\"\nrate    = \"{} Hz\"\n{encoder}{}{}\n\
         [[controller]]\nkind        = \"cascade\"\nbandwidth   = \"{} Hz\"\nforce_limit = \"{} {force}\"\n\n\
         [[compensator]]\nkind = \"coulomb\"\n\n[[compensator]]\nkind = \"{}\"\n",
        short(shown.rate),
        path("as fast as in the log", 1.0),
        path("a tenth of that", 0.1),
        short(bandwidth),
        short(LIMIT_OVER_FORCE * shown.force),
        whole(law)
    ))
}
