//! Rests at the ends and in between: what is left out of fits of the whole record, and what never is.

use crate::mapping_common::{column, message, noise, table};
use std::f64::consts::TAU;
use stiction_formats::Table;
use stiction_log::mapping::Rests;
use stiction_log::{Code, Log, Mapping, Severity};

/// Samples a second, Hz.
const RATE: f64 = 1000.0;
/// One encoder count, m.
const STEP: f64 = 1e-6;

/// A made recording: position in m and force in N at so many seconds.
struct Made {
    seconds: f64,
    position: Box<dyn Fn(f64) -> f64>,
    force: Box<dyn Fn(f64) -> f64>,
}

impl Made {
    /// Rest, three periods of 20 mm to and fro with friction, rest.
    fn between(before: f64, after: f64) -> Self {
        let moving = move |t: f64| (0.0..3.0).contains(&(t - before));
        let phase = move |t: f64| TAU * (t - before);
        Self {
            seconds: before + 3.0 + after,
            position: Box::new(move |t| {
                let x = 0.01 * (1.0 - phase(t).cos());
                if moving(t) { x } else { 0.0 }
            }),
            force: Box::new(move |t| {
                let f = 20.0 * phase(t).sin().signum() + 5.0 * phase(t).sin();
                if moving(t) { f } else { 7.0 }
            }),
        }
    }

    fn force(mut self, force: impl Fn(f64) -> f64 + 'static) -> Self {
        let moving = self.force;
        let held = moving(-1.0);
        self.force = Box::new(move |t| {
            if moving(t) == held {
                force(t)
            } else {
                moving(t)
            }
        });
        self
    }

    fn table(&self) -> Table {
        let time: Vec<f64> = (0..(self.seconds * RATE) as usize)
            .map(|i| i as f64 / RATE)
            .collect();
        let counts = |t: &f64| ((self.position)(*t) / STEP).round() * STEP;
        let position = time.iter().map(counts).collect();
        let force = time.iter().enumerate();
        let force = force.map(|(i, t)| (self.force)(*t) + 0.3 * noise(i));
        let force = force.collect();
        table(vec![
            column("time [s]", time),
            column("position [m]", position),
            column("force [N]", force),
        ])
    }

    fn log(&self, mapping: &Mapping) -> Log {
        Log::from_table(&self.table(), mapping).unwrap_or_else(|e| panic!("{e}"))
    }
}

/// Seconds of the record that a fit sees.
fn fitted(log: &Log) -> (f64, f64) {
    let range = log.fitted();
    (log.time[range.start], log.time[range.end - 1])
}

fn near((a, b): (f64, f64), (c, d): (f64, f64)) -> bool {
    (a - c).abs() < 0.06 && (b - d).abs() < 0.06
}

#[test]
fn rests_at_both_ends_are_left_out_but_for_what_is_beside_the_motion() {
    let log = Made::between(4.0, 6.0).log(&Mapping::default());
    assert!(near(fitted(&log), (3.5, 7.5)), "{:?}", fitted(&log));
    let told = message(&log, "rest-at-end");
    assert!(
        told.contains("rests = \"keep\"") && told.contains("0 to 3.981 s and 7.019 to 13 s"),
        "{told}"
    );
    assert_eq!(log.rests.len(), 2);
    let codes: Vec<Code> = log.excluded.iter().map(|e| e.code).collect();
    assert_eq!(codes, [Code::RestAtEnd; 2]);
    let valid = log.valid_in_motion();
    let first = log.time[valid.iter().position(|v| *v).unwrap()];
    let last = log.time[valid.iter().rposition(|v| *v).unwrap()];
    assert!(near((first, last), (3.98, 7.02)), "{first} {last}");
    // For a procedure that starts from rest they are data.
    assert!(log.valid().iter().all(|v| *v));
    assert!(!log.has_warnings());
}

#[test]
fn noise_of_the_position_is_no_motion() {
    let mut made = Made::between(4.0, 6.0).table();
    for (i, x) in made.columns[1].values.iter_mut().enumerate() {
        *x += 20.0 * STEP * noise(i + 99);
    }
    let log = Log::from_table(&made, &Mapping::default()).unwrap();
    assert!(near(fitted(&log), (3.5, 7.5)), "{:?}", fitted(&log));
}

#[test]
fn a_velocity_alone_shows_rests_too_and_slow_motion_is_none() {
    let velocity = |slow: f64| {
        let mut table = Made::between(4.0, 6.0).table();
        let x = &table.columns[1].values;
        let v: Vec<f64> = (0..x.len())
            .map(|i| {
                let (a, b) = (i.saturating_sub(5), (i + 5).min(x.len() - 1));
                let resting = table.columns[0].values[i] < 3.9;
                let slow = if resting { slow } else { 0.0 };
                slow + (x[b] - x[a]) / ((b - a) as f64 / RATE) + 2e-4 * noise(i + 99)
            })
            .collect();
        table.columns[1] = column("velocity [m/s]", v);
        Log::from_table(&table, &Mapping::default()).unwrap()
    };
    let log = velocity(0.0);
    assert!(near(fitted(&log), (3.5, 7.5)), "{:?}", fitted(&log));
    // A quarter of the noise, but it goes on for four seconds.
    let log = velocity(5e-5);
    assert!(near(fitted(&log), (0.0, 7.5)), "{:?}", fitted(&log));
}

#[test]
fn an_integrator_at_the_end_says_nothing_a_ramp_before_the_motion_does() {
    let creeps = Made::between(4.0, 6.0).force(|t| 18.0 * (-(t - 7.0).max(0.0) / 2.0).exp() - 4.0);
    assert!(near(fitted(&creeps.log(&Mapping::default())), (3.5, 7.5)));
    // A ramp to break-away over the whole rest.
    let ramp = Made::between(4.0, 0.2).force(|t| 5.0 * t);
    let log = ramp.log(&Mapping::default());
    assert!(near(fitted(&log), (0.0, 7.199)), "{:?}", fitted(&log));
    assert!(message(&log, "rest-at-end").contains("force varies"));
    // Four seconds of nothing, then the ramp.
    let late = Made::between(8.0, 0.2).force(|t| 5.0 * (t - 4.0).max(0.0));
    let (from, _) = fitted(&late.log(&Mapping::default()));
    assert!((3.0..4.0).contains(&from), "{from}");
    // Steps of force at rest at the end, to and fro.
    let steps = Made::between(0.2, 8.0).force(|t| 9.0 * (TAU * t / 2.0).sin().signum());
    let log = steps.log(&Mapping::default());
    assert!(near(fitted(&log), (0.0, 11.199)), "{:?}", fitted(&log));
}

#[test]
fn the_axis_file_has_the_last_word() {
    let made = Made::between(4.0, 6.0);
    let whole = (0.0, 12.999);
    let keep = |rests, crop| Mapping {
        rests,
        crop,
        ..Mapping::default()
    };
    let log = made.log(&keep(Some(Rests::Keep), None));
    assert!(near(fitted(&log), whole) && log.excluded.is_empty());
    assert!(message(&log, "rest-at-end").contains("Kept"));
    let log = made.log(&keep(None, Some((0.0, 20.0))));
    assert!(near(fitted(&log), whole) && log.excluded.is_empty());
    let log = made.log(&keep(Some(Rests::Cut), Some((0.0, 20.0))));
    assert!(near(fitted(&log), (3.5, 7.5)));
}

#[test]
fn rests_in_between_are_said_and_fitted() {
    let made = |dwell: f64| {
        let (first, second) = (Made::between(0.2, 0.0), Made::between(0.0, 0.2));
        let later = 3.2 + dwell;
        let (f, g) = (first.force, second.force);
        Made {
            seconds: later + 3.2,
            position: Box::new(move |t| {
                let x = if t < later {
                    &first.position
                } else {
                    &second.position
                };
                x(if t < later { t } else { t - later })
            }),
            force: Box::new(move |t| if t < later { f(t) } else { g(t - later) }),
        }
    };
    let log = made(2.0).log(&Mapping::default());
    assert!(log.excluded.is_empty());
    let told = message(&log, "rest-between");
    assert!(
        told.starts_with("1 rest between motions") && told.contains("longest 2"),
        "{told}"
    );
    assert!(!log.has_warnings());
    let log = made(7.0).log(&Mapping::default());
    let found = log.findings.iter().find(|f| f.code() == Code::RestBetween);
    assert_eq!(found.unwrap().severity, Severity::Warning);
    let log = made(0.5).log(&Mapping::default());
    assert!(log.rests.is_empty());
}

#[test]
fn slow_motion_and_presliding_are_no_rest() {
    let slow = |amplitude: f64, period: f64, seconds: f64| Made {
        seconds,
        position: Box::new(move |t| amplitude * (2.0 / TAU * (TAU * t / period).sin().asin())),
        force: Box::new(move |t| 10.0 * (TAU * t / period).cos().signum()),
    };
    // Two counts a second; three counts to each side; a sine of ten counts.
    for made in [
        slow(50.0 * STEP, 50.0, 100.0),
        slow(6.0 * STEP, 4.0, 20.0),
        slow(20.0 * STEP, 8.0, 40.0),
    ] {
        let log = made.log(&Mapping::default());
        assert!(log.rests.is_empty(), "{:?}", log.rests);
    }
    // All rest stays what it is.
    let still = Made {
        seconds: 10.0,
        position: Box::new(|t| STEP * f64::from(t > 5.0)),
        force: Box::new(|_| 1.0),
    };
    let log = still.log(&Mapping {
        resolution: Some(STEP),
        ..Mapping::default()
    });
    assert!(log.rests.is_empty() && message(&log, "no-motion").contains("does not move"));
}
