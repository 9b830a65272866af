//! The load of an axis found while it runs: mass and level of friction by recursive least squares.

use crate::drive::{Drive, RunningDrive};
use stiction_friction::{Held, LuGre, ParamError};

/// Settings of a load estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadSettings {
    /// Learning time over which samples are forgotten, > 0, s.
    pub memory: f64,
    /// Cut-off of the two lags that force, acceleration and friction all pass, > 0, Hz.
    pub cutoff: f64,
    /// Acceleration, past the lags, below which nothing is learnt and nothing forgotten, > 0, m/s^2 (rad/s^2): the mass
    /// could not be told from friction there, nor the noise of force and position from either.
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

/// Mass and level of friction as they are now believed.
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
/// nothing has to be aligned but the drive's delay, which its model has.
#[derive(Clone, Debug)]
pub struct LoadEstimator {
    law: LuGre<f64>,
    drive: RunningDrive,
    settings: LoadSettings,
    rate: f64,
    load: Load,
    /// The two latest positions, m (rad), the newer first, once there are any.
    positions: Option<[f64; 2]>,
    seen: u32,
    deflection: f64,
    /// Mean friction and drive force over the period before.
    friction: f64,
    force: f64,
    /// After each of the two lags: force, acceleration, friction.
    first: [f64; 3],
    second: [f64; 3],
    fade: f64,
    covariance: [[f64; 2]; 2],
}

/// The covariance that says nothing is known, against squares of m/s^2 and N; it never grows beyond.
const UNKNOWN: f64 = 1e6;

impl LoadEstimator {
    /// For a law at its nominal level and a nominal mass (kg, kg m^2), a model of the drive, and a control rate in Hz.
    pub fn new(
        law: LuGre<f64>,
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
            deflection: 0.0,
            friction: 0.0,
            force: 0.0,
            first: [0.0; 3],
            second: [0.0; 3],
            fade: libm::exp(-1.0 / (rate * settings.memory)),
            covariance: [[1.0, 0.0], [0.0, 1e-2]],
        })
    }

    /// What is believed now.
    pub fn load(&self) -> Load {
        self.load
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
        let end = self.law.step_held(self.deflection, h, velocity);
        let friction = self.law.mean_force(self.deflection, end, h, velocity);
        self.deflection = end;
        let acceleration = (position - 2.0 * newer + older) * self.rate * self.rate;
        // `force` is of the period that ends now, the drive's output of it was asked for a sample ago.
        let force = self.drive.force(0);
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
        let p = self.covariance;
        let pa = [p[0][0] * a + p[0][1] * f, p[1][0] * a + p[1][1] * f];
        let fade = self.fade;
        let spread = fade + a * pa[0] + f * pa[1];
        let gain = [pa[0] / spread, pa[1] / spread];
        let missing = u - self.load.mass * a - self.load.level * f;
        // A mass or level below nothing is not believed, whatever the data.
        self.load.mass = (self.load.mass + gain[0] * missing).max(f64::MIN_POSITIVE);
        self.load.level = (self.load.level + gain[1] * missing).max(0.0);
        let next = |i: usize, j: usize| (p[i][j] - gain[i] * pa[j]) / fade;
        let cross = 0.5 * (next(0, 1) + next(1, 0));
        let grown = [[next(0, 0), cross], [cross, next(1, 1)]];
        if grown[0][0] <= UNKNOWN && grown[1][1] <= UNKNOWN {
            self.covariance = grown;
        }
    }
}
