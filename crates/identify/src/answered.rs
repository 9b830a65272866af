//! Records of a controller that answers the counts of its encoder, for tests of what finds the answer.

use crate::conditioning::record::{Record, Samples};
use crate::conditioning::{Conditioning, condition};
use crate::reaction::Logging;
use stiction_servo::encoder::Encoder;
use stiction_servo::noise::Noise;

const STEP: f64 = 2.5e-4;
/// A difference of positions times 3 kN s/m, and 100 kN/m.
pub const ANSWER: [f64; 2] = [-1.21e7, 1.2e7];
/// Standard deviation of the noise of the force, N.
pub const NOISE: f64 = 0.5;

/// A record of a controller that answers its readings, and the force that the axis got.
pub fn record(answers: bool, late: f64) -> (Record, Vec<f64>) {
    read(answers, late, 100e-9, 5)
}

/// The same with an encoder of this count.
pub fn read(answers: bool, late: f64, count: f64, seed: u64) -> (Record, Vec<f64>) {
    let mut noise = Noise::new(seed);
    let encoder = Encoder::new(count).unwrap();
    let t = |k: usize| k as f64 * STEP;
    let x: Vec<f64> = (0..16_000)
        .map(|k| encoder.read(2e-3 * libm::sin(9.0 * t(k)) + 1e-4 * libm::sin(31.0 * t(k))))
        .collect();
    let held: Vec<f64> = (0..x.len())
        .map(|k| {
            let reference = 40.0 * libm::sin(9.0 * t(k) + 0.3);
            let answer = ANSWER[0] * x[k] + ANSWER[1] * x[k.saturating_sub(1)];
            reference + if answers { answer } else { 0.0 }
        })
        .collect();
    let logging = Logging::new(late);
    let force = (0..x.len())
        .map(|k| logging.at(&held, k) + NOISE * noise.normal())
        .collect();
    let samples = Samples {
        time: (0..x.len()).map(t).collect(),
        position: Some(x),
        force,
        ..Samples::default()
    };
    let record = condition(&[samples], &Conditioning::default()).unwrap();
    (record, held)
}

/// A record of moves to and fro under jerk of 1437 m/s3 with a mass of 10 kg: the force of the ramps is what the reference asks
/// of it, and the controller answers the errors of its encoder alone.
pub fn moves(count: f64) -> Record {
    let mut noise = Noise::new(7);
    let encoder = Encoder::new(count).unwrap();
    let (mut x, mut v, mut a) = (0.0, 0.0, 0.0);
    let (mut position, mut force) = (Vec::new(), Vec::new());
    let mut errors = [0.0; 2];
    for k in 0..16_000 {
        // Ramps of acceleration up and down, a stretch at constant speed, and the same back; each way takes half a second.
        let jerk = match (k % 2000, k % 4000 < 2000) {
            (0..16 | 1900..1916, true) | (16..32 | 1884..1900, false) => 1437.0,
            (16..32 | 1884..1900, true) | (0..16 | 1900..1916, false) => -1437.0,
            _ => 0.0,
        };
        let read = encoder.read(x);
        errors = [read - x, errors[0]];
        position.push(read);
        let answer = ANSWER[0] * errors[0] + ANSWER[1] * errors[1];
        force.push(10.0 * a + answer + NOISE * noise.normal());
        a += STEP * jerk;
        v += STEP * a;
        x += STEP * v;
    }
    let samples = Samples {
        time: (0..position.len()).map(|k| k as f64 * STEP).collect(),
        position: Some(position),
        force,
        ..Samples::default()
    };
    condition(&[samples], &Conditioning::default()).unwrap()
}
