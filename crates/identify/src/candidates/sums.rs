//! Sums of products of the columns that a trial makes, with or without a filter on the record.

use crate::conditioning::record::Record;
use crate::conditioning::shift::Shift;
use crate::error::Error;
use crate::law::Law;
use crate::law::terms::{ColumnKind, Delay, Terms};
use crate::separable::linear::dot;
use crate::separable::objective::Objective;
use crate::separable::recursion::trace;
use stiction_lanes::{InstructionSet, OWN, Segment, Sums, Time, Track, Trial, shared_sums, sums};

/// A record as the six-parameter cost reads it.
pub(super) struct Sampled {
    source: Source,
    law: Law,
    /// Products of `[force, velocity, further..]` with each other.
    pub shared: Vec<Vec<f64>>,
    /// For each further column, whether its coefficient must not be negative.
    pub nonnegative: Vec<bool>,
    /// Sum of squares of the measured force.
    pub energy: f64,
    /// Samples that are run through for one candidate.
    pub samples: usize,
}

enum Source {
    /// The columns of the law are used directly, without filter or shift, in the lane kernels.
    Lanes(Track),
    /// The columns pass the filter of the record, or are shifted earlier by a known delay.
    Filtered {
        record: Box<Record>,
        shift: Shift,
        /// Force, velocity, further columns at the kept samples.
        shared: Vec<Vec<f64>>,
    },
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
            Delay::Given(0.0) | Delay::Fitted => None,
            Delay::Given(time) => Some(Shift::earlier(time / record.step())),
        };
        let gram = |columns: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let row = |a: &Vec<f64>| columns.iter().map(|b| dot(a, b)).collect();
            columns.iter().map(row).collect()
        };
        let energy = objective.energy();
        let samples = record.segments.iter().map(|s| s.velocity.len()).sum();
        if record.common.is_none() && record.decimate == 1 && shift.is_none() {
            let track = track(record, &shared)?;
            return Ok(Self {
                law,
                shared: shared_sums(&track),
                source: Source::Lanes(track),
                nonnegative,
                energy,
                samples,
            });
        }
        Ok(Self {
            law,
            shared: gram(&shared),
            source: Source::Filtered {
                record: Box::new(record.clone()),
                shift: shift.unwrap_or(Shift::NONE),
                shared,
            },
            nonnegative,
            energy,
            samples,
        })
    }

    /// The record as the lane kernels read it, where they give the cost directly: no further columns.
    pub fn bare(&self) -> Option<&Track> {
        match &self.source {
            Source::Lanes(track) if self.nonnegative.is_empty() => Some(track),
            _ => None,
        }
    }

    /// Sums for each trial; without `slopes` those of the sensitivities may be zero.
    pub fn sums(&self, trials: &[Trial], slopes: bool) -> Option<Vec<Sums>> {
        match &self.source {
            Source::Lanes(track) => sums(track, trials, InstructionSet::best()).ok(),
            Source::Filtered {
                record,
                shift,
                shared,
            } => {
                let one = |trial| filtered(&self.law, record, *shift, shared, trial, slopes);
                Some(trials.iter().map(one).collect())
            }
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

fn track(record: &Record, shared: &[Vec<f64>]) -> Result<Track, Error> {
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
    let segments: Vec<Segment> = record
        .segments
        .iter()
        .enumerate()
        .map(|(i, s)| Segment {
            time: Time::Step(s.step),
            velocity: &s.velocity,
            force: &spread[i][0],
            keep: &s.keep,
            columns: &further[i],
        })
        .collect();
    Track::new(&segments).map_err(|_| Error::Setting {
        name: "largest speed or force",
        found: record.top_speed(),
        allowed: "finite and below 1e100",
    })
}

/// The sums of one trial, its columns filtered like the force.
fn filtered(
    law: &Law,
    record: &Record,
    shift: Shift,
    shared: &[Vec<f64>],
    trial: &Trial,
    slopes: bool,
) -> Sums {
    let p = [trial.ln_kappa, trial.ln_excess, trial.ln_velocity];
    let used = if slopes { OWN } else { 2 };
    let mut own: Vec<Vec<f64>> = vec![Vec::new(); used];
    for segment in &record.segments {
        let traced = trace(law, &p, segment.step, &segment.velocity, slopes);
        let mut full = vec![traced.eta, traced.rate];
        full.extend(traced.eta_slope);
        full.extend(traced.rate_slope);
        full.truncate(used);
        record.filter(&mut full);
        for (out, column) in own.iter_mut().zip(&full) {
            record.thin(segment, column, shift, out);
        }
    }
    let product = |i: usize, j: usize| match (own.get(i), own.get(j)) {
        (Some(a), Some(b)) => dot(a, b),
        _ => 0.0,
    };
    let with = |s: &Vec<f64>, i: usize| own.get(i).map_or(0.0, |a| dot(a, s));
    Sums {
        own: std::array::from_fn(|i| std::array::from_fn(|j| product(i, j))),
        shared: shared
            .iter()
            .map(|s| std::array::from_fn(|i| with(s, i)))
            .collect(),
    }
}
