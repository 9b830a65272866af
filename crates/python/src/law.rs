//! A law that is run.

use crate::error::{Refusal, raised};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use std::sync::{Mutex, MutexGuard, PoisonError};
use stiction_files::ModelFile;
use stiction_workflows::{self as workflows, SteppedLaw, forces_along};

/// A friction law with its state.
#[pyclass(frozen, module = "stiction._native")]
pub struct Law {
    law: workflows::Law,
    /// Calls from several threads follow one another.
    stepped: Mutex<SteppedLaw>,
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
        let law = workflows::Law::of(&values).map_err(|e| refused(e.to_string()))?;
        Ok(Self {
            stepped: Mutex::new(SteppedLaw::new(law.clone())),
            law,
            model: model.to_toml(),
        })
    }

    /// The law with its state, for this thread alone. Nothing of Python may be called until it is let go.
    fn stepped(&self, py: Python<'_>) -> MutexGuard<'_, SteppedLaw> {
        let locked = self.stepped.lock_py_attached(py);
        locked.unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Law {
    /// The law of the text of a model file, with what `memory` gave.
    #[staticmethod]
    fn of_model(py: Python<'_>, model: &str, memory: Vec<f64>) -> PyResult<Self> {
        let model = ModelFile::parse(model).map_err(|e| raised(py, &e.into()))?;
        let law = Self::of(&model).map_err(|refusal| refusal.raise(py))?;
        let recalled = law.stepped(py).recall(&memory);
        match recalled {
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
    fn memory(&self, py: Python<'_>) -> Vec<f64> {
        self.stepped(py).memory()
    }

    /// One sample in real time.
    fn step(&self, py: Python<'_>, velocity: f64, dt: f64) -> f64 {
        self.stepped(py).step(dt, velocity)
    }

    /// Many samples in real time, without a sample of another thread between them.
    fn steps<'py>(
        &self,
        py: Python<'py>,
        velocity: PyReadonlyArray1<'py, f64>,
        dt: f64,
    ) -> Bound<'py, PyArray1<f64>> {
        let velocity = velocity.as_array();
        let mut law = self.stepped(py);
        let forces: Vec<f64> = velocity.iter().map(|&v| law.step(dt, v)).collect();
        drop(law);
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
    fn force(&self, py: Python<'_>) -> f64 {
        self.stepped(py).force()
    }

    /// Deflection of a bristle, or spring forces of elements.
    #[getter]
    fn state(&self, py: Python<'_>) -> Vec<f64> {
        self.stepped(py).state()
    }

    /// Back to rest.
    fn reset(&self, py: Python<'_>) {
        self.stepped(py).reset();
    }
}
