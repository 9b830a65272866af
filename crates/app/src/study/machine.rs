//! The simulated axis: its settings for a run, and what is said of it.

use super::Machine;
use super::result::{AxisParameter, SimulatedAxis};
use crate::symbols;
use stiction_friction::Damping;
use stiction_log::Motion;
use stiction_servo::axis::AxisSettings;
use stiction_servo::controller::Controller;
use stiction_servo::feedforward::Feedforward;

impl Machine {
    pub(super) fn settings(&self, controller: Controller, seed: u64) -> AxisSettings {
        AxisSettings {
            plant: self.plant,
            drive: self.drive,
            encoder: self.encoder,
            position_noise: self.position_noise,
            cogging: self.cogging,
            disturbance: None,
            controller,
            feedforward: Feedforward::default(),
            rate: self.rate,
            substeps: self.substeps,
            seed,
        }
    }

    /// What the controller may ask for and the drive can give, N (N m).
    pub(super) fn largest_force(&self, controller: &Controller) -> f64 {
        controller.force_limit().min(self.drive.peak_force())
    }

    /// Unit of a metric.
    pub(super) fn unit(&self, metric: &str) -> String {
        match (metric, self.motion) {
            ("stick_time", _) => "s",
            ("velocity_ripple", _) => "1",
            (name, _) if name.starts_with("saturation") => "1",
            (name, Motion::Linear) if name.starts_with("command_change") => "N",
            (name, Motion::Rotary) if name.starts_with("command_change") => "N*m",
            (_, motion) => symbols::length_unit(motion),
        }
        .into()
    }

    pub(super) fn entry(&self) -> SimulatedAxis {
        let parameters = self.model.parameters.iter().map(|p| AxisParameter {
            name: p.name.clone(),
            value: p.value,
            unit: p.unit.clone(),
        });
        let sigma1 = match self.law.damping() {
            Damping::Constant(_) => "constant",
            _ => "capped",
        };
        SimulatedAxis {
            kind: match self.motion {
                Motion::Linear => "linear",
                Motion::Rotary => "rotary",
            }
            .into(),
            origin: self.model.origin.clone(),
            parameters: parameters.collect(),
            sigma1: sigma1.into(),
            mass: self.mass,
            rate_hz: self.rate,
            substeps: self.substeps,
            delay_s: self.drive.delay,
            current_lag_s: self.drive.current_lag,
            peak_force: Some(self.drive.peak_force()).filter(|f| f.is_finite()),
            encoder: self.encoder.resolution(),
            position_noise: self.position_noise,
        }
    }
}
