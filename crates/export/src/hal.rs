//! LinuxCNC: a HAL component, with the C text inside, and a self-test that runs in a HAL thread.

use crate::identifier::shortened;
use crate::number::Literal;
use crate::template::Fill;
use crate::terms::{self, Extra};
use crate::vectors::{DOUBLE_TOLERANCE, Vectors};
use crate::{Error, File, Model, c, header, law};

const COMPONENT: &str = include_str!("../templates/hal/component.comp.in");
const SELFTEST: &str = include_str!("../templates/hal/selftest.py.in");

/// Most characters of the first part of a component's name: with `_friction`, the number of the instance and the longest parameter,
/// `tmax-increased`, it stays within 47 characters (`HAL_NAME_LEN` of hal.h), and the component within 31
/// (`RTAPI_NAME_LEN` of rtapi.h).
const MAX_NAME_LENGTH: usize = 20;

/// Name of the component.
pub(crate) fn component(model: &Model) -> String {
    let name = model.identifier.to_ascii_lowercase();
    format!("{}_friction", shortened(&name, MAX_NAME_LENGTH))
}

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let vectors = Vectors::<f64>::new(model, "double")?;
    let compensator = model.compensator::<f64>(&model.settings, "double")?;
    let component = component(model);
    let mut fill = Fill::default();
    fill.set("name", model.identifier.clone())
        .set("component", component.clone())
        .set("pins", component.replace('_', "-"))
        .set("version", model.provenance.version.clone())
        .set("law", c::inside(model)?)
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        .set("f_unit", model.force_unit())
        .set("a_unit", model.acceleration_unit())
        .set(
            "drive_pins",
            match model.settings.adaptation {
                Some(_) => ", *pins->drive_force, *pins->learn",
                None => "",
            },
        );
    law::fill(&mut fill, compensator.friction(), f64::c);
    let terms = compensator.terms().copied().unwrap_or_default();
    terms::fill(&mut fill, &terms, &c::syntax::<f64>(&c::DOUBLE));
    let extras = Extra::of(&terms);
    let pins = extras.iter().map(|extra| match extra {
        Extra::Acceleration | Extra::Position => format!(", *pins->{} / pins->units", pin(*extra)),
        Extra::Load | Extra::Temperature | Extra::Transmitted => {
            format!(", *pins->{}", pin(*extra))
        }
    });
    let first = 3 + 2 * usize::from(model.settings.adaptation.is_some());
    let nets = extras.iter().zip(first..).map(|(extra, k)| {
        let (net, own) = (pin(*extra), component.replace('_', "-"));
        format!("net {net} streamer.0.pin.{k} => {own}.0.{net}\n")
    });
    fill.set("load_unit", model.load_unit())
        .set("extra_pins", pins.collect::<String>())
        .set("extra_cfg", "f".repeat(extras.len()))
        .set("extra_nets", nets.collect::<String>());
    let mut test = fill.clone();
    law::settings(&mut fill, compensator.settings(), f64::c);
    law::settings(&mut test, &vectors.settings, f64::c);
    let period = libm::round(model.settings.cycle_time * 1e9);
    test.set("header", header::comment(model, "# "))
        .set("period", format!("{period:.0}"))
        .set("rows", vectors.python())
        .set("tolerance", (DOUBLE_TOLERANCE * vectors.scale(model)).c());
    let text = fill
        .set("header", header::comment(model, ""))
        .render(COMPONENT);
    Ok(vec![
        File::text(format!("{component}.comp"), text),
        File::text(format!("{component}_selftest.py"), test.render(SELFTEST)),
    ])
}

/// The pin of what comes in: a shorter name than elsewhere, for those of HAL end after 47 characters.
fn pin(extra: Extra) -> &'static str {
    match extra {
        Extra::Acceleration => "acceleration",
        Extra::Position | Extra::Load | Extra::Temperature | Extra::Transmitted => extra.name(),
    }
}
