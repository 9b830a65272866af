//! ROS 2: the C++ header in double precision, a class whose settings are parameters of a node, their file, and a self-test.

use crate::c::DOUBLE;
use crate::number::Literal;
use crate::{Error, File, Model, cpp, header, law};

const CLASS: &str = include_str!("../templates/ros2/friction.hpp.in");
const PARAMETERS: &str = include_str!("../templates/ros2/friction.yaml.in");

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let fill = cpp::common::<f64>(model, &DOUBLE)?;
    let mut yaml = fill.clone();
    let compensator = model.compensator::<f64>(&model.settings, DOUBLE.real)?;
    law::settings(&mut yaml, compensator.settings(), f64::yaml);
    yaml.set("header", header::comment(model, "# "));
    let name = format!("{}_friction", model.identifier);
    Ok(vec![
        File::text(format!("include/{name}_ros2.hpp"), fill.render(CLASS)),
        File::text(
            format!("include/{name}_f64.hpp"),
            cpp::precision::<f64>(model, &DOUBLE)?,
        ),
        File::text(format!("config/{name}.yaml"), yaml.render(PARAMETERS)),
        File::text("test/selftest_f64.h", cpp::samples::<f64>(model, &DOUBLE)?),
        File::text(
            "test/selftest.cpp",
            cpp::selftest(fill, "include", "test/selftest.cpp", "", false),
        ),
    ])
}
