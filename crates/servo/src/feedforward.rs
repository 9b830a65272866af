//! Friction compensation: the force that is added to the controller's.

use crate::drive::Drive;
use crate::surroundings::Surroundings;
use stiction_friction::ParamError;
use stiction_friction::compensator::{Compensator, DisturbanceObserver, DisturbanceState, Input};

/// Compensation of an axis: any of its parts, or none.
///
/// | method | parts |
/// |---|---|
/// | none | none |
/// | Coulomb, Stribeck, LuGre on reference or measured velocity, blend, observer, adaptive | `compensator` |
/// | disturbance observer | `observer` |
/// | iterative learning | `learned`, from pass to pass by [`Learning`](crate::learning::Learning) |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Feedforward {
    /// The model-based compensator, the code that runs on the drive.
    pub compensator: Option<Compensator<f64>>,
    /// How far it looks ahead on the reference, 0 to 7 samples; usually [`Drive::preview`].
    pub preview: f64,
    /// The disturbance observer.
    pub observer: Option<DisturbanceObserver<f64>>,
    /// A force for each sample of the pass, N (N m).
    pub learned: Vec<f64>,
    /// What the compensator is told of load, temperature and place; none where it does not depend on them.
    pub surroundings: Option<Surroundings>,
}

/// What the compensation sees in a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moment {
    pub index: usize,
    /// Reference position, m (rad).
    pub position: f64,
    /// Reference velocity ahead, m/s (rad/s).
    pub ahead: f64,
    /// Measured velocity, m/s (rad/s).
    pub rate: f64,
    /// Reference less measured position, m (rad).
    pub error: f64,
}

/// Commands that are kept: the longest delay of a drive, 32 periods, and the two ends of the period over which a velocity
/// is measured.
const KEPT_COMMANDS: usize = 34;

/// A running compensation.
#[derive(Clone, Debug, PartialEq)]
pub struct RunningFeedforward {
    parts: Feedforward,
    /// There is no part.
    none: bool,
    observed: DisturbanceState<f64>,
    /// The last commands less what the compensator and the passes gave, N (N m), the newest at `newest`: the observer
    /// estimates what they leave.
    commands: [f64; KEPT_COMMANDS],
    newest: usize,
    modelled: f64,
    /// Which of them acted over the period before a sample.
    late: usize,
    /// The last command, N (N m), and the largest force of the drive.
    command: f64,
    peak: f64,
}

impl Feedforward {
    /// The compensator alone, with a preview in samples.
    pub fn compensator(compensator: Compensator<f64>, preview: f64) -> Self {
        Feedforward {
            compensator: Some(compensator),
            preview,
            ..Feedforward::default()
        }
    }

    /// The disturbance observer alone.
    pub fn observer(observer: DisturbanceObserver<f64>) -> Self {
        Feedforward {
            observer: Some(observer),
            ..Feedforward::default()
        }
    }

    pub(crate) fn start(
        &self,
        drive: &Drive,
        period: f64,
    ) -> Result<RunningFeedforward, ParamError> {
        if !(0.0..=crate::trajectory::MAX_PREVIEW).contains(&self.preview) {
            return Err(ParamError::new("preview", self.preview, "0 to 7 samples"));
        }
        Ok(RunningFeedforward {
            parts: self.clone(),
            none: self.compensator.is_none() && self.observer.is_none() && self.learned.is_empty(),
            observed: DisturbanceState::default(),
            commands: [0.0; KEPT_COMMANDS],
            newest: 0,
            modelled: 0.0,
            // The drive was checked: its delay is at most 32 periods.
            late: libm::round(drive.delay / period) as usize,
            command: 0.0,
            peak: drive.peak_force(),
        })
    }
}

impl RunningFeedforward {
    /// The compensator with its state, if there is one.
    pub fn compensator(&self) -> Option<&Compensator<f64>> {
        self.parts.compensator.as_ref()
    }

    pub(crate) fn set_level(&mut self, level: f64) {
        if let Some(compensator) = &mut self.parts.compensator {
            compensator.set_level(level);
        }
    }

    #[inline]
    pub(crate) fn force(&mut self, moment: Moment) -> f64 {
        if self.none { 0.0 } else { self.sum(moment) }
    }

    fn sum(&mut self, moment: Moment) -> f64 {
        let mut force = 0.0;
        if let Some(compensator) = &mut self.parts.compensator {
            let surroundings = self.parts.surroundings;
            let seen = surroundings.map(|s| s.seen(moment.position));
            let [load, temperature, position] = seen.unwrap_or([f64::NAN; 3]);
            force += compensator.step(Input {
                load,
                temperature,
                position,
                reference_velocity: moment.ahead,
                measured_velocity: moment.rate,
                tracking_error: moment.error,
                enable: true,
                drive_force: self.command,
                learn: self.command.abs() < self.peak,
                ..Input::default()
            });
        }
        if let Some(learned) = self.parts.learned.get(moment.index) {
            force += learned;
        }
        self.modelled = force;
        if let Some(observer) = &self.parts.observer {
            let acted = self.commands[(self.newest + KEPT_COMMANDS - self.late) % KEPT_COMMANDS];
            force += observer.step(&mut self.observed, acted, moment.rate);
        }
        force
    }

    /// Records the force that was commanded.
    #[inline]
    pub(crate) fn applied(&mut self, command: f64) {
        self.command = command;
        if self.parts.observer.is_some() {
            self.newest = (self.newest + 1) % KEPT_COMMANDS;
            self.commands[self.newest] = command - self.modelled;
        }
    }
}
