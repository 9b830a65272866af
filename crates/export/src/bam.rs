//! Parameters of BAM, Better Actuator Models (Duclusaud et al. 2025, arXiv 2410.08650): friction by speed and load, M1 to M5.
//!
//! BAM's friction is `base + viscous |v| + stribeck e^-(|v/vs|^alpha)`, and grows with the torque on the gear, that of the motor less
//! the external one. In steady motion that is twice what the gear transmits, so a share of the transmitted torque is half of it there.

use crate::check::Advice;
use crate::domain::Own;
use crate::joint::{at_rest, six_digits};
use crate::number::{Literal, short};
use crate::{Error, File, Model};
use stiction_codes::Code;
use stiction_friction::Shape;

/// What the numbers of the motor stand for until somebody replaces them: the actuator of BAM whose control is a torque.
const ACTUATOR: &str = "unitree_go1";
/// Torque that does not limit it, N m.
const UNLIMITED: f64 = 1e6;
/// Slope of the straight line through 0 nearest to `v |v|` up to a top speed, in parts of that speed.
const QUADRATIC: f64 = 0.75;

/// Friction as BAM has it.
struct Bam {
    /// `m1` to `m5`.
    model: &'static str,
    numbers: Vec<(&'static str, f64)>,
    /// What it lacks, in words.
    notes: Vec<String>,
}

impl Bam {
    fn of(model: &Model, [friction, damping]: [f64; 2]) -> Result<Self, Error> {
        let law = &model.friction;
        let both = |sides: [f64; 2]| 0.5 * (sides[0] + sides[1]);
        let mut notes = Vec::new();
        let coulomb = both(law.coulomb());
        let excess = at_rest(law) - coulomb;
        let curve = law.curve();
        let levels = model.terms.levels.unwrap_or_default();
        let share = both(levels.transmitted);
        let [slope, driven] = [share, both(levels.driven)].map(|part| part * coulomb);
        let differs = curve.map_or(
            law.coulomb()[0] != law.coulomb()[1] || law.viscous()[0] != law.viscous()[1],
            |curve| curve.positive() != curve.negative(),
        );
        if differs {
            notes.push("the directions differ: their mean is here".to_string());
        }
        if model.friction.presliding().is_some() {
            notes.push("presliding (sigma0, sigma1) has no place in BAM".into());
        }
        let falls = excess > 0.0;
        if !falls && slope == 0.0 && driven == 0.0 {
            return Ok(Self {
                model: "m1",
                numbers: vec![("friction_base", friction), ("friction_viscous", damping)],
                notes,
            });
        }
        let quadratic = QUADRATIC * both(levels.quadratic) * levels.top_speed;
        if quadratic != 0.0 {
            notes.push(
                "quadratic viscous friction is in friction_viscous as its nearest line".into(),
            );
        }
        let viscous = (both(law.viscous()) + quadratic).max(0.0);
        // The model has the level at the mean transmitted torque, BAM that without any.
        let unloaded = 1.0 - share * model.terms.channels.transmitted.reference;
        if unloaded < 0.0 {
            notes.push("friction without load would be negative: it is 0 here".into());
        }
        let level = unloaded.max(0.0);
        let mut numbers = vec![
            ("friction_base", coulomb * level),
            ("friction_viscous", viscous),
        ];
        let mut ratio = 0.0;
        if let Some(curve) = curve.filter(|_| falls) {
            ratio = excess / coulomb;
            let exponent = match curve.shape() {
                Shape::Gaussian => 2.0,
                Shape::Exponential => 1.0,
                Shape::Power(exponent) => exponent,
                Shape::Lorentzian => {
                    return Err(Error::Law {
                        target: "bam",
                        law: format!("{} with a Lorentzian Stribeck curve", model.law()),
                        allowed: "a Stribeck curve with an exponent",
                    });
                }
            };
            numbers.push(("friction_stribeck", excess * level));
            let velocity = [curve.positive(), curve.negative()].map(|side| side.stribeck_velocity);
            numbers.push(("dtheta_stribeck", both(velocity)));
            numbers.push(("alpha", exponent));
        }
        let known = match (slope + 0.5 * driven > 0.0, driven_apart(slope, driven)) {
            (false, _) => {
                if slope != 0.0 || driven != 0.0 {
                    notes.push(
                        "friction falls with the transmitted torque: BAM has the mean level".into(),
                    );
                }
                Vec::new()
            }
            (true, Some([motor, external])) if falls => vec![
                ("load_friction_motor", motor),
                ("load_friction_external", external),
                ("load_friction_motor_stribeck", motor * ratio),
                ("load_friction_external_stribeck", external * ratio),
            ],
            (true, _) => {
                if driven != 0.0 {
                    notes.push(
                        "friction grows differently where the load drives: BAM has the mean of both"
                            .into(),
                    );
                }
                // Half of the sum is the mean slope, and the torque on the gear twice what it transmits.
                let mean = 0.5 * (slope + 0.5 * driven);
                let base = ("load_friction_base", mean);
                match falls {
                    true => vec![base, ("load_friction_stribeck", mean * ratio)],
                    false => vec![base],
                }
            }
        };
        let name = match (falls, known.len()) {
            (true, 0) => "m2",
            (false, 0) => "m1",
            (false, _) => "m3",
            (true, 2) => "m4",
            (true, _) => "m5",
        };
        numbers.extend(known);
        Ok(Self {
            model: name,
            numbers,
            notes,
        })
    }
}

/// Shares of the motor's and the external torque with which friction grows by `slope` of what is transmitted while the motor drives,
/// and `driven` more while the load does; `None` where BAM cannot have that.
///
/// In steady motion the motor has what is transmitted and friction f, more or less by who drives: `f = (m + e) t + m f` or
/// `f = (m + e) t - m f`.
fn driven_apart(slope: f64, driven: f64) -> Option<[f64; 2]> {
    let (drives, is_driven) = (slope, slope + driven);
    let motor = (drives - is_driven) / (drives + is_driven);
    let external = is_driven * (1.0 + motor) - motor;
    let is_possible = driven != 0.0 && (0.0..1.0).contains(&motor) && external >= 0.0;
    is_possible.then_some([motor, external])
}

/// What a law has that BAM has not.
pub(crate) fn simplified(model: &Model) -> Option<Advice> {
    let own = Own::axis(model);
    let bam = Bam::of(model, own.line()).ok()?;
    let message = format!(
        "BAM {} with {}{}",
        bam.model.to_uppercase(),
        bam.numbers
            .iter()
            .map(|(name, value)| format!("{name} {}", short(*value)))
            .collect::<Vec<_>>()
            .join(", "),
        bam.notes
            .iter()
            .map(|note| format!("; {note}"))
            .collect::<String>(),
    );
    (!bam.notes.is_empty()).then_some(Advice {
        code: Code::ExportSimplified,
        message,
    })
}

/// The file of one axis, whose inertia counts as that of the rotor.
pub(crate) fn axis(model: &Model) -> Result<Vec<File>, Error> {
    let own = Own::axis(model);
    own.in_newtons("bam")?;
    Ok(vec![file(model, own.nominal("inertia"), own.line())?])
}

/// The file of a joint.
pub(crate) fn file(
    model: &Model,
    armature: Option<f64>,
    simulators: [f64; 2],
) -> Result<File, Error> {
    let bam = Bam::of(model, simulators)?;
    let string = crate::domain::string;
    let mut lines = vec![
        format!("\"model\": \"{}\"", bam.model),
        format!("\"actuator\": \"{ACTUATOR}\""),
        "\"ratio\": 1.0".to_string(),
        format!("\"max_torque\": {}", UNLIMITED.c()),
    ];
    lines.extend(armature.map(|value| format!("\"armature\": {}", six_digits(value).c())));
    let numbers = bam.numbers.iter();
    lines.extend(numbers.map(|(name, value)| format!("\"{name}\": {}", six_digits(*value).c())));
    let motor = "the motor was not identified: put your actuator with its kt and R in place of actuator, ratio and max_torque";
    let notes = (model.notes.iter().map(String::as_str))
        .chain([motor])
        .chain(bam.notes.iter().map(String::as_str));
    let notes: Vec<String> = notes.map(|note| format!("    {}", string(note))).collect();
    lines.push(format!("\"notes\": [\n{}\n  ]", notes.join(",\n")));
    lines.push(format!("\"title\": {}", string(&model.title)));
    lines.push(format!(
        "\"model_sha256\": {}",
        string(&model.provenance.model_sha256)
    ));
    Ok(File::text(
        format!("{}_bam.json", model.identifier),
        format!("{{\n  {}\n}}\n", lines.join(",\n  ")),
    ))
}
