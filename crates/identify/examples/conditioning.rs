//! Prints the tables of `docs/conditioning.md`: how well the automatic conditioning does on simulated
//! logs whose truth is known.

#[path = "../tests/suite/common/mod.rs"]
mod common;

use common::closed_loop::{axis, encoder, error, identified, three_segments, truth};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Conditioning, Cutoff, Law, LawKind, Samples, Settings, Silent, Source, Terms, condition,
    fit_law,
};
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog, Record};
use stiction_servo::noise::Noise;
use stiction_servo::path::{Path, Sine};
use stiction_servo::plant::Plant;
use stiction_signal::SavitzkyGolay;

fn main() {
    encoders();
    windows();
    slow();
}

/// Every parameter of closed-loop logs, three encoders and two axes.
fn encoders() {
    println!("| axis | encoder | seed | cut-offs (Hz) | largest error | outside its interval |");
    println!("|---|---|---|---|---|---|");
    for name in ["machine", "motor"] {
        for count in [50e-9, 100e-9, 1e-6] {
            for seed in 0..4 {
                let log = three_segments(name, count, 0.5, seed);
                let (tuned, found) = identified(&log, count);
                let mut worst = ("", 0.0_f64);
                let mut outside = Vec::new();
                for (parameter, truth) in truth(name) {
                    let (off, covered) = error(found.parameter(parameter).unwrap(), truth);
                    if off.abs() > worst.1.abs() {
                        worst = (parameter, off);
                    }
                    if !covered {
                        outside.push(format!("{parameter} {off:+.2} %"));
                    }
                }
                for (parameter, truth) in [("offset", 0.0), ("delay", -1.25e-4)] {
                    let p = found.parameter(parameter).unwrap();
                    if p.ci95.is_none_or(|(a, b)| truth < a || truth > b) {
                        outside.push(parameter.to_string());
                    }
                }
                let hertz = |cutoff| match cutoff {
                    Cutoff::Hz(f) => f,
                    Cutoff::Auto | Cutoff::Off => f64::NAN,
                };
                println!(
                    "| {name} | {:.0} nm | {seed} | {:.0}, {:.0} | {} {:+.2} % | {} |",
                    1e9 * count,
                    hertz(tuned.conditioning.source_cutoff),
                    hertz(tuned.conditioning.common_cutoff),
                    worst.0,
                    worst.1,
                    outside.join(", ")
                );
            }
        }
    }
}

/// Savitzky-Golay windows as scripts use them, against the automatic choice, on logs of each encoder.
fn windows() {
    println!(
        "\n| encoder | 11 | 31 | 101 | 301 | automatic | over the best | above 1.5 | largest |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut squares = Vec::new();
    for count in [10e-9, 100e-9, 1e-6] {
        let rows: Vec<[f64; 6]> = (1..=LOGS).map(|seed| row(count, seed)).collect();
        let column = |i: usize| {
            let mut values: Vec<f64> = rows.iter().map(|row| row[i]).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let median = |i: usize| {
            let values = column(i);
            0.5 * (values[values.len() / 2] + values[(values.len() - 1) / 2])
        };
        let cells: Vec<String> = (0..5).map(|i| format!("{:.2} %", median(i))).collect();
        let ratios = column(5);
        println!(
            "| {:.0} nm | {} | {:.2} | {} of {LOGS} | {:.1} |",
            1e9 * count,
            cells.join(" | "),
            median(5),
            ratios.iter().filter(|r| **r > 1.5).count(),
            ratios[ratios.len() - 1]
        );
        let mean = |i: usize| {
            let sum: f64 = rows.iter().map(|row| row[i] * row[i]).sum();
            (sum / rows.len() as f64).sqrt()
        };
        let cells: Vec<String> = (0..5).map(|i| format!("{:.2} %", mean(i))).collect();
        squares.push(format!("| {:.0} nm | {} |", 1e9 * count, cells.join(" | ")));
    }
    println!("\n| encoder | 11 | 31 | 101 | 301 | automatic |");
    println!("|---|---|---|---|---|---|");
    println!("{}", squares.join("\n"));
}

/// A joint behind a gear on slow sines: mass and stiffness hardly show.
fn slow() {
    println!(
        "\n| period | noise | seed | cut-offs (Hz) | sigma0 | mass | flagged | outside its interval |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (period, memory) in [(8.0, 0.0), (8.0, 0.98), (20.0, 0.0), (20.0, 0.98)] {
        for seed in 0..2 {
            println!("{}", joint_row(period, memory, seed));
        }
    }
}

fn joint_row(period: f64, memory: f64, seed: u64) -> String {
    let log = joint(period, memory, seed);
    let (tuned, found) = identified(&log, JOINT_COUNT);
    let hertz = |cutoff| match cutoff {
        Cutoff::Hz(f) => f,
        Cutoff::Auto | Cutoff::Off => f64::NAN,
    };
    let (mut flagged, mut outside) = (Vec::new(), Vec::new());
    for (name, truth) in JOINT {
        let p = found.parameter(name).unwrap();
        if !p.identifiable {
            flagged.push(name);
        } else if !error(p, truth).1 {
            outside.push(format!("{name} {:+.1} %", error(p, truth).0));
        }
    }
    let off = |i: usize| error(found.parameter(JOINT[i].0).unwrap(), JOINT[i].1).0;
    format!(
        "| {period:.0} s | {} | {seed} | {:.2}, {:.2} | {:+.1} % | {:+.1} % | {} | {} |",
        if memory > 0.0 { "correlated" } else { "white" },
        hertz(tuned.conditioning.source_cutoff),
        hertz(tuned.conditioning.common_cutoff),
        off(0),
        off(6),
        flagged.join(", "),
        outside.join(", ")
    )
}

/// A joint with a gear, rad and N m.
const JOINT: [(&str, f64); 7] = [
    ("sigma0", 2100.0),
    ("sigma1", 40.0),
    ("sigma2", 9.0),
    ("coulomb", 7.0),
    ("static", 8.5),
    ("stribeck_velocity", 0.06),
    ("mass", 0.42),
];
/// Its encoder, rad.
const JOINT_COUNT: f64 = 1e-4;
/// Noise of its torque, N m.
const JOINT_NOISE: f64 = 0.2;

/// Two slow sines of a joint at 500 Hz, 60 s.
fn joint(period: f64, memory: f64, seed: u64) -> Record {
    let [stiffness, damping, viscous, coulomb, fs, vs, mass] = JOINT.map(|(_, value)| value);
    let side = Direction {
        coulomb,
        static_friction: fs,
        stribeck_velocity: vs,
        viscous,
    };
    let curve = Stribeck::new(Shape::Gaussian, side, side, 0.0).unwrap();
    let law = LuGre::new(stiffness, Damping::Constant(damping), curve).unwrap();
    let mut log = ClosedLoop {
        plant: Plant::new(mass, law).unwrap(),
        controller: Cascade::tuned(mass, 15.0, 100.0).unwrap(),
        path: Path::new(vec![
            Sine::new(0.6, 1.0 / period, 40.0),
            Sine::new(0.1, 1.5 / period, 20.0),
        ])
        .unwrap(),
        encoder: encoder(JOINT_COUNT, seed),
        rate: 500.0,
        substeps: 20,
        force_noise: 0.0,
        force_log: ForceLog::Held,
        seed,
    }
    .run()
    .unwrap();
    // First-order noise of a standard deviation that does not depend on its memory.
    let mut noise = Noise::new(100 + seed);
    let mut state = 0.0;
    for force in &mut log.force {
        state = memory * state + (1.0 - memory * memory).sqrt() * noise.normal();
        *force += JOINT_NOISE * state;
    }
    log
}

/// Logs of each encoder.
const LOGS: u64 = 12;

/// On one log the largest error with each window, with the automatic choice, %, and that over the least with a window.
fn row(count: f64, seed: u64) -> [f64; 6] {
    let log = sine(count, seed);
    let largest = |value: &dyn Fn(&str) -> f64| {
        let errors = truth("machine").map(|(name, truth)| (value(name) / truth - 1.0).abs());
        100.0 * errors.into_iter().fold(0.0, f64::max)
    };
    let [a, b, c, d] = [11, 31, 101, 301].map(|window| {
        let found = smoothed(&log, window);
        largest(&|name| found.value(name).unwrap_or(f64::INFINITY))
    });
    let (_, found) = identified(&log, count);
    let own = largest(&|name| found.value(name).unwrap());
    [a, b, c, d, own, own / a.min(b).min(c).min(d)]
}

/// One slow sine at 10 kHz without feedforward, 1 % noise on the force.
fn sine(count: f64, seed: u64) -> Record {
    let axis = axis("machine");
    ClosedLoop {
        plant: Plant::new(axis.mass, axis.law).unwrap(),
        controller: Cascade {
            position_gain: 80.0,
            speed_gain: 2000.0,
            integral_gain: 1e5,
            mass_feedforward: 0.0,
            force_limit: 1e3,
        },
        path: Path::sine(0.0503, 1.0, 3.0).unwrap(),
        encoder: encoder(count, seed),
        rate: 1e4,
        substeps: 10,
        force_noise: 0.3,
        force_log: ForceLog::Held,
        seed,
    }
    .run()
    .unwrap()
}

/// The usual script: velocity from a smoothing polynomial, then least squares.
fn smoothed(log: &Record, window: usize) -> stiction_identify::Estimate {
    let step = log.time[1] - log.time[0];
    let slope = SavitzkyGolay::new(window, 3, 1).unwrap();
    let samples = Samples {
        time: log.time.clone(),
        velocity: Some(slope.apply(&log.position, step).unwrap()),
        force: log.force.clone(),
        ..Samples::default()
    };
    let raw = Conditioning {
        source: Some(Source::Velocity),
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    let record = condition(&[samples], &raw).unwrap();
    let law = Law::new(LawKind::LuGre);
    let settings = Settings::default();
    fit_law(&record, law, &Terms::default(), 0.0, &settings, &mut Silent)
        .unwrap()
        .0
}
