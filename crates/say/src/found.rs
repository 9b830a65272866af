//! What is wrong, odd or worth knowing about a recording.

use std::fmt;
use stiction_codes::Code;
use stiction_number::{Percent, counted, full, short};

/// A number with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The number, in that unit.
    pub number: f64,
    /// Its unit as people write it.
    pub unit: String,
}

impl Value {
    /// A number with its unit.
    pub fn new(number: f64, unit: impl Into<String>) -> Self {
        let unit = unit.into();
        Self { number, unit }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", short(self.number), self.unit)
    }
}

/// A sample of a log, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Sample {
    pub number: usize,
    pub seconds: f64,
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sample {} ({} s)", self.number, short(self.seconds))
    }
}

/// How large a column or the time step is.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum Size {
    TimeStep(Value),
    Travel(&'static str, Value),
    MeanSpeed(&'static str, Value),
    Largest(&'static str, Value),
}

impl Size {
    /// The number with its unit.
    pub fn value(&self) -> &Value {
        match self {
            Self::TimeStep(v) => v,
            Self::Travel(_, v) | Self::MeanSpeed(_, v) | Self::Largest(_, v) => v,
        }
    }
}

impl fmt::Display for Size {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TimeStep(v) => write!(f, "the median time step is {v}"),
            Self::Travel(channel, v) => write!(f, "{channel} travels {v} in all"),
            Self::MeanSpeed(channel, v) => write!(f, "{channel} moves with {v} on average"),
            Self::Largest(channel, v) => write!(f, "{channel} is {v} at most"),
        }
    }
}

/// Why a position jumps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Jump {
    /// A counter of so many counts overflows.
    Counter(u64),
    /// An angle begins again after each turn.
    Turn,
    /// Single counts were lost or garbled.
    Stray,
    /// Unknown.
    Unknown,
}

/// What turns the sign of a force that brakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The axis file does not invert it.
    Invert,
    /// The axis file inverts it already.
    Undo,
    /// The clock of the file that it comes from comes first.
    Clock,
    /// This log is a validation, and the fitted logs have the right sign.
    Validation,
}

/// What shows that an axis moves while its position is frozen.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // The travel that it shows.
pub enum Moving {
    Velocity(Value),
    Jump(Value),
    Reference(Value),
}

/// How two signals that show one motion differ.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum Mismatch {
    /// They are hardly correlated over so many samples at a time.
    Uncorrelated { correlation: f64, samples: usize },
    /// One is a multiple of the other, for which a unit may be the cause.
    Ratio {
        ratio: f64,
        cause: Option<&'static str>,
    },
}

/// What becomes of samples at rest at the ends of a record.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum AtRest {
    /// They are kept for a key of the axis file.
    Kept { key: &'static str },
    /// The force varies in them.
    Varying,
    /// They are left out, from and to, s.
    Cut {
        seconds: Vec<[f64; 2]>,
        samples: usize,
        part: f64,
    },
}

/// What was done about missing cells.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum Mended {
    Excluded { interpolated: usize, dropped: usize },
    Bridged { holes: f64 },
}

/// Why a channel is left out.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum Useless {
    /// None of its cells is a number.
    Empty { channel: &'static str },
    /// Too much of it is missing in long stretches.
    Holes {
        channel: &'static str,
        cells: usize,
        of: usize,
        part: f64,
    },
    /// Most of it is no course.
    Scattered(Dropout),
}

impl fmt::Display for Useless {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { channel } => write!(f, "{channel} has no numbers"),
            Self::Holes { channel, cells, of, part } => write!(f, "{channel}: {cells} of {} missing, {} of the record in gaps longer than an eighth of it (at most half)", counted(*of, "cell"), percent(*part)),
            Self::Scattered(dropout) => write!(f, "{dropout}; between rows it may change by {}, and at least half of it must do so", dropout.step),
        }
    }
}

/// Cells of a temperature or load that no sensor measured.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Dropout {
    pub channel: &'static str,
    pub times: usize,
    pub rows: usize,
    /// First data row, counted from 1.
    pub first: usize,
    pub column: String,
    pub number: String,
    /// Most that it may change from row to row.
    pub step: Value,
}

impl fmt::Display for Dropout {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { channel, first, column, number, .. } = self;
        write!(f, "{channel} jumps away and back {} for {}, first in data row {first} of column {column}: {number}", counted(self.times, "time"), counted(self.rows, "row"))
    }
}

/// Zeros that an export wrote for missing samples.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Zeros {
    pub channel: &'static str,
    pub largest: f64,
    pub cells: usize,
    pub of: usize,
    /// First data row of the part that is kept, counted from 1.
    pub first: usize,
}

impl fmt::Display for Zeros {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { channel, largest, cells, of, first } = self;
        let nearly = if *largest == 0.0 { String::new() } else { format!(" or practically 0 (at most {})", short(*largest)) };
        write!(f, "{channel} is 0{nearly} in {cells} of {} ({}), first in data row {first} of the part that is kept, between samples far from 0", counted(*of, "sample"), percent(*cells as f64 / *of as f64))
    }
}

/// Why the wrap of a position is probably wrong.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum WrongWrap {
    /// The wrap is one count short of those of a counter.
    Bits { bits: u32, right: u64 },
    /// The counter shows more counts than the wrap.
    Counts { shown: f64, right: Option<u64> },
    /// It covers more than the wrap without a jump.
    Beyond { covers: Value },
    /// It covers more than the wrap, and jumps by another travel.
    Jumps { covers: Value, jump: Value },
    /// Jumps are left after unwrapping.
    Left { left: Value, jump: Value },
}

/// What names the force of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // A field is what its name says: a line of the axis file.
pub enum ForceLine {
    Column { line: String, open_unit: bool },
    OtherFile,
    Nanometres { column: String, line: String },
    Counts { column: String, line: String },
}

/// Something found about a recording. Parts are dimensionless, 1 is all; channels and columns go by their names, lines are those of
/// an axis file.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says; the variant says of what.
#[rustfmt::skip] // One line a kind.
pub enum Found {
    /// Samples are missing between time stamps.
    Gaps { gaps: usize, missing: usize, longest: f64, after: Sample, splits: usize },
    /// Time steps vary.
    Jitter { step: f64, rms: f64, worst: f64, at: Sample },
    /// Time stamps are rounded, and the rows are at one rate; a line where none is missing.
    RoundedStamps { tick: f64, rate: f64, line: Option<String> },
    /// Rows have no time stamp.
    NoStamps { rows: usize, first: usize },
    /// Rows repeat the time stamp of the row before.
    RepeatedStamps { rows: usize, first: usize, seconds: f64 },
    /// The same, of a clock that is coarser than the sampling.
    CountedRows { rows: usize, first: usize, tick: f64, rate: f64 },
    /// The time counter overflowed.
    TimeOverflow { size: f64, times: usize, first: usize },
    /// Cells are missing; among them those beyond any measurement: how many, the first number, its data row.
    Missing { channel: &'static str, cells: usize, of: usize, first: usize, implausible: Option<(usize, String, usize)>, done: Mended },
    /// A channel is of no use.
    LeftOut(Useless),
    /// Zeros stand for missing samples.
    ZeroFilled(Zeros),
    /// A temperature is at or below absolute zero.
    BelowAbsoluteZero { rows: usize, of: usize, first: usize, column: String, number: String },
    /// A temperature or load jumps away and back.
    Dropout(Dropout),
    /// A column ends before the others.
    ShortColumn { channel: &'static str, samples: usize, longest: usize },
    /// Rows in which the axis is not enabled are left out.
    NotEnabled { column: String, enabled: String, rows: usize, of: usize, places: usize, seconds: [f64; 2] },
    /// A column that says enabled is not used.
    EnableIgnored { column: String, status_word: bool, line: String },
    /// Negative counts were written without a sign.
    Unsigned { channel: &'static str, bits: u32 },
    /// The force was logged so many rows after its motion, or before it.
    ForceLate { rows: isize, seconds: f64 },
    /// The force was logged behind a low-pass.
    ForceLowPass { seconds: f64 },
    /// The force was logged as a mean.
    ForceMean { rows: usize },
    /// The position changes every few rows only.
    HeldPosition { rows: usize, rate: f64 },
    /// A position with a wrap: how often it wrapped and at which sample first.
    Wrapped { wraps: Option<(usize, usize)>, period: Value, reference: bool, wrong: Option<WrongWrap> },
    /// The position jumps.
    Jumps { jumps: usize, size: Value, after: Sample, cause: Jump },
    /// The position is quantised.
    Quantised { step: f64, range: f64, unit: String, given: bool },
    /// The travel is few encoder steps.
    FewSteps { steps: f64 },
    /// The position is frozen while the axis moves.
    Stuck { stretches: usize, samples: usize, moving: Moving, first: Sample },
    /// An angle in radians has the steps of an encoder in degrees.
    StepsOfDegrees { place: String, column: String, step: f64, bits: u32 },
    /// A size that no machine has.
    UnlikelySize { size: Size, usual: [f64; 2], column: String, unit: String, line: String },
    /// A motion faster and harder than that of any servo axis; the column and unit of the time, if any.
    NoServo { channel: &'static str, speed: Value, acceleration: Value, most: [Value; 2], column: String, unit: String, time: Option<(String, String)>, line: String },
    /// The force is at a limit.
    Saturated { limit: Value, samples: usize, stretches: usize, first: Sample },
    /// Single forces are far beyond all others.
    Outliers { samples: usize, times: f64, force: Value, first: Sample },
    /// The force is zero while the axis moves.
    ForceDead { stretches: usize, samples: usize, first: Sample, until: f64 },
    /// The force has few steps; so few values that no parameter is a constant.
    CoarseForce { step: Value, range: f64, few: bool },
    /// The force does negative work.
    ForceBrakes { part: f64, turn: Turn },
    /// The P gain, or the supply, V, of a servo's loop is the usual one, since nothing states it.
    ServoAssumed { kp: Option<f64>, supply: Option<f64> },
    /// The force is a magnitude, and whether the log has a reference.
    Magnitude { reference: bool },
    /// A force on a rotary axis, or a torque on a linear one.
    ForceUnit { unit: String, motion: String, wanted: String },
    /// The force is a voltage.
    ForceIsVoltage { wanted: String, unit: String },
    /// The force is in a unit that is no force.
    Uncalibrated { dimension: String, wanted: String, per: Option<String> },
    /// No column is a force.
    NoForce { columns: String, line: ForceLine },
    /// Velocity and the derivative of the position differ.
    Velocity(Mismatch),
    /// Acceleration and the second derivative of the position differ.
    Acceleration(Mismatch),
    /// The record is short.
    FewSamples { samples: usize, least: usize },
    /// The axis does not move.
    NoMotion { channel: &'static str, range: Value },
    /// Neighbouring samples are hardly correlated.
    Noise { channel: &'static str },
    /// The axis moves in one direction only.
    OneDirection { range: Value },
    /// The axis moves at one speed.
    OneSpeed { speed: Value },
    /// A column never changes.
    Constant { channel: &'static str, value: f64 },
    /// The axis stands still at the start until a time, at the end from a time, s.
    RestAtEnds { until: Option<f64>, from: Option<f64>, then: AtRest },
    /// The axis stands still between motions; in some of these rests the force varies.
    RestBetween { rests: usize, part: f64, longest: f64, from: f64, varying: usize },
    /// A column was joined from another file; the rows kept where it is slower.
    Joined { channel: &'static str, file: String, offset: f64, rates: [f64; 2], thinned: bool, rows: usize, outside: usize, unused: usize },
    /// The time offset of another file was estimated.
    Offset { channel: &'static str, file: String, columns: String, seconds: String, half_width: f64, explained: f64 },
    /// File and axis file give different units.
    UnitOverride { channel: &'static str, recording: String, axis_file: String },
    /// Units were assumed: each with its channel.
    UnitsAssumed(Vec<String>),
    /// A unit has several meanings.
    UnitConvention { channel: &'static str, unit: String, meaning: &'static str },
    /// Rows are missing between the time stamps, which a given rate does not count.
    RateSkipsRows { column: String, seconds: f64, rate: f64 },
    /// Rows are missing between the stamps of a coarse clock; the longest stretch without, s.
    RateSkipsGaps { column: String, rate: f64, crop: [f64; 2] },
    /// Time stamps without a unit contradict a given rate.
    StampsUnread { column: String, rate: f64, unit: String, stamped: f64, line: String },
    /// The file states another sample time.
    RateDiffers { rate: f64, step: f64 },
}

impl Found {
    /// The code that its page is named by.
    pub fn code(&self) -> Code {
        match self {
            Self::Gaps { .. } => Code::Gap,
            Self::Jitter { .. } | Self::RoundedStamps { .. } => Code::Jitter,
            Self::NoStamps { .. } => Code::TimeMissing,
            Self::RepeatedStamps { .. } | Self::CountedRows { .. } => Code::DuplicateTime,
            Self::TimeOverflow { .. } => Code::TimeWrap,
            Self::LeftOut(Useless::Scattered(_))
            | Self::BelowAbsoluteZero { .. }
            | Self::Dropout(_) => Code::SensorDropout,
            Self::Missing { .. } | Self::LeftOut(_) => Code::MissingCells,
            Self::ZeroFilled(_) => Code::ZeroFilled,
            Self::ShortColumn { .. } => Code::ShortColumn,
            Self::NotEnabled { .. } => Code::NotEnabled,
            Self::EnableIgnored { .. } => Code::EnableIgnored,
            Self::Unsigned { .. } => Code::UnsignedCounts,
            Self::ForceLate { rows, .. } if *rows > 0 => Code::ForceLate,
            Self::ForceLate { .. } => Code::MotionLate,
            Self::ForceLowPass { .. } | Self::ForceMean { .. } => Code::ForceFiltered,
            Self::HeldPosition { .. } => Code::HeldPosition,
            Self::Wrapped { .. } => Code::PositionWrap,
            Self::Jumps { .. } => Code::PositionJump,
            Self::Quantised { .. } => Code::Quantisation,
            Self::FewSteps { .. } => Code::CoarsePosition,
            Self::Stuck { .. } => Code::StuckEncoder,
            Self::StepsOfDegrees { .. } | Self::UnlikelySize { .. } | Self::NoServo { .. } => {
                Code::UnlikelySize
            }
            Self::Saturated { .. } => Code::Saturation,
            Self::Outliers { .. } => Code::ForceSpike,
            Self::ForceDead { .. } => Code::ForceDead,
            Self::CoarseForce { .. } => Code::CoarseForce,
            Self::ForceBrakes { .. } | Self::Magnitude { .. } => Code::ForceSign,
            Self::ForceUnit { .. } => Code::ForceUnit,
            Self::ForceIsVoltage { .. } | Self::Uncalibrated { .. } | Self::ServoAssumed { .. } => {
                Code::ForceNotCalibrated
            }
            Self::NoForce { .. } => Code::NoForce,
            Self::Velocity(_) => Code::VelocityMismatch,
            Self::Acceleration(_) => Code::AccelerationMismatch,
            Self::FewSamples { .. } => Code::FewSamples,
            Self::NoMotion { .. } => Code::NoMotion,
            Self::Noise { .. } => Code::NoiseOnly,
            Self::OneDirection { .. } => Code::OneDirection,
            Self::OneSpeed { .. } => Code::ConstantVelocity,
            Self::Constant { .. } => Code::ConstantColumn,
            Self::RestAtEnds { .. } => Code::RestAtEnd,
            Self::RestBetween { .. } => Code::RestBetween,
            Self::Joined { .. } => Code::Joined,
            Self::Offset { .. } => Code::OffsetEstimated,
            Self::UnitOverride { .. } => Code::UnitOverride,
            Self::UnitsAssumed(_) => Code::UnitAssumed,
            Self::UnitConvention { .. } => Code::UnitConvention,
            Self::RateSkipsRows { .. }
            | Self::RateSkipsGaps { .. }
            | Self::StampsUnread { .. }
            | Self::RateDiffers { .. } => Code::RateOverride,
        }
    }

    /// Whether time steps vary.
    pub fn is_jitter(&self) -> bool {
        matches!(self, Self::Jitter { .. } | Self::RoundedStamps { .. })
    }

    /// Whether force and motion were not logged together, or the force smoothed.
    pub fn is_force_moved(&self) -> bool {
        matches!(self, Self::ForceLate { .. }) || self.is_force_smoothed()
    }

    /// Whether the force was logged smoothed.
    pub fn is_force_smoothed(&self) -> bool {
        matches!(self, Self::ForceLowPass { .. } | Self::ForceMean { .. })
    }

    /// Whether a unit is probably wrong.
    pub fn is_unlikely_size(&self) -> bool {
        matches!(
            self,
            Self::StepsOfDegrees { .. } | Self::UnlikelySize { .. } | Self::NoServo { .. }
        )
    }

    /// The sentence, with the name that the axis file has.
    #[rustfmt::skip] // One line a sentence.
    pub fn words(&self, axis: &str) -> String {
        match self {
            Self::Gaps { gaps, missing, longest, after, splits } => format!("{} with {} missing, the longest {} s, first after {after}{}", counted(*gaps, "gap"), counted(*missing, "sample"), short(*longest), if *splits > 0 { format!(". The record is split at {}", counted(*splits, "gap")) } else { String::new() }),
            Self::Jitter { step, rms, worst, at } => format!("time steps deviate from their median of {} s by {} s rms ({}), at most {} s at {at}", short(*step), short(*rms), percent(rms / step), short(*worst)),
            Self::RoundedStamps { tick, line: Some(line), .. } => format!("time stamps are rounded to {} s, but rows are equally spaced. In {axis}, delete time under [columns] and write above it {line}", short(*tick)),
            Self::RoundedStamps { tick, rate, line: None } => format!("time stamps are rounded to {} s; the rows are at {rate} Hz, and some are missing", short(*tick)),
            Self::NoStamps { rows, first } => format!("{} without a time stamp, first data row {first}: dropped", counted(*rows, "row")),
            Self::RepeatedStamps { rows, first, seconds } => format!("{} with the time stamp of the row before, first data row {first} at {} s: dropped", counted(*rows, "row"), short(*seconds)),
            Self::CountedRows { rows, first, tick, rate } => format!("{} with the time stamp of the row before, first data row {first}: time stamps are rounded to {} s, and the rows are counted at {rate} Hz", counted(*rows, "row"), short(*tick)),
            Self::TimeOverflow { size, times, first } => format!("the time counter overflowed at {size} {}, first in data row {first}: unwrapped", counted(*times, "time")),
            Self::Missing { channel, cells, of, first, implausible, done } => {
                let among = implausible.as_ref().map_or(String::new(), |(cells, number, row)| format!(", {cells} of them implausibly large, such as {number} in data row {row}"));
                let done = match done {
                    Mended::Excluded { interpolated, dropped: 0 } if *interpolated > 0 => "interpolated and excluded".to_string(),
                    Mended::Excluded { interpolated: 0, .. } => "dropped with their rows".to_string(),
                    Mended::Excluded { interpolated, dropped } => format!("{interpolated} interpolated and excluded, {dropped} dropped with their rows"),
                    Mended::Bridged { holes } if *holes > 0.0 => format!("interpolated in time, although {} of the record is in gaps longer than an eighth of it", percent(*holes)),
                    Mended::Bridged { .. } => "interpolated in time".to_string(),
                };
                format!("{channel}: {} of {of} missing, first in data row {first} of the part that is kept{among}: {done}", counted(*cells, "cell"))
            }
            Self::LeftOut(why) => format!("{why}; it is left out"),
            Self::ZeroFilled(zeros) => format!("{zeros}. The export wrote 0 for missing samples: these are not fitted"),
            Self::BelowAbsoluteZero { rows, of, first, column, number } => format!("temperature is at or below 0 K (-273.15 degC) in {rows} of {}, first in data row {first} of column {column}: {number}. These cells are taken as missing", counted(*of, "row")),
            Self::Dropout(dropout) => format!("{dropout}. The sensor dropped out (between rows it may change by {}): these cells are taken as missing", dropout.step),
            Self::ShortColumn { channel, samples, longest } => format!("{channel} has {}, other columns up to {longest}: the record is cut to {samples}", counted(*samples, "sample")),
            Self::NotEnabled { column, enabled, rows, of, places, seconds: [from, to] } => format!("column {column} is not {enabled} in {rows} of {}, at {}, first from {} to {} s of the part that is kept. These rows are left out, and the record is split there", counted(*of, "row"), counted(*places, "place"), short(*from), short(*to)),
            Self::EnableIgnored { column, status_word: false, line } => format!("column {column} is 0 in some rows, and all rows are used: while an axis is disabled, its force does not move it. If 1 means enabled, leave out the others: in {axis}, under [columns], write {line}"),
            Self::EnableIgnored { column, status_word: true, line } => format!("column {column} is a status word in which operation is not enabled in some rows (bits other than xxxx xxxx x01x 0111), and all rows are used: while an axis is disabled, its force does not move it. Leave those rows out: in {axis}, under [columns], write {line}"),
            Self::Unsigned { channel, bits } => format!("{channel} has whole numbers near 0 and near {largest} only, as a counter of {bits} bits without its sign: {largest} is read as -1", largest = (1_u64 << bits) - 1),
            Self::ForceLate { rows, seconds } => match rows { 1.. => format!("the force was logged about {} ({} ms) later than its motion: each row takes the force from that much later", counted(rows.unsigned_abs(), "row"), short(1e3 * seconds)), _ => format!("the motion was logged about {} ({} ms) later than its force: each row takes the force from that much earlier", counted(rows.unsigned_abs(), "row"), short(1e3 * seconds)) },
            Self::ForceLowPass { seconds } => format!("the force was logged behind a first-order low-pass with a time constant of about {} ms, which smears every reversal: the force before the filter is computed and used", short(1e3 * seconds)),
            Self::ForceMean { rows } => format!("the force was logged as a mean over about {}, which smears every reversal: the force before the mean is computed and used", counted(*rows, "row")),
            Self::HeldPosition { rows, rate } => format!("the position is updated only every {rows} rows: the rows between are left out, their forces averaged, and the log is read at {} Hz. For constants of the machine, log at the rate of the encoder, or log the position that the controller uses", full(*rate)),
            Self::Wrapped { wraps, period, reference, wrong } => {
                let likewise = |word: &str| if *reference { format!("; the reference {word}") } else { String::new() };
                let done = match wraps {
                    Some((wraps, first)) => format!("position wraps {}, first at sample {first}: unwrapped with a period of {period}{}", counted(*wraps, "time"), likewise("likewise")),
                    None => format!("position never wraps (no step is longer than half the wrap of {period}): nothing was unwrapped{}", likewise("was")),
                };
                let write = |right: &Option<u64>| right.map_or("correct wrap".to_string(), |right| format!("write wrap = \"{right} counts\""));
                let wrong = match wrong {
                    None => String::new(),
                    Some(WrongWrap::Bits { bits, right }) => format!(". But a counter of {bits} bits wraps after {right} counts: {} under [log] in {axis}", write(&Some(*right))),
                    Some(WrongWrap::Counts { shown, right }) => format!(". But it shows {} counts, more than the wrap: {} under [log] in {axis}", full(*shown), write(right)),
                    Some(WrongWrap::Beyond { covers }) => format!(". But it covers {covers} without a jump, more than the wrap: correct wrap under [log] in {axis}, or delete it"),
                    Some(WrongWrap::Jumps { covers, jump }) => format!(". But it covers {covers}, more than the wrap, and jumps by {jump}: correct wrap under [log] in {axis}, or delete it"),
                    Some(WrongWrap::Left { left, jump }) => format!(". But jumps of {left} are left, and it jumped by {jump}: correct wrap under [log] in {axis}, or delete it"),
                };
                format!("{done}{wrong}")
            }
            Self::Jumps { jumps, size, after, cause: Jump::Stray } => format!("position steps {} far from the steps before and after, first by {size} after {after}: counts were lost or garbled. The record is split there", counted(*jumps, "time")),
            Self::Jumps { jumps, size, after, cause } => {
                let cure = match cause {
                    Jump::Counter(counts) => format!("This is {}: write wrap = \"{counts} counts\" under [log] in {axis}", counter(*counts)),
                    Jump::Turn => format!("It begins again after each turn: write wrap = \"360 deg\" under [log] in {axis}"),
                    _ => format!("If it wraps there, give that travel as wrap under [log] in {axis}"),
                };
                format!("position jumps {} by more than half its range, first by {size} after {after}, and the record is split there. {cure}", counted(*jumps, "time"))
            }
            Self::Quantised { step, range, unit, given } => format!("position is quantised in steps of {} {unit} ({}); its range of {} {unit} is {} steps", short(*step), if *given { "as given" } else { "detected in the data" }, short(*range), short((range / step).round())),
            Self::FewSteps { steps } => format!("the whole travel is {} encoder steps: presliding is hardly resolved", short(*steps)),
            Self::Stuck { stretches: number, samples, moving, first } => {
                let moving = match moving {
                    Moving::Velocity(travel) => format!("the velocity covers {travel}"),
                    Moving::Jump(travel) => format!("it then jumps by {travel}"),
                    Moving::Reference(travel) => format!("the reference covers {travel}"),
                };
                format!("position is frozen in {} ({} in all) while the axis moves, first from {first}: {moving}. These samples are excluded", stretches(*number), counted(*samples, "sample"))
            }
            Self::StepsOfDegrees { place, column, step, bits } => format!("position, column {place}, is read in rad, but its steps of {} are 360/2^{bits}, those of an encoder of {bits} bits in degrees. In {axis}, under [columns], write position = {{ column = {column}, unit = \"deg\" }}, and check the units of the other columns", short(*step)),
            Self::UnlikelySize { size, usual: [least, most], column, unit, line } => format!("{size}; machines have {} to {}: the unit of column {column} ({unit}) is probably wrong. Give the right one in {axis} under [columns], such as {line}", short(*least), Value::new(*most, &size.value().unit)),
            Self::NoServo { channel, speed, acceleration, most: [fastest, hardest], column, unit, time, line } => {
                let time = time.as_ref().map_or(String::new(), |(column, unit)| format!(", or that of time, column {column} ({unit}),"));
                format!("{channel} shows {speed} and {acceleration} at once, more than any servo axis ({fastest} with {hardest}): the unit of column {column} ({unit}){time} is probably wrong. Give the right one in {axis} under [columns], such as {line}")
            }
            Self::Saturated { limit, samples, stretches: number, first } => format!("force saturates near {limit} for {} in {}, first from {first}. These samples are excluded", counted(*samples, "sample"), stretches(*number)),
            Self::Outliers { samples, times, force, first } => format!("the force has {} beyond all others by more than {times} times their range, first {force} at {first}. These are errors of measurement or transmission: interpolated and excluded", counted(*samples, "outlier")),
            Self::ForceDead { stretches: number, samples, first, until } => format!("force is zero while the axis moves, in {} ({} in all), first from {first} to {} s: the drive was off, and something else moved the axis. These samples are excluded", stretches(*number), counted(*samples, "sample"), short(*until)),
            Self::CoarseForce { step, range, few } => format!("the force is quantised in steps of {step}, {} of them over its range of {}: friction is resolved to a part of a step{}", short((range / step.number).round()), Value::new(*range, &step.unit), if *few { ", and no parameter fitted to it is a constant of the machine" } else { "" }),
            Self::ForceBrakes { part, turn } => {
                let cure = match turn {
                    Turn::Invert => format!("If its column is the friction force, not the driving force, set invert = true beside it under [columns] in {axis}"),
                    Turn::Undo => format!("{axis} inverts it already (invert, or a negative scale): undo that"),
                    Turn::Clock => format!("It comes from another file, whose clock may differ: set offset = \"estimate\" beside its file under [columns] in {axis}, and only if it still brakes invert = true"),
                    Turn::Validation => "That of the fitted logs does not: invert the column in this file, or validate on another".to_string(),
                };
                format!("inverted force sign: the force brakes, with a net work of -{} of all the work it does. {cure}", percent(*part))
            }
            Self::ServoAssumed { kp, supply } => {
                let kp = kp.map(|kp| (format!("a P gain of {}", short(kp)), "kp = GAIN"));
                let supply = supply.map(|volt| (format!("a supply of {} V", short(volt)), "supply = \"VOLTAGE V\""));
                let (said, lines): (Vec<_>, Vec<_>) = kp.into_iter().chain(supply).unzip();
                format!("the torque of the servo is assumed to be that of {}, and every force scales with it. State what was set, under [drive] in {axis}: {}", said.join(" and "), lines.join(" and "))
            }
            Self::Magnitude { reference } => {
                let cure = match reference {
                    true => "Write sign = \"following-error\" beside its column",
                    false => "Write sign = \"following-error\" beside its column and name the commanded position, reference = { column = \"NAME\" }, with file = \"FILE\" if it is in another file; or write sign = \"COLUMN\" with a column that has the sign",
                };
                format!("unsigned force: it never changes its sign while the axis moves both ways, so only the magnitude was logged. {cure}, under [columns] in {axis}")
            }
            Self::ForceUnit { unit, motion, wanted } => format!("the force is in {unit}, but a {motion} axis needs {wanted}: a scale for the lead or radius is missing, or the kind is wrong"),
            Self::ForceIsVoltage { wanted, unit } => format!("the force is a voltage. If it commands a drive in torque mode, give its scale in {wanted}/{unit}; if it is at the terminals of a motor, describe the motor under [drive] in {axis} (force_constant, resistance and the speed: docs/axis.md#drive), or back-EMF and resistance look like viscous friction"),
            Self::Uncalibrated { dimension, wanted, per: Some(per) } => format!("the force is in {dimension}, and so are the parameters, unless a scale in {wanted}/{per} is given"),
            Self::Uncalibrated { dimension, wanted, per: None } => format!("the force is in {dimension}, and so are the parameters, unless a scale in {wanted} is given. For a part of a rated value write scale = \"RATED {wanted}\" (CiA 402 object 6076h, or the nameplate); for a duty, describe the motor under [drive]: docs/axis.md#drive"),
            Self::NoForce { columns, line } => {
                let cure = match line {
                    ForceLine::Column { line, open_unit } => format!("Name it in {axis} under [columns], such as {line}{} (for the voltage, the duty or the current of a motor see [drive] in docs/axis.md)", if *open_unit { ", where UNIT is N of a force, N m of a torque, A of a current" } else { "" }),
                    ForceLine::OtherFile => format!("Join one of another file by its time stamps, in {axis} under [columns]: force = {{ file = \"FILE\", column = \"NAME\", unit = \"UNIT\" }}; of a servo that follows a commanded position write servo = \"MODEL\" (docs/lerobot.md)"),
                    ForceLine::Nanometres { column, line } => format!("The name of {column} is that of a force, but nm are nanometres; newton metres are Nm or N m: write that in the log, or in {axis} under [columns]: {line}"),
                    ForceLine::Counts { column, line } => format!("The name of {column} is that of a force, but the size of its counts is missing: give it in {axis} under [columns], such as {line}"),
                };
                format!("no column was recognised as force, torque or current, and friction needs one; {columns}. {cure}")
            }
            Self::Velocity(mismatch) => mismatch.words("velocity is not the derivative of the position", "the derivative of the position", "the velocity"),
            Self::Acceleration(mismatch) => mismatch.words("acceleration is not the second derivative of the position", "the acceleration of the position", "the logged acceleration"),
            Self::FewSamples { samples, least } => format!("the log has {}: with fewer than {least} an identification means little", counted(*samples, "sample")),
            Self::NoMotion { channel, range } => format!("the axis does not move: {channel} covers {range}"),
            Self::Noise { channel } => format!("{channel} looks like noise: neighbouring samples are hardly correlated"),
            Self::OneDirection { range } => format!("the axis moves in one direction only, over {range}: friction in the other direction and an offset of the force cannot be identified"),
            Self::OneSpeed { speed } => format!("the axis moves at one speed, {speed}: mass and the dependence of friction on speed cannot be identified"),
            Self::Constant { channel, value } => format!("{channel} is {} throughout", short(*value)),
            Self::RestAtEnds { until, from, then } => {
                let start = until.map(|until| format!("at the start until {} s", short(until)));
                let end = from.map(|from| format!("at the end from {} s", short(from)));
                let then = match then {
                    AtRest::Kept { key } => format!("Kept, because {axis} has {key} under [log]"),
                    AtRest::Varying => "The force varies meanwhile, as before break-away: procedures that start from rest use these samples, fits of the whole record do not".to_string(),
                    AtRest::Cut { seconds, samples, part } => format!("Fits of the whole record leave out {} ({}, {}), where the force does not show friction; to keep it, write rests = \"keep\" under [log] in {axis}", and(seconds.iter().map(|[from, to]| format!("{} to {} s", short(*from), short(*to)))), counted(*samples, "sample"), percent(*part)),
                };
                format!("the axis stands still {}. {then}", and(start.into_iter().chain(end)))
            }
            Self::RestBetween { rests, part, longest, from, varying } => {
                let varying = if *varying > 0 { format!(". In {varying} of them the force varies without motion, which no friction law describes: fits of the whole record leave these out; to fit them, write rests = \"keep\" under [log] in {axis}") } else { String::new() };
                format!("{} between motions, {} of the samples, the longest {} s from {} s{varying}", counted(*rests, "rest"), percent(*part), short(*longest), short(*from))
            }
            Self::Joined { channel, file, offset, rates: [own, log], thinned, rows, outside, unused } => {
                let added = if *offset == 0.0 { String::new() } else { format!(", {} s added to them", short(*offset)) };
                let kept = if *thinned { format!(", so the {} nearest to its samples are kept", counted(*rows, "row")) } else { String::new() };
                let beyond = if *outside > 0 { format!(". {outside} of {} lie outside or in a gap of it and are left out", counted(*rows, "row")) } else { String::new() };
                let unused = if *unused > 0 { format!(". {} of {file} lie outside the log", counted(*unused, "sample")) } else { String::new() };
                format!("{channel} is joined from {file} by time stamps{added}: it is sampled at {} Hz, the log at {} Hz{kept}{beyond}{unused}", short(*own), short(*log))
            }
            Self::Offset { channel, file, columns, seconds, half_width, explained } => format!("time offset of {file}: {seconds} s, +- {} s (95 %), from {columns} ({} of the variance explained); a fitted delay is no more accurate. To keep it, write offset = \"{seconds} s\" in place of \"estimate\" for {channel}", short(*half_width), Percent::error(100.0 * explained).decimals(1)),
            Self::UnitOverride { channel, recording, axis_file } => format!("{channel}: the recording gives {recording}, {axis} gives {axis_file}: {axis} is used"),
            Self::UnitsAssumed(all) => format!("no unit is given for some columns; assumed: {}", all.join(", ")),
            Self::UnitConvention { channel, unit, meaning } => format!("{channel}: {unit} is {meaning}"),
            Self::RateSkipsRows { column, seconds, rate } => format!("rows are missing between the time stamps of {column}, first at {} s, and rate = \"{} Hz\" of {axis} does not count them: the time stamps are used instead", short(*seconds), short(*rate)),
            Self::RateSkipsGaps { column, rate, crop: [from, to] } => format!("rows are missing between the longest stretches of {column}, and rate = \"{} Hz\" of {axis} does not count them. Delete rate, or keep rows without a gap, under [log]: crop = [\"{} s\", \"{} s\"]", short(*rate), short(*from), short(*to)),
            Self::StampsUnread { column, rate, unit, stamped, line } => format!("rows are counted at rate = \"{} Hz\" of {axis}, and {column} is not used, which runs at {} Hz in {unit}. If that is right, delete the line rate and write under [columns]: {line}", short(*rate), short(*stamped)),
            Self::RateDiffers { rate, step } => format!("rows are counted at rate = \"{} Hz\" of {axis}, but the file states a sample time of {} s, {} Hz. If the file is right, delete the line rate", short(*rate), short(*step), short(1.0 / step)),
        }
    }
}

impl Mismatch {
    #[rustfmt::skip] // One line a sentence.
    fn words(&self, apart: &str, one: &str, other: &str) -> String {
        match self {
            Self::Uncorrelated { correlation, samples } => format!("{apart}: over {samples} samples their correlation is {}", short(*correlation)),
            Self::Ratio { ratio, cause } => {
                let sign = (*ratio < 0.0).then_some("one of them has the wrong sign");
                let why: Vec<&str> = cause.iter().copied().chain(sign).collect();
                format!("{one} is {} times {other}: {}?", short(*ratio), if why.is_empty() { "a unit, a gear or a lead between them".to_string() } else { why.join(", and ") })
            }
        }
    }
}

/// A counter in words: of how many bits, or of how many counts.
pub fn counter(counts: u64) -> String {
    match counts.is_power_of_two() {
        true => format!("a counter of {} bits", counts.ilog2()),
        false => format!("a counter of {counts} counts"),
    }
}

fn stretches(number: usize) -> String {
    match number {
        1 => "1 stretch".into(),
        _ => format!("{number} stretches"),
    }
}

fn and(all: impl Iterator<Item = String>) -> String {
    all.collect::<Vec<_>>().join(" and ")
}

fn percent(part: f64) -> String {
    Percent::error(100.0 * part).digits(2)
}
