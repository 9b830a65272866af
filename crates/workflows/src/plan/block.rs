//! Lines of `[limits]` to paste where an axis file has none.

use super::assume::lacking;
use crate::check::Motion;
use crate::source::{self, Source};
use std::path::Path;
use stiction_files::Axis;
use stiction_identify::Mass;
use stiction_log::Motion as Kind;
use stiction_number::four_digits as short;

/// The lines of `[limits]` that an axis file lacks for a plan, each with an example or what a log of the axis shows, and what it
/// is; `None` where none is missing or the file cannot be read.
pub fn limits_to_fill_in(axis: &Path, log: Option<&Path>) -> Option<String> {
    let axis = Axis::read(axis).ok()?;
    let limits = axis.limits.as_ref();
    let has_mass =
        limits.is_some_and(|l| l.mass.is_some()) || matches!(axis.terms.mass, Mass::Given(_));
    let source = log.and_then(|log| source::load(log, &axis).ok());
    let lines = lacking(&axis, has_mass).map(|lack| {
        let key = lack.key.trim_start_matches("limits.");
        let seen = source.as_ref().and_then(|source| seen(source, key));
        let value = seen.as_deref().unwrap_or(lack.example);
        let from = match &seen {
            Some(_) => "so much the log shows; fill in",
            None => "an example; fill in",
        };
        format!("{key} = {value}    # {from} {}\n", lack.what)
    });
    let lines: String = lines.collect();
    let head = match limits {
        Some(_) => "",
        None => "[limits]\n",
    };
    (!lines.is_empty()).then(|| format!("{head}{lines}"))
}

/// What a log shows of a limit, as it is written.
fn seen(source: &Source, key: &str) -> Option<String> {
    let log = &source.log;
    let is_rotary = log.motion == Kind::Rotary;
    match key {
        "stroke" => {
            let x = log.position.as_ref()?;
            let first = *x.first()?;
            let (unit, per) = if is_rotary {
                ("deg", 1.0_f64.to_degrees())
            } else {
                ("mm", 1e3)
            };
            let most = x.iter().map(|x| x - first).fold(0.0, f64::max);
            let least = x.iter().map(|x| x - first).fold(0.0, f64::min);
            (most > least).then(|| {
                let [least, most] = [least, most].map(|x| short(per * x));
                format!("[\"{least} {unit}\", \"{most} {unit}\"]")
            })
        }
        "speed" => {
            let top = Motion::of(log)?.top_speed;
            let unit = if is_rotary { "rad/s" } else { "m/s" };
            (top > 0.0).then(|| format!("\"{} {unit}\"", short(top)))
        }
        "rated_force" => {
            let force = log.force.as_ref()?;
            let most = force.iter().map(|f| f.abs()).fold(0.0, f64::max);
            let unit = match log.force_unit.as_str() {
                "N" => "N",
                "N*m" => "N m",
                _ => return None,
            };
            Some(format!("\"{} {unit}\"", short(most)))
        }
        _ => None,
    }
}
