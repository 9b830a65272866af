//! A measured acceleration against the derivative of the position.

use crate::common::Noise;
use std::f64::consts::TAU;
use stiction_identify::{Accelerometer, Conditioning, Cutoff, Record, Samples, condition};

const STEP: f64 = 1e-3;
const COUNT: f64 = 1e-6;

/// Position and acceleration of two sines.
fn motion(t: f64) -> (f64, f64) {
    let sines = [(0.02, 1.0), (0.001, 4.0)];
    sines.iter().fold((0.0, 0.0), |(x, a), (amplitude, hz)| {
        let w = TAU * hz;
        let value = amplitude * (w * t).sin();
        (x + value, a - w * w * value)
    })
}

/// What such a sensor shows on an axis with an encoder.
fn record(gain: f64, lag: f64, offset: f64, noise: f64) -> Record {
    let mut random = Noise::new(7);
    let time: Vec<f64> = (0..6000).map(|k| k as f64 * STEP).collect();
    let encoder = |t: &f64| COUNT * (motion(*t).0 / COUNT).round();
    let mut sensor = |t: &f64| gain * motion(t - lag).1 + offset + noise * random.normal();
    let samples = Samples {
        position: Some(time.iter().map(encoder).collect()),
        acceleration: Some(time.iter().map(&mut sensor).collect()),
        force: time.iter().map(|t| 3.0 * motion(*t).1).collect(),
        time,
        ..Samples::default()
    };
    let filters = Conditioning {
        source_cutoff: Cutoff::Hz(100.0),
        common_cutoff: Cutoff::Hz(50.0),
        ..Conditioning::default()
    };
    condition(&[samples], &filters).unwrap()
}

/// Root mean square of the error of the acceleration of a record, away from its ends.
fn error(record: &Record) -> f64 {
    let found = &record.segments[0].acceleration;
    let inner = 300..found.len() - 300;
    let count = inner.len() as f64;
    let off = inner.map(|k| found[k] - motion(k as f64 * STEP).1);
    (off.map(|e| e * e).sum::<f64>() / count).sqrt()
}

fn judged(record: &Record) -> (Record, Accelerometer) {
    record.with_accelerometer().expect("both are there")
}

#[test]
fn a_good_one_is_taken_with_gain_lag_and_offset_taken_out() {
    for (gain, lag) in [(1.0, 0.0), (1.03, 2.4e-3), (0.97, -1e-3)] {
        let before = record(gain, lag, 0.3, 0.002);
        let (after, found) = judged(&before);
        assert!(found.taken, "{found:?}");
        assert!((found.gain - gain).abs() < 2e-3, "{found:?}");
        assert!((found.lag - lag).abs() < 5e-5, "{found:?}");
        assert!((found.offset - 0.3).abs() < 5e-3, "{found:?}");
        assert!(error(&after) < 0.2 * error(&before), "{found:?}");
    }
}

/// The noise that is stated is that of the sensor and of the derivative, through the same filters.
#[test]
fn what_is_said_of_noise_is_right() {
    // White noise of half a band that is 5 % of the Nyquist frequency and steeper: between a fifth and a third is left.
    let (_, found) = judged(&record(1.0, 0.0, 0.0, 0.05));
    assert!(found.noise > 0.01 && found.noise < 0.02, "{found:?}");
    // The derivative as it is, without the sensor: the common filter takes some of it away.
    let before = record(1.0, 0.0, 0.0, 0.05);
    let raw = error(&before);
    assert!(found.derivative_noise < raw, "{found:?} {raw}");
    assert!(found.derivative_noise > 0.02 * raw, "{found:?} {raw}");
}

#[test]
fn a_bad_one_is_left_alone() {
    // Much noise; another gain; another motion.
    let noisy = record(1.0, 0.0, 0.0, 1.0);
    let scaled = record(1.2, 0.0, 0.0, 0.002);
    let mut other = record(1.0, 0.0, 0.0, 0.002);
    let sensor = &mut other.segments[0].channels.acceleration;
    sensor
        .iter_mut()
        .enumerate()
        .for_each(|(k, a)| *a = (k as f64 * 0.0371).sin());
    assert!(other.with_accelerometer().is_none());
    for before in [noisy, scaled] {
        let (after, found) = judged(&before);
        assert!(!found.taken, "{found:?}");
        assert_eq!(
            after.segments[0].acceleration,
            before.segments[0].acceleration
        );
    }
}

#[test]
fn nothing_to_compare_is_nothing() {
    let mut without = record(1.0, 0.0, 0.0, 0.0);
    without.segments[0].channels.acceleration.clear();
    assert!(without.with_accelerometer().is_none());
}
