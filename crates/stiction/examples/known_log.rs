//! Writes the log of a known axis for `bench/peers`: `known_log AXIS RATE FILE`.
//!
//! Three seconds along a velocity sine of ten times the Stribeck velocity and 1 Hz, as
//! `stiction compare --problem AXIS --rate RATE` makes it: the law with twenty steps to a sample, then white noise
//! of 1 % of the largest force. Prints the true parameters, a name and a value (SI) on each line.

use std::f64::consts::TAU;
use std::fmt::Write;
use stiction_servo::known;
use stiction_servo::noise::Noise;

const DURATION: f64 = 3.0;
/// Steps of the law in one sample.
const FINE: usize = 20;
const NOISE: f64 = 0.01;
const SEED: u64 = 1;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, rate, file] = &arguments[..] else {
        eprintln!("usage: known_log AXIS RATE FILE");
        std::process::exit(2);
    };
    let axis = known::find(name).expect("a known axis");
    let rate: f64 = rate.parse().expect("a rate in Hz");
    let law = axis.law;
    let side = law.curve().positive();
    let velocity = |t: f64| 10.0 * side.stribeck_velocity * libm::sin(TAU * t);
    let (step, samples) = (1.0 / rate, (DURATION * rate).round() as usize + 1);
    let h = step / FINE as f64;
    let mut z = 0.0;
    let mut rows: Vec<[f64; 3]> = Vec::with_capacity(samples);
    for i in 0..samples {
        for k in 0..if i > 0 { FINE } else { 0 } {
            let t = (i - 1) as f64 * step + k as f64 * h;
            z = law.step_record(z, h, velocity(t), velocity(t + h));
        }
        let t = i as f64 * step;
        rows.push([t, velocity(t), law.force(z, velocity(t))]);
    }
    let largest = rows.iter().fold(0.0_f64, |m, row| m.max(row[2].abs()));
    let mut noise = Noise::new(SEED);
    let mut text = String::from("time [s],velocity [m/s],force [N]\n");
    for [t, v, force] in rows {
        let force = force + NOISE * largest * noise.normal();
        writeln!(text, "{t},{v},{force}").expect("memory");
    }
    std::fs::write(file, text).expect("a file to write");
    for (name, value) in [
        ("sigma0", law.stiffness()),
        ("sigma1", law.damping().at_rest()),
        ("sigma2", side.viscous),
        ("coulomb", side.coulomb),
        ("static", side.static_friction),
        ("stribeck_velocity", side.stribeck_velocity),
    ] {
        println!("{name} {value}");
    }
}
