//! sigma0 and sigma1 (and mass, offset) with the steady curve known: the second half of the
//! static-then-dynamic identification of Zhang et al. 2025, doi 10.1371/journal.pone.0322844,
//! eqs. 35-38.
//!
//! The residual is that of the control force, `u - M a - F(v)`; against the friction force
//! `u - M a` it is the same. For a given ln kappa everything that is left is linear, so the search is
//! in one dimension: a grid over the whole range, its minima followed.

use super::parameter::Found;
use super::profile::golden;
use super::statics::Statics;
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::{Estimate, estimate, uncertainty};
use crate::law::physical::physical;
use crate::law::terms::Terms;
use crate::law::{Law, LawKind};
use crate::parameter::NORMAL_Q95;
use crate::parameter::covariance::Covariance;
use crate::parameter::physical::propagate;
use crate::separable::linear::{self, Solution, dot};
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::SearchBox;
use crate::separable::secant::Secant;
use nalgebra::{DMatrix, DVector};
use stiction_parameters::{Name, Quantity};
use stiction_search::{Control, Counts, Observer, Progress, Stage, Status};

/// Starts over ln sigma0, spread over the whole range.
const GRID_POINTS: usize = 24;
/// Minima of the grid that are followed, and the width in ln sigma0 at which that ends.
const FOLLOWED: usize = 3;
/// Width in ln sigma0 at which following a minimum ends: far below any interval, far above the rounding of
/// the cost.
const SETTLED_WIDTH: f64 = 1e-7;
/// Step of the central differences that give sensitivities, in logarithms: their error is about the square.
const DIFFERENCE_STEP: f64 = 1e-4;

/// Fits the dynamic parameters of LuGre to a record, the steady curve held.
///
/// The uncertainty of the curve is carried into that of sigma0 and sigma1. What encoder and filters shift is not in it:
/// [`dynamic_conditioned`](super::dynamic_conditioned) measures that.
///
/// # Errors
/// As [`separable`](crate::separable()): no motion, too few samples.
pub fn dynamic(
    record: &Record,
    statics: &Statics,
    terms: &Terms,
    low_speed: f64,
    observer: &mut dyn Observer,
) -> Result<Estimate, Error> {
    dynamic_near(None, record, statics, terms, low_speed, observer)
}

/// The same with sigma0 sought only around a given `ln(sigma0/Fc)`, sigma0/Fc in 1/m or 1/rad: what a search has found.
///
/// # Errors
/// As [`dynamic`].
pub fn dynamic_near(
    near: Option<f64>,
    record: &Record,
    statics: &Statics,
    terms: &Terms,
    low_speed: f64,
    observer: &mut dyn Observer,
) -> Result<Estimate, Error> {
    let law = Law {
        asymmetric: statics.asymmetric,
        exponent: statics.exponent,
        ..Law::new(LawKind::LuGre)
    };
    let bounds = SearchBox::from_record(record, &law)?;
    let objective = Objective::new(record, law, terms);
    let free = objective
        .linear()
        .iter()
        .filter(|t| !Statics::owns(t))
        .count();
    let needed = 10 * (free + 1);
    if record.kept() < needed {
        return Err(Error::TooFewSamples {
            found: record.kept(),
            needed,
            losses: record.losses(),
        });
    }
    let held = Held::of(objective, statics, law);
    let (best, status, counts) = held.search(&bounds, near, observer);
    let mut p = held.p.clone();
    p[held.kappa] = best;
    let solved = held.solve(best);
    let c = held.whole(&solved);
    // An evaluation of the usual form, filled with the results of this search and the coefficients that
    // are held.
    let mut evaluation = held.objective.evaluate(&p, false);
    evaluation.cost = solved.cost;
    evaluation.solution.residual = solved.residual.clone();
    evaluation.solution.coefficients = c.clone();
    evaluation.solution.active = vec![true; c.len()];
    evaluation.solution.dependent = vec![false; c.len()];
    let optimum = Optimum {
        law,
        elements: Vec::new(),
        p: p.clone(),
        bounds,
        status,
        counts,
        iterations: counts.total(),
        history: Vec::new(),
        delay: false,
        secant: Secant::default(),
        evaluation,
    };
    let mut out = estimate(record, law, terms, &optimum, low_speed);
    held.describe(&p, &c, &solved, &optimum.bounds, &mut out.fitted);
    Ok(out)
}

/// A fit with the steady curve held.
pub(super) struct Held<'a> {
    objective: Objective<'a>,
    statics: &'a Statics,
    law: Law,
    kappa: usize,
    /// Unknowns with the curve filled in.
    p: Vec<f64>,
    c: Vec<f64>,
}

impl<'a> Held<'a> {
    /// On a record of the same axis.
    pub fn new(record: &'a Record, statics: &'a Statics, law: Law, terms: &'a Terms) -> Self {
        Self::of(Objective::new(record, law, terms), statics, law)
    }

    fn of(objective: Objective<'a>, statics: &'a Statics, law: Law) -> Self {
        let (p, c) = statics.unknowns(&law, objective.linear());
        Self {
            kappa: law.layout().kappa.unwrap_or(0),
            objective,
            statics,
            law,
            p,
            c,
        }
    }

    /// Unknowns and coefficients at the minimum next to these unknowns; `None` for a record without motion.
    pub fn found_near(&self, near: &[f64]) -> Option<(Vec<f64>, Vec<f64>, Counts)> {
        let bounds = SearchBox::from_record(self.objective.record(), &self.law).ok()?;
        let range = (bounds.low(self.kappa), bounds.high(self.kappa));
        let near = near.get(self.kappa)?.clamp(range.0, range.1);
        let (best, _, counts) = self.follow(near, range);
        let mut p = self.p.clone();
        p[self.kappa] = best;
        let c = self.whole(&self.solve(best));
        Some((p, c, counts))
    }

    fn free(&self) -> Vec<usize> {
        let linear = self.objective.linear().iter().enumerate();
        linear
            .filter(|(_, t)| !Statics::owns(t))
            .map(|(i, _)| i)
            .collect()
    }

    fn columns(&self, p: &[f64]) -> Vec<Vec<f64>> {
        self.objective.parts(p, &vec![1.0; self.c.len()])
    }

    /// Solves the free linear unknowns for one ln kappa.
    fn solve(&self, kappa: f64) -> Solution {
        let mut p = self.p.clone();
        p[self.kappa] = kappa;
        let columns = self.columns(&p);
        let free = self.free();
        let mut target = self.objective.force().to_vec();
        for (t, f) in target.iter_mut().zip(self.objective.inertia(&p)) {
            *t -= f;
        }
        for (i, column) in columns.iter().enumerate() {
            if !free.contains(&i) {
                for (t, x) in target.iter_mut().zip(column) {
                    *t -= self.c[i] * x;
                }
            }
        }
        let views: Vec<&[f64]> = free.iter().map(|&i| columns[i].as_slice()).collect();
        let bounded: Vec<bool> = free
            .iter()
            .map(|&i| self.objective.linear()[i].is_never_negative())
            .collect();
        linear::solve(&views, &bounded, &target)
    }

    /// All coefficients, held and free.
    fn whole(&self, solved: &Solution) -> Vec<f64> {
        let mut c = self.c.clone();
        for (&i, x) in self.free().iter().zip(&solved.coefficients) {
            c[i] = *x;
        }
        c
    }

    fn search(
        &self,
        bounds: &SearchBox,
        near: Option<f64>,
        observer: &mut dyn Observer,
    ) -> (f64, Status, Counts) {
        let (low, high) = (bounds.low(self.kappa), bounds.high(self.kappa));
        if let Some(near) = near {
            return self.follow(near.clamp(low, high), (low, high));
        }
        let mut counts = Counts::default();
        let mut grid = Vec::with_capacity(GRID_POINTS);
        let mut best = (f64::INFINITY, low);
        for i in 0..GRID_POINTS {
            let x = low + (high - low) * i as f64 / (GRID_POINTS - 1) as f64;
            let cost = self.solve(x).cost;
            grid.push((x, cost));
            counts.costs += 1;
            if cost < best.0 {
                best = (cost, x);
            }
            let control = observer.progress(&Progress {
                stage: Stage::Scan,
                fraction: (i + 1) as f64 / GRID_POINTS as f64,
                counts,
                best: self.objective.relative(best.0),
            });
            if control == Control::Stop {
                return (best.1, Status::Interrupted, counts);
            }
        }
        let mut minima: Vec<usize> = (0..GRID_POINTS)
            .filter(|&i| {
                (i == 0 || grid[i].1 <= grid[i - 1].1)
                    && (i + 1 == GRID_POINTS || grid[i].1 <= grid[i + 1].1)
            })
            .collect();
        minima.sort_by(|&a, &b| grid[a].1.total_cmp(&grid[b].1));
        minima.truncate(FOLLOWED);
        let trials = std::cell::Cell::new(0);
        for i in minima {
            let ends = (
                grid[i.saturating_sub(1)].0,
                grid[(i + 1).min(GRID_POINTS - 1)].0,
            );
            let x = golden(ends, SETTLED_WIDTH, |x| {
                trials.set(trials.get() + 1);
                self.solve(x).cost
            });
            let cost = self.solve(x).cost;
            if cost < best.0 {
                best = (cost, x);
            }
        }
        counts.costs += trials.get() as u64;
        let status = if best.0.is_finite() {
            Status::Converged
        } else {
            Status::Stalled
        };
        (best.1, status, counts)
    }

    /// The minimum next to a place, as far as a place of the grid is from the next.
    fn follow(&self, near: f64, (low, high): (f64, f64)) -> (f64, Status, Counts) {
        let reach = (high - low) / (GRID_POINTS - 1) as f64;
        let ends = ((near - reach).max(low), (near + reach).min(high));
        let trials = std::cell::Cell::new(0);
        let x = golden(ends, SETTLED_WIDTH, |x| {
            trials.set(trials.get() + 1);
            self.solve(x).cost
        });
        let counts = Counts {
            costs: trials.get(),
            ..Counts::default()
        };
        (x, Status::Converged, counts)
    }

    /// Slopes of the model force with `(p, c)`.
    fn jacobian(&self, p: &[f64], c: &[f64]) -> Vec<Vec<f64>> {
        let mut out: Vec<Vec<f64>> = (0..p.len())
            .map(|i| {
                let moved = |by: f64| {
                    let mut p = p.to_vec();
                    p[i] += by;
                    self.objective.model(&p, c)
                };
                let (up, down) = (moved(DIFFERENCE_STEP), moved(-DIFFERENCE_STEP));
                up.iter()
                    .zip(&down)
                    .map(|(a, b)| (a - b) / (2.0 * DIFFERENCE_STEP))
                    .collect()
            })
            .collect();
        out.extend(self.columns(p));
        out
    }

    /// Replaces the parameters of a joint fit by these, with their uncertainty.
    fn describe(
        &self,
        p: &[f64],
        c: &[f64],
        solved: &Solution,
        bounds: &SearchBox,
        out: &mut FittedLaw,
    ) {
        let linear = self.objective.linear();
        let raw = physical(&self.law, linear, self.objective.record().step(), p, c);
        let unknowns = self.covariance(p, c, solved);
        let matrix = propagate(&raw, &unknowns);
        let level = self.statics.sides[0].coulomb;
        let free = self.free();
        let position = |name: Name| {
            let i = linear.iter().position(|t| t.name == name)?;
            free.iter().position(|&j| j == i)
        };
        for (i, found) in raw.iter().enumerate() {
            let kept = self.statics.parameters.iter().find(|p| {
                p.name == found.name
                    && found.name != Quantity::Offset
                    && found.name != Quantity::Mass
            });
            let dynamic = found.name == Quantity::Sigma0 || position(found.name).is_some();
            let parameter = match kept.filter(|_| !dynamic) {
                Some(kept) => kept.clone(),
                None => {
                    let held =
                        position(found.name).map(|j| (solved.active[j], solved.dependent[j]));
                    let reason = match (found.name.quantity, held) {
                        (Quantity::Sigma0, _) if bounds.at_bound(p, self.kappa) => {
                            "is at the bound of its search range"
                        }
                        (_, Some((_, true))) => {
                            "cannot be separated from the other terms on this motion"
                        }
                        (_, Some((false, _))) => "held at zero: the data ask for a negative value",
                        _ => "",
                    };
                    Found {
                        name: found.name,
                        value: found.value,
                        variance: matrix[(i, i)],
                        reason,
                    }
                    .parameter(level, NORMAL_Q95)
                }
            };
            if let Some(place) = out.parameters.iter_mut().find(|p| p.name == found.name) {
                *place = parameter;
            }
        }
        out.covariance = Covariance::new(raw.iter().map(|r| r.name).collect(), &matrix);
    }

    /// Covariance of `(p, c)`: that of the curve, that of the record, and the effect of the curve's
    /// errors on the free unknowns.
    fn covariance(&self, p: &[f64], c: &[f64], solved: &Solution) -> DMatrix<f64> {
        let k = p.len();
        let jacobian = self.jacobian(p, c);
        let width = jacobian.len();
        let mut free = vec![self.kappa];
        let own = self.free();
        free.extend(
            own.iter()
                .enumerate()
                .filter(|(j, _)| solved.active[*j])
                .map(|(_, &i)| k + i),
        );
        let columns: Vec<&[f64]> = free.iter().map(|&i| jacobian[i].as_slice()).collect();
        let breaks = self.objective.record().breaks();
        let small = uncertainty::sandwich(&columns, &solved.residual, &breaks).covariance;
        let slopes = self.statics.slopes(&self.law, self.objective.linear());
        let known = &self.statics.covariance.matrix;
        let known = DMatrix::from_fn(known.len(), known.len(), |i, j| known[i][j]);
        let curve = &slopes * known * slopes.transpose();
        // Change of the free unknowns with those of the curve: -(Jf^T Jf)^-1 Jf^T Js.
        let scale: Vec<f64> = columns
            .iter()
            .map(|c| 1.0 / dot(c, c).sqrt().max(f64::MIN_POSITIVE))
            .collect();
        let n = free.len();
        let gram = DMatrix::from_fn(n, n, |i, j| {
            dot(columns[i], columns[j]) * scale[i] * scale[j]
        });
        let mut answer = DMatrix::zeros(width, width);
        if let Some(factor) = gram.cholesky() {
            for j in (0..width).filter(|j| !free.contains(j) && curve[(*j, *j)] != 0.0) {
                let rhs = DVector::from_fn(n, |i, _| dot(columns[i], &jacobian[j]) * scale[i]);
                let x = factor.solve(&rhs);
                for (i, &to) in free.iter().enumerate() {
                    answer[(to, j)] = -x[i] * scale[i];
                }
            }
        }
        let whole = DMatrix::identity(width, width) + answer;
        let mut out = &whole * curve * whole.transpose();
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate() {
                out[(i, j)] += small[(a, b)];
            }
        }
        out
    }
}
