//! The compensator as code.

use crate::error::{Refusal, raised, spoken};
use crate::options::unknown;
use pyo3::prelude::*;
use std::path::PathBuf;
use stiction_files::{Looks, ModelFile, looks};
use stiction_workflows::Error;
use stiction_workflows::export::{
    self as workflow, Draws, ExportOptions, Feedforward, Target, Width,
};

/// A dict with every option.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    target: String,
    name: Option<String>,
    cycle_time: f64,
    limit: Option<f64>,
    rated_force: Option<f64>,
    gain: Option<f64>,
    ramp: Option<f64>,
    dead_zone: Option<f64>,
    slew: Option<f64>,
    window: Option<f64>,
    adapt: bool,
    feedforward: Vec<String>,
    draws: Option<(usize, u64, String)>,
}

impl Asked {
    fn options(self) -> Result<ExportOptions, Refused> {
        let mut targets = Target::ALL.into_iter();
        let target = targets.find(|target| target.name() == self.target);
        let target = target.ok_or_else(|| Refused::Name(unknown("target", &self.target)))?;
        let mut options = ExportOptions::new(target, self.cycle_time);
        options.name = self.name;
        options.limit = self.limit;
        options.rated_force = self.rated_force;
        options.gain = self.gain;
        options.safety.ramp = self.ramp;
        options.safety.dead_zone = self.dead_zone;
        options.safety.slew = self.slew;
        options.safety.window = self.window;
        options.adapt = self.adapt;
        if let Some((count, seed, width)) = self.draws {
            let mut widths = Width::ALL.into_iter();
            let found = widths.find(|own| own.name() == width);
            options.draws = Some(Draws {
                count,
                seed,
                width: found.ok_or_else(|| Refused::Name(unknown("width", &width)))?,
            });
        }
        let parts = self.feedforward.iter().map(String::as_str);
        options.feedforward = Feedforward::from_names(parts).map_err(Refused::Option)?;
        Ok(options)
    }
}

enum Refused {
    Name(Refusal),
    Option(stiction_workflows::Error),
}

/// Writes a model (the text of a model file, or the path of one, or of the robot.toml of a robot) as code into a folder; what was
/// written, as JSON.
#[pyfunction]
pub fn export(
    py: Python<'_>,
    model: &str,
    file: Option<PathBuf>,
    urdf: Option<PathBuf>,
    options: Asked,
    out: PathBuf,
    force: bool,
) -> PyResult<String> {
    let options = options.options().map_err(|refused| match refused {
        Refused::Name(refusal) => refusal.raise(py),
        Refused::Option(error) => raised(py, &error),
    })?;
    let is_robot = file
        .as_deref()
        .is_some_and(|file| looks(file) == Some(Looks::Robot));
    if urdf.is_some() && !is_robot {
        let (found, allowed) = ("a URDF for the model of one axis", "that of a robot.toml");
        return Err(Refusal::argument("urdf", found, allowed).raise(py));
    }
    let exported = py.detach(|| -> Result<serde_json::Result<String>, Error> {
        if let Some(robot) = file.as_deref().filter(|_| is_robot) {
            let mut exported = workflow::export_robot_file(robot, urdf.as_deref(), &options)?;
            spoken(&mut exported.warnings);
            exported.write(&out, force)?;
            return Ok(serde_json::to_string(&exported));
        }
        let mut exported = match &file {
            Some(file) => workflow::export_file(file, &options)?,
            None => workflow::export(&ModelFile::parse(model)?, &options)?,
        };
        exported.write(&out, force)?;
        spoken(&mut exported.warnings);
        Ok(serde_json::to_string(&exported))
    });
    let exported = exported.map_err(|e| raised(py, &e))?;
    Ok(exported.expect("plain data"))
}
