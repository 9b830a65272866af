//! One step of a mass with LuGre friction under a force, with its derivatives.
//!
//! This is the implicit-midpoint step MID of `stiction_servo::plant` with a force that is constant
//! over the step, differentiated by the implicit function theorem: the derivatives are those of the
//! computed step itself, not of the differential equation behind it. The mean force is computed from the
//! mean of the states at both ends, without the correction of the servo crate: its derivatives would cost
//! more than smaller steps of the same accuracy. The servo crate is the reference it is tested against.

use crate::output_error::elements::Elements;
use libm::{cos, exp, expm1, fabs, pow, sin};
use stiction_friction::LuGre;
use stiction_parameters::{LawKind, Name, ParameterSet, Quantity, Side};

/// The steady curve in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Curve {
    /// Fc, N (N m).
    pub coulomb: f64,
    /// Fs, N (N m).
    pub fixed: f64,
    /// vs, m/s (rad/s).
    pub velocity: f64,
    /// s2, N s/m (N m s/rad).
    pub viscous: f64,
}

/// A force that is a sine of the position: `factor * sin(rate x)`, or the cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wave {
    /// 1/m (1/rad).
    pub rate: f64,
    pub is_cosine: bool,
    /// N (N m).
    pub factor: f64,
}

impl Wave {
    pub fn sine(rate: f64) -> Self {
        Self {
            rate,
            is_cosine: false,
            factor: 0.0,
        }
    }

    pub fn cosine(rate: f64) -> Self {
        Self {
            is_cosine: true,
            ..Self::sine(rate)
        }
    }

    /// Its shape at a position, and the slope of the shape.
    pub fn shape(&self, x: f64) -> (f64, f64) {
        let angle = self.rate * x;
        if self.is_cosine {
            (cos(angle), -self.rate * sin(angle))
        } else {
            (sin(angle), self.rate * cos(angle))
        }
    }
}

/// Everything that decides how the axis moves under a force.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    /// s0, N/m (N m/rad).
    pub stiffness: f64,
    /// s1, N s/m (N m s/rad).
    pub micro_damping: f64,
    /// Positive and negative direction of motion.
    pub sides: [Curve; 2],
    /// Stribeck exponent.
    pub exponent: f64,
    /// M, kg (kg m^2).
    pub mass: f64,
    /// F0, N (N m).
    pub offset: f64,
    /// How much later the force was logged than it acted, beyond what [`Hold`](super::run::Hold) says, s.
    pub delay: f64,
    /// Gravity and cogging.
    pub waves: Vec<Wave>,
    /// Maxwell-slip elements in the place of the bristles.
    pub elements: Option<Elements>,
}

/// Position, velocity, bristle deflection: m, m/s, m (rad, rad/s, rad). Where an axis with elements is shown, the third is
/// their force, N (N m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct State {
    pub x: f64,
    pub v: f64,
    pub z: f64,
}

/// Places of the axis' own derivatives in [`Slopes::direct`]; waves follow.
pub(crate) mod slot {
    pub const STIFFNESS: usize = 0;
    pub const MICRO_DAMPING: usize = 1;
    pub const VISCOUS: usize = 2;
    pub const COULOMB: usize = 3;
    pub const EXCESS: usize = 4;
    pub const VELOCITY: usize = 5;
    pub const MASS: usize = 6;
    pub const OFFSET: usize = 7;
    /// For what acts on the force only; its derivatives here are zero.
    pub const FORCE_ONLY: usize = 8;
    pub const WAVES: usize = 9;
}

/// Most waves: gravity and four pitches of cogging.
pub(crate) const MOST_WAVES: usize = 10;
const SLOTS: usize = slot::WAVES + MOST_WAVES;

/// Derivatives of one step: `dw = -(balance . d) / slope` for the mean velocity w, and from it all else.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slopes {
    /// Index of the direction of motion in this step.
    pub side: usize,
    /// `-1 / (d balance / d w)`.
    pub gain: f64,
    /// Derivatives of the force balance in x, v, z before the step; in the force it is -1.
    pub by_state: [f64; 3],
    /// Derivatives of z after the step in w and in z before it.
    pub z_by_w: f64,
    pub z_by_z: f64,
    /// Direct derivatives of the balance and of z after the step in each parameter.
    pub direct: [(f64, f64); SLOTS],
}

/// The bristle map at a held velocity with what its derivatives need.
struct Bristle {
    side: usize,
    /// z after the step.
    end: f64,
    /// d end / d w.
    by_w: f64,
    /// 1 + expm1(-a).
    keep: f64,
    /// d end / d g, and d end / d ln s0 at given g.
    by_level: f64,
    by_stiffness: f64,
    /// `exp(-|w/vs|^delta)` and `|w/vs|^delta`.
    fall: f64,
    power: f64,
}

/// Bisection alone would need about sixty.
const MOST_EVALUATIONS: u32 = 200;

impl Axis {
    /// The largest deflection, m (rad).
    pub fn bound(&self) -> f64 {
        self.sides[0].fixed.max(self.sides[1].fixed) / self.stiffness
    }

    /// The LuGre law of the axis without viscous friction and offset; `None` where its values are invalid
    /// for a law.
    pub fn dry_law(&self) -> Option<LuGre<f64>> {
        let mut set = ParameterSet::of(
            LawKind::LuGre,
            [
                (Quantity::Sigma0.into(), self.stiffness),
                (Quantity::Sigma1.into(), self.micro_damping),
                (Quantity::Sigma2.into(), 0.0),
                (Quantity::StribeckExponent.into(), self.exponent),
            ],
        );
        for (side, curve) in [Side::Positive, Side::Negative]
            .into_iter()
            .zip(&self.sides)
        {
            set.insert(Name::new(Quantity::Coulomb, side), curve.coulomb);
            set.insert(Name::new(Quantity::Static, side), curve.fixed);
            set.insert(Name::new(Quantity::StribeckVelocity, side), curve.velocity);
        }
        set.lugre().ok()
    }

    fn bristle(&self, z: f64, h: f64, w: f64) -> Bristle {
        let side = usize::from(w < 0.0);
        let sign = if side == 1 { -1.0 } else { 1.0 };
        let curve = &self.sides[side];
        let drop = curve.fixed - curve.coulomb;
        let speed = fabs(w);
        let ratio = speed / curve.velocity;
        let (fall, power) = if drop == 0.0 {
            (0.0, 0.0)
        } else {
            let power = if self.exponent == 2.0 {
                ratio * ratio
            } else {
                pow(ratio, self.exponent)
            };
            (exp(-power), power)
        };
        let level = curve.coulomb + drop * fall;
        // At rest with an exponent below one the derivative is infinite; the step does not need it there.
        let level_slope = if fall == 0.0 || speed == 0.0 {
            0.0
        } else {
            -sign * drop * fall * self.exponent * power / speed
        };
        let per_speed = h * self.stiffness / level;
        let a = per_speed * speed;
        let e = expm1(-a);
        let keep = 1.0 + e;
        let steady = sign * level / self.stiffness;
        let lag = z - steady;
        let by_level = -sign * e / self.stiffness + lag * keep * a / level;
        Bristle {
            side,
            end: z + lag * e,
            by_w: by_level * level_slope - lag * keep * sign * per_speed,
            keep,
            by_level,
            by_stiffness: steady * e - lag * keep * a,
            fall,
            power,
        }
    }

    /// The position-dependent force and its slope.
    pub fn waves_at(&self, x: f64) -> (f64, f64) {
        self.waves.iter().fold((0.0, 0.0), |(f, s), wave| {
            let (value, slope) = wave.shape(x);
            (f + wave.factor * value, s + wave.factor * slope)
        })
    }

    /// Inertia and friction less the force at the mean velocity `w`, its derivative, and the bristle.
    fn balance(&self, from: State, h: f64, force: f64, w: f64) -> (f64, f64, Bristle) {
        let b = self.bristle(from.z, h, w);
        let inertia = 2.0 * self.mass / h;
        let viscous = self.sides[b.side].viscous;
        let (beside, beside_slope) = if self.waves.is_empty() {
            (0.0, 0.0)
        } else {
            self.waves_at(from.x + 0.5 * h * w)
        };
        let excess = inertia * (w - from.v)
            + self.stiffness * 0.5 * (from.z + b.end)
            + self.micro_damping * (b.end - from.z) / h
            + viscous * w
            + self.offset
            + beside
            - force;
        let slope = inertia
            + b.by_w * (0.5 * self.stiffness + self.micro_damping / h)
            + viscous
            + 0.5 * h * beside_slope;
        (excess, slope, b)
    }

    /// The mean velocity over a step of `h` seconds under a constant force, and the bristle there.
    fn solve(&self, from: State, h: f64, force: f64) -> (f64, f64, Bristle) {
        let inertia = 2.0 * self.mass / h;
        let bound = self.bound().max(fabs(from.z));
        let waves: f64 = self.waves.iter().map(|w| fabs(w.factor)).sum();
        let bristle = self.stiffness * bound + self.micro_damping * 2.0 * bound / h + waves;
        let free = (inertia * from.v + force - self.offset) / inertia;
        // The small extra share keeps rounding from excluding the solution from the bracket.
        let reach = 1.01 * bristle / inertia + 1e-6 * (fabs(free) + fabs(from.v));
        let (mut low, mut high) = (free.min(0.0) - reach, free.max(0.0) + reach);
        // A velocity below this is standstill.
        let negligible = 1e-12 * self.sides[0].velocity.min(1.0);
        let mut w = from.v.max(low).min(high);
        let mut last_move = high - low;
        for _ in 0..MOST_EVALUATIONS {
            let (excess, slope, _) = self.balance(from, h, force, w);
            if excess > 0.0 {
                high = w;
            } else {
                low = w;
            }
            let newton = w - excess / slope;
            let moves = fabs(newton - w);
            // Newton converges quadratically: after a relative change of 1e-8 the remaining error is rounding.
            if moves <= 1e-8 * fabs(w) + negligible {
                w = newton;
                break;
            }
            if high - low <= 4.0 * f64::EPSILON * fabs(w) {
                break;
            }
            let trusted = newton > low && newton < high && 2.0 * moves <= last_move;
            let next = if trusted { newton } else { 0.5 * (low + high) };
            last_move = fabs(next - w);
            w = next;
        }
        let (_, slope, b) = self.balance(from, h, force, w);
        (w, slope, b)
    }

    /// Advances by `h` seconds under a constant force.
    pub fn step(&self, from: State, h: f64, force: f64) -> State {
        let (w, _, b) = self.solve(from, h, force);
        after(from, h, w, &b)
    }

    /// The same with the derivatives of the step.
    pub fn step_with_slopes(&self, from: State, h: f64, force: f64) -> (State, Slopes) {
        let (w, slope, b) = self.solve(from, h, force);
        let curve = &self.sides[b.side];
        let lever = 0.5 * self.stiffness + self.micro_damping / h;
        let mean = 0.5 * (from.z + b.end);
        let through = |z: f64| (lever * z, z);
        let drop = curve.fixed - curve.coulomb;
        let level = curve.coulomb + drop * b.fall;
        let mut direct = [(0.0, 0.0); SLOTS];
        direct[slot::STIFFNESS] = {
            let (balance, z) = through(b.by_stiffness);
            (balance + self.stiffness * mean, z)
        };
        direct[slot::MICRO_DAMPING] = (self.micro_damping * (b.end - from.z) / h, 0.0);
        direct[slot::VISCOUS] = (w, 0.0);
        direct[slot::COULOMB] = through(b.by_level * level);
        direct[slot::EXCESS] = through(b.by_level * drop * b.fall);
        direct[slot::VELOCITY] = through(if b.fall == 0.0 {
            0.0
        } else {
            b.by_level * drop * b.fall * self.exponent * b.power
        });
        direct[slot::MASS] = (2.0 * self.mass / h * (w - from.v), 0.0);
        direct[slot::OFFSET] = (1.0, 0.0);
        let middle = from.x + 0.5 * h * w;
        let mut beside_slope = 0.0;
        for (wave, d) in self.waves.iter().zip(&mut direct[slot::WAVES..]) {
            let (value, slope) = wave.shape(middle);
            d.0 = value;
            beside_slope += wave.factor * slope;
        }
        let slopes = Slopes {
            side: b.side,
            gain: -1.0 / slope,
            by_state: [
                beside_slope,
                -2.0 * self.mass / h,
                0.5 * self.stiffness * (1.0 + b.keep) + self.micro_damping * (b.keep - 1.0) / h,
            ],
            z_by_w: b.by_w,
            z_by_z: b.keep,
            direct,
        };
        (after(from, h, w, &b), slopes)
    }
}

fn after(from: State, h: f64, w: f64, b: &Bristle) -> State {
    State {
        x: from.x + h * w,
        v: 2.0 * w - from.v,
        z: b.end,
    }
}
