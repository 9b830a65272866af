//! The steady curve that a procedure takes over: from logs of constant velocities or from a model.

use super::map::{self, Mapped};
use crate::error::Error;
use crate::identify::beside::Beside;
use crate::identify::load::Asked;
use crate::identify::logs::{paths, refused};
use crate::source::Source;
use crate::wording::Setting;
use stiction_files::ModelFile;
use stiction_files::Warning;
use stiction_files::model::ReadModel;
use stiction_files::result::StaticMapEntry;
use stiction_friction::Direction;
use stiction_identify as engine;
use stiction_identify::procedure::Statics;
use stiction_identify::{Covariance, Observer, Parameter};
use stiction_number::four_digits;
use stiction_parameters::{LawKind, Name, ParameterSet, Quantity, Side};
use stiction_servo::plant::Plant;

/// A curve with where it comes from.
pub(super) struct Known {
    pub statics: Statics,
    /// `"logs"`, `"static logs"` or `"model"`.
    pub from: &'static str,
    pub map: Option<StaticMapEntry>,
    pub warnings: Vec<Warning>,
    /// Whether a search for it was stopped.
    pub interrupted: bool,
}

/// The curve of the model, else of the static logs, else of the logs themselves.
pub(super) fn known(
    asked: Asked,
    sources: &[Source],
    beside: &Beside,
    observer: &mut dyn Observer,
) -> Result<Known, Error> {
    if let Some(model) = &beside.model {
        return from_model(model);
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
        interrupted,
        ..
    } = map::map(asked, logs, observer)?;
    let own = beside.statics.is_empty();
    Ok(Known {
        statics: Statics::from_map(&map).map_err(|e| match e {
            engine::Error::Setting { name, found, .. } if own => {
                let found = format!(
                    "{}: no steady curve can be read from its constant velocities: {name} would be {}",
                    paths(logs).join(", "),
                    four_digits(found)
                );
                let allowed = [
                    "a log of constant velocities for the curve, ".into(),
                    Setting::Statics.is("LOG"),
                    ", or a model that has it, ".into(),
                    Setting::Model.is("MODEL.toml"),
                ];
                Error::usage(found, allowed)
            }
            e => refused(logs, e),
        })?,
        from,
        map: Some(entry),
        warnings,
        interrupted,
    })
}

fn from_model(read: &ReadModel) -> Result<Known, Error> {
    let model = &read.model;
    let exponent = value(model, "stribeck_exponent").unwrap_or(2.0);
    // Every parameter name was checked when the model was read.
    let parameters = model
        .parameter
        .iter()
        .filter_map(|p| {
            Some(Parameter {
                std: p.std,
                ci95: p.ci95.map(|[low, high]| (low, high)),
                identifiable: p.identifiable,
                identified: p.origin == "identified",
                ..Parameter::given(p.name.parse::<Name>().ok()?, p.value)
            })
        })
        .collect();
    let names = model.covariance.names.iter();
    let covariance = Covariance {
        names: names.filter_map(|name| name.parse().ok()).collect(),
        matrix: model.covariance.matrix.clone(),
    };
    let statics = Statics::new(parameters, covariance, exponent).map_err(|e| {
        let allowed = "a model with coulomb, static, stribeck_velocity and sigma2";
        read.refuse("parameter", e.to_string(), allowed)
    })?;
    Ok(Known {
        statics,
        from: "model",
        map: None,
        warnings: Vec::new(),
        interrupted: false,
    })
}

/// A value of a model file.
pub(super) fn value(model: &ModelFile, name: &str) -> Option<f64> {
    model
        .parameter
        .iter()
        .find(|p| p.name == name)
        .map(|p| p.value)
}

/// The simulated axis with a LuGre law from the parameters of one direction, if they are valid together. Any law will
/// do: one without a Stribeck curve gets a constant level, one without micro-damping gets sigma1 = 0.
pub(super) fn plant(values: &ParameterSet, positive: bool) -> Option<(Plant, Direction<f64>)> {
    let side = if positive {
        Side::Positive
    } else {
        Side::Negative
    };
    let of = |quantity| values.on(quantity, side);
    let coulomb = of(Quantity::Coulomb)?;
    let level = of(Quantity::Static).unwrap_or(coulomb).max(coulomb);
    let mut set = ParameterSet::of(
        LawKind::LuGre,
        [
            (Quantity::Sigma0, of(Quantity::Sigma0)?),
            (Quantity::Sigma1, of(Quantity::Sigma1).unwrap_or(0.0)),
            (Quantity::Sigma2, of(Quantity::Sigma2)?),
            (Quantity::Coulomb, coulomb),
            (Quantity::Static, level),
            (
                Quantity::StribeckVelocity,
                of(Quantity::StribeckVelocity).unwrap_or(1.0),
            ),
        ]
        .map(|(quantity, value)| (quantity.into(), value)),
    );
    if let Some(exponent) = of(Quantity::StribeckExponent) {
        set.insert(Quantity::StribeckExponent, exponent);
    }
    let law = set.lugre().ok()?;
    let plant = Plant::new(of(Quantity::Mass)?, law).ok()?;
    Some((plant, *law.curve().positive()))
}
