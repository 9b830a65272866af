//! IEC 61131-3 Structured Text: a function block and a test program, in LREAL and in REAL; the text itself, or wrapped
//! in the files of TwinCAT and PLCopen.

mod plcopen;
mod twincat;
mod unit;

use crate::model::cast;
use crate::number::Literal;
use crate::template::Fill;
use crate::terms::{self, Extra, Syntax};
use crate::vectors::{DOUBLE_TOLERANCE, SINGLE_TOLERANCE, Vectors};
use crate::{Error, File, Model, header, law};
use stiction_friction::compensator::{Friction, Settings};
use unit::Unit;

const DECLARATION: &str = include_str!("../templates/st/block.declaration.in");
const BODY: &str = include_str!("../templates/st/block.body.in");
const ELEMENT: &str = include_str!("../templates/st/law/element.body.in");
const TEST_DECLARATION: &str = include_str!("../templates/st/test.declaration.in");
const TEST_BODY: &str = include_str!("../templates/st/test.body.in");

/// A number type of IEC 61131-3.
struct Precision {
    suffix: &'static str,
    real: &'static str,
    /// Largest velocity and tracking error that are accepted: no product of them overflows.
    huge: &'static str,
    /// Arguments from which on exp(-x^2), exp(-x) and exp(-exp(x)) are 0 to rounding.
    ends: [&'static str; 3],
    /// Terms of the series of exp(-a) - 1, used below a = 0.3, that make it exact to rounding.
    terms: u32,
    /// Largest error of the self-test, relative to [`Vectors::scale`].
    tolerance: f64,
}

const LREAL: Precision = Precision {
    suffix: "",
    real: "LREAL",
    huge: "1.0E15",
    ends: ["26.0", "700.0", "6.5"],
    terms: 13,
    tolerance: DOUBLE_TOLERANCE,
};

const REAL: Precision = Precision {
    suffix: "_R",
    real: "REAL",
    huge: "1.0E12",
    ends: ["9.0", "87.0", "4.4"],
    terms: 7,
    tolerance: SINGLE_TOLERANCE,
};

/// A slew limit that limits nothing, f_unit/s: compilers refuse what single precision has no number for, also where it
/// stands for an LREAL.
const NO_SLEW_LIMIT: f64 = 1e30;

/// Plain text, one file per unit.
pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let units = units(model)?;
    Ok(units
        .iter()
        .map(|unit| File::text(format!("{}.st", unit.name), unit.text()))
        .collect())
}

/// TwinCAT 3, one file per unit.
pub(crate) fn twincat(model: &Model) -> Result<Vec<File>, Error> {
    Ok(units(model)?.iter().map(twincat::file).collect())
}

/// PLCopen TC6 XML, one file.
pub(crate) fn plcopen(model: &Model) -> Result<Vec<File>, Error> {
    let text = plcopen::project(model, &units(model)?);
    Ok(vec![File::text(
        format!("{}_friction.xml", model.identifier),
        text,
    )])
}

fn units(model: &Model) -> Result<Vec<Unit>, Error> {
    let mut units = Vec::new();
    units.extend(precision::<f64>(model, &LREAL)?);
    units.extend(precision::<f32>(model, &REAL)?);
    Ok(units)
}

fn precision<T: Literal>(model: &Model, precision: &Precision) -> Result<[Unit; 2], Error> {
    let vectors = Vectors::<T>::new(model, precision.real)?;
    let compensator = model.compensator::<T>(&model.settings, precision.real)?;
    let mut fill = Fill::default();
    fill.set("header", header::comment(model, ""))
        .set("name", model.identifier.clone())
        .set("suffix", precision.suffix)
        .set("REAL", precision.real)
        .set("huge", precision.huge)
        .set("gaussian_end", precision.ends[0])
        .set("exp_end", precision.ends[1])
        .set("power_end", precision.ends[2])
        .set("series", series(precision.terms))
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        .set("f_unit", model.force_unit())
        .set("a_unit", model.acceleration_unit())
        .set("key", compensator.key().to_string());
    law::fill(&mut fill, compensator.friction(), T::st);
    elements(&mut fill, compensator.friction());
    let syntax = Syntax {
        number: T::st,
        functions: ["SIN", "COS"],
        places: ["seen_position", "place"],
        choose: |forward, back| {
            format!(
                "        IF dry_part > 0.0 THEN\n            level_factor := level_factor + {forward};\n        ELSE\n            \
                 level_factor := level_factor + {back};\n        END_IF;"
            )
        },
    };
    let terms = compensator.terms().copied().unwrap_or_default();
    terms::fill(&mut fill, &terms, &syntax);
    fill.set("load_unit", model.load_unit());
    let mut test = fill.clone();
    law::settings(&mut fill, &writable(compensator.settings()), T::st);
    law::settings(&mut test, &writable(&cast(&vectors.settings)), T::st);
    let tolerance = T::from_f64(precision.tolerance * vectors.scale(model));
    let adapting = vectors.settings.adaptation.map_or(String::new(), |a| {
        let [memory, mass] = [a.memory, a.mass].map(|x| T::from_f64(x).st());
        format!(
            ",\n            drive_force := u, learn := wanted_too, memory := {memory}, moving_mass := {mass}"
        )
    });
    let extras = Extra::of(&terms);
    let inputs = extras
        .iter()
        .map(|extra| format!(",\n            {} := {}", extra.name(), variable(*extra)));
    test.set("extra_inputs", inputs.collect::<String>());
    test.set("rows", rows(&vectors, &extras))
        .set("adapt_inputs", adapting)
        .set("count", vectors.rows.len().to_string())
        .set("tolerance", tolerance.st());
    let (name, suffix) = (&model.identifier, precision.suffix);
    Ok([
        Unit {
            name: format!("FB_{name}_Friction{suffix}"),
            program: false,
            declaration: fill.render(DECLARATION),
            body: fill.render(BODY),
        },
        Unit {
            name: format!("PRG_{name}_FrictionTest{suffix}"),
            program: true,
            declaration: test.render(TEST_DECLARATION),
            body: test.render(TEST_BODY),
        },
    ])
}

/// The Maxwell-slip elements of a law that has them, each written out: not every compiler has arrays and loops.
fn elements<T: Literal>(fill: &mut Fill, friction: &Friction<T>) {
    let real = fill.value("REAL").to_string();
    let (force, length) = (
        fill.value("f_unit").to_string(),
        fill.value("x_unit").to_string(),
    );
    let steps = law::element_lines(friction, |k, _| {
        let text = fill.clone().set("k", (k + 1).to_string()).render(ELEMENT);
        text.trim_end().to_string()
    });
    let lines = |line: &dyn Fn(usize, T, T) -> String| {
        law::element_lines(friction, |k, e| line(k + 1, e.stiffness, e.share))
    };
    let parameters = lines(&|k, stiffness, share| {
        let (stiffness, share) = (stiffness.st(), share.st());
        format!(
            "    stiffness_{k} : {real} := {stiffness}; (* of a Maxwell-slip element > 0, {force}/{length} *)\n    \
             share_{k} : {real} := {share}; (* of the level that it takes > 0; the sum is 1 *)"
        )
    });
    let states = lines(&|k, _, _| {
        format!(
            "    element_{k} : {real} := 0.0; (* force of an element, {force} *)\n    \
             slips_{k} : BOOL := FALSE; (* it slips, else it sticks *)"
        )
    });
    let ranges = lines(&|k, _, _| {
        format!(
            "    AND (stiffness_{k} >= 1.0E-9) AND (stiffness_{k} <= 1.0E15) AND (share_{k} >= 1.0E-9) AND (share_{k} <= 1.0)"
        )
    });
    let resets = lines(&|k, _, _| format!("    element_{k} := 0.0;\n    slips_{k} := FALSE;"));
    let yields =
        lines(&|k, _, _| format!("        slide := MAX(slide, share_{k} * most / stiffness_{k});"));
    fill.set("element_steps", steps)
        .set("element_parameters", parameters)
        .set("element_states", states)
        .set("element_ranges", ranges)
        .set("element_resets", resets)
        .set("element_yields", yields);
}

/// The settings as they can be written.
fn writable<T: Literal>(settings: &Settings<T>) -> Settings<T> {
    Settings {
        slew: settings.slew.min(T::from_f64(NO_SLEW_LIMIT)),
        ..*settings
    }
}

/// `exp(-a) - 1 = -a (1 - a/2 (1 - a/3 (...)))`, innermost first.
fn series(terms: u32) -> String {
    let mut lines = vec![format!("    e := 1.0 - a / {terms}.0;")];
    lines.extend(
        (2..terms)
            .rev()
            .map(|k| format!("    e := 1.0 - a / {k}.0 * e;")),
    );
    lines.push("    e := -a * e;".into());
    lines.join("\n")
}

/// Its variable in the test program.
fn variable(extra: Extra) -> &'static str {
    match extra {
        Extra::Acceleration => "a",
        Extra::Position => "place",
        Extra::Load => "load",
        Extra::Temperature => "temperature",
        Extra::Transmitted => "transmitted",
    }
}

fn rows<T: Literal>(vectors: &Vectors<T>, extras: &[Extra]) -> String {
    let rows: Vec<String> = vectors
        .rows
        .iter()
        .enumerate()
        .map(|(i, row)| {
            let (v, x, force) = (row.velocity.st(), row.error.st(), row.force.st());
            let truth = |x| if x { "TRUE" } else { "FALSE" };
            let drive = row.drive.map(|(u, learn)| {
                let (u, learn) = (u.st(), truth(learn));
                format!("u := {u}; wanted_too := {learn}; ")
            });
            let (on, drive) = (truth(row.enable), drive.unwrap_or_default());
            let each = extras.iter().zip(&row.extras);
            let beside: String = each
                .map(|(extra, x)| format!("{} := {}; ", variable(*extra), x.st()))
                .collect();
            format!("    {i}: v := {v}; x := {x}; wanted := {on}; {drive}{beside}due := {force};")
        })
        .collect();
    rows.join("\n")
}
