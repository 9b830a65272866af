//! Load estimation: mass and friction level of a running axis by recursive least squares.

use crate::drive::{Drive, RunningDrive};
use stiction_friction::{Damping, Direction, Held, LuGre, ParamError, Stribeck};

/// Settings of a load estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadSettings {
    /// Time constant of the forgetting, counted in time that is learnt from, > 0, s.
    pub memory: f64,
    /// Cut-off of the two lags that force, acceleration and friction all pass, > 0, Hz.
    pub cutoff: f64,
    /// Filtered acceleration below which nothing is learnt and nothing forgotten, > 0, m/s^2 (rad/s^2): there the mass
    /// could not be distinguished from friction, nor either from noise.
    pub least_acceleration: f64,
}

impl Default for LoadSettings {
    /// .2 s, 40 Hz, .3 m/s^2.
    fn default() -> Self {
        LoadSettings {
            memory: 0.2,
            cutoff: 40.0,
            least_acceleration: 0.3,
        }
    }
}

/// The present estimate of mass and friction level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// kg (kg m^2)
    pub mass: f64,
    /// Factor on the law's whole force.
    pub level: f64,
}

/// Recursive least squares with exponential forgetting (Astrom, Wittenmark 1995, Adaptive Control, chapter 2) on
/// `u = M a + level F`, with u the force that the drive model makes of the commands, a the second difference of the
/// measured position, and F the law stepped along that position.
///
/// The second difference belongs to the mean of two neighbouring forces exactly; all three then pass the same lags, so
/// only the drive's delay has to be aligned, which its model does.
#[derive(Clone, Debug)]
pub struct LoadEstimator<L: Held<f64> = LuGre<f64>> {
    law: L,
    drive: RunningDrive,
    settings: LoadSettings,
    rate: f64,
    load: Load,
    /// The two latest positions, m (rad), the newer first, once there are any.
    positions: Option<[f64; 2]>,
    seen: u32,
    /// Samples that were learnt from.
    learnt: u32,
    deflection: L::State,
    /// Mean friction and drive force over the period before.
    friction: f64,
    force: f64,
    /// After each of the two lags: force, acceleration, friction.
    first: [f64; 3],
    second: [f64; 3],
    fade: f64,
    covariance: [[f64; 2]; 2],
}

/// Bound of the diagonal of the covariance, in 1/(m/s^2)^2 and 1/N^2 (rotary: 1/(rad/s^2)^2 and 1/(N m)^2): forgetting
/// without excitation does not let it grow beyond.
const MAX_COVARIANCE: f64 = 1e6;
/// The diagonal at the start, in the same units: the nominal mass is doubted more than the nominal level.
const INITIAL_COVARIANCE: [f64; 2] = [1.0, 1e-2];

/// A law with its whole friction, but for the offset, `by` > 0 times as large at every deflection and velocity: what a load
/// or a temperature does to it.
pub fn scaled(law: &LuGre<f64>, by: f64) -> Result<LuGre<f64>, ParamError> {
    ParamError::positive("friction", by)?;
    let curve = law.curve();
    let [positive, negative] = [curve.positive(), curve.negative()].map(|side| Direction {
        coulomb: by * side.coulomb,
        static_friction: by * side.static_friction,
        viscous: by * side.viscous,
        ..*side
    });
    let damping = match law.damping() {
        Damping::Constant(sigma1) => Damping::Constant(by * sigma1),
        Damping::Capped(sigma1) => Damping::Capped(by * sigma1),
        Damping::Olsson { sigma1, velocity } => Damping::Olsson {
            sigma1: by * sigma1,
            velocity,
        },
    };
    let curve = Stribeck::new(curve.shape(), positive, negative, curve.offset())?;
    LuGre::new(by * law.stiffness(), damping, curve)
}

impl<L: Held<f64>> LoadEstimator<L> {
    /// For a law at its nominal level and a nominal mass (kg, kg m^2), a model of the drive, and a control rate in Hz.
    pub fn new(
        law: L,
        mass: f64,
        drive: Drive,
        rate: f64,
        settings: LoadSettings,
    ) -> Result<Self, ParamError> {
        ParamError::positive("mass", mass)?;
        ParamError::positive("rate", rate)?;
        ParamError::positive("memory", settings.memory)?;
        ParamError::positive("cutoff", settings.cutoff)?;
        ParamError::positive("least_acceleration", settings.least_acceleration)?;
        Ok(LoadEstimator {
            law,
            drive: RunningDrive::new(drive, 1.0 / rate, 1)?,
            settings,
            rate,
            load: Load { mass, level: 1.0 },
            positions: None,
            seen: 0,
            learnt: 0,
            deflection: L::State::default(),
            friction: 0.0,
            force: 0.0,
            first: [0.0; 3],
            second: [0.0; 3],
            fade: libm::exp(-1.0 / (rate * settings.memory)),
            covariance: [[INITIAL_COVARIANCE[0], 0.0], [0.0, INITIAL_COVARIANCE[1]]],
        })
    }

    /// The present estimate.
    pub fn load(&self) -> Load {
        self.load
    }

    /// How long it has learnt, s: the time with an acceleration above the least.
    pub fn learning_time(&self) -> f64 {
        f64::from(self.learnt) / self.rate
    }

    /// Takes a sample: the measured position, m (rad), and the force commanded at it, N (N m). Samples that are not finite
    /// are passed over.
    pub fn sample(&mut self, position: f64, command: f64) -> Load {
        if !position.is_finite() || !command.is_finite() {
            return self.load;
        }
        let [newer, older] = self.positions.unwrap_or([position; 2]);
        self.positions = Some([position, newer]);
        let h = 1.0 / self.rate;
        let velocity = (position - newer) * self.rate;
        let end = self.law.hold(self.deflection, h, velocity);
        let friction = self.law.mean_force(self.deflection, end, h, velocity);
        self.deflection = end;
        let acceleration = (position - 2.0 * newer + older) * self.rate * self.rate;
        // `force` is that of the period that ends now, for the command of a sample ago.
        let induced = self.drive.induced_force() - self.drive.damper() * velocity;
        let force = self.drive.force(0) + induced;
        self.drive.moved(position - newer);
        let raw = [
            0.5 * (self.force + force),
            acceleration,
            0.5 * (self.friction + friction),
        ];
        (self.force, self.friction) = (force, friction);
        self.drive.command(command);

        let weight = -libm::expm1(-2.0 * std::f64::consts::PI * self.settings.cutoff * h);
        for ((first, second), raw) in self.first.iter_mut().zip(&mut self.second).zip(raw) {
            *first += weight * (raw - *first);
            *second += weight * (*first - *second);
        }
        // Two differences and the lags have to be filled with motion first.
        self.seen = self.seen.saturating_add(1);
        if self.seen > 2 {
            self.learn();
        }
        self.load
    }

    fn learn(&mut self) {
        let [u, a, f] = self.second;
        if a.abs() < self.settings.least_acceleration {
            return;
        }
        self.learnt = self.learnt.saturating_add(1);
        let p = self.covariance;
        let pa = [p[0][0] * a + p[0][1] * f, p[1][0] * a + p[1][1] * f];
        let fade = self.fade;
        let spread = fade + a * pa[0] + f * pa[1];
        let gain = [pa[0] / spread, pa[1] / spread];
        let missing = u - self.load.mass * a - self.load.level * f;
        // Mass and level stay positive, whatever the data.
        self.load.mass = (self.load.mass + gain[0] * missing).max(f64::MIN_POSITIVE);
        self.load.level = (self.load.level + gain[1] * missing).max(0.0);
        let next = |i: usize, j: usize| (p[i][j] - gain[i] * pa[j]) / fade;
        let cross = 0.5 * (next(0, 1) + next(1, 0));
        let grown = [[next(0, 0), cross], [cross, next(1, 1)]];
        if grown[0][0] <= MAX_COVARIANCE && grown[1][1] <= MAX_COVARIANCE {
            self.covariance = grown;
        }
    }
}
