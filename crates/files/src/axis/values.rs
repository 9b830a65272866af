//! What an axis file says, in SI units and the types of the log and the engine.

use super::gain::ControllerValues;
use super::tied::Tied;
use crate::error::Error;
use std::path::PathBuf;
use stiction_identify::{Conditioning, Delay, Hold, Terms};
use stiction_log::text::TextOptions;
use stiction_log::{Log, Mapping, Motion};

/// Everything an axis file says, resolved; `Axis::default()` leaves all to detection.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Name of the axis for reports.
    pub name: Option<String>,
    /// Which column is what.
    pub mapping: Mapping,
    /// How text logs are written, where stated.
    pub text: TextOptions,
    /// Filters and decimation.
    pub conditioning: Conditioning,
    /// Linear terms beside the friction law; a mass in kg or kg m^2.
    pub terms: Terms,
    /// Stribeck exponent, dimensionless.
    pub stribeck_exponent: f64,
    /// Elements of the Maxwell-slip law; `None` leaves the number to the data.
    pub gms_elements: Option<usize>,
    /// Whether the Stribeck exponent is fitted instead.
    pub exponent_fitted: bool,
    /// Speed below which a sample counts as slow, m/s or rad/s; `None` follows from the log.
    pub low_speed: Option<f64>,
    /// How the logged force stands to the instants of the samples, for a simulation.
    pub hold: Hold,
    /// Longest stretch that is simulated from one free start in open loop, s; `None` for whole runs.
    pub segment: Option<f64>,
    /// The controller as typed; its units are known with the log.
    pub(super) controller: Option<ControllerValues>,
    /// Whether to fit a constant force; `None` follows from the law.
    pub(super) offset: Option<bool>,
    /// Values whose unit fits one kind of axis only, checked when the log says which it is.
    pub(super) tied: Vec<Tied>,
    pub(super) file: PathBuf,
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            name: None,
            mapping: Mapping::default(),
            text: TextOptions::default(),
            conditioning: Conditioning::default(),
            terms: Terms {
                delay: Delay::Fitted,
                ..Terms::default()
            },
            stribeck_exponent: 2.0,
            gms_elements: None,
            exponent_fitted: false,
            low_speed: None,
            hold: Hold::Held,
            segment: None,
            controller: None,
            offset: None,
            tied: Vec::new(),
            file: PathBuf::new(),
        }
    }
}

impl Axis {
    /// The linear terms for a log and a law.
    ///
    /// A constant force is fitted beside a symmetric law only, unless the axis file says otherwise: it
    /// cannot be told from Coulomb levels that differ between the directions.
    ///
    /// # Errors
    /// Where a unit of the file does not fit the log: an angle on a linear axis, a mass where the force
    /// is a current, a force limit in another unit than the force.
    pub fn terms_for(&self, log: &Log, asymmetric: bool) -> Result<Terms, Error> {
        for tied in &self.tied {
            if let Some(allowed) = tied.misfit(log) {
                return Err(self.misfit(&tied.place, &tied.text, allowed));
            }
        }
        if self.terms.gravity && log.motion == Motion::Linear {
            let allowed = "sin q and cos q need the angle of a rotary axis; gravity on a linear axis is \
                           the constant force";
            return Err(self.misfit("terms.gravity: ", "true on a linear axis", allowed.into()));
        }
        let mut terms = self.terms.clone();
        terms.offset = self.offset.unwrap_or(!asymmetric);
        Ok(terms)
    }

    pub(super) fn misfit(&self, place: &str, found: &str, allowed: String) -> Error {
        Error::Config {
            file: self.file.clone(),
            place: place.into(),
            found: found.into(),
            allowed,
        }
    }
}
