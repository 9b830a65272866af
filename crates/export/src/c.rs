//! C99: a header, a source and a self-test, in double and in single precision.

use crate::model::cast;
use crate::number::Literal;
use crate::template::Fill;
use crate::terms::{self, Syntax};
use crate::vectors::{DOUBLE_TOLERANCE, SINGLE_TOLERANCE, Vectors};
use crate::{Error, File, Model, header, law};
use sha2::{Digest, Sha256};

const HEADER: &str = include_str!("../templates/c/compensator.h.in");
const SOURCE: &str = include_str!("../templates/c/compensator.c.in");
const SELFTEST: &str = include_str!("../templates/c/selftest.c.in");

/// A number type of C.
pub(crate) struct Precision {
    /// What is appended to the model's identifier.
    pub(crate) suffix: &'static str,
    pub(crate) real: &'static str,
    /// Suffix of a number.
    pub(crate) literal: &'static str,
    /// Suffix of a function of `math.h`.
    pub(crate) function: &'static str,
    pub(crate) max: &'static str,
    /// Largest error of the self-test, relative to [`Vectors::scale`].
    pub(crate) tolerance: f64,
}

pub(crate) const DOUBLE: Precision = Precision {
    suffix: "",
    real: "double",
    literal: "",
    function: "",
    max: "DBL_MAX",
    tolerance: DOUBLE_TOLERANCE,
};

pub(crate) const FLOAT: Precision = Precision {
    suffix: "_f32",
    real: "float",
    literal: "f",
    function: "f",
    max: "FLT_MAX",
    tolerance: SINGLE_TOLERANCE,
};

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let mut files = precision::<f64>(model, &DOUBLE)?;
    files.extend(precision::<f32>(model, &FLOAT)?);
    Ok(files)
}

fn precision<T: Literal>(model: &Model, precision: &Precision) -> Result<Vec<File>, Error> {
    let vectors = Vectors::<T>::new(model, precision.real)?;
    let fill = fill::<T>(model, precision)?;
    let file = format!("{}_friction{}", model.identifier, precision.suffix);
    let mut test = fill.clone();
    law::settings::<T>(&mut test, &cast(&vectors.settings), T::c);
    let tolerance = precision.tolerance * vectors.scale(model);
    test.set("rows", rows(&vectors))
        .set("tolerance", T::from_f64(tolerance).c());
    Ok(vec![
        File::text(format!("{file}.h"), fill.render(HEADER)),
        File::text(format!("{file}.c"), fill.render(SOURCE)),
        File::text(format!("{file}_selftest.c"), test.render(SELFTEST)),
    ])
}

/// Header and source in double precision.
pub(crate) fn double(model: &Model) -> Result<Vec<File>, Error> {
    let mut files = precision::<f64>(model, &DOUBLE)?;
    files.truncate(2);
    Ok(files)
}

/// The text of the header and the source in double precision, for a file that holds both.
pub(crate) fn inside(model: &Model) -> Result<String, Error> {
    let mut fill = fill::<f64>(model, &DOUBLE)?;
    fill.flag("apart", false);
    Ok(joined(&fill))
}

/// The same for a header in C++, in a namespace: functions inline, and what it includes left to the file around it.
pub(crate) fn inline<T: Literal>(model: &Model, precision: &Precision) -> Result<String, Error> {
    let mut fill = fill::<T>(model, precision)?;
    fill.flag("apart", false)
        .flag("includes", false)
        .set("own", "inline")
        .set("shared", "inline ");
    Ok(joined(&fill))
}

fn joined(fill: &Fill) -> String {
    format!("{}\n{}", fill.render(HEADER), fill.render(SOURCE))
}

pub(crate) fn rows<T: Literal>(vectors: &Vectors<T>) -> String {
    let rows: Vec<String> = vectors
        .rows
        .iter()
        .map(|row| {
            let (v, e, f) = (row.velocity.c(), row.error.c(), row.force.c());
            let drive = row.drive.map(|(u, learn)| format!(", {}, {learn}", u.c()));
            let drive = drive.unwrap_or_default();
            let extras: String = row.extras.iter().map(|x| format!(", {}", x.c())).collect();
            format!(
                "    {{ {{ {v}, {e}, {}{drive}{extras} }}, {f} }}",
                row.enable
            )
        })
        .collect();
    rows.join(",\n")
}

pub(crate) fn fill<T: Literal>(model: &Model, precision: &Precision) -> Result<Fill, Error> {
    let compensator = model.compensator::<T>(&model.settings, precision.real)?;
    let name = format!("{}{}", model.identifier, precision.suffix);
    let mut fill = Fill::default();
    fill.set("header", header::comment(model, " * "))
        .set("name", name.clone())
        .set("NAME", name.to_ascii_uppercase())
        .set(
            "file",
            format!("{}_friction{}", model.identifier, precision.suffix),
        )
        .set("real", precision.real)
        .set("f", precision.literal)
        .set("m", precision.function)
        .set("MAX", precision.max)
        .flag("apart", true)
        .flag("includes", true)
        .set("own", "static")
        .set("shared", "")
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        .set("f_unit", model.force_unit())
        .set("a_unit", model.acceleration_unit())
        .set("load_unit", model.load_unit())
        .set("stamp", stamp(model))
        .set("key", T::from_f64(f64::from(compensator.key())).c());
    law::settings(&mut fill, compensator.settings(), T::c);
    law::fill(&mut fill, compensator.friction(), T::c);
    let lines = law::element_lines(compensator.friction(), |k, element| {
        let (stiffness, share) = (element.stiffness.c(), element.share.c());
        format!(
            "    params->element_stiffness[{k}] = {stiffness};\n    params->element_share[{k}] = {share};"
        )
    });
    fill.set("element_lines", lines);
    let terms = compensator.terms().copied().unwrap_or_default();
    terms::fill(&mut fill, &terms, &syntax(precision));
    Ok(fill)
}

/// A number that files of another model or other settings do not share, for the preprocessor to compare.
fn stamp(model: &Model) -> String {
    // Debug output holds every number with all of its digits.
    let hash = Sha256::digest(format!("{model:?}"));
    let number = hash
        .iter()
        .take(4)
        .fold(0, |n, byte| n << 8 | u32::from(*byte));
    format!("0x{number:08x}u")
}

/// How C writes what friction depends on.
pub(crate) fn syntax<T: Literal>(precision: &Precision) -> Syntax<T> {
    Syntax {
        number: T::c,
        functions: match precision.function {
            "" => ["sin", "cos"],
            _ => ["sinf", "cosf"],
        },
        places: ["s->seen_position", "x"],
        choose: |forward, back| format!("    factor += forward ? {forward} : {back};"),
    }
}
