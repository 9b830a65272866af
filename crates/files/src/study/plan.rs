//! A study, resolved: everything that a run of it needs, in SI units and the types of the simulation.

use super::belief::Family;
use super::model::Model;
use super::result::StudyInput;
use crate::error::Warning;
use stiction_codes::Code;
use stiction_friction::compensator::{Adaptation, Source, Watchdog};
use stiction_log::Motion;
use stiction_servo::controller::Controller;
use stiction_servo::cross_coupling::CrossCoupling;
use stiction_servo::disturbance::{Cogging, Disturbance};
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::law::AxisLaw;
use stiction_servo::learning::Learning;
use stiction_servo::levelled::Depends;
use stiction_servo::plane::PlaneMotion;
use stiction_servo::trajectory::Trajectory;

/// A study, resolved: ready to run.
pub struct Study {
    /// Name for the report.
    pub name: String,
    /// Seed of the noise and of drawn parameters.
    pub seed: u64,
    /// The simulated axis.
    pub machine: Machine,
    /// Reference motions of one axis.
    pub paths: Vec<PathPlan>,
    /// The second axis, where there is one.
    pub second: Option<Second>,
    /// Reference motions of both axes.
    pub contours: Vec<ContourPlan>,
    /// Controllers of the first axis.
    pub controllers: Vec<Named<Controller>>,
    /// What compensates friction; the first is none.
    pub compensators: Vec<Named<Scheme>>,
    /// What is believed of the first axis; the first family is the exact parameters.
    pub families: Vec<Family>,
    /// Why nothing is promised: what the models lack; none where something is, and for the values of a sweep.
    pub not_promised: Option<String>,
    /// What changes on the axis while it runs, in order of time.
    pub events: Vec<Event>,
    /// Values of a key in turn.
    pub sweeps: Vec<Sweep>,
    /// Whether the course of each run is kept.
    pub keeps_courses: bool,
    /// Files that were read, the study itself first.
    pub inputs: Vec<StudyInput>,
    /// What to beware of before anything runs.
    pub warnings: Vec<Warning>,
}

impl Study {
    /// Files that the study reads, itself first.
    pub fn inputs(&self) -> impl Iterator<Item = &str> {
        self.inputs.iter().map(|i| i.path.as_str())
    }

    /// The study itself, and that of each value of its sweeps, in their order.
    pub fn grids(&self) -> impl Iterator<Item = &Study> {
        let points = self.sweeps.iter().flat_map(|sweep| &sweep.points);
        std::iter::once(self).chain(points.map(|point| &point.study))
    }

    /// Takes over what is to beware of with the values of its sweeps and not without; once for each sweep and code.
    pub(super) fn warn_of_sweeps(&mut self) {
        for sweep in &mut self.sweeps {
            let mut said: Vec<Code> = self.warnings.iter().map(|w| w.code).collect();
            for point in &mut sweep.points {
                for mut warning in point.study.warnings.drain(..) {
                    if !said.contains(&warning.code) {
                        said.push(warning.code);
                        let value = stiction_number::quantity(point.value, &sweep.unit);
                        warning.message = format!("{} = {value}: {}", sweep.key, warning.message);
                        self.warnings.push(warning);
                    }
                }
            }
        }
    }
}

/// A change of the axis while it runs; nothing told to the compensator.
#[derive(Clone, Copy)]
pub struct Event {
    /// s from the beginning of a run.
    pub time: f64,
    /// The mass from then on, kg (kg m^2), where it changes.
    pub mass: Option<f64>,
    /// Factor on the friction of the law from then on, where it changes.
    pub friction: Option<f64>,
}

/// A key with several values in turn.
pub struct Sweep {
    /// The key with its table, such as `path.amplitude`; parameters of the law are `law.sigma0` and so on.
    pub key: String,
    /// SI unit of its values; empty for numbers.
    pub unit: String,
    /// Ascending.
    pub points: Vec<SweepPoint>,
}

/// One value of a sweep.
pub struct SweepPoint {
    /// SI.
    pub value: f64,
    /// The study with that value, with exact parameters alone.
    pub study: Study,
}

/// Something with the name under which it stands in tables.
pub struct Named<T> {
    /// The name, which no other entry of its kind has.
    pub name: String,
    /// What it names.
    pub value: T,
}

/// The simulated axis, without controller and compensator.
pub struct Machine {
    /// Linear or rotary.
    pub motion: Motion,
    /// Its parameters, and where they come from.
    pub model: Model,
    /// The law of the axis, with sigma1 capped unless the file says otherwise.
    pub law: AxisLaw,
    /// What its friction depends on beside the velocity; none where on nothing.
    pub depends: Option<Depends>,
    /// kg (kg m^2)
    pub mass: f64,
    /// Damper beside the law, N s/m (N m s/rad).
    pub viscous: f64,
    /// Spring to the origin, N/m (N m/rad).
    pub spring: f64,
    /// Whether the study gives the mass, rather than the model.
    pub given_mass: bool,
    /// Control rate, Hz.
    pub rate: f64,
    /// Plant steps in one control period.
    pub substeps: u32,
    /// Delay, current loop and limits.
    pub drive: Drive,
    /// Steps of the measured position.
    pub encoder: Encoder,
    /// Noise of the measured position before the encoder's steps, rms, m (rad).
    pub position_noise: f64,
    /// Cogging of the motor.
    pub cogging: Option<Cogging>,
    /// Force on the axis over time.
    pub disturbance: Option<Disturbance>,
}

/// A reference motion of one axis, and the time from which its samples count.
pub struct PathPlan {
    /// Its name.
    pub name: String,
    /// `sine`, `move`, `file` and others.
    pub kind: &'static str,
    /// The motion.
    pub trajectory: Box<dyn Trajectory + Send + Sync>,
    /// Time from which samples count, s.
    pub skip: f64,
}

/// What compensates friction.
pub enum Scheme {
    /// Nothing: what all others are compared with.
    None,
    /// A force from a law.
    Model(ModelScheme),
    /// A disturbance observer alone, with its bandwidth, Hz.
    Observer(f64),
    /// Iterative learning over this number of passes, of which the last counts.
    Learning(Learning, u64),
}

/// A force from the law.
pub struct ModelScheme {
    /// How much of the law.
    pub kind: ModelKind,
    /// The velocity that drives the law.
    pub source: Source<f64>,
    /// Part of the force that is let through, 0 to 1.
    pub gain: f64,
    /// Speed below which the force stays as it is, m/s (rad/s); `None`: what is exported for the law.
    pub dead_zone: Option<f64>,
    /// Largest force, N (N m); `None`: that of the controller.
    pub limit: Option<f64>,
    /// Largest change of the force, N/s (N m/s); `None`: what is exported for the law.
    pub slew: Option<f64>,
    /// Time in which the force comes in, s.
    pub ramp: f64,
    /// Adaptation of the level.
    pub adaptation: Option<Adaptation<f64>>,
    /// What switches the force off where it makes the error larger.
    pub watchdog: Option<Watchdog<f64>>,
    /// How far ahead the reference is read, samples; `None`: what the drive needs, for the reference velocity.
    pub preview: Option<f64>,
    /// Whether it is told load, temperature and position, where friction depends on them.
    pub inputs: bool,
    /// Whether mass and level of friction are estimated while running, and fed forward.
    pub load_estimate: bool,
    /// Bandwidth of a disturbance observer beside it, Hz.
    pub observer: Option<f64>,
}

/// How much of the law.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum ModelKind {
    /// Coulomb and viscous friction.
    Coulomb,
    /// The steady curve.
    Stribeck,
    /// The bristles without the Stribeck effect: static friction is Coulomb friction.
    Simplified,
    /// The whole law with its bristles or elements.
    Whole,
}

/// The second axis of a study, and what couples both.
pub struct Second {
    /// The axis.
    pub machine: Machine,
    /// One for each controller of the first axis, in its order.
    pub controllers: Vec<Controller>,
    /// What is believed of this axis, and how it may be: as many families with as many members as of the first.
    pub families: Vec<Family>,
    /// Control of the contour error, where there is any.
    pub coupling: Option<CrossCoupling>,
}

/// A contour, and the time from which its samples count.
pub struct ContourPlan {
    /// Its name.
    pub name: String,
    /// `circle`, `corner`, `square`, `figure-eight` or `file`.
    pub kind: &'static str,
    /// The motion of both axes.
    pub motion: Box<dyn PlaneMotion + Send + Sync>,
    /// Time from which samples count, s.
    pub skip: f64,
}
