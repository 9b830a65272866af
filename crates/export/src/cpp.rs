//! C++11: a header-only library around the text of C, in the layout of Arduino and PlatformIO, with its self-test.

use crate::c::{self, DOUBLE, FLOAT, Precision};
use crate::model::cast;
use crate::number::Literal;
use crate::template::Fill;
use crate::vectors::Vectors;
use crate::{Error, File, Model, law};

const PRECISION: &str = include_str!("../templates/cpp/precision.hpp.in");
const LIBRARY: &str = include_str!("../templates/cpp/library.hpp.in");
const PROPERTIES: &str = include_str!("../templates/cpp/library.properties.in");
const JSON: &str = include_str!("../templates/cpp/library.json.in");
const SAMPLES: &str = include_str!("../templates/cpp/selftest.h.in");
const SKETCH: &str = include_str!("../templates/cpp/selftest.ino.in");
const SELFTEST: &str = include_str!("../templates/cpp/selftest.cpp.in");
const AXIS: &str = include_str!("../templates/cpp/axis.ino.in");

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let mut files = header(model)?;
    files.push(File::text(
        "examples/SelfTest/selftest_f32.h",
        samples::<f32>(model, &FLOAT)?,
    ));
    files.push(File::text(
        "examples/SelfTest/selftest_f64.h",
        samples::<f64>(model, &DOUBLE)?,
    ));
    let mut fill = common::<f64>(model, &DOUBLE)?;
    let period = libm::round(model.settings.cycle_time * 1e6);
    fill.set("cycle_us", format!("{period:.0}"));
    for (path, template) in [
        ("examples/SelfTest/SelfTest.ino", SKETCH),
        ("examples/Axis/Axis.ino", AXIS),
        ("library.json", JSON),
    ] {
        files.push(File::text(path, fill.render(template)));
    }
    files.push(File::text(
        "extras/selftest.cpp",
        selftest(
            fill,
            "src",
            "extras/selftest.cpp",
            "../examples/SelfTest/",
            true,
        ),
    ));
    let mut properties = common::<f64>(model, &DOUBLE)?;
    properties.set("header", crate::header::comment(model, "# "));
    files.push(File::text(
        "library.properties",
        properties.render(PROPERTIES),
    ));
    Ok(files)
}

/// The headers: what includes all of them, and one for each precision.
fn header(model: &Model) -> Result<Vec<File>, Error> {
    let name = format!("src/{}_friction", model.identifier);
    let library = common::<f64>(model, &DOUBLE)?.render(LIBRARY);
    Ok(vec![
        File::text(format!("{name}.hpp"), library),
        File::text(format!("{name}_f32.hpp"), precision::<f32>(model, &FLOAT)?),
        File::text(format!("{name}_f64.hpp"), precision::<f64>(model, &DOUBLE)?),
    ])
}

/// The header of a precision, with the text of C inside.
pub(crate) fn precision<T: Literal>(model: &Model, precision: &Precision) -> Result<String, Error> {
    let mut fill = common::<T>(model, precision)?;
    fill.set("law", c::inline::<T>(model, precision)?);
    Ok(fill.render(PRECISION))
}

/// The samples of the self-test with the function that runs them.
pub(crate) fn samples<T: Literal>(model: &Model, precision: &Precision) -> Result<String, Error> {
    let vectors = Vectors::<T>::new(model, precision.real)?;
    let mut fill = common::<T>(model, precision)?;
    law::settings::<T>(&mut fill, &cast(&vectors.settings), T::c);
    let tolerance = precision.tolerance * vectors.scale(model);
    fill.set("rows", c::rows(&vectors))
        .set("tolerance", T::from_f64(tolerance).c());
    Ok(fill.render(SAMPLES))
}

/// The program of the self-test, with the folders of the headers and of the samples; in double precision, and where asked in single.
pub(crate) fn selftest(
    mut fill: Fill,
    include: &str,
    path: &str,
    samples: &str,
    single: bool,
) -> String {
    fill.set("include", include)
        .set("test", path)
        .set("samples", samples)
        .flag("single", single);
    fill.render(SELFTEST)
}

/// The values of the C target, with names of files that both precisions share.
pub(crate) fn common<T: Literal>(model: &Model, precision: &Precision) -> Result<Fill, Error> {
    let mut fill = c::fill::<T>(model, precision)?;
    let library = format!("{}_friction", model.identifier);
    fill.set("file", library.clone())
        .set("library", library)
        .set("NAME", model.identifier.to_ascii_uppercase())
        .set("bits", bits(precision))
        .set("BITS", bits(precision).to_ascii_uppercase())
        .set(
            "words",
            if precision.real == DOUBLE.real {
                "double"
            } else {
                "single"
            },
        )
        .flag("double", precision.real == DOUBLE.real)
        .set("version", env!("CARGO_PKG_VERSION"))
        .set("sha256", model.provenance.model_sha256.clone())
        .set("url", env!("CARGO_PKG_REPOSITORY"));
    Ok(fill)
}

/// The name of a precision in C++, after its size in bits.
fn bits(precision: &Precision) -> &'static str {
    if precision.real == DOUBLE.real {
        "f64"
    } else {
        "f32"
    }
}
