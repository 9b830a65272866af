//! One run simulated from its initial state, with the derivatives of position and force.

use crate::output_error::bristles::Bristles;
use crate::output_error::controller::{Controller, Memory};
use crate::output_error::dead_time::Late;
use crate::output_error::drawn::Drawn;
use crate::output_error::elements::Slipping;
use crate::output_error::plant::{Axis, State};
use crate::output_error::run::{Hold, Run};
use crate::output_error::unknowns::{LOCALS, Layout, MOST, Unknown};

/// Where a run starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Initial(pub [f64; LOCALS]);

/// How the axis is driven and stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drive<'a> {
    pub controller: Option<&'a Controller>,
    pub hold: Hold,
    /// Plant steps in one control period (in open loop: in one sample).
    pub substeps: usize,
}

impl Drive<'_> {
    /// Unknowns of each run that are in use.
    pub fn locals(&self) -> usize {
        match self.controller {
            Some(c) if c.has_integral() => LOCALS,
            _ => LOCALS - 1,
        }
    }
}

/// An axis as it is stepped, whatever its friction remembers.
pub(crate) trait Plant {
    type State: Copy;
    /// Derivative of a state in one unknown.
    type Slope: Copy;

    fn start(&self, initial: &Initial) -> Self::State;

    /// Derivatives of the start in each unknown, those of the run last.
    fn start_slopes(&self, layout: &Layout, initial: &Initial) -> [Self::Slope; MOST];

    fn shown(&self, state: &Self::State) -> State;

    fn position(state: &Self::State) -> f64;

    fn position_slope(slope: &Self::Slope) -> f64;

    /// Advances by `h` seconds under a constant force.
    fn step(&self, state: Self::State, h: f64, force: f64) -> Self::State;

    /// The same for a state and all its derivatives.
    fn advance(
        &self,
        state: Self::State,
        h: f64,
        force: f64,
        layout: &Layout,
        force_slopes: &[f64; MOST],
        slopes: &mut [Self::Slope],
    ) -> Self::State;
}

/// Values at one instant: simulated position, velocity and force, with the derivatives of position and
/// force in each unknown, those of the run last; force only in closed loop.
pub(crate) struct Instant<'a> {
    pub state: State,
    pub force: f64,
    pub position_slopes: &'a [f64],
    pub force_slopes: &'a [f64],
}

/// Simulates a run and shows every sample to `see`, without derivatives, until `see` says no.
pub(crate) fn simulate(
    axis: &Axis,
    drive: &Drive,
    run: &Run,
    initial: &Initial,
    see: impl FnMut(usize, &State, f64) -> bool,
) {
    match &axis.elements {
        None => plain(&Bristles::new(axis, None), axis, drive, run, initial, see),
        Some(elements) => {
            let plant = Slipping::new(axis, elements);
            plain(&plant, axis, drive, run, initial, see);
        }
    }
}

fn plain<P: Plant>(
    plant: &P,
    axis: &Axis,
    drive: &Drive,
    run: &Run,
    initial: &Initial,
    mut see: impl FnMut(usize, &State, f64) -> bool,
) {
    let n = run.time.len();
    let periods = periods(run);
    let control = run.step / periods as f64;
    let h = control / drive.substeps as f64;
    let mut state = plant.start(initial);
    let mut memory = memory(initial, control);
    let mut before = None;
    let drawn = Drawn::new(run, drive, axis.delay);
    let is_late = drive.controller.is_some() && axis.delay < 0.0;
    let mut late = is_late.then(|| Late::new(axis.delay, control, drive.substeps));
    for k in 0..n {
        let mut logged = 0.0;
        let mut seen = false;
        let at = plant.shown(&state);
        for i in 0..periods {
            let force = match drive.controller {
                Some(c) => {
                    let wanted = run.wanted[k * periods + i];
                    c.force(&mut memory, control, wanted, P::position(&state))
                        .force
                }
                None => run.force[k],
            };
            if !seen {
                seen = true;
                logged = mean_with(before, force, drive.hold);
            }
            before = Some(force);
            if let Some(late) = &mut late {
                late.ask(force, &[0.0; MOST]);
            }
            if k + 1 < n {
                for j in 0..drive.substeps {
                    let own = match (&late, drive.controller) {
                        (Some(late), _) => late.at(j),
                        (None, Some(_)) => force,
                        (None, None) => 0.0,
                    };
                    let logged = drawn.at(k, i * drive.substeps + j);
                    state = plant.step(state, h, own + logged);
                }
            }
        }
        if !see(k, &at, logged) {
            return;
        }
    }
}

/// The same with the derivatives. `layout` says in which order the shared unknowns stand.
pub(crate) fn simulate_with_slopes(
    axis: &Axis,
    layout: &Layout,
    drive: &Drive,
    run: &Run,
    initial: &Initial,
    see: impl FnMut(usize, &Instant) -> bool,
) {
    match &axis.elements {
        None => {
            let plant = Bristles::new(axis, Some(layout));
            with_slopes(&plant, axis, layout, drive, run, initial, see);
        }
        Some(elements) => {
            let plant = Slipping::new(axis, elements);
            with_slopes(&plant, axis, layout, drive, run, initial, see);
        }
    }
}

#[allow(clippy::too_many_arguments)]
fn with_slopes<P: Plant>(
    plant: &P,
    axis: &Axis,
    layout: &Layout,
    drive: &Drive,
    run: &Run,
    initial: &Initial,
    mut see: impl FnMut(usize, &Instant) -> bool,
) {
    let n = run.time.len();
    let periods = periods(run);
    let control = run.step / periods as f64;
    let h = control / drive.substeps as f64;
    let shared = layout.len();
    let count = shared + drive.locals();
    let mut state = plant.start(initial);
    let mut memory = memory(initial, control);
    let mut slopes = plant.start_slopes(layout, initial);
    let mut memories = [Memory::default(); MOST];
    // The position one control period before the first instant follows from the initial velocity.
    memories[shared].last = 1.0;
    memories[shared + 1].last = -control;
    memories[shared + 3].integral = 1.0;
    let mut force_slopes = [0.0; MOST];
    let mut logged_slopes = [0.0; MOST];
    let mut before = None;
    let drawn = Drawn::new(run, drive, axis.delay);
    let delay = layout.place(Unknown::Delay);
    let is_late = drive.controller.is_some() && (axis.delay < 0.0 || delay.is_some());
    let mut late = is_late.then(|| Late::new(axis.delay, control, drive.substeps));
    let mut acting = [0.0; MOST];
    for k in 0..n {
        let at = plant.shown(&state);
        let mut position_slopes = [0.0; MOST];
        for (p, d) in position_slopes.iter_mut().zip(&slopes[..count]) {
            *p = P::position_slope(d);
        }
        let mut logged = 0.0;
        for i in 0..periods {
            let old = force_slopes;
            let force = match drive.controller {
                Some(c) => {
                    let wanted = run.wanted[k * periods + i];
                    let x = P::position(&state);
                    let command = c.force(&mut memory, control, wanted, x);
                    for j in 0..count {
                        let dx = P::position_slope(&slopes[j]);
                        force_slopes[j] = c.slope(&mut memories[j], control, &command, dx);
                    }
                    command.force
                }
                None => run.force[k],
            };
            if i == 0 {
                logged = mean_with(before, force, drive.hold);
                for j in 0..count {
                    logged_slopes[j] = match (drive.hold, before) {
                        (Hold::Centred, Some(_)) => 0.5 * (old[j] + force_slopes[j]),
                        _ => force_slopes[j],
                    };
                }
            }
            before = Some(force);
            if let Some(late) = &mut late {
                late.ask(force, &force_slopes);
            }
            if k + 1 < n {
                for j in 0..drive.substeps {
                    let (own, by) = match (&late, drive.controller) {
                        (Some(late), _) => {
                            late.slopes(j, delay, &mut acting[..count]);
                            (late.at(j), &acting)
                        }
                        (None, Some(_)) => (force, &force_slopes),
                        (None, None) => {
                            if let Some(own) = delay {
                                force_slopes[own] = drawn.slope(k, j);
                            }
                            (0.0, &force_slopes)
                        }
                    };
                    let force = own + drawn.at(k, i * drive.substeps + j);
                    let slopes = &mut slopes[..count];
                    state = plant.advance(state, h, force, layout, by, slopes);
                }
            }
        }
        let now = Instant {
            state: at,
            force: logged,
            position_slopes: &position_slopes[..count],
            force_slopes: &logged_slopes[..count],
        };
        if !see(k, &now) {
            return;
        }
    }
}

/// Control periods in one sample.
pub(crate) fn periods(run: &Run) -> usize {
    (run.wanted.len() / run.time.len().max(1)).max(1)
}

/// The force that the log shows for an instant, given the one held before it.
fn mean_with(before: Option<f64>, force: f64, hold: Hold) -> f64 {
    match (hold, before) {
        (Hold::Centred, Some(before)) => 0.5 * (before + force),
        _ => force,
    }
}

fn memory(initial: &Initial, control: f64) -> Memory {
    Memory {
        last: initial.0[0] - control * initial.0[1],
        integral: initial.0[3],
    }
}
