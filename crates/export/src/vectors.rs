//! Inputs with the outputs that the exported code has to give, for the self-test of every target.
//!
//! The tolerances of the self-tests are here too; all are relative to the largest force, [`Vectors::scale`].

use crate::number::{Literal, short};
use crate::terms::Extra;
use crate::{Error, Model};
use stiction_friction::Real;
use stiction_friction::compensator::{Adaptation, Input, Settings, Watchdog};

/// A sample of the self-test.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row<T> {
    /// Reference velocity, m/s (rad/s).
    pub velocity: T,
    /// Tracking error, m (rad).
    pub error: T,
    /// Enable.
    pub enable: bool,
    /// Force of the drive and whether to learn from it, N (N m): where the compensator adapts.
    pub drive: Option<(T, bool)>,
    /// What else comes in, in the order of [`Extra`].
    pub extras: Vec<T>,
    /// The expected force, N (N m).
    pub force: T,
}

/// The self-test: its own settings, so that in a few samples every part of the compensator acts.
#[derive(Clone, Debug)]
pub(crate) struct Vectors<T> {
    pub settings: Settings<f64>,
    pub rows: Vec<Row<T>>,
}

/// Largest error of a self-test in double precision, relative: some thousand operations, each rounded to 1.1e-16.
pub(crate) const DOUBLE_TOLERANCE: f64 = 1e-12;
/// The same in single precision, where operations are rounded to 6e-8.
pub(crate) const SINGLE_TOLERANCE: f64 = 2e-6;

/// Tracking error without compensation in the self-test, m (rad); its size does not matter, only ratios do.
const TRACKING_ERROR: f64 = 1e-5;
/// Force of the drive over that of the law in the self-test of one that adapts.
const DRIVE_SHARE: f64 = 1.3;
/// Its largest force, over the friction at low speed.
const LARGEST_DRIVE: f64 = 10.0;

impl<T: Real> Vectors<T> {
    /// Computed with the compensator itself, in the number type of the target.
    pub(crate) fn new(model: &Model, number_type: &'static str) -> Result<Self, Error> {
        let settings = settings(model);
        let mut compensator = model.compensator::<T>(&settings, number_type)?;
        let rows = motion(model, settings.cycle_time)
            .into_iter()
            .enumerate()
            .map(|(k, (velocity, error, enable))| {
                let (velocity, error) = (T::from_f64(velocity), T::from_f64(error));
                // More friction than that of the law, at the sample before.
                let most = LARGEST_DRIVE * model.scale();
                let due = DRIVE_SHARE * compensator.state().law.force.to_f64();
                let due = due.max(-most).min(most);
                let adapts = settings.adaptation.is_some();
                let drive = adapts.then_some((T::from_f64(short(due)), enable));
                let (drive_force, learn) = drive.unwrap_or_default();
                let mut input = Input {
                    reference_velocity: velocity,
                    measured_velocity: T::ZERO,
                    tracking_error: error,
                    enable,
                    drive_force,
                    learn,
                    ..Input::default()
                };
                let extras = Extra::of(&model.terms);
                let extras = extras
                    .into_iter()
                    .map(|extra| extra.put(&mut input, T::from_f64(course(model, extra, k))));
                let extras = extras.collect();
                let force = compensator.step(input);
                Row {
                    velocity,
                    error,
                    enable,
                    drive,
                    extras,
                    force,
                }
            })
            .collect();
        Ok(Vectors { settings, rows })
    }

    /// The scale of errors, N (N m): static friction, or the largest force of the test if larger.
    pub(crate) fn scale(&self, model: &Model) -> f64 {
        let forces = self.rows.iter().map(|row| row.force.to_f64().abs());
        forces.fold(model.scale(), f64::max)
    }
}

impl Vectors<f64> {
    /// The rows as a list in Python.
    pub(crate) fn python(&self) -> String {
        let rows: Vec<String> = self
            .rows
            .iter()
            .map(|row| {
                let (v, e, f) = (row.velocity.c(), row.error.c(), row.force.c());
                let truth = |x| if x { "True" } else { "False" };
                let enable = truth(row.enable);
                let drive = row
                    .drive
                    .map(|(u, learn)| format!("{}, {}, ", u.c(), truth(learn)));
                let extras: String = row.extras.iter().map(|x| format!("{}, ", x.c())).collect();
                format!(
                    "    ({v}, {e}, {enable}, {}{extras}{f}),",
                    drive.unwrap_or_default()
                )
            })
            .collect();
        rows.join("\n")
    }

    /// The rows of a matrix in MATLAB.
    pub(crate) fn matrix(&self) -> String {
        let number = |flag| if flag { "1" } else { "0" };
        let rows: Vec<String> = self
            .rows
            .iter()
            .map(|row| {
                let (v, e, f) = (row.velocity.c(), row.error.c(), row.force.c());
                let drive = row
                    .drive
                    .map(|(u, learn)| format!("{}, {}, ", u.c(), number(learn)));
                let extras: String = row.extras.iter().map(|x| format!("{}, ", x.c())).collect();
                format!(
                    "    {v}, {e}, {}, {}{extras}{f}",
                    number(row.enable),
                    drive.unwrap_or_default()
                )
            })
            .collect();
        rows.join("\n")
    }
}

/// Limits that are reached, a ramp of five cycles, a watchdog that learns and trips within the test, an adaptation that forgets within it.
fn settings(model: &Model) -> Settings<f64> {
    let h = model.settings.cycle_time;
    let scale = model.scale();
    let limit = if scale > 0.0 {
        let levels = model
            .terms
            .levels
            .map_or(1.0, |l| l.largest(&model.terms.channels));
        let most = levels * scale + model.terms.largest_beside();
        short(1.1 * most).min(model.settings.limit)
    } else {
        model.settings.limit
    };
    Settings {
        cycle_time: h,
        gain: 0.9,
        dead_zone: short(1e-3 * speed(model)),
        limit,
        slew: short(limit / (4.0 * h)),
        ramp: short(5.0 * h),
        adaptation: model.settings.adaptation.map(|given| Adaptation {
            memory: short(20.0 * h),
            // With inertial forces like those of friction, whatever the axis: the sums then keep their digits.
            mass: if given.mass > 0.0 {
                short(0.1 * scale * h / speed(model)).clamp(1e-9, 1e9)
            } else {
                0.0
            },
            ..given
        }),
        watchdog: Some(Watchdog {
            window: short(8.0 * h),
            ratio: 1.0,
        }),
    }
}

/// What comes in beside the motion at the k-th sample: to and fro within its range and beyond.
fn course(model: &Model, extra: Extra, k: usize) -> f64 {
    // Another number of samples for each, so that they are not all at their ends at once.
    let (cycles, steps) = match extra {
        Extra::Acceleration => (14.0, 0.3),
        Extra::Position => (37.0, 0.6),
        Extra::Load => (53.0, 0.6),
        Extra::Temperature => (71.0, 0.6),
        Extra::Transmitted => (59.0, 1.2),
    };
    let wave = steps * libm::sin(2.0 * core::f64::consts::PI * k as f64 / cycles);
    short(match extra.channel(&model.terms.channels) {
        // Of either sign.
        Some(channel) if extra == Extra::Transmitted => wave * channel.range[1],
        Some(channel) => {
            let [low, high] = channel.range;
            0.5 * (low + high) + wave * (high - low)
        }
        None => wave * model.scale() / model.terms.mass,
    })
}

/// A speed at which the law changes, m/s (rad/s).
fn speed(model: &Model) -> f64 {
    let curve = model.friction.curve();
    curve.map_or(0.01, |curve| curve.positive().stribeck_velocity)
}

/// Velocity, tracking error, enable.
fn motion(model: &Model, h: f64) -> Vec<(f64, f64, bool)> {
    let v = speed(model);
    // A cycle of this speed moves the bristles by a part of their length.
    let small = match model.friction.presliding() {
        Some(length) => v.min(0.3 * length / h),
        None => 0.1 * v,
    };
    let mut rows = Vec::new();
    let mut add = |n: usize, error: f64, enable: bool, at: &dyn Fn(f64) -> f64| {
        rows.extend((0..n).map(|k| (short(at(k as f64)), error, enable)));
    };
    let sine = |k: f64, cycles: f64| libm::sin(2.0 * core::f64::consts::PI * k / cycles);
    let to_and_fro = |k: f64| {
        if libm::floor(k / 4.0) % 2.0 == 0.0 {
            v
        } else {
            -v
        }
    };
    add(2, 0.0, false, &|_| 0.0);
    // The watchdog learns over five windows of two strokes, then compensation comes in.
    add(46, TRACKING_ERROR, false, &to_and_fro);
    add(12, 0.5 * TRACKING_ERROR, true, &|_| v);
    add(35, 0.5 * TRACKING_ERROR, true, &|k| 3.0 * v * sine(k, 25.0));
    add(25, 0.5 * TRACKING_ERROR, true, &|k| small * sine(k, 12.0));
    add(5, 0.5 * TRACKING_ERROR, true, &|_| 0.0);
    add(6, 0.5 * TRACKING_ERROR, true, &|_| 50.0 * v);
    add(6, 0.5 * TRACKING_ERROR, true, &|_| -50.0 * v);
    // Inside the dead zone.
    add(4, 0.5 * TRACKING_ERROR, true, &|_| -5e-4 * v);
    add(12, TRACKING_ERROR, false, &|_| -2.0 * v);
    // A window that is not judged, although the error is larger.
    add(20, 3.0 * TRACKING_ERROR, true, &|k| 2.0 * to_and_fro(k));
    // Larger errors than without: the watchdog trips.
    add(10, 3.0 * TRACKING_ERROR, true, &|_| 0.3 * v);
    rows
}
