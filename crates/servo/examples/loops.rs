//! Times closed loops with friction, for `bench/servo/compare.py`: `loops ROUNDS`.
//!
//! Prints one line a loop, its name and ns per control step on one core: of each stretch of 1000 steps the least of all
//! rounds, on average. The sine of the reference is computed in the loop; with `-shared` in the name it was sampled before,
//! as for the runs of a study. `study-run` is the least whole run of a study, metrics included. With `loops ROUNDS study` also the
//! seconds that 1000 such runs take on one thread and on two. `loops ROUNDS accuracy` prints, for more and more plant steps in
//! a control step of the first loop, ns per control step and how far the tracking error is from that with very many, rms in
//! parts of its own.

use std::hint::black_box;
use std::time::Instant;
use stiction_friction::ParamError;
use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
use stiction_servo::axis::{Axis, AxisSettings, Correction};
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::Quick;
use stiction_servo::known;
use stiction_servo::metrics::{Crawl, Feed, Hunting, Tracking, standing_error};
use stiction_servo::motion::Sine;
use stiction_servo::path::Reference;
use stiction_servo::plant::Plant;
use stiction_servo::run::{follow, follow_sampled};
use stiction_servo::sampled::Sampled;
use stiction_servo::trajectory::Lookahead;

/// Steps of a loop, and those that are timed together: shorter than what a scheduler leaves it.
const STEPS: usize = 30_000;
const STRETCH: usize = 1000;
const RUNS: usize = 1000;
/// Plant steps in a control step whose cost and accuracy are told, and those that count as exact.
const PLANT_STEPS: [u32; 6] = [1, 2, 4, 8, 16, 32];
const VERY_MANY: u32 = 512;

fn main() -> Result<(), ParamError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let rounds = arguments.first().and_then(|r| r.parse().ok()).unwrap_or(50);
    if arguments.get(1).is_some_and(|what| what == "accuracy") {
        return accuracy(rounds);
    }
    let whole = whole()?;
    for (name, settings) in [
        ("cascade", &plain(false)?),
        ("compensated", &plain(true)?),
        ("everything", &whole),
    ] {
        let (rate, preview) = (settings.rate, settings.feedforward.preview);
        let sine = Sine::new(0.02, 1.0, STEPS as f64 / rate)?;
        let computed = || {
            let mut reference = Lookahead::new(&sine, rate, preview);
            (0..STEPS).map(move |_| reference.sample())
        };
        println!("{name} {:.1}", least(settings, rounds, computed)?);
        let sampled = Sampled::new(&sine, rate)?;
        let shared = || sampled.with_preview(preview);
        println!("{name}-shared {:.1}", least(settings, rounds, shared)?);
    }
    println!("study-run {:.1}", least_run(&whole, 4 * rounds)?);
    if arguments.get(1).is_some_and(|what| what == "study") {
        for threads in [1, 2] {
            println!("study-{threads} {:.2}", study(&whole, threads)?);
        }
    }
    Ok(())
}

/// A 10 kHz cascade with one plant step a control step; no encoder steps, delay or lag.
fn plain(compensated: bool) -> Result<AxisSettings, ParamError> {
    let axis = known::find("machine").expect("a known axis");
    let whole = axis.simulated(1e4, 30.0)?;
    let settings = Settings::bare(1e-4, 500.0);
    let compensator = Compensator::new(Friction::LuGre(axis.law), Source::Reference, settings)?;
    Ok(AxisSettings {
        plant: Plant::new(axis.mass, axis.law)?,
        drive: Drive::ideal(),
        encoder: Encoder::new(0.0)?,
        feedforward: Feedforward {
            compensator: compensated.then_some(compensator),
            ..Feedforward::default()
        },
        ..whole
    })
}

/// The run of a study: 4 kHz, three plant steps, encoder, delay, current loop, preview, compensator with watchdog.
fn whole() -> Result<AxisSettings, ParamError> {
    let axis = known::find("motor").expect("a known axis");
    let settings = Settings::new(1.0 / 4000.0, 500.0);
    let compensator = Compensator::new(Friction::LuGre(axis.law), Source::Reference, settings)?;
    Ok(AxisSettings {
        feedforward: Feedforward::compensator(compensator, 1.64),
        ..axis.simulated(4000.0, 60.0)?
    })
}

fn least<R: Iterator<Item = (Reference, f64)>>(
    settings: &AxisSettings,
    rounds: usize,
    references: impl Fn() -> R,
) -> Result<f64, ParamError> {
    let mut least = [f64::INFINITY; STEPS / STRETCH];
    for _ in 0..rounds {
        let mut axis = Axis::new(settings.clone(), Quick::new(1)?)?;
        let mut references = references();
        for least in &mut least {
            let start = Instant::now();
            let stretch = references.by_ref().take(STRETCH);
            let squares = stretch.fold(0.0, |sum, (now, ahead)| {
                let error = axis.step(now, ahead, Correction::default()).error();
                sum + error * error
            });
            black_box(squares);
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    Ok(1e9 * least.iter().sum::<f64>() / STEPS as f64)
}

/// What a plant step costs and how much of the tracking error it gets right.
fn accuracy(rounds: usize) -> Result<(), ParamError> {
    let sine = Sine::new(0.02, 1.0, STEPS as f64 / 1e4)?;
    let settings = |substeps| -> Result<AxisSettings, ParamError> {
        let plain = plain(false)?;
        Ok(AxisSettings { substeps, ..plain })
    };
    let errors = |substeps| -> Result<Vec<f64>, ParamError> {
        let mut axis = Axis::new(settings(substeps)?, Quick::new(1)?)?;
        let samples = follow(&mut axis, &sine)?;
        Ok(samples.iter().map(|sample| sample.error()).collect())
    };
    let rms = |values: &[f64]| {
        let squares: f64 = values.iter().map(|x| x * x).sum();
        (squares / values.len() as f64).sqrt()
    };
    let right = errors(VERY_MANY)?;
    for substeps in PLANT_STEPS {
        let found = errors(substeps)?;
        let off: Vec<f64> = found.iter().zip(&right).map(|(a, b)| a - b).collect();
        let settings = settings(substeps)?;
        let computed = || {
            let mut reference = Lookahead::new(&sine, settings.rate, 0.0);
            (0..STEPS).map(move |_| reference.sample())
        };
        let spent = least(&settings, rounds, computed)?;
        println!("{substeps} {spent:.1} {:.2e}", rms(&off) / rms(&right));
    }
    Ok(())
}

/// The motion of all runs of a study.
fn motion_of_study(settings: &AxisSettings) -> Result<Sampled, ParamError> {
    Sampled::new(&Sine::new(5e-3, 1.0, 3.0)?, settings.rate)
}

/// A run of 3 s with its metrics, and how many samples it has.
fn run_of_study(settings: &AxisSettings, motion: &Sampled) -> Result<usize, ParamError> {
    let mut axis = Axis::new(black_box(settings).clone(), Quick::new(1)?)?;
    let samples = follow_sampled(&mut axis, motion)?;
    black_box((
        Tracking::of(&samples),
        Crawl::of(&samples),
        Feed::of(&samples),
        standing_error(&samples),
        Hunting::of(&samples),
    ));
    Ok(samples.len())
}

/// The least time of a run, ns a sample.
fn least_run(settings: &AxisSettings, rounds: usize) -> Result<f64, ParamError> {
    let motion = motion_of_study(settings)?;
    (0..rounds).try_fold(f64::INFINITY, |least, _| {
        let start = Instant::now();
        let samples = run_of_study(settings, &motion)?;
        Ok(least.min(1e9 * start.elapsed().as_secs_f64() / samples as f64))
    })
}

/// Seconds for all runs.
fn study(settings: &AxisSettings, threads: usize) -> Result<f64, ParamError> {
    let start = Instant::now();
    let motion = motion_of_study(settings)?;
    std::thread::scope(|scope| {
        let motion = &motion;
        let share =
            move || (0..RUNS / threads).try_for_each(|_| run_of_study(settings, motion).map(drop));
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(share)).collect();
        let ended = running.into_iter().map(|r| r.join().expect("no panic"));
        ended.collect::<Result<(), ParamError>>()
    })?;
    Ok(start.elapsed().as_secs_f64())
}
