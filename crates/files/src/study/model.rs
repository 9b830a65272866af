//! The friction of the simulated axis: from a model file, or of a known axis.

use crate::error::{Error, Warning};
use crate::model::ModelFile;
use crate::result::CovarianceEntry;
use crate::symbols;
use std::path::Path;
use stiction_codes::Code;
use stiction_friction::{Damping, Direction, LuGre, ParamError, Shape, Stribeck};
use stiction_log::Motion;
use stiction_servo::known::{self, Kind};

/// Parameters of a law with bristles, and what is known of their errors.
pub struct Model {
    /// Linear or rotary.
    pub motion: Motion,
    /// Where it comes from, for reports.
    pub origin: String,
    /// Every parameter.
    pub parameters: Vec<Parameter>,
    /// Of the identified parameters; none for a known axis.
    pub covariance: Option<CovarianceEntry>,
    /// What to beware of.
    pub warnings: Vec<Warning>,
}

/// One parameter.
pub struct Parameter {
    /// Name, such as `sigma0`.
    pub name: String,
    /// SI.
    pub value: f64,
    /// SI unit.
    pub unit: String,
}

/// Parameters that the simulated law has, without the suffix of their direction. The delay is one of the log, not of the
/// axis.
const SIMULATED: [&str; 10] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static",
    "stribeck_velocity",
    "stribeck_exponent",
    "mass",
    "offset",
    "delay",
];

impl Model {
    /// A known axis by its name.
    pub fn known(name: &str) -> Option<Self> {
        let axis = known::find(name)?;
        let motion = match axis.kind {
            Kind::Linear => Motion::Linear,
            Kind::Rotary => Motion::Rotary,
        };
        let side = axis.law.curve().positive();
        let (length, force, mass) = match motion {
            Motion::Linear => ("m", "N", "kg"),
            Motion::Rotary => ("rad", "N*m", "kg*m^2"),
        };
        let parameter = |name: &str, value: f64, unit: String| Parameter {
            name: name.into(),
            value,
            unit,
        };
        let parameters = vec![
            parameter("sigma0", axis.law.stiffness(), format!("{force}/{length}")),
            parameter(
                "sigma1",
                axis.law.damping().at_rest(),
                format!("{force}*s/{length}"),
            ),
            parameter("sigma2", side.viscous, format!("{force}*s/{length}")),
            parameter("coulomb", side.coulomb, force.into()),
            parameter("static", side.static_friction, force.into()),
            parameter(
                "stribeck_velocity",
                side.stribeck_velocity,
                symbols::speed_unit(motion).into(),
            ),
            parameter("mass", axis.mass, mass.into()),
        ];
        Some(Model {
            motion,
            origin: format!("Known axis {}: {}", axis.name, axis.source),
            parameters,
            covariance: None,
            warnings: Vec::new(),
        })
    }

    /// A model file as identification wrote it.
    pub fn read(file: &Path) -> Result<Self, Error> {
        let model = ModelFile::read(file)?;
        let refuse = |place: &str, found: String, allowed: &str| Error::Config {
            file: file.to_path_buf(),
            place: place.into(),
            found,
            allowed: allowed.into(),
        };
        if !["lugre", "dahl"].contains(&model.law.as_str()) {
            let allowed = "a study simulates lugre and dahl; identify with --law lugre";
            return Err(refuse("law: ", format!("{:?}", model.law), allowed));
        }
        let (motion, force) = match model.kind.as_str() {
            "rotary" => (Motion::Rotary, "N*m"),
            _ => (Motion::Linear, "N"),
        };
        if model.force_unit != force {
            let allowed = format!(
                "a study needs {force}: identify with the scale of the force column in the axis file"
            );
            let found = format!("{:?}", model.force_unit);
            return Err(refuse("force_unit: ", found, &allowed));
        }
        if let Some(name) = model.missing() {
            let allowed = "a study needs every parameter of the law";
            return Err(refuse("parameter: ", format!("no {name}"), allowed));
        }
        let mut warnings = Vec::new();
        if !model.trustworthy {
            warnings.push(Warning::new(
                Code::ModelInDoubt,
                "the identification did not stand by this model: see its report",
            ));
        }
        let listed = |test: &dyn Fn(&crate::model::ModelParameter) -> bool| {
            let names = model.parameter.iter().filter(|p| test(p));
            names
                .map(|p| p.name.as_str())
                .collect::<Vec<_>>()
                .join(", ")
        };
        let unknown = listed(&|p| !p.identifiable);
        if !unknown.is_empty() {
            warnings.push(Warning::new(
                Code::ModelInDoubt,
                format!("the log did not determine {unknown}: what depends on it is a guess"),
            ));
        }
        let stem = |name: &str| {
            let name = name.strip_suffix("_pos").unwrap_or(name);
            name.strip_suffix("_neg").unwrap_or(name).to_string()
        };
        let left_out = listed(&|p| !SIMULATED.contains(&stem(&p.name).as_str()));
        if !left_out.is_empty() {
            warnings.push(Warning::new(
                Code::NotInStudy,
                format!("the model has {left_out}, which a study does not simulate"),
            ));
        }
        let parameters = model.parameter.iter().map(|p| Parameter {
            name: p.name.clone(),
            value: p.value,
            unit: p.unit.clone(),
        });
        let name = model.name.as_deref().unwrap_or("an identified axis");
        let model = Model {
            motion,
            origin: format!("{name}, identified by {}", model.source.method),
            parameters: parameters.collect(),
            covariance: Some(model.covariance),
            warnings,
        };
        // What the parameters of a file do not allow is said of that file.
        law(&|name| model.value(name)).map_err(|e| {
            let found = format!("{} = {}", e.name, stiction_number::four_digits(e.value));
            refuse("parameter: ", found, e.allowed)
        })?;
        Ok(model)
    }

    /// A parameter by its name.
    pub fn value(&self, name: &str) -> Option<f64> {
        let found = self.parameters.iter().find(|p| p.name == name);
        found.map(|p| p.value)
    }
}

/// The law of parameters by their names, with sigma1 capped. A Dahl law has no static level and no sigma1 of its own.
pub(super) fn law(value: &dyn Fn(&str) -> Option<f64>) -> Result<LuGre<f64>, ParamError> {
    let side = |suffix: &str| {
        let of = |name: &str| value(&format!("{name}{suffix}")).or_else(|| value(name));
        let coulomb = of("coulomb").unwrap_or(f64::NAN);
        Direction {
            coulomb,
            static_friction: of("static").unwrap_or(coulomb),
            // Without a static level of its own the curve is flat, whatever the velocity.
            stribeck_velocity: of("stribeck_velocity").unwrap_or(1.0),
            viscous: of("sigma2").unwrap_or(0.0),
        }
    };
    let shape = match value("stribeck_exponent") {
        Some(exponent) if exponent != 2.0 => Shape::Power(exponent),
        _ => Shape::Gaussian,
    };
    let offset = value("offset").unwrap_or(0.0);
    let (pos, neg) = (side("_pos"), side("_neg"));
    // Where both are the same, an error names the parameter as the model does.
    let curve = if pos == neg {
        Stribeck::symmetric(shape, pos, offset)?
    } else {
        Stribeck::new(shape, pos, neg, offset)?
    };
    let damping = Damping::Capped(value("sigma1").unwrap_or(0.0));
    LuGre::new(value("sigma0").unwrap_or(f64::NAN), damping, curve)
}
