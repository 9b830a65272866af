//! Cost and sensitivities of a trial of the nonlinear unknowns, everything linear solved exactly.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use crate::gms;
use crate::law::Law;
use crate::law::dependence::product;
use crate::law::terms::{ColumnKind, Delay, LinearTerm, Mass, Side, Terms};
use crate::separable::linear::{self, Solution, dot};
use crate::separable::recursion::{Trace, trace};
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// A record, a law and the linear terms beside it.
#[derive(Clone, Debug)]
pub struct Objective<'a> {
    record: &'a Record,
    law: Law,
    /// What is known of the delay; where it is fitted it is the last nonlinear unknown, in samples.
    delay: Delay,
    linear: Vec<LinearTerm>,
    nonnegative: Vec<bool>,
    /// Columns that no parameter of the law changes; `None` for those that one does.
    fixed: Vec<Option<Fixed>>,
    /// Levels that change with another channel: which linear unknown, and the factor at the full
    /// rate of each segment.
    varying: Vec<Varying>,
    /// Measured force.
    force: Vec<f64>,
    /// A mass that is given, and the acceleration.
    inertia: Option<(f64, Fixed)>,
    /// Sum of squares of the measured force at the kept samples.
    energy: f64,
    /// A coefficient that is not fitted but held at a value.
    held: Option<(usize, f64)>,
}

/// A known column of the regression.
#[derive(Clone, Debug)]
enum Fixed {
    /// At the kept samples: without a delay it never changes.
    Thin(Vec<f64>),
    /// At the full rate, filtered, for each segment: a delay moves it.
    Full(Vec<Vec<f64>>),
}

/// A column `f(t) eta`.
#[derive(Clone, Debug)]
struct Varying {
    linear: usize,
    side: Option<Side>,
    factors: Vec<Vec<f64>>,
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
        // Elements stick and slip at instants that a shift would move between samples.
        let delay = match terms.delay {
            Delay::Fitted if law.kind.has_elements() => Delay::NONE,
            delay => delay,
        };
        let moves = delay != Delay::NONE;
        let fixed = linear
            .iter()
            .map(|term| fixed_column(record, term.column, moves))
            .collect();
        let varying = linear
            .iter()
            .enumerate()
            .filter_map(|(i, term)| match term.column {
                ColumnKind::LevelTimes(factor, side) => Some(Varying {
                    linear: i,
                    side,
                    factors: record.segments.iter().map(|s| factor.along(s)).collect(),
                }),
                _ => None,
            })
            .collect();
        let force = record.gather(|s| &s.force);
        let energy = dot(&force, &force);
        let nonnegative = linear.iter().map(|term| term.nonnegative).collect();
        let inertia = match terms.mass {
            Mass::Given(mass) => {
                fixed_column(record, ColumnKind::Acceleration, moves).map(|a| (mass, a))
            }
            Mass::Fitted | Mass::Absent => None,
        };
        Self {
            record,
            law,
            delay,
            linear,
            nonnegative,
            fixed,
            varying,
            force,
            inertia,
            energy,
            held: None,
        }
    }

    /// Number of nonlinear unknowns: those of the law, and the delay where it is one.
    pub fn nonlinear(&self) -> usize {
        self.law.nonlinear() + usize::from(self.delay == Delay::Fitted)
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

    /// Solves the linear part for the nonlinear unknowns `p`: logarithms in the order of the law, then
    /// the delay in samples where it is unknown.
    pub fn evaluate(&self, p: &[f64], slopes: bool) -> Evaluation {
        let traces = self.traces(p, slopes);
        let shift = self.shift(p);
        let mut columns = self.columns(&traces, shift);
        let target = self.without_held(&mut columns, shift);
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let mut solution = linear::solve(&views, &self.nonnegative, &target);
        if let Some((j, value)) = self.held {
            solution.coefficients[j] = value;
        }
        let slope_columns = if slopes {
            self.slopes(&traces, p, &solution.coefficients)
        } else {
            Vec::new()
        };
        let k = slope_columns.len();
        let mut hessian = DMatrix::zeros(k, k);
        let mut descent = DVector::zeros(k);
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
    fn without_held(&self, columns: &mut [Vec<f64>], shift: Shift) -> Cow<'_, [f64]> {
        let minus = |from: &[f64], part: &[f64]| -> Vec<f64> {
            from.iter().zip(part).map(|(u, x)| u - x).collect()
        };
        let mut target = match self.inertia_force(shift) {
            Some(inertia) => Cow::Owned(minus(&self.force, &inertia)),
            None => Cow::Borrowed(&self.force[..]),
        };
        if let Some((j, value)) = self.held {
            columns[j].iter_mut().for_each(|x| *x *= value);
            target = Cow::Owned(minus(&target, &columns[j]));
            columns[j].fill(0.0);
        }
        target
    }

    /// `-1/2` times the gradient of the cost with respect to the nonlinear unknowns.
    pub fn descent(&self, p: &[f64]) -> Vec<f64> {
        self.evaluate(p, true).descent.iter().copied().collect()
    }

    /// Inertia force of a given mass at the kept samples; empty if it is fitted or absent.
    pub(crate) fn inertia(&self, p: &[f64]) -> Vec<f64> {
        self.inertia_force(self.shift(p)).unwrap_or_default()
    }

    /// Model force at the kept samples for given coefficients.
    pub(crate) fn model(&self, p: &[f64], coefficients: &[f64]) -> Vec<f64> {
        let mut out = self.inertia(p);
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
        let mut parts = self.columns(&self.traces(p, false), self.shift(p));
        for (column, c) in parts.iter_mut().zip(coefficients) {
            column.iter_mut().for_each(|x| *x *= c);
        }
        parts
    }

    /// How much earlier the motion stands that belongs to a force.
    fn shift(&self, p: &[f64]) -> Shift {
        match (self.delay, p.last()) {
            (Delay::Fitted, Some(&samples)) => Shift::earlier(samples),
            (Delay::Fitted, None) => Shift::NONE,
            (Delay::Given(0.0), _) => Shift::NONE,
            (Delay::Given(time), _) => Shift::earlier(time / self.record.step()),
        }
    }

    fn inertia_force(&self, shift: Shift) -> Option<Vec<f64>> {
        let (mass, acceleration) = self.inertia.as_ref()?;
        let mut force = self.at(acceleration, shift);
        force.iter_mut().for_each(|a| *a *= mass);
        Some(force)
    }

    /// A known column at the kept samples.
    fn at(&self, column: &Fixed, shift: Shift) -> Vec<f64> {
        match column {
            Fixed::Thin(thin) => thin.clone(),
            Fixed::Full(full) => {
                let mut out = Vec::with_capacity(self.force.len());
                for (segment, full) in self.record.segments.iter().zip(full) {
                    self.record.thin(segment, full, shift, &mut out);
                }
                out
            }
        }
    }

    fn traces(&self, p: &[f64], slopes: bool) -> Vec<Run> {
        let p = &p[..self.law.nonlinear()];
        let segments = self.record.segments.iter().enumerate();
        segments
            .map(|(i, s)| {
                let trace = trace(&self.law, p, s.step, &s.velocity, slopes);
                // The rate is empty for a static law, and then no column asks for it.
                let mut columns = vec![trace.eta.clone(), trace.rate.clone()];
                columns.extend(trace.elements.iter().map(|e| e.level.clone()));
                for varying in &self.varying {
                    columns.push(product(&trace.eta, &varying.factors[i], varying.side));
                }
                self.record.filter(&mut columns);
                Run { trace, columns }
            })
            .collect()
    }

    /// The columns of the regression at the kept samples.
    fn columns(&self, runs: &[Run], shift: Shift) -> Vec<Vec<f64>> {
        let own = |column: usize| {
            let mut out = Vec::with_capacity(self.force.len());
            for (segment, run) in self.record.segments.iter().zip(runs) {
                self.record
                    .thin(segment, &run.columns[column], shift, &mut out);
            }
            out
        };
        // They were made in the order of the linear unknowns, after the elements.
        let mut next = 2 + runs.first().map_or(0, |run| run.trace.elements.len())..;
        self.linear
            .iter()
            .zip(&self.fixed)
            .map(|(term, fixed)| match (fixed, term.column) {
                (Some(column), _) => self.at(column, shift),
                (None, ColumnKind::Rate) => own(1),
                (None, ColumnKind::Element(k)) => own(2 + k),
                (None, ColumnKind::LevelTimes(..)) => next.next().map(&own).unwrap_or_default(),
                (None, _) => own(0),
            })
            .collect()
    }

    /// `d(Phi)/dp_i c` of every nonlinear unknown, filtered and thinned like the columns.
    fn slopes(&self, runs: &[Run], p: &[f64], coefficients: &[f64]) -> Vec<Vec<f64>> {
        let mut c_eta = 0.0;
        let mut c_rate = 0.0;
        for ((term, fixed), &c) in self.linear.iter().zip(&self.fixed).zip(coefficients) {
            match (fixed, term.column) {
                (None, ColumnKind::Rate) => c_rate += c,
                // Different at each sample: see below.
                (None, ColumnKind::LevelTimes(..)) | (Some(_), _) => {}
                (None, _) => c_eta += c,
            }
        }
        let k = self.law.nonlinear();
        let shift = self.shift(p);
        let mut out = vec![Vec::with_capacity(self.force.len()); k];
        for (s, (segment, run)) in self.record.segments.iter().zip(runs).enumerate() {
            let t = &run.trace;
            let level = self.level(s, &t.eta, c_eta, coefficients);
            let mut full: Vec<Vec<f64>> = (0..k)
                .map(|i| {
                    if self.law.kind.has_elements() {
                        return gms::recursion::slope(&t.elements, i, coefficients);
                    }
                    let slope = t.eta_slope[i].iter();
                    let mut d: Vec<f64> = match &level {
                        None => slope.map(|x| c_eta * x).collect(),
                        Some(level) => slope.zip(level).map(|(x, c)| c * x).collect(),
                    };
                    if let Some(rate) = t.rate_slope.get(i) {
                        for (x, r) in d.iter_mut().zip(rate) {
                            *x += c_rate * r;
                        }
                    }
                    d
                })
                .collect();
            self.record.filter(&mut full);
            for (out, column) in out.iter_mut().zip(&full) {
                self.record.thin(segment, column, shift, out);
            }
        }
        if self.delay == Delay::Fitted {
            out.push(self.delay_slope(runs, p, coefficients));
        }
        out
    }

    /// Derivative of the model with respect to the delay, per sample.
    fn delay_slope(&self, runs: &[Run], p: &[f64], coefficients: &[f64]) -> Vec<f64> {
        let slope = Shift::slope(p.last().copied().unwrap_or(0.0));
        let mut out = vec![0.0; self.force.len()];
        let mut add = |c: f64, column: Vec<f64>| {
            for (y, x) in out.iter_mut().zip(column) {
                *y += c * x;
            }
        };
        for (column, &c) in self.columns(runs, slope).into_iter().zip(coefficients) {
            add(c, column);
        }
        if let Some(inertia) = self.inertia_force(slope) {
            add(1.0, inertia);
        }
        out
    }

    /// What multiplies `eta` at each sample of a segment; `None` where nothing but `c_eta` does.
    fn level(&self, segment: usize, eta: &[f64], c_eta: f64, c: &[f64]) -> Option<Vec<f64>> {
        if self.varying.is_empty() {
            return None;
        }
        let mut level = vec![c_eta; eta.len()];
        for varying in &self.varying {
            let factors = &varying.factors[segment];
            for ((level, f), &eta) in level.iter_mut().zip(factors).zip(eta) {
                if varying.side.is_none_or(|side| side.selects(eta)) {
                    *level += c[varying.linear] * f;
                }
            }
        }
        Some(level)
    }

    /// For each linear unknown, how large its column is in use: the coefficient times this compares
    /// with the Coulomb level.
    pub(crate) fn spans(&self) -> Vec<f64> {
        let top = self.record.top_speed();
        self.linear
            .iter()
            .map(|term| match term.column {
                ColumnKind::Square(_) => top * top,
                ColumnKind::LevelTimes(factor, _) => factor.span(self.record),
                ColumnKind::SpeedTimes(factor, _) => top * factor.span(self.record),
                _ => 1.0,
            })
            .collect()
    }
}

/// The law along one segment.
struct Run {
    trace: Trace,
    /// The columns that the law makes, filtered, at the full rate: `eta`, its rate, the elements, and
    /// the levels that change with another channel.
    columns: Vec<Vec<f64>>,
}

/// A column that does not depend on the parameters of the law; `None` if it does.
fn fixed_column(record: &Record, column: ColumnKind, moves: bool) -> Option<Fixed> {
    let each = |f: &dyn Fn(&Segment) -> Vec<f64>| -> Vec<Vec<f64>> {
        record.segments.iter().map(f).collect()
    };
    let of = |x: &[f64], f: &dyn Fn(f64) -> f64| -> Vec<f64> { x.iter().map(|&x| f(x)).collect() };
    let one_way = |side: Option<Side>, v: f64| match side {
        Some(side) if !side.selects(v) => 0.0,
        _ => v,
    };
    let mut full = match column {
        ColumnKind::Level
        | ColumnKind::Element(_)
        | ColumnKind::Rate
        | ColumnKind::LevelTimes(..) => return None,
        ColumnKind::Sign(side) => each(&|s| {
            of(&s.velocity, &|v| {
                if side.selects(v) { v.signum() } else { 0.0 }
            })
        }),
        ColumnKind::Speed(side) => each(&|s| of(&s.velocity, &|v| one_way(side, v))),
        ColumnKind::Square(side) => each(&|s| of(&s.velocity, &|v| one_way(side, v) * v.abs())),
        ColumnKind::SpeedTimes(factor, side) => each(&|s| {
            let velocity = s.velocity.iter().map(|&v| one_way(side, v));
            velocity.zip(factor.along(s)).map(|(v, f)| v * f).collect()
        }),
        ColumnKind::Acceleration => each(&|s| s.acceleration.clone()),
        ColumnKind::One if !moves => return Some(Fixed::Thin(vec![1.0; record.kept()])),
        ColumnKind::One => each(&|s| vec![1.0; s.velocity.len()]),
        ColumnKind::Sine(rate) => each(&|s| of(&s.position, &|x| libm::sin(rate * x))),
        ColumnKind::Cosine(rate) => each(&|s| of(&s.position, &|x| libm::cos(rate * x))),
    };
    for column in &mut full {
        record.filter([column]);
    }
    if moves {
        return Some(Fixed::Full(full));
    }
    let mut thin = Vec::with_capacity(record.kept());
    for (segment, full) in record.segments.iter().zip(&full) {
        record.thin(segment, full, Shift::NONE, &mut thin);
    }
    Some(Fixed::Thin(thin))
}
