//! Nanoseconds per control step of a closed loop with friction: `cargo bench -p stiction-servo --bench axis`.
//!
//! Each sample runs 3 s of a sine of 20 mm at 1 Hz under a 10 kHz cascade, with one plant step a control step, as
//! scripts of this kind do: no encoder steps, delay or lag.

use divan::{Bencher, black_box, counter::ItemsCount};
use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
use stiction_servo::axis::{Axis, AxisSettings, Correction};
use stiction_servo::controller::Controller;
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::fuzzy::FuzzyPid;
use stiction_servo::integrator::Quick;
use stiction_servo::known;
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::Sine;
use stiction_servo::path::Reference;
use stiction_servo::pid::{Pid, PidState};
use stiction_servo::run::run_with;
use stiction_servo::trajectory::Lookahead;

const RATE: f64 = 1e4;
const STEPS: usize = 30_000;

fn main() {
    divan::main();
}

fn plain(compensated: bool, controller: Option<Controller>) -> AxisSettings {
    let axis = known::find("machine").expect("a known axis");
    let whole = axis.simulated(RATE, 30.0).expect("settings of the bench");
    let settings = Settings::bare(1.0 / RATE, 500.0);
    let compensator = Compensator::new(Friction::LuGre(axis.law), Source::Reference, settings)
        .expect("settings of the bench");
    AxisSettings {
        plant: stiction_servo::plant::Plant::new(axis.mass, axis.law).expect("a known axis"),
        drive: Drive::ideal(),
        encoder: Encoder::new(0.0).expect("settings of the bench"),
        controller: controller.unwrap_or(whole.controller),
        feedforward: Feedforward {
            compensator: compensated.then_some(compensator),
            ..Feedforward::default()
        },
        ..whole
    }
}

fn squared_error(settings: &AxisSettings) -> f64 {
    let sine = Sine::new(0.02, 1.0, 3.0).expect("a sine");
    let quick = Quick::new(1).expect("one step");
    let mut axis = Axis::new(settings.clone(), quick).expect("settings of the bench");
    let mut reference = Lookahead::new(&sine, settings.rate, settings.feedforward.preview);
    (0..STEPS).fold(0.0, |sum, _| {
        let (now, ahead) = reference.sample();
        let error = axis.step(now, ahead, Correction::default()).error();
        sum + error * error
    })
}

/// Without and with the LuGre compensator.
#[divan::bench(args = [false, true])]
fn cascade(bencher: Bencher, compensated: bool) {
    let settings = plain(compensated, None);
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench(|| squared_error(black_box(&settings)));
}

/// The whole axis: encoder, delay, current loop, preview, 10 kHz plant under 4 kHz control.
#[divan::bench]
fn everything(bencher: Bencher) {
    let axis = known::find("motor").expect("a known axis");
    let mut settings = axis.simulated(4000.0, 60.0).expect("settings of the bench");
    let safe = Settings::new(1.0 / 4000.0, 500.0);
    let compensator = Compensator::new(Friction::LuGre(axis.law), Source::Reference, safe)
        .expect("settings of the bench");
    settings.feedforward = Feedforward::compensator(compensator, 1.64);
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench(|| squared_error(black_box(&settings)));
}

/// Controllers alone: a PID and the fuzzy one.
#[divan::bench(args = [false, true])]
fn pid(bencher: Bencher, fuzzy: bool) {
    let plain = Pid::tuned(10.0, 30.0, 500.0).expect("settings of the bench");
    let rules = FuzzyPid::tuned(10.0, 30.0, 500.0, 20.0).expect("settings of the bench");
    let positions: Vec<f64> = (0..STEPS)
        .map(|k| 1e-3 * libm::sin(0.01 * k as f64))
        .collect();
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        let mut state = PidState::default();
        black_box(&positions).iter().fold(0.0, |sum, &x| {
            let r = Reference::default();
            sum + if fuzzy {
                rules.force(&mut state, 1e-4, r, x, 0.0)
            } else {
                plain.force(&mut state, 1e-4, r, x, 0.0)
            }
        })
    });
}

/// One run of a study: 3 s of a sine at 4 kHz, the whole axis, and its metrics.
#[divan::bench]
fn study_run(bencher: Bencher) {
    let axis = known::find("motor").expect("a known axis");
    let mut settings = axis.simulated(4000.0, 60.0).expect("settings of the bench");
    let safe = Settings::new(1.0 / 4000.0, 500.0);
    let compensator = Compensator::new(Friction::LuGre(axis.law), Source::Reference, safe)
        .expect("settings of the bench");
    settings.feedforward = Feedforward::compensator(compensator, 1.64);
    let sine = Sine::new(5e-3, 1.0, 3.0).expect("a sine");
    bencher.counter(ItemsCount::new(12_000_usize)).bench(|| {
        let quick = Quick::new(1).expect("one step");
        let samples = run_with(black_box(&settings), &sine, quick).expect("settings of the bench");
        Tracking::of(&samples)
    });
}
