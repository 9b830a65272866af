//! An axis with bristles along a run: what its state and the derivatives of its state are.

use crate::output_error::plant::{Axis, State, slot};
use crate::output_error::simulate::{Initial, Plant};
use crate::output_error::unknowns::{Layout, MOST, Unknown};
use stiction_parameters::Side;

/// An axis, and where the derivatives of its steps stand.
pub(crate) struct Bristles<'a> {
    axis: &'a Axis,
    /// Index of the derivative of each shared unknown among the derivatives of a step, and its direction.
    places: Vec<(usize, Side)>,
}

impl<'a> Bristles<'a> {
    /// `layout` where derivatives are asked for.
    pub fn new(axis: &'a Axis, layout: Option<&Layout>) -> Self {
        Self {
            axis,
            places: layout.map_or(Vec::new(), places),
        }
    }
}

impl Plant for Bristles<'_> {
    type State = State;
    /// Of position, velocity and deflection.
    type Slope = [f64; 3];

    fn start(&self, initial: &Initial) -> State {
        State {
            x: initial.0[0],
            v: initial.0[1],
            z: initial.0[2] * self.axis.sides[0].coulomb / self.axis.stiffness,
        }
    }

    fn start_slopes(&self, layout: &Layout, initial: &Initial) -> [[f64; 3]; MOST] {
        let mut slopes = [[0.0; 3]; MOST];
        let shared = layout.len();
        let z = self.start(initial).z;
        for (d, unknown) in slopes.iter_mut().zip(&layout.unknowns) {
            d[2] = match unknown {
                Unknown::Stiffness => -z,
                Unknown::Coulomb(side) if side.holds(0) => z,
                _ => 0.0,
            };
        }
        slopes[shared][0] = 1.0;
        slopes[shared + 1][1] = 1.0;
        slopes[shared + 2][2] = self.axis.sides[0].coulomb / self.axis.stiffness;
        slopes
    }

    #[inline]
    fn shown(&self, state: &State) -> State {
        *state
    }

    #[inline]
    fn position(state: &State) -> f64 {
        state.x
    }

    #[inline]
    fn position_slope(slope: &[f64; 3]) -> f64 {
        slope[0]
    }

    #[inline]
    fn step(&self, state: State, h: f64, force: f64) -> State {
        self.axis.step(state, h, force)
    }

    #[inline]
    fn advance(
        &self,
        state: State,
        h: f64,
        force: f64,
        _: &Layout,
        force_slopes: &[f64; MOST],
        slopes: &mut [[f64; 3]],
    ) -> State {
        let (next, step) = self.axis.step_with_slopes(state, h, force);
        let [by_x, by_v, by_z] = step.by_state;
        for (j, (d, du)) in slopes.iter_mut().zip(force_slopes).enumerate() {
            let [dx, dv, dz] = *d;
            let mut balance = by_x * dx + by_v * dv + by_z * dz - du;
            let mut z = 0.0;
            if let Some((slot, side)) = self.places.get(j)
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
}

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
            // What acts on the force only, and what bristles do not have.
            Unknown::Delay
            | Unknown::Reach(_)
            | Unknown::Yield(_)
            | Unknown::Ratio
            | Unknown::Attraction => (slot::FORCE_ONLY, Side::Both),
            Unknown::Wave(i) => (slot::WAVES + i, Side::Both),
        })
        .collect()
}
