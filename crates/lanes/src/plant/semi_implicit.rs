//! The semi-implicit step, axes in lanes: no equation to solve, one division.

use super::{Axis, Drive, Measured, Motion, Outcome};
use crate::curve::{Curve, Speed};
use crate::dispatch::Kernel;
use crate::exp::{exp, fma};
use crate::lane_array::{Aligned, lanes, read, write};

/// One axis, in units of its Coulomb level.
#[derive(Clone, Copy)]
struct Lane {
    curve: Curve,
    /// `M/h`.
    inertia: f64,
    /// `h kappa`.
    rate: f64,
    /// Fc.
    level: f64,
    micro_damping: f64,
    /// `1/(M/h + sigma1 + sigma2)`.
    yielding: f64,
}

impl Lane {
    fn new(axis: &Axis, h: f64) -> Self {
        let c = &axis.friction;
        let kappa = c.stiffness / c.coulomb;
        let excess = (c.static_friction - c.coulomb) / c.coulomb;
        let inertia = axis.mass / h;
        Lane {
            curve: Curve::new(kappa, excess, c.stribeck_velocity, c.exponent),
            inertia,
            rate: h * kappa,
            level: c.coulomb,
            micro_damping: c.micro_damping,
            yielding: 1.0 / (inertia + c.micro_damping + c.viscous),
        }
    }

    fn to_array(self) -> [f64; 9] {
        let c = self.curve;
        [
            c.excess,
            c.fall,
            c.exponent,
            c.ln_velocity,
            self.inertia,
            self.rate,
            self.level,
            self.micro_damping,
            self.yielding,
        ]
    }

    #[inline(always)]
    fn from_array(numbers: [f64; 9]) -> Self {
        let [excess, fall, exponent, ln_velocity, rest @ ..] = numbers;
        let [inertia, rate, level, micro_damping, yielding] = rest;
        Lane {
            curve: Curve {
                rate,
                excess,
                fall,
                exponent,
                ln_velocity,
            },
            inertia,
            rate,
            level,
            micro_damping,
            yielding,
        }
    }

    /// Velocity and `eta` at the end of a step that starts with `v` and `eta`.
    #[inline(always)]
    fn step<const POWER: bool>(&self, v: f64, eta: f64, force: f64) -> (f64, f64) {
        let speed = v.abs();
        let ln = if POWER { libm::log(speed) } else { 0.0 };
        let g = fma(
            self.curve.excess,
            exp(self.curve.exponent::<POWER>(Speed { value: speed, ln })),
            1.0,
        );
        let over_level = fma(self.rate, v, eta) / fma(self.rate, speed, g);
        let end = over_level * g;
        let slip = self.micro_damping * (speed * over_level);
        let pushed = fma(end, -self.level, fma(self.inertia, v, force)) + slip;
        (pushed * self.yielding, end)
    }
}

pub(super) struct SemiImplicit<'a, const N: usize, const POWER: bool> {
    drive: &'a Drive<'a>,
    lanes: Aligned<[[f64; N]; 9]>,
    /// `Fc/sigma0` of each lane.
    length: [f64; N],
    used: usize,
}

impl<'a, const N: usize, const POWER: bool> SemiImplicit<'a, N, POWER> {
    pub fn new(drive: &'a Drive, group: &[Axis]) -> Self {
        let all: [Lane; N] = lanes(group, |axis| Lane::new(axis, drive.step));
        let mut rows = Aligned([[0.0; N]; 9]);
        for (j, lane) in all.iter().enumerate() {
            write(&mut rows.0, j, lane.to_array());
        }
        SemiImplicit {
            drive,
            lanes: rows,
            length: lanes(group, |axis| {
                axis.friction.coulomb / axis.friction.stiffness
            }),
            used: group.len(),
        }
    }
}

impl<const N: usize, const POWER: bool> Kernel for SemiImplicit<'_, N, POWER> {
    type Output = Vec<Outcome>;

    #[inline(always)]
    fn run(self) -> Vec<Outcome> {
        let Drive {
            step: h,
            force,
            start,
            measured,
        } = *self.drive;
        let (measured, of_position) = match measured {
            Measured::Position(x) => (x, 1.0),
            Measured::Velocity(v) => (v, 0.0),
        };
        let mut x = Aligned([start.position; N]);
        let mut v = Aligned([start.velocity; N]);
        let mut eta = Aligned([0.0; N]);
        for j in 0..N {
            eta.0[j] = start.deflection / self.length[j];
        }
        let mut cost = Aligned([0.0; N]);
        for (&force, &measured) in force.iter().zip(measured) {
            for j in 0..N {
                let lane = Lane::from_array(read(&self.lanes.0, j));
                let (next, end) = lane.step::<POWER>(v.0[j], eta.0[j], force);
                v.0[j] = next;
                eta.0[j] = end;
                x.0[j] = fma(h, next, x.0[j]);
                let reached = fma(of_position, x.0[j] - next, next);
                cost.0[j] = fma(measured - reached, measured - reached, cost.0[j]);
            }
        }
        let outcome = |j: usize| {
            let end = Motion {
                position: x.0[j],
                velocity: v.0[j],
                deflection: eta.0[j] * self.length[j],
            };
            Outcome::new(cost.0[j], end)
        };
        (0..self.used).map(outcome).collect()
    }
}
