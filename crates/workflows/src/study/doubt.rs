//! What a run shows that its figures do not: a force at its limit, a command that shakes, a load that nothing was learnt of.

use super::machine::largest_force;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::study::Study;
use stiction_files::study::result::ResultRow;
use stiction_number::Percent;
use stiction_number::quantity;
use stiction_policy::simulation;
use stiction_servo::load::LoadSettings;

/// Codes of the warnings that are made here.
pub const CODES: [Code; 3] = [
    Code::AtForceLimit,
    Code::UnsteadyCommand,
    Code::LoadNotLearnt,
];

/// What is to be said of the rows of a path or contour under a controller.
pub(super) fn warnings(study: &Study, rows: &[ResultRow]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for rows in rows.chunk_by(|a, b| (&a.path, &a.controller) == (&b.path, &b.controller)) {
        warnings.extend(at_limit(study, rows));
        warnings.extend(shaking(study, rows));
        warnings.extend(not_learnt(rows));
    }
    warnings
}

/// The largest of a metric over all runs of some rows, on any axis, as a part of what `of` gives for that axis.
fn worst<'r>(
    rows: &'r [ResultRow],
    stem: &str,
    of: &dyn Fn(usize) -> f64,
) -> Option<(&'r ResultRow, f64)> {
    let all = rows.iter().flat_map(|row| {
        row.metrics.iter().filter_map(move |m| {
            let axis = m.name.strip_prefix(stem)?;
            Some((row, m.largest / of(usize::from(axis == "_y"))))
        })
    });
    all.max_by(|a, b| a.1.total_cmp(&b.1))
}

fn at_limit(study: &Study, rows: &[ResultRow]) -> Option<Warning> {
    let row = rows.first()?;
    let same = |a: &ResultRow, b: &ResultRow| a.scheme() == b.scheme();
    let schemes = rows.chunk_by(same).filter_map(|rows| {
        let (row, share) = worst(rows, "saturation", &|_| 1.0)?;
        let percent = Percent::error(100.0 * share).decimals(0);
        (share > simulation::MAX_SHARE_AT_LIMIT).then(|| format!("{} ({percent})", row.scheme()))
    });
    let schemes: Vec<String> = schemes.collect();
    (!schemes.is_empty()).then(|| {
        Warning::new(
            Code::AtForceLimit,
            format!(
                "{}, {}: the command is at its limit of {} in part of the samples with {}: the result then shows the \
                 limit, not the controller or the compensation",
                row.path,
                row.controller,
                limits(study, &row.controller),
                schemes.join(", ")
            ),
        )
    })
}

fn shaking(study: &Study, rows: &[ResultRow]) -> Option<Warning> {
    let limits = force_limits(study, &rows.first()?.controller)?;
    let (row, share) = worst(rows, "command_change", &|axis| limits[axis])?;
    (share > simulation::MAX_COMMAND_CHANGE).then(|| {
        Warning::new(
            Code::UnsteadyCommand,
            format!(
                "{}, {}: with {} the command changes by {} of the largest force from sample to sample (rms): the \
                 loop is not stable, or its gains are too high for the encoder and the noise. Halve its bandwidth under \
                 [[controller]] in the study file until this is gone, or put in a finer encoder",
                row.path,
                row.controller,
                row.scheme(),
                Percent::error(100.0 * share).decimals(0)
            ),
        )
    })
}

/// A load estimate that had less than its memory to learn in.
fn not_learnt(rows: &[ResultRow]) -> Option<Warning> {
    let settings = LoadSettings::default();
    let learning = |row: &ResultRow| Some(row.metric("learning_time")?.largest);
    let row = rows
        .iter()
        .find(|row| learning(row).is_some_and(|time| time < settings.memory))?;
    let time = match learning(row)? {
        0.0 => "no time".into(),
        time => quantity(time, "s"),
    };
    Some(Warning::new(
        Code::LoadNotLearnt,
        format!(
            "{}, {}: the load estimate of {} had {time} to learn in, of {} that it takes: it learns while the \
             acceleration is above {}; what it found by then is fed forward all the same, and tells nothing of the load",
            row.path,
            row.controller,
            row.compensator,
            quantity(settings.memory, "s"),
            quantity(settings.least_acceleration, "m/s^2 (rad/s^2)"),
        ),
    ))
}

/// The largest force of each axis under a controller, N (N m); with one axis its force twice.
fn force_limits(study: &Study, controller: &str) -> Option<[f64; 2]> {
    let i = study
        .controllers
        .iter()
        .position(|c| c.name == controller)?;
    let first = largest_force(&study.machine, &study.controllers[i].value);
    let second = study
        .second
        .as_ref()
        .map(|second| largest_force(&second.machine, &second.controllers[i]));
    Some([first, second.unwrap_or(first)])
}

/// The same in words.
fn limits(study: &Study, controller: &str) -> String {
    let unit = stiction_files::symbols::force_unit(study.machine.motion);
    match force_limits(study, controller) {
        Some([x, y]) if x != y => {
            format!("{} (x) and {} (y)", quantity(x, unit), quantity(y, unit))
        }
        Some([x, _]) => quantity(x, unit),
        None => "the largest force".into(),
    }
}
