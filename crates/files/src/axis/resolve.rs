//! From the axis file as typed to SI values that the libraries take.

use super::Axis;
use super::controller::{ControllerValues, Gain};
use super::raw::{self, RawAxis, RawChannel, RawExponent, RawScale, RawSelector, RawTerms};
use super::tied::Tied;
use crate::error::Error;
use std::cell::RefCell;
use std::path::Path;
use stiction_identify::{
    Conditioning, Cutoff, Delay, Dependence, GMS_FEWEST, GMS_MOST, Hold, Mass, Source,
};
use stiction_log::text::{Decimal, Separator, TextOptions};
use stiction_log::{Channel, Dimension, Mapping, Motion, Role, Selector, Unit, Value, Wrap};

const SPEEDS: [Dimension; 2] = [Dimension::LINEAR_VELOCITY, Dimension::ANGULAR_VELOCITY];

/// Largest decimation: 10 kHz down to 1 Hz.
const MAX_DECIMATE: usize = 10_000;

/// Checks every value of a raw axis; `text` and `file` are for messages.
pub(super) fn resolve(raw: &RawAxis, text: &str, file: &Path) -> Result<Axis, Error> {
    let resolver = Resolver {
        text,
        file,
        tied: RefCell::default(),
    };
    let mut axis = resolver.resolve(raw)?;
    axis.tied = resolver.tied.into_inner();
    Ok(axis)
}

struct Resolver<'a> {
    text: &'a str,
    file: &'a Path,
    tied: RefCell<Vec<Tied>>,
}

impl Resolver<'_> {
    fn resolve(&self, raw: &RawAxis) -> Result<Axis, Error> {
        let mut axis = Axis {
            name: raw.name.clone().filter(|n| !n.trim().is_empty()),
            file: self.file.to_path_buf(),
            ..Axis::default()
        };
        self.mapping(raw, &mut axis.mapping)?;
        self.text_options(raw, &mut axis.text)?;
        axis.conditioning = self.conditioning(raw)?;
        axis.conditioning.resolution = axis.mapping.resolution;
        self.terms(raw, &mut axis)?;
        self.simulation(raw, &mut axis)?;
        if let Some(text) = &raw.report.low_speed {
            axis.low_speed = Some(self.positive("report.low_speed", text, &SPEEDS)?);
        }
        Ok(axis)
    }

    fn mapping(&self, raw: &RawAxis, mapping: &mut Mapping) -> Result<(), Error> {
        mapping.motion = match raw.kind.as_deref() {
            None => None,
            Some("linear") => Some(Motion::Linear),
            Some("rotary") => Some(Motion::Rotary),
            Some(other) => {
                return Err(self.refuse("kind", format!("{other:?}"), "linear or rotary"));
            }
        };
        if let Some(text) = &raw.rate {
            mapping.rate_hz = Some(self.positive("rate", text, &[Dimension::FREQUENCY])?);
        }
        let columns = [
            (Role::Time, &raw.columns.time),
            (Role::Position, &raw.columns.position),
            (Role::Velocity, &raw.columns.velocity),
            (Role::Force, &raw.columns.force),
            (Role::Reference, &raw.columns.reference),
            (Role::Temperature, &raw.columns.temperature),
            (Role::Load, &raw.columns.load),
        ];
        for (role, channel) in columns {
            let Some(channel) = channel else { continue };
            let channel = self.channel(role, channel)?;
            let slot = match role {
                Role::Time => &mut mapping.time,
                Role::Position => &mut mapping.position,
                Role::Velocity => &mut mapping.velocity,
                Role::Force => &mut mapping.force,
                Role::Reference => &mut mapping.reference,
                Role::Temperature => &mut mapping.temperature,
                Role::Load => &mut mapping.load,
            };
            *slot = Some(channel);
        }
        let lengths = [Dimension::LENGTH, Dimension::ANGLE];
        if let Some(text) = &raw.log.wrap {
            let period = self.positive("log.wrap", text, &lengths)?;
            mapping.wrap = Some(Wrap { period });
        }
        if let Some(text) = &raw.log.resolution {
            mapping.resolution = Some(self.positive("log.resolution", text, &lengths)?);
        }
        if let Some(text) = &raw.log.force_limit {
            let forces = [
                Dimension::FORCE,
                Dimension::TORQUE,
                Dimension::CURRENT,
                Dimension::VOLTAGE,
            ];
            mapping.force_limit = Some(self.positive("log.force_limit", text, &forces)?);
        }
        if let Some([from, to]) = &raw.log.crop {
            let a = self.value("log.crop", from, &[Dimension::TIME])?;
            let b = self.value("log.crop", to, &[Dimension::TIME])?;
            if a >= b {
                return Err(self.refuse(
                    "log.crop",
                    format!("{from:?} to {to:?}"),
                    "two times from the first sample, the first before the second",
                ));
            }
            mapping.crop = Some((a, b));
        }
        Ok(())
    }

    fn channel(&self, role: Role, raw: &RawChannel) -> Result<Channel, Error> {
        let key = format!("columns.{role}");
        let select = |selector: &RawSelector| match selector {
            RawSelector::Name(name) => Ok(Selector::Name(name.clone())),
            RawSelector::Index(i) => usize::try_from(*i)
                .ok()
                .filter(|i| *i > 0)
                .map(Selector::Index)
                .ok_or_else(|| {
                    self.refuse(&key, format!("column number {i}"), "columns count from 1")
                }),
        };
        let full = match raw {
            RawChannel::Name(name) => {
                return Ok(Channel::named(name.clone()));
            }
            RawChannel::Index(i) => {
                let column = select(&RawSelector::Index(*i))?;
                return Ok(Channel {
                    column,
                    unit: None,
                    scale: None,
                    invert: false,
                });
            }
            RawChannel::Full(full) => full,
        };
        let unit = full.unit.as_deref().map(|text| {
            Unit::parse(text).map_err(|e| self.refuse(&format!("{key}.unit"), e.found, &e.allowed))
        });
        let scale = full.scale.as_ref().map(|scale| match scale {
            RawScale::Number(x) if x.is_finite() && *x != 0.0 => Ok(Value {
                number: *x,
                unit: Unit::si(Dimension::ONE),
            }),
            RawScale::Number(x) => Err(self.refuse(
                &format!("{key}.scale"),
                x.to_string(),
                "a finite number, not 0",
            )),
            RawScale::Text(text) => Value::parse(text)
                .map_err(|e| self.refuse(&format!("{key}.scale"), e.found, &e.allowed)),
        });
        Ok(Channel {
            column: select(&full.column)?,
            unit: unit.transpose()?,
            scale: scale.transpose()?,
            invert: full.invert,
        })
    }

    fn text_options(&self, raw: &RawAxis, out: &mut TextOptions) -> Result<(), Error> {
        out.header = raw.text.header;
        out.preamble = raw.text.preamble;
        out.separator = match raw.text.separator.as_deref() {
            None => None,
            Some("tab" | "\t") => Some(Separator::Tab),
            Some(";" | "semicolon") => Some(Separator::Semicolon),
            Some("," | "comma") => Some(Separator::Comma),
            Some("|" | "pipe") => Some(Separator::Pipe),
            Some(" " | "blanks") => Some(Separator::Blanks),
            Some(other) => {
                return Err(self.refuse(
                    "text.separator",
                    format!("{other:?}"),
                    "tab, semicolon, comma, pipe or blanks",
                ));
            }
        };
        out.decimal = match raw.text.decimal.as_deref() {
            None => None,
            Some("." | "point") => Some(Decimal::Point),
            Some("," | "comma") => Some(Decimal::Comma),
            Some(other) => {
                return Err(self.refuse("text.decimal", format!("{other:?}"), "point or comma"));
            }
        };
        Ok(())
    }

    fn conditioning(&self, raw: &RawAxis) -> Result<Conditioning, Error> {
        let raw = &raw.conditioning;
        let source = match raw.source.as_deref() {
            None | Some("auto") => None,
            Some("position") => Some(Source::Position),
            Some("velocity") => Some(Source::Velocity),
            Some(other) => {
                return Err(self.refuse(
                    "conditioning.source",
                    format!("{other:?}"),
                    "position, velocity or auto",
                ));
            }
        };
        let cutoff = |key: &str, text: &Option<String>| match text.as_deref() {
            None | Some("auto") => Ok(Cutoff::Auto),
            Some("off") => Ok(Cutoff::Off),
            Some(text) => self
                .positive(key, text, &[Dimension::FREQUENCY])
                .map(Cutoff::Hz),
        };
        if let Some(n) = raw.decimate
            && !(1..=MAX_DECIMATE).contains(&n)
        {
            return Err(self.refuse(
                "conditioning.decimate",
                n.to_string(),
                "a whole number from 1 to 10000",
            ));
        }
        Ok(Conditioning {
            source,
            source_cutoff: cutoff("conditioning.source_cutoff", &raw.source_cutoff)?,
            common_cutoff: cutoff("conditioning.common_cutoff", &raw.common_cutoff)?,
            decimate: raw.decimate,
            resolution: None,
            min_speed: match &raw.min_speed {
                Some(text) => self.positive("conditioning.min_speed", text, &SPEEDS)?,
                None => 0.0,
            },
        })
    }

    fn terms(&self, raw: &RawAxis, axis: &mut Axis) -> Result<(), Error> {
        match raw.mass.as_deref() {
            None | Some("fit") => axis.terms.mass = Mass::Fitted,
            Some("none") => axis.terms.mass = Mass::Absent,
            Some(text) => {
                let allowed = [Dimension::MASS, Dimension::INERTIA];
                axis.terms.mass = Mass::Given(self.positive("mass", text, &allowed)?);
            }
        }
        axis.offset = raw.terms.offset;
        axis.terms.gravity = raw.terms.gravity.unwrap_or(false);
        axis.terms.cogging = self.pitches("terms.cogging", &raw.terms.cogging)?;
        axis.terms.quadratic_viscous = raw.terms.quadratic_viscous.unwrap_or(false);
        axis.terms.dependences = self.dependences(&raw.terms)?;
        axis.terms.delay = match raw.terms.delay.as_deref() {
            None | Some("fit") => Delay::Fitted,
            Some("none") => Delay::NONE,
            Some(text) => Delay::Given(self.delay("terms.delay", text)?),
        };
        match &raw.terms.stribeck_exponent {
            None => {}
            Some(RawExponent::Number(delta)) if (0.1..=10.0).contains(delta) => {
                axis.stribeck_exponent = *delta;
            }
            Some(RawExponent::Word(word)) if word == "fit" => axis.exponent_fitted = true,
            Some(other) => {
                let found = match other {
                    RawExponent::Number(delta) => delta.to_string(),
                    RawExponent::Word(word) => format!("{word:?}"),
                };
                return Err(self.refuse(
                    "terms.stribeck_exponent",
                    found,
                    "a number from 0.1 to 10, or \"fit\"",
                ));
            }
        }
        if let Some(n) = raw.terms.gms_elements {
            if !(GMS_FEWEST..=GMS_MOST).contains(&n) {
                return Err(self.refuse(
                    "terms.gms_elements",
                    n.to_string(),
                    "a whole number from 3 to 10",
                ));
            }
            axis.gms_elements = Some(n);
        }
        Ok(())
    }

    /// A time of either sign, up to a second.
    fn delay(&self, key: &str, text: &str) -> Result<f64, Error> {
        let time = self.value(key, text, &[Dimension::TIME])?;
        if time.abs() <= 1.0 {
            return Ok(time);
        }
        let allowed = "fit, none, or a time from -1 s to 1 s";
        Err(self.refuse(key, format!("{text:?}"), allowed))
    }

    /// What friction depends on, about references that the log will give.
    fn dependences(&self, raw: &RawTerms) -> Result<Vec<Dependence>, Error> {
        let asked = [
            (raw.coulomb_load, Dependence::CoulombLoad(0.0)),
            (raw.coulomb_temperature, Dependence::CoulombTemperature(0.0)),
            (raw.coulomb_position, Dependence::CoulombPosition(0.0)),
            (raw.sigma2_temperature, Dependence::ViscousTemperature(0.0)),
        ];
        let mut out: Vec<Dependence> = asked
            .into_iter()
            .filter_map(|(asked, dependence)| (asked == Some(true)).then_some(dependence))
            .collect();
        let pitches = self.pitches("terms.coulomb_pitch", &raw.coulomb_pitch)?;
        out.extend(pitches.into_iter().map(Dependence::CoulombPitch));
        Ok(out)
    }

    fn pitches(&self, key: &str, raw: &[String]) -> Result<Vec<f64>, Error> {
        let lengths = [Dimension::LENGTH, Dimension::ANGLE];
        if raw.len() > 4 {
            return Err(self.refuse(key, format!("{} pitches", raw.len()), "at most 4"));
        }
        raw.iter()
            .map(|pitch| self.positive(key, pitch, &lengths))
            .collect()
    }

    fn simulation(&self, raw: &RawAxis, axis: &mut Axis) -> Result<(), Error> {
        axis.hold = match raw.simulation.force.as_deref() {
            None | Some("held") => Hold::Held,
            Some("centred") => Hold::Centred,
            Some(other) => {
                return Err(self.refuse(
                    "simulation.force",
                    format!("{other:?}"),
                    "held or centred",
                ));
            }
        };
        axis.segment = match raw.simulation.segment.as_deref() {
            None | Some("whole") => None,
            Some(text) => Some(self.positive("simulation.segment", text, &[Dimension::TIME])?),
        };
        let Some(raw) = &raw.controller else {
            return Ok(());
        };
        let integral = match (raw.kind.as_str(), &raw.integral_gain) {
            ("p-p", None) => None,
            ("p-pi", Some(text)) => Some(self.gain("controller.integral_gain", text)?),
            ("p-p", Some(text)) => {
                let allowed = "p-p has none; kind = \"p-pi\" has one";
                return Err(self.refuse("controller.integral_gain", format!("{text:?}"), allowed));
            }
            ("p-pi", None) => {
                let allowed = "p-pi needs integral_gain, such as \"2e5 N/m\"";
                return Err(self.refuse("controller.kind", "\"p-pi\"".into(), allowed));
            }
            (other, _) => {
                let allowed = "p-p (P position, P speed) or p-pi (P position, PI speed)";
                return Err(self.refuse("controller.kind", format!("{other:?}"), allowed));
            }
        };
        let share = raw.velocity_feedforward.unwrap_or(0.0);
        if !(0.0..=1.0).contains(&share) {
            let allowed = "a number from 0 (none) to 1 (the whole reference speed)";
            return Err(self.refuse(
                "controller.velocity_feedforward",
                share.to_string(),
                allowed,
            ));
        }
        let optional = |key: &str, text: &Option<String>| {
            text.as_ref().map(|text| self.gain(key, text)).transpose()
        };
        axis.controller = Some(ControllerValues {
            position_gain: self.positive(
                "controller.position_gain",
                &raw.position_gain,
                &[Dimension::FREQUENCY],
            )?,
            speed_gain: self.gain("controller.speed_gain", &raw.speed_gain)?,
            integral_gain: integral,
            velocity_feedforward: share,
            mass_feedforward: optional("controller.mass_feedforward", &raw.mass_feedforward)?,
            force_limit: optional("controller.force_limit", &raw.force_limit)?,
            rate: match &raw.rate {
                Some(text) => {
                    Some(self.positive("controller.rate", text, &[Dimension::FREQUENCY])?)
                }
                None => None,
            },
        });
        Ok(())
    }

    /// A value above 0 whose unit can be judged only with the log.
    fn gain(&self, key: &str, text: &str) -> Result<Gain, Error> {
        let value = Value::parse(text).map_err(|e| self.refuse(key, e.found, &e.allowed))?;
        if value.number <= 0.0 {
            return Err(self.refuse(key, format!("{text:?}"), "a finite value above 0"));
        }
        Ok(Gain {
            place: self.place(key),
            value,
        })
    }

    fn value(&self, key: &str, text: &str, dimensions: &[Dimension]) -> Result<f64, Error> {
        let value = Value::parse(text).map_err(|e| self.refuse(key, e.found, &e.allowed))?;
        let mut found = String::new();
        let mut allowed: Vec<String> = Vec::new();
        for &dimension in dimensions {
            match value.si_of(dimension) {
                Ok(x) => {
                    self.tie(key, text, dimension);
                    return Ok(x);
                }
                Err(e) => {
                    found = e.found;
                    allowed.push(e.allowed);
                }
            }
        }
        Err(self.refuse(key, found, &allowed.join("; or ")))
    }

    /// Remembers a value whose dimension does not fit every axis.
    fn tie(&self, key: &str, text: &str, dimension: Dimension) {
        let free = [Dimension::TIME, Dimension::FREQUENCY, Dimension::ONE];
        if !free.contains(&dimension) {
            self.tied.borrow_mut().push(Tied {
                place: self.place(key),
                text: format!("{text:?}"),
                dimension,
            });
        }
    }

    fn positive(&self, key: &str, text: &str, dimensions: &[Dimension]) -> Result<f64, Error> {
        let x = self.value(key, text, dimensions)?;
        if x > 0.0 && x.is_finite() {
            return Ok(x);
        }
        Err(self.refuse(key, format!("{text:?}"), "a finite value above 0"))
    }

    fn refuse(&self, key: &str, found: String, allowed: &str) -> Error {
        Error::Config {
            file: self.file.to_path_buf(),
            place: self.place(key),
            found,
            allowed: allowed.into(),
        }
    }

    /// Line and key, as errors begin.
    fn place(&self, key: &str) -> String {
        // `columns.force.unit` stands on the line of `columns.force` where it is an inline table.
        let parent = key.rsplit_once('.').map_or(key, |(parent, _)| parent);
        let line = raw::line_of(self.text, key).or_else(|| raw::line_of(self.text, parent));
        match line {
            Some(line) => format!("line {line}, {key}: "),
            None => format!("{key}: "),
        }
    }
}
