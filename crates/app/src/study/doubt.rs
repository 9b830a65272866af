//! What a run shows that its figures do not: a watchdog that still learns while they count, a force at its limit, a
//! command that shakes.

use super::result::ResultRow;
use super::{Scheme, Study};
use crate::error::Warning;
use crate::report::quantity;
use stiction_codes::Code;
use stiction_servo::axis::Sample;

/// Share of the samples at the limit of the force from which on a run is warned of.
const MUCH: f64 = 0.01;
/// Rms change of the command from sample to sample, as a part of the largest force, from which on it shakes: a loop that
/// swings between the limits in 64 samples or fewer.
const SHAKES: f64 = 0.1;

/// Codes of the warnings that are made here.
pub(crate) const CODES: [Code; 3] = [
    Code::StillLearning,
    Code::AtForceLimit,
    Code::UnsteadyCommand,
];

impl Scheme {
    /// When a watchdog has learnt what is normal and the force has come in, s; infinite where the motion is too short,
    /// `None` without a watchdog.
    pub(super) fn learnt(&self, samples: &[Sample], rate: f64) -> Option<f64> {
        let Scheme::Model(model) = self else {
            return None;
        };
        let window = model.watchdog.as_ref()?.window;
        // Its windows: moving time from a turn of the reference to one of the same sense, ten times as long without turns.
        let (mut time, mut turns, mut forward) = (0.0, 0, false);
        for s in samples.iter().filter(|s| s.reference.velocity != 0.0) {
            let now = s.reference.velocity > 0.0;
            let turned = now != forward && time > 0.0;
            forward = now;
            if turned {
                turns += 1;
                if turns == 1 {
                    time = 0.0;
                }
            }
            time += 1.0 / rate;
            let whole = turned && turns >= 3 && turns % 2 == 1;
            if whole && time >= window || time >= 10.0 * window {
                return Some(s.time + model.ramp);
            }
        }
        Some(f64::INFINITY)
    }
}

/// What is to be said of the rows of a path or contour under a controller.
pub(super) fn warnings(study: &Study, rows: &[ResultRow]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for rows in rows.chunk_by(|a, b| (&a.path, &a.controller) == (&b.path, &b.controller)) {
        warnings.extend(at_limit(study, rows));
        warnings.extend(shaking(study, rows));
    }
    let mut learning: Vec<&ResultRow> = Vec::new();
    for row in rows.iter().filter(|r| r.still_learning > 0) {
        // The same under every controller and with all parameters.
        let same = |r: &&ResultRow| (&r.path, &r.compensator) == (&row.path, &row.compensator);
        if !learning.iter().any(same) {
            learning.push(row);
        }
    }
    warnings.extend(learning.iter().filter_map(|row| still_learning(study, row)));
    warnings
}

fn still_learning(study: &Study, row: &ResultRow) -> Option<Warning> {
    let compensator = study
        .compensators
        .iter()
        .find(|c| c.name == row.compensator)?;
    let Scheme::Model(model) = &compensator.it else {
        return None;
    };
    let window = model.watchdog.as_ref()?.window;
    let (duration, skip) = study.span(&row.path)?;
    Some(Warning::new(
        Code::StillLearning,
        format!(
            "{}, {}: the watchdog lets no force through until it has learnt the error without, from the first turn of \
             the motion over {} and two strokes at least; of {} what counts begins at {}. Give a longer run and a \
             skip beyond the learning, a shorter watchdog_window (a cycle of the motion), or watchdog = false",
            row.path,
            row.compensator,
            quantity(window, "s"),
            quantity(duration, "s"),
            quantity(skip, "s"),
        ),
    ))
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
    let (row, share) = worst(rows, "saturation", &|_| 1.0)?;
    (share > MUCH).then(|| {
        Warning::new(
            Code::AtForceLimit,
            format!(
                "{}, {}: with {} the command is at its limit of {} in {:.0} % of the samples: what counts is then the \
                 limit, neither the controller nor the compensation",
                row.path,
                row.controller,
                crate::report::scheme(row),
                study.limits(&row.controller),
                100.0 * share
            ),
        )
    })
}

fn shaking(study: &Study, rows: &[ResultRow]) -> Option<Warning> {
    let limits = study.force_limits(&rows.first()?.controller)?;
    let (row, share) = worst(rows, "command_change", &|axis| limits[axis])?;
    (share > SHAKES).then(|| {
        Warning::new(
            Code::UnsteadyCommand,
            format!(
                "{}, {}: with {} the command changes by {:.0} % of the largest force from sample to sample (rms): the \
                 loop is not stable, or its gains are too high for the encoder and the noise",
                row.path,
                row.controller,
                crate::report::scheme(row),
                100.0 * share
            ),
        )
    })
}

impl Study {
    /// Length of a path or contour and from when on it counts, s.
    fn span(&self, name: &str) -> Option<(f64, f64)> {
        let path = self.paths.iter().find(|p| p.name == name);
        let path = path.map(|p| (p.trajectory.duration(), p.skip));
        let contour = self.contours.iter().find(|c| c.name == name);
        path.or_else(|| contour.map(|c| (c.motion.duration(), c.skip)))
    }

    /// The largest force of either axis under a controller, N (N m); that of the first twice where there is one.
    fn force_limits(&self, controller: &str) -> Option<[f64; 2]> {
        let i = self.controllers.iter().position(|c| c.name == controller)?;
        let first = self.machine.largest_force(&self.controllers[i].it);
        let second = self
            .second
            .as_ref()
            .map(|second| second.machine.largest_force(&second.controllers[i]));
        Some([first, second.unwrap_or(first)])
    }

    /// The same in words.
    fn limits(&self, controller: &str) -> String {
        let unit = crate::symbols::force_unit(self.machine.motion);
        match self.force_limits(controller) {
            Some([x, y]) if x != y => {
                format!("{} (x) and {} (y)", quantity(x, unit), quantity(y, unit))
            }
            Some([x, _]) => quantity(x, unit),
            None => "the largest force".into(),
        }
    }
}
