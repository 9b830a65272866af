//! A mass with friction, driven by a force: the implicit midpoint step MID.

use stiction_friction::{Held, LuGre, Pace, ParamError};

/// A mass (inertia) on a guide with friction: LuGre unless said otherwise, any law that is [`Held`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant<L = LuGre<f64>> {
    mass: f64,
    law: L,
    viscous: f64,
    stiffness: f64,
}

/// The state of motion of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<S = f64> {
    /// Position, m (rad).
    pub position: f64,
    /// Velocity, m/s (rad/s).
    pub velocity: f64,
    /// Bristle deflection, m (rad), or whatever the state of the law is.
    pub deflection: S,
}

/// The force on the axis over one step: `force - stiffness * position`.
///
/// For a spring of stiffness k whose far end is at y, both at the middle of the step: `force = k y`, `stiffness = k`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// N (N m); for a force that varies, its value at the middle of the step.
    pub force: f64,
    /// >= 0, N/m (N m/rad).
    pub stiffness: f64,
}

impl Load {
    /// A force alone, N (N m).
    pub fn force(force: f64) -> Self {
        Load {
            force,
            stiffness: 0.0,
        }
    }
}

/// The result of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S = f64> {
    /// The motion at the end of the step.
    pub motion: Motion<S>,
    /// Mean velocity over the step, m/s (rad/s): the position moved by `h` times this.
    pub mean_velocity: f64,
    /// Mean friction force over the step, N (N m), offset included.
    pub friction: f64,
    /// Evaluations of the force balance that the solution needed.
    pub evaluations: u32,
}

impl<L: Held<f64>> Plant<L> {
    /// `mass` in kg (kg m^2), finite and > 0.
    pub fn new(mass: f64, law: L) -> Result<Self, ParamError> {
        ParamError::positive("mass", mass)?;
        Ok(Plant {
            mass,
            law,
            viscous: 0.0,
            stiffness: 0.0,
        })
    }

    /// The same plant with a damper, `viscous` >= 0 in N s/m (N m s/rad), beside the law's own viscous part.
    pub fn with_viscous(self, viscous: f64) -> Result<Self, ParamError> {
        ParamError::not_negative("viscous", viscous)?;
        Ok(Plant { viscous, ..self })
    }

    /// The same plant on a spring to the origin, `stiffness` >= 0 in N/m (N m/rad).
    pub fn with_stiffness(self, stiffness: f64) -> Result<Self, ParamError> {
        ParamError::not_negative("stiffness", stiffness)?;
        Ok(Plant { stiffness, ..self })
    }

    /// The same plant with another mass, kg (kg m^2): a load taken up or put down.
    pub fn with_mass(self, mass: f64) -> Result<Self, ParamError> {
        ParamError::positive("mass", mass)?;
        Ok(Plant { mass, ..self })
    }

    /// The same plant with another law.
    pub fn with_law(self, law: L) -> Self {
        Plant { law, ..self }
    }

    /// Mass, kg (kg m^2).
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Damper beside the law, N s/m (N m s/rad).
    pub fn viscous(&self) -> f64 {
        self.viscous
    }

    /// Spring to the origin, N/m (N m/rad).
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// The friction law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// Advances `from` by `h` > 0 seconds under `load`.
    ///
    /// MID: implicit midpoint in velocity and position, the law's own step at the mean velocity w, for LuGre
    /// ```text
    /// 2 M (w - v)/h = u(t + h/2, x + h w/2) - [sigma0 z_mean(w) + sigma1 (z+(w) - z)/h + sigma2 w + F0]
    /// x+ = x + h w,  v+ = 2 w - v
    /// ```
    /// with the mean deflection z_mean of [`Sweep`](stiction_friction::Sweep); other laws take `(z + z+)/2`. Second order
    /// and A-stable; the work of all forces equals the change of kinetic energy to rounding. It does not damp motion that is too
    /// fast for the step: keep `h sqrt(sigma0/M)` below about 2. With sigma1 capped friction releases no energy over a
    /// closed cycle, in steps that move no farther than g(v)/sigma0; a longer one through a reversal can.
    ///
    /// A load that is not finite gives a motion that is not finite.
    pub fn step(&self, from: Motion<L::State>, h: f64, load: Load) -> Step<L::State> {
        let load = Load {
            stiffness: load.stiffness + self.stiffness,
            ..load
        };
        let pace = Pace {
            h,
            start: from.velocity,
            mass: self.mass,
        };
        let balance = Balance {
            plant: self,
            from,
            pace,
            load,
        };
        let Solution {
            mean_velocity,
            friction,
            evaluations,
        } = balance.solve();
        let motion = Motion {
            position: from.position + h * mean_velocity,
            velocity: 2.0 * mean_velocity - from.velocity,
            deflection: self.law.hold(from.deflection, h, mean_velocity),
        };
        Step {
            motion,
            mean_velocity,
            friction,
            evaluations,
        }
    }
}

/// Tolerances of the solution of one step.
struct Tolerances {
    /// Most evaluations: bisection alone would need about sixty; a load that is NaN ends here.
    max_evaluations: u32,
    /// Largest Newton step after which the solution is exact to rounding, relative to the velocity: Newton's method
    /// converges quadratically.
    final_step: f64,
    /// Velocity that counts as standstill, in Stribeck velocities.
    standstill: f64,
    /// Width of the bracket at which it is closed, in velocities that count as standstill.
    closed_bracket: f64,
    /// Factor on the largest force of the bristles that brackets the solution.
    bracket_factor: f64,
    /// Margin of the bracket for rounding, relative to the velocity.
    bracket_rounding: f64,
}

const TOLERANCES: Tolerances = Tolerances {
    max_evaluations: 200,
    final_step: 1e-8,
    standstill: 1e-12,
    closed_bracket: 1e-3,
    bracket_factor: 1.01,
    bracket_rounding: 1e-6,
};

/// The force balance of one step as an equation for the mean velocity.
struct Balance<'a, L: Held<f64>> {
    plant: &'a Plant<L>,
    from: Motion<L::State>,
    pace: Pace<f64>,
    load: Load,
}

struct Solution {
    mean_velocity: f64,
    friction: f64,
    evaluations: u32,
}

impl<L: Held<f64>> Balance<'_, L> {
    /// Inertia and friction less drive at the mean velocity `w`, and friction; each with its derivative.
    fn at(&self, w: f64) -> [(f64, f64); 2] {
        let Balance {
            plant,
            from,
            pace,
            load,
        } = *self;
        let friction = plant.law.mean_force_slope(from.deflection, &pace, w);
        let inertia = 2.0 * plant.mass / pace.h;
        let drive = load.force - load.stiffness * (from.position + 0.5 * pace.h * w);
        let excess = inertia * (w - from.velocity) + friction.0 + plant.viscous * w - drive;
        let slope = inertia + plant.viscous + 0.5 * pace.h * load.stiffness + friction.1;
        [(excess, slope), friction]
    }

    /// Newton's method inside a bracket that bisection shrinks whenever Newton leaves it or is slow.
    fn solve(&self) -> Solution {
        let law = &self.plant.law;
        let h = self.pace.h;
        let inertia = 2.0 * self.plant.mass / h;
        // For any w the bristles contribute no more than this; the viscous part and the spring only brake.
        let bristle = law.reach(h);
        let drive =
            self.load.force - self.load.stiffness * self.from.position - law.curve().offset();
        let passive = inertia + self.plant.viscous + 0.5 * h * self.load.stiffness;
        let free = (inertia * self.from.velocity + drive) / passive;
        let rounding = TOLERANCES.bracket_rounding * (free.abs() + self.from.velocity.abs());
        let reach = TOLERANCES.bracket_factor * bristle / inertia + rounding;
        let (mut low, mut high) = (free.min(0.0) - reach, free.max(0.0) + reach);

        let negligible =
            TOLERANCES.standstill * law.curve().direction(self.from.velocity).stribeck_velocity;
        // Not `clamp`: the ends are NaN where the load is.
        let mut w = self.from.velocity.max(low).min(high);
        let mut last_move = high - low;
        let mut evaluations = 0;
        loop {
            let [(excess, slope), (friction, friction_slope)] = self.at(w);
            evaluations += 1;
            if excess > 0.0 {
                high = w;
            } else {
                low = w;
            }
            let newton = w - excess / slope;
            let moves = (newton - w).abs();
            if moves <= TOLERANCES.final_step * w.abs() + negligible {
                return Solution {
                    mean_velocity: newton,
                    friction: friction + friction_slope * (newton - w),
                    evaluations,
                };
            }
            // At standstill the force of a law may jump, as where slipping elements begin to stick.
            let width = (4.0 * f64::EPSILON * w.abs()).max(TOLERANCES.closed_bracket * negligible);
            if high - low <= width || evaluations == TOLERANCES.max_evaluations {
                return Solution {
                    mean_velocity: w,
                    friction,
                    evaluations,
                };
            }
            let trusted = newton > low && newton < high && 2.0 * moves <= last_move;
            let next = if trusted { newton } else { 0.5 * (low + high) };
            last_move = (next - w).abs();
            w = next;
        }
    }
}
