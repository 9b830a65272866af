//! The steps in which the position moves, and jumps that no motion explains.

use super::{Finding, Severity, count, extremes, place, short};
use crate::log::Log;
use crate::mapping::Mapping;
use stiction_codes::Code;

/// A travel of fewer steps than this says little about presliding.
const COARSE_STEPS: f64 = 50.0;
/// A jump is above this share of the range ...
const JUMP_OF_RANGE: f64 = 0.5;
/// ... and this many times the mean step of the rest.
const JUMP_OF_MEAN: f64 = 50.0;
/// Smallest differences looked at: up to this many quanta.
const SMALL: f64 = 20.5;
/// At least so many small differences, each this near a whole number of quanta (rms).
const MIN_SMALL: usize = 30;
const NEAR_WHOLE: f64 = 0.1;

/// The step of a stepped signal, in its own unit; `None` where it is continuous or says too little.
/// Samples where `skip` holds are left out.
pub(super) fn quantum(values: &[f64], skip: &[bool]) -> Option<f64> {
    let (low, high) = extremes(values)?;
    // Differences below the rounding of the numbers themselves are no steps.
    let fuzz = 8.0 * f64::EPSILON * low.abs().max(high.abs());
    let steps = || {
        let pairs = values.windows(2).zip(skip.windows(2));
        pairs
            .filter(|(_, skipped)| !skipped[0] && !skipped[1])
            .map(|(w, _)| (w[1] - w[0]).abs())
            .filter(move |d| *d > fuzz)
    };
    let smallest = steps().min_by(f64::total_cmp)?;
    let limit = SMALL * smallest;
    let mut quantum = smallest;
    for _ in 0..3 {
        let (mut kd, mut kk) = (0.0, 0.0);
        for d in steps().filter(|d| *d <= limit) {
            let k = (d / quantum).round();
            kd += k * d;
            kk += k * k;
        }
        quantum = kd / kk;
    }
    let (mut squares, mut seen) = (0.0, 0_usize);
    for d in steps().filter(|d| *d <= limit) {
        let ratio = d / quantum;
        squares += (ratio - ratio.round()) * (ratio - ratio.round());
        seen += 1;
    }
    let near = (squares / seen.max(1) as f64).sqrt() <= NEAR_WHOLE;
    (seen >= MIN_SMALL && near && quantum > 0.0).then_some(quantum)
}

/// Finds the step of the position, or takes the one that is stated.
pub(super) fn steps(log: &mut Log, mapping: &Mapping) {
    let Some(position) = &log.position else {
        return;
    };
    let Some((low, high)) = extremes(position) else {
        return;
    };
    let unit = log.motion.position().si_text();
    let range = high - low;
    log.quantum = mapping
        .resolution
        .or_else(|| quantum(position, &log.skipped()));
    let Some(step) = log.quantum else { return };
    let source = if mapping.resolution.is_some() {
        "as stated"
    } else {
        "as seen in the data"
    };
    let message = format!(
        "position moves in steps of {} {unit} ({source}); its range of {} {unit} is {} steps",
        short(step),
        short(range),
        short((range / step).round())
    );
    log.findings
        .push(Finding::new(Code::Quantisation, Severity::Note, message));
    if range > 0.0 && range / step < COARSE_STEPS {
        let message = format!(
            "the whole travel is {} steps of the position; presliding is hardly visible",
            short((range / step).round())
        );
        log.findings.push(Finding::new(
            Code::CoarsePosition,
            Severity::Warning,
            message,
        ));
    }
}

/// Finds jumps of the position and splits the record there.
pub(super) fn jumps(log: &mut Log) {
    let Some(position) = &log.position else {
        return;
    };
    let Some((low, high)) = extremes(position) else {
        return;
    };
    let bound = JUMP_OF_RANGE * (high - low);
    let steps = || {
        position
            .windows(2)
            .enumerate()
            .filter(|(i, _)| !log.gap_after(*i))
    };
    let (mut small, mut smalls) = (0.0, 0_usize);
    let mut jumps = Vec::new();
    for (index, w) in steps() {
        let size = (w[1] - w[0]).abs();
        if size > bound {
            jumps.push(index);
        } else {
            small += size;
            smalls += 1;
        }
    }
    let mean = small / smalls.max(1) as f64;
    let Some(&first) = jumps.first() else { return };
    // A record with few other samples has no usual step to compare with.
    if bound <= JUMP_OF_MEAN * mean || smalls < 20 {
        return;
    }
    let unit = log.motion.position().si_text();
    let size = (position[first + 1] - position[first]).abs();
    let message = format!(
        "position jumps {} by more than half its range, first by {} {unit} after {}; if it starts \
         again there, give that travel as wrap under [log] in axis.toml; the record is split at \
         the jumps",
        count(jumps.len(), "time"),
        short(size),
        place(log, first)
    );
    log.findings
        .push(Finding::new(Code::PositionJump, Severity::Warning, message).at(first));
    log.split(&jumps.iter().map(|jump| jump + 1).collect::<Vec<_>>());
}
