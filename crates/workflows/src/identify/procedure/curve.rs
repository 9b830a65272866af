//! The steady curve that a procedure takes over: from logs of constant velocities or from a model.

use super::static_map::{self, Mapped};
use super::{Beside, refused};
use crate::error::Error;
use crate::identify::Options;
use crate::source::Source;
use stiction_files::Axis;
use stiction_files::ModelFile;
use stiction_files::Warning;
use stiction_files::result::StaticMapEntry;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::procedure::Statics;
use stiction_identify::{Covariance, Dimension, Parameter};
use stiction_servo::plant::Plant;

/// A curve with where it comes from.
pub(super) struct Known {
    pub statics: Statics,
    /// `"logs"`, `"static logs"` or `"model"`.
    pub from: &'static str,
    pub map: Option<StaticMapEntry>,
    pub warnings: Vec<Warning>,
}

/// The curve of the model, else of the static logs, else of the logs themselves.
pub(super) fn known(
    options: &Options,
    axis: &Axis,
    sources: &[Source],
    beside: &Beside,
) -> Result<Known, Error> {
    if let Some(model) = &beside.model {
        return from_model(model, options);
    }
    let (logs, from) = if beside.statics.is_empty() {
        (sources, "logs")
    } else {
        (beside.statics.as_slice(), "static logs")
    };
    let Mapped {
        map,
        entry,
        warnings,
    } = static_map::map(options, axis, logs)?;
    Ok(Known {
        statics: Statics::from_map(&map).map_err(|e| refused(logs, e))?,
        from,
        map: Some(entry),
        warnings,
    })
}

fn from_model(model: &ModelFile, options: &Options) -> Result<Known, Error> {
    let exponent = value(model, "stribeck_exponent").unwrap_or(2.0);
    let parameters = model
        .parameter
        .iter()
        .map(|p| Parameter {
            std: p.std,
            ci95: p.ci95.map(|[low, high]| (low, high)),
            identifiable: p.identifiable,
            identified: p.origin == "identified",
            ..Parameter::given(&p.name, dimension(&p.name), p.value)
        })
        .collect();
    let covariance = Covariance {
        names: model.covariance.names.clone(),
        matrix: model.covariance.matrix.clone(),
    };
    let file = options.procedures.model.clone().unwrap_or_default();
    let statics = Statics::new(parameters, covariance, exponent).map_err(|e| {
        stiction_files::Error::Config {
            file,
            place: "parameter: ".into(),
            found: e.to_string(),
            allowed: "a model with coulomb, static, stribeck_velocity and sigma2".into(),
        }
    })?;
    Ok(Known {
        statics,
        from: "model",
        map: None,
        warnings: Vec::new(),
    })
}

fn dimension(name: &str) -> Dimension {
    match name.trim_end_matches("_pos").trim_end_matches("_neg") {
        "sigma0" => Dimension::Stiffness,
        "sigma1" | "sigma2" => Dimension::Damping,
        "stribeck_velocity" => Dimension::Speed,
        "stribeck_exponent" => Dimension::One,
        "mass" => Dimension::Inertia,
        _ => Dimension::Force,
    }
}

/// A value of a model file.
pub(super) fn value(model: &ModelFile, name: &str) -> Option<f64> {
    model
        .parameter
        .iter()
        .find(|p| p.name == name)
        .map(|p| p.value)
}

/// The axis of a LuGre law with one direction's curve, if its numbers make one.
pub(super) fn plant(
    value: &dyn Fn(&str) -> Option<f64>,
    positive: bool,
) -> Option<(Plant, Direction<f64>)> {
    let suffix = if positive { "_pos" } else { "_neg" };
    let of = |name: &str| value(name).or_else(|| value(&format!("{name}{suffix}")));
    let coulomb = of("coulomb")?;
    let side = Direction {
        coulomb,
        static_friction: of("static").unwrap_or(coulomb).max(coulomb),
        stribeck_velocity: of("stribeck_velocity").unwrap_or(1.0),
        viscous: of("sigma2")?,
    };
    let shape = match value("stribeck_exponent") {
        Some(delta) if delta != 2.0 => Shape::Power(delta),
        _ => Shape::Gaussian,
    };
    let curve = Stribeck::symmetric(shape, side, 0.0).ok()?;
    let damping = Damping::Constant(value("sigma1").unwrap_or(0.0));
    let law = LuGre::new(value("sigma0")?, damping, curve).ok()?;
    Some((Plant::new(value("mass")?, law).ok()?, side))
}
