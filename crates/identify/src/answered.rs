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
