//! Result of a fit by simulation: parameters with their intervals, signals, and the size of the error.

use crate::estimate::advice;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::series::Series;
use crate::estimate::sliding;
use crate::fit::Fit;
use crate::law::Law;
use crate::law::terms::Terms;
use crate::output_error::controller::Controller;
use crate::output_error::covariance::covariance;
use crate::output_error::descent::Descent;
use crate::output_error::physical::{insert_given, parameters};
use crate::output_error::places;
use crate::output_error::plant::Axis;
use crate::output_error::run::{self, Hold};
use crate::output_error::search::{Found, Search};
use crate::output_error::signals::{Signals, signals};
use crate::output_error::simulate::Drive;
use crate::output_error::unknowns::Unknown;
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use crate::parameter::physical::{Physical, propagate};
use crate::scatter::Variances;
use nalgebra::DMatrix;
use stiction_parameters::Quantity;
use stiction_search::{Counts, Status};

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
    /// Whether the axis never breaks away in the logs: its levels are open then.
    pub never_breaks_away: bool,
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
    pub(crate) axis: Axis,
    pub(crate) controller: Option<Controller>,
    pub(crate) hold: Hold,
    pub(crate) segment: Option<f64>,
    pub(crate) weights: [f64; 2],
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
    let at = places::in_order(&problem.layout, at);
    let axis = problem.layout.write(&problem.base, &at.q);
    let signals = signals(&problem, &at);
    let position = match status {
        Status::Interrupted => signals.position_fit_at_once(),
        _ => signals.position_fit(),
    };
    let held: Vec<bool> = problem
        .layout
        .unknowns
        .iter()
        .zip(&at.q)
        .map(|(unknown, x)| match unknown {
            Unknown::Viscous(_) => *x <= 0.0,
            Unknown::Delay => search.scale.acts_at_once(*x),
            _ => false,
        })
        .collect();
    let is_stopped = status == Status::Interrupted;
    // What a stopped search has found has no intervals.
    let (unknowns, without) = match is_stopped {
        true => (
            DMatrix::from_element(held.len(), held.len(), f64::INFINITY),
            vec![false; held.len()],
        ),
        false => covariance(&problem, &at, &held),
    };
    let mut raw = parameters(&law, &problem.layout, &axis, &at.q, search.scale.centre);
    // No dead time is an answer, and not one with an interval.
    let at_once = |p: &Physical| p.name == Quantity::Delay && p.nonlinear.is_some_and(|k| held[k]);
    raw.retain(|p| !at_once(p));
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
            Parameter::judged(p, Variances::known(matrix[(i, i)]), None, reason, size)
        })
        .collect();
    insert_given(&mut parameters, &law, terms);
    let covariance = Covariance::new(raw.iter().map(|p| p.name).collect(), &matrix);
    sliding::flag_one_direction(&mut parameters, || {
        signals.moves_both_ways(search.simulation.quantum)
    });
    let value = |quantity: Quantity| {
        parameters
            .iter()
            .find(|p| p.name == quantity)
            .map_or(0.0, |p| p.value)
    };
    let inertia = value(Quantity::Mass) * signals.acceleration_rms();
    let left = value(Quantity::Sigma0) * position.rmse;
    let never_breaks_away = sliding::flag_what_never_breaks_away(
        &mut parameters,
        signals.stroke(),
        signals
            .friction
            .iter()
            .fold(0.0, |most: f64, f| most.max(f.abs())),
        (inertia, left),
    );
    advice::explain(&mut parameters, &covariance);
    let top = signals.velocity.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut fitted = FittedLaw {
        law,
        terms: terms.clone(),
        parameters,
        covariance,
        fit: position,
        low_speed: None,
        low_speed_bound: 0.02 * top,
        effects: Vec::new(),
        disagreements: Vec::new(),
        likelier_exponent: None,
        of_the_counts: false,
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
    if is_stopped {
        fitted.stopped();
    }
    SimulationFit {
        fitted,
        never_breaks_away,
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
