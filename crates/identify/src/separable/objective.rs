//! Cost and sensitivities of a trial of the nonlinear unknowns, everything linear solved exactly.

use crate::conditioning::record::Record;
use crate::law::Law;
use crate::law::terms::{ColumnKind, LinearTerm, Mass, Terms};
use crate::separable::linear::{self, Solution, dot};
use crate::separable::recursion::{Trace, trace};
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// A record, a law and the linear terms beside it.
#[derive(Clone, Debug)]
pub struct Objective<'a> {
    record: &'a Record,
    law: Law,
    linear: Vec<LinearTerm>,
    nonnegative: Vec<bool>,
    /// Columns that no nonlinear unknown changes, at the kept samples; `None` for those it does.
    fixed: Vec<Option<Vec<f64>>>,
    /// Measured force.
    force: Vec<f64>,
    /// Inertia force of a given mass; empty if it is fitted or absent.
    inertia: Vec<f64>,
    /// What is left to explain: force minus inertia.
    target: Vec<f64>,
    /// Sum of squares of the measured force at the kept samples.
    energy: f64,
    /// A coefficient that is not fitted but held at a value.
    held: Option<(usize, f64)>,
}

/// One trial.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Sum of squares of the residual at the kept samples.
    pub cost: f64,
    pub(crate) solution: Solution,
    /// Columns at the kept samples.
    pub(crate) columns: Vec<Vec<f64>>,
    /// `d(Phi) c` for each nonlinear unknown, at the kept samples; empty without sensitivities.
    pub(crate) slopes: Vec<Vec<f64>>,
    /// `J^T J` of the reduced problem (Kaufman).
    pub(crate) hessian: DMatrix<f64>,
    /// `-J^T r` of the reduced problem: the direction of descent.
    pub(crate) descent: DVector<f64>,
}

impl Evaluation {
    /// Measured minus modelled force at the kept samples.
    pub fn residual(&self) -> &[f64] {
        &self.solution.residual
    }

    /// Columns of the Jacobian of the model at the kept samples: one for each nonlinear unknown, then
    /// one for each linear one that is not held at zero. Without the nonlinear ones where the
    /// evaluation was made without sensitivities.
    pub fn jacobian(&self) -> Vec<&[f64]> {
        let active = self.columns.iter().zip(&self.solution.active);
        self.slopes
            .iter()
            .chain(active.filter_map(|(column, active)| active.then_some(column)))
            .map(Vec::as_slice)
            .collect()
    }
}

impl<'a> Objective<'a> {
    /// The objective of this law with these terms on this record.
    pub fn new(record: &'a Record, law: Law, terms: &Terms) -> Self {
        let linear = terms.columns(&law);
        let fixed = linear
            .iter()
            .map(|term| fixed_column(record, term.column))
            .collect();
        let force = record.gather(|s| &s.force);
        let energy = dot(&force, &force);
        let nonnegative = linear.iter().map(|term| term.nonnegative).collect();
        let inertia: Vec<f64> = match terms.mass {
            Mass::Given(mass) => record
                .gather(|s| &s.acceleration)
                .iter()
                .map(|a| mass * a)
                .collect(),
            Mass::Fitted | Mass::Absent => Vec::new(),
        };
        let target = if inertia.is_empty() {
            force.clone()
        } else {
            force.iter().zip(&inertia).map(|(u, f)| u - f).collect()
        };
        Self {
            record,
            law,
            linear,
            nonnegative,
            fixed,
            force,
            inertia,
            target,
            energy,
            held: None,
        }
    }

    /// The same objective with one coefficient held at a value.
    pub(crate) fn holding(&self, coefficient: usize, value: f64) -> Self {
        let mut out = self.clone();
        out.held = Some((coefficient, value));
        out
    }

    /// The record.
    pub fn record(&self) -> &Record {
        self.record
    }

    /// The law.
    pub fn law(&self) -> &Law {
        &self.law
    }

    pub(crate) fn linear(&self) -> &[LinearTerm] {
        &self.linear
    }

    /// Measured force at the kept samples.
    pub fn force(&self) -> &[f64] {
        &self.force
    }

    /// Sum of squares of the measured force at the kept samples.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// `rms(residual) / rms(measured)` of a cost.
    pub fn relative(&self, cost: f64) -> f64 {
        if self.energy > 0.0 {
            (cost / self.energy).sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// Solves the linear part for the nonlinear unknowns `p` (logarithms, in the order of the law).
    pub fn evaluate(&self, p: &[f64], slopes: bool) -> Evaluation {
        let traces = self.traces(p, slopes);
        let mut columns = self.columns(&traces);
        let target = self.without_held(&mut columns);
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let mut solution = linear::solve(&views, &self.nonnegative, &target);
        if let Some((j, value)) = self.held {
            solution.coefficients[j] = value;
        }
        let k = if slopes { self.law.nonlinear() } else { 0 };
        let mut hessian = DMatrix::zeros(k, k);
        let mut descent = DVector::zeros(k);
        let slope_columns = self.slopes(&traces, k, &solution.coefficients);
        let mut projected: Vec<Vec<f64>> = Vec::with_capacity(k);
        for (i, d) in slope_columns.iter().enumerate() {
            descent[i] = dot(d, &solution.residual);
            let mut outside = d.clone();
            solution.project_out(&views, &mut outside);
            for (j, other) in projected.iter().enumerate() {
                let x = dot(other, &outside);
                hessian[(i, j)] = x;
                hessian[(j, i)] = x;
            }
            hessian[(i, i)] = dot(&outside, &outside);
            projected.push(outside);
        }
        Evaluation {
            cost: solution.cost,
            solution,
            columns,
            slopes: slope_columns,
            hessian,
            descent,
        }
    }

    /// The target without the part of a held coefficient, whose column is emptied so that the linear
    /// problem leaves it out.
    fn without_held(&self, columns: &mut [Vec<f64>]) -> Cow<'_, [f64]> {
        let Some((j, value)) = self.held else {
            return Cow::Borrowed(&self.target);
        };
        let left = self.target.iter().zip(&columns[j]);
        let left = left.map(|(u, x)| u - value * x).collect();
        columns[j].fill(0.0);
        Cow::Owned(left)
    }

    /// `-1/2` times the gradient of the cost with respect to the nonlinear unknowns.
    pub fn descent(&self, p: &[f64]) -> Vec<f64> {
        self.evaluate(p, true).descent.iter().copied().collect()
    }

    /// Inertia force of a given mass at the kept samples; empty if it is fitted or absent.
    pub(crate) fn inertia(&self) -> &[f64] {
        &self.inertia
    }

    /// Model force at the kept samples for given coefficients.
    pub(crate) fn model(&self, p: &[f64], coefficients: &[f64]) -> Vec<f64> {
        let mut out = self.inertia.clone();
        out.resize(self.force.len(), 0.0);
        for part in self.parts(p, coefficients) {
            for (y, x) in out.iter_mut().zip(part) {
                *y += x;
            }
        }
        out
    }

    /// Every term of the model force at the kept samples, in the order of the linear unknowns.
    pub(crate) fn parts(&self, p: &[f64], coefficients: &[f64]) -> Vec<Vec<f64>> {
        let mut parts = self.columns(&self.traces(p, false));
        for (column, c) in parts.iter_mut().zip(coefficients) {
            column.iter_mut().for_each(|x| *x *= c);
        }
        parts
    }

    fn traces(&self, p: &[f64], slopes: bool) -> Vec<Trace> {
        let segments = self.record.segments.iter();
        segments
            .map(|s| trace(&self.law, p, s.step, &s.velocity, slopes))
            .collect()
    }

    /// The columns of the regression at the kept samples.
    fn columns(&self, traces: &[Trace]) -> Vec<Vec<f64>> {
        let mut own = [Vec::new(), Vec::new()];
        for (segment, t) in self.record.segments.iter().zip(traces) {
            // The rate is empty for a static law, and then no column asks for it.
            let full = vec![t.eta.clone(), t.rate.clone()];
            for (out, column) in own.iter_mut().zip(self.record.filtered(segment, full)) {
                out.extend(column);
            }
        }
        let [eta, rate] = own;
        self.linear
            .iter()
            .zip(&self.fixed)
            .map(|(term, fixed)| match (fixed, term.column) {
                (Some(column), _) => column.clone(),
                (None, ColumnKind::Rate) => rate.clone(),
                (None, _) => eta.clone(),
            })
            .collect()
    }

    /// `d(Phi)/dp_i c` of the first `k` unknowns, filtered and thinned like the columns.
    fn slopes(&self, traces: &[Trace], k: usize, coefficients: &[f64]) -> Vec<Vec<f64>> {
        let mut c_eta = 0.0;
        let mut c_rate = 0.0;
        for ((term, fixed), &c) in self.linear.iter().zip(&self.fixed).zip(coefficients) {
            match (fixed, term.column) {
                (None, ColumnKind::Rate) => c_rate += c,
                (None, _) => c_eta += c,
                _ => {}
            }
        }
        let mut out = vec![Vec::with_capacity(self.force.len()); k];
        for (segment, t) in self.record.segments.iter().zip(traces) {
            let full = (0..k)
                .map(|i| {
                    let mut d: Vec<f64> = t.eta_slope[i].iter().map(|x| c_eta * x).collect();
                    if let Some(rate) = t.rate_slope.get(i) {
                        for (x, r) in d.iter_mut().zip(rate) {
                            *x += c_rate * r;
                        }
                    }
                    d
                })
                .collect();
            for (out, column) in out.iter_mut().zip(self.record.filtered(segment, full)) {
                out.extend(column);
            }
        }
        out
    }
}

/// A column that does not depend on the nonlinear unknowns; `None` if it does.
fn fixed_column(record: &Record, column: ColumnKind) -> Option<Vec<f64>> {
    let from_velocity = |f: &dyn Fn(f64) -> f64| {
        let mut out = Vec::with_capacity(record.kept());
        for segment in &record.segments {
            let full = segment.velocity.iter().map(|&v| f(v)).collect();
            out.extend(record.filtered(segment, vec![full]).into_iter().flatten());
        }
        out
    };
    match column {
        ColumnKind::Level | ColumnKind::Rate => None,
        ColumnKind::Sign(side) => Some(from_velocity(&|v| {
            if side.selects(v) { v.signum() } else { 0.0 }
        })),
        ColumnKind::Speed(side) => Some(from_velocity(&|v| match side {
            Some(side) if !side.selects(v) => 0.0,
            _ => v,
        })),
        ColumnKind::Acceleration => Some(record.gather(|s| &s.acceleration)),
        ColumnKind::One => Some(vec![1.0; record.kept()]),
        ColumnKind::Sine(rate) => Some(
            record
                .gather(|s| &s.position)
                .iter()
                .map(|x| libm::sin(rate * x))
                .collect(),
        ),
        ColumnKind::Cosine(rate) => Some(
            record
                .gather(|s| &s.position)
                .iter()
                .map(|x| libm::cos(rate * x))
                .collect(),
        ),
    }
}
