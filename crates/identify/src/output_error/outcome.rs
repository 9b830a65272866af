//! Result of a fit by simulation: parameters with their intervals, signals, and the size of the error.

use crate::error::Error;
use crate::estimate::advice;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::series::Series;
use crate::estimate::sliding;
use crate::estimate::uncertainty;
use crate::fit::Fit;
use crate::law::Law;
use crate::law::terms::{Mass, Terms};
use crate::output_error::controller::Controller;
use crate::output_error::descent::{Descent, descend};
use crate::output_error::plant::Axis;
use crate::output_error::problem::{Point, Problem};
use crate::output_error::run::{self, Hold, Recording, Run};
use crate::output_error::search::{Found, Search};
use crate::output_error::simulate::{Drive, simulate, simulate_with_slopes};
use crate::output_error::start::rest;
use crate::output_error::unknowns::{Layout, Unknown};
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use crate::parameter::physical::{Physical, propagate};
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use nalgebra::DMatrix;
use std::ops::Range;
use stiction_parameters::{Name, Quantity};
use stiction_search::{Counts, Observer, Silent, Stage, Status};
use stiction_signal::{Travel, noise_deviation};

/// Measured and simulated signals at the samples that count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signals {
    /// Which log each sample comes from, counted from 0.
    pub log: Vec<usize>,
    /// Which stretch without a gap it is in, counted from 0 over all logs.
    pub stretch: Vec<usize>,
    /// Time, s.
    pub time: Vec<f64>,
    /// Measured position, m or rad.
    pub position: Vec<f64>,
    /// Simulated position, m or rad.
    pub simulated: Vec<f64>,
    /// Simulated velocity, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Simulated friction, in the unit of the force.
    pub friction: Vec<f64>,
    /// Logged force.
    pub force: Vec<f64>,
    /// Force of the simulated controller; empty in open loop.
    pub simulated_force: Vec<f64>,
}

impl Signals {
    /// Size of the position error. The relative error is against the motion, the position about the mean of its stretch:
    /// where the origin of the encoder is does not matter, and 100 % is what standing still would leave.
    pub fn position_fit(&self) -> Fit {
        let motion: Vec<f64> = self.stretches().flat_map(about_mean).collect();
        let residual = less(&self.position, &self.simulated);
        Fit::new(&motion, &residual).unwrap_or_else(|| still(&residual))
    }

    /// Size of the force error, in closed loop.
    pub fn force_fit(&self) -> Option<Fit> {
        if self.simulated_force.is_empty() {
            return None;
        }
        Fit::new(&self.force, &less(&self.force, &self.simulated_force))
    }

    /// Whether the axis moves in both directions, by its measured position, with the encoder step, m or rad, where it is
    /// known; or by its simulated position, which has neither steps nor noise, so that presliding of a few counts is seen:
    /// there a movement counts if it is more than twice the rms residual.
    pub fn moves_both_ways(&self, encoder_step: Option<f64>) -> bool {
        let noise = noise_deviation(self.stretches());
        let measured = Travel::shortest_movement(encoder_step.unwrap_or(0.0), noise);
        let simulated = CLEAR_OF_RESIDUAL * self.position_fit().rmse;
        let both = |of: &[f64], shortest| {
            let travel = self
                .bounds()
                .map(|range| Travel::of(of[range].iter().copied(), shortest));
            !travel.fold(Travel::default(), Travel::and).is_one_way()
        };
        both(&self.position, measured) || both(&self.simulated, simulated)
    }

    /// Measured positions without gaps, each of one log.
    fn stretches(&self) -> impl Iterator<Item = &[f64]> {
        self.bounds().map(|range| &self.position[range])
    }

    /// Where the stretches are.
    fn bounds(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = (1..=self.stretch.len())
            .filter(|&i| i == self.stretch.len() || self.stretch[i] != self.stretch[i - 1]);
        ends.scan(0, |start, end| {
            let range = *start..end;
            *start = end;
            Some(range)
        })
    }
}

/// Movements of the simulated position longer than this many rms residuals count as motion.
const CLEAR_OF_RESIDUAL: f64 = 2.0;

fn about_mean(x: &[f64]) -> impl Iterator<Item = f64> {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    x.iter().map(move |x| x - mean)
}

/// A residual beside a position that does not move, or one too large to square.
fn still(residual: &[f64]) -> Fit {
    let n = residual.len();
    let energy: f64 = residual.iter().map(|r| r * r).sum();
    let rmse = (energy / n.max(1) as f64).sqrt();
    Fit {
        rmse: if rmse.is_finite() { rmse } else { f64::MAX },
        relative_error_percent: f64::MAX,
        r2: f64::NAN,
        samples: n,
        effective_samples: 1.0,
    }
}

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// A law fitted by simulation.
#[derive(Clone, Debug)]
pub struct SimulationFit {
    /// Parameters, covariance and search; what it was fitted to is the position.
    pub fitted: FittedLaw,
    /// Position, velocity and force, measured and simulated.
    pub signals: Signals,
    /// Position error.
    pub position: Fit,
    /// Force error; `None` in open loop, where the force is what drives the simulation.
    pub force: Option<Fit>,
    /// Pieces that were simulated in the fit, each from a start of its own that was fitted too.
    pub runs: usize,
    /// Stretches without a gap that the pieces were cut from.
    pub stretches: usize,
    /// Plant steps in one control period (in open loop: in one sample).
    pub substeps: usize,
    /// Rms residual that one encoder count alone would leave, m or rad, where it is known.
    pub floor: Option<f64>,
    /// Position error where each stretch is simulated whole from one start; `None` where the fit itself did so, or the
    /// search was stopped.
    pub whole: Option<Fit>,
    /// Position error over a short horizon; `None` in closed loop, where the stretches are not much longer than the
    /// horizon, or the search was stopped.
    pub short: Option<Short>,
    axis: Axis,
    controller: Option<Controller>,
    hold: Hold,
    segment: Option<f64>,
    weights: [f64; 2],
}

/// The error of a simulation that starts anew again and again, each start fitted: how far the axis is off after a short
/// while, where the error of the whole run has had all its time to grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short {
    /// Longest piece that is simulated from one start, s.
    pub seconds: f64,
    /// Position error.
    pub position: Fit,
}

impl SimulationFit {
    /// Whether a controller was simulated too.
    pub fn is_closed_loop(&self) -> bool {
        self.controller.is_some()
    }

    /// Longest piece that the fit was cut into, s; `None` where every stretch ran whole.
    pub fn segment(&self) -> Option<f64> {
        self.segment.filter(|_| self.runs > self.stretches)
    }

    /// Values that were fitted for the starts of all runs.
    pub fn starts(&self) -> usize {
        let drive = Drive {
            controller: self.controller.as_ref(),
            hold: self.hold,
            substeps: self.substeps,
        };
        self.runs * drive.locals()
    }
}

/// An unseen recording under a fitted law.
#[derive(Clone, Debug)]
pub struct Unseen {
    /// Position, velocity and force, measured and simulated.
    pub signals: Signals,
    /// Position error.
    pub position: Fit,
    /// Force error, in closed loop.
    pub force: Option<Fit>,
    /// Stretches without a gap, each simulated whole from one start.
    pub runs: usize,
    /// Position error over a short horizon, as in the fit.
    pub short: Option<Short>,
    /// Evaluations that fitting the starts took.
    pub counts: Counts,
}

/// Horizon where the fit was not cut, s: a choice, long enough for a few reversals of most motions.
const HORIZON: f64 = 1.0;
/// Steps of a descent on starts alone.
const START_STEPS: usize = 60;
/// Bristle deflections, over `Fc/s0`, from which the start of a run is looked for: at rest, and sliding either way.
const START_DEFLECTIONS: [f64; 3] = [0.0, 1.0, -1.0];

/// Simulates recordings that were not fitted, each stretch without a gap whole. Only where a stretch starts is fitted to
/// it: position, velocity and bristle deflection (and a controller's integral) cannot be known beforehand.
///
/// # Errors
/// As [`output_error`](crate::output_error()).
pub fn simulate_unseen(
    recordings: &[Recording],
    fitted: &SimulationFit,
    observer: &mut dyn Observer,
) -> Result<Unseen, Error> {
    let runs = run::runs(recordings, fitted.controller.as_ref(), None)?;
    if runs.is_empty() {
        return Err(Error::TooFewSamples {
            found: 0,
            needed: 10,
            losses: run::losses(recordings, 0, 0),
        });
    }
    let mut watch = Watch::new(observer, Stage::Fine);
    let signals = fitted.replay(&runs, &mut watch);
    Ok(Unseen {
        force: signals.force_fit(),
        position: signals.position_fit(),
        signals,
        runs: runs.len(),
        short: fitted.over_short(&runs, &mut watch),
        counts: watch.counts,
    })
}

impl SimulationFit {
    /// The signals of other runs, of which only the starts are fitted.
    fn replay(&self, runs: &[Run], watch: &mut Watch) -> Signals {
        let problem = Problem {
            runs,
            layout: Layout {
                unknowns: Vec::new(),
                waves: Vec::new(),
            },
            base: self.axis.clone(),
            drive: Drive {
                controller: self.controller.as_ref(),
                hold: self.hold,
                substeps: self.substeps,
            },
            weights: self.weights,
        };
        let nothing = SearchBox::between(Vec::new(), Vec::new());
        // Each run for itself: in one descent a start that is hard to find would hold up all others.
        let mut starts = rest(runs, self.controller.as_ref());
        for (run, start) in runs.iter().zip(&mut starts) {
            let alone = Problem {
                runs: std::slice::from_ref(run),
                ..problem.clone()
            };
            let mut best = (f64::INFINITY, *start);
            for deflection in START_DEFLECTIONS {
                let mut guess = *start;
                guess.0[2] = deflection;
                let at = Point {
                    q: Vec::new(),
                    starts: vec![guess],
                };
                let found = descend(&alone, &nothing, at, START_STEPS, watch);
                if found.cost < best.0 {
                    best = (found.cost, found.at.starts[0]);
                }
            }
            *start = best.1;
        }
        let at = Point {
            q: Vec::new(),
            starts,
        };
        signals(&problem, &at)
    }

    /// The error over a short horizon of stretches that are whole.
    fn over_short(&self, stretches: &[Run], watch: &mut Watch) -> Option<Short> {
        let seconds = self.segment.unwrap_or(HORIZON);
        let runs: Vec<Run> = stretches
            .iter()
            .flat_map(|run| run.clone().cut(run.samples_in(seconds)))
            .collect();
        if self.is_closed_loop() || runs.len() == stretches.len() {
            return None;
        }
        let position = self.replay(&runs, watch).position_fit();
        (!watch.stopped).then_some(Short { seconds, position })
    }

    /// Adds the errors of the fitted recordings over horizons other than that of the fit.
    pub(crate) fn judge_horizons(&mut self, recordings: &[Recording], watch: &mut Watch) {
        let controller = self.controller.as_ref();
        let Ok(stretches) = run::runs(recordings, controller, None) else {
            return;
        };
        if watch.stopped || self.is_closed_loop() {
            return;
        }
        if let Some(seconds) = self.segment() {
            let whole = self.replay(&stretches, watch).position_fit();
            self.whole = (!watch.stopped).then_some(whole);
            let position = self.position;
            self.short = Some(Short { seconds, position });
        } else {
            self.short = self.over_short(&stretches, watch);
        }
    }
}

/// Most plant steps of one simulation for which intervals are computed after an interruption: a fifth of a second or so.
const MOST_STEPS_AFTER_A_STOP: usize = 100_000;

/// Puts together what a search found.
pub(crate) fn describe(
    search: &Search,
    found: Found,
    law: Law,
    terms: &Terms,
    counts: Counts,
) -> SimulationFit {
    let problem = search.problem(&found.base, found.substeps, found.weights);
    let Descent {
        at,
        status,
        iterations,
        history,
        ..
    } = found.descent;
    let axis = problem.layout.write(&problem.base, &at.q);
    let signals = signals(&problem, &at);
    let position = signals.position_fit();
    let held: Vec<bool> = problem
        .layout
        .unknowns
        .iter()
        .zip(&at.q)
        .map(|(unknown, x)| matches!(unknown, Unknown::Viscous(_)) && *x <= 0.0)
        .collect();
    let stopped_early = status == Status::Interrupted && problem.steps() > MOST_STEPS_AFTER_A_STOP;
    let (unknowns, without) = match stopped_early {
        true => (
            DMatrix::from_element(held.len(), held.len(), f64::INFINITY),
            vec![false; held.len()],
        ),
        false => covariance(&problem, &at, &held),
    };
    let raw = parameters(&problem.layout, &axis, &at.q, search.scale.centre);
    let matrix = propagate(&raw, &unknowns);
    let level = axis.sides[0].coulomb.max(axis.sides[1].coulomb);
    let mut parameters: Vec<Parameter> = raw
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let place = p.nonlinear.filter(|&k| k < at.q.len());
            let reason = match place {
                Some(k) if held[k] => "held at zero: the data ask for a negative value".into(),
                Some(k) if without[k] => "has no effect on this motion".into(),
                Some(k) if found.bounds.at_bound(&at.q, k) => {
                    "is at the bound of its search range".into()
                }
                _ => String::new(),
            };
            let size = match p.name == Quantity::Delay {
                true => search.scale.step,
                false => level,
            };
            Parameter::judged(p, matrix[(i, i)], None, reason, size)
        })
        .collect();
    insert_given(&mut parameters, &law, terms);
    let covariance = Covariance::new(raw.iter().map(|p| p.name).collect(), &matrix);
    sliding::flag_one_direction(&mut parameters, || {
        signals.moves_both_ways(search.simulation.quantum)
    });
    advice::explain(&mut parameters, &covariance);
    let top = signals.velocity.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let fitted = FittedLaw {
        law,
        terms: terms.clone(),
        parameters,
        covariance,
        fit: position,
        low_speed: None,
        low_speed_bound: 0.02 * top,
        series: Series {
            log: signals.log.clone(),
            time: signals.time.clone(),
            position: signals.position.clone(),
            velocity: signals.velocity.clone(),
            measured: signals.position.clone(),
            model: signals.simulated.clone(),
            other: vec![0.0; signals.time.len()],
        },
        status,
        counts,
        iterations,
        history,
        elements: Vec::new(),
    };
    SimulationFit {
        fitted,
        position,
        force: signals.force_fit(),
        signals,
        runs: search.runs.len(),
        stretches: run::stretches_of(search.runs),
        whole: None,
        short: None,
        substeps: found.substeps,
        floor: search.simulation.quantum.map(|q| q / libm::sqrt(12.0)),
        axis,
        controller: search.simulation.controller,
        hold: search.simulation.hold,
        segment: search.simulation.segment,
        weights: found.weights,
    }
}

fn signals(problem: &Problem, at: &Point) -> Signals {
    let axis = problem.layout.write(&problem.base, &at.q);
    // Friction at an instant, without offset and position-dependent parts; viscous friction may come out negative, which
    // no law takes.
    let law = axis.dry_law();
    let friction = |z: f64, v: f64| {
        let viscous = axis.sides[usize::from(v < 0.0)].viscous;
        law.map_or(f64::NAN, |law| law.force(z, v)) + viscous * v
    };
    let closed = problem.drive.controller.is_some();
    let mut out = Signals::default();
    for (run, initial) in problem.runs.iter().zip(&at.starts) {
        simulate(&axis, &problem.drive, run, initial, |k, state, force| {
            if !run.keep[k] {
                return true;
            }
            out.log.push(run.log);
            out.stretch.push(run.stretch);
            out.time.push(run.time[k]);
            out.position.push(run.position[k]);
            out.simulated.push(state.x);
            out.velocity.push(state.v);
            out.friction.push(friction(state.z, state.v));
            out.force.push(run.force[k]);
            if closed {
                out.simulated_force.push(force);
            }
            true
        });
    }
    out
}

/// Covariance of the shared unknowns with the starts of the runs unknown too, and which of them have no
/// effect at all.
///
/// The influence of a sample on an unknown is summed over its channels, so that the errors of position
/// and force at one instant, which are correlated, are not counted as two independent ones.
fn covariance(problem: &Problem, at: &Point, held: &[bool]) -> (DMatrix<f64>, Vec<bool>) {
    let count = problem.layout.len();
    let mut silent = Silent;
    let equations = problem.equations(at, &mut Watch::new(&mut silent, Stage::Fine));
    let (reduced, _) = equations.reduced(0.0);
    let without: Vec<bool> = (0..count)
        .map(|i| equations.shared[(i, i)] <= 0.0)
        .collect();
    let free: Vec<usize> = (0..count).filter(|&i| !held[i] && !without[i]).collect();
    let q = free.len();
    let mut out = DMatrix::zeros(count, count);
    let scale: Vec<f64> = free
        .iter()
        .map(|&i| 1.0 / equations.shared[(i, i)].sqrt())
        .collect();
    let scaled = DMatrix::from_fn(q, q, |a, b| {
        reduced.normal[free[a] * count + free[b]] * scale[a] * scale[b]
    });
    if q == 0 || scaled.iter().any(|x| !x.is_finite()) {
        out.fill(f64::INFINITY);
        return (out, without);
    }
    let bread = uncertainty::inverse(scaled).0;

    let axis = problem.layout.write(&problem.base, &at.q);
    let mut influence: Vec<Vec<f64>> = vec![Vec::new(); q];
    let mut breaks = Vec::new();
    let mut samples = 0;
    for ((run, initial), part) in problem.runs.iter().zip(&at.starts).zip(&equations.runs) {
        if samples > 0 {
            breaks.push(samples);
        }
        // The remaining effect of a shared unknown after the start of its run has been adjusted to it.
        let own = &part.mixed * part.inverse(0.0);
        simulate_with_slopes(
            &axis,
            &problem.layout,
            &problem.drive,
            run,
            initial,
            |k, now| {
                if !run.keep[k] {
                    return true;
                }
                samples += 1;
                let mut score = vec![0.0; q];
                let mut add = |weight: f64, residual: f64, slopes: &[f64]| {
                    for (s, &i) in score.iter_mut().zip(&free) {
                        let mut slope = slopes[i];
                        for (a, local) in slopes[count..].iter().enumerate() {
                            slope -= own[(i, a)] * local;
                        }
                        *s += weight * weight * slope * residual;
                    }
                };
                add(
                    problem.weights[0],
                    run.position[k] - now.state.x,
                    now.position_slopes,
                );
                if problem.drive.controller.is_some() {
                    add(
                        problem.weights[1],
                        run.force[k] - now.force,
                        now.force_slopes,
                    );
                }
                for (a, series) in influence.iter_mut().enumerate() {
                    series.push((0..q).map(|b| bread[(a, b)] * scale[b] * score[b]).sum());
                }
                true
            },
        );
    }
    let channels = if problem.drive.controller.is_some() {
        2
    } else {
        1
    };
    let spent = q + problem.runs.len() * problem.drive.locals();
    let (n, spent) = (samples as f64, spent as f64 / f64::from(channels));
    if n <= spent + 1.0 {
        out.fill(f64::INFINITY);
        return (out, without);
    }
    let variance = equations.cost / (f64::from(channels) * (n - spent));
    let small =
        uncertainty::of_influence(&influence, &breaks, n / (n - spent), &(&bread * variance));
    for (a, &i) in free.iter().enumerate() {
        for (b, &j) in free.iter().enumerate() {
            out[(i, j)] = small[(a, b)] * scale[a] * scale[b];
        }
    }
    (out, without)
}

/// The parameters of the law as functions of the shared unknowns.
///
/// The delay is that of the middle of a row's force, as the fit of the force states it.
fn parameters(layout: &Layout, axis: &Axis, q: &[f64], centre: f64) -> Vec<Physical> {
    let mut out = Vec::new();
    for (k, (unknown, &x)) in layout.unknowns.iter().zip(q).enumerate() {
        let mut slope = vec![0.0; q.len()];
        let (name, value) = match *unknown {
            Unknown::Stiffness => {
                slope[k] = axis.stiffness;
                (Quantity::Sigma0.into(), axis.stiffness)
            }
            Unknown::MicroDamping => {
                slope[k] = axis.micro_damping;
                (Quantity::Sigma1.into(), axis.micro_damping)
            }
            Unknown::Viscous(side) => {
                slope[k] = 1.0;
                (Name::new(Quantity::Sigma2, side), x)
            }
            Unknown::Coulomb(side) => {
                let level = axis.sides[side.index()].coulomb;
                slope[k] = level;
                (Name::new(Quantity::Coulomb, side), level)
            }
            Unknown::Excess(side) => {
                let curve = &axis.sides[side.index()];
                slope[k] = curve.fixed - curve.coulomb;
                if let Some(level) = layout.place(Unknown::Coulomb(side)) {
                    slope[level] = curve.fixed;
                }
                (Name::new(Quantity::Static, side), curve.fixed)
            }
            Unknown::Velocity(side) => {
                let velocity = axis.sides[side.index()].velocity;
                slope[k] = velocity;
                (Name::new(Quantity::StribeckVelocity, side), velocity)
            }
            Unknown::Mass => {
                slope[k] = axis.mass;
                (Quantity::Mass.into(), axis.mass)
            }
            Unknown::Offset => {
                slope[k] = 1.0;
                (Quantity::Offset.into(), x)
            }
            Unknown::Delay => {
                slope[k] = 1.0;
                (Quantity::Delay.into(), x + centre)
            }
            Unknown::Wave(i) => {
                slope[k] = 1.0;
                (layout.waves[i].1, x)
            }
        };
        out.push(Physical {
            name,
            value,
            slope,
            nonlinear: Some(k),
            linear: None,
        });
    }
    out.sort_by_key(|parameter| parameter.name.quantity.place());
    out
}

/// Puts what was given beside what was found, in the order of tables.
fn insert_given(parameters: &mut Vec<Parameter>, law: &Law, terms: &Terms) {
    if law.kind.has_stribeck() {
        let at = parameters
            .iter()
            .rposition(|p| p.name.quantity == Quantity::StribeckVelocity)
            .map_or(parameters.len(), |i| i + 1);
        parameters.insert(
            at,
            Parameter::given(Quantity::StribeckExponent, law.exponent),
        );
    }
    if let Mass::Given(mass) = terms.mass {
        let at = parameters
            .iter()
            .position(|p| p.name == Quantity::Offset)
            .unwrap_or(parameters.len());
        let mass = Parameter::given(Quantity::Mass, mass);
        parameters.insert(at, mass);
    }
}
