//! The friction of the simulated axis: from a model file, or of a known axis.

use super::resolve::Dimensions;
use crate::config::{Given, LARGEST_SI, Swept};
use crate::error::{Error, Warning};
use crate::model::{BY_HAND, Dependences, ModelFile, ModelParameter, ReadModel};
use crate::result::{CovarianceEntry, RemainingEntry};
use crate::shell::{quoted, quoted_path};
use crate::symbols;
use std::path::Path;
use stiction_codes::Code;
use stiction_formats::Dimension;
use stiction_friction::Stribeck;
use stiction_log::Motion;
use stiction_parameters::{FrictionLaw, LawError, LawKind, Name, ParameterSet, Quantity};
use stiction_servo::known::{self, Kind};
use stiction_servo::law::AxisLaw;

/// Whether a study simulates a law: one that holds an axis at rest.
pub(super) fn is_simulated_law(kind: LawKind) -> bool {
    kind.has_bristle()
}

/// The law of an axis with these parameters, sigma1 constant.
pub(super) fn axis_law(values: &ParameterSet) -> Result<AxisLaw, LawError> {
    match values.law()? {
        FrictionLaw::LuGre(law) => Ok(AxisLaw::LuGre(law)),
        FrictionLaw::ElastoPlastic(law) => Ok(AxisLaw::ElastoPlastic(law)),
        FrictionLaw::MaxwellSlip(law) => Ok(AxisLaw::MaxwellSlip(law)),
        FrictionLaw::CoulombViscous(_) | FrictionLaw::Stribeck(_) => {
            let kind = values.kind();
            Err(LawError::NotLuGre { kind })
        }
    }
}

/// Parameters of a law with bristles, and what is known of their errors.
pub struct Model {
    /// Linear or rotary.
    pub motion: Motion,
    /// The family of the law.
    pub kind: LawKind,
    /// Where it comes from, for reports.
    pub origin: String,
    /// Every parameter.
    pub parameters: Vec<Parameter>,
    /// What a compensator is made of where the data leave parameters open; none where they do not.
    pub supported: Option<ParameterSet>,
    /// Of the identified parameters; none for a known axis.
    pub covariance: Option<CovarianceEntry>,
    /// What the law leaves of the force; none where it was not measured.
    pub remaining: Option<RemainingEntry>,
    /// What to beware of.
    pub warnings: Vec<Warning>,
    /// The file that it was read from, for messages about its values.
    pub(super) read: Option<ReadModel>,
}

/// One parameter.
pub struct Parameter {
    /// Which parameter.
    pub name: Name,
    /// SI.
    pub value: f64,
    /// SI unit.
    pub unit: String,
}

/// Whether the simulated law has a parameter. The delay is one of the log, not of the axis.
pub(super) fn is_simulated(quantity: Quantity) -> bool {
    matches!(
        quantity,
        Quantity::Sigma0
            | Quantity::Sigma1
            | Quantity::Mass
            | Quantity::Offset
            | Quantity::Delay
            | Quantity::StribeckExponent
            | Quantity::BreakawayRatio
            | Quantity::Attraction
            | Quantity::ElementStiffness(_)
            | Quantity::ElementYield(_)
            | Quantity::ElementForce(_)
    ) || quantity.is_of_the_steady_curve()
}

/// The command that identifies the law lugre where a model has another one. A steady curve is kept, and the bristles come
/// from a log with reversals; of other logs lugre is fitted.
fn lugre(read: &ReadModel) -> String {
    let model = &read.model;
    let file = quoted_path(read.file());
    let out = quoted(&format!("{}-lugre", model.law));
    if model.source.method == "static" {
        return format!(
            "this is the steady curve of one, and a log with reversals gives the rest: stiction identify LOG --axis AXIS.toml \
             --method static-then-dynamic --model {file} --out {out}"
        );
    }
    let logs: Vec<String> = model
        .source
        .inputs
        .iter()
        .map(|i| quoted(&i.path))
        .collect();
    let logs = match logs.is_empty() {
        true => "LOG".into(),
        false => logs.join(" "),
    };
    format!(
        "identify it, with the axis file if there was one: stiction identify {logs} --law lugre --out {out}"
    )
}

/// Coulomb levels forward and back, N (N m).
fn levels(curve: &Stribeck<f64>) -> [f64; 2] {
    [curve.positive(), curve.negative()].map(|side| side.coulomb)
}

/// What is said of the parameters of a model that a study leaves out.
fn left_out(model: &ModelFile, curve: &Stribeck<f64>) -> Option<Warning> {
    let depends = model.dependences(levels(curve)).without_transmitted();
    let out = |p: &&ModelParameter| {
        let name = p.name.parse::<Name>().map(|name| name.quantity);
        let stands = |q| is_simulated(q) || q.is_a_reference();
        !name.is_ok_and(stands) && !depends.taken.contains(&p.name)
    };
    let names: Vec<&str> = model
        .parameter
        .iter()
        .filter(out)
        .map(|p| p.name.as_str())
        .collect();
    if names.is_empty() {
        return None;
    }
    let names = names.join(", ");
    let mut message = format!("the model has {names}, which a study does not simulate");
    if !depends.lacking.is_empty() {
        let lines = depends.lacking.join(" and ");
        message =
            format!("the model has {names}, and does not say over which range: add {lines} to it");
    }
    Some(Warning::new(Code::NotInStudy, message))
}

impl Model {
    /// A known axis by its name.
    pub fn known(name: &str) -> Option<Self> {
        let axis = known::find(name)?;
        let motion = match axis.kind {
            Kind::Linear => Motion::Linear,
            Kind::Rotary => Motion::Rotary,
        };
        let side = axis.law.curve().positive();
        let force = symbols::force_unit(motion);
        let parameter = |(quantity, value): (Quantity, f64)| Parameter {
            name: quantity.into(),
            value,
            unit: symbols::unit(quantity.dimension(), motion, force, ""),
        };
        let parameters = [
            (Quantity::Sigma0, axis.law.stiffness()),
            (Quantity::Sigma1, axis.law.damping().at_rest()),
            (Quantity::Sigma2, side.viscous),
            (Quantity::Coulomb, side.coulomb),
            (Quantity::Static, side.static_friction),
            (Quantity::StribeckVelocity, side.stribeck_velocity),
            (Quantity::Mass, axis.mass),
        ]
        .map(parameter)
        .into();
        let origin = format!("Known axis {}: {}", axis.name, axis.source);
        Some(Model::exact(motion, origin, parameters))
    }

    /// LuGre with parameters that have no errors.
    pub(super) fn exact(motion: Motion, origin: String, parameters: Vec<Parameter>) -> Self {
        Self {
            motion,
            kind: LawKind::LuGre,
            origin,
            parameters,
            supported: None,
            covariance: None,
            remaining: None,
            warnings: Vec::new(),
            read: None,
        }
    }

    /// The file that it was read from; none for a known axis, and for parameters that the study gives itself.
    pub fn file(&self) -> Option<&ReadModel> {
        self.read.as_ref()
    }

    /// A model file as identification wrote it.
    pub fn read(file: &Path) -> Result<Self, Error> {
        Self::of(ReadModel::read(file)?)
    }

    /// The same from its text; `file` is named in errors.
    pub(super) fn parse(text: &str, file: &Path) -> Result<Self, Error> {
        Self::of(ReadModel::named(text, file)?)
    }

    fn of(read: ReadModel) -> Result<Self, Error> {
        let model = &read.model;
        let kind = match LawKind::from_name(&model.law) {
            Some(kind) if is_simulated_law(kind) => kind,
            _ => {
                let allowed = format!(
                    "a study simulates laws with bristles or elements, which hold an axis at rest; {}",
                    lugre(&read)
                );
                return Err(read.refuse("law", format!("{:?}", model.law), &allowed));
            }
        };
        let (motion, force) = match model.kind.as_str() {
            "rotary" => (Motion::Rotary, "N*m"),
            _ => (Motion::Linear, "N"),
        };
        if model.force_unit != force {
            let allowed = format!(
                "a study needs {force}: identify with the scale of the force column in the axis file"
            );
            let found = format!("{:?}", model.force_unit);
            return Err(read.refuse("force_unit", found, &allowed));
        }
        if let Some(missing) = read.missing() {
            let mut allowed = "a study needs every parameter of the law".to_string();
            if model.source.method == "presliding-step" {
                let logs = model.source.inputs.iter().map(|input| quoted(&input.path));
                allowed = format!(
                    "{allowed}: steps show the bristles alone. With the steady curve of a model from --method static, here \
                     curve/model.toml: stiction identify {} --method presliding-step --model curve/model.toml --out whole",
                    logs.collect::<Vec<_>>().join(" ")
                );
            }
            return Err(read.refuse("parameter", format!("no {missing}"), &allowed));
        }
        let simulated = |name: &str| name.parse().is_ok_and(|n: Name| is_simulated(n.quantity));
        let beyond = |p: &&ModelParameter| simulated(&p.name) && p.value.abs() > LARGEST_SI;
        if let Some(p) = model.parameter.iter().find(beyond) {
            let found = format!("{} = {}", p.name, stiction_number::four_digits(p.value));
            let allowed = format!("in a study from -{LARGEST_SI:e} to {LARGEST_SI:e}");
            return Err(read.refuse_parameter(&p.name, found, &allowed));
        }
        let mut warnings = Vec::new();
        if !model.trustworthy {
            warnings.push(Warning::new(
                Code::ModelInDoubt,
                "the identification flagged this model as not trustworthy: see its report",
            ));
        }
        let listed = |test: &dyn Fn(&ModelParameter) -> bool| {
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
        // Every parameter name was checked when the model was read.
        let parameters = model.parameter.iter().filter_map(|p| {
            Some(Parameter {
                name: p.name.parse().ok()?,
                value: p.value,
                unit: p.unit.clone(),
            })
        });
        let supported = model.supported().filter(|(_, lowered)| !lowered.is_empty());
        let name = model.name.as_deref();
        let found = Model {
            motion,
            kind,
            origin: match model.source.method.as_str() {
                BY_HAND => name.unwrap_or("an axis written by hand").into(),
                method => format!(
                    "{}, identified by {method}",
                    name.unwrap_or("an identified axis")
                ),
            },
            parameters: parameters.collect(),
            supported: supported.map(|(values, _)| values),
            covariance: Some(model.covariance.clone()),
            remaining: model.remaining.clone(),
            warnings,
            read: None,
        };
        // If the parameters of a file do not make a law, the error names that file.
        match axis_law(&found.values()) {
            Ok(law) => {
                let warning = left_out(&read.model, law.curve());
                let mut found = found;
                found.warnings.extend(warning);
                Ok(Model {
                    read: Some(read),
                    ..found
                })
            }
            Err(LawError::Value(e)) => {
                let found = format!("{} = {}", e.name, stiction_number::four_digits(e.value));
                Err(read.refuse_parameter(e.name, found, e.allowed))
            }
            Err(e) => {
                let allowed = "every parameter of the law";
                Err(read.refuse("parameter", e.to_string(), allowed))
            }
        }
    }

    /// Takes the value of a sweep where it is one of a parameter of the law, in both directions of motion, and returns it.
    pub(super) fn take<'a>(&mut self, swept: &Swept<'a>) -> Result<Option<&'a Given<'a>>, Error> {
        let quantity = swept.key.strip_prefix("law.").and_then(Quantity::from_stem);
        let of_the_law =
            |q: &Quantity| is_simulated(*q) && !matches!(q, Quantity::Mass | Quantity::Delay);
        let Some(quantity) = quantity.filter(of_the_law) else {
            return Ok(None);
        };
        let given = swept.value;
        let value = match Dimensions::of(self.motion).of_parameter(quantity) {
            Dimension::ONE => given
                .as_number()
                .ok_or_else(|| given.refused("a number, without quotes"))?,
            dimension => given.value(&[dimension])?.0,
        };
        let allowed = quantity.allowed();
        if !allowed.admits(value) {
            return Err(given.refused(allowed.words()));
        }
        // A law that does not give its exponent has that of the Gaussian curve.
        let exponent = quantity == Quantity::StribeckExponent;
        if exponent && self.parameters.iter().all(|p| p.name.quantity != quantity) {
            self.parameters.push(Parameter {
                name: quantity.into(),
                value,
                unit: "1".into(),
            });
        }
        for parameter in &mut self.parameters {
            if parameter.name.quantity == quantity {
                parameter.value = value;
                swept.taken.set(true);
            }
        }
        Ok(swept.taken.get().then_some(given))
    }

    /// A key whose value cannot be used, at its place in the file that it was read from.
    pub fn refuse(&self, key: &str, found: String, allowed: &str) -> Error {
        match &self.read {
            Some(read) => read.refuse(key, found, allowed),
            None => self.refuse_parameter(key, found, allowed),
        }
    }

    /// The same of a parameter.
    pub fn refuse_parameter(&self, name: &str, found: String, allowed: &str) -> Error {
        match &self.read {
            Some(read) => read.refuse_parameter(name, found, allowed),
            // The parameters of a known axis are always valid.
            None => Error::Config {
                file: self.origin.clone().into(),
                place: format!("{name}: "),
                found,
                allowed: allowed.into(),
            },
        }
    }

    /// Its parameters with their values.
    pub fn values(&self) -> ParameterSet {
        let values = self.parameters.iter().map(|p| (p.name, p.value));
        ParameterSet::of(self.kind, values)
    }

    /// What friction depends on beside the velocity, as parts of the levels of a curve.
    pub(super) fn dependences(&self, curve: &Stribeck<f64>) -> Dependences {
        let read = self.read.as_ref();
        read.map_or_else(Dependences::default, |read| {
            read.model.dependences(levels(curve)).without_transmitted()
        })
    }

    /// The unit of a parameter of the model; that of a plain number where it has none.
    pub(super) fn unit_of(&self, name: Quantity) -> &str {
        let mut all = self.parameters.iter();
        let found = all.find(|p| p.name == name);
        found.map_or("1", |p| &p.unit)
    }

    /// Largest speed of the logs that it was identified from, m/s (rad/s), where that is known.
    pub fn top_speed(&self) -> Option<f64> {
        self.read.as_ref()?.model.top_speed()
    }

    /// A parameter by its name.
    pub fn value(&self, name: impl Into<Name>) -> Option<f64> {
        let name = name.into();
        let found = self.parameters.iter().find(|p| p.name == name);
        found.map(|p| p.value)
    }
}
