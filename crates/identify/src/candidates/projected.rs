//! Costs of many candidates beside a common filter, a delay or further terms.
//!
//! What the columns `C` of the further terms express of the measured force `u` is taken out of it once: `u' = u - C c'`. A
//! candidate is then simulated once, its force filtered once, and its cost follows from a few sums: with `b` what its force
//! `F` leaves of `u'`,
//!
//! ```text
//! |u - F - C c|^2 = b.b - 2 d.(C'b) + d.(C'C) d,   b = u' - F,   d = c - c'
//! ```
//!
//! Candidates stand side by side in lanes, so that filter and sums run over a vector of them. Derivatives take the products of
//! all columns of a trial instead.

use super::sums::{motion, track};
use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use crate::error::Error;
use crate::law::Law;
use crate::separable::linear::{self, Normal, dot};
use crate::separable::recursion::trace;
use nalgebra::{DMatrix, DVector};
use std::array::from_fn;
use stiction_dispatch::{InstructionSet, Kernel};
use stiction_lanes::{Candidate, OWN, Sums, Track, Trial, residuals};

/// Candidates side by side: a vector of AVX-512.
const LANES: usize = 8;
type Row = [f64; LANES];

pub(super) struct Projected {
    record: Record,
    shift: Shift,
    /// The motion, with a measured force of 0.
    motion: Track,
    /// `u'` at the kept samples.
    target: Vec<f64>,
    /// `c'`.
    expressed: DVector<f64>,
    /// Measured force, velocity and the columns of `C`, at the kept samples.
    shared: Vec<Vec<f64>>,
    /// `C'C`.
    gram: DMatrix<f64>,
    /// For each of them, whether its coefficient must not be negative.
    nonnegative: Vec<bool>,
}

impl Projected {
    /// From the measured force, the velocity and the columns of the further terms at the kept samples, filtered and shifted as
    /// the force of a candidate is to be.
    pub fn new(
        record: &Record,
        shift: Shift,
        shared: Vec<Vec<f64>>,
        nonnegative: &[bool],
    ) -> Result<Self, Error> {
        let still = |segment: &Segment| vec![0.0; segment.velocity.len()];
        let still: Vec<Vec<f64>> = record.segments.iter().map(still).collect();
        let motions = record.segments.iter().zip(&still);
        let motions = motions.map(|(segment, force)| motion(segment, force, &[], &[]));
        let columns: Vec<&[f64]> = shared[2..].iter().map(Vec::as_slice).collect();
        let (count, free) = (columns.len(), vec![false; columns.len()]);
        let solution = linear::solve(&columns, &free, &shared[0]);
        Ok(Self {
            motion: track(record, motions.collect())?,
            record: record.clone(),
            shift,
            target: solution.residual,
            expressed: solution.coefficients.into(),
            gram: DMatrix::from_fn(count, count, |i, j| dot(columns[i], columns[j])),
            shared,
            nonnegative: nonnegative.to_vec(),
        })
    }

    /// Sum of squares of the residual of each candidate, the further terms solved for.
    pub fn costs(&self, candidates: &[Candidate]) -> Vec<f64> {
        let (mut rows, mut out) = (Vec::new(), Vec::with_capacity(candidates.len()));
        for group in candidates.chunks(LANES) {
            let set = InstructionSet::best();
            // A checked box holds only candidates that can be computed.
            if residuals(&self.motion, group, set, &mut rows).is_err() {
                out.extend(group.iter().map(|_| f64::INFINITY));
                continue;
            }
            let sums = self.sums(&mut rows);
            out.extend((0..group.len()).map(|lane| self.least(&sums, lane)));
        }
        out
    }

    /// Filters the forces of candidates at the full rate, and adds up `b.b` and `C'b`.
    fn sums(&self, rows: &mut [Row]) -> Vec<Row> {
        let mut sums = vec![[0.0; LANES]; 1 + self.gram.nrows()];
        let (mut rest, mut from) = (rows, 0);
        for segment in &self.record.segments {
            let (own, after) = rest.split_at_mut(segment.velocity.len());
            rest = after;
            if let Some(filter) = &self.record.common {
                // The segment was conditioned by this very filter, so it is long enough.
                let _ = filter.zero_phase_rows(own);
            }
            from += InstructionSet::best().run(Adding {
                of: self,
                keep: &segment.keep,
                rows: own,
                from,
                sums: &mut sums,
            });
        }
        sums
    }

    /// The sums of one trial, its columns filtered like the force.
    pub fn products(&self, law: &Law, trial: &Trial) -> Sums {
        let p = [trial.ln_kappa, trial.ln_excess, trial.ln_velocity];
        let mut own: [Vec<f64>; OWN] = Default::default();
        for segment in &self.record.segments {
            let traced = trace(law, &p, segment.step, &segment.velocity, true);
            let mut full = vec![traced.eta, traced.rate];
            full.extend(traced.eta_slope);
            full.extend(traced.rate_slope);
            self.record.filter(&mut full);
            for (out, column) in own.iter_mut().zip(&full) {
                self.record.thin(segment, column, self.shift, out);
            }
        }
        let with = |x: &Vec<f64>| from_fn(|i| dot(&own[i], x));
        Sums {
            own: from_fn(|i| with(&own[i])),
            shared: self.shared.iter().map(with).collect(),
        }
    }

    /// The least sum of squares that the coefficients of the further terms allow.
    fn least(&self, sums: &[Row], lane: usize) -> f64 {
        let left = DVector::from_iterator(sums.len() - 1, sums[1..].iter().map(|row| row[lane]));
        let rhs = &left + &self.gram * &self.expressed;
        let normal = Normal {
            gram: self.gram.clone(),
            rhs: rhs.as_slice().to_vec(),
            energy: sums[0][lane],
        };
        let (factor, solved, _) = normal.solve(&self.nonnegative);
        let mut change = -&self.expressed;
        for (&j, c) in factor.columns().iter().zip(solved) {
            change[j] += c;
        }
        let cost = sums[0][lane] - 2.0 * change.dot(&left) + change.dot(&(&self.gram * &change));
        // Rounding may take it below zero, never far.
        if cost.is_nan() {
            f64::INFINITY
        } else {
            cost.max(0.0)
        }
    }
}

/// Adds up the products of a segment whose kept samples begin at `from`; returns how many it has.
struct Adding<'a> {
    of: &'a Projected,
    keep: &'a [bool],
    rows: &'a [Row],
    from: usize,
    sums: &'a mut [Row],
}

impl Kernel for Adding<'_> {
    type Output = usize;

    #[inline(always)]
    fn run(self) -> usize {
        let Projected {
            record,
            shift,
            target,
            shared,
            ..
        } = self.of;
        let mut at = self.from;
        for (k, _) in self.keep.iter().enumerate().filter(|(_, keep)| **keep) {
            let mut b = shift.row(self.rows, k * record.decimate);
            for (b, sum) in b.iter_mut().zip(&mut self.sums[0]) {
                *b += target[at];
                *sum += *b * *b;
            }
            for (sums, column) in self.sums[1..].iter_mut().zip(&shared[2..]) {
                for (sum, b) in sums.iter_mut().zip(&b) {
                    *sum += column[at] * b;
                }
            }
            at += 1;
        }
        at - self.from
    }
}
