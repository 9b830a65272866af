//! The compensator as code.

use crate::error::{Refusal, raised};
use crate::options::unknown;
use pyo3::prelude::*;
use std::path::PathBuf;
use stiction::{ExportOptions, Feedforward, Target};

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
        let parts = self.feedforward.iter().map(String::as_str);
        options.feedforward = Feedforward::from_names(parts).map_err(Refused::Option)?;
        Ok(options)
    }
}

enum Refused {
    Name(Refusal),
    Option(stiction::Error),
}

/// Writes a model (the text of a model file, or the path of one) as code into a folder; what was written, as JSON.
#[pyfunction]
pub fn export(
    py: Python<'_>,
    model: &str,
    file: Option<PathBuf>,
    options: Asked,
    out: PathBuf,
    force: bool,
) -> PyResult<String> {
    let options = options.options().map_err(|refused| match refused {
        Refused::Name(refusal) => refusal.raise(py),
        Refused::Option(error) => raised(py, &error),
    })?;
    let exported = py.detach(|| {
        let exported = match &file {
            Some(file) => stiction::export_file(file, &options)?,
            None => stiction::export(&stiction::ModelFile::parse(model)?, &options)?,
        };
        exported.write(&out, force)?;
        Ok(exported)
    });
    let exported = exported.map_err(|e: stiction::Error| raised(py, &e))?;
    Ok(serde_json::to_string(&exported).expect("plain data"))
}
