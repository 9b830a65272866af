//! Cost and normal equations of a trial, with the unknowns of each run kept separate from the shared ones.

use crate::output_error::plant::Axis;
use crate::output_error::run::{self, Run};
use crate::output_error::simulate::{Drive, Initial, periods, simulate, simulate_with_slopes};
use crate::output_error::unknowns::{LOCALS, Layout, MOST};
use crate::watch::Watch;
use nalgebra::{DMatrix, DVector, Matrix4, Vector4};
use stiction_search::Derivatives;

/// Runs, unknowns, and the weights of the residuals.
#[derive(Clone, Debug)]
pub(crate) struct Problem<'a> {
    pub runs: &'a [Run],
    pub layout: Layout,
    /// What is given, and where the search starts.
    pub base: Axis,
    pub drive: Drive<'a>,
    /// Weights of the position residual and of the force residual; force only in closed loop.
    pub weights: [f64; 2],
}

/// A trial: shared unknowns and the start of each run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Point {
    pub q: Vec<f64>,
    pub starts: Vec<Initial>,
}

/// `J^T J` and `J^T r` of one run, as far as its own unknowns are concerned.
#[derive(Clone, Debug)]
pub(crate) struct OwnPart {
    /// Shared unknowns by own unknowns.
    pub mixed: DMatrix<f64>,
    pub own: Matrix4<f64>,
    pub descent: Vector4<f64>,
}

/// A trial with its derivatives. Residuals are measured minus simulated.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    pub cost: f64,
    pub shared: DMatrix<f64>,
    pub descent: DVector<f64>,
    pub runs: Vec<OwnPart>,
}

/// Plant steps between two looks at the observer: a twentieth of a second or so with derivatives.
const STEPS_BETWEEN_LOOKS: usize = 20_000;

/// Looks at the observer now and then while a simulation goes on.
pub(crate) struct Looks<'w, 'o> {
    watch: &'w mut Watch<'o>,
    since: usize,
    is_stopped: bool,
}

impl<'w, 'o> Looks<'w, 'o> {
    pub fn new(watch: &'w mut Watch<'o>) -> Self {
        // After a stop every further simulation ends at once.
        let is_stopped = watch.stopped;
        Self {
            watch,
            since: 0,
            is_stopped,
        }
    }

    /// Whether to go on after another `steps`.
    #[inline]
    pub fn go_on(&mut self, steps: usize) -> bool {
        if self.is_stopped {
            return false;
        }
        self.since += steps;
        if self.since < STEPS_BETWEEN_LOOKS {
            return true;
        }
        self.since = 0;
        self.watch.report(f64::INFINITY);
        self.is_stopped = self.watch.stopped;
        !self.is_stopped
    }
}

impl Problem<'_> {
    /// Sum of squares of the weighted residuals; infinite where the simulation gives values that are not
    /// finite, or where it was stopped.
    pub fn cost(&self, at: &Point, watch: &mut Watch) -> f64 {
        let mut looks = Looks::new(watch);
        let axis = self.layout.write(&self.base, &at.q);
        let [wx, wf] = self.weights;
        let closed = self.drive.controller.is_some();
        let mut cost = 0.0;
        for (run, initial) in self.runs.iter().zip(&at.starts) {
            let steps = self.drive.substeps * periods(run);
            simulate(&axis, &self.drive, run, initial, |k, state, force| {
                if run.keep[k] {
                    let rx = wx * (run.position[k] - state.x);
                    cost += rx * rx;
                    if closed {
                        let rf = wf * (run.force[k] - force);
                        cost += rf * rf;
                    }
                }
                looks.go_on(steps)
            });
            if looks.is_stopped {
                return f64::INFINITY;
            }
        }
        if cost.is_nan() { f64::INFINITY } else { cost }
    }

    /// Cost and normal equations; an infinite cost where the simulation was stopped.
    pub fn equations(&self, at: &Point, watch: &mut Watch) -> Equations {
        let mut looks = Looks::new(watch);
        let shared = self.layout.len();
        let locals = self.drive.locals();
        let count = shared + locals;
        let axis = self.layout.write(&self.base, &at.q);
        let closed = self.drive.controller.is_some();
        let mut out = Equations {
            cost: 0.0,
            shared: DMatrix::zeros(shared, shared),
            descent: DVector::zeros(shared),
            runs: Vec::with_capacity(self.runs.len()),
        };
        for (run, initial) in self.runs.iter().zip(&at.starts) {
            let mut sums = Sums::new();
            let steps = self.drive.substeps * periods(run);
            simulate_with_slopes(&axis, &self.layout, &self.drive, run, initial, |k, now| {
                if run.keep[k] {
                    sums.add(
                        self.weights[0],
                        run.position[k] - now.state.x,
                        now.position_slopes,
                    );
                    if closed {
                        sums.add(self.weights[1], run.force[k] - now.force, now.force_slopes);
                    }
                }
                looks.go_on(steps)
            });
            if looks.is_stopped {
                sums.cost = f64::INFINITY;
            }
            out.cost += sums.cost;
            for i in 0..shared {
                out.descent[i] += sums.descent[i];
                for j in 0..=i {
                    out.shared[(i, j)] += sums.normal[i][j];
                }
            }
            let mut part = OwnPart {
                mixed: DMatrix::zeros(shared, LOCALS),
                own: Matrix4::zeros(),
                descent: Vector4::zeros(),
            };
            for i in shared..count {
                let a = i - shared;
                part.descent[a] = sums.descent[i];
                for j in 0..shared {
                    part.mixed[(j, a)] = sums.normal[i][j];
                }
                for j in shared..=i {
                    part.own[(a, j - shared)] = sums.normal[i][j];
                    part.own[(j - shared, a)] = sums.normal[i][j];
                }
            }
            out.runs.push(part);
        }
        for i in 0..shared {
            for j in 0..i {
                out.shared[(j, i)] = out.shared[(i, j)];
            }
        }
        if out.cost.is_nan() {
            out.cost = f64::INFINITY;
        }
        out
    }

    /// Sum of squares of the measured signals with the same weights: the reference for what is only rounding.
    pub fn energy(&self) -> f64 {
        let mut energy = 0.0;
        for run in self.runs {
            for (k, _) in run.keep.iter().enumerate().filter(|(_, keep)| **keep) {
                let x = self.weights[0] * run.position[k];
                energy += x * x;
                if self.drive.controller.is_some() {
                    let f = self.weights[1] * run.force[k];
                    energy += f * f;
                }
            }
        }
        energy
    }

    /// The same of the motion: positions about the mean of their stretch.
    pub fn motion(&self) -> f64 {
        let [wx, wf] = self.weights;
        let mut energy = wx * wx * run::motion(self.runs);
        if self.drive.controller.is_some() {
            for run in self.runs {
                let kept = run.force.iter().zip(&run.keep).filter(|(_, keep)| **keep);
                energy += kept.map(|(f, _)| wf * wf * f * f).sum::<f64>();
            }
        }
        energy
    }
}

/// Normal equations of one run, the lower half.
struct Sums {
    cost: f64,
    normal: [[f64; MOST]; MOST],
    descent: [f64; MOST],
}

impl Sums {
    fn new() -> Self {
        Self {
            cost: 0.0,
            normal: [[0.0; MOST]; MOST],
            descent: [0.0; MOST],
        }
    }

    #[inline]
    fn add(&mut self, weight: f64, residual: f64, slopes: &[f64]) {
        let square = weight * weight;
        self.cost += square * residual * residual;
        for (i, a) in slopes.iter().enumerate() {
            let scaled = square * a;
            self.descent[i] += scaled * residual;
            for (n, b) in self.normal[i].iter_mut().zip(&slopes[..=i]) {
                *n += scaled * b;
            }
        }
    }
}

impl OwnPart {
    /// Inverse of the own part, damped; directions without any effect stay put.
    pub fn inverse(&self, damping: f64) -> Matrix4<f64> {
        let scale = Vector4::from_fn(|i, _| {
            let d = self.own[(i, i)] * (1.0 + damping);
            if d > 0.0 && d.is_finite() {
                1.0 / d.sqrt()
            } else {
                0.0
            }
        });
        let mut unit = Matrix4::from_fn(|i, j| self.own[(i, j)] * scale[i] * scale[j]);
        for i in 0..LOCALS {
            // A unit diagonal, and slightly more than one: two unknowns of a start can have the same effect.
            unit[(i, i)] = 1.0 + 1e-12;
        }
        let inverse = unit.cholesky().map_or_else(Matrix4::zeros, |c| c.inverse());
        Matrix4::from_fn(|i, j| inverse[(i, j)] * scale[i] * scale[j])
    }
}

impl Equations {
    /// Equations of the shared unknowns alone, those of the runs eliminated with this damping, and the
    /// fall of the cost that the unknowns of the runs predict by themselves.
    pub fn reduced(&self, damping: f64) -> (Derivatives, f64) {
        let mut matrix = self.shared.clone();
        let mut rhs = self.descent.clone();
        let mut beside = 0.0;
        for part in &self.runs {
            let inverse = part.inverse(damping);
            let through = &part.mixed * inverse;
            matrix -= &through * part.mixed.transpose();
            rhs -= &through * part.descent;
            let step = inverse * part.descent;
            beside += 2.0 * part.descent.dot(&step) - (part.own * step).dot(&step);
        }
        let n = rhs.len();
        let mut out = Derivatives::zeros(n);
        out.cost = self.cost;
        for i in 0..n {
            out.gradient[i] = -rhs[i];
            for j in 0..n {
                out.normal[i * n + j] = matrix[(i, j)];
            }
        }
        (out, beside)
    }

    /// Steps of the runs' own unknowns when the shared ones take the given step.
    pub fn own_steps(&self, step: &[f64], damping: f64) -> Vec<[f64; LOCALS]> {
        let step = DVector::from_column_slice(step);
        self.runs
            .iter()
            .map(|part| {
                let left = part.descent - part.mixed.transpose() * &step;
                (part.inverse(damping) * left).into()
            })
            .collect()
    }
}
