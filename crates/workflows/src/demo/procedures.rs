//! Logs for every procedure, of the axis of the demo.

use super::axis::{AXIS, ENCODER_COUNT, FORCE_NOISE, RATE, csv, simulate};
use crate::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stiction_files::{Kept, write_keeping};
use stiction_friction::ParamError;
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::encoder::Encoder;
use stiction_servo::known::{self, KnownAxis};
use stiction_servo::noise::Noise;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_servo::speeds::Speeds;

/// Rate of the logs of constant speeds and ramps, Hz: they are long, and nothing in them changes fast.
const SLOW_RATE: f64 = 1000.0;
/// Rates of the force ramps, N/s.
const RAMP_RATES: [f64; 3] = [5.0, 20.0, 100.0];
/// Heights of the force steps, N.
const STEP_HEIGHTS: [f64; 2] = [3.0, 9.0];
/// One count of the encoder of the steps, m.
const FINE_ENCODER_COUNT: f64 = 1e-9;
/// Rate of the logs of steps, Hz.
const STEP_RATE: f64 = 10_000.0;
/// Noise of the force where the drive applies it in open loop, N rms.
const OPEN_LOOP_FORCE_NOISE: f64 = 0.05;

/// Writes a log of constant speeds, one of motion, two force steps and three force ramps into `dir`; other files that had
/// their names are kept.
///
/// # Errors
/// When the folder cannot be written.
pub fn procedures(dir: impl AsRef<Path>, seed: u64) -> Result<(Vec<PathBuf>, Vec<Kept>), Error> {
    let dir = dir.as_ref();
    let axis = known::find(AXIS).expect("the demo axis is in the library");
    let mut logs = vec![
        ("speeds.csv".to_string(), speeds(&axis, seed)),
        ("motion.csv".into(), simulate(&axis, seed).map(|r| csv(&r))),
    ];
    for (k, height) in STEP_HEIGHTS.iter().enumerate() {
        let force = |t: f64| if t >= 0.05 { *height } else { 0.0 };
        let log = open_loop(
            &axis,
            STEP_RATE,
            0.6,
            FINE_ENCODER_COUNT,
            seed + 10 + k as u64,
            force,
        );
        logs.push((format!("step_{}.csv", k + 1), log));
    }
    for (k, rate) in RAMP_RATES.iter().enumerate() {
        let force = |t: f64| rate * (t - 0.2).max(0.0);
        let seconds = 0.2 + 35.0 / rate;
        let log = open_loop(
            &axis,
            SLOW_RATE,
            seconds,
            ENCODER_COUNT,
            seed + 20 + k as u64,
            force,
        );
        logs.push((format!("ramp_{}.csv", k + 1), log));
    }
    std::fs::create_dir_all(dir).map_err(|e| stiction_files::Error::output(dir, e.to_string()))?;
    let (mut written, mut kept) = (Vec::new(), Vec::new());
    for (name, log) in logs {
        let path = dir.join(name);
        let text = log.expect("the demo settings are valid");
        kept.extend(write_keeping(&path, text.as_bytes())?);
        written.push(path);
    }
    Ok((written, kept))
}

/// Twelve speeds each way in closed loop, from a tenth of the Stribeck velocity up.
fn speeds(axis: &KnownAxis, seed: u64) -> Result<String, ParamError> {
    let plant = Plant::new(axis.mass, axis.law)?;
    let controller = Cascade::tuned(axis.mass, 60.0, 500.0)?;
    let path = Speeds::ladder((0.5e-3, 0.3), 12, 0.1, (0.5, 8.0), 0.1)?;
    let encoder = Encoder::new(ENCODER_COUNT)?;
    let mut noise = Noise::new(seed);
    let mut out = String::from("Time [s],Reference [mm],Position [mm],Force [N]\n");
    let (mut state, mut motion) = (CascadeState::default(), Motion::default());
    let h = 1.0 / SLOW_RATE;
    for k in 0..(path.duration() * SLOW_RATE) as usize {
        let t = k as f64 * h;
        let asked = path.at(t);
        let x = encoder.read(motion.position);
        let force = controller.force(&mut state, h, asked, x);
        let logged = force + FORCE_NOISE * noise.normal();
        let _ = writeln!(
            out,
            "{t:.4},{:.6},{:.6},{logged:.4}",
            1e3 * asked.position,
            1e3 * x
        );
        for _ in 0..10 {
            motion = plant.step(motion, h / 10.0, Load::force(force)).motion;
        }
    }
    Ok(out)
}

/// What the axis does under a force alone, each value held until the next sample.
fn open_loop(
    axis: &KnownAxis,
    rate: f64,
    seconds: f64,
    count: f64,
    seed: u64,
    force: impl Fn(f64) -> f64,
) -> Result<String, ParamError> {
    let plant = Plant::new(axis.mass, axis.law)?;
    let encoder = Encoder::new(count)?;
    let mut noise = Noise::new(seed);
    let mut out = String::from("Time [s],Position [um],Force [N]\n");
    let mut motion = Motion::default();
    let h = 1.0 / rate;
    let steps = (rate.recip() * RATE * 5.0).ceil().max(4.0);
    for k in 0..(seconds * rate) as usize {
        let t = k as f64 * h;
        let u = force(t);
        let x = encoder.read(motion.position);
        let logged = u + OPEN_LOOP_FORCE_NOISE * noise.normal();
        let _ = writeln!(out, "{t:.6},{:.4},{logged:.5}", 1e6 * x);
        for _ in 0..steps as usize {
            motion = plant.step(motion, h / steps, Load::force(u)).motion;
        }
    }
    Ok(out)
}
