//! Modelica: the law as a differential equation, and as friction between two flanges of the standard library, for simulation.

use crate::number::Literal;
use crate::template::Fill;
use crate::{Error, File, Model, header, law};
use stiction_friction::compensator::Friction;

const PACKAGE: &str = include_str!("../templates/modelica/package.mo.in");

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    if model.friction.bristle().is_none() {
        return Err(Error::Law {
            target: "modelica",
            law: model.law().into(),
            allowed: "dahl, lugre and elasto-plastic, whose bristles make a differential equation; the target fmu has every law",
        });
    }
    if !model.in_newtons() {
        return Err(Error::ForceUnit {
            target: "modelica",
            found: model.force_unit().into(),
            allowed: if model.rotary { "N m" } else { "N" },
        });
    }
    let compensator = model.compensator::<f64>(&model.settings, "double")?;
    let friction: &Friction<f64> = compensator.friction();
    let mut fill = Fill::default();
    law::fill(&mut fill, friction, f64::c);
    let length = friction.presliding().unwrap_or(1.0);
    fill.set("header", header::table_comment(model, "// "))
        .set("name", model.identifier.clone())
        .set("nominal", crate::number::short(length).c())
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        // As the standard library spells it.
        .set("f_unit", model.force_unit().replace(' ', "."))
        .flag("linear", !model.rotary);
    let name = format!("{}_friction.mo", model.identifier);
    Ok(vec![File::text(name, fill.render(PACKAGE))])
}
