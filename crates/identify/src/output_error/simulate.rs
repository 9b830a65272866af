//! One run simulated from its initial state, with the derivatives of position and force.

use crate::output_error::controller::{Controller, Memory};
use crate::output_error::drawn::Drawn;
use crate::output_error::plant::{Axis, State, slot};
use crate::output_error::run::{Hold, Run};
use crate::output_error::unknowns::{Layout, Unknown};
use stiction_parameters::Side;

/// Unknowns of each run: position, velocity, bristle deflection over `Fc/s0`, and with a PI controller
/// its integral.
pub(crate) const LOCALS: usize = 4;
/// Most unknowns in all: 13 of an asymmetric law, gravity and cogging, those of a run.
pub(crate) const MOST: usize = 32;

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
    mut see: impl FnMut(usize, &State, f64) -> bool,
) {
    let n = run.time.len();
    let periods = periods(run);
    let control = run.step / periods as f64;
    let h = control / drive.substeps as f64;
    let mut state = start(axis, initial);
    let mut memory = memory(initial, control);
    let mut before = None;
    let drawn = Drawn::new(run, drive.hold, axis.delay, drive.substeps);
    for k in 0..n {
        let mut logged = 0.0;
        let mut seen = false;
        let at = state;
        for i in 0..periods {
            let force = match drive.controller {
                Some(c) => {
                    let wanted = run.wanted[k * periods + i];
                    c.force(&mut memory, control, wanted, state.x).force
                }
                None => run.force[k],
            };
            if !seen {
                seen = true;
                logged = mean_with(before, force, drive.hold);
            }
            before = Some(force);
            if k + 1 < n {
                for j in 0..drive.substeps {
                    let force = match drive.controller {
                        Some(_) => force,
                        None => drawn.at(k, j),
                    };
                    state = axis.step(state, h, force);
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
    mut see: impl FnMut(usize, &Instant) -> bool,
) {
    let n = run.time.len();
    let periods = periods(run);
    let control = run.step / periods as f64;
    let h = control / drive.substeps as f64;
    let shared = layout.len();
    let count = shared + drive.locals();
    let places = places(layout);
    let mut state = start(axis, initial);
    let mut memory = memory(initial, control);
    let mut slopes = start_slopes(axis, layout, initial);
    let mut memories = [Memory::default(); MOST];
    // The position one control period before the first instant follows from the initial velocity.
    memories[shared].last = 1.0;
    memories[shared + 1].last = -control;
    memories[shared + 3].integral = 1.0;
    let mut force_slopes = [0.0; MOST];
    let mut logged_slopes = [0.0; MOST];
    let mut before = None;
    let drawn = Drawn::new(run, drive.hold, axis.delay, drive.substeps);
    let delay = layout.place(Unknown::Delay);
    for k in 0..n {
        let at = state;
        let mut position_slopes = [0.0; MOST];
        for (p, d) in position_slopes.iter_mut().zip(&slopes[..count]) {
            *p = d[0];
        }
        let mut logged = 0.0;
        for i in 0..periods {
            let old = force_slopes;
            let force = match drive.controller {
                Some(c) => {
                    let wanted = run.wanted[k * periods + i];
                    let command = c.force(&mut memory, control, wanted, state.x);
                    for j in 0..count {
                        force_slopes[j] =
                            c.slope(&mut memories[j], control, &command, slopes[j][0]);
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
            if k + 1 < n {
                for j in 0..drive.substeps {
                    let force = match drive.controller {
                        Some(_) => force,
                        None => drawn.at(k, j),
                    };
                    if let Some(own) = delay {
                        force_slopes[own] = drawn.slope(k, j);
                    }
                    state = advance(
                        axis,
                        state,
                        h,
                        force,
                        &places,
                        &force_slopes,
                        &mut slopes,
                        count,
                    );
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

/// One step of the axis and of all derivatives.
#[allow(clippy::too_many_arguments)]
#[inline]
fn advance(
    axis: &Axis,
    state: State,
    h: f64,
    force: f64,
    places: &[(usize, Side)],
    force_slopes: &[f64; MOST],
    slopes: &mut [[f64; 3]; MOST],
    count: usize,
) -> State {
    let (next, step) = axis.step_with_slopes(state, h, force);
    let [by_x, by_v, by_z] = step.by_state;
    for (j, (d, du)) in slopes.iter_mut().zip(force_slopes).take(count).enumerate() {
        let [dx, dv, dz] = *d;
        let mut balance = by_x * dx + by_v * dv + by_z * dz - du;
        let mut z = 0.0;
        if let Some((slot, side)) = places.get(j)
            && side.holds(step.side)
        {
            let (in_balance, in_z) = step.direct[*slot];
            balance += in_balance;
            z = in_z;
        }
        let dw = step.gain * balance;
        *d = [
            dx + h * dw,
            2.0 * dw - dv,
            step.z_by_z * dz + step.z_by_w * dw + z,
        ];
    }
    next
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

fn start(axis: &Axis, initial: &Initial) -> State {
    State {
        x: initial.0[0],
        v: initial.0[1],
        z: initial.0[2] * axis.sides[0].coulomb / axis.stiffness,
    }
}

fn memory(initial: &Initial, control: f64) -> Memory {
    Memory {
        last: initial.0[0] - control * initial.0[1],
        integral: initial.0[3],
    }
}

fn start_slopes(axis: &Axis, layout: &Layout, initial: &Initial) -> [[f64; 3]; MOST] {
    let mut slopes = [[0.0; 3]; MOST];
    let shared = layout.len();
    let z = start(axis, initial).z;
    for (d, unknown) in slopes.iter_mut().zip(&layout.unknowns) {
        d[2] = match unknown {
            Unknown::Stiffness => -z,
            Unknown::Coulomb(side) if side.holds(0) => z,
            _ => 0.0,
        };
    }
    slopes[shared][0] = 1.0;
    slopes[shared + 1][1] = 1.0;
    slopes[shared + 2][2] = axis.sides[0].coulomb / axis.stiffness;
    slopes
}

/// Index of the derivative of each shared unknown among the derivatives of a step, and its direction.
fn places(layout: &Layout) -> Vec<(usize, Side)> {
    layout
        .unknowns
        .iter()
        .map(|unknown| match *unknown {
            Unknown::Stiffness => (slot::STIFFNESS, Side::Both),
            Unknown::MicroDamping => (slot::MICRO_DAMPING, Side::Both),
            Unknown::Viscous(side) => (slot::VISCOUS, side),
            Unknown::Coulomb(side) => (slot::COULOMB, side),
            Unknown::Excess(side) => (slot::EXCESS, side),
            Unknown::Velocity(side) => (slot::VELOCITY, side),
            Unknown::Mass => (slot::MASS, Side::Both),
            Unknown::Offset => (slot::OFFSET, Side::Both),
            Unknown::Delay => (slot::FORCE_ONLY, Side::Both),
            Unknown::Wave(i) => (slot::WAVES + i, Side::Both),
        })
        .collect()
}
