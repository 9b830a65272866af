//! Recordings under a law that is known: only where each stretch starts is fitted to it.

use crate::error::Error;
use crate::fit::Fit;
use crate::output_error::descent::descend;
use crate::output_error::outcome::{Short, SimulationFit};
use crate::output_error::problem::{Point, Problem};
use crate::output_error::run::{self, Recording, Run};
use crate::output_error::signals::{Signals, signals};
use crate::output_error::simulate::Drive;
use crate::output_error::start::rest;
use crate::output_error::unknowns::Layout;
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use stiction_search::{Counts, Observer, Stage};

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
