//! Effects that a residual shows.

use std::fmt;
use stiction_codes::Code;
use stiction_number::{Percent, four_digits, short};

/// What an effect is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says; the variant says what changes.
pub enum What {
    Drift,
    Position,
    LevelWave,
    Load,
    Temperature,
    /// A force that repeats with the position; whether it has another pitch than in the fit.
    Ripple {
        another_pitch: bool,
    },
    SpringForce,
    /// Motor and load vibrate; the cut-off below which the axis is rigid, Hz.
    Resonance {
        at_load: bool,
        rigid: f64,
    },
    Backlash,
    /// The force was smoothed before it was logged, or after.
    Dynamics {
        logged: bool,
    },
    Clocks,
    Limit,
    Mass,
    Delay,
    Bristles,
    Curve,
    /// Encoder counts prefer another exponent of the Stribeck curve.
    Exponent(f64),
}

impl What {
    /// The code that its page is named by.
    pub fn code(self) -> Code {
        match self {
            Self::Drift => Code::FrictionDrift,
            Self::Position | Self::LevelWave => Code::PositionDependence,
            Self::Load => Code::LoadDependence,
            Self::Temperature => Code::TemperatureDependence,
            Self::Ripple { .. } => Code::PositionRipple,
            Self::SpringForce => Code::SpringForce,
            Self::Resonance { .. } => Code::Resonance,
            Self::Backlash => Code::Backlash,
            Self::Dynamics { .. } => Code::UnmodelledDynamics,
            Self::Clocks => Code::ClocksApart,
            Self::Limit => Code::ForceNotGiven,
            Self::Mass => Code::MassDisagrees,
            Self::Delay => Code::DelayDisagrees,
            Self::Bristles | Self::Curve | Self::Exponent(_) => Code::LawShape,
        }
    }

    /// What to do where no line of the axis file and no law describes it.
    #[rustfmt::skip] // One line a sentence.
    fn remedy(self) -> String {
        match self {
            Self::Resonance { rigid, .. } => return format!("Record with less acceleration, or set common_cutoff = \"{} Hz\" under [conditioning] in the axis file: below that the axis is rigid, and levels and mass are right", four_digits(rigid)),
            Self::Drift => "Record the axis warmed up, or record its temperature too",
            Self::Position | Self::LevelWave => "Record within the working range of the axis",
            Self::Load | Self::Temperature => "Record under the working conditions of the axis",
            Self::Backlash => "To check, hold the motor and push the load to and fro; preload the drive train, or record motion that does not cross the gap",
            Self::Dynamics { .. } => "Log the force that acts, unfiltered, such as the measured current",
            Self::Clocks => "Record both with one clock",
            Self::Limit => "Log the measured current, or record with less acceleration",
            Self::Mass => "Write mass = \"fit\" in its place in the axis file",
            Self::Delay => "Write delay = \"fit\" in its place under [terms] in the axis file",
            Self::Ripple { .. } | Self::SpringForce | Self::Bristles | Self::Curve | Self::Exponent(_) => "The friction curve of the result holds whatever the law",
        }
        .into()
    }
}

impl fmt::Display for What {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Drift => "friction drifts during the log",
            Self::Position => "friction changes along the stroke",
            Self::LevelWave => "the friction level repeats with the position",
            Self::Load => "friction changes with the load",
            Self::Temperature => "friction changes with the temperature",
            Self::Ripple { another_pitch: true } => "the force ripple has another pitch than in the fit",
            Self::Ripple { another_pitch: false } => "a force repeats with the position",
            Self::SpringForce => "a force changes with the position, like that of a spring, a cable chain or a weight",
            Self::Resonance { at_load: true, .. } => "motor and load vibrate against each other, the encoder on the load",
            Self::Resonance { at_load: false, .. } => "motor and load vibrate against each other, the encoder on the motor",
            Self::Backlash => "backlash between motor and load",
            Self::Dynamics { logged: true } => "unmodelled dynamics between force and motion, such as a filter of the logged force, a spring or backlash",
            Self::Dynamics { logged: false } => "the axis feels the force later and smoother than it was logged, as behind a slow current loop",
            Self::Clocks => "force and motion were stamped by two clocks that drift apart",
            Self::Limit => "the drive gave less than the logged force",
            Self::Mass => "the mass differs from that of the axis file",
            Self::Delay => "the delay differs from that of the axis file",
            Self::Bristles => "friction after a reversal is not described by this law",
            Self::Curve => "friction over speed is not described by this law",
            Self::Exponent(exponent) => return write!(f, "encoder counts prefer a Stribeck curve with an exponent of {exponent}"),
        })
    }
}

/// How large an effect is.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Extent {
    pub name: String,
    pub value: f64,
    pub unit: String,
    /// Half of its 95 % interval, as a part of it, where that is known.
    pub about: Option<f64>,
}

/// What takes an effect into the fit.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum Remedy {
    /// Lines of a table of the axis file.
    Set { lines: String, table: String },
    /// Another law.
    Law(String),
}

/// A part of the residual that an effect explains.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says; dimensionless.
pub struct Explained {
    pub of_residual: f64,
    pub of_force: f64,
}

impl fmt::Display for Explained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = |part: f64| Percent::error(100.0 * part).digits(2);
        let (residual, force) = (part(self.of_residual), part(self.of_force));
        write!(
            f,
            "explains {residual} of the residual, {force} of the force"
        )
    }
}

/// An effect that a residual shows.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Effect {
    pub what: What,
    pub extents: Vec<Extent>,
    pub explained: Option<Explained>,
    pub remedy: Option<Remedy>,
}

impl Effect {
    /// The code that its page is named by.
    pub fn code(&self) -> Code {
        self.what.code()
    }

    /// What it is, how large, and what to do.
    pub(crate) fn words(&self) -> String {
        let extents: Vec<String> = self.extents.iter().map(ToString::to_string).collect();
        let extents = match extents.is_empty() {
            true => String::new(),
            false => format!(" ({})", extents.join(", ")),
        };
        let explained = self.explained.map_or(String::new(), |e| format!(": {e}"));
        let then = match &self.remedy {
            Some(Remedy::Set { lines, table }) => {
                format!("Set {lines} under [{table}] in the axis file")
            }
            Some(Remedy::Law(law)) => format!("Try the law {law}"),
            None => self.what.remedy(),
        };
        format!("{}{extents}{explained}. {then}", self.what)
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ", self.name.replace('_', " "))?;
        match self.unit.as_str() {
            "%" => write!(f, "{} %", short(self.value))?,
            "" => f.write_str(&four_digits(self.value))?,
            unit => write!(f, "{} {unit}", four_digits(self.value))?,
        }
        match self.about {
            Some(about) => write!(f, " ± {}", Percent::error(100.0 * about).digits(2)),
            None => Ok(()),
        }
    }
}
