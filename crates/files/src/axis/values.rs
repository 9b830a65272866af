//! What an axis file says, in SI units and the types of the log and the engine.

use super::gain::ControllerValues;
use super::limits::AxisLimits;
use super::listed::{ListedLog, Use};
use super::search::SearchValues;
use super::tied::Tied;
use crate::axis::other::OtherFile;
use crate::config::Places;
use crate::error::Error;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_formats::ethercat::ProcessData;
use stiction_formats::text::TextOptions;
use stiction_identify::{Conditioning, Delay, Hold, Mass, Terms};
use stiction_log::{Elsewhere, Log, Mapping, Motion};
use stiction_number::short;

/// A column that comes from another file than the log, or has other time stamps than its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct JoinedColumn {
    /// That file; `None` for the log itself, in which the column has time stamps of its own.
    pub file: Option<OtherFile>,
    /// What the column is, and how its clock goes with that of the log.
    pub from: Elsewhere,
}

impl JoinedColumn {
    /// A line of the axis file such as `force = { column = "F", unit = "N" }`, with the file.
    pub fn line(&self, line: &str) -> String {
        let Some(file) = &self.file else {
            return line.into();
        };
        let file = toml::Value::String(file.given().display().to_string());
        line.replacen("{ ", &format!("{{ file = {file}, "), 1)
    }
}

/// Everything an axis file says, resolved; `Axis::default()` leaves all to detection.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Name of the axis for reports.
    pub name: Option<String>,
    /// Which column is what.
    pub mapping: Mapping,
    /// The logs that the file lists.
    pub logs: Vec<ListedLog>,
    /// Columns that come from other files than the log, or have other time stamps than its rows.
    pub joined: Vec<JoinedColumn>,
    /// How text logs are written, where stated.
    pub text: TextOptions,
    /// Which process data of EtherCAT captures are columns.
    pub ethercat: ProcessData,
    /// Filters and decimation.
    pub conditioning: Conditioning,
    /// Linear terms beside the friction law; a mass in kg or kg m^2.
    pub terms: Terms,
    /// Stribeck exponent, dimensionless, where it is given.
    pub stribeck_exponent: Option<f64>,
    /// Elements of the Maxwell-slip law; `None` leaves the number to the data.
    pub gms_elements: Option<usize>,
    /// Whether the Stribeck exponent is fitted instead.
    pub exponent_fitted: bool,
    /// Speed below which a sample counts as slow, m/s or rad/s; `None` follows from the log.
    pub low_speed: Option<f64>,
    /// How the logged force relates in time to the samples (held or centred), for a simulation.
    pub hold: Hold,
    /// Longest stretch that is simulated from one free start in open loop, s; `None` for whole runs.
    pub segment: Option<f64>,
    /// What the axis may do.
    pub limits: Option<AxisLimits>,
    /// Bandwidth of the speed loop of a controller whose gains are not known, Hz.
    pub bandwidth: Option<f64>,
    /// The controller as typed; its units are known with the log.
    pub(super) controller: Option<ControllerValues>,
    /// Settings and boxes of searches as typed, likewise.
    pub(super) search: SearchValues,
    /// Whether to fit a constant force; `None` follows from the law.
    pub(super) offset: Option<bool>,
    /// Whether anything is said of gravity.
    pub(super) gravity_is_stated: bool,
    /// Values whose unit fits one kind of axis only, checked when the log says which it is.
    pub(super) tied: Vec<Tied>,
    pub(super) file: PathBuf,
    /// The file that it was read from.
    pub(super) read_from: Option<PathBuf>,
    /// SHA-256 of the text that it was read from.
    pub(super) sha256: Option<String>,
    /// Where each key stands.
    pub(super) places: Places,
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            name: None,
            mapping: Mapping::default(),
            logs: Vec::new(),
            joined: Vec::new(),
            text: TextOptions::default(),
            ethercat: ProcessData::default(),
            conditioning: Conditioning::default(),
            terms: Terms {
                delay: Delay::Fitted,
                ..Terms::default()
            },
            stribeck_exponent: None,
            gms_elements: None,
            exponent_fitted: false,
            low_speed: None,
            hold: Hold::Held,
            segment: None,
            limits: None,
            bandwidth: None,
            controller: None,
            search: SearchValues::default(),
            offset: None,
            gravity_is_stated: false,
            tied: Vec::new(),
            file: PathBuf::new(),
            read_from: None,
            sha256: None,
            places: Places::default(),
        }
    }
}

impl Axis {
    /// Whether the force moves a mass: not on a test rig whose load cell sees friction alone.
    pub fn has_inertia(&self) -> bool {
        self.terms.mass != Mass::Absent
    }

    /// The linear terms for a log and a law.
    ///
    /// A constant force is fitted beside a symmetric law only, unless the axis file says otherwise: it
    /// cannot be told from Coulomb levels that differ between the directions.
    ///
    /// # Errors
    /// Where a unit of the file does not fit the log: an angle on a linear axis, a mass where the force
    /// is a current, a force limit in another unit than the force.
    pub fn terms_for(&self, log: &Log, asymmetric: bool) -> Result<Terms, Error> {
        self.fits(log.motion, &log.force_unit, "log")?;
        let terms = self.terms_of(log.motion, asymmetric)?;
        self.check_pitches(log)?;
        Ok(terms)
    }

    /// The same before there is a log.
    ///
    /// # Errors
    /// Where gravity is asked for on a linear axis.
    pub fn terms_of(&self, motion: Motion, asymmetric: bool) -> Result<Terms, Error> {
        if self.terms.gravity && motion == Motion::Linear {
            let allowed = "sin q and cos q need the angle of a rotary axis; gravity on a linear axis is \
                           the constant force";
            let found = "true on a linear axis".into();
            return Err(self.places.refuse("terms.gravity", found, allowed));
        }
        let mut terms = self.terms.clone();
        terms.offset = self.offset.unwrap_or(!asymmetric);
        Ok(terms)
    }

    /// Whether every unit fits an axis of that kind, in a `source` (log, model) that has the force in that unit.
    ///
    /// # Errors
    /// For the first value whose unit does not.
    pub fn fits(&self, motion: Motion, force_unit: &str, source: &str) -> Result<(), Error> {
        for tied in &self.tied {
            if let Some(allowed) = tied.misfit(motion, force_unit, source) {
                return Err(self.misfit(&tied.place, &tied.text, allowed));
            }
        }
        Ok(())
    }

    /// The file that it was read from.
    pub fn file(&self) -> Option<&Path> {
        self.read_from.as_deref()
    }

    /// SHA-256 of the text that it was read from; `None` where that was no file.
    pub fn sha256(&self) -> Option<&str> {
        self.sha256.as_deref()
    }

    /// Whether nothing is said of gravity.
    pub fn leaves_gravity_open(&self) -> bool {
        !self.gravity_is_stated
    }

    /// The Stribeck exponent to assume, dimensionless: that of the Gaussian curve unless another is given.
    pub fn exponent(&self) -> f64 {
        self.stribeck_exponent.unwrap_or(2.0)
    }

    /// Whether nothing is said of the Stribeck exponent.
    pub fn leaves_exponent_open(&self) -> bool {
        self.stribeck_exponent.is_none() && !self.exponent_fitted
    }

    /// Refuses a pitch that the encoder cannot show.
    fn check_pitches(&self, log: &Log) -> Result<(), Error> {
        let Some(step) = self.mapping.resolution.or(log.quantum) else {
            return Ok(());
        };
        let along = self.terms.level_pitches();
        for (key, pitches) in [("cogging", &self.terms.cogging), ("coulomb_pitch", &along)] {
            if let Some(i) = pitches.iter().position(|pitch| *pitch < step) {
                let key = format!("terms.{key}[{}]", i + 1);
                let unit = log.motion.position().si_text();
                let found = format!("{} {unit}", short(pitches[i]));
                let allowed = format!("at least the encoder step, {} {unit}", short(step));
                return Err(self.places.refuse(&key, found, &allowed));
            }
        }
        Ok(())
    }

    /// What the file says of the log at this path; `None` where it does not list it.
    pub fn listed(&self, path: &Path) -> Option<&ListedLog> {
        self.logs.iter().find(|log| log.is(path))
    }

    /// Whether the file gives a key, such as `log.crop`, or a table.
    pub fn gives(&self, key: &str) -> bool {
        self.places.has(key)
    }

    /// An error of this code about the value of a key, such as `log.crop`; `None` where the file does not give it.
    pub fn refuse(
        &self,
        key: &str,
        found: impl Into<String>,
        allowed: impl Into<String>,
        code: Code,
    ) -> Option<Error> {
        let key = self.written(key)?;
        Some(Error::Misfit {
            file: self.file.clone(),
            place: self.places.place(&key),
            found: found.into(),
            allowed: allowed.into(),
            code,
        })
    }

    /// The refusal of a recording, at the key of this file that it is about, where it is about one.
    pub fn at_key(&self, error: stiction_formats::Error) -> Error {
        each(self.named_in(error), |error| self.at_own_key(error))
    }

    /// A text that speaks of `axis.toml` and its `[columns]`, with the names that they have.
    pub fn named(&self, text: &str) -> String {
        let columns = format!("[{}]", self.places.columns());
        // All joints of a robot have one clock, which stands under [columns].
        let text = text.replace("[columns]", &columns);
        let text = text.replace(&format!("{columns}: time = "), "[columns]: time = ");
        match self.file.file_name() {
            Some(name) => text.replace("axis.toml", &name.to_string_lossy()),
            None => text,
        }
    }

    fn named_in(&self, error: stiction_formats::Error) -> stiction_formats::Error {
        error.reworded(&|text| self.named(text))
    }

    fn at_own_key(&self, error: stiction_formats::Error) -> Error {
        match error.setting().map(String::from) {
            Some(key) => self.at(&key, error),
            None => error.into(),
        }
    }

    /// The refusal of a part of a log that the file may list, at the key of that log that it is about.
    pub fn at_listed(
        &self,
        error: stiction_formats::Error,
        listed: Option<&ListedLog>,
        part: Use,
    ) -> Error {
        each(self.named_in(error), |error| {
            match (listed, error.setting()) {
                (Some(log), Some(setting)) => self.at(&log.written(setting, part), error),
                _ => self.at_own_key(error),
            }
        })
    }

    /// The refusal of a recording, at this key, where the file has it.
    pub fn at(&self, key: &str, error: stiction_formats::Error) -> Error {
        let mut found = error.clone();
        let allowed = std::mem::take(&mut found.allowed);
        let refused = self.refuse(key, found.to_string(), allowed, error.kind.code());
        refused.unwrap_or_else(|| error.into())
    }

    /// A key as the file has it: the key itself, or the column that it belongs to, by the name used in the file.
    fn written(&self, key: &str) -> Option<String> {
        let names = ["columns.force", "columns.torque", "columns.current"];
        let under: Vec<String> = match key.strip_prefix(names[0]) {
            Some(part) => names.iter().map(|name| format!("{name}{part}")).collect(),
            None => vec![key.into()],
        };
        let column = |key: &String| match key.rsplit_once('.') {
            Some((column, _)) if column.starts_with("columns.") => Some(column.to_string()),
            _ => None,
        };
        let columns = under.iter().filter_map(column);
        let mut all = under.iter().cloned().chain(columns);
        all.find(|key| self.places.has(key))
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

/// Everything that is wrong with a recording, each at its own key.
fn each(error: stiction_formats::Error, place: impl Fn(stiction_formats::Error) -> Error) -> Error {
    let all: Vec<Error> = error.clone().each().into_iter().map(place).collect();
    // Nothing is about a key: it stays the error of one recording.
    match all.iter().all(|error| matches!(error, Error::Log(_))) {
        true => error.into(),
        false => Error::of_all(all).unwrap_or_else(|| error.into()),
    }
}
