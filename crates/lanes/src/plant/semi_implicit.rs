//! The semi-implicit step, axes in lanes: no equation to solve, one division.

use super::drive::{Axis, Drive, Measured, Motion, Outcome};
use crate::curve::{Curve, Speed};
use crate::exp::{exps, fma};
use crate::lane_array::{Aligned, lanes, read, write};
use stiction_dispatch::Kernel;

/// One axis, in units of its Coulomb level.
#[derive(Clone, Copy)]
struct Lane {
    curve: Curve,
    /// `h kappa`.
    rate: f64,
    /// `1/(M/h + sigma1 + sigma2)`: velocity per force.
    yielding: f64,
    /// That times `M/h`, times Fc and times sigma1.
    inertia: f64,
    level: f64,
    micro_damping: f64,
}

impl Lane {
    fn new(axis: &Axis, h: f64) -> Self {
        let c = &axis.friction;
        let kappa = c.stiffness / c.coulomb;
        let excess = (c.static_friction - c.coulomb) / c.coulomb;
        let inertia = axis.mass / h;
        let yielding = 1.0 / (inertia + c.micro_damping + c.viscous);
        Lane {
            curve: Curve::new(kappa, excess, c.stribeck_velocity, c.exponent),
            rate: h * kappa,
            yielding,
            inertia: yielding * inertia,
            level: yielding * c.coulomb,
            micro_damping: yielding * c.micro_damping,
        }
    }

    fn to_array(self) -> [f64; 9] {
        let c = self.curve;
        [
            c.excess,
            c.fall,
            c.exponent,
            c.ln_velocity,
            self.rate,
            self.yielding,
            self.inertia,
            self.level,
            self.micro_damping,
        ]
    }

    #[inline(always)]
    fn from_array(numbers: [f64; 9]) -> Self {
        let [excess, fall, exponent, ln_velocity, rest @ ..] = numbers;
        let [rate, yielding, inertia, level, micro_damping] = rest;
        Lane {
            curve: Curve {
                rate,
                excess,
                fall,
                exponent,
                ln_velocity,
            },
            rate,
            yielding,
            inertia,
            level,
            micro_damping,
        }
    }
}

/// Axes whose chains of operations are written side by side.
const CHAINS: usize = 4;

/// Velocity and `eta` at the end of a step that starts with `v` and `eta`.
#[inline(always)]
fn step<const POWER: bool>(
    lanes: &[Lane; CHAINS],
    v: [f64; CHAINS],
    eta: [f64; CHAINS],
    force: f64,
) -> ([f64; CHAINS], [f64; CHAINS]) {
    let mut exponent = [0.0; CHAINS];
    for k in 0..CHAINS {
        let value = v[k].abs();
        let ln = if POWER { libm::log(value) } else { 0.0 };
        exponent[k] = lanes[k].curve.exponent::<POWER>(Speed { value, ln });
    }
    let fall = exps(exponent);
    let mut g = [0.0; CHAINS];
    let mut pull = [0.0; CHAINS];
    let mut over_level = [0.0; CHAINS];
    for k in 0..CHAINS {
        let lane = &lanes[k];
        g[k] = fma(lane.curve.excess, fall[k], 1.0);
        over_level[k] = fma(lane.rate, v[k], eta[k]) / fma(lane.rate, v[k].abs(), g[k]);
        pull[k] = fma(-lane.level, g[k], lane.micro_damping * v[k].abs());
    }
    let mut end = [0.0; CHAINS];
    let mut next = [0.0; CHAINS];
    for k in 0..CHAINS {
        let lane = &lanes[k];
        let free = fma(lane.inertia, v[k], lane.yielding * force);
        next[k] = fma(over_level[k], pull[k], free);
        end[k] = over_level[k] * g[k];
    }
    (next, end)
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
            Measured::Position(x) => (x, true),
            Measured::Velocity(v) => (v, false),
        };
        let mut x = Aligned([start.position; N]);
        let mut v = Aligned([start.velocity; N]);
        let mut eta = Aligned([0.0; N]);
        for j in 0..N {
            eta.0[j] = start.deflection / self.length[j];
        }
        let mut cost = Aligned([0.0; N]);
        for (&force, &measured) in force.iter().zip(measured) {
            for j in 0..N / CHAINS {
                let mut own = [Lane::from_array(read(&self.lanes.0, j)); CHAINS];
                let mut from = [[0.0; CHAINS]; 2];
                for k in 0..CHAINS {
                    let j = j + k * (N / CHAINS);
                    own[k] = Lane::from_array(read(&self.lanes.0, j));
                    from[0][k] = v.0[j];
                    from[1][k] = eta.0[j];
                }
                let (next, end) = step::<POWER>(&own, from[0], from[1], force);
                for k in 0..CHAINS {
                    let j = j + k * (N / CHAINS);
                    v.0[j] = next[k];
                    eta.0[j] = end[k];
                    x.0[j] = fma(h, next[k], x.0[j]);
                    let reached = if of_position { x.0[j] } else { next[k] };
                    cost.0[j] = fma(measured - reached, measured - reached, cost.0[j]);
                }
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
