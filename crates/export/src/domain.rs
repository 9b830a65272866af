//! What simulators take of a joint, each number with its ranges, and draws from them for domain randomisation.

mod document;
mod draw;

use crate::joint::{Joint, at_rest, six_digits};
use crate::number::Literal;
use crate::template::Fill;
use crate::{Error, File, Model, header};
pub(crate) use document::string;
pub use draw::{Draws, Width};

const SCRIPT: &str = include_str!("../templates/domain/domain.py.in");

/// The numbers of a joint with their ranges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Domain {
    /// The numbers; without any those of the law, without ranges.
    pub numbers: Vec<Number>,
    /// A square root of their correlations: a row for each number, of length 1.
    pub root: Vec<Vec<f64>>,
}

/// A number of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// `armature`, `inertia`, `frictionloss`, `damping`, `static_friction`, or a parameter of the law such as `sigma0`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Identified value.
    pub nominal: f64,
    /// Half of the 95 % interval from day to day and for another motion, on a [`Scale::Log`] the value times that of the
    /// logarithm; absent where not known, and then the number is not varied.
    pub half: [Option<f64>; 2],
    /// How it scatters.
    pub scale: Scale,
    /// Whether the data determine it.
    pub is_determined: bool,
}

/// How a number scatters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Normal in the logarithm.
    Log,
    /// Normal, and never negative.
    NotNegative,
    /// Normal.
    Any,
}

impl Number {
    /// A number that is not varied.
    fn fixed(name: &str, unit: String, nominal: f64) -> Self {
        Self {
            name: name.into(),
            unit,
            nominal,
            half: [None; 2],
            scale: Scale::NotNegative,
            is_determined: true,
        }
    }

    /// Its 95 % range of a width, if known.
    pub fn range(&self, width: Width) -> Option<[f64; 2]> {
        let half = self.half[width.place()]?;
        let (low, high) = (self.nominal - half, self.nominal + half);
        Some(match self.scale {
            Scale::Log => {
                let factor = libm::exp(half / self.nominal);
                [self.nominal / factor, self.nominal * factor]
            }
            Scale::NotNegative => [low.max(0.0), high],
            Scale::Any => [low, high],
        })
    }
}

/// A joint of a document.
pub(crate) struct Own<'a> {
    /// Name in the simulator.
    pub name: String,
    pub model: &'a Model,
    pub domain: Domain,
}

impl<'a> Own<'a> {
    /// The joint of one axis, by the name that it has in the files of other targets.
    pub fn axis(model: &'a Model) -> Self {
        let joint = Joint::of(model);
        Self {
            name: format!("{}_joint", model.identifier),
            model,
            domain: known(model, None, [joint.friction, joint.damping]),
        }
    }

    /// A joint of a robot.
    pub fn of_robot(name: &str, model: &'a Model, armature: f64, simulators: [f64; 2]) -> Self {
        Self {
            name: name.into(),
            model,
            domain: known(model, Some(armature), simulators),
        }
    }

    /// Refuses a unit that no simulator has.
    pub fn in_newtons(&self, target: &'static str) -> Result<(), Error> {
        let model = self.model;
        if model.in_newtons() {
            return Ok(());
        }
        Err(Error::ForceUnit {
            target,
            found: model.force_unit().into(),
            allowed: if model.rotary { "N m" } else { "N" },
        })
    }

    /// Coulomb and viscous friction.
    pub fn line(&self) -> [f64; 2] {
        ["frictionloss", "damping"].map(|name| self.nominal(name).unwrap_or(0.0))
    }

    pub fn nominal(&self, name: &str) -> Option<f64> {
        let found = self.domain.numbers.iter().find(|own| own.name == name);
        found.map(|own| own.nominal)
    }
}

/// The domain of a model, or its nominal numbers where it has none.
fn known(model: &Model, armature: Option<f64>, [friction, damping]: [f64; 2]) -> Domain {
    if !model.domain.numbers.is_empty() {
        return model.domain.clone();
    }
    let force = model.force_unit().to_string();
    let inertia = if model.rotary { "kg m^2" } else { "kg" };
    let per_speed = match model.rotary {
        true => format!("{force} s/rad"),
        false => format!("{force} s/m"),
    };
    let armature = armature.map(|value| Number::fixed("armature", inertia.into(), value));
    let numbers: Vec<Number> = armature
        .into_iter()
        .chain([
            Number::fixed("frictionloss", force.clone(), friction),
            Number::fixed("damping", per_speed, damping),
            Number::fixed(
                "static_friction",
                force,
                at_rest(&model.friction).max(friction),
            ),
        ])
        .collect();
    let one = |i: usize| (0..numbers.len()).map(move |j| f64::from(u8::from(i == j)));
    Domain {
        root: (0..numbers.len()).map(|i| one(i).collect()).collect(),
        numbers,
    }
}

/// Names of the files, and what heads them.
pub(crate) struct Head<'a> {
    pub identifier: &'a str,
    pub title: &'a str,
    pub notes: Vec<String>,
    pub provenance: &'a crate::Provenance,
    /// The head of a file in Python.
    pub comment: String,
}

impl<'a> Head<'a> {
    /// Of one axis.
    pub fn axis(model: &'a Model) -> Self {
        Self {
            identifier: &model.identifier,
            title: &model.title,
            notes: model.notes.clone(),
            provenance: &model.provenance,
            comment: header::table_comment(model, "# "),
        }
    }
}

/// The document with the ranges and, where asked for, draws, and a script that applies them.
pub(crate) fn files(head: &Head, joints: &[Own], draws: Option<&Draws>) -> Vec<File> {
    let name = head.identifier;
    let mut fill = Fill::default();
    fill.set("header", head.comment.clone()).set("name", name);
    vec![
        File::text(
            format!("{name}_domain.json"),
            document::text(head, joints, draws),
        ),
        File::text(format!("{name}_domain.py"), fill.render(SCRIPT)),
    ]
}

/// The numbers of `keys` of each joint as entries of a dictionary in Python.
pub(crate) fn entries(joints: &[Own], keys: &[(&str, &str)]) -> String {
    let line = |own: &Own| {
        let each = keys.iter().filter_map(|(key, number)| {
            Some(format!(
                "\"{key}\": {}",
                six_digits(own.nominal(number)?).c()
            ))
        });
        let each: Vec<String> = each.collect();
        let name = crate::robot::python::literal(&own.name);
        format!("    {name}: {{{}}},", each.join(", "))
    };
    let lines: Vec<String> = joints.iter().map(line).collect();
    lines.join("\n")
}
