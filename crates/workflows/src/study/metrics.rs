//! What is measured of a run; what it means is in `docs/study.md`.

use super::changing::LoadCourse;
use stiction_files::study::{Job, Study};
use stiction_servo::axis::Sample;
use stiction_servo::metrics::{Crawl, Feed, Hunting, Tracking, share_at_limit, standing_error};

/// Of a path, in the order in which a run gives them.
const PATH: [&str; 17] = [
    "rms_error",
    "peak_error",
    "reversal_peak",
    "command_change",
    "stick_time",
    "saturation",
    "velocity_ripple",
    "rest_share",
    "feed_error_rms",
    "feed_error_peak",
    "feed_error_share",
    "standing_error",
    "hunting_amplitude",
    "hunting_period",
    "found_mass",
    "found_friction",
    "learning_time",
];

/// Of a contour, in the same order.
const CONTOUR: [&str; 12] = [
    "contour_rms",
    "contour_peak",
    "circular_deviation",
    "reversal_peak_x",
    "reversal_peak_y",
    "command_change_x",
    "command_change_y",
    "saturation_x",
    "saturation_y",
    "feed_error_rms",
    "feed_error_peak",
    "feed_error_share",
];

/// Those that not every motion has: NaN where they mean nothing.
const NOT_ALWAYS: [&str; 12] = [
    "velocity_ripple",
    "rest_share",
    "feed_error_rms",
    "feed_error_peak",
    "feed_error_share",
    "standing_error",
    "hunting_amplitude",
    "hunting_period",
    "found_mass",
    "found_friction",
    "learning_time",
    "circular_deviation",
];

/// Names of the metrics of a run.
pub(super) fn metrics(study: &Study, job: Job) -> &'static [&'static str] {
    match job.path < study.paths.len() {
        true => &PATH,
        false => &CONTOUR,
    }
}

/// Whether a run may be without this metric.
pub(super) fn may_be_absent(name: &str) -> bool {
    NOT_ALWAYS.contains(&name)
}

/// The errors of the feed rate in the order above.
pub(super) fn feed(feed: Option<Feed>) -> [f64; 3] {
    feed.map_or([f64::NAN; 3], |f| [f.rms, f.peak, f.share])
}

/// All metrics of a path; `load` is what was found of the load, where it was looked for.
pub(super) fn of_path(
    samples: &[Sample],
    largest_force: f64,
    load: Option<&LoadCourse>,
) -> Vec<f64> {
    let tracking = Tracking::of(samples);
    let crawl = Crawl::of(samples);
    let hunting = Hunting::of(samples);
    let mut metrics = vec![
        tracking.rms,
        tracking.peak,
        tracking.reversal_peak,
        tracking.command_change,
        tracking.stick_time,
        share_at_limit(samples, largest_force),
        crawl.map_or(f64::NAN, |c| c.ripple),
        crawl.map_or(f64::NAN, |c| c.rest_share),
    ];
    metrics.extend(feed(Feed::of(samples)));
    metrics.extend([
        standing_error(samples).unwrap_or(f64::NAN),
        hunting.map_or(f64::NAN, |h| h.amplitude),
        hunting.and_then(|h| h.period).unwrap_or(f64::NAN),
    ]);
    let last = |of: fn(&LoadCourse) -> &Vec<f64>| {
        let found = load.and_then(|load| of(load).last());
        found.copied().unwrap_or(f64::NAN)
    };
    metrics.extend([
        last(|l| &l.found_mass),
        last(|l| &l.found_level),
        load.and_then(|l| l.learning_time).unwrap_or(f64::NAN),
    ]);
    metrics
}
