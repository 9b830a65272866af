//! Numbers for the friction compensation that drives have built in: of those whose documentation says what a number means and in
//! which unit it counts.
//!
//! Beckhoff AX8000 and AMP8000: objects 0x3144:01 to 03. Beckhoff AX2000: ASCII commands ISTFR and VSTFR. Kollmorgen AKD and
//! AKD2G: IL.FRICTION and IL.OFFSET, by the formula of IL.FF.

use crate::check::Advice;
use crate::joint::{Difference, Joint, Speeds, six_digits};
use crate::number::Literal;
use crate::template::Fill;
use crate::{Error, File, Model, header};
use stiction_codes::Code;
use stiction_friction::compensator::Friction;

const TABLE: &str = include_str!("../templates/drive_table/table.csv.in");

/// Speed below which a current rises from 0, in Stribeck velocities, and in top speeds for a law without: as for the dead zone of
/// such a law.
const RISE: (f64, f64) = (0.01, 0.001);

/// A drive with its numbers.
struct Drive {
    name: &'static str,
    numbers: Vec<Number>,
    /// What its friction is, for people.
    form: &'static str,
    error: Difference,
}

struct Number {
    parameter: &'static str,
    value: f64,
    unit: String,
    meaning: &'static str,
}

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let drives = drives(model);
    if drives.is_empty() {
        return Err(Error::ForceUnit {
            target: "drive-table",
            found: model.force_unit().into(),
            allowed: if model.rotary { "N m or A" } else { "N or A" },
        });
    }
    let rows: Vec<String> = drives.iter().flat_map(rows).collect();
    let words: Vec<String> = drives
        .iter()
        .map(|drive| format!("# {}", words(drive, model)))
        .collect();
    // What each leaves out stands with it, not among the notes as well.
    let mut head = model.clone();
    let left = simplified(model);
    head.notes
        .retain(|note| left.as_ref().is_none_or(|left| *note != left.message));
    let mut fill = Fill::default();
    fill.set("header", header::table_comment(&head, "# "))
        .set("drives", words.join("\n"))
        .set("rows", rows.join("\n"))
        .set("way", model.length_unit())
        .flag("current", model.force_unit() == "A");
    let name = format!("{}_drive_table.csv", model.identifier);
    Ok(vec![File::text(name, fill.render(TABLE))])
}

fn rows(drive: &Drive) -> Vec<String> {
    let row = |n: &Number| {
        format!(
            "{},{},{},{},{}",
            drive.name,
            n.parameter,
            n.value.c(),
            n.unit,
            n.meaning
        )
    };
    drive.numbers.iter().map(row).collect()
}

fn words(drive: &Drive, model: &Model) -> String {
    format!(
        "{}: {}; against the law at constant velocity off by {}",
        drive.name,
        drive.form,
        drive.error.words(model)
    )
}

/// How far each is from the law.
pub(crate) fn simplified(model: &Model) -> Option<Advice> {
    let drives = drives(model);
    let words: Vec<String> = drives.iter().map(|drive| words(drive, model)).collect();
    (!words.is_empty()).then(|| Advice {
        code: Code::ExportSimplified,
        message: format!("a drive holds less than the law. {}", words.join(". ")),
    })
}

/// The drives that count in the unit of the model's force.
fn drives(model: &Model) -> Vec<Drive> {
    if model.in_newtons() {
        vec![ax8000(model)]
    } else if model.force_unit() == "A" {
        vec![akd(model), ax2000(model)]
    } else {
        vec![]
    }
}

fn ax8000(model: &Model) -> Drive {
    let joint = Joint::of(model);
    let (f, x, v) = (model.force_unit(), model.length_unit(), model.speed_unit());
    let mut numbers = Vec::new();
    if let Some(stiffness) = stiffness(&model.friction) {
        numbers.push(Number {
            parameter: "0x3144:01",
            value: six_digits(stiffness),
            unit: format!("{f}/{x}"),
            meaning: "static friction spring rate",
        });
    }
    numbers.push(Number {
        parameter: "0x3144:02",
        value: joint.friction,
        unit: f.into(),
        meaning: "static friction torque/force",
    });
    numbers.push(Number {
        parameter: "0x3144:03",
        value: joint.damping,
        unit: format!("{f}/({v})"),
        meaning: "dynamic friction factor",
    });
    Drive {
        name: "Beckhoff AX8000 and AMP8000",
        numbers,
        form: "a level in the direction of motion and a part that grows with the velocity",
        error: joint.error,
    }
}

/// Stiffness before anything slips.
fn stiffness(law: &Friction<f64>) -> Option<f64> {
    match law {
        Friction::Gms(law) => Some(law.elements().iter().map(|e| e.stiffness).sum()),
        law => law.bristle().map(|law| law.stiffness()),
    }
}

fn akd(model: &Model) -> Drive {
    let speeds = Speeds::of(model);
    let level = six_digits(speeds.mean(&|v| 0.5 * (model.steady(v) - model.steady(-v))));
    let offset = six_digits(speeds.mean(&|v| 0.5 * (model.steady(v) + model.steady(-v))));
    let number = |parameter, value, meaning| Number {
        parameter,
        value,
        unit: "A".into(),
        meaning,
    };
    Drive {
        name: "Kollmorgen AKD and AKD2G",
        numbers: vec![
            number(
                "IL.FRICTION",
                level,
                "friction feedforward while motion is commanded (rms)",
            ),
            number(
                "IL.OFFSET",
                offset,
                "feedforward that is always there (rms)",
            ),
        ],
        form: "a level in the direction of motion and a constant",
        error: speeds.error(model, &|v| level.copysign(v) + offset),
    }
}

fn ax2000(model: &Model) -> Drive {
    let speeds = Speeds::of(model);
    let full = six_digits(match model.stribeck_velocity() {
        0.0 => RISE.1 * speeds.top,
        velocity => RISE.0 * velocity,
    });
    let share = |v: f64| (v / full).clamp(-1.0, 1.0);
    let mean = |v: f64| 0.5 * (model.steady(v) - model.steady(-v));
    let level = speeds.mean(&|v| share(v) * mean(v)) / speeds.mean(&|v| share(v) * share(v));
    let level = six_digits(level);
    Drive {
        name: "Beckhoff AX2000",
        numbers: vec![
            Number {
                parameter: "ISTFR",
                value: level,
                unit: "A".into(),
                meaning: "current from VSTFR on",
            },
            Number {
                parameter: "VSTFR",
                value: full,
                unit: model.speed_unit().into(),
                meaning: "velocity up to which it rises from 0; to be written in VUNIT of the drive",
            },
        ],
        form: "a level in the direction of motion that rises from 0 with the velocity up to VSTFR",
        error: speeds.error(model, &|v| level * share(v)),
    }
}
