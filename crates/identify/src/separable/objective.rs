//! Cost and sensitivities of a trial of the nonlinear unknowns, everything linear solved exactly.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use crate::conditioning::thinning;
use crate::gms;
use crate::law::Law;
use crate::law::dependence::{Factor, product};
use crate::law::prior::Beside;
use crate::law::terms::{ColumnKind, Delay, LinearTerm, Mass, Side, Terms};
use crate::separable::fixed::{Column, Fixed, fixed_columns};
use crate::separable::in_lanes::InLanes;
use crate::separable::linear::{self, Solution, dot};
use crate::separable::moving::Moving;
use crate::separable::recursion::{Trace, trace};
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};
use stiction_search::Derivatives;
use stiction_signal::Thinning;

/// A record, a law and the linear terms beside it.
#[derive(Clone, Debug)]
pub struct Objective<'a> {
    record: &'a Record,
    law: Law,
    /// What is known of the delay; where it is fitted it is the last nonlinear unknown, in samples.
    delay: Delay,
    /// The lag of the force behind the log, samples.
    lag: f64,
    linear: Vec<LinearTerm>,
    nonnegative: Vec<bool>,
    /// Columns that no parameter of the law changes; `None` for those that one does.
    fixed: Vec<Option<Fixed>>,
    /// Those of them that the delay moves.
    moving: Moving,
    /// Levels that change with another channel: which linear unknown, and the factor at the full
    /// rate of each segment.
    varying: Vec<Varying>,
    /// Measured force.
    force: Cow<'a, [f64]>,
    /// A mass that is given, and the acceleration.
    inertia: Option<(f64, Fixed)>,
    /// Sum of squares of the measured force at the kept samples.
    energy: f64,
    /// The common filter where it is worth computing its output at the kept samples alone.
    thinning: Option<Thinning>,
    /// The record on the batch kernels, where they know the law; made when first needed.
    /// What is known of the law before the record.
    prior: Beside,
    lanes: OnceLock<Option<InLanes>>,
}

/// A column `f(t) eta`, or that of the rate of `eta`.
#[derive(Clone, Debug)]
struct Varying {
    linear: usize,
    of: Varied,
    side: Option<Side>,
    factor: Factor,
    /// The factor at the full rate of each segment.
    factors: Vec<Vec<f64>>,
}

/// What of the law a factor multiplies.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Varied {
    Level,
    Rate,
}

/// One trial.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Sum of squares of the residual at the kept samples.
    pub cost: f64,
    pub(crate) solution: Solution,
    /// Columns at the kept samples.
    pub(crate) columns: Vec<Column>,
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
            .chain(active.filter_map(|(column, active)| active.then_some(&**column)))
            .map(Vec::as_slice)
            .collect()
    }

    /// What a step of the search needs to know of it.
    pub(crate) fn reduced(&self) -> Derivatives {
        Derivatives {
            cost: self.cost,
            gradient: self.descent.iter().map(|d| -d).collect(),
            // Symmetric to the bit, so rows are columns.
            normal: self.hessian.as_slice().to_vec(),
        }
    }
}

impl<'a> Objective<'a> {
    /// The objective of this law with these terms on this record.
    pub fn new(record: &'a Record, law: Law, terms: &Terms) -> Self {
        let linear = terms.columns(&law);
        // Elements change between stick and slip at instants between samples that a shift cannot represent.
        let delay = match terms.delay {
            Delay::Fitted if law.kind.has_elements() => Delay::NONE,
            delay => delay,
        };
        let lengths = record.segments.iter().map(|s| s.velocity.len());
        let thinning = thinning(
            record.common.as_ref(),
            record.decimate,
            lengths.max().unwrap_or(0),
        );
        let known = match delay {
            Delay::Fitted => None,
            Delay::Given(time) => Some(given(time, record)),
        };
        // That of a delay that is given is no part of it.
        let lag = match delay {
            Delay::Fitted => terms.lag.time() / record.step(),
            Delay::Given(_) => 0.0,
        };
        let mut kinds: Vec<ColumnKind> = linear.iter().map(|term| term.column).collect();
        if let Mass::Given(_) = terms.mass {
            kinds.push(ColumnKind::Acceleration);
        }
        let (mut fixed, moving) = fixed_columns(record, &kinds, known, thinning.as_ref());
        let inertia = match terms.mass {
            Mass::Given(mass) => fixed.pop().flatten().map(|a| (mass, a)),
            Mass::Fitted | Mass::Absent => None,
        };
        let varying = linear
            .iter()
            .enumerate()
            .filter_map(|(i, term)| {
                let (of, factor, side) = match term.column {
                    ColumnKind::LevelTimes(factor, side) => (Varied::Level, factor, side),
                    ColumnKind::RateTimes(factor) => (Varied::Rate, factor, None),
                    _ => return None,
                };
                Some(Varying {
                    linear: i,
                    of,
                    side,
                    factor,
                    factors: record.segments.iter().map(|s| factor.along(s)).collect(),
                })
            })
            .collect();
        let force = record.whole(|s| &s.force);
        let energy = dot(&force, &force);
        let nonnegative = linear.iter().map(|term| term.is_never_negative()).collect();
        Self {
            record,
            law,
            delay,
            lag,
            linear,
            nonnegative,
            fixed,
            moving,
            varying,
            force,
            inertia,
            energy,
            thinning,
            prior: terms
                .prior
                .map(|prior| prior.beside(&law))
                .unwrap_or_default(),
            lanes: OnceLock::new(),
        }
    }

    /// The record on the batch kernels, where they know the law.
    fn lanes(&self) -> Option<&InLanes> {
        let made = self.lanes.get_or_init(|| {
            let still = self.delay == Delay::NONE;
            let directed = self.law.layout().ratio.is_some();
            if self.record.common.is_some() || directed || !still || !self.varying.is_empty() {
                return InLanes::motion(self.record, &self.law);
            }
            let target = self.target(Shift::NONE);
            let columns: Vec<Option<&[f64]>> = self
                .fixed
                .iter()
                .map(|column| match column {
                    Some(Fixed::Thin(thin)) => Some(thin.as_slice()),
                    _ => None,
                })
                .collect();
            InLanes::regression(self.record, &self.law, &self.linear, &target, &columns)
                .map(|lanes| lanes.beside(self.prior.clone()))
        });
        made.as_ref()
    }

    /// The batch kernels, where the reduced problem follows from their sums: neither a filter nor a delay
    /// stands between the law and the regression, and no level changes with another channel.
    pub(crate) fn sums(&self) -> Option<&InLanes> {
        self.lanes().filter(|lanes| lanes.sums())
    }

    /// Number of nonlinear unknowns: those of the law, and the delay where it is one.
    pub fn nonlinear(&self) -> usize {
        self.law.nonlinear() + usize::from(self.delay == Delay::Fitted)
    }

    /// What is known of the law before the record.
    pub(crate) fn prior(&self) -> &Beside {
        &self.prior
    }

    /// Whether the delay is an unknown.
    pub(crate) fn is_delayed(&self) -> bool {
        self.delay == Delay::Fitted
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

    /// Which coefficients must not be negative.
    pub(crate) fn nonnegative(&self) -> &[bool] {
        &self.nonnegative
    }

    /// What the columns are fitted to: the measured force at the kept samples without the inertia force of a given mass.
    pub(crate) fn target_at(&self, p: &[f64]) -> Cow<'_, [f64]> {
        self.target(self.shift(p))
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
        let mut traces = self.traces(p, slopes);
        let shift = self.shift(p);
        let columns = self.columns(&mut traces, shift, Moved::Value);
        let target = self.target(shift);
        let views: Vec<&[f64]> = columns.iter().map(|column| column.as_slice()).collect();
        let solution = linear::solve(&views, &self.nonnegative, &target);
        let slope_columns = if slopes {
            self.slopes(&mut traces, p, &solution.coefficients)
        } else {
            Vec::new()
        };
        let mut hessian = solution.curvature(&views, &slope_columns);
        let descent = slope_columns.iter().map(|d| dot(d, &solution.residual));
        let mut descent = DVector::from_iterator(slope_columns.len(), descent);
        if slopes {
            for (i, weight, pull) in self.prior.pulls(p) {
                hessian[(i, i)] += weight;
                descent[i] += pull;
            }
        }
        Evaluation {
            cost: solution.cost + self.prior.cost(p),
            solution,
            columns,
            slopes: slope_columns,
            hessian,
            descent,
        }
    }

    /// The measured force without the inertia force of a given mass.
    fn target(&self, shift: Shift) -> Cow<'_, [f64]> {
        match self.inertia_force(shift) {
            Some(inertia) => Cow::Owned(difference(&self.force, &inertia)),
            None => Cow::Borrowed(&self.force[..]),
        }
    }

    /// The cost alone, from sums where possible, with their lower precision.
    pub(crate) fn cost(&self, p: &[f64]) -> f64 {
        let summed = self.sums().and_then(|sums| sums.reduced(p));
        summed.map_or_else(|| self.evaluate(p, false).cost, |reduced| reduced.cost)
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

    /// The columns of the regression at the kept samples.
    pub(crate) fn columns_at(&self, p: &[f64]) -> Vec<Column> {
        self.columns(&mut self.traces(p, false), self.shift(p), Moved::Value)
    }

    /// The columns of the regression at the kept samples, and the derivatives of the model by the nonlinear unknowns.
    pub(crate) fn linearised(
        &self,
        p: &[f64],
        coefficients: &[f64],
    ) -> (Vec<Column>, Vec<Vec<f64>>) {
        let mut traces = self.traces(p, true);
        let columns = self.columns(&mut traces, self.shift(p), Moved::Value);
        (columns, self.slopes(&mut traces, p, coefficients))
    }

    /// Every term of the model force at the kept samples, in the order of the linear unknowns.
    pub(crate) fn parts(&self, p: &[f64], coefficients: &[f64]) -> Vec<Vec<f64>> {
        let columns = self.columns_at(p);
        let scaled = |(column, c): (&Column, &f64)| column.iter().map(|x| x * c).collect();
        columns.iter().zip(coefficients).map(scaled).collect()
    }

    /// Moving mass, given or fitted, in the unit of the force; `None` where there is none.
    pub(crate) fn mass(&self, coefficients: &[f64]) -> Option<f64> {
        if let Some((mass, _)) = &self.inertia {
            return Some(*mass);
        }
        let mut terms = self.linear.iter().zip(coefficients);
        let found = terms.find(|(term, _)| term.column == ColumnKind::Acceleration);
        found.map(|(_, c)| *c)
    }

    /// By how much earlier in the log the motion is that belongs to a force.
    pub(crate) fn shift(&self, p: &[f64]) -> Shift {
        match (self.delay, p.last()) {
            (Delay::Fitted, Some(&samples)) => Shift::before_lag(samples, self.lag),
            (Delay::Fitted, None) => Shift::NONE,
            (Delay::Given(time), _) => given(time, self.record),
        }
    }

    fn inertia_force(&self, shift: Shift) -> Option<Vec<f64>> {
        let (mass, acceleration) = self.inertia.as_ref()?;
        let acceleration = self.at(acceleration, shift);
        Some(acceleration.iter().map(|a| a * mass).collect())
    }

    /// A known column at the kept samples.
    fn at(&self, column: &Fixed, shift: Shift) -> Column {
        match column {
            Fixed::Thin(thin) => Arc::clone(thin),
            Fixed::Moving(i) => self
                .moving
                .at(*i, self.record, shift, self.thinning.as_ref()),
        }
    }

    /// Full-rate columns of a segment, filtered, at the kept samples, for each shift.
    fn filtered(&self, segment: &Segment, full: &[&[f64]], shifts: &[Shift]) -> Vec<Vec<Vec<f64>>> {
        let thinning = self.thinning.as_ref();
        self.record.filtered(segment, full, shifts, thinning)
    }

    fn traces(&self, p: &[f64], slopes: bool) -> Vec<Run> {
        // In the order of `Moved`.
        let mut shifts = vec![self.shift(p)];
        if slopes && self.delay == Delay::Fitted {
            shifts.push(Shift::slope(p.last().copied().unwrap_or(0.0), self.lag));
        }
        self.traces_at(p, slopes, &shifts)
    }

    /// The law along the record, its columns read at each of some shifts.
    fn traces_at(&self, p: &[f64], slopes: bool, shifts: &[Shift]) -> Vec<Run> {
        let p = &p[..self.law.nonlinear()];
        let segments = &self.record.segments;
        // Where the factor of eta is the same for all samples, the kernels weight the derivatives while
        // computing them.
        let in_lanes = self.lanes().and_then(|lanes| {
            let apart = slopes && !self.varying.is_empty();
            lanes.traces(p, apart)
        });
        let traces = in_lanes.unwrap_or_else(|| {
            let along = |s: &Segment| trace(&self.law, p, s.step, &s.velocity, slopes);
            segments.iter().map(along).collect()
        });
        traces
            .into_iter()
            .enumerate()
            .map(|(i, trace)| {
                let times = |v: &Varying| {
                    let of = match v.of {
                        Varied::Level => &trace.eta,
                        Varied::Rate => &trace.rate,
                    };
                    product(of, (&v.factor, &v.factors[i]), v.side)
                };
                let varying: Vec<Vec<f64>> = self.varying.iter().map(times).collect();
                let mut run = Run {
                    trace,
                    varying,
                    kept: None,
                };
                if self.record.common.is_some() {
                    let full: Vec<&[f64]> = run.all().map(Vec::as_slice).collect();
                    run.kept = Some(self.filtered(&segments[i], &full, shifts));
                }
                run
            })
            .collect()
    }

    /// The columns of the regression at the kept samples.
    fn columns(&self, runs: &mut [Run], shift: Shift, moved: Moved) -> Vec<Column> {
        // Whether eta is needed again, besides being a column itself.
        let again = !self.varying.is_empty() || self.delay == Delay::Fitted;
        let gather = |runs: &[Run], column: usize| {
            let mut out = Vec::with_capacity(self.force.len());
            for (segment, run) in self.record.segments.iter().zip(runs) {
                match &run.kept {
                    Some(kept) => {
                        let shifts = kept.get(column).into_iter();
                        let values = shifts.flat_map(|shifts| shifts.get(moved as usize));
                        values.for_each(|x| out.extend_from_slice(x));
                    }
                    None => {
                        if let Some(full) = run.all().nth(column) {
                            self.record.thin(segment, full, shift, &mut out);
                        }
                    }
                }
            }
            Arc::new(out)
        };
        let own = |runs: &mut [Run], column: usize| match (&self.record.segments[..], runs) {
            ([segment], [run]) if !again && run.kept.is_none() => {
                let mut out = Vec::new();
                let full = run.take(column);
                self.record.thin_whole(segment, full, shift, &mut out);
                Arc::new(out)
            }
            (_, runs) => gather(runs, column),
        };
        // They were made in the order of the linear unknowns.
        let mut next = 0..;
        self.linear
            .iter()
            .zip(&self.fixed)
            .map(|(term, fixed)| match (fixed, term.column) {
                // The derivative of a constant.
                (Some(_), ColumnKind::One) if moved == Moved::Slope => {
                    Arc::new(vec![0.0; self.force.len()])
                }
                (Some(column), _) => self.at(column, shift),
                (None, ColumnKind::Rate) => own(runs, 1),
                (None, ColumnKind::Element(k)) => own(runs, 2 + k),
                (None, ColumnKind::LevelTimes(..) | ColumnKind::RateTimes(_)) => {
                    let k = next.next().unwrap_or_default();
                    let own = runs.first().map_or(0, |run| run.trace.own().count());
                    gather(runs, own + k)
                }
                (None, _) => own(runs, 0),
            })
            .collect()
    }

    /// `d(Phi)/dp_i c` of every nonlinear unknown, filtered and thinned like the columns. The derivatives
    /// of the law are consumed.
    fn slopes(&self, runs: &mut [Run], p: &[f64], coefficients: &[f64]) -> Vec<Vec<f64>> {
        let mut c_eta = 0.0;
        let mut c_rate = 0.0;
        for ((term, fixed), &c) in self.linear.iter().zip(&self.fixed).zip(coefficients) {
            match (fixed, term.column) {
                (None, ColumnKind::Rate) => c_rate += c,
                // Depends on the sample: see below.
                (None, ColumnKind::LevelTimes(..) | ColumnKind::RateTimes(_)) | (Some(_), _) => {}
                (None, _) => c_eta += c,
            }
        }
        let k = self.law.nonlinear();
        let shift = self.shift(p);
        let weighed = self
            .lanes()
            .filter(|_| self.varying.is_empty())
            .and_then(|lanes| lanes.slopes(&p[..k], [c_eta, c_rate]));
        let mut weighed = weighed.into_iter().flatten();
        let mut out = vec![Vec::new(); k];
        for (s, (segment, run)) in self.record.segments.iter().zip(&mut *runs).enumerate() {
            let t = &mut run.trace;
            let full = if let Some(full) = weighed.next() {
                full
            } else if self.law.kind.has_elements() {
                let slope = |i| gms::recursion::slope(&t.elements, i, coefficients);
                (0..k).map(slope).collect()
            } else {
                let level = self.factor(Varied::Level, s, &t.eta, c_eta, coefficients);
                let damping = self.factor(Varied::Rate, s, &t.eta, c_rate, coefficients);
                let mut full = std::mem::take(&mut t.eta_slope);
                let mut rates = t.rate_slope.iter();
                for d in &mut full {
                    match &level {
                        None => d.iter_mut().for_each(|x| *x *= c_eta),
                        Some(level) => d.iter_mut().zip(level).for_each(|(x, c)| *x *= c),
                    }
                    let rate = rates.next().into_iter().flatten();
                    match &damping {
                        None => d.iter_mut().zip(rate).for_each(|(x, r)| *x += c_rate * r),
                        Some(damping) => {
                            let rate = rate.zip(damping);
                            d.iter_mut().zip(rate).for_each(|(x, (r, c))| *x += c * r);
                        }
                    }
                }
                full
            };
            if self.record.common.is_some() {
                let full: Vec<&[f64]> = full.iter().map(Vec::as_slice).collect();
                let kept = self.filtered(segment, &full, &[shift]);
                for (out, column) in out.iter_mut().zip(kept.into_iter().flatten()) {
                    match out.is_empty() {
                        true => *out = column,
                        false => out.extend(column),
                    }
                }
                continue;
            }
            for (out, column) in out.iter_mut().zip(full) {
                self.record.thin_whole(segment, column, shift, out);
            }
        }
        if self.delay == Delay::Fitted {
            out.push(self.delay_slope(runs, p, coefficients));
        }
        out
    }

    /// Derivative of the model with respect to the delay, per sample.
    fn delay_slope(&self, runs: &mut [Run], p: &[f64], coefficients: &[f64]) -> Vec<f64> {
        let slope = Shift::slope(p.last().copied().unwrap_or(0.0), self.lag);
        self.derived(runs, slope, coefficients)
    }

    /// Derivative of the model with respect to the square of the lag, per square of a sample.
    pub(crate) fn bend(&self, p: &[f64], coefficients: &[f64]) -> Vec<f64> {
        let bend = Shift::bend(p.last().copied().unwrap_or(0.0), self.lag);
        let mut runs = self.traces_at(p, false, &[self.shift(p), bend]);
        self.derived(&mut runs, bend, coefficients)
    }

    /// The model read by a derivative of its shift.
    fn derived(&self, runs: &mut [Run], slope: Shift, coefficients: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.force.len()];
        let mut add = |c: f64, column: &[f64]| {
            for (y, x) in out.iter_mut().zip(column) {
                *y += c * x;
            }
        };
        let columns = self.columns(&mut *runs, slope, Moved::Slope);
        for (column, &c) in columns.iter().zip(coefficients) {
            add(c, column);
        }
        if let Some(inertia) = self.inertia_force(slope) {
            add(1.0, &inertia);
        }
        out
    }

    /// The factor of `eta`, or of its rate, at each sample of a segment; `None` where it is this constant.
    fn factor(
        &self,
        of: Varied,
        segment: usize,
        eta: &[f64],
        constant: f64,
        c: &[f64],
    ) -> Option<Vec<f64>> {
        let mut all = self.varying.iter().filter(|v| v.of == of).peekable();
        all.peek()?;
        let mut out = vec![constant; eta.len()];
        for varying in all {
            let factors = &varying.factors[segment];
            for ((out, f), &eta) in out.iter_mut().zip(factors).zip(eta) {
                *out += c[varying.linear] * varying.factor.of(*f, eta, varying.side);
            }
        }
        Some(out)
    }

    /// For each linear unknown, the size of its column in use: the coefficient times this compares with
    /// the Coulomb level.
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
    /// The levels that change with another channel, at the full rate.
    varying: Vec<Vec<f64>>,
    /// Where there is a common filter: each column of [`all`](Self::all) after it at the kept samples, for each shift.
    kept: Option<Vec<Vec<Vec<f64>>>>,
}

/// Which of the shifts that the columns of a run were read at.
#[derive(Clone, Copy, PartialEq)]
enum Moved {
    /// By the delay.
    Value,
    /// The derivative with respect to the delay.
    Slope,
}

impl Run {
    /// The columns that the law makes at the full rate: `eta` (0), its rate (1), the elements, and then the levels that
    /// change with another channel.
    fn all(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.trace.own().chain(&self.varying)
    }

    /// A column of the law; other than an element it is moved out and is empty afterwards.
    fn take(&mut self, column: usize) -> Vec<f64> {
        match column {
            0 => std::mem::take(&mut self.trace.eta),
            1 => std::mem::take(&mut self.trace.rate),
            _ => self.trace.own().nth(column).cloned().unwrap_or_default(),
        }
    }
}

/// By how much earlier the motion is for a delay that is given, s.
fn given(time: f64, record: &Record) -> Shift {
    match time == 0.0 {
        true => Shift::NONE,
        false => Shift::earlier(time / record.step()),
    }
}

fn difference(from: &[f64], part: &[f64]) -> Vec<f64> {
    from.iter().zip(part).map(|(u, x)| u - x).collect()
}
