//! From what the axis file gives to what a plan needs, with what is assumed where it is silent.

use super::known::{Known, Told};
use super::possible::{reachable, samples, thinned};
use super::{PlanOptions, asked, carried, law};
use crate::error::Error;
use std::path::Path;
use stiction_files::plan::Assumed;
use stiction_files::{Axis, Warning};
use stiction_identify::Mass;
use stiction_log::Motion;
use stiction_parameters::LawKind;
use stiction_plan::{Aim, Belief, Candidate, Limits, Loop, Nameplate, Rig, Subject};
use stiction_servo::cascade::Cascade;

/// What a plan is made with.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// Linear or rotary.
    pub motion: Motion,
    /// Limits, drive, encoder and the ranges of what is not known.
    pub nameplate: Nameplate,
    /// The rig with the log that is recorded; that of the nameplate is simulated, and may have a slower one.
    pub logged: Rig,
    /// What a first model or log leaves open, in place of what the nameplate does.
    pub belief: Option<Belief>,
    /// The noise, and what is known from a log that will be identified together with that of the motion.
    pub aim: Aim,
    /// What an identification of the log will fit.
    pub subject: Subject,
    /// Where the axis stands when the motion starts, m (rad).
    pub start: f64,
    /// What the axis file does not give.
    pub assumed: Vec<Assumed>,
    /// What is not planned for though it is asked for.
    pub warnings: Vec<Warning>,
}

impl Given {
    /// Axes that are thought possible; other seeds are others.
    pub(super) fn draw(&self, count: usize, seed: u32) -> Vec<Candidate> {
        match &self.belief {
            Some(belief) => belief.draw(&self.nameplate.limits, count, seed),
            None => self.nameplate.draw(&self.subject, count, seed),
        }
    }

    /// What allows these axes.
    pub fn known_by(&self) -> &'static str {
        match self.belief {
            Some(_) => "the first identification",
            None => "the nameplate",
        }
    }
}

/// Parts of the largest speed and acceleration of a probe.
const PROBE: f64 = 0.5;
/// How many times larger or smaller the mass may be than the axis file says.
const MASS_FACTOR: f64 = 2.0;
/// Part of the stroke that is left free at either end.
const END_ZONE: f64 = 0.05;
/// Time in which the largest acceleration is reached, s.
const JERK_TIME: f64 = 5e-3;
/// Rate of a log, Hz.
const RATE: f64 = 2000.0;
/// One encoder step, m, and of a rotary axis, rad: 17 bits a turn.
const STEP: f64 = 1e-6;
const ANGLE_STEP: f64 = std::f64::consts::TAU / 131_072.0;
/// Noise of the logged force over the rated one.
const NOISE: f64 = 0.005;
/// Bandwidth of the speed loop, Hz, and its largest over the rate of the log.
const BANDWIDTH: f64 = 40.0;
const OF_RATE: f64 = 1.0 / 20.0;

/// A limit that no plan goes without and the axis file does not give.
pub(super) struct Lacking {
    pub key: &'static str,
    /// What it is.
    pub what: &'static str,
    /// A value as it is written.
    pub example: &'static str,
}

/// The limits that are missing.
pub(super) fn lacking(axis: &Axis, has_mass: bool) -> impl Iterator<Item = Lacking> {
    let limits = axis.limits.as_ref();
    let rotary = is_rotary(axis);
    let one = |is_given: bool, key, what, [linear, turning]: [&'static str; 2]| {
        let example = if rotary { turning } else { linear };
        (!is_given).then_some(Lacking { key, what, example })
    };
    [
        one(
            limits.is_some_and(|l| l.stroke.is_some()),
            "limits.stroke",
            "how far the axis may go from where it stands",
            ["[\"-100 mm\", \"100 mm\"]", "[\"-180 deg\", \"180 deg\"]"],
        ),
        one(
            limits.is_some_and(|l| l.speed.is_some()),
            "limits.speed",
            "the largest speed",
            ["\"0.2 m/s\"", "\"300 rpm\""],
        ),
        one(
            limits.is_some_and(|l| l.acceleration.is_some()),
            "limits.acceleration",
            "the largest acceleration",
            ["\"6 m/s2\"", "\"200 rad/s2\""],
        ),
        one(
            limits.is_some_and(|l| l.rated_force.is_some()),
            "limits.rated_force",
            "the force or torque that the drive can give for long",
            ["\"150 N\"", "\"1.3 N m\""],
        ),
        one(
            has_mass,
            "limits.mass",
            "what moves, within a factor of two",
            ["\"10 kg\"", "\"5 kg cm2\""],
        ),
    ]
    .into_iter()
    .flatten()
}

fn is_rotary(axis: &Axis) -> bool {
    let limits = axis.limits.as_ref();
    limits.is_some_and(|l| l.motion == Motion::Rotary)
        || axis.mapping.motion == Some(Motion::Rotary)
}

/// What the axis file gives, and what is assumed where it may be.
pub(super) fn given(
    axis: &Axis,
    file: &Path,
    told: Option<Told>,
    options: &PlanOptions,
) -> Result<Given, Error> {
    let limits = axis.limits.as_ref();
    let mass = limits.and_then(|l| l.mass).or(match axis.terms.mass {
        Mass::Given(mass) => Some(mass),
        Mass::Fitted | Mass::Absent => None,
    });
    let mass = mass.or(told.as_ref().and_then(Told::mass));
    let missing: Vec<(&str, String)> = lacking(axis, mass.is_some())
        .map(|lack| (lack.key, format!("{}, such as {}", lack.what, lack.example)))
        .collect();
    let (Some(l), Some(mass), true) = (limits, mass, missing.is_empty()) else {
        return Err(axis.missing(&missing).into());
    };
    let (Some(stroke), Some(speed), Some(acceleration), Some(rated)) =
        (l.stroke, l.speed, l.acceleration, l.rated_force)
    else {
        return Err(axis.missing(&missing).into());
    };
    if let (Some(of_limits), Mass::Given(stated)) = (l.mass, axis.terms.mass)
        && !(1.0 / MASS_FACTOR..=MASS_FACTOR).contains(&(stated / of_limits))
    {
        let full = stiction_number::full;
        let found = format!("{} beside mass = {}", full(of_limits), full(stated));
        let allowed = "the same mass within a factor of two, or left out where mass is given";
        let code = stiction_codes::Code::BadConfig;
        if let Some(refused) = axis.refuse("limits.mass", found, allowed, code) {
            return Err(refused.into());
        }
    }
    let motion = l.motion;
    let mut assumed = Vec::new();
    let mut or = |given: Option<f64>, key: &str, value: f64, unit: String| {
        given.unwrap_or_else(|| {
            assumed.push(Assumed {
                key: key.into(),
                value,
                unit,
            });
            value
        })
    };
    let jerk_unit = format!("{}/s^3", motion.position().si_text());
    let (force, length) = (motion.force().si_text(), motion.position().si_text());
    let step = match motion {
        Motion::Linear => STEP,
        Motion::Rotary => ANGLE_STEP,
    };
    let limits = Limits {
        stroke,
        end_zone: or(l.end_zone, "limits.end_zone", END_ZONE, "1".into()),
        speed,
        acceleration,
        jerk: or(l.jerk, "limits.jerk", acceleration / JERK_TIME, jerk_unit),
        rated_force: rated,
        peak_force: or(l.peak_force, "limits.peak_force", rated, force.clone()),
    };
    let shown = told.as_ref();
    let rate = or(
        axis.mapping.rate_hz.or(shown.and_then(|t| t.rate)),
        "rate",
        RATE,
        "Hz".into(),
    );
    let rig = Rig {
        rate,
        encoder_step: or(
            axis.mapping.resolution.or(shown.and_then(|t| t.step)),
            "log.resolution",
            step,
            length,
        ),
        force_noise: or(
            l.force_noise.or(shown.and_then(|t| t.force_noise)),
            "limits.force_noise",
            NOISE * rated,
            force,
        ),
        loop_: match axis.controller_of(motion)? {
            Some(known) => Loop::Gains(
                Cascade {
                    position_gain: known.position_gain,
                    speed_gain: known.speed_gain,
                    integral_gain: known.integral_gain,
                    mass_feedforward: known.mass_feedforward,
                    force_limit: limits.peak_force.min(known.force_limit),
                },
                known.velocity_feedforward,
            ),
            None => {
                let usual = BANDWIDTH.min(OF_RATE * rate);
                Loop::Tuned(or(
                    axis.bandwidth,
                    "controller.bandwidth",
                    usual,
                    "Hz".into(),
                ))
            }
        },
    };
    let whole = limits;
    let limits = match options.probe {
        true => Limits {
            speed: PROBE * limits.speed,
            acceleration: PROBE * limits.acceleration,
            ..limits
        },
        false => limits,
    };
    let logged = Nameplate {
        mass,
        mass_factor: MASS_FACTOR,
        limits,
        rig,
    };
    logged.validate().map_err(|e| {
        let key = match e.name {
            "rate" | "mass" => e.name.to_string(),
            "resolution" => "log.resolution".into(),
            "bandwidth" | "position_gain" | "speed_gain" | "integral_gain" => {
                format!("controller.{}", e.name)
            }
            name => format!("limits.{name}"),
        };
        let found = stiction_number::full(e.value);
        let code = stiction_codes::Code::BadConfig;
        let refused = axis.refuse(&key, found.clone(), e.allowed, code);
        refused.map_or_else(
            || Error::usage(format!("{key} = {found}"), e.allowed),
            Error::from,
        )
    })?;
    samples(axis, rate, options.longest())?;
    let unhalved = Nameplate {
        limits: whole,
        ..logged
    };
    reachable(axis, &unhalved, motion, options.longest())?;
    let nameplate = Nameplate {
        rig: thinned(rig),
        ..logged
    };
    let is_asymmetric = options.asymmetric || told.as_ref().is_some_and(Told::is_asymmetric);
    let start = carried::start(motion, options)?;
    let law = asked::Law {
        elements: told.as_ref().and_then(Told::elements),
        is_asymmetric,
        // Without a first identification nothing is known of elements.
        steps: law::steps(file, LawKind::Gms),
    };
    let mut asked = asked::asked(axis, motion, &law, (start, &whole))?;
    if let Some(told) = &told {
        asked.warnings.extend(told.doubt.clone());
        asked
            .warnings
            .extend(asked::of_model(&told.beyond(&asked.subject)));
    }
    if asked.waves && options.start.is_none() {
        assumed.push(Assumed {
            key: "position where it starts (--start)".into(),
            value: 0.0,
            unit: motion.position().si_text(),
        });
    }
    let elements = asked
        .subject
        .elements
        .filter(|_| axis.gms_elements.is_none());
    if let Some(elements) = elements {
        // What the log of the motion has to be identified with.
        assumed.push(Assumed {
            key: "terms.gms_elements".into(),
            value: elements.count as f64,
            unit: "1".into(),
        });
    }
    let belief = told
        .map(|told| told.belief(&asked.subject, &nameplate))
        .transpose()?;
    let mut aim = Aim::new(nameplate.rig.force_noise);
    if let (Some(Known::Log(_)), Some(belief)) = (&options.known, &belief) {
        aim.known = belief.deviations.clone();
    }
    Ok(Given {
        motion,
        nameplate,
        logged: rig,
        belief,
        aim,
        subject: asked.subject,
        start,
        assumed,
        warnings: asked.warnings,
    })
}
