//! One axis under control at a fixed rate: plant, drive, sensor, controller and compensation together.

use crate::controller::{Controller, ControllerState};
use crate::disturbance::{Cogging, Disturbance};
use crate::drive::{Drive, RunningDrive};
use crate::encoder::Encoder;
use crate::feedforward::{Feedforward, Moment, RunningFeedforward};
use crate::integrator::{Integrator, Mid};
use crate::noise::Noise;
use crate::path::Reference;
use crate::plant::{Load, Motion, Plant};
use stiction_friction::{Held, LuGre, ParamError};

/// An axis to simulate. Plain settings; [`Axis::new`] checks the numbers that the parts do not check.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisSettings<L = LuGre<f64>> {
    /// Mass, friction, damper and spring.
    pub plant: Plant<L>,
    /// Amplifier and motor: from the controller's force to the force on the axis.
    pub drive: Drive,
    /// The position sensor.
    pub encoder: Encoder,
    /// Standard deviation of white noise on the position before the encoder, >= 0, m (rad).
    pub position_noise: f64,
    /// Cogging of the motor.
    pub cogging: Option<Cogging>,
    /// Any other force on the axis.
    pub disturbance: Option<Disturbance>,
    /// The controller.
    pub controller: Controller,
    /// Compensation of friction.
    pub feedforward: Feedforward,
    /// Control rate, > 0, Hz.
    pub rate: f64,
    /// Substeps of a control period, over each of which the force is held, 1 to 100 000; an integrator may take several steps in each.
    pub substeps: u32,
    /// Seed of the noise.
    pub seed: u64,
}

/// The state of an axis at a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// s
    pub time: f64,
    /// The reference.
    pub reference: Reference,
    /// Measured position, m (rad).
    pub measured: f64,
    /// Force commanded for the period that begins, N (N m).
    pub command: f64,
    /// The part of it that compensates friction, N (N m).
    pub compensation: f64,
    /// True position, m (rad).
    pub position: f64,
    /// True velocity, m/s (rad/s).
    pub velocity: f64,
}

impl Sample {
    /// Reference less true position, m (rad).
    #[inline]
    pub fn error(&self) -> f64 {
        self.reference.position - self.position
    }
}

/// Inputs to an axis beside its reference, at a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Added to the reference velocity that the controller sees, m/s (rad/s): cross-coupled control.
    pub velocity: f64,
    /// A force fed forward, N (N m).
    pub force: f64,
}

/// A running axis.
#[derive(Clone, Debug)]
pub struct Axis<L: Held<f64> = LuGre<f64>, I = Mid> {
    settings: AxisSettings<L>,
    integrator: I,
    /// Control period, s, the fraction of it that is a substep, and the length of a substep, s.
    period: f64,
    stretch: f64,
    span: f64,
    /// The plant with the damper of the drive.
    plant: Plant<L>,
    drive: RunningDrive,
    controller: ControllerState,
    feedforward: RunningFeedforward,
    noise: Noise,
    motion: Motion<L::State>,
    /// Measured position of this sample, and whether it has been taken already; that of the sample before.
    measured: f64,
    fresh: bool,
    last: Option<f64>,
    count: u64,
}

impl<L: Held<f64>, I: Integrator<L>> Axis<L, I> {
    /// At rest at the origin.
    pub fn new(settings: AxisSettings<L>, integrator: I) -> Result<Self, ParamError> {
        ParamError::positive("rate", settings.rate)?;
        ParamError::not_negative("position_noise", settings.position_noise)?;
        settings.controller.validate()?;
        if let Some(cogging) = &settings.cogging {
            cogging.validate()?;
        }
        if let Some(disturbance) = &settings.disturbance {
            disturbance.validate()?;
        }
        let period = 1.0 / settings.rate;
        let drive = RunningDrive::new(settings.drive, period, settings.substeps)?;
        let stretch = 1.0 / f64::from(settings.substeps);
        let feedforward = settings.feedforward.start(&settings.drive, period)?;
        Ok(Axis {
            integrator,
            period,
            stretch,
            span: period * stretch,
            plant: damped(settings.plant, &drive)?,
            drive,
            controller: ControllerState::default(),
            feedforward,
            noise: Noise::new(settings.seed),
            motion: Motion::default(),
            measured: 0.0,
            fresh: false,
            last: None,
            count: 0,
            settings,
        })
    }

    /// The settings.
    pub fn settings(&self) -> &AxisSettings<L> {
        &self.settings
    }

    /// The running compensation.
    pub fn feedforward(&self) -> &RunningFeedforward {
        &self.feedforward
    }

    /// The true friction force now, N (N m).
    pub fn friction(&self) -> f64 {
        let law = self.settings.plant.law();
        law.force_now(self.motion.deflection, self.motion.velocity)
    }

    /// Changes the mass of the plant, kg (kg m^2), from now on: a load taken up or put down.
    pub fn set_mass(&mut self, mass: f64) -> Result<(), ParamError> {
        self.settings.plant = self.settings.plant.with_mass(mass)?;
        self.plant = self.plant.with_mass(mass)?;
        self.integrator.forget();
        Ok(())
    }

    /// Changes the plant's law from now on; its state is kept.
    pub fn set_law(&mut self, law: L) {
        self.settings.plant = self.settings.plant.with_law(law);
        self.plant = self.plant.with_law(law);
        self.integrator.forget();
    }

    /// Sets the friction level that the compensator assumes, a factor on its law, from now on.
    pub fn set_friction_level(&mut self, level: f64) {
        self.feedforward.set_level(level);
    }

    /// Changes the acceleration feedforward, kg (kg m^2), from now on.
    pub fn set_mass_feedforward(&mut self, mass: f64) -> Result<(), ParamError> {
        let controller = self.settings.controller.with_mass_feedforward(mass);
        controller.validate()?;
        self.settings.controller = controller;
        Ok(())
    }

    /// The position that the sensor shows at this sample, m (rad).
    #[inline]
    pub fn measure(&mut self) -> f64 {
        if !self.fresh {
            let mut position = self.motion.position;
            if self.settings.position_noise > 0.0 {
                position += self.settings.position_noise * self.noise.normal();
            }
            self.measured = self.settings.encoder.read(position);
            self.fresh = true;
        }
        self.measured
    }

    /// Measures, controls, and moves the axis by one control period. `ahead` is the reference velocity, m/s (rad/s), at the
    /// instant for which friction is to be compensated.
    #[inline(always)]
    pub fn step(&mut self, reference: Reference, ahead: f64, correction: Correction) -> Sample {
        let period = self.period;
        let measured = self.measure();
        self.fresh = false;
        let rate = (measured - self.last.unwrap_or(measured)) * self.settings.rate;
        self.last = Some(measured);
        let compensation = self.feedforward.force(Moment {
            index: self.count as usize,
            position: reference.position,
            ahead,
            rate,
            error: reference.position - measured,
        });
        let wanted = Reference {
            velocity: reference.velocity + correction.velocity,
            ..reference
        };
        let command = self.settings.controller.force(
            &mut self.controller,
            period,
            wanted,
            measured,
            compensation + correction.force,
        );
        self.feedforward.applied(command);
        let time = self.count as f64 * period;
        let sample = Sample {
            time,
            reference,
            measured,
            command,
            compensation,
            position: self.motion.position,
            velocity: self.motion.velocity,
        };
        self.drive.command(command);
        for i in 0..self.settings.substeps {
            self.advance(time, i);
        }
        self.count += 1;
        sample
    }

    /// Moves the axis by the substep `i` of the period that began at `time`.
    // Not inlined into the loop over the substeps: loop invariants would be kept on the stack.
    #[inline(never)]
    fn advance(&mut self, time: f64, i: u32) {
        let span = self.span;
        let driven = self.drive.force(i as usize);
        let mut force = driven + self.drive.induced_force();
        // Position and time at the middle of the substep.
        if let Some(cogging) = &self.settings.cogging {
            force += cogging.force(self.motion.position + 0.5 * span * self.motion.velocity);
        }
        if let Some(disturbance) = &self.settings.disturbance {
            let begin = f64::from(i) * self.stretch;
            force += disturbance.force(time + begin * self.period + 0.5 * span);
        }
        if let Some(next) = self.drive.next_force(i as usize) {
            // The other forces change little over a substep.
            self.integrator.expect(next + (force - driven));
        }
        let (plant, load, from) = (&self.plant, Load::force(force), self.motion.position);
        self.motion = self.integrator.advance(plant, self.motion, span, load, 0.0);
        self.drive.moved(self.motion.position - from);
    }
}

/// A plant with the damper that the drive adds to it.
fn damped<L: Held<f64>>(plant: Plant<L>, drive: &RunningDrive) -> Result<Plant<L>, ParamError> {
    plant.with_viscous(plant.viscous() + drive.damper())
}
