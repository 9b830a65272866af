//! Functional Mock-up Units for co-simulation, FMI 2.0 and 3.0: the C text behind the interface of the standard, with a
//! binary for each platform that a compiler is available for.
//!
//! Standards: FMI 2.0.4 and FMI 3.0.1, Modelica Association, fmi-standard.org.

mod archive;
mod description;
mod platform;
mod unit;
mod variables;
mod version;

use crate::guid::guid;
use crate::number::Literal;
use crate::template::Fill;
use crate::terms::{self, Extra};
use crate::vectors::{DOUBLE_TOLERANCE, Vectors};
use crate::{Error, File, Model, c, check, header, law};
pub use platform::Platform;
use variables::Variables;
use version::{Version, escape};

const CORE: &str = include_str!("../templates/fmu/core.c.in");
const FMI2: &str = include_str!("../templates/fmu/fmi2.c.in");
const FMI3: &str = include_str!("../templates/fmu/fmi3.c.in");
const SELFTEST: &str = include_str!("../templates/fmu/selftest.py.in");
const PAGE: &str = include_str!("../templates/fmu/index.html.in");

/// The FMUs of a model and their self-test. `compile` gives the shared library of a C source for a platform
/// ([`Platform::arguments`]), or nothing where there is no compiler for it: there a tool has to compile the source.
///
/// # Errors
/// As [`export`](crate::export).
pub fn fmu(
    model: &Model,
    compile: &mut dyn FnMut(&File, Platform) -> Option<Vec<u8>>,
) -> Result<Vec<File>, Error> {
    check::check(model, "double")?;
    let vectors = Vectors::<f64>::new(model, "double")?;
    let component = format!("{}_friction", model.identifier.to_ascii_lowercase());
    let compensator = model.compensator::<f64>(&model.settings, "double")?;
    let variables = Variables::of(&compensator);
    let mut fill = Fill::default();
    fill.set("name", model.identifier.clone())
        .set("component", component.clone())
        .set("law", c::inside(model)?)
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        .set("f_unit", model.force_unit())
        .set("a_unit", model.acceleration_unit())
        .set("load_unit", model.load_unit());
    let terms = compensator.terms().copied().unwrap_or_default();
    terms::fill(&mut fill, &terms, &c::syntax::<f64>(&c::DOUBLE));
    let extras = Extra::of(&terms);
    let each = |text: &dyn Fn(&str) -> String| -> String {
        extras.iter().map(|extra| text(extra.name())).collect()
    };
    fill.set("extra_data", each(&|name| format!(", d->{name}")))
        .set("extra_values", each(&|name| format!(", {name}")))
        .set("extra_keys", each(&|name| format!(", \"{name}\"")));
    variables.fill(&mut fill);
    let mut files = Vec::new();
    for (version, interface) in [(Version::Two, FMI2), (Version::Three, FMI3)] {
        let mut own = fill.clone();
        law::settings(&mut own, compensator.settings(), f64::c);
        // A hash of the text without the token itself, so that no two models share it.
        let token = guid(&format!(
            "{}{}{interface}",
            version.number(),
            own_text(model)?
        ));
        own.set("token", token.clone())
            .set("version", version.number())
            .set("header", header::comment(model, " * "));
        let text = format!("{}{interface}", own.render(CORE));
        let source = File::text(format!("sources/{component}.c"), text);
        let page = own
            .set("header", escape(&header::comment(model, "")))
            .render(PAGE);
        let mut parts = vec![File::text(
            "modelDescription.xml",
            description::xml(model, version, &component, &token, &variables),
        )];
        for platform in Platform::ALL {
            let Some(folder) = version.folder(platform) else {
                continue;
            };
            if let Some(bytes) = compile(&source, platform) {
                let path = format!("binaries/{folder}/{component}.{}", platform.extension());
                parts.push(File { path, bytes });
            }
        }
        parts.push(File::text("documentation/index.html", page));
        parts.push(source);
        if version == Version::Three {
            let build = description::build(&component);
            parts.push(File::text("sources/buildDescription.xml", build));
        }
        files.push(File {
            path: format!("{component}_fmi{}.fmu", version.number()),
            bytes: archive::zip(&parts)?,
        });
    }
    let mut test = fill;
    law::settings(&mut test, &vectors.settings, f64::c);
    test.set("header", header::comment(model, "# "))
        .set("rows", vectors.python())
        .set("tolerance", (DOUBLE_TOLERANCE * vectors.scale(model)).c());
    files.push(File::text(
        format!("{component}_selftest.py"),
        test.render(SELFTEST),
    ));
    Ok(files)
}

/// The text that distinguishes the FMU of one model from that of another.
fn own_text(model: &Model) -> Result<String, Error> {
    Ok(format!(
        "{}{}",
        header::comment(model, ""),
        c::inside(model)?
    ))
}
