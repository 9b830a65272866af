//! The gap between motor and load as a correction of the position of the motor, on which the encoder is.
//!
//! LinuxCNC (`control.c`, `usrmotintf.cc`): adds half of `BACKLASH` moving up and subtracts it moving down; a file of
//! `COMP_FILE_TYPE = 1` has rows of position, forward and reverse correction, with lines between them, up to the first row that is not
//! one. TwinCAT (Tc2_MC2, `MC_TableBasedPositionCompensation`): an array of positions and corrections that act in one direction, added
//! to the actual position.

use crate::map::Map;
use crate::number::{Literal, short};
use crate::template::Fill;
use crate::{Advice, Backlash, Error, File, Model, header};
use std::f64::consts::TAU;
use stiction_codes::Code;

const CSV: &str = include_str!("../templates/backlash/gap.csv.in");
const INI: &str = include_str!("../templates/backlash/linuxcnc.ini.in");
const COMP: &str = include_str!("../templates/backlash/linuxcnc_comp.in");
const TWINCAT: &str = include_str!("../templates/backlash/twincat.st.in");

/// Half of an interval as a part of the width up to which nothing is said.
const KNOWN: f64 = 0.2;
/// Millimetres in a metre and in an inch.
const MILLIMETRES: f64 = 1e3;
const INCH: f64 = 25.4;

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let gap = gap(model)?;
    // What the controllers count in.
    let (unit, factor) = match model.rotary {
        true => ("degrees", 360.0 / TAU),
        false => ("mm", MILLIMETRES),
    };
    let metric = correction(&gap, model, 1.0);
    let counted = correction(&gap, model, factor);
    let width = factor * gap.width;
    let name = &model.identifier;
    let mut fill = Fill::default();
    fill.set("header", header::table_comment(model, "# "))
        .set("name", name.clone())
        .set("x_unit", model.length_unit())
        .set("unit", unit)
        .set("width", width.c())
        .set("inches", (width / INCH).c())
        .flag("linear", !model.rotary)
        .set("metric", metric.lines(","))
        .set("counted", counted.lines(" "))
        .set("from", counted.from.st())
        .set("to", (counted.from + counted.step).st())
        .set("count", counted.values.len().to_string())
        .set("elements", elements(&counted));
    let mut in_st = fill.clone();
    let words = header::table_comment(model, "   ");
    in_st.set("header", format!("(* {}", words.trim_start()));
    let file = |path: &str, text: String| File::text(format!("{name}_{path}"), text);
    Ok(vec![
        file("backlash.csv", fill.render(CSV)),
        file("linuxcnc.ini", fill.render(INI)),
        file("linuxcnc_comp.txt", fill.render(COMP)),
        file("twincat.st", in_st.render(TWINCAT)),
    ])
}

/// The gap is known so little that a correction by its width may make a wrong one.
pub(crate) fn uncertain(model: &Model) -> Option<Advice> {
    let gap = model.backlash?;
    let [low, high] = gap.interval?;
    let wide = (high - low) > 2.0 * KNOWN * gap.width;
    let [width, low, high] = [gap.width, low, high].map(short);
    wide.then(|| Advice {
        code: Code::Backlash,
        message: format!(
            "the width of {width} {unit} is known as {low} to {high} {unit} only, and too much correction makes the axis hunt: measure it \
             with a dial gauge, or begin with the lower end",
            unit = model.length_unit()
        ),
    })
}

/// The gap, if its width is known.
fn gap(model: &Model) -> Result<Backlash, Error> {
    let missing = |reason| Error::Missing {
        target: "backlash",
        reason,
    };
    let gap = model.backlash.ok_or(missing(
        "the model has no backlash, for no gap stands out of its log: measure it with a dial gauge and write into the model file [backlash] \
         and below it width = WIDTH, in m or rad",
    ))?;
    match gap.interval {
        Some([low, _]) if low <= 0.0 => Err(missing(
            "the interval of the backlash reaches 0: measure its width with a dial gauge and write it into the model file, without ci95",
        )),
        _ => Ok(gap),
    }
}

/// Correction of the motor's position moving forward and back, at both ends of the range; lengths in `factor` parts of m or rad.
fn correction(gap: &Backlash, model: &Model, factor: f64) -> Map<2> {
    // The same everywhere, so that the ends may be any.
    let [low, high] = gap.range.unwrap_or(match model.rotary {
        true => [-TAU, TAU],
        false => [-1.0, 1.0],
    });
    let half = 0.5 * factor * gap.width;
    Map::along(factor * low, factor * high, 2, |_| [half, -half])
}

/// Elements of an array in Structured Text: what is added to the actual position of an axis moving back, if that of one moving forward
/// is taken as it is. The motor stands behind the load then: its position is too low by the gap.
fn elements(map: &Map<2>) -> String {
    let element = |(place, [forward, back]): (f64, &[f64; 2])| {
        let (place, more) = (place.st(), (forward - back).st());
        format!("        (Position := {place}, Compensation := {more})")
    };
    map.rows().map(element).collect::<Vec<_>>().join(",\n")
}
