//! Coulomb and viscous friction of a joint, which is all that URDF, SDFormat and Isaac Lab hold: the numbers nearest to the
//! law, and how far they are from it.

use crate::check::{Advice, FAST_STRIBECK_VELOCITIES};
use crate::number::{Literal, short};
use crate::template::Fill;
use crate::{Error, File, Model, header, mujoco};
use stiction_codes::Code;
use stiction_friction::compensator::Friction;

const URDF: &str = include_str!("../templates/joint/joint.urdf.in");
const SDF: &str = include_str!("../templates/joint/joint.sdf.in");
const ISAAC_LAB: &str = include_str!("../templates/joint/isaaclab.py.in");

/// Speeds over which law and joint are compared: the middles of this many equal parts.
const SPEEDS: u32 = 10_000;
/// Top speed of a law without a Stribeck velocity where that of the log is not known, m/s (rad/s).
const TOP_SPEED: f64 = 1.0;

/// The friction of a joint: `sgn(v) friction + damping v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Joint {
    /// N (N m).
    pub(crate) friction: f64,
    /// N s/m (N m s/rad).
    pub(crate) damping: f64,
    /// Mean static friction of the directions, not below `friction`; N (N m).
    at_rest: f64,
    /// Its difference from the law.
    pub(crate) error: Difference,
}

impl Joint {
    /// The least squares over all speeds from 0 to the top speed of the log, each alike, and both directions alike.
    pub(crate) fn of(model: &Model) -> Self {
        let speeds = Speeds::of(model);
        // Half of the way between the directions: the offset is in neither number.
        let mean = |v: f64| 0.5 * (model.steady(v) - model.steady(-v));
        let (middle, forces) = (speeds.mean(&|v| v), speeds.mean(&mean));
        let slope = speeds.mean(&|v| (v - middle) * mean(v))
            / speeds.mean(&|v| (v - middle) * (v - middle));
        let (friction, damping) = match (forces - slope * middle, slope) {
            (_, slope) if slope < 0.0 => (forces, 0.0),
            (level, _) if level < 0.0 => {
                (0.0, speeds.mean(&|v| v * mean(v)) / speeds.mean(&|v| v * v))
            }
            both => both,
        };
        // What the log itself shows comes first: the law may have terms that a joint has not.
        let known = ["frictionloss", "damping"].map(|name| {
            let found = model.domain.numbers.iter().find(|own| own.name == name);
            found.map(|own| own.nominal)
        });
        let [friction, damping] = match known {
            [Some(friction), Some(damping)] => [friction, damping],
            _ => [friction, damping],
        };
        let (friction, damping) = (six_digits(friction), six_digits(damping));
        Joint {
            friction,
            damping,
            at_rest: six_digits(at_rest(&model.friction)).max(friction),
            error: speeds.error(model, &|v| friction.copysign(v) + damping * v),
        }
    }
}

/// Coulomb friction, N (N m), and viscous friction, N s/m (N m s/rad), nearest to a law from 0 to the top speed of its log.
pub fn nearest_line(model: &Model) -> [f64; 2] {
    let Joint {
        friction, damping, ..
    } = Joint::of(model);
    [friction, damping]
}

/// Static friction of a law, the mean of the directions, N (N m).
pub fn static_friction(model: &Model) -> f64 {
    at_rest(&model.friction)
}

/// The speeds over which a law and something simpler are compared, all alike and both directions alike.
pub(crate) struct Speeds {
    /// From 0 to this, m/s (rad/s).
    pub(crate) top: f64,
}

/// How far something simpler is from a law over [`Speeds`], in the unit of its force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Difference {
    top: f64,
    /// Root of the mean square.
    rms: f64,
    /// The largest, and at which velocity: 0 for the limit as the speed goes to 0.
    most: (f64, f64),
}

impl Speeds {
    /// Those of the log, where the model has them.
    pub(crate) fn of(model: &Model) -> Self {
        let top = model.top_speed.filter(|top| *top > 0.0);
        Self {
            top: top.unwrap_or_else(|| match model.stribeck_velocity() {
                0.0 => TOP_SPEED,
                velocity => FAST_STRIBECK_VELOCITIES * velocity,
            }),
        }
    }

    fn each(&self) -> impl Iterator<Item = f64> + '_ {
        (0..SPEEDS).map(|k| self.top * (f64::from(k) + 0.5) / f64::from(SPEEDS))
    }

    /// The mean of a function of the speed.
    pub(crate) fn mean(&self, of: &dyn Fn(f64) -> f64) -> f64 {
        self.each().map(of).sum::<f64>() / f64::from(SPEEDS)
    }

    /// How far a force by velocity is from the law.
    pub(crate) fn error(&self, model: &Model, force: &dyn Fn(f64) -> f64) -> Difference {
        let off = |v: f64| model.steady(v) - force(v);
        let square = self.mean(&|v| 0.5 * (off(v) * off(v) + off(-v) * off(-v)));
        let mut most = (0.0, 0.0);
        // Nothing is faster than the top speed, nothing slower than the limit at standstill.
        let ends = [crate::model::ALMOST_STANDSTILL, self.top];
        for v in self.each().chain(ends) {
            for v in [v, -v] {
                if off(v).abs() > most.0 {
                    let slowest = v.abs() <= crate::model::ALMOST_STANDSTILL;
                    most = (off(v).abs(), if slowest { 0.0 } else { v });
                }
            }
        }
        Difference {
            top: self.top,
            rms: libm::sqrt(square),
            most,
        }
    }
}

impl Difference {
    /// In words, behind `off by`.
    pub(crate) fn words(&self, model: &Model) -> String {
        let (unit, speed_unit) = (model.force_unit(), model.speed_unit());
        let share = match model.scale() {
            scale if scale > 0.0 => {
                format!(
                    " ({:.1} percent of static friction)",
                    100.0 * self.rms / scale
                )
            }
            _ => String::new(),
        };
        let at = match self.most.1 {
            0.0 => "at standstill".into(),
            v => format!("at {} {speed_unit}", short(v)),
        };
        let range = match model.top_speed {
            Some(top) if top > 0.0 => "those of the log",
            _ => "assumed, since the model does not have those of its log",
        };
        format!(
            "{} {unit} rms{share}, {} {unit} at most, {at}, over speeds of 0 to {} {speed_unit} ({range}), each speed and both directions weighted alike",
            short(self.rms),
            short(self.most.0),
            short(self.top),
        )
    }
}

/// Static friction of a law, the mean of the directions, N (N m).
pub(crate) fn at_rest(law: &Friction<f64>) -> f64 {
    let levels = match law.curve() {
        Some(curve) => [curve.positive(), curve.negative()].map(|side| side.static_friction),
        None => law.coulomb(),
    };
    0.5 * (levels[0] + levels[1])
}

pub(crate) fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// How far a joint is from the law.
pub(crate) fn simplified(model: &Model) -> Advice {
    let joint = Joint::of(model);
    let (unit, speed_unit) = (model.force_unit(), model.speed_unit());
    Advice {
        code: Code::ExportSimplified,
        message: format!(
            "the joint has Coulomb and viscous friction only, {} {unit} and {} {unit} per {speed_unit}: against the law they are off by {}; \
             bristles and offset are left out",
            short(joint.friction),
            short(joint.damping),
            joint.error.words(model),
        ),
    }
}

pub(crate) fn urdf(model: &Model) -> Result<Vec<File>, Error> {
    let fill = fill(model, "urdf")?;
    let name = format!("{}_friction.urdf", model.identifier);
    Ok(vec![File::text(name, xml(model, fill, URDF))])
}

pub(crate) fn sdf(model: &Model) -> Result<Vec<File>, Error> {
    let fill = fill(model, "sdf")?;
    let name = format!("{}_friction.sdf", model.identifier);
    Ok(vec![File::text(name, xml(model, fill, SDF))])
}

pub(crate) fn isaac_lab(model: &Model) -> Result<Vec<File>, Error> {
    let mut fill = fill(model, "isaaclab")?;
    fill.set("header", header::table_comment(&told(model), "# "));
    let name = format!("{}_friction.py", model.identifier);
    Ok(vec![File::text(name, fill.render(ISAAC_LAB))])
}

fn xml(model: &Model, mut fill: Fill, template: &str) -> String {
    let words = header::table_comment(&told(model), "");
    fill.set("header", mujoco::spaced(&words)).render(template)
}

/// The model with the error among its notes.
pub(crate) fn told(model: &Model) -> Model {
    let mut told = model.clone();
    let error = simplified(model).message;
    if !told.notes.contains(&error) {
        told.notes.push(error);
    }
    told
}

fn fill(model: &Model, target: &'static str) -> Result<Fill, Error> {
    if !model.in_newtons() {
        return Err(Error::ForceUnit {
            target,
            found: model.force_unit().into(),
            allowed: if model.rotary { "N m" } else { "N" },
        });
    }
    let joint = Joint::of(model);
    let mut fill = Fill::default();
    fill.set("name", model.identifier.clone())
        .set("NAME", model.identifier.to_ascii_uppercase())
        .set("friction", joint.friction.c())
        .set("damping", joint.damping.c())
        .set("at_rest", joint.at_rest.c())
        .set(
            "type",
            if model.rotary {
                "revolute"
            } else {
                "prismatic"
            },
        )
        .set(
            "free",
            if model.rotary {
                "continuous"
            } else {
                "prismatic"
            },
        )
        .set("axis", if model.rotary { "0 0 1" } else { "1 0 0" })
        .set("f_unit", model.force_unit())
        .set("v_unit", model.speed_unit())
        .flag("linear", !model.rotary);
    Ok(fill)
}
