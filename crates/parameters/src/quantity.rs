//! What a parameter is, whichever direction of motion it belongs to.

use crate::{Allowed, Dimension};
use std::borrow::Cow;

/// The part of a wave along the stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wave {
    /// Amplitude of the sine.
    Sine,
    /// Amplitude of the cosine.
    Cosine,
}

/// What a parameter is, in the order of tables; elements and waves are counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// Bristle stiffness sigma0; of a Maxwell-slip law the sum over its elements.
    Sigma0,
    /// Micro-damping sigma1.
    Sigma1,
    /// Viscous friction sigma2.
    Sigma2,
    /// Viscous friction that grows with the square of the speed.
    QuadraticViscous,
    /// Coulomb level Fc.
    Coulomb,
    /// Static level Fs.
    Static,
    /// Stribeck velocity vs.
    StribeckVelocity,
    /// Stribeck exponent delta.
    StribeckExponent,
    /// Break-away part of the steady deflection, elasto-plastic.
    BreakawayRatio,
    /// Rate at which a slipping element follows the Stribeck curve, 1/s.
    Attraction,
    /// Moving mass or inertia.
    Mass,
    /// Constant force F0.
    Offset,
    /// Delay of the force against the motion.
    Delay,
    /// Stiffness of a Maxwell-slip element.
    ElementStiffness(u32),
    /// Deflection at which a Maxwell-slip element yields.
    ElementYield(u32),
    /// Force at which a Maxwell-slip element yields.
    ElementForce(u32),
    /// Gravity of a rotary axis.
    Gravity(Wave),
    /// Cogging of the first, second, ... pitch.
    Cogging(u32, Wave),
    /// Coulomb level per normal load.
    CoulombLoad,
    /// Coulomb level per temperature.
    CoulombTemperature,
    /// Coulomb level along the stroke.
    CoulombPosition,
    /// Wave of the Coulomb level of the first, second, ... pitch.
    CoulombPitch(u32, Wave),
    /// Coulomb level per transmitted force or torque.
    CoulombTransmitted,
    /// What is added to that while the load drives the axis.
    CoulombDriven,
    /// Viscous friction per temperature.
    Sigma2Temperature,
    /// Coulomb level of the second, third, ... log beyond that of the first.
    CoulombLog(u32),
    /// Micro-damping of the second, third, ... log beyond that of the first.
    Sigma1Log(u32),
    /// Viscous friction of the second, third, ... log beyond that of the first.
    Sigma2Log(u32),
    /// Load at which the parameters hold.
    LoadReference,
    /// Temperature at which the parameters hold.
    TemperatureReference,
    /// Position at which the parameters hold.
    PositionReference,
    /// Transmitted force or torque at which the parameters hold.
    TransmittedReference,
}

/// Quantities with one fixed name, that name, their symbol and what they are in words.
const PLAIN: [(Quantity, &str, &str, &str); 23] = [
    (Quantity::Sigma0, "sigma0", "σ₀", "bristle stiffness"),
    (Quantity::Sigma1, "sigma1", "σ₁", "micro-damping"),
    (Quantity::Sigma2, "sigma2", "σ₂", "viscous friction"),
    (
        Quantity::QuadraticViscous,
        "quadratic_viscous",
        "σ₂₂",
        "quadratic viscous friction",
    ),
    (Quantity::Coulomb, "coulomb", "Fc", "Coulomb friction"),
    (Quantity::Static, "static", "Fs", "static friction"),
    (
        Quantity::StribeckVelocity,
        "stribeck_velocity",
        "vs",
        "Stribeck velocity",
    ),
    (
        Quantity::StribeckExponent,
        "stribeck_exponent",
        "δ",
        "Stribeck exponent",
    ),
    (
        Quantity::BreakawayRatio,
        "breakaway_ratio",
        "zba/zss",
        "break-away part of the steady deflection",
    ),
    (
        Quantity::Attraction,
        "attraction",
        "a",
        "attraction of slip to the Stribeck curve",
    ),
    (Quantity::Mass, "mass", "M", "moving mass"),
    (Quantity::Offset, "offset", "F₀", "constant force"),
    (
        Quantity::Delay,
        "delay",
        "τ",
        "delay of the force against the motion",
    ),
    (
        Quantity::CoulombLoad,
        "coulomb_load",
        "∂Fc/∂N",
        "Coulomb friction per normal load",
    ),
    (
        Quantity::CoulombTemperature,
        "coulomb_temperature",
        "∂Fc/∂T",
        "Coulomb friction per temperature",
    ),
    (
        Quantity::CoulombPosition,
        "coulomb_position",
        "∂Fc/∂x",
        "Coulomb friction along the stroke",
    ),
    (
        Quantity::CoulombTransmitted,
        "coulomb_transmitted",
        "Kt",
        "Coulomb friction per transmitted force",
    ),
    (
        Quantity::CoulombDriven,
        "coulomb_driven",
        "Kd",
        "the same where the load drives, beyond that",
    ),
    (
        Quantity::Sigma2Temperature,
        "sigma2_temperature",
        "∂σ₂/∂T",
        "viscous friction per temperature",
    ),
    (
        Quantity::LoadReference,
        "load_reference",
        "N₀",
        "mean normal load",
    ),
    (
        Quantity::TemperatureReference,
        "temperature_reference",
        "T₀",
        "mean temperature",
    ),
    (
        Quantity::PositionReference,
        "position_reference",
        "x₀",
        "middle of the stroke",
    ),
    (
        Quantity::TransmittedReference,
        "transmitted_reference",
        "τ₀",
        "mean transmitted force",
    ),
];

impl Quantity {
    fn plain(self) -> Option<&'static (Quantity, &'static str, &'static str, &'static str)> {
        PLAIN.iter().find(|entry| entry.0 == self)
    }

    /// Name as written to files, without the suffix of a direction.
    pub fn stem(self) -> Cow<'static, str> {
        if let Some(entry) = self.plain() {
            return entry.1.into();
        }
        let part = |wave| match wave {
            Wave::Sine => "sin",
            Wave::Cosine => "cos",
        };
        match self {
            Quantity::ElementStiffness(k) => format!("stiffness_{k}").into(),
            Quantity::ElementYield(k) => format!("yield_{k}").into(),
            Quantity::ElementForce(k) => format!("element_{k}").into(),
            Quantity::Gravity(wave) => format!("gravity_{}", part(wave)).into(),
            Quantity::Cogging(k, wave) => format!("cogging{k}_{}", part(wave)).into(),
            Quantity::CoulombPitch(k, wave) => format!("coulomb_pitch{k}_{}", part(wave)).into(),
            Quantity::CoulombLog(k) => format!("coulomb_log{k}").into(),
            Quantity::Sigma1Log(k) => format!("sigma1_log{k}").into(),
            Quantity::Sigma2Log(k) => format!("sigma2_log{k}").into(),
            // Every other quantity stands in the list.
            _ => "".into(),
        }
    }

    /// The quantity of such a name.
    pub fn from_stem(stem: &str) -> Option<Self> {
        if let Some(entry) = PLAIN.iter().find(|entry| entry.1 == stem) {
            return Some(entry.0);
        }
        // As it is written: no sign, no leading zero.
        let number = |text: &str| {
            let digits = text.bytes().all(|b| b.is_ascii_digit()) && !text.starts_with('0');
            digits.then(|| text.parse::<u32>().ok()).flatten()
        };
        let wave = |of: &str| {
            let rest = stem.strip_prefix(of)?;
            let (number_text, wave) = match rest.strip_suffix("_sin") {
                Some(number) => (number, Wave::Sine),
                None => (rest.strip_suffix("_cos")?, Wave::Cosine),
            };
            Some((number(number_text)?, wave))
        };
        let element = |of: &str| number(stem.strip_prefix(of)?);
        match stem {
            "gravity_sin" => Some(Quantity::Gravity(Wave::Sine)),
            "gravity_cos" => Some(Quantity::Gravity(Wave::Cosine)),
            _ => element("stiffness_")
                .map(Quantity::ElementStiffness)
                .or_else(|| element("yield_").map(Quantity::ElementYield))
                .or_else(|| element("element_").map(Quantity::ElementForce))
                .or_else(|| element("coulomb_log").map(Quantity::CoulombLog))
                .or_else(|| element("sigma1_log").map(Quantity::Sigma1Log))
                .or_else(|| element("sigma2_log").map(Quantity::Sigma2Log))
                .or_else(|| wave("cogging").map(|(k, part)| Quantity::Cogging(k, part)))
                .or_else(|| wave("coulomb_pitch").map(|(k, part)| Quantity::CoulombPitch(k, part))),
        }
    }

    /// Symbol in Unicode; the name where there is none.
    pub fn symbol(self) -> Cow<'static, str> {
        let numbered = |letter: &str, k: u32| {
            let digits = k.to_string();
            let below = digits.bytes().map(|b| {
                char::from_u32(0x2080 + u32::from(b - b'0')).unwrap_or('₀') // subscript digits
            });
            let mut out = String::from(letter);
            out.extend(below);
            Cow::Owned(out)
        };
        match self {
            Quantity::ElementStiffness(k) => numbered("k", k),
            Quantity::ElementYield(k) => numbered("d", k),
            Quantity::ElementForce(k) => numbered("W", k),
            _ => self
                .plain()
                .map_or_else(|| self.stem(), |entry| entry.2.into()),
        }
    }

    /// What it is, in the words of the field; a mass is `moving mass`, also where it is an inertia.
    pub fn meaning(self) -> &'static str {
        match self {
            Quantity::ElementStiffness(_) => "stiffness of an element",
            Quantity::ElementYield(_) => "deflection at which the element yields",
            Quantity::ElementForce(_) => "force at which the element yields",
            Quantity::Gravity(Wave::Sine) => "gravity, sin q",
            Quantity::Gravity(Wave::Cosine) => "gravity, cos q",
            Quantity::Cogging(..) => "cogging",
            Quantity::CoulombPitch(..) => "Coulomb friction, wave along the stroke",
            Quantity::CoulombLog(_) => "Coulomb friction of a log, less that of the first",
            Quantity::Sigma1Log(_) => "micro-damping of a log, less that of the first",
            Quantity::Sigma2Log(_) => "viscous friction of a log, less that of the first",
            _ => self.plain().map_or("", |entry| entry.3),
        }
    }

    /// What it measures.
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::Sigma0 | Quantity::ElementStiffness(_) | Quantity::CoulombPosition => {
                Dimension::Stiffness
            }
            Quantity::Sigma1
            | Quantity::Sigma2
            | Quantity::Sigma1Log(_)
            | Quantity::Sigma2Log(_) => Dimension::Damping,
            Quantity::QuadraticViscous => Dimension::QuadraticDamping,
            Quantity::Coulomb
            | Quantity::Static
            | Quantity::Offset
            | Quantity::ElementForce(_)
            | Quantity::Gravity(_)
            | Quantity::Cogging(..)
            | Quantity::CoulombPitch(..)
            | Quantity::CoulombLog(_)
            | Quantity::TransmittedReference => Dimension::Force,
            Quantity::StribeckVelocity => Dimension::Speed,
            Quantity::StribeckExponent
            | Quantity::BreakawayRatio
            | Quantity::CoulombTransmitted
            | Quantity::CoulombDriven => Dimension::One,
            Quantity::Attraction => Dimension::Rate,
            Quantity::Mass => Dimension::Inertia,
            Quantity::Delay => Dimension::Time,
            Quantity::ElementYield(_) | Quantity::PositionReference => Dimension::Length,
            Quantity::CoulombLoad => Dimension::ForcePerLoad,
            Quantity::CoulombTemperature => Dimension::ForcePerTemperature,
            Quantity::Sigma2Temperature => Dimension::DampingPerTemperature,
            Quantity::LoadReference => Dimension::Load,
            Quantity::TemperatureReference => Dimension::Temperature,
        }
    }

    /// The values that it may have.
    pub fn allowed(self) -> Allowed {
        match self {
            Quantity::Sigma0
            | Quantity::Sigma1
            | Quantity::Sigma2
            | Quantity::Coulomb
            | Quantity::Static
            | Quantity::Mass
            | Quantity::ElementStiffness(_)
            | Quantity::ElementYield(_)
            | Quantity::ElementForce(_) => Allowed::NotNegative,
            Quantity::StribeckVelocity | Quantity::Attraction => Allowed::Positive,
            Quantity::StribeckExponent => Allowed::Exponent,
            Quantity::BreakawayRatio => Allowed::Share,
            Quantity::Delay => Allowed::Delay,
            _ => Allowed::Any,
        }
    }

    /// Place in tables. What stands beside the law shares the last place and keeps the order in which it came.
    pub fn place(self) -> usize {
        const ORDER: [Quantity; 13] = [
            Quantity::Sigma0,
            Quantity::Sigma1,
            Quantity::Sigma2,
            Quantity::QuadraticViscous,
            Quantity::Coulomb,
            Quantity::Static,
            Quantity::StribeckVelocity,
            Quantity::StribeckExponent,
            Quantity::BreakawayRatio,
            Quantity::Attraction,
            Quantity::Mass,
            Quantity::Offset,
            Quantity::Delay,
        ];
        let found = ORDER.iter().position(|known| *known == self);
        found.unwrap_or(ORDER.len())
    }

    /// Whether an asymmetric model may have a value for each direction of motion.
    pub fn may_differ_by_side(self) -> bool {
        self.is_of_the_steady_curve()
            || matches!(
                self,
                Quantity::QuadraticViscous
                    | Quantity::CoulombLoad
                    | Quantity::CoulombTemperature
                    | Quantity::CoulombPosition
                    | Quantity::CoulombPitch(..)
                    | Quantity::CoulombTransmitted
                    | Quantity::CoulombDriven
                    | Quantity::Sigma2Temperature
            )
    }

    /// Whether it is one of the numbers of the steady curve that an asymmetric law has for each direction: Fc, Fs, vs and
    /// sigma2.
    pub fn is_of_the_steady_curve(self) -> bool {
        matches!(
            self,
            Quantity::Coulomb | Quantity::Static | Quantity::StribeckVelocity | Quantity::Sigma2
        )
    }

    /// Whether it describes the shape of a bristle or of the Stribeck curve: sigma0, sigma1, Fs, vs and the exponent.
    pub fn is_of_the_shape(self) -> bool {
        matches!(
            self,
            Quantity::Sigma0
                | Quantity::Sigma1
                | Quantity::Static
                | Quantity::StribeckVelocity
                | Quantity::StribeckExponent
        )
    }

    /// Whether it belongs to one of several logs rather than to the machine.
    pub fn is_of_a_log(self) -> bool {
        matches!(
            self,
            Quantity::CoulombLog(_) | Quantity::Sigma1Log(_) | Quantity::Sigma2Log(_)
        )
    }

    /// Whether it is that of a single Maxwell-slip element.
    pub fn is_of_an_element(self) -> bool {
        matches!(
            self,
            Quantity::ElementStiffness(_) | Quantity::ElementYield(_) | Quantity::ElementForce(_)
        )
    }
}
