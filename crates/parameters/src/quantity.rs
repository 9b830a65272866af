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
#[non_exhaustive]
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
    /// Part of a map of the Coulomb level over the stroke: the first a straight line from -1 to 1, the others cosines of half a
    /// wave, a whole one, ...
    CoulombMap(u32),
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
    /// Length of the stroke over which the Coulomb level has a map.
    PositionStroke,
    /// Transmitted force or torque at which the parameters hold.
    TransmittedReference,
}

/// A quantity with one fixed name.
struct Plain {
    quantity: Quantity,
    stem: &'static str,
    symbol: &'static str,
    meaning: &'static str,
    dimension: Dimension,
    allowed: Allowed,
}

/// A row each, in the order of tables.
macro_rules! rows {
    ($($quantity:ident $stem:literal $symbol:literal $meaning:literal $dimension:ident $allowed:ident)*) => {
        &[$(Plain {
            quantity: Quantity::$quantity,
            stem: $stem,
            symbol: $symbol,
            meaning: $meaning,
            dimension: Dimension::$dimension,
            allowed: Allowed::$allowed,
        }),*]
    };
}

const PLAIN: &[Plain] = rows! {
    Sigma0               "sigma0"                "σ₀"      "bristle stiffness"                           Stiffness             NotNegative
    Sigma1               "sigma1"                "σ₁"      "micro-damping"                               Damping               NotNegative
    Sigma2               "sigma2"                "σ₂"      "viscous friction"                            Damping               NotNegative
    QuadraticViscous     "quadratic_viscous"     "σ₂₂"     "quadratic viscous friction"                  QuadraticDamping      Any
    Coulomb              "coulomb"               "Fc"      "Coulomb friction"                            Force                 NotNegative
    Static               "static"                "Fs"      "static friction"                             Force                 NotNegative
    StribeckVelocity     "stribeck_velocity"     "vs"      "Stribeck velocity"                           Speed                 Positive
    StribeckExponent     "stribeck_exponent"     "δ"       "Stribeck exponent"                           One                   Exponent
    BreakawayRatio       "breakaway_ratio"       "zba/zss" "break-away part of the steady deflection"    One                   Share
    Attraction           "attraction"            "a"       "attraction of slip to the Stribeck curve"    Rate                  Positive
    Mass                 "mass"                  "M"       "moving mass"                                 Inertia               NotNegative
    Offset               "offset"                "F₀"      "constant force"                              Force                 Any
    Delay                "delay"                 "τ"       "delay of the force against the motion"       Time                  Delay
    CoulombLoad          "coulomb_load"          "∂Fc/∂N"  "Coulomb friction per normal load"            ForcePerLoad          Any
    CoulombTemperature   "coulomb_temperature"   "∂Fc/∂T"  "Coulomb friction per temperature"            ForcePerTemperature   Any
    CoulombPosition      "coulomb_position"      "∂Fc/∂x"  "Coulomb friction along the stroke"           Stiffness             Any
    CoulombTransmitted   "coulomb_transmitted"   "Kt"      "Coulomb friction per transmitted force"      One                   Any
    CoulombDriven        "coulomb_driven"        "Kd"      "the same where the load drives, beyond that" One                   Any
    Sigma2Temperature    "sigma2_temperature"    "∂σ₂/∂T"  "viscous friction per temperature"            DampingPerTemperature Any
    LoadReference        "load_reference"        "N₀"      "mean normal load"                            Load                  Any
    TemperatureReference "temperature_reference" "T₀"      "mean temperature"                            Temperature           Any
    PositionReference    "position_reference"    "x₀"      "middle of the stroke"                        Length                Any
    PositionStroke       "position_stroke"       "ℓ"       "length of the stroke"                        Length                Positive
    TransmittedReference "transmitted_reference" "τ₀"      "mean transmitted force"                      Force                 Any
};

/// Quantities that have a place of their own in tables; those beside the law follow.
const OF_THE_LAW: usize = 13;

impl Quantity {
    fn plain(self) -> Option<&'static Plain> {
        PLAIN.iter().find(|row| row.quantity == self)
    }

    /// Name as written to files, without the suffix of a direction.
    pub fn stem(self) -> Cow<'static, str> {
        if let Some(row) = self.plain() {
            return row.stem.into();
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
            Quantity::CoulombMap(k) => format!("coulomb_map{k}").into(),
            Quantity::CoulombLog(k) => format!("coulomb_log{k}").into(),
            Quantity::Sigma1Log(k) => format!("sigma1_log{k}").into(),
            Quantity::Sigma2Log(k) => format!("sigma2_log{k}").into(),
            // Every other quantity stands in the list.
            _ => "".into(),
        }
    }

    /// The quantity of such a name.
    #[doc(hidden)]
    pub fn from_stem(stem: &str) -> Option<Self> {
        if let Some(row) = PLAIN.iter().find(|row| row.stem == stem) {
            return Some(row.quantity);
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
                .or_else(|| element("coulomb_map").map(Quantity::CoulombMap))
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
                .map_or_else(|| self.stem(), |row| row.symbol.into()),
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
            Quantity::CoulombMap(_) => "Coulomb friction, part of its map over the stroke",
            Quantity::CoulombLog(_) => "Coulomb friction of a log, less that of the first",
            Quantity::Sigma1Log(_) => "micro-damping of a log, less that of the first",
            Quantity::Sigma2Log(_) => "viscous friction of a log, less that of the first",
            _ => self.plain().map_or("", |row| row.meaning),
        }
    }

    /// What it measures.
    #[doc(hidden)]
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::ElementStiffness(_) => Dimension::Stiffness,
            Quantity::ElementYield(_) => Dimension::Length,
            Quantity::Sigma1Log(_) | Quantity::Sigma2Log(_) => Dimension::Damping,
            _ => self.plain().map_or(Dimension::Force, |row| row.dimension),
        }
    }

    /// The values that it may have.
    #[doc(hidden)]
    pub fn allowed(self) -> Allowed {
        if self.is_of_an_element() {
            return Allowed::NotNegative;
        }
        self.plain().map_or(Allowed::Any, |row| row.allowed)
    }

    /// Place in tables. What stands beside the law shares the last place and keeps the order in which it came.
    #[doc(hidden)]
    pub fn place(self) -> usize {
        let found = PLAIN.iter().position(|row| row.quantity == self);
        found.map_or(OF_THE_LAW, |place| place.min(OF_THE_LAW))
    }

    /// Whether an asymmetric model may have a value for each direction of motion.
    #[doc(hidden)]
    pub fn may_differ_by_side(self) -> bool {
        self.is_of_the_steady_curve()
            || matches!(
                self,
                Quantity::QuadraticViscous
                    | Quantity::CoulombLoad
                    | Quantity::CoulombTemperature
                    | Quantity::CoulombPosition
                    | Quantity::CoulombPitch(..)
                    | Quantity::CoulombMap(_)
                    | Quantity::CoulombTransmitted
                    | Quantity::CoulombDriven
                    | Quantity::Sigma2Temperature
            )
    }

    /// Whether it is one of the numbers of the steady curve that an asymmetric law has for each direction: Fc, Fs, vs and
    /// sigma2.
    #[doc(hidden)]
    pub fn is_of_the_steady_curve(self) -> bool {
        matches!(
            self,
            Quantity::Coulomb | Quantity::Static | Quantity::StribeckVelocity | Quantity::Sigma2
        )
    }

    /// Whether it describes the shape of a bristle or of the Stribeck curve: sigma0, sigma1, Fs, vs and the exponent.
    #[doc(hidden)]
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
    #[doc(hidden)]
    pub fn is_of_a_log(self) -> bool {
        matches!(
            self,
            Quantity::CoulombLog(_) | Quantity::Sigma1Log(_) | Quantity::Sigma2Log(_)
        )
    }

    /// Whether it says where other parameters hold, and is given.
    #[doc(hidden)]
    pub fn is_a_reference(self) -> bool {
        matches!(
            self,
            Quantity::LoadReference
                | Quantity::TemperatureReference
                | Quantity::PositionReference
                | Quantity::PositionStroke
                | Quantity::TransmittedReference
        )
    }

    /// Whether it is that of a single Maxwell-slip element.
    #[doc(hidden)]
    pub fn is_of_an_element(self) -> bool {
        matches!(
            self,
            Quantity::ElementStiffness(_) | Quantity::ElementYield(_) | Quantity::ElementForce(_)
        )
    }
}
