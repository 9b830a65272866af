//! Metrics of every run, and those that are like what the paper claims beside its words.

use super::compensation::Compensation;
use super::corner::{Cornered, Turn};
use super::results::Paper;
use super::stage::Control;
use super::tracking::Tracked;
use super::units::Units;
use stiction_files::reproduce_file::{ClaimEntry, MetricEntry, RunEntry};
use stiction_servo::metrics::Feed;

/// The paper's claims in its words.
const FEED: &str = "feed error 2.8 to 2.3 m/min, 17.8 %";
const CORNER: &str = "up to 25.1 % at corners";

/// Name and unit of a metric, the claim that is like it, and its value.
type Metric<R> = (
    &'static str,
    fn(&Units) -> &'static str,
    &'static str,
    fn(&R, &Units) -> f64,
);

const SINE: [Metric<Tracked>; 4] = [
    (
        "largest error at reversals",
        |u| u.length,
        "",
        |t, _| t.position.reversal_peak,
    ),
    (
        "rms position error",
        |u| u.length,
        "",
        |t, _| t.position.rms,
    ),
    ("largest speed error", |u| u.speed, "", |t, _| peak(t.feed)),
    ("rms speed error", |u| u.speed, "", |t, _| rms(t.feed)),
];

const CORNERED: [Metric<Cornered>; 4] = [
    (
        "largest contour error",
        |u| u.length,
        CORNER,
        |c, _| c.contour.peak,
    ),
    ("rms contour error", |u| u.length, "", |c, _| c.contour.rms),
    (
        "largest feed error",
        |u| u.feed.0,
        FEED,
        |c, u| u.feed.1 * peak(c.feed),
    ),
    (
        "rms feed error",
        |u| u.feed.0,
        "",
        |c, u| u.feed.1 * rms(c.feed),
    ),
];

fn peak(feed: Option<Feed>) -> f64 {
    feed.map_or(f64::NAN, |f| f.peak)
}

fn rms(feed: Option<Feed>) -> f64 {
    feed.map_or(f64::NAN, |f| f.rms)
}

/// A run of an experiment, whichever it is.
trait Run {
    fn experiment(&self) -> &'static str;
    fn control(&self) -> Control;
    fn compensation(&self) -> Compensation;
}

impl Run for Tracked {
    fn experiment(&self) -> &'static str {
        "sine"
    }

    fn control(&self) -> Control {
        self.control
    }

    fn compensation(&self) -> Compensation {
        self.compensation
    }
}

impl Run for Cornered {
    fn experiment(&self) -> &'static str {
        match (self.turn, self.coupled) {
            (Turn::Stop, false) => "corner with a stop",
            (Turn::Stop, true) => "corner with a stop, cross-coupled",
            (Turn::Blend, false) => "corner at speed",
            (Turn::Blend, true) => "corner at speed, cross-coupled",
        }
    }

    fn control(&self) -> Control {
        self.control
    }

    fn compensation(&self) -> Compensation {
        self.compensation
    }
}

impl Paper {
    /// The metrics of every run.
    pub(super) fn runs(&self) -> Vec<RunEntry> {
        let units = self.stage.units();
        let sines = self.tracked.iter().map(|run| entry(run, &SINE, &units));
        let corners = self.cornered.iter();
        let corners = corners.map(|run| entry(run, &CORNERED, &units));
        sines.chain(corners).collect()
    }

    /// Our metrics with LuGre beside those without compensation under the same fuzzy PID, each with the paper's claim
    /// where the paper makes one. It couples its axes and contours, so its claims stand beside the coupled runs at speed.
    pub(super) fn claims(&self) -> Vec<ClaimEntry> {
        let fuzzy = |run: &dyn Run| run.control() == Control::Fuzzy;
        let sines: Vec<&Tracked> = self.tracked.iter().filter(|r| fuzzy(*r)).collect();
        let units = self.stage.units();
        let mut claims = beside(&sines, &SINE, &units);
        for turn in [Turn::Stop, Turn::Blend] {
            for coupled in [false, true] {
                let corners = self.cornered.iter();
                let corners: Vec<&Cornered> = corners
                    .filter(|r| fuzzy(*r) && r.turn == turn && r.coupled == coupled)
                    .collect();
                // A path of a machine tool goes round its corners at speed.
                let like = coupled && turn == Turn::Blend;
                let words = |(name, unit, published, of): Metric<Cornered>| {
                    (name, unit, if like { published } else { "" }, of)
                };
                claims.extend(beside(&corners, &CORNERED.map(words), &units));
            }
        }
        claims
    }
}

fn entry<R: Run>(run: &R, metrics: &[Metric<R>], units: &Units) -> RunEntry {
    RunEntry {
        experiment: run.experiment().into(),
        controller: run.control().name().into(),
        compensation: run.compensation().name().into(),
        metrics: metrics
            .iter()
            .map(|(name, unit, _, of)| MetricEntry {
                name: (*name).into(),
                unit: unit(units).into(),
                value: of(run, units),
            })
            .collect(),
    }
}

/// Each metric of the runs with LuGre beside that of the run without compensation.
fn beside<R: Run>(runs: &[&R], metrics: &[Metric<R>], units: &Units) -> Vec<ClaimEntry> {
    let is = |run: &R, of| run.compensation() == of;
    let Some(bare) = runs.iter().find(|r| is(r, Compensation::Nothing)) else {
        return Vec::new();
    };
    let mut claims = Vec::new();
    for (name, unit, published, of) in metrics {
        let without = of(bare, units);
        for fed in [Compensation::Reference, Compensation::Measured] {
            let run = runs.iter().find(|r| is(r, fed));
            claims.extend(run.map(|run| ClaimEntry {
                name: format!("{name}, {}", run.experiment()),
                unit: unit(units).into(),
                controller: run.control().name().into(),
                compensation: fed.name().into(),
                without,
                with: of(run, units),
                reduction_percent: 100.0 * (1.0 - of(run, units) / without),
                published: (*published).into(),
            }));
        }
    }
    claims
}
