//! A law that is run.

use crate::error::{Refusal, raised};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use stiction::{FrictionLaw, SteppedLaw, forces_along};

/// A friction law with its state.
#[pyclass(module = "stiction._native")]
pub struct Law {
    law: FrictionLaw,
    stepped: SteppedLaw,
}

impl Law {
    /// At rest.
    pub fn new(law: FrictionLaw) -> Self {
        Self {
            stepped: SteppedLaw::new(law.clone()),
            law,
        }
    }
}

#[pymethods]
impl Law {
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
