//! MATLAB and Octave: functions of plain MATLAB with their self-test, and the text of C as an S-function of Simulink.

mod ports;

use crate::c::{self, DOUBLE};
use crate::number::Literal;
use crate::terms::{self, Extra, Syntax};
use crate::vectors::{DOUBLE_TOLERANCE, Vectors};
use crate::{Error, File, Model, header, law};

const PARAMS: &str = include_str!("../templates/matlab/params.m.in");
const INIT: &str = include_str!("../templates/matlab/init.m.in");
const RESET: &str = include_str!("../templates/matlab/reset.m.in");
const STEP: &str = include_str!("../templates/matlab/step.m.in");
const MEMORY: &str = include_str!("../templates/matlab/memory.m.in");
const RECALL: &str = include_str!("../templates/matlab/recall.m.in");
const SELFTEST: &str = include_str!("../templates/matlab/selftest.m.in");
const BLOCK: &str = include_str!("../templates/matlab/block.m.in");
const SFUN: &str = include_str!("../templates/matlab/sfun.c.in");

/// What a file has before `_friction`: the functions have the names of those of C.
const FUNCTIONS: [(&str, &str); 6] = [
    ("params", PARAMS),
    ("init", INIT),
    ("step", STEP),
    ("reset", RESET),
    ("memory", MEMORY),
    ("recall", RECALL),
];

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let name = &model.identifier;
    let vectors = Vectors::<f64>::new(model, "double")?;
    let compensator = model.compensator::<f64>(&model.settings, "double")?;
    let terms = compensator.terms().copied().unwrap_or_default();
    let mut fill = c::fill::<f64>(model, &DOUBLE)?;
    let [stiffness, share] = elements(model);
    fill.set("element_stiffness", stiffness)
        .set("element_share", share)
        .set("header", header::comment(model, "% "));
    terms::fill(&mut fill, &terms, &syntax());
    let extras = Extra::of(&terms);
    let adapts = model.settings.adaptation.is_some();
    let first = if adapts { 6 } else { 4 };
    let rows: Vec<String> = extras
        .iter()
        .enumerate()
        .map(|(k, extra)| format!("input.{} = row({});", extra.name(), first + k))
        .collect();
    fill.flag("extras", !extras.is_empty())
        .set("extra_rows", rows.join("\n"));
    let mut files: Vec<File> = FUNCTIONS
        .iter()
        .map(|(function, template)| {
            File::text(format!("{name}_{function}.m"), fill.render(template))
        })
        .collect();
    let file = format!("{name}_friction");
    let mut test = fill.clone();
    law::settings(&mut test, &vectors.settings, f64::c);
    test.set("rows", vectors.matrix())
        .set("tolerance", (DOUBLE_TOLERANCE * vectors.scale(model)).c());
    files.push(File::text(
        format!("{file}_selftest.m"),
        test.render(SELFTEST),
    ));
    files.extend(c::double(model)?);
    ports::fill(&mut fill, model, &terms);
    files.push(File::text(format!("{file}_block.m"), fill.render(BLOCK)));
    fill.set("header", header::comment(model, " * "));
    files.push(File::text(format!("{file}_sfun.c"), fill.render(SFUN)));
    Ok(files)
}

/// Stiffness and share of the elements, as lists.
fn elements(model: &Model) -> [String; 2] {
    let elements = law::elements(&model.friction);
    let list = |of: &dyn Fn(usize) -> f64| {
        let each: Vec<String> = (0..elements.len()).map(|k| of(k).c()).collect();
        each.join(", ")
    };
    [
        list(&|k| elements[k].stiffness),
        list(&|k| elements[k].share),
    ]
}

/// How MATLAB writes what friction depends on.
fn syntax() -> Syntax<f64> {
    Syntax {
        number: f64::c,
        functions: ["sin", "cos"],
        places: ["s.seen_position", "x"],
        choose: |forward, back| {
            format!(
                "if forward\n    factor = factor + {forward};\nelse\n    factor = factor + {back};\nend"
            )
        },
    }
}
