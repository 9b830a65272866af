//! `stiction drift`: what changed over time, from the table of a batch.

use super::{Done, Run, What, Words, Work};
use crate::refused::Refused;
use crate::units::Shown;
use serde::Deserialize;
use serde_json::{Value, json};
use stiction_files::drift_file::{Alarm, DriftFile, NoiseEntry};
use stiction_identify::{Control, Progress, Stage};
use stiction_pages::text;
use stiction_workflows::drift;
use stiction_workflows::drift::{DriftOutcome, Limit, Times};
use stiction_workflows::verdict;

/// Most courses that are drawn, and most logs of all of them.
const MOST: (usize, usize) = (24, 20_000);
/// Seconds of a day.
const DAY: f64 = 86_400.0;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    table: String,
    #[serde(default)]
    limits: Vec<String>,
    /// Whether times are the dates in the names of the logs.
    #[serde(default)]
    names: bool,
}

impl Work for Drift {
    fn what(&self) -> What<'_> {
        What {
            kind: "drift",
            about: self.table.clone(),
            out: None,
        }
    }

    fn words(&self, words: &mut Words) {
        words.word(&self.table);
        for limit in &self.limits {
            words.option("--limit", Some(limit));
        }
        words.option("--times", self.names.then_some("names"));
    }

    fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        let table = run.workspace.file(&self.table)?;
        let limits = self.limits.iter().map(|text| Limit::read(text));
        let limits = limits.collect::<Result<Vec<_>, _>>()?;
        let times = match self.names {
            true => Times::Names,
            false => Times::Table,
        };
        // The limits of what changes by itself are simulated.
        let stage = Stage::Experiments { done: 0, all: 1 };
        let goes_on = || {
            let control = run.observer.progress(&Progress::of(stage, 0.0));
            matches!(control, Control::Continue)
        };
        let Some(found) = drift::drift_while(&table, &limits, times, goes_on)? else {
            return Err(Refused::bad("stopped before anything was found"));
        };
        Ok(Done {
            verdict: Some(verdict::of_drift(&found.file)),
            json: Some(shown(&found)),
            ..Done::default()
        })
    }
}

/// What the page shows.
fn shown(found: &DriftOutcome) -> Value {
    let file = &found.file;
    let words = text::followed(file);
    let unclear = |noise: &NoiseEntry| {
        let own = (&noise.parameter, &noise.law);
        let mut all = file.unclear.iter();
        all.any(|other| (&other.parameter, &other.law) == own)
    };
    let is_clear = file.noise.iter().any(|noise| !unclear(noise));
    let mut logs = 0;
    let courses = found.shown.iter().chain(&found.quiet).take(MOST.0);
    let courses = courses.take_while(|course| {
        logs += course.followed.points.len();
        logs <= MOST.1
    });
    json!({
        "verdict": words.verdict,
        "good": is_clear && file.alarms.is_empty() && file.apart.is_empty(),
        "timed": file.timed,
        "logs": file.input.logs,
        "machines": file.machines,
        "notes": words.notes,
        "alarms": file.alarms,
        "times": words.times,
        "courses": courses.map(|course| drawn(file, course)).collect::<Value>(),
    })
}

/// The course of a parameter over the days since the first log, in the unit that is shown, with its levels.
fn drawn(file: &DriftFile, course: &drift::Shown) -> Value {
    let unit = Shown::of(&course.unit);
    let points = &course.followed.points;
    let first = points.first().map_or(0.0, |point| point.time);
    let last = points.last().map_or(0.0, |point| point.time);
    let days = |time: f64| (time - first) / DAY;
    let number = |value: f64| unit.number(value);
    let judged = &course.judged;
    let (low, high): (Vec<f64>, Vec<f64>) = judged
        .intervals()
        .map(|(low, high)| (number(low), number(high)))
        .unzip();
    let mut levels = vec![(days(first), number(judged.reference))];
    // In the order of time, as alarms are not.
    for change in &judged.changes {
        let since = points[change.since].time;
        let is_own = |alarm: &&Alarm| {
            let names = (&alarm.machine, &alarm.parameter, &alarm.law);
            let own = (&course.machine, &course.parameter, &course.law);
            names == own && alarm.limit.is_none() && alarm.since == since
        };
        let after = file.alarms.iter().find(is_own).map(|alarm| alarm.after);
        let before = levels[levels.len() - 1].1;
        levels.push((days(since), before));
        levels.push((days(since), after.map_or(before, number)));
    }
    levels.push((days(last), levels[levels.len() - 1].1));
    let (level_x, level_y): (Vec<f64>, Vec<f64>) = levels.into_iter().unzip();
    json!({
        "machine": course.machine,
        "parameter": course.parameter,
        "law": course.law,
        "unit": unit.unit,
        "x": points.iter().map(|point| days(point.time)).collect::<Vec<_>>(),
        "y": judged.corrected.iter().map(|value| number(*value)).collect::<Vec<_>>(),
        "low": low,
        "high": high,
        "levels": { "x": level_x, "y": level_y },
    })
}
