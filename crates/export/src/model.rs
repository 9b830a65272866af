//! The model that is exported.

use crate::{Domain, Draws, Error, range, terms};
use stiction_friction::compensator::{
    Adaptation, Compensator, Friction, Settings, Source, Terms, Watchdog,
};
use stiction_friction::{Damping, ElastoPlastic, LuGre, Real};

/// Speed, m/s (rad/s), that stands for the limit of zero: the level at it is the static friction to rounding.
pub(crate) const ALMOST_STANDSTILL: f64 = 1e-300;

/// A friction law with the settings of its compensator, and where its numbers came from. The law is driven by the
/// reference velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Name of the axis, any text.
    pub title: String,
    /// What the names in the code begin with; see [`identifier`](crate::identifier).
    pub identifier: String,
    /// Rotary: rad; else linear: m.
    pub rotary: bool,
    /// Unit of the force: `N` (`N m`), or the unit of the drive, such as `A`; `1` where it is a fraction of a rated value. The
    /// limit, the law and the output are in this unit.
    pub force_unit: String,
    /// The law. The micro-damping of bristles is exported capped, whatever form it has here.
    pub friction: Friction<f64>,
    /// What friction depends on beside the velocity, and what is fed forward beside it; of its default nothing. Beside a weight
    /// the law has no offset.
    pub terms: Terms<f64>,
    /// Unit of the load, where friction depends on it.
    pub load_unit: String,
    /// Gap between motor and load, if there is one.
    pub backlash: Option<Backlash>,
    /// Settings of the compensator.
    pub settings: Settings<f64>,
    /// Force that the motor is rated for, in the unit of the force; needed by targets that write per mille of it.
    pub rated_force: Option<f64>,
    /// Largest speed of the recordings that it was identified on, m/s (rad/s), if known.
    pub top_speed: Option<f64>,
    /// Parameters as they were identified.
    pub parameters: Vec<Parameter>,
    /// What simulators take, with ranges.
    pub domain: Domain,
    /// Draws from those ranges, for `domain-json`, `mujoco`, `isaaclab`, `newton` and `bam`.
    pub draws: Option<Draws>,
    /// Sentences for the head of every file, such as warnings about the parameters.
    pub notes: Vec<String>,
    /// Where the numbers came from.
    pub provenance: Provenance,
}

/// A gap between motor and load, with the encoder on the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backlash {
    /// Lost motion, m (rad) of the axis, above 0.
    pub width: f64,
    /// 95 % interval of the width; `None` where it was measured otherwise.
    pub interval: Option<[f64; 2]>,
    /// The load, as a part of the moving mass, above 0 and below 1, if known.
    pub load: Option<f64>,
    /// Positions that the log has seen, m (rad), if known.
    pub range: Option<[f64; 2]>,
}

/// A parameter as identified.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, such as `sigma0`.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// 95 % interval, if the data bound it.
    pub interval: Option<[f64; 2]>,
    /// Whether the data determine it.
    pub identifiable: bool,
    /// Whether it was given, not identified.
    pub given: bool,
}

/// Where the numbers came from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// Version of stiction.
    pub version: String,
    /// SHA-256 of the model file.
    pub model_sha256: String,
    /// Recordings with their SHA-256.
    pub inputs: Vec<(String, String)>,
}

impl Model {
    /// The compensator that the exported code is, in a number type. `number_type` is its name in the target,
    /// if there is one.
    pub(crate) fn compensator<T: Real>(
        &self,
        settings: &Settings<f64>,
        number_type: impl Into<Option<&'static str>>,
    ) -> Result<Compensator<T>, Error> {
        let number_type = number_type.into();
        range::check(self, settings.limit, number_type)?;
        let refuse = |e| Error::number(number_type, e);
        let friction = match &self.friction {
            Friction::LuGre(law) => capped(law).map(Friction::LuGre),
            Friction::ElastoPlastic(law) => capped(law.bristle())
                .and_then(|bristle| ElastoPlastic::new(bristle, law.breakaway()))
                .map(Friction::ElastoPlastic),
            law => Ok(*law),
        };
        let friction = friction.and_then(|law| law.cast());
        let friction = friction.map_err(refuse)?;
        let compensator =
            Compensator::new(friction, Source::Reference, cast(settings)).map_err(refuse)?;
        match terms::has(&self.terms) {
            true => compensator
                .with_terms(terms::cast(&self.terms))
                .map_err(refuse),
            false => Ok(compensator),
        }
    }

    /// The compensator that the exported code is, as a Rust value to be stepped once a cycle.
    ///
    /// # Errors
    /// As [`export`](crate::export): for numbers or settings out of range.
    pub fn in_rust(&self) -> Result<Compensator<f64>, Error> {
        self.compensator(&self.settings, None)
    }

    /// Unit of velocity.
    pub(crate) fn speed_unit(&self) -> &'static str {
        if self.rotary { "rad/s" } else { "m/s" }
    }

    /// Unit of acceleration.
    pub(crate) fn acceleration_unit(&self) -> &'static str {
        if self.rotary { "rad/s^2" } else { "m/s^2" }
    }

    /// Unit of position.
    pub(crate) fn length_unit(&self) -> &'static str {
        if self.rotary { "rad" } else { "m" }
    }

    /// Unit of the load, as it is written.
    pub(crate) fn load_unit(&self) -> String {
        match self.load_unit.as_str() {
            "1" | "" => "the unit of the log".into(),
            unit => crate::header::plain(unit),
        }
    }

    /// Unit of force, as it is written.
    pub(crate) fn force_unit(&self) -> &str {
        match self.force_unit.as_str() {
            "1" => "p.u.",
            unit => unit,
        }
    }

    /// Whether the force is a fraction of a rated value.
    pub(crate) fn is_share(&self) -> bool {
        self.force_unit == "1"
    }

    /// Whether the unit of the force is the SI unit of force or torque.
    pub(crate) fn in_newtons(&self) -> bool {
        self.force_unit == if self.rotary { "N m" } else { "N" }
    }

    /// Name of the law's family.
    pub(crate) fn law(&self) -> &'static str {
        match self.friction {
            Friction::Coulomb(_) => "coulomb-viscous",
            Friction::Stribeck(_) => "stribeck",
            Friction::LuGre(_) => "lugre",
            Friction::ElastoPlastic(_) => "elasto-plastic",
            Friction::Gms(law) if law.attraction().is_finite() => "gms",
            Friction::Gms(_) => "maxwell-slip",
        }
    }

    /// The steady force at a velocity, m/s (rad/s), with quadratic viscous friction.
    pub(crate) fn steady(&self, v: f64) -> f64 {
        let levels = self.terms.levels.unwrap_or_default();
        self.steady_of_law(v) + levels.quadratic_force(self.friction.viscous(), v)
    }

    /// That of the law alone.
    pub(crate) fn steady_of_law(&self, v: f64) -> f64 {
        match &self.friction {
            Friction::Coulomb(law) => law.force(v),
            _ => self.friction.curve().map_or(0.0, |curve| curve.force(v)),
        }
    }

    /// The larger steady force of the two directions at a speed, with the offset; at standstill the limit as the speed goes to 0.
    pub(crate) fn larger(&self, speed: f64) -> f64 {
        let v = speed.max(ALMOST_STANDSTILL);
        self.steady(v).abs().max(self.steady(-v).abs())
    }

    /// The least speed at which a force is beyond the limit, m/s (rad/s), if that is below 1e4; 0 for standstill.
    pub(crate) fn saturates_from(&self, force: &dyn Fn(f64) -> f64) -> Option<f64> {
        let beyond = |speed: f64| force(speed) > self.settings.limit;
        let speed = |k: i32| libm::pow(10.0, -6.0 + 0.01 * f64::from(k));
        let first = (0..=1000).find(|k| beyond(speed(*k)))?;
        if first == 0 {
            return Some(0.0);
        }
        let (mut low, mut high) = (speed(first - 1), speed(first));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *if beyond(middle) { &mut high } else { &mut low } = middle;
        }
        Some(high)
    }

    /// The larger Stribeck velocity, m/s (rad/s); 0 where the level does not fall.
    pub(crate) fn stribeck_velocity(&self) -> f64 {
        let Some(curve) = self.friction.curve() else {
            return 0.0;
        };
        let falls = [curve.positive(), curve.negative()]
            .into_iter()
            .filter(|side| side.static_friction > side.coulomb);
        falls.fold(0.0, |most, side| most.max(side.stribeck_velocity))
    }

    /// Largest force of the law at low speed, in its unit: the scale of its errors.
    pub(crate) fn scale(&self) -> f64 {
        self.friction.scale()
    }
}

/// The law with its micro-damping capped, as it is exported.
fn capped(law: &LuGre<f64>) -> Result<LuGre<f64>, stiction_friction::ParamError> {
    law.with_damping(Damping::Capped(law.damping().at_rest()))
}

/// Settings in another number type. An unlimited slew stays unlimited.
pub(crate) fn cast<T: Real>(settings: &Settings<f64>) -> Settings<T> {
    let to = T::from_f64;
    Settings {
        cycle_time: to(settings.cycle_time),
        gain: to(settings.gain),
        dead_zone: to(settings.dead_zone),
        limit: to(settings.limit),
        slew: if settings.slew >= T::MAX.to_f64() {
            T::MAX
        } else {
            to(settings.slew)
        },
        ramp: to(settings.ramp),
        adaptation: settings.adaptation.map(|a| Adaptation {
            memory: to(a.memory),
            range: to(a.range),
            mass: to(a.mass),
        }),
        watchdog: settings.watchdog.map(|w| Watchdog {
            window: to(w.window),
            ratio: to(w.ratio),
        }),
    }
}
