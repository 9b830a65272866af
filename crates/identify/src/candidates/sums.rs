//! A record as the six-parameter cost reads it: costs, and the sums of products that derivatives are made of.

use super::projected::Projected;
use crate::conditioning::record::{self, Record};
use crate::conditioning::shift::Shift;
use crate::error::Error;
use crate::law::Law;
use crate::law::terms::{ColumnKind, Delay, Terms};
use crate::separable::linear::dot;
use crate::separable::objective::Objective;
use stiction_lanes::{
    Candidate, InstructionSet, Scheme, Segment, Sums, Time, Track, Trial, costs, sums,
};

/// A record with what stands beside the law.
pub(super) struct Sampled {
    law: Law,
    /// The record as the lane kernels read it, where neither filter nor shift stands between law and measured force.
    track: Option<Track>,
    /// What computes costs beside filter, shift or further columns; `None` without all of them.
    projected: Option<Projected>,
    /// Products of `[force, velocity, further..]` with each other.
    pub shared: Vec<Vec<f64>>,
    /// For each further column, whether its coefficient must not be negative.
    pub nonnegative: Vec<bool>,
    /// Sum of squares of the measured force.
    pub energy: f64,
    /// Samples that are run through for one candidate.
    pub samples: usize,
}

impl Sampled {
    /// Reads a record together with the linear terms beside the law; a delay that would be fitted is
    /// taken as zero.
    pub fn new(record: &Record, law: Law, terms: &Terms) -> Result<Self, Error> {
        let still = match terms.delay {
            Delay::Fitted => Delay::NONE,
            given => given,
        };
        let terms = Terms {
            delay: still,
            ..terms.clone()
        };
        let objective = crate::separable::checked::checked(record, law, &terms)?;
        let (shared, nonnegative) = shared_columns(&objective);
        let shift = match still {
            Delay::Given(0.0) | Delay::Fitted => Shift::NONE,
            Delay::Given(time) => Shift::earlier(time / record.step()),
        };
        let reads_lanes = record.common.is_none() && record.decimate == 1 && shift == Shift::NONE;
        let track = reads_lanes.then(|| spread(record, &shared)).transpose()?;
        let row = |a: &Vec<f64>| shared.iter().map(|b| dot(a, b)).collect();
        let products = shared.iter().map(row).collect();
        let projected = match reads_lanes && nonnegative.is_empty() {
            true => None,
            false => Some(Projected::new(record, shift, shared, &nonnegative)?),
        };
        Ok(Self {
            law,
            track,
            projected,
            shared: products,
            nonnegative,
            energy: objective.energy(),
            samples: record.segments.iter().map(|s| s.velocity.len()).sum(),
        })
    }

    /// Whether nothing stands between the force of the law and the measured one: neither filter nor further columns.
    pub fn is_bare(&self) -> bool {
        self.projected.is_none()
    }

    /// The cost of each candidate. Further columns and filters are for [`Scheme::Explin`] alone.
    pub fn costs(&self, candidates: &[Candidate], scheme: Scheme) -> Vec<f64> {
        let found = match (&self.projected, &self.track) {
            (Some(projected), _) => Some(projected.costs(candidates)),
            // A checked box holds only candidates that can be computed.
            (None, track) => track
                .as_ref()
                .and_then(|track| costs(track, candidates, scheme, InstructionSet::best()).ok()),
        };
        let found = found.unwrap_or_default().into_iter();
        found.map(|cost| cost / self.energy).collect()
    }

    /// Sums for each trial.
    pub fn sums(&self, trials: &[Trial]) -> Option<Vec<Sums>> {
        match (&self.track, &self.projected) {
            (Some(track), _) => sums(track, trials, InstructionSet::best()).ok(),
            (None, projected) => projected.as_ref().map(|projected| {
                let one = |trial| projected.products(&self.law, trial);
                trials.iter().map(one).collect()
            }),
        }
    }
}

/// Force, velocity and the columns beside the law, at the kept samples; which of the last are bounded.
fn shared_columns(objective: &Objective) -> (Vec<Vec<f64>>, Vec<bool>) {
    // They are the same for every trial.
    let p = vec![0.0; objective.nonlinear()];
    let mut force = objective.force().to_vec();
    for (u, inertia) in force.iter_mut().zip(objective.inertia(&p)) {
        *u -= inertia;
    }
    let (mut velocity, mut further, mut nonnegative) = (Vec::new(), Vec::new(), Vec::new());
    let columns = objective.evaluate(&p, false).columns;
    for (term, column) in objective.linear().iter().zip(columns) {
        match term.column {
            ColumnKind::Level | ColumnKind::Rate => {}
            ColumnKind::Speed(None) => velocity = column.to_vec(),
            _ => {
                further.push(column.to_vec());
                nonnegative.push(term.is_never_negative());
            }
        }
    }
    let mut shared = vec![force, velocity];
    shared.append(&mut further);
    (shared, nonnegative)
}

fn spread(record: &Record, shared: &[Vec<f64>]) -> Result<Track, Error> {
    // Puts the values of the kept samples back at their places; samples that do not count are never read.
    let mut at = 0;
    let spread: Vec<Vec<Vec<f64>>> = record
        .segments
        .iter()
        .map(|segment| {
            let from = at;
            at += segment.keep.iter().filter(|&&k| k).count();
            let each = |column: &Vec<f64>| {
                let mut kept = column[from..at].iter();
                let place = |&keep: &bool| match keep {
                    true => kept.next().copied().unwrap_or(0.0),
                    false => 0.0,
                };
                segment.keep.iter().map(place).collect()
            };
            shared.iter().map(each).collect()
        })
        .collect();
    let further: Vec<Vec<&[f64]>> = spread
        .iter()
        .map(|columns| columns[2..].iter().map(Vec::as_slice).collect())
        .collect();
    let segments = record.segments.iter().enumerate();
    let segments = segments.map(|(i, s)| motion(s, &spread[i][0], &s.keep, &further[i]));
    track(record, segments.collect())
}

/// A segment of a record as the lane kernels read it.
pub(super) fn motion<'a>(
    of: &'a record::Segment,
    force: &'a [f64],
    keep: &'a [bool],
    columns: &'a [&'a [f64]],
) -> Segment<'a> {
    Segment {
        time: Time::Step(of.step),
        velocity: &of.velocity,
        force,
        keep,
        columns,
    }
}

pub(super) fn track(record: &Record, segments: Vec<Segment>) -> Result<Track, Error> {
    Track::new(&segments).map_err(|_| Error::Setting {
        name: "largest speed or force",
        found: record.top_speed(),
        allowed: "finite and below 1e100",
    })
}
