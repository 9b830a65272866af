//! Rows by which the force was logged later than the motion it belongs to.
//!
//! A fit finds a delay of a few samples by itself, to a small part of one. Further away its cost has other minima, and the
//! parameters pay for the delay. So the force is first laid beside the motion at every lag, with what any axis answers motion
//! with as linear columns: mass, viscous friction, offset, a spring, and Maxwell-slip elements that yield after very different
//! travels, so that a friction that lags behind a reversal by its presliding is not taken for a late one. What is left of the
//! force is least where both belong together.
//!
//! The Stribeck peak that follows each reversal is in none of these columns, and a force some rows early has one: on sines the
//! least is up to 16 rows early where the force is in time. So only a late force is looked for; one that is early, or late on a
//! sine, the fit that follows finds at the end of its range, and goes on from there (see `alignment`).

use crate::conditioning::record::Samples;
use crate::conditioning::{median_step, stretches};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;
use stiction_policy::delay;
use stiction_signal::{Sos, gradient, second_derivative};

/// Rows either way that are tried.
pub(crate) const MOST: usize = 64;
/// Cut-offs in parts of the sample rate: of the position, and of force and columns.
const SOURCE: f64 = 0.1;
const COMMON: f64 = 0.025;
/// One sample in this many counts: twice the rate that the filter leaves.
const EVERY: usize = 10;
/// Travels after which the elements yield, in parts of the stroke.
const YIELDS: [f64; 6] = [0.1, 0.03, 0.01, 0.003, 0.001, 0.0003];
/// Mass, viscous friction, offset, spring, elements.
const COLUMNS: usize = 4 + YIELDS.len();
/// Fewest samples that count.
const FEWEST: usize = 20 * COLUMNS;

/// Rows by which the force of these logs of one axis was logged later than its motion; `None` where that is not more than a fit
/// finds by itself, or the motion does not show it.
///
/// Costs two filters of the log and, for one sample in ten, as many products as there are columns and lags.
pub fn lateness(logs: &[Samples]) -> Option<usize> {
    let left = Sums::of(logs).left()?;
    let best = (0..left.len()).min_by(|&a, &b| left[a].total_cmp(&left[b]))?;
    let near = (MOST - delay::ROWS_OF_A_FIT)..=(MOST + delay::ROWS_OF_A_FIT);
    let own = near.map(|i| left[i]).fold(f64::INFINITY, f64::min);
    let rows = best.checked_sub(MOST)?;
    (rows > delay::ROWS_OF_A_FIT && rows < MOST && left[best] < delay::MAX_LATE_ERROR * own)
        .then_some(rows)
}

/// Where the force goes best with its motion among the rows that are later (`way` 1) or earlier (-1) than a fit finds by itself,
/// however well that is; `None` where it is no better there than further on.
pub(crate) fn likely(logs: &[Samples], way: isize) -> Option<isize> {
    let left = Sums::of(logs).left()?;
    let at = |rows: usize| MOST.checked_add_signed(way * rows as isize);
    let rows = (delay::ROWS_OF_A_FIT + 1)..MOST;
    let least = rows.min_by(|&a, &b| {
        let of = |rows| at(rows).and_then(|i| left.get(i)).copied();
        let [a, b] = [a, b].map(|rows| of(rows).unwrap_or(f64::INFINITY));
        a.total_cmp(&b)
    });
    least
        .filter(|rows| *rows < MOST - 1)
        .map(|rows| way * rows as isize)
}

/// Normal equations of the force at every lag.
struct Sums {
    square: DMatrix<f64>,
    products: Vec<DVector<f64>>,
    force: Vec<f64>,
    count: usize,
}

impl Sums {
    fn new() -> Self {
        Self {
            square: DMatrix::zeros(COLUMNS, COLUMNS),
            products: vec![DVector::zeros(COLUMNS); 2 * MOST + 1],
            force: vec![0.0; 2 * MOST + 1],
            count: 0,
        }
    }

    fn of(logs: &[Samples]) -> Self {
        let mut sums = Self::new();
        for log in logs {
            let step = median_step(&log.time);
            for stretch in stretches(log, step) {
                sums.add(log, stretch, step);
            }
        }
        sums
    }

    fn add(&mut self, log: &Samples, range: Range<usize>, step: f64) {
        let Some(columns) = columns(log, range.clone(), step) else {
            return;
        };
        let Some(force) = filtered(&log.force[range.clone()], COMMON) else {
            return;
        };
        let mut at = MOST;
        while at + MOST < range.len() {
            let row = DVector::from_fn(COLUMNS, |i, _| columns[i][at]);
            let valid = log.valid.get(range.start + at).copied().unwrap_or(true);
            if valid && row.iter().all(|x| x.is_finite()) {
                self.count += 1;
                self.square.ger(1.0, &row, &row, 1.0);
                for (lag, products) in self.products.iter_mut().enumerate() {
                    let f = force[at + lag - MOST];
                    products.axpy(f, &row, 1.0);
                    self.force[lag] += f * f;
                }
            }
            at += EVERY;
        }
    }

    /// What is left of the square of the force at every lag.
    fn left(&self) -> Option<Vec<f64>> {
        if self.count < FEWEST {
            return None;
        }
        let scale = DVector::from_fn(COLUMNS, |i, _| {
            let own = self.square[(i, i)].sqrt();
            if own > 0.0 { 1.0 / own } else { 0.0 }
        });
        // Elements that yield at the same samples have nearly the same column.
        let scaled = DMatrix::from_fn(COLUMNS, COLUMNS, |i, j| {
            let ridge = if i == j { 1e-6 } else { 0.0 };
            self.square[(i, j)] * scale[i] * scale[j] + ridge
        });
        let factor = scaled.cholesky()?;
        let each = self.products.iter().zip(&self.force);
        let left = each.map(|(products, force)| {
            let b = products.component_mul(&scale);
            force - b.dot(&factor.solve(&b))
        });
        Some(left.collect())
    }
}

/// What the force of an axis is made of, along one stretch.
fn columns(log: &Samples, range: Range<usize>, step: f64) -> Option<[Vec<f64>; COLUMNS]> {
    let position = match (&log.position, &log.velocity) {
        (Some(position), _) => position.get(range)?.to_vec(),
        (None, Some(velocity)) => velocity
            .get(range)?
            .iter()
            .scan(0.0, |x, v| {
                *x += v * step;
                Some(*x)
            })
            .collect(),
        (None, None) => return None,
    };
    let position = filtered(&position, SOURCE)?;
    let low = position.iter().copied().fold(f64::INFINITY, f64::min);
    let high = position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let stroke = high - low;
    let middle = 0.5 * (low + high);
    let mut columns = vec![
        second_derivative(&position, step).ok()?,
        gradient(&position, step).ok()?,
        vec![1.0; position.len()],
        position.iter().map(|x| x - middle).collect(),
    ];
    for part in YIELDS {
        columns.push(element(&position, part * stroke));
    }
    let filtered: Option<Vec<_>> = columns.iter().map(|x| filtered(x, COMMON)).collect();
    filtered?.try_into().ok()
}

/// Force of a Maxwell-slip element that yields after a travel, in parts of its yield force.
fn element(position: &[f64], travel: f64) -> Vec<f64> {
    let mut before = position.first().copied().unwrap_or(0.0);
    let mut deflection = 0.0_f64;
    let along = |&x: &f64| {
        deflection = (deflection + x - before).clamp(-travel, travel);
        before = x;
        deflection / travel.max(f64::MIN_POSITIVE)
    };
    position.iter().map(along).collect()
}

fn filtered(signal: &[f64], cutoff: f64) -> Option<Vec<f64>> {
    let filter = Sos::butterworth_low_pass(2, cutoff, 1.0).ok()?;
    filter.zero_phase(signal).ok()
}
