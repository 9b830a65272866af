//! The axis of the experiments, with numbers of our own where the paper gives none.

use super::search::search_box;
use super::units::Units;
use super::{dynamics, statics, tracking};
use std::f64::consts::TAU;
use stiction_friction::ParamError;
use stiction_servo::axis::{AxisSettings, Sample};
use stiction_servo::cascade::Cascade;
use stiction_servo::controller::Controller;
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::fuzzy::FuzzyPid;
use stiction_servo::integrator::Ode4;
use stiction_servo::known::{self, KnownAxis};
use stiction_servo::motion::Limits;
use stiction_servo::pid::Pid;
use stiction_servo::plant::Plant;
use stiction_servo::run::run_with;
use stiction_servo::trajectory::Trajectory;

/// Control rate, Hz: one step of ode4 of 1e-4 s in each period.
pub(super) const RATE: f64 = 1e4;

/// Bandwidth for which the controller of x is tuned on our stage, Hz, and that of y as a part of it.
pub(super) const BANDWIDTH: f64 = 60.0;
const SECOND: f64 = 0.75;
/// Bandwidth of the current loop below the cascade, Hz: that of [`Drive::linear_motor`].
const CURRENT_LOOP: f64 = 1000.0;

/// Encoder step of the stage, m: published.
const ENCODER: f64 = 50e-9;

/// Stribeck velocity (m/s) and deflection at break-away (m) of our stage, which motions on it are chosen for.
const STRIBECK_VELOCITY: f64 = 3e-3;
const PRESLIDING: f64 = 9e-6;
/// Least stroke over the deflection at break-away, in parts of that ratio on our stage, dimensionless: ten deflections
/// for the shortest one.
const LEAST_STROKE: f64 = 0.2;

/// Rise of the static level over the Coulomb level, as a part of that, below which there is no Stribeck curve, dimensionless.
const LEAST_RISE: f64 = 1e-3;
/// Speed of the axis over that of the reference for which ode4 has to be stable, dimensionless.
const OVERSHOOT: f64 = 1.1;

/// What is assumed of our stage.
const OURS: [&str; 2] = [
    "Friction of the stage: σ₀ 2·10⁶ N/m, σ₁ 1500 N·s/m (constant), σ₂ 30 N·s/m, Fc 12 N, Fs 18 N, vs 3 mm/s. The \
     paper's table is an image that no text carries.",
    "172.8 N/V: 96 N/A are published, 1.8 A/V follow if 10 V are the 18 A of the drive's peak. A thermal time of 10 s for \
     the rated 221 N.",
];

/// A controller of the experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// PID with fixed gains.
    Pid,
    /// The same PID with gains scheduled by fuzzy rules: that of the paper.
    Fuzzy,
    /// The three loops of the paper's drive: position, velocity and current.
    Cascade,
}

impl Control {
    /// All of them, the plain one first.
    pub const ALL: [Control; 3] = [Control::Pid, Control::Fuzzy, Control::Cascade];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Control::Pid => "PID",
            Control::Fuzzy => "fuzzy PID",
            Control::Cascade => "cascade",
        }
    }
}

/// The axes of the experiments.
#[derive(Clone, Debug)]
pub struct Stage {
    /// Name of an axis of the user, where it has one.
    pub name: Option<String>,
    /// Mass and friction of the axis that is identified: the truth.
    pub truth: KnownAxis,
    /// Whether it is an axis of the user.
    pub(super) own: bool,
    /// The other axis of the corner.
    pub(super) second: KnownAxis,
    pub(super) drive: Drive,
    pub(super) encoder: Encoder,
    /// Bandwidth for which its controllers are tuned, Hz.
    pub(super) bandwidth: f64,
    /// Steps of ode4 in a control period.
    pub(super) steps: u32,
    /// What is assumed of this axis, in words.
    pub(super) notes: Vec<String>,
}

impl Stage {
    /// The stage of this project.
    pub(super) fn ours() -> Result<Self, ParamError> {
        Ok(Stage {
            name: None,
            truth: axis("motor")?,
            own: false,
            // A heavier slide carries the stage.
            second: axis("machine")?,
            drive: Drive {
                current_lag: 0.0,
                ..Drive::linear_motor(0.0)
            },
            encoder: Encoder::new(ENCODER)?,
            bandwidth: BANDWIDTH,
            steps: 1,
            notes: OURS.map(String::from).into(),
        })
    }

    /// Units of the axis as they are typed.
    pub fn units(&self) -> Units {
        Units::of(self.truth.kind)
    }

    /// Whether it is an axis of the user.
    pub fn is_own(&self) -> bool {
        self.own
    }

    /// Bandwidths of the controllers of x and y, Hz.
    pub fn bandwidths(&self) -> [f64; 2] {
        [self.bandwidth, SECOND * self.bandwidth]
    }

    /// Parameters that the experiments cannot find, since the axis has none.
    pub fn without(&self) -> Vec<&'static str> {
        let [_, s1, s2, coulomb, rise, _] = self.genome();
        let absent = [
            ("sigma1", s1 <= 0.0),
            ("sigma2", s2 <= 0.0),
            // Without a difference between the levels there is nothing to fall.
            ("stribeck_velocity", rise <= LEAST_RISE * coulomb),
        ];
        let absent = absent.into_iter().filter(|(_, is)| *is);
        absent.map(|(name, _)| name).collect()
    }

    /// The fastest speed of any experiment, with some overshoot, m/s (rad/s).
    pub(super) fn fastest(&self) -> f64 {
        let sine = |amplitude: f64, frequency: f64| TAU * frequency * self.stroke(amplitude);
        let constant = self.speed(1e-3 * statics::SPEEDS[statics::SPEEDS.len() - 1]);
        let tracked = sine(tracking::AMPLITUDE, tracking::FREQUENCY);
        let dynamic = sine(dynamics::AMPLITUDE, dynamics::FREQUENCY);
        OVERSHOOT * constant.max(tracked).max(dynamic)
    }

    /// `[sigma0, sigma1, sigma2, Fc, Fs - Fc, vs]` of the axis, SI.
    pub(super) fn genome(&self) -> [f64; 6] {
        let law = &self.truth.law;
        let side = law.curve().positive();
        [
            law.stiffness(),
            law.damping().at_rest(),
            side.viscous,
            side.coulomb,
            side.static_friction - side.coulomb,
            side.stribeck_velocity,
        ]
    }

    /// The same in logarithms, as the searches have them; what the axis has none of is at the low end of its box.
    pub(super) fn point(&self) -> [f64; 6] {
        let [low, _] = search_box(self);
        let genome = self.genome();
        std::array::from_fn(|i| libm::log(if genome[i] > 0.0 { genome[i] } else { low[i] }))
    }

    /// The true value of a parameter, SI.
    pub fn true_value(&self, name: &str) -> f64 {
        let [s0, s1, s2, coulomb, rise, slow] = self.genome();
        match name {
            "sigma0" => s0,
            "sigma1" => s1,
            "sigma2" => s2,
            "coulomb" => coulomb,
            "static" => coulomb + rise,
            _ => slow,
        }
    }

    /// A speed on our stage, m/s, as the same part of the Stribeck velocity of this axis, m/s (rad/s).
    pub(super) fn speed(&self, ours: f64) -> f64 {
        ours * self.truth.law.curve().positive().stribeck_velocity / STRIBECK_VELOCITY
    }

    /// Limits of a motion on our stage, m and s, on this axis, as many times faster.
    pub(super) fn limits(&self, ours: Limits) -> Limits {
        Limits {
            velocity: self.speed(ours.velocity),
            acceleration: self.speed(ours.acceleration),
            jerk: self.speed(ours.jerk),
        }
    }

    /// A stroke on our stage, m, on this axis, m (rad): longer by as much as speeds are higher, and long enough to leave
    /// presliding.
    pub(super) fn stroke(&self, ours: f64) -> f64 {
        let presliding = self.truth.law.bound() / PRESLIDING;
        ours * self.speed(1.0).max(LEAST_STROKE * presliding)
    }

    /// Along a trajectory as the paper integrates it.
    pub(super) fn along(
        &self,
        settings: &AxisSettings,
        trajectory: &impl Trajectory,
    ) -> Result<Vec<Sample>, ParamError> {
        run_with(settings, trajectory, Ode4::new(self.steps)?)
    }

    /// The stage under a controller, Z25 eqs. (23)-(24): `M x'' = Ke u - F`, no delay, and a current loop of its own under
    /// the cascade only.
    pub(super) fn settings(&self, control: Control) -> Result<AxisSettings, ParamError> {
        self.controlled(&self.truth, control, self.bandwidths()[0])
    }

    /// The second axis of the corner.
    pub(super) fn second(&self, control: Control) -> Result<AxisSettings, ParamError> {
        self.controlled(&self.second, control, self.bandwidths()[1])
    }

    fn controlled(
        &self,
        axis: &KnownAxis,
        control: Control,
        bandwidth: f64,
    ) -> Result<AxisSettings, ParamError> {
        let limit = self.drive.peak_force();
        let friction = axis.law.curve().largest_static_level();
        let mut drive = self.drive;
        let controller = match control {
            Control::Pid => Controller::Pid(Pid::tuned(axis.mass, bandwidth, limit)?),
            Control::Fuzzy => {
                Controller::Fuzzy(FuzzyPid::tuned(axis.mass, bandwidth, limit, friction)?)
            }
            Control::Cascade => {
                drive.current_lag = 1.0 / (TAU * CURRENT_LOOP);
                Controller::Cascade(Cascade::tuned(axis.mass, bandwidth, limit)?)
            }
        };
        Ok(AxisSettings {
            plant: Plant::new(axis.mass, axis.law)?,
            drive,
            encoder: self.encoder,
            controller,
            feedforward: Feedforward::default(),
            substeps: 1,
            ..axis.simulated(RATE, bandwidth)?
        })
    }
}

fn axis(name: &str) -> Result<KnownAxis, ParamError> {
    known::find(name).ok_or(ParamError::new("axis", 0.0, "a known one"))
}
