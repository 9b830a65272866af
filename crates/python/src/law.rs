//! A law that is run.

use crate::error::{Refusal, raised};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use stiction::{FrictionLaw, ModelFile, SteppedLaw, forces_along};

/// A friction law with its state.
#[pyclass(module = "stiction._native")]
pub struct Law {
    law: FrictionLaw,
    stepped: SteppedLaw,
    /// The model file of the law.
    model: String,
}

impl Law {
    /// The law of a model, at rest.
    ///
    /// # Errors
    /// Where its parameters make none.
    pub fn of(model: &ModelFile) -> Result<Self, Refusal> {
        let refused = |found: String| {
            let allowed = "parameters that make a law: see which the log leaves open";
            Refusal::argument("law", found, allowed)
        };
        let values = model.values();
        let values =
            values.ok_or_else(|| refused("a law that this version does not know".into()))?;
        let law = values.law().map_err(|e| refused(e.to_string()))?;
        Ok(Self {
            stepped: SteppedLaw::new(law.clone()),
            law,
            model: model.to_toml(),
        })
    }
}

#[pymethods]
impl Law {
    /// The law of the text of a model file, with what `memory` gave.
    #[staticmethod]
    fn of_model(py: Python<'_>, model: &str, memory: Vec<f64>) -> PyResult<Self> {
        let model = ModelFile::parse(model).map_err(|e| raised(py, &e.into()))?;
        let mut law = Self::of(&model).map_err(|refusal| refusal.raise(py))?;
        match law.stepped.recall(&memory) {
            true => Ok(law),
            false => {
                let found = format!("{} numbers", memory.len());
                Err(Refusal::argument("memory", found, "those of a law of this kind").raise(py))
            }
        }
    }

    /// The text of its model file.
    #[getter]
    fn model(&self) -> &str {
        &self.model
    }

    /// All that it remembers.
    fn memory(&self) -> Vec<f64> {
        self.stepped.memory()
    }

    /// One sample in real time.
    fn step(&mut self, velocity: f64, dt: f64) -> f64 {
        self.stepped.step(dt, velocity)
    }

    /// Many samples in real time.
    fn steps<'py>(
        &mut self,
        py: Python<'py>,
        velocity: PyReadonlyArray1<'py, f64>,
        dt: f64,
    ) -> Bound<'py, PyArray1<f64>> {
        let velocity = velocity.as_array();
        let forces: Vec<f64> = velocity.iter().map(|&v| self.stepped.step(dt, v)).collect();
        forces.into_pyarray(py)
    }

    /// A record from rest.
    fn record<'py>(
        &self,
        py: Python<'py>,
        time: PyReadonlyArray1<'py, f64>,
        velocity: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (time, velocity) = (time.as_array(), velocity.as_array());
        let (Some(time), Some(velocity)) = (time.as_slice(), velocity.as_slice()) else {
            let found = "an array that is not contiguous";
            return Err(Refusal::argument("time, velocity", found, "contiguous arrays").raise(py));
        };
        let forces = forces_along(&self.law, time, velocity);
        Ok(forces.map_err(|e| raised(py, &e))?.into_pyarray(py))
    }

    /// Force of the last real-time sample.
    #[getter]
    fn force(&self) -> f64 {
        self.stepped.force()
    }

    /// Deflection of a bristle, or spring forces of elements.
    #[getter]
    fn state(&self) -> Vec<f64> {
        self.stepped.state()
    }

    /// Back to rest.
    fn reset(&mut self) {
        self.stepped.reset();
    }
}
