//! How the fit changes with the cut-offs beside those that were chosen.
//!
//! Replicas show what encoder steps and filters shift, as far as the simulated axis is like the one that was logged. Fitted with
//! other cut-offs, the log itself shows what they do not: once the shifts that replicas have there are taken off, fits with
//! one cut-off and another must agree within what their noise explains (Hausman 1978, doi 10.2307/1913827). What is beyond
//! that is an error that the choice of the cut-off decides on.

use crate::conditioning::record::{Record, Samples, Segment};
use crate::conditioning::{Conditioning, Cutoff};
use crate::estimate::Estimate;
use crate::law::physical::physical;
use crate::parameter::physical::{Physical, propagate};
use crate::refit::{Asked, Refit, refitted};
use crate::replica::Replica;
use crate::shifts::{Shifts, between};
use stiction_search::Counts;

/// Factors of both cut-offs, and of the common one alone, that make the neighbours.
const NEIGHBOURS: [[f64; 2]; 2] = [[std::f64::consts::SQRT_2, 1.0], [1.0, 0.5]];
/// Replicas that are fitted with each of them.
const REPLICA_COUNT: usize = 3;

/// One pair of cut-offs beside those of a record.
struct Window {
    conditioning: Conditioning,
    /// From the fit with the chosen cut-offs to the one with these: of the log, and of replicas.
    own: Vec<f64>,
    replicas: Shifts,
    /// Variance by which noise explains a difference.
    chance: Vec<f64>,
}

/// The neighbours of the cut-offs of a record.
pub(super) struct Windows(Vec<Window>);

impl Windows {
    /// Fits the log with them.
    pub fn of(record: &Record, fitted: &Estimate, raw: &[Physical], counts: &mut Counts) -> Self {
        let log = logged(record, fitted);
        let chosen = record.conditioning.as_ref();
        let neighbours = NEIGHBOURS.iter().filter_map(|by| beside(chosen?, by));
        let own = propagate(raw, fitted.unknowns.at_once());
        let window = |conditioning: Conditioning| {
            let refit = refitted(&log, &conditioning, fitted, Asked::Scatter, counts)?;
            let there = at(record, fitted, &refit);
            let covariance = propagate(&there, refit.scatter?.at_once());
            let chance = (0..raw.len()).map(|i| (covariance[(i, i)] - own[(i, i)]).abs());
            Some(Window {
                conditioning,
                own: between(raw, &there),
                replicas: Shifts::default(),
                chance: chance.collect(),
            })
        };
        Self(neighbours.filter_map(window).collect())
    }

    /// Fits a replica with them, which has shifts like these with the chosen cut-offs.
    pub fn count(
        &mut self,
        replica: &Replica,
        (record, fitted): (&Record, &Estimate),
        (truth, shift): (&[Physical], &[f64]),
        counts: &mut Counts,
    ) {
        for window in &mut self.0 {
            if window.replicas.0.len() >= REPLICA_COUNT {
                continue;
            }
            let conditioning = &window.conditioning;
            let refit = refitted(replica, conditioning, fitted, Asked::Unknowns, counts);
            if let Some(refit) = refit {
                let there = between(truth, &at(record, fitted, &refit));
                let moved = there.iter().zip(shift).map(|(there, here)| there - here);
                window.replicas.0.push(moved.collect());
            }
        }
    }

    /// Variance of each of so many parameters that neither replicas nor noise explain.
    pub fn variance(&self, parameters: usize) -> Vec<f64> {
        let known = self.0.iter().filter(|w| w.replicas.0.len() >= 2);
        let windows: Vec<&Window> = known.collect();
        let unexplained = |i: usize| {
            let excess = windows.iter().map(|w| {
                let difference = w.own[i] - w.replicas.mean(i);
                // The log is one more of them, and their mean is that of a few.
                let few = 1.0 + 1.0 / w.replicas.count();
                let chance = w.chance[i] + few * w.replicas.variance(i);
                let excess = difference * difference - chance;
                if excess.is_finite() {
                    excess.max(0.0)
                } else {
                    0.0
                }
            });
            excess.sum::<f64>() / windows.len().max(1) as f64
        };
        (0..parameters).map(unexplained).collect()
    }
}

/// The parameters that a fit found.
fn at(record: &Record, fitted: &Estimate, refit: &Refit) -> Vec<Physical> {
    let linear = fitted.terms.columns(&fitted.law);
    physical(&fitted.law, &linear, record.step(), &refit.p, &refit.c)
}

/// Cut-offs changed by these factors; `None` where there are none, or the common one would not stay below the other.
fn beside(chosen: &Conditioning, [both, common]: &[f64; 2]) -> Option<Conditioning> {
    let (Cutoff::Hz(source), Cutoff::Hz(shared)) = (chosen.source_cutoff, chosen.common_cutoff)
    else {
        return None;
    };
    let (source, shared) = (both * source, both * common * shared);
    (shared < source).then_some(Conditioning {
        source_cutoff: Cutoff::Hz(source),
        common_cutoff: Cutoff::Hz(shared),
        ..*chosen
    })
}

/// The logs of a record as they were read, with the parameters of its fit.
fn logged(record: &Record, fitted: &Estimate) -> Replica {
    let channel = |x: &[f64]| (!x.is_empty()).then(|| x.to_vec());
    let samples = |segment: &Segment| Samples {
        time: (0..segment.drive.len())
            .map(|k| k as f64 * segment.step)
            .collect(),
        position: channel(&segment.reading),
        force: segment.drive.clone(),
        valid: segment.valid.clone(),
        at_rest: segment.at_rest.clone(),
        load: channel(&segment.channels.load),
        temperature: channel(&segment.channels.temperature),
        external: channel(&segment.channels.external),
        ..Samples::default()
    };
    Replica {
        logs: record.segments.iter().map(samples).collect(),
        quiet: Vec::new(),
        p: fitted.unknowns().to_vec(),
        terms: fitted.terms.clone(),
    }
}
