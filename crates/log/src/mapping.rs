//! Which column is what: plain data that says how a [`Table`] becomes a [`Log`](crate::Log), and
//! the detection of whatever it leaves open.
//!
//! # What is recognised without an axis file
//! A column is recognised by the words of its name (`Position`, `act_vel`, `MAIN.fActTorque`,
//! `qm`, `t`); a unit that measures something else rules a column out. Words such as `cmd`,
//! `target`, `reference` make it a reference: the position reference is kept as such, a commanded
//! force stands in only where no measured one exists. Columns about errors, limits and states are
//! passed over, and so are columns without a unit that hold 0 and 1 alone: flags. Where names say nothing,
//! the only column in a unit of length (angle, velocity, force, torque) is taken. Two columns that fit equally well are refused, unless they are equal
//! sample by sample, or all but one of them never change. A column that never changes is taken where its name says so as no other's
//! does, and never for its unit alone. Motion and force are of one axis: beside `X act` and `X current`, `Y act` is a position
//! too, and the one is taken whose force is named. Columns that a mapping names are taken as named; only what it leaves
//! open is filled in: time where neither time nor rate is given, force where none is given,
//! position and velocity only where neither is given, and acceleration, reference, temperature and load where the mapping does
//! not say that there is none. A reference in the unit in which the file has a named position is read as that one is, and both it
//! and an acceleration turn with the sign of a named motion; where such a column does not fit, it is left out.
//!
//! # Missing units
//! * A unit in the mapping takes precedence over the unit in the file; a difference is a finding.
//! * **time**: seconds, if the median spacing is then 1 us to 0.2 s, as motion logs have. Otherwise
//!   refused: sample numbers and milliseconds look alike.
//! * **position, velocity, force**: if no unit is given anywhere, in the file or in the
//!   mapping, SI is assumed and a finding says so (a MATLAB file has no place for units). If some
//!   are given and this one is not, it is refused: partly labelled files hide factors of a thousand.
//!   Seconds that a reader has made of time stamps are no unit that is given.
//! * **counts** follow from a scale such as `1 um/count`.
//! * **reference** takes the unit of the position, **temperature** degrees Celsius, **load** a plain
//!   number; findings say so.
//!
//! # Linear or rotary
//! From the mapping; else from the unit of position, velocity or force; else, where units are
//! assumed, from the names (`torque`, `angle`, `force`, `displacement`); else refused.
//!
//! Error texts quote `axis.toml` as: top-level `kind`, `rate`; table `[columns]` with a name, a
//! number counted from 1, or `{ column, unit, scale, invert, sign }` for each quantity, `enable` with `{ column, equals }`; table `[log]` with
//! `crop`, `rests`, `wrap`, `resolution`, `force_limit`.

mod bases;
mod channel;
mod choose;
mod complete;
mod convert;
mod counted;
mod describe;
mod drive;
pub(crate) mod enable;
mod endings;
mod flags;
mod joints;
mod limits;
mod motion;
mod names;
mod offered;
pub(crate) mod parts;
mod rate;
mod select;
mod servos;
mod still;
mod understood;
mod wanted;

use crate::findings::{Finding, full};
use crate::{Error, Kind, Table};
pub use bases::OwnStamps;
pub use channel::{Channel, Motion, Role, Selector, Sign};
pub(crate) use choose::clear;
pub(crate) use complete::time_source;
pub(crate) use convert::{Source, another_unit};
pub(crate) use drive::Gain;
pub use drive::{BACK_EMFS, Drive, FORCE_CONSTANTS, PositionLoop, RESISTANCES, SUPPLIES};
pub use enable::Enable;
pub use joints::{JointColumns, assume_units, joints};
pub use limits::{FORCE_LIMITS, RATES, RESOLUTIONS, SCALES, WRAP_COUNTS, WRAPS};
pub use names::is_commanded;
pub use parts::Parts;
pub(crate) use select::select;
pub use servos::{SERVOS, Servo, servo};
pub use understood::{Assumed, Understood};
pub(crate) use wanted::wanted;

/// A position that wraps after some travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrap {
    /// Travel after which the position repeats, m or rad; 1e-9 to 1e9.
    Travel(f64),
    /// Counts after which the counter repeats, such as 65536 of 16 bits, signed or not; 2 to 2^53. For a position column in counts.
    Counts(f64),
}

impl Wrap {
    /// A position that runs from `-limit` to `+limit` (m or rad, above 0).
    pub fn at(limit: f64) -> Self {
        Wrap::Travel(2.0 * limit)
    }
}

/// What becomes of the rests at the ends of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rests {
    /// Fits of the whole record leave them out.
    Cut,
    /// They are fitted as the rest of the record.
    Keep,
}

/// How a table is to be read; `Mapping::default()` leaves everything to detection.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapping {
    /// Linear or rotary; from units where `None`.
    pub motion: Option<Motion>,
    /// Samples a second (Hz, 1e-3 to 1e9) where the table has no time column.
    pub rate_hz: Option<f64>,
    /// Time column.
    pub time: Option<Channel>,
    /// Position column.
    pub position: Option<Channel>,
    /// Velocity column.
    pub velocity: Option<Channel>,
    /// Column of a measured acceleration.
    pub acceleration: Option<Channel>,
    /// Column of force, torque, or the current or voltage proportional to it.
    pub force: Option<Channel>,
    /// The motor, where the column holds its current, voltage or duty; `None` takes the column as it is.
    pub drive: Option<Drive>,
    /// Column of the reference (commanded) position.
    pub reference: Option<Channel>,
    /// Temperature column.
    pub temperature: Option<Channel>,
    /// Column of the normal load.
    pub load: Option<Channel>,
    /// Force or torque that acts on the axis from outside, towards positive position.
    pub external: Option<Channel>,
    /// Those of [`Role::OPTIONAL`] that no column has, whatever it is called.
    pub absent: Vec<Role>,
    /// Column that says in which rows the axis is enabled, or in which mode it is; `None` keeps every row.
    pub enable: Option<Enable>,
    /// Where the position wraps.
    pub wrap: Option<Wrap>,
    /// First and last second to keep, counted from the first sample of the file.
    pub crop: Option<(f64, f64)>,
    /// Parts of that to keep; `None` keeps all.
    pub parts: Option<Parts>,
    /// What becomes of rests at the ends; `None` cuts them where no crop is given.
    pub rests: Option<Rests>,
    /// Encoder step, m or rad; estimated from the data where `None`.
    pub resolution: Option<f64>,
    /// Force at which drive or sensor saturates, in the unit of the log's force; above 0.
    pub force_limit: Option<f64>,
}

impl Mapping {
    /// The channel of this role, where one is given.
    pub fn channel(&self, role: Role) -> Option<&Channel> {
        match role {
            Role::Time => self.time.as_ref(),
            Role::Position => self.position.as_ref(),
            Role::Velocity => self.velocity.as_ref(),
            Role::Acceleration => self.acceleration.as_ref(),
            Role::Force => self.force.as_ref(),
            Role::Reference => self.reference.as_ref(),
            Role::Temperature => self.temperature.as_ref(),
            Role::Load => self.load.as_ref(),
            Role::External => self.external.as_ref(),
        }
    }

    /// Gives a role another channel.
    pub fn set(&mut self, role: Role, channel: Channel) {
        *self.slot(role) = Some(channel);
    }

    fn slot(&mut self, role: Role) -> &mut Option<Channel> {
        match role {
            Role::Time => &mut self.time,
            Role::Position => &mut self.position,
            Role::Velocity => &mut self.velocity,
            Role::Acceleration => &mut self.acceleration,
            Role::Force => &mut self.force,
            Role::Reference => &mut self.reference,
            Role::Temperature => &mut self.temperature,
            Role::Load => &mut self.load,
            Role::External => &mut self.external,
        }
    }

    /// What a table's names and units say by themselves.
    ///
    /// # Errors
    /// As [`Mapping::complete`].
    pub fn detect(table: &Table) -> Result<Detected, Error> {
        Self::default().complete(table)
    }

    /// The columns whose role is clear, each by itself, with the unit that the file gives it; for a table that
    /// [`Mapping::detect`] refuses.
    pub fn clear_columns(table: &Table) -> Self {
        choose::clear(table)
    }

    /// Which columns of a table this mapping may take, of which only names and units are known yet: those that it names, and
    /// those that could be what it leaves open. With the samples of these alone it understands the table as with all of them.
    pub fn wanted(&self, heads: &Table) -> Vec<bool> {
        wanted::by_mapping(self, heads)
    }

    /// Whether a table has every column that this mapping gives a role.
    pub fn is_of(&self, table: &Table) -> bool {
        let mut named = Role::ALL
            .into_iter()
            .filter_map(|role| Some((role, self.channel(role)?)));
        named.all(|(role, channel)| select::select(table, &channel.column, role).is_ok())
    }

    /// This mapping with everything it leaves open filled in from the table: every channel then has
    /// a unit, and the kind of motion is known.
    ///
    /// # Errors
    /// [`Kind::Ambiguous`] with the choices, [`Kind::Missing`] with what there is, [`Kind::Unit`]
    /// for units that are unknown or do not fit, [`Kind::Value`] for numbers out of range; each
    /// with lines for `axis.toml` that settle it.
    pub fn complete(&self, table: &Table) -> Result<Detected, Error> {
        self.check_numbers()?;
        complete::complete(self, table)
    }

    fn check_numbers(&self) -> Result<(), Error> {
        // Wide enough for any machine, narrow enough that no sum overflows.
        let [travel, counts] = match self.wrap {
            Some(Wrap::Travel(travel)) => [Some(travel), None],
            Some(Wrap::Counts(counts)) => [None, Some(counts)],
            None => [None; 2],
        };
        let bounded = [
            ("rate", "rate", self.rate_hz, RATES, "Hz"),
            ("wrap period", "log.wrap", travel, WRAPS, "m or rad"),
            ("wrap period", "log.wrap", counts, WRAP_COUNTS, "counts"),
            (
                "resolution",
                "log.resolution",
                self.resolution,
                RESOLUTIONS,
                "m or rad",
            ),
            (
                "force limit",
                "log.force_limit",
                self.force_limit,
                FORCE_LIMITS,
                "the unit of the force",
            ),
        ];
        for (name, key, value, range, unit) in bounded {
            if let Some(value) = value.filter(|x| !range.contains(x)) {
                let (low, high) = (range.start(), range.end());
                let found = format!("{name} is {}", full(value));
                let allowed = format!("it has to be from {low:e} to {high:e}, in {unit}");
                return Err(Error::new(Kind::Value, found, allowed).of_setting(key));
            }
        }
        let good = |a: f64, b: f64| a.is_finite() && a >= 0.0 && a < b;
        if let Some((from, to)) = self.crop.filter(|(a, b)| !good(*a, *b)) {
            let found = format!("crop is {} to {}", full(from), full(to));
            let allowed = "crop takes two times in s from the first sample, from 0 on, the first less than the second";
            return Err(Error::new(Kind::Value, found, allowed).of_setting("log.crop"));
        }
        let mut stretches = self.parts.iter().flat_map(|parts| parts.stretches());
        if let Some((from, to)) = stretches.find(|(a, b)| !good(*a, *b)) {
            let found = format!("a part is {} to {}", full(*from), full(*to));
            let allowed =
                "two times in s from the first sample, from 0 on, the first less than the second";
            return Err(Error::new(Kind::Value, found, allowed).of_setting(parts::KEY));
        }
        Ok(())
    }
}

/// A mapping with nothing left open, and what had to be assumed for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Detected {
    /// The complete mapping.
    pub mapping: Mapping,
    /// How each column was understood, in words: `force = column 5 "Torque [N m]", unit N m`.
    pub phrases: Vec<String>,
    /// What had to be assumed.
    pub findings: Vec<Finding>,
    /// What became of every column of the table, in order.
    pub columns: Vec<Understood>,
}
