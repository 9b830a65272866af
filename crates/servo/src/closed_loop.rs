//! Plant, controller and sensors at a control rate: what a drive would log.

use crate::cascade::{Cascade, CascadeState};
use crate::encoder::Encoder;
use crate::noise::Noise;
use crate::path::Path;
use crate::plant::{Load, Motion, Plant};
use crate::run::sample_count;
use crate::trajectory::Trajectory;
use stiction_friction::{Held, LuGre, ParamError};

/// Which force is logged in the same row as the position at the instant t_k.
///
/// The controller reads the position at t_k and holds the force u_k from t_k to t_k + h.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceLog {
    /// u_k itself, as most drives log it: its centre is at t_k + h/2, half a sample after the position.
    Held,
    /// The mean force from t_k - h/2 to t_k + h/2, `(u_{k-1} + u_k)/2`: no delay against the position.
    Centred,
}

/// A closed loop to run. Plain settings; [`run`](Self::run) checks the numbers that the parts do not check.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLoop<L = LuGre<f64>, P = Path> {
    /// The axis.
    pub plant: Plant<L>,
    /// The controller.
    pub controller: Cascade,
    /// The reference, from rest.
    pub path: P,
    /// The position sensor, seen by the controller and the log.
    pub encoder: Encoder,
    /// Control and log rate, > 0, Hz.
    pub rate: f64,
    /// Plant steps in one control period, >= 1.
    pub substeps: u32,
    /// Standard deviation of the white noise on the logged force, >= 0, N (N m). The controller does not see it.
    pub force_noise: f64,
    /// Which force is logged.
    pub force_log: ForceLog,
    /// Seed of the noise: the same seed gives the same record, bit for bit.
    pub seed: u64,
}

/// The log of a run, one entry per control period in each channel, and the true motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// s
    pub time: Vec<f64>,
    /// Reference position, m (rad).
    pub reference: Vec<f64>,
    /// Measured position, m (rad), in steps of the encoder.
    pub position: Vec<f64>,
    /// Commanded force u_k, held over the period that starts at this instant, N (N m).
    pub force_command: Vec<f64>,
    /// Logged force, N (N m), as [`ForceLog`] says, with noise.
    pub force: Vec<f64>,
    /// The true motion and forces, which no sensor shows.
    pub truth: Truth,
}

/// The exact motion at the instants of a [`Record`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    /// m (rad)
    pub position: Vec<f64>,
    /// m/s (rad/s)
    pub velocity: Vec<f64>,
    /// Bristle deflection, m (rad).
    pub deflection: Vec<f64>,
    /// Friction force at the instant, N (N m).
    pub friction: Vec<f64>,
    /// Logged force without its noise, N (N m).
    pub force: Vec<f64>,
}

impl<L: Held<f64, State = f64>, P: Trajectory> ClosedLoop<L, P> {
    /// Runs the loop from rest at the origin over the whole path.
    pub fn run(&self) -> Result<Record, ParamError> {
        let n = self.validate()?;
        let h = 1.0 / self.rate;
        let dt = h / f64::from(self.substeps);
        let law = self.plant.law();

        let mut record = Record::with_capacity(n);
        let mut noise = Noise::new(self.seed);
        let mut control = CascadeState::default();
        let mut motion = Motion::default();
        let mut held = 0.0;
        for k in 0..n {
            let time = k as f64 / self.rate;
            let reference = self.path.at(time);
            let position = self.encoder.read(motion.position);
            let before = held;
            held = self.controller.force(&mut control, h, reference, position);
            let force = match self.force_log {
                ForceLog::Held => held,
                ForceLog::Centred => 0.5 * (before + held),
            };

            record.time.push(time);
            record.reference.push(reference.position);
            record.position.push(position);
            record.force_command.push(held);
            record.force.push(force + self.force_noise * noise.normal());
            record.truth.position.push(motion.position);
            record.truth.velocity.push(motion.velocity);
            record.truth.deflection.push(motion.deflection);
            record
                .truth
                .friction
                .push(law.force_now(motion.deflection, motion.velocity));
            record.truth.force.push(force);

            for _ in 0..self.substeps {
                motion = self.plant.step(motion, dt, Load::force(held)).motion;
            }
        }
        Ok(record)
    }

    /// The number of samples, if the settings can be run.
    fn validate(&self) -> Result<usize, ParamError> {
        self.controller.validate()?;
        ParamError::positive("rate", self.rate)?;
        ParamError::not_negative("force_noise", self.force_noise)?;
        if self.substeps == 0 {
            return Err(ParamError::new("substeps", 0.0, ">= 1"));
        }
        sample_count(self.path.duration(), self.rate)
    }
}

impl Record {
    fn with_capacity(n: usize) -> Self {
        let channel = || Vec::with_capacity(n);
        Record {
            time: channel(),
            reference: channel(),
            position: channel(),
            force_command: channel(),
            force: channel(),
            truth: Truth {
                position: channel(),
                velocity: channel(),
                deflection: channel(),
                friction: channel(),
                force: channel(),
            },
        }
    }
}
