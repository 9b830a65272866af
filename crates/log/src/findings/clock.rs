//! Gaps and jitter of the time stamps, which are increasing by now.

use super::finding::{Finding, median, place};
use crate::log::coarse::Coarse;
use crate::log::{Gap, Log};
use stiction_policy::{clock, signal};
use stiction_say::Found;

/// Finds the median step, the gaps, and the stretches between the long ones.
pub(super) fn gaps(log: &mut Log) {
    let mut steps: Vec<f64> = log.time.windows(2).map(|w| w[1] - w[0]).collect();
    let Some(step) = median(&mut steps) else {
        return;
    };
    drop(steps);
    // Two ticks in place of one are no gap.
    let (step, longest) = match Coarse::of_a_part(&log.time) {
        Some((clock, _)) => (1.0 / clock.rate_hz, clock.longest_step()),
        None => (step, clock::MIN_GAP * step),
    };
    for (index, w) in log.time.windows(2).enumerate() {
        let seconds = w[1] - w[0];
        if seconds > longest {
            let missing = ((seconds / step).round() as usize).saturating_sub(1).max(1);
            log.gaps.push(Gap {
                start_index: index,
                seconds,
                missing_samples: missing,
            });
        }
    }
    let resumed = std::mem::take(&mut log.resumed);
    log.split(&resumed);
    // What was left out by choice is not missing.
    let by_choice = |g: &&Gap| resumed.binary_search(&(g.start_index + 1)).is_ok();
    let missing: Vec<Gap> = log.gaps.iter().filter(|g| !by_choice(g)).cloned().collect();
    log.resumed = resumed;
    let long: Vec<usize> = missing
        .iter()
        .filter(|g| g.missing_samples > signal::MAX_BRIDGED_SAMPLES)
        .map(|g| g.start_index + 1)
        .collect();
    log.split(&long);
    let longest = missing
        .iter()
        .max_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let Some((first, longest)) = missing.first().zip(longest) else {
        return;
    };
    let (gaps, first) = (missing.len(), first.start_index);
    let missing = missing
        .iter()
        .fold(0_usize, |sum, g| sum.saturating_add(g.missing_samples));
    let many = missing as f64 > signal::MAX_MISSING_UNWARNED * log.time.len() as f64;
    let found = Found::Gaps {
        gaps,
        missing,
        longest: longest.seconds,
        after: place(log, first),
        splits: long.len(),
    };
    let finding = Finding::graded(found, many || !long.is_empty());
    log.findings.push(finding.at(first));
}

/// How far steps other than gaps are from the median.
pub(super) fn jitter(log: &mut Log) {
    let step = 1.0 / log.rate_hz;
    let (mut squares, mut steps) = (0.0, 0_usize);
    let (mut worst, mut at) = (0.0, 0);
    let clock = Coarse::of_a_part(&log.time);
    let longest = match &clock {
        Some((clock, _)) => clock.longest_step(),
        None => clock::MIN_GAP * step,
    };
    for (index, w) in log.time.windows(2).enumerate() {
        let off = (w[1] - w[0]) - step;
        // Rows that are left out between stretches are no fault of the clock.
        if off + step > longest || log.starts_segment(index + 1) {
            continue;
        }
        squares += off * off;
        steps += 1;
        if off.abs() > worst {
            (worst, at) = (off.abs(), index);
        }
    }
    if steps == 0 {
        return;
    }
    let rms = (squares / steps as f64).sqrt();
    if rms <= clock::MAX_UNNOTED_JITTER * step {
        return;
    }
    let is_warning = rms > clock::MAX_JITTER * step;
    let finding = match clock {
        Some((clock, rows)) => {
            let found = Found::RoundedStamps {
                tick: clock.tick,
                rate: clock.rate_hz,
                line: (rows.len() == log.time.len()).then(|| clock.line()),
            };
            Finding::graded(found, is_warning)
        }
        None => {
            let found = Found::Jitter {
                step,
                rms,
                worst,
                at: place(log, at),
            };
            Finding::graded(found, is_warning).at(at)
        }
    };
    log.findings.push(finding);
}
