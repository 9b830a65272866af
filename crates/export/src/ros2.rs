//! ROS 2: the C++ header in double precision, a class whose settings are parameters of a node, their file, and a self-test.

use crate::c::DOUBLE;
use crate::number::Literal;
use crate::template::Fill;
use crate::{Error, File, Model, cpp, header, law};

const CLASS: &str = include_str!("../templates/ros2/friction.hpp.in");
const PARAMETERS: &str = include_str!("../templates/ros2/friction.yaml.in");

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let mut files = classes(model, "test")?;
    let mut yaml = values(model)?;
    yaml.set("header", header::comment(model, "# "));
    let path = format!("config/{}_friction.yaml", model.identifier);
    files.insert(2, File::text(path, yaml.render(PARAMETERS)));
    Ok(files)
}

/// The headers, and their self-test in a folder.
pub(crate) fn classes(model: &Model, test: &str) -> Result<Vec<File>, Error> {
    let fill = cpp::common::<f64>(model, &DOUBLE)?;
    let name = format!("{}_friction", model.identifier);
    let program = format!("{test}/selftest.cpp");
    Ok(vec![
        File::text(format!("include/{name}_ros2.hpp"), fill.render(CLASS)),
        File::text(
            format!("include/{name}_f64.hpp"),
            cpp::precision::<f64>(model, &DOUBLE)?,
        ),
        File::text(
            format!("{test}/selftest_f64.h"),
            cpp::samples::<f64>(model, &DOUBLE)?,
        ),
        File::text(
            program.clone(),
            cpp::selftest(fill, "include", &program, "", false),
        ),
    ])
}

/// The parameters of a node, as part of its file.
pub(crate) fn parameters(model: &Model) -> Result<String, Error> {
    Ok(values(model)?.render("    %part ros2/parameters.yaml.in\n"))
}

fn values(model: &Model) -> Result<Fill, Error> {
    let mut fill = cpp::common::<f64>(model, &DOUBLE)?;
    let compensator = model.compensator::<f64>(&model.settings, DOUBLE.real)?;
    law::settings(&mut fill, compensator.settings(), f64::yaml);
    Ok(fill)
}
