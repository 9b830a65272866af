//! A force that was logged much later than its motion is taken as it belongs.

use super::disagree;
use super::load::{Asked, Loaded};
use super::logs::paths;
use crate::error::Error;
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::{Axis, Warning, shell};
use stiction_identify::{Delay, FittedLaw, lateness};
use stiction_log::{Offset, Role};
use stiction_number::{four_digits, full};
use stiction_parameters::Quantity;

/// Lays force and motion beside each other, where no delay is given and whole records are fitted.
pub(super) fn aligned(asked: Asked, mut loaded: Loaded) -> Result<Loaded, Error> {
    let is_sought = asked.axis.terms.delay == Delay::Fitted;
    // A force of the wrong sign looks late, by half of a period.
    let is_inverted = |source: &Source| {
        let mut findings = source.log.findings.iter();
        findings.any(|finding| finding.code == Code::ForceSign)
    };
    if !is_sought
        || !asked.options.procedures.method.fits_force()
        || loaded.sources.iter().any(is_inverted)
    {
        return Ok(loaded);
    }
    let samples: Result<Vec<_>, Error> = loaded.sources.iter().map(Source::fitted).collect();
    let Some(rows) = lateness(&samples?) else {
        return Ok(loaded);
    };
    loaded.late = rows as f64 / loaded.sources[0].log.rate_hz;
    for source in loaded.sources.iter_mut().chain(&mut loaded.held_out) {
        source.log.take_force_later(rows);
    }
    Ok(loaded)
}

/// Adds to the warning of a late force the line that states the whole delay, and the command that then takes it.
pub(super) fn stated(asked: Asked, loaded: &Loaded, law: &FittedLaw, warnings: &mut [Warning]) {
    let late = warnings
        .iter_mut()
        .rev()
        .find(|w| w.code == Code::ForceLate);
    let Some(warning) = late else { return };
    let (further, row) = match (law.value(Quantity::Delay), law.terms.delay) {
        (Some(delay), _) => (delay, "The delay in the table is the whole one. "),
        (None, Delay::Given(delay)) => (delay, ""),
        (None, Delay::Fitted) => (0.0, ""),
    };
    let late = loaded.late + further;
    let line = format!("delay = \"{} ms\"", four_digits(1e3 * late));
    let logs = paths(&loaded.sources);
    let typed: Vec<String> = logs.iter().map(|log| shell::quoted(log)).collect();
    let options = disagree::options(asked);
    let (place, axis) = match asked.axis.file() {
        Some(file) => (format!("in {}", file.display()), String::new()),
        None => {
            let file = shell::axis_file(&logs[0]);
            (format!("in a new file {file}"), format!(" --axis {file}"))
        }
    };
    if let Some(added) = of_another_clock(asked.axis) {
        warning.message.push_str(&format!(
            ". {row}The force comes from another file, whose clock may be late: to say so, write offset = \"{} s\" beside its file \
             under [columns] {place}{}, then: stiction identify {}{options} --out RESULT",
            full((1e6 * (added - late)).round() / 1e6),
            match added == 0.0 {
                true => "",
                false => " in place of the offset there",
            },
            typed.join(" ")
        ));
        return;
    }
    warning.message.push_str(&format!(
        ". {row}Find out where it comes from; to state it, write {line} under [terms] {place}, \
         then: stiction identify {}{axis}{options} --out RESULT",
        typed.join(" ")
    ));
}

/// What is added to the time stamps of a force that comes from another file, s; `None` where it comes from the log.
fn of_another_clock(axis: &Axis) -> Option<f64> {
    let mut joined = axis.joined.iter().filter(|column| column.file.is_some());
    match joined
        .find(|column| column.from.role == Role::Force)?
        .from
        .offset
    {
        Offset::Given(added) => Some(added),
        // What was estimated has been laid upon the motion already.
        Offset::Estimated => None,
    }
}
