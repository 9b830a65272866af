//! The force to expect along a motion.

use rayon::prelude::*;
use stiction_plan::{Candidate, Motion, Nameplate, run};

/// Pieces of time that the band has.
const BINS: usize = 800;

/// Least and largest force on any of the axes, in pieces of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// Middle of each piece, s.
    pub time: Vec<f64>,
    /// N (N m)
    pub low: Vec<f64>,
    /// N (N m)
    pub high: Vec<f64>,
}

/// Simulates the motion on every axis once more.
pub(super) fn band(motion: &Motion, axes: &[Candidate], plate: &Nameplate) -> Band {
    let forces: Vec<Vec<f64>> = axes
        .par_iter()
        .filter_map(|axis| {
            let run = run(motion, axis, &plate.rig, plate.limits.peak_force, 0.5);
            run.ok().map(|run| run.force)
        })
        .collect();
    let samples = forces.first().map_or(0, Vec::len);
    let bins = BINS.min(samples.max(1));
    let mut band = Band::default();
    for bin in 0..bins {
        let (from, to) = (bin * samples / bins, (bin + 1) * samples / bins);
        let all = || forces.iter().flat_map(|force| &force[from..to]).copied();
        band.time
            .push(motion.duration() * (bin as f64 + 0.5) / bins as f64);
        band.low.push(all().fold(f64::INFINITY, f64::min));
        band.high.push(all().fold(f64::NEG_INFINITY, f64::max));
    }
    band
}
