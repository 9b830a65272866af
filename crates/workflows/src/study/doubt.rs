//! What a run shows that its figures do not: a force at its limit, a command that shakes, a load that nothing was learnt of.

use super::machine::largest_force;
use stiction_files::Warning;
use stiction_files::study::Study;
use stiction_files::study::result::ResultRow;
use stiction_policy::simulation;
use stiction_say::{Notice, Value};
use stiction_servo::load::LoadSettings;

/// Whether a warning is one of those that are made here: some figures are misleading.
pub fn is_misleading(warning: &Warning) -> bool {
    matches!(
        warning.kind(),
        Some(Notice::AtForceLimit { .. } | Notice::Shaking { .. } | Notice::LoadNotLearnt { .. })
    )
}

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
        (share > simulation::MAX_SHARE_AT_LIMIT).then(|| (row.scheme().to_string(), share))
    });
    let each: Vec<(String, f64)> = schemes.collect();
    (!each.is_empty()).then(|| {
        let notice = Notice::AtForceLimit {
            path: row.path.clone(),
            controller: row.controller.clone(),
            limits: limits(study, &row.controller),
            each,
        };
        notice.into()
    })
}

fn shaking(study: &Study, rows: &[ResultRow]) -> Option<Warning> {
    let (row, share) = most_shaken(study, rows)?;
    let notice = Notice::Shaking {
        path: row.path.clone(),
        controller: row.controller.clone(),
        scheme: row.scheme().to_string(),
        part: share,
    };
    Some(notice.into())
}

/// The row of a controller whose command shakes most, and by which part of the largest force; `None` where none shakes.
pub(super) fn most_shaken<'r>(
    study: &Study,
    rows: &'r [ResultRow],
) -> Option<(&'r ResultRow, f64)> {
    let limits = force_limits(study, &rows.first()?.controller)?;
    let most = worst(rows, "command_change", &|axis| limits[axis]);
    most.filter(|(_, share)| *share > simulation::MAX_COMMAND_CHANGE)
}

/// A load estimate that had less than its memory to learn in.
fn not_learnt(rows: &[ResultRow]) -> Option<Warning> {
    let settings = LoadSettings::default();
    let learning = |row: &ResultRow| Some(row.metric("learning_time")?.largest);
    let row = rows
        .iter()
        .find(|row| learning(row).is_some_and(|time| time < settings.memory))?;
    let notice = Notice::LoadNotLearnt {
        path: row.path.clone(),
        controller: row.controller.clone(),
        compensator: row.compensator.clone(),
        seconds: learning(row)?,
        needed: settings.memory,
        acceleration: settings.least_acceleration,
    };
    Some(notice.into())
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

/// The same, once where both are alike.
fn limits(study: &Study, controller: &str) -> Vec<Value> {
    let unit = stiction_files::symbols::force_unit(study.machine.motion);
    let limits = force_limits(study, controller).into_iter().flatten();
    let mut limits: Vec<Value> = limits.map(|limit| Value::new(limit, unit)).collect();
    limits.dedup();
    limits
}
