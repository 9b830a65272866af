//! The step MID of `stiction-servo`, but without its correction for the curvature of the deflection within a step;
//! axes in lanes.

use super::drive::{Axis, Drive, Measured, Motion, Outcome};
use crate::curve::{Curve, Speed};
use crate::exp::{LOWEST_ARGUMENT, at_least, at_most, exp, expm1, fma};
use crate::lane_array::{Aligned, lanes, read, write};
use stiction_dispatch::Kernel;

/// Most evaluations of the equation in one step. Bisection alone would need about sixty.
const MOST_EVALUATIONS: u32 = 200;

/// One axis, in units of its Coulomb level.
#[derive(Clone, Copy)]
struct Lane {
    curve: Curve,
    /// `2 M/h`.
    inertia: f64,
    /// `h kappa`.
    rate: f64,
    /// Fc.
    level: f64,
    /// `sigma1/(kappa h)`.
    damping: f64,
    viscous: f64,
    /// Speed that counts as standstill, 1e-12 of the Stribeck velocity, m/s (rad/s).
    negligible: f64,
    /// Upper bound of the mean friction force without the viscous part, divided by the inertia, m/s (rad/s).
    reach: f64,
}

impl Lane {
    fn new(axis: &Axis, h: f64) -> Self {
        let c = &axis.friction;
        let kappa = c.stiffness / c.coulomb;
        let excess = (c.static_friction - c.coulomb) / c.coulomb;
        let (inertia, damping) = (2.0 * axis.mass / h, c.micro_damping / (kappa * h));
        Lane {
            curve: Curve::new(kappa, excess, c.stribeck_velocity, c.exponent),
            inertia,
            rate: h * kappa,
            level: c.coulomb,
            damping,
            viscous: c.viscous,
            negligible: 1e-12 * c.stribeck_velocity,
            reach: (c.coulomb + 2.0 * damping) * (1.0 + excess) / inertia,
        }
    }

    fn to_array(self) -> [f64; 12] {
        let c = self.curve;
        [
            c.rate,
            c.excess,
            c.fall,
            c.exponent,
            c.ln_velocity,
            self.inertia,
            self.rate,
            self.level,
            self.damping,
            self.viscous,
            self.negligible,
            self.reach,
        ]
    }

    #[inline(always)]
    fn from_array(numbers: [f64; 12]) -> Self {
        let [rate, excess, fall, exponent, ln_velocity, rest @ ..] = numbers;
        let curve = Curve {
            rate,
            excess,
            fall,
            exponent,
            ln_velocity,
        };
        let [inertia, rate, level, damping, viscous, negligible, reach] = rest;
        Lane {
            curve,
            inertia,
            rate,
            level,
            damping,
            viscous,
            negligible,
            reach,
        }
    }

    /// `eta` at the end of a step with the mean velocity `w`, and its derivative.
    #[inline(always)]
    fn end<const POWER: bool>(&self, eta: f64, w: f64) -> (f64, f64) {
        let speed = w.abs();
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        let ln = if POWER { libm::log(speed) } else { 0.0 };
        let exponent = at_least(
            self.curve.exponent::<POWER>(Speed { value: speed, ln }),
            LOWEST_ARGUMENT,
        );
        let fall = self.curve.excess * exp(exponent);
        let g = 1.0 + fall;
        let inverse = 1.0 / g;
        let rate = self.rate * inverse;
        let e = expm1(at_least(-(rate * speed), LOWEST_ARGUMENT));
        // With signs as in the direction of motion.
        let gaussian = 2.0 * self.curve.fall * speed;
        let falls = if POWER && self.curve.exponent != 2.0 {
            self.curve.exponent * exponent / at_least(speed, f64::MIN_POSITIVE)
        } else {
            gaussian
        };
        let g_slope = if fall > 0.0 { fall * falls } else { 0.0 };
        let lag = fma(sign, eta, -g);
        let length_slope = rate * fma(-(speed * inverse), g_slope, 1.0);
        let slope = -fma(lag * (1.0 + e), length_slope, g_slope * e);
        (fma(sign * lag, e, eta), slope)
    }

    /// Residual of the equation of motion at the mean velocity `w`: inertia and friction minus drive; and its
    /// derivative.
    #[inline(always)]
    fn balance<const POWER: bool>(&self, v: f64, eta: f64, force: f64, w: f64) -> (f64, f64) {
        let (end, end_slope) = self.end::<POWER>(eta, w);
        let bristle = fma(0.5 * self.level, eta + end, self.damping * (end - eta));
        let excess = fma(self.inertia, w - v, fma(self.viscous, w, bristle)) - force;
        let stiff = fma(0.5, self.level, self.damping);
        (excess, fma(end_slope, stiff, self.inertia + self.viscous))
    }
}

/// The axes, one array for each quantity.
struct Lanes<const N: usize>(Aligned<[[f64; N]; 12]>);

impl<const N: usize> Lanes<N> {
    fn new(lanes: &[Lane; N]) -> Self {
        let mut rows = Aligned([[0.0; N]; 12]);
        for (j, lane) in lanes.iter().enumerate() {
            write(&mut rows.0, j, lane.to_array());
        }
        Lanes(rows)
    }

    #[inline(always)]
    fn at(&self, j: usize) -> Lane {
        Lane::from_array(read(&self.0.0, j))
    }
}

pub(super) struct Midpoint<'a, const N: usize, const POWER: bool> {
    drive: &'a Drive<'a>,
    lanes: Lanes<N>,
    /// `Fc/sigma0` of each lane.
    length: [f64; N],
    used: usize,
}

impl<'a, const N: usize, const POWER: bool> Midpoint<'a, N, POWER> {
    pub fn new(drive: &'a Drive, group: &[Axis]) -> Self {
        Midpoint {
            drive,
            lanes: Lanes::new(&lanes(group, |axis| Lane::new(axis, drive.step))),
            length: lanes(group, |axis| {
                axis.friction.coulomb / axis.friction.stiffness
            }),
            used: group.len(),
        }
    }
}

/// The search for the mean velocity of each lane.
struct Search<const N: usize> {
    w: Aligned<[f64; N]>,
    low: Aligned<[f64; N]>,
    high: Aligned<[f64; N]>,
    last_move: Aligned<[f64; N]>,
    /// 1 while the lane is searching, then 0.
    open: Aligned<[f64; N]>,
}

impl<const N: usize, const POWER: bool> Kernel for Midpoint<'_, N, POWER> {
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
        let all = &self.lanes;
        let mut x = Aligned([start.position; N]);
        let mut v = Aligned([start.velocity; N]);
        let mut eta = Aligned([0.0; N]);
        for j in 0..N {
            eta.0[j] = start.deflection / self.length[j];
        }
        let mut cost = Aligned([0.0; N]);
        let zero = Aligned([0.0; N]);
        let mut search = Search {
            w: v,
            low: zero,
            high: zero,
            last_move: zero,
            open: zero,
        };
        for (&force, &measured) in force.iter().zip(measured) {
            search.bracket(all, &v.0, force);
            for _ in 0..MOST_EVALUATIONS {
                search.improve::<POWER>(all, &v.0, &eta.0, force);
                let mut open = 0;
                for j in 0..N {
                    open |= search.open.0[j].to_bits();
                }
                if open == 0 {
                    break;
                }
            }
            for j in 0..N {
                let w = search.w.0[j];
                let bound = 1.0 + all.at(j).curve.excess;
                let end = all.at(j).end::<POWER>(eta.0[j], w).0;
                eta.0[j] = at_least(at_most(end, bound), -bound);
                x.0[j] = fma(h, w, x.0[j]);
                v.0[j] = fma(2.0, w, -v.0[j]);
                let reached = fma(of_position, x.0[j] - v.0[j], v.0[j]);
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

impl<const N: usize> Search<N> {
    /// Bracket of the mean velocity: from standstill to that of the axis without friction, widened at both ends by
    /// the most that the bristles can change it.
    #[inline(always)]
    fn bracket(&mut self, lanes: &Lanes<N>, v: &[f64; N], force: f64) {
        for j in 0..N {
            let free = v[j] + force / lanes.at(j).inertia;
            // The small additional margin makes sure that rounding does not exclude the solution.
            let reach = 1.01 * lanes.at(j).reach + 1e-6 * (free.abs() + v[j].abs());
            let low = at_most(free, 0.0) - reach;
            let high = at_least(free, 0.0) + reach;
            self.low.0[j] = low;
            self.high.0[j] = high;
            // First guess: the velocity extrapolated from the step before.
            let guess = fma(2.0, v[j], -self.w.0[j]);
            self.w.0[j] = at_most(at_least(guess, low), high);
            self.last_move.0[j] = high - low;
            self.open.0[j] = 1.0;
        }
    }

    /// One step of Newton's method, or a bisection where it leaves the bracket or is slow.
    #[inline(always)]
    fn improve<const POWER: bool>(
        &mut self,
        lanes: &Lanes<N>,
        v: &[f64; N],
        eta: &[f64; N],
        force: f64,
    ) {
        for j in 0..N {
            let w = self.w.0[j];
            let (excess, slope) = lanes.at(j).balance::<POWER>(v[j], eta[j], force, w);
            let high = if excess > 0.0 { w } else { self.high.0[j] };
            let low = if excess > 0.0 { self.low.0[j] } else { w };
            let newton = w - excess / slope;
            let moves = (newton - w).abs();
            // Newton converges quadratically: after a move of 1e-8 what remains is rounding.
            let negligible = lanes.at(j).negligible;
            let solved = moves <= fma(1e-8, w.abs(), negligible);
            let least = at_least(4.0 * f64::EPSILON * w.abs(), 1e-3 * negligible);
            let shut = high - low <= least;
            let trusted = (newton > low) & (newton < high) & (2.0 * moves <= self.last_move.0[j]);
            let next = if trusted { newton } else { 0.5 * (low + high) };
            let next = if shut { w } else { next };
            let next = if solved { newton } else { next };
            let open = self.open.0[j] != 0.0;
            self.last_move.0[j] = (next - w).abs();
            self.high.0[j] = high;
            self.low.0[j] = low;
            self.w.0[j] = if open { next } else { w };
            self.open.0[j] = if solved | shut { 0.0 } else { self.open.0[j] };
        }
    }
}
