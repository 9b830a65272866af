//! A mass on a bristle under a force that is held: one step, its Jacobian, and how both depend on the unknowns.

use crate::exponential::exp;
use crate::state_space::relaxation::Relaxation;
use crate::state_space::tangent::{LANES, Sensitive, Tangent};
use crate::state_space::unknowns::{
    COULOMB, DAMPING, DISTURBANCE, EACH_SIDE, MASS, MEMORY, OFFSET, RATIO, STIFFNESS, UNKNOWNS,
    VELOCITY, VISCOUS, WHITE,
};

/// Stribeck exponent of the Gaussian curve.
pub(super) const GAUSSIAN: f64 = 2.0;
/// Most Newton iterations of a step.
const MOST_ITERATIONS: usize = 12;
/// Change of the mean velocity, as parts of the Stribeck velocity and of itself, after which an iteration is the last:
/// what it leaves is of the size of the square.
const LAST_CHANGE: [f64; 2] = [1e-7, 1e-8];

/// Friction in one direction of motion; a number in one lane, or in all.
#[derive(Clone, Copy)]
struct Side<T> {
    /// Fc, N (N m).
    coulomb: T,
    /// Fs - Fc, N (N m).
    rise: T,
    /// One over the Stribeck velocity, s/m (s/rad).
    inverse_velocity: T,
    /// sigma2, N s/m (N m s/rad).
    viscous: T,
}

/// What else a step depends on.
#[derive(Clone, Copy)]
struct Body<T> {
    /// sigma0, N/m (N m/rad).
    stiffness: T,
    /// sigma1 over the substep.
    damping: T,
    /// Half the substep over the mass.
    mobility: T,
    /// Constant force, N (N m).
    offset: T,
}

/// An axis at one trial of the unknowns.
pub(super) struct Axis {
    sides: [Side<Sensitive>; 2],
    body: Body<Sensitive>,
    /// Stribeck exponent.
    exponent: f64,
    /// Length of a substep, s.
    substep: f64,
    substeps: u32,
    /// Variance of the white error of the force.
    pub white: Sensitive,
    /// Variance of the disturbance, and what of it is new in each sample.
    pub disturbance: Sensitive,
    pub renewed: Sensitive,
    /// Part of the disturbance that is left a sample later.
    pub kept: Sensitive,
}

/// Position, velocity, deflection, disturbance.
pub(super) type State = [Sensitive; 4];

/// Derivatives of position, velocity and deflection after a sample (rows) by velocity and deflection before and by the force
/// (columns). By the position the position has one, the others zero.
pub(super) type Jacobian = [[Sensitive; 3]; 3];

/// No step at all.
const STILL: Jacobian = {
    let (zero, one) = (Sensitive::ZERO, Sensitive::constant(1.0));
    [[zero; 3], [one, zero, zero], [zero, one, zero]]
};

/// The numbers of a step that take an exponential or an iteration.
#[derive(Clone, Copy)]
struct Moment {
    /// Mean velocity.
    mean: f64,
    /// Which direction, and its sign.
    side: usize,
    sign: f64,
    /// Its size in Stribeck velocities to the Stribeck exponent, and the derivative of that by them.
    power: [f64; 2],
    /// Part of the rise of static over Coulomb friction that is left at the mean velocity.
    bell: f64,
    relaxation: Relaxation,
}

/// A step before its mean velocity is known as a function of what it depends on.
#[derive(Clone, Copy)]
struct Terms {
    /// Balance of the forces, in velocities: zero.
    balance: Tangent,
    deflection: Tangent,
    /// Derivative of the deflection by the mean velocity.
    deflection_slope: Tangent,
    /// Part of a deflection that is left.
    end: Tangent,
    /// Derivatives of friction by the deflection before, and of the balance by the mean velocity.
    by_deflection: Tangent,
    by_mean: Tangent,
}

impl Axis {
    /// Axis at the unknowns `at` with a Stribeck exponent, and samples `step` seconds apart; `directed` where each direction has
    /// its own unknowns.
    pub fn at(
        at: &[f64; UNKNOWNS],
        exponent: f64,
        directed: bool,
        step: f64,
        substeps: u32,
    ) -> Self {
        let substep = step / f64::from(substeps);
        let unknown = |value: f64, slope: f64, own: usize, k: usize| Tangent {
            value,
            slope: if k == own { slope } else { 0.0 },
        };
        let log = |own: usize, k: usize| {
            let value = exp(at[own]);
            unknown(value, value, own, k)
        };
        let side = |side: usize| {
            let shift = side * EACH_SIDE;
            let coulomb = |k| log(COULOMB + shift, k);
            Side {
                coulomb: Sensitive::of(coulomb),
                rise: Sensitive::of(|k| log(RATIO + shift, k).times(coulomb(k)).minus(coulomb(k))),
                inverse_velocity: Sensitive::of(|k| log(VELOCITY + shift, k).inverse()),
                viscous: Sensitive::of(|k| log(VISCOUS + shift, k)),
            }
        };
        let rate = exp(-at[MEMORY]);
        let left = exp(-rate);
        let kept = |k| unknown(left, left * rate, MEMORY, k);
        let disturbance = |k| log(DISTURBANCE, k).times(log(DISTURBANCE, k));
        Self {
            sides: [side(0), side(usize::from(directed))],
            body: Body {
                stiffness: Sensitive::of(|k| log(STIFFNESS, k)),
                damping: Sensitive::of(|k| log(DAMPING, k).scaled(1.0 / substep)),
                mobility: Sensitive::of(|k| log(MASS, k).inverse().scaled(0.5 * substep)),
                offset: Sensitive::of(|k| unknown(at[OFFSET], 1.0, OFFSET, k)),
            },
            exponent,
            substep,
            substeps,
            white: Sensitive::of(|k| log(WHITE, k).times(log(WHITE, k))),
            renewed: Sensitive::of(|k| {
                let left = disturbance(k).times(kept(k));
                disturbance(k).minus_product(left, kept(k))
            }),
            disturbance: Sensitive::of(disturbance),
            kept: Sensitive::of(kept),
        }
    }

    /// Advances a state by a sample under a logged force.
    #[inline(always)]
    pub fn advance(&self, state: &mut State, jacobian: &mut Jacobian, force: f64) {
        *jacobian = STILL;
        for _ in 0..self.substeps {
            self.substep(state, jacobian, force);
        }
        let (kept, disturbance) = (&self.kept, &mut state[3]);
        let value = disturbance.value;
        for k in 0..LANES {
            let before = Tangent {
                value,
                slope: disturbance.slope.0[k],
            };
            disturbance.slope.0[k] = before.times(kept.lane(k)).slope;
        }
        disturbance.value *= kept.value;
    }

    #[inline(always)]
    fn substep(&self, state: &mut State, jacobian: &mut Jacobian, force: f64) {
        let [x, v, z, d] = [0, 1, 2, 3].map(|i| state[i].value);
        let moment = self.moment(v, z, force + d - self.body.offset.value);
        let side = &self.sides[moment.side];
        // What the step depends on through its mean velocity, which the balance determines.
        let alone = Tangent {
            value: moment.mean,
            slope: 1.0,
        };
        let here = |number: &Sensitive| Tangent::constant(number.value);
        let through = self.terms(
            &moment,
            side.map(here),
            self.body.map(here),
            alone,
            [v, z, d].map(Tangent::constant),
            force,
        );
        let stiff = -1.0 / through.balance.slope;
        let j = jacobian.map(|row| row.map(|number| number.value));
        let mut values = ([0.0; 3], [[0.0; 3]; 3]);
        let [position, velocity, deflection, disturbance] = state;
        for k in 0..LANES {
            let state = [
                Tangent {
                    value: v,
                    slope: velocity.slope.0[k],
                },
                Tangent {
                    value: z,
                    slope: deflection.slope.0[k],
                },
                Tangent {
                    value: d,
                    slope: disturbance.slope.0[k],
                },
            ];
            let lane = |number: &Sensitive| number.lane(k);
            let body = self.body.map(lane);
            let terms = self.terms(
                &moment,
                side.map(lane),
                body,
                Tangent::constant(moment.mean),
                state,
                force,
            );
            let mean = Tangent {
                value: moment.mean,
                slope: stiff * terms.balance.slope,
            };
            let along = |own: Tangent, through: Tangent| own.through(through.slope, mean.slope);
            let last = along(terms.deflection, through.deflection);
            let slope = along(terms.deflection_slope, through.deflection_slope);
            let end = along(terms.end, through.end);
            let by_deflection = along(terms.by_deflection, through.by_deflection);
            let by_velocity = along(terms.by_mean, through.by_mean).inverse();
            let by_force = body.mobility.times(by_velocity);
            let by_deflection = Tangent::ZERO.minus_product(by_force, by_deflection);
            // Two rows of the three columns of the Jacobian make a third; without a loop inside the lanes.
            let before = |row: usize, column: usize, jacobian: &Jacobian| Tangent {
                value: j[row][column],
                slope: jacobian[row][column].slope.0[k],
            };
            let column = |column: usize, direct: Tangent, jacobian: &mut Jacobian| {
                let (way, speed, bend) = (
                    before(0, column, jacobian),
                    before(1, column, jacobian),
                    before(2, column, jacobian),
                );
                let by = direct.plus_product(by_velocity, speed);
                let by = by.plus_product(by_deflection, bend);
                let way = way.plus_scaled(self.substep, by);
                let speed = by.scaled(2.0).minus(speed);
                let bend = end.times(bend).plus_product(slope, by);
                jacobian[0][column].slope.0[k] = way.slope;
                jacobian[1][column].slope.0[k] = speed.slope;
                jacobian[2][column].slope.0[k] = bend.slope;
                [way.value, speed.value, bend.value]
            };
            let columns = [
                column(0, Tangent::ZERO, jacobian),
                column(1, Tangent::ZERO, jacobian),
                column(2, by_force, jacobian),
            ];
            let way = Tangent {
                value: x,
                slope: position.slope.0[k],
            };
            let way = way.plus_scaled(self.substep, mean);
            let speed = mean.scaled(2.0).minus(state[0]);
            position.slope.0[k] = way.slope;
            velocity.slope.0[k] = speed.slope;
            deflection.slope.0[k] = last.slope;
            values = ([way.value, speed.value, last.value], columns);
        }
        let ([x, v, z], columns) = values;
        position.value = x;
        velocity.value = v;
        deflection.value = z;
        for (column, rows) in columns.iter().enumerate() {
            for (row, value) in rows.iter().enumerate() {
                jacobian[row][column].value = *value;
            }
        }
    }

    /// The step with a mean velocity given.
    #[inline(always)]
    fn terms(
        &self,
        moment: &Moment,
        side: Side<Tangent>,
        body: Body<Tangent>,
        mean: Tangent,
        [velocity, deflection, disturbance]: [Tangent; 3],
        force: f64,
    ) -> Terms {
        let Relaxation {
            end,
            mean: average,
            ramp,
        } = moment.relaxation;
        let turn = mean.times(side.inverse_velocity);
        let [power, power_slope] = moment.power;
        let bell = turn.mapped(moment.bell, -power_slope * moment.bell);
        let left = side.rise.times(bell);
        let slower = side.coulomb.plus(left).inverse();
        let per_speed = body
            .stiffness
            .times(slower)
            .scaled(self.substep * moment.sign);
        let length = per_speed.times(mean);
        // Its derivative by the mean velocity: the level falls as well.
        let falls = left.times(slower).times(turn.mapped(power, power_slope));
        let longer = per_speed.plus_product(per_speed, falls.scaled(self.exponent));
        let [end, end_slope] = derived(length, end);
        let [average, average_slope] = derived(length, average);
        let [ramp, ramp_slope] = derived(length, ramp);
        let way = mean.scaled(self.substep);
        let middle = deflection.times(average).plus_product(way, ramp);
        let last = deflection.times(end).plus_product(way, average);
        let by_length = deflection
            .times(average_slope)
            .plus_product(way, ramp_slope);
        let middle_slope = ramp.scaled(self.substep).plus_product(longer, by_length);
        let by_length = deflection.times(end_slope).plus_product(way, average_slope);
        let last_slope = average.scaled(self.substep).plus_product(longer, by_length);
        let friction = body.stiffness.times(middle);
        let friction = friction.plus_product(body.damping, last.minus(deflection));
        let friction = friction.plus_product(side.viscous, mean);
        let driving = disturbance.minus(body.offset).raised(force);
        let by_mean = side.viscous.plus_product(body.stiffness, middle_slope);
        let by_mean = by_mean.plus_product(body.damping, last_slope);
        let by_deflection = body.stiffness.times(average);
        Terms {
            balance: mean
                .minus(velocity)
                .minus_product(body.mobility, driving.minus(friction)),
            deflection: last,
            deflection_slope: last_slope,
            by_deflection: by_deflection.plus_product(body.damping, end.raised(-1.0)),
            by_mean: Tangent::constant(1.0).plus_product(body.mobility, by_mean),
            end,
        }
    }

    /// The mean velocity of a substep that balances the forces, and what follows from it.
    #[inline(always)]
    fn moment(&self, velocity: f64, deflection: f64, driving: f64) -> Moment {
        let mut mean = velocity;
        for _ in 0..MOST_ITERATIONS {
            let [balance, slope] = self.balance(mean, velocity, deflection, driving);
            let change = balance / slope;
            mean -= change;
            let side = &self.sides[usize::from(mean < 0.0)];
            let least = LAST_CHANGE[0] / side.inverse_velocity.value;
            if change.abs() <= least + LAST_CHANGE[1] * mean.abs() || change.is_nan() {
                break;
            }
        }
        self.at_mean(mean)
    }

    #[inline(always)]
    fn at_mean(&self, mean: f64) -> Moment {
        let index = usize::from(mean < 0.0);
        let side = &self.sides[index];
        let sign = if index == 0 { 1.0 } else { -1.0 };
        let turn = mean * side.inverse_velocity.value;
        let power = self.power(turn);
        let bell = exp(-power[0]);
        let level = side.coulomb.value + side.rise.value * bell;
        let length = self.body.stiffness.value * self.substep * mean.abs() / level;
        Moment {
            mean,
            side: index,
            sign,
            power,
            bell,
            relaxation: Relaxation::of(length),
        }
    }

    /// A velocity in Stribeck velocities, its size to the Stribeck exponent, and the derivative of that.
    #[inline(always)]
    fn power(&self, turn: f64) -> [f64; 2] {
        if self.exponent == GAUSSIAN {
            return [turn * turn, 2.0 * turn];
        }
        if turn == 0.0 {
            return [0.0; 2];
        }
        let power = exp(self.exponent * libm::log(turn.abs()));
        [power, self.exponent * power / turn]
    }

    /// Balance of the forces at a mean velocity, and its derivative.
    #[inline(always)]
    fn balance(&self, mean: f64, velocity: f64, deflection: f64, driving: f64) -> [f64; 2] {
        let at = self.at_mean(mean);
        let side = &self.sides[at.side];
        let Body {
            stiffness,
            damping,
            mobility,
            ..
        } = &self.body;
        let relaxation = at.relaxation;
        let left = side.rise.value * at.bell;
        let slower = 1.0 / (side.coulomb.value + left);
        let longer = stiffness.value * self.substep * slower * at.sign;
        let longer = longer * (1.0 + self.exponent * left * slower * at.power[0]);
        let way = self.substep * mean;
        let middle = deflection * relaxation.mean[0] + way * relaxation.ramp[0];
        let last = deflection * relaxation.end[0] + way * relaxation.mean[0];
        let slope = |own: f64, first: f64, second: f64| {
            self.substep * own + longer * (deflection * first + way * second)
        };
        let middle_slope = slope(relaxation.ramp[0], relaxation.mean[1], relaxation.ramp[1]);
        let last_slope = slope(relaxation.mean[0], relaxation.end[1], relaxation.mean[1]);
        let friction = stiffness.value * middle
            + damping.value * (last - deflection)
            + side.viscous.value * mean;
        let by_mean =
            stiffness.value * middle_slope + damping.value * last_slope + side.viscous.value;
        [
            mean - velocity - mobility.value * (driving - friction),
            1.0 + mobility.value * by_mean,
        ]
    }
}

impl<T> Side<T> {
    #[inline(always)]
    fn map<U>(&self, f: impl Fn(&T) -> U) -> Side<U> {
        Side {
            coulomb: f(&self.coulomb),
            rise: f(&self.rise),
            inverse_velocity: f(&self.inverse_velocity),
            viscous: f(&self.viscous),
        }
    }
}

impl<T> Body<T> {
    #[inline(always)]
    fn map<U>(&self, f: impl Fn(&T) -> U) -> Body<U> {
        Body {
            stiffness: f(&self.stiffness),
            damping: f(&self.damping),
            mobility: f(&self.mobility),
            offset: f(&self.offset),
        }
    }
}

/// A function of a length and its derivative by it, from the values of both and of the second derivative.
#[inline(always)]
fn derived(length: Tangent, at: [f64; 3]) -> [Tangent; 2] {
    [length.mapped(at[0], at[1]), length.mapped(at[1], at[2])]
}
