//! Tables of known motions, and small helpers for tests of the mapping.
#![allow(dead_code)]

use stiction_formats::{Column, Table};
use stiction_log::{Log, Severity};

/// A column with a name such as `Position [mm]`.
pub fn column(header: &str, values: Vec<f64>) -> Column {
    let (name, unit) = match header.split_once(" [") {
        Some((name, unit)) => (name, Some(unit.trim_end_matches(']').to_string())),
        None => (header, None),
    };
    Column {
        name: name.to_string(),
        unit,
        values,
        ..Column::default()
    }
}

/// A table of such columns.
pub fn table(columns: Vec<Column>) -> Table {
    Table {
        columns,
        ..Table::default()
    }
}

/// A pseudo-random number in -1 .. 1 that depends on its place only (SplitMix64 finaliser).
pub fn noise(place: usize) -> f64 {
    let mut z = (place as u64)
        .wrapping_add(0x9e37_79b9_7f4a_7c15)
        .wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A clean axis: x = A sin(w t), F = m a + Fc sign(v) + Fv v, with some noise on the force.
pub struct Axis {
    pub time: Vec<f64>,
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    pub force: Vec<f64>,
}

/// So many samples at 1 kHz of an axis that goes to and fro at 1.3 Hz over +-50 mm.
pub fn axis(samples: usize) -> Axis {
    let (a, w, m, fc, fv) = (0.05, 2.0 * std::f64::consts::PI * 1.3, 20.0, 12.0, 80.0);
    let time: Vec<f64> = (0..samples).map(|i| i as f64 / 1000.0).collect();
    let position: Vec<f64> = time.iter().map(|t| a * (w * t).sin()).collect();
    let velocity: Vec<f64> = time.iter().map(|t| a * w * (w * t).cos()).collect();
    let force = (0..samples)
        .map(|i| {
            let v = velocity[i];
            fc * (v / 1e-3).tanh() + fv * v - m * w * w * position[i] + 0.2 * noise(i)
        })
        .collect();
    Axis {
        time,
        position,
        velocity,
        force,
    }
}

impl Axis {
    pub fn table(self) -> Table {
        table(vec![
            column("time [s]", self.time),
            column("position [m]", self.position),
            column("velocity [m/s]", self.velocity),
            column("force [N]", self.force),
        ])
    }
}

pub fn codes(log: &Log) -> Vec<&'static str> {
    log.findings.iter().map(|f| f.code().as_str()).collect()
}

pub fn warnings(log: &Log) -> Vec<&'static str> {
    log.findings
        .iter()
        .filter(|f| f.severity == Severity::Warning)
        .map(|f| f.code().as_str())
        .collect()
}

pub fn message(log: &Log, code: &str) -> String {
    let hit = log.findings.iter().find(|f| f.code().as_str() == code);
    hit.unwrap_or_else(|| panic!("no {code} in {:#?}", log.findings))
        .to_string()
}

/// Findings and detections, one a line, for snapshots.
pub fn told(log: &Log) -> String {
    let findings = log
        .findings
        .iter()
        .map(|f| format!("{:?} {}: {}", f.severity, f.code(), f));
    log.detected
        .iter()
        .cloned()
        .chain(findings)
        .collect::<Vec<_>>()
        .join("\n")
}
