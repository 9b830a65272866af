//! sigma0 and sigma1 from force steps by simulation: the published inversion assumes a linear axis; here
//! the mass with its LuGre law is simulated under the measured force and fitted to the position.
//!
//! The bristles slip long before break-away: at a tenth of Fs the inversion is off by -15 % in sigma0 and
//! +25 % in sigma1 at a damping ratio of .3, and by -37 % and +280 % at .1, since each oscillation moves
//! the axis a little further. First loading is exactly `x = -(Fs/sigma0) ln(1 - u/Fs)`.

use super::parameter::{Found, quantile};
use super::step::StepResponse;
use super::step_given::{GIVEN, carried};
use super::step_model::{Response, Trial};
use super::step_rounding::rounding;
use super::stretch::Run;
use crate::error::Error;
use crate::estimate::uncertainty;
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use crate::separable::linear::dot;
use stiction_friction::Direction;
use stiction_parameters::{Name, Quantity};
use stiction_policy::procedure;
use stiction_search::descent::{Descent, LeastSquares, Region, Settings, Sums, descend};
use stiction_search::{Control, Counts, Derivatives, Observer, Progress, Stage, Status};

/// Phase of the oscillation of the mass on its bristles in one sample, rad, beyond which the log cannot
/// show it: two samples a period (Nyquist).
const MOST_PHASE_PER_SAMPLE: f64 = std::f64::consts::PI;
/// Starts: shares of the inversion's sigma0, and damping ratios.
const STIFFNESS_SHARES: [f64; 4] = [1.0, 1.3, 2.0, 4.0];
const DAMPING_RATIOS: [f64; 4] = [0.03, 0.1, 0.3, 0.9];
/// Starts that are followed.
const FOLLOWED: usize = 3;
/// Most steps of each.
const MOST_TRIALS: usize = 60;
/// Step of the central differences that give sensitivities, in logarithms: their error is about the square.
const DIFFERENCE_STEP: f64 = 1e-4;
/// Relative fall of the cost at which a descent ends; derivatives from differences are not accurate
/// enough for more.
const NO_GAIN: f64 = 1e-10;
/// Step in the logarithms at which a descent ends, likewise.
const SETTLED_STEP: f64 = 1e-8;
/// Longest step of one unknown, in its logarithm.
const LONGEST_STEP: f64 = 1.0;
/// Largest delay between force and position that is looked for, samples.
const MOST_DELAY: f64 = 2.0;
/// What is wrong with every parameter there.
const LATE: &str = "the delay between force and position is at the end of its range, two samples: something shapes the response \
                    that the law and what is given beside it do not explain";

/// What is known beside the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepSettings {
    /// Mass, kg (kg m^2); `None` makes it one more unknown.
    pub mass: Option<f64>,
    /// The steady curve; `None` makes Fs one more unknown and takes Fc = Fs, sigma2 = 0, which holds
    /// for speeds well below vs.
    pub curve: Option<Direction<f64>>,
    /// Stribeck exponent.
    pub exponent: f64,
    /// Constant force F0 beside friction, N (N m): at rest friction is the force less this one, and that deflects the
    /// bristles before the step.
    pub offset: f64,
    /// Covariance of what is given, in the order Fc, Fs, vs, sigma2, mass, exponent, offset; zero for what is exact.
    /// The intervals of the result count it, and its covariance contains it.
    pub given: [[f64; 7]; 7],
}

/// The fit of one or more step responses.
#[derive(Clone, Debug)]
pub struct StepFit {
    /// sigma0, sigma1, and mass and static friction where they were unknown.
    pub parameters: Vec<Parameter>,
    /// Their covariance, and that of what was given and is not exact, with which they vary.
    pub covariance: Covariance,
    /// How much later the position is logged than the force, s, and its standard deviation; `None` at the end of its
    /// range, where the delay stands for something that the law does not explain.
    pub delay: (f64, Option<f64>),
    /// Per response: time from the first sample shown, s, measured and fitted displacement, m or rad.
    pub series: Vec<StepSeries>,
    /// Residual of the position, rms, m or rad.
    pub rmse: f64,
    /// How the search ended.
    pub status: Status,
    /// Simulations of all responses.
    pub counts: Counts,
    /// Damping ratio `(sigma1 + sigma2)/(2 sqrt(sigma0 M))`.
    pub damping_ratio: f64,
}

/// One response as it was fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct StepSeries {
    /// s
    pub time: Vec<f64>,
    /// Displacement from the rest before the step, m or rad.
    pub measured: Vec<f64>,
    /// The same of the model.
    pub model: Vec<f64>,
}

impl StepFit {
    /// The value of a parameter.
    pub fn value<N>(&self, name: N) -> Option<f64>
    where
        Name: PartialEq<N>,
    {
        let found = self.parameters.iter().find(|p| p.name == name);
        found.map(|p| p.value)
    }
}

/// Fits step responses of one axis together.
///
/// Unknown are ln sigma0, ln sigma1, the delay between force and position as a share of the longest, and where they are not
/// given ln M and ln Fs; the level of the position of each response is solved exactly.
///
/// # Errors
/// For no response, or settings out of range.
pub fn fit_steps(
    runs: &[(Run, StepResponse)],
    settings: &StepSettings,
    observer: &mut dyn Observer,
) -> Result<StepFit, Error> {
    let Some((_, first)) = runs.first() else {
        return Err(Error::NoStep {
            log: 1,
            reason: "no log is given",
        });
    };
    let given = [
        ("mass", settings.mass),
        ("coulomb", settings.curve.map(|c| c.coulomb)),
        (
            "stribeck_velocity",
            settings.curve.map(|c| c.stribeck_velocity),
        ),
        ("stribeck_exponent", Some(settings.exponent)),
    ];
    for (name, found) in given {
        if let Some(found) = found.filter(|x| !(*x > 0.0 && x.is_finite())) {
            return Err(Error::Setting {
                name,
                found,
                allowed: "a finite number above 0",
            });
        }
    }
    let highest = runs
        .iter()
        .map(|(_, s)| {
            let friction = s.before - settings.offset;
            (friction + s.height).abs().max(friction.abs())
        })
        .fold(0.0, f64::max);
    if let Some(curve) = settings.curve
        && curve.static_friction <= highest
    {
        return Err(Error::Setting {
            name: "static",
            found: curve.static_friction,
            allowed: "a static friction above the force of every step: a step beyond it slides",
        });
    }
    let viscous = settings.curve.map_or(0.0, |c| c.viscous);
    let inverted = first.invert(settings.mass, viscous);
    let responses: Vec<Response> = runs
        .iter()
        .map(|(run, step)| Response::new(run, step))
        .collect();
    let step = responses[0]
        .time
        .windows(2)
        .map(|t| t[1] - t[0])
        .fold(0.0, f64::max);
    let mass = inverted.mass.unwrap_or_else(|| {
        // Without overshoot and without a given mass: estimated from the duration of the response.
        let rise = responses[0].time.last().copied().unwrap_or(1.0) / 20.0;
        inverted.sigma0 * rise * rise
    });
    let steepest = 2.0 * (inverted.sigma0 / mass).sqrt();
    if let Some(found) = settings
        .mass
        .filter(|_| 0.5 * steepest * step > MOST_PHASE_PER_SAMPLE)
    {
        return Err(Error::Setting {
            name: "mass",
            found,
            allowed: "heavier: this mass would swing on the bristles faster than the log samples",
        });
    }
    let mut problem = Problem {
        steps: responses.iter().map(|r| r.steps(steepest)).collect(),
        responses,
        settings: *settings,
        highest,
        step,
        counts: Counts::default(),
    };
    let mut starts = Vec::new();
    for share in STIFFNESS_SHARES {
        for ratio in DAMPING_RATIOS {
            let sigma0 = share * inverted.sigma0;
            let sigma1 = 2.0 * ratio * (sigma0 * mass).sqrt();
            let mut p = vec![libm::log(sigma0), libm::log(sigma1), 0.0];
            if settings.mass.is_none() {
                p.push(libm::log(mass * share));
            }
            if settings.curve.is_none() {
                // Distance of Fs from the highest step; if the axis is stiffer than it looks, more of its
                // motion is slip.
                p.push(libm::log(1.0 / (share - 0.9)));
            }
            let cost = problem.cost(&p);
            starts.push((cost, p));
        }
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate(FOLLOWED);
    let mut best: Option<(f64, Vec<f64>, Status)> = None;
    for (k, (_, start)) in starts.into_iter().enumerate() {
        let control = observer.progress(&Progress {
            stage: Stage::Fine,
            fraction: k as f64 / FOLLOWED as f64,
            counts: problem.counts,
            best: best.as_ref().map_or(f64::INFINITY, |b| b.0.sqrt()),
        });
        if control == Control::Stop && best.is_some() {
            best = best.map(|(c, p, _)| (c, p, Status::Interrupted));
            break;
        }
        let (cost, p, status) = problem.descend(start);
        if best.as_ref().is_none_or(|b| cost < b.0) {
            best = Some((cost, p, status));
        }
    }
    let Some((_, p, status)) = best else {
        return Err(Error::NoStep {
            log: 1,
            reason: "no start could be simulated",
        });
    };
    Ok(problem.result(&p, status))
}

pub(super) struct Problem {
    pub responses: Vec<Response>,
    steps: Vec<u32>,
    pub settings: StepSettings,
    highest: f64,
    /// Longest sample time, s.
    step: f64,
    counts: Counts,
}

impl Problem {
    fn trial(&self, p: &[f64]) -> Trial {
        let mut rest = p[3..].iter();
        let mass = self
            .settings
            .mass
            .unwrap_or_else(|| libm::exp(rest.next().copied().unwrap_or(0.0)));
        let curve = self.settings.curve.unwrap_or_else(|| {
            let above = libm::exp(rest.next().copied().unwrap_or(0.0));
            let level = self.highest * (1.0 + above);
            Direction {
                coulomb: level,
                static_friction: level,
                stribeck_velocity: 1.0,
                viscous: 0.0,
            }
        });
        Trial {
            sigma0: libm::exp(p[0]),
            sigma1: libm::exp(p[1]),
            mass,
            curve,
            exponent: self.settings.exponent,
            offset: self.settings.offset,
            delay: MOST_DELAY * self.step * p[2],
        }
    }

    /// Measured minus simulated positions, the mean of each response subtracted; not finite for a trial
    /// with invalid parameters.
    pub fn residual(&mut self, p: &[f64]) -> Vec<f64> {
        self.counts.costs += 1;
        let trial = self.trial(p);
        let mut out = Vec::new();
        for (response, steps) in self.responses.iter().zip(&self.steps) {
            let Some(model) = response.simulate(&trial, *steps) else {
                return vec![f64::NAN];
            };
            let start = out.len();
            out.extend(response.position.iter().zip(&model).map(|(x, y)| x - y));
            let own = &mut out[start..];
            let level = own.iter().sum::<f64>() / own.len() as f64;
            own.iter_mut().for_each(|r| *r -= level);
        }
        out
    }

    fn cost(&mut self, p: &[f64]) -> f64 {
        let r = self.residual(p);
        let cost = dot(&r, &r);
        if cost.is_finite() {
            cost
        } else {
            f64::INFINITY
        }
    }

    /// Slopes of the residual with each unknown, by central differences.
    fn slopes(&mut self, p: &[f64]) -> Vec<Vec<f64>> {
        (0..p.len())
            .map(|i| {
                let mut moved = |by: f64| {
                    let mut p = p.to_vec();
                    p[i] += by;
                    self.residual(&p)
                };
                let (up, down) = (moved(DIFFERENCE_STEP), moved(-DIFFERENCE_STEP));
                up.iter()
                    .zip(&down)
                    .map(|(a, b)| (a - b) / (2.0 * DIFFERENCE_STEP))
                    .collect()
            })
            .collect()
    }

    /// Least squares from a start: where it ends, what it costs there, and how.
    fn descend(&mut self, start: Vec<f64>) -> (f64, Vec<f64>, Status) {
        let residual = self.residual(&start);
        let cost = dot(&residual, &residual);
        if !cost.is_finite() {
            return (f64::INFINITY, start, Status::Stalled);
        }
        let settings = Settings {
            most_trials: MOST_TRIALS,
            longest_step: LONGEST_STEP,
            settled_step: SETTLED_STEP,
            // The derivatives come from differences, and near the minimum only the error of these
            // differences is left.
            flat_slope: f64::INFINITY,
            no_gain: NO_GAIN,
            ..Settings::default()
        };
        let n = start.len();
        let (mut low, mut high) = (vec![f64::NEG_INFINITY; n], vec![f64::INFINITY; n]);
        (low[2], high[2]) = (-1.0, 1.0);
        let delays = Region {
            low: &low,
            high: &high,
        };
        let walk = Descent::new(start.clone(), &settings);
        let mut fitted = Fitted {
            problem: self,
            at: start,
            residual,
            sums: None,
            tried: None,
        };
        let walk = descend(&mut fitted, walk, delays, &settings);
        let cost = dot(&fitted.residual, &fitted.residual);
        let status = walk.status().unwrap_or(Status::Budget);
        (cost, walk.into_point(), status)
    }

    fn result(mut self, p: &[f64], status: Status) -> StepFit {
        let residual = self.residual(p);
        let slopes = self.slopes(p);
        let columns: Vec<&[f64]> = slopes.iter().map(Vec::as_slice).collect();
        let mut breaks = Vec::new();
        let mut at = 0;
        for response in &self.responses[..self.responses.len() - 1] {
            at += response.position.len();
            breaks.push(at);
        }
        // The unknowns, and behind them the settings.
        let mut covariance = carried(&mut self, p, &slopes);
        let own = uncertainty::sandwich(&columns, &residual, &breaks).covariance;
        let mut corner = covariance.view_mut((0, 0), own.shape());
        corner += own;
        corner += rounding(&self, &residual, &slopes);
        let trial = self.trial(p);
        let n = residual.len() as f64;
        let level = trial.curve.coulomb;
        let delay_std = covariance[(2, 2)].max(0.0).sqrt();
        let at_end = p[2].abs() > procedure::END_OF_RANGE;
        // Every other unknown is a logarithm, that of Fs the one of its distance from the highest step.
        let mut rows = vec![
            (Quantity::Sigma0, trial.sigma0, 0, trial.sigma0),
            (Quantity::Sigma1, trial.sigma1, 1, trial.sigma1),
        ];
        let mut next = 3;
        if self.settings.curve.is_none() {
            let i = p.len() - 1;
            let fixed = trial.curve.static_friction;
            rows.push((Quantity::Static, fixed, i, fixed - self.highest));
        }
        if self.settings.mass.is_none() {
            rows.push((Quantity::Mass, trial.mass, next, trial.mass));
            next += 1;
        }
        debug_assert!(next <= p.len());
        let parameters = rows
            .iter()
            .map(|&(name, value, i, slope)| {
                let found = Found {
                    name: name.into(),
                    value,
                    variance: covariance[(i, i)] * slope * slope,
                    reason: "",
                };
                let mut parameter = found.parameter(level, quantile(n));
                if at_end && parameter.identifiable {
                    parameter.identifiable = false;
                    parameter.reason = LATE.into();
                }
                parameter
            })
            .collect();
        for (j, quantity) in GIVEN.into_iter().enumerate() {
            let i = p.len() + j;
            if covariance[(i, i)] > 0.0 && rows.iter().all(|row| row.0 != quantity) {
                rows.push((quantity, f64::NAN, i, 1.0));
            }
        }
        let matrix = rows
            .iter()
            .map(|a| {
                let row = rows.iter();
                row.map(|b| covariance[(a.2, b.2)] * a.3 * b.3).collect()
            })
            .collect();
        let mut start = 0;
        let series = self
            .responses
            .iter()
            .map(|response| {
                let end = start + response.position.len();
                let left = &residual[start..end];
                start = end;
                StepSeries {
                    time: response.time.clone(),
                    measured: response.position.clone(),
                    model: response
                        .position
                        .iter()
                        .zip(left)
                        .map(|(x, r)| x - r)
                        .collect(),
                }
            })
            .collect();
        let critical = 2.0 * (trial.sigma0 * trial.mass).sqrt();
        StepFit {
            parameters,
            covariance: Covariance {
                names: rows.iter().map(|r| r.0.into()).collect(),
                matrix,
            },
            delay: (
                trial.delay,
                (!at_end).then_some(MOST_DELAY * self.step * delay_std),
            ),
            series,
            rmse: (dot(&residual, &residual) / n).sqrt(),
            status,
            counts: self.counts,
            damping_ratio: (trial.sigma1 + trial.curve.viscous) / critical,
        }
    }
}

/// A descent on the positions, with derivatives from differences.
struct Fitted<'a> {
    problem: &'a mut Problem,
    at: Vec<f64>,
    residual: Vec<f64>,
    /// At this point; `None` until they are asked for.
    sums: Option<Derivatives>,
    tried: Option<(Vec<f64>, Vec<f64>)>,
}

impl LeastSquares for Fitted<'_> {
    fn sums(&mut self, _: f64) -> Option<Sums<'_>> {
        if self.sums.is_none() {
            let slopes = self.problem.slopes(&self.at);
            let n = slopes.len();
            let mut sums = Derivatives::zeros(n);
            sums.cost = dot(&self.residual, &self.residual);
            for i in 0..n {
                sums.gradient[i] = dot(&slopes[i], &self.residual);
                for j in 0..n {
                    sums.normal[i * n + j] = dot(&slopes[i], &slopes[j]);
                }
            }
            let mut numbers = sums.gradient.iter().chain(&sums.normal);
            if !numbers.all(|x| x.is_finite()) {
                return None;
            }
            self.sums = Some(sums);
        }
        self.sums.as_ref().map(Sums::from)
    }

    fn cost(&mut self, trial: &[f64], _: f64) -> f64 {
        let residual = self.problem.residual(trial);
        let cost = dot(&residual, &residual);
        self.tried = Some((trial.to_vec(), residual));
        cost
    }

    fn accept(&mut self) {
        if let Some((at, residual)) = self.tried.take() {
            (self.at, self.residual) = (at, residual);
            self.sums = None;
        }
    }
}
