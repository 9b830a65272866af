//! Measured and simulated signals of a fit, and the size of their difference.

use crate::fit::{Fit, MOST_LAGS};
use crate::output_error::problem::{Point, Problem};
use crate::output_error::simulate::simulate;
use std::ops::Range;
use stiction_policy::simulation;
use stiction_signal::{Travel, noise_deviation};

/// A second difference of a position whose errors are independent, over their size: the root of 1 + 4 + 1.
const BEND_OF_NOISE: f64 = 2.449_489_742_783_178;

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
    /// Longest way between two measured positions of a log, m or rad.
    pub(crate) fn stroke(&self) -> f64 {
        let of_log = |own: &[f64]| {
            let low = own.iter().copied().fold(f64::INFINITY, f64::min);
            let high = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            high - low
        };
        self.stretches().map(of_log).fold(0.0, f64::max)
    }

    /// Acceleration of the measured motion, rms, m/s^2 or rad/s^2, over the shortest time in which it shows clearly beside what
    /// the simulation leaves of the position; 0 where it never does.
    pub(crate) fn acceleration_rms(&self) -> f64 {
        let clear = simulation::MIN_BEND * BEND_OF_NOISE * self.position_rmse();
        let longest = self.bounds().map(|range| range.len()).max().unwrap_or(0);
        let mut lag = 1;
        while 2 * lag < longest {
            let (mut bends, mut accelerations, mut count) = (0.0, 0.0, 0_usize);
            for range in self.bounds() {
                for k in range.start + lag..range.end.saturating_sub(lag) {
                    let bend =
                        self.position[k + lag] - 2.0 * self.position[k] + self.position[k - lag];
                    let time = 0.5 * (self.time[k + lag] - self.time[k - lag]);
                    bends += bend * bend;
                    accelerations += (bend / (time * time)).powi(2);
                    count += 1;
                }
            }
            let count = count.max(1) as f64;
            if (bends / count).sqrt() > clear {
                return (accelerations / count).sqrt();
            }
            lag *= 2;
        }
        0.0
    }

    /// Size of the position error. The relative error is against the motion, the position about the mean of its stretch:
    /// where the origin of the encoder is does not matter, and 100 % is what standing still would leave.
    pub fn position_fit(&self) -> Fit {
        self.position_fit_up_to_lag(MOST_LAGS)
    }

    /// The same with an autocorrelation that takes a few hundredths of a second at most: after an interruption the answer is
    /// to come at once.
    pub(crate) fn position_fit_at_once(&self) -> Fit {
        let lags = MOST_PRODUCTS_AT_ONCE / self.position.len().max(1);
        self.position_fit_up_to_lag(lags.clamp(2, MOST_LAGS))
    }

    fn position_fit_up_to_lag(&self, lags: usize) -> Fit {
        let motion: Vec<f64> = self.stretches().flat_map(about_mean).collect();
        let residual = less(&self.position, &self.simulated);
        Fit::up_to_lag(&motion, &residual, lags).unwrap_or_else(|| still(&residual))
    }

    /// Root mean square of the position error alone: the rest of [`position_fit`](Self::position_fit) takes a tenth of a second
    /// on a long log.
    fn position_rmse(&self) -> f64 {
        still(&less(&self.position, &self.simulated)).rmse
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
        let simulated = simulation::MIN_MOVEMENT * self.position_rmse();
        let both = |of: &[f64], shortest| {
            let travel = self
                .bounds()
                .map(|range| Travel::of(of[range].iter().copied(), shortest));
            !travel.fold(Travel::default(), Travel::and).is_one_way()
        };
        both(&self.position, measured) || both(&self.simulated, simulated)
    }

    /// Log, counted from 1, and time, s, at which the simulated position is further from the measured one than this ever
    /// goes, where it ends far beyond.
    pub(crate) fn diverged(&self) -> Option<(usize, f64)> {
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        let reach = |[low, high]: [f64; 2], x: &f64| [low.min(*x), high.max(*x)];
        let [low, high] = self.position.iter().fold(ends, reach);
        let off = less(&self.position, &self.simulated);
        let within = |x: f64, parts: f64| x.abs() <= parts * (high - low);
        if off
            .iter()
            .all(|&x| within(x, simulation::DIVERGED_FIT_ERROR))
        {
            return None;
        }
        let left = off.iter().position(|&x| !within(x, 1.0))?;
        Some((self.log[left] + 1, self.time[left]))
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

/// Most products of an autocorrelation after an interruption.
const MOST_PRODUCTS_AT_ONCE: usize = 50_000_000;

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

/// Simulates the runs of a problem.
pub(crate) fn signals(problem: &Problem, at: &Point) -> Signals {
    let axis = problem.layout.write(&problem.base, &at.q);
    // Friction at an instant, without offset and position-dependent parts; viscous friction may come out negative, which
    // no law takes.
    let law = axis.dry_law();
    let friction = |z: f64, v: f64| {
        let viscous = axis.sides[usize::from(v < 0.0)].viscous;
        // With elements their force stands in the place of the deflection.
        let dry = match axis.elements {
            Some(_) => z,
            None => law.map_or(f64::NAN, |law| law.force(z, v)),
        };
        dry + viscous * v
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
