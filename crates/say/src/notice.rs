//! What to beware of in a result.

use crate::{Effect, Found, OfRobot, Reason, Unplanned, Value};
use std::fmt;
use stiction_codes::Code;
use stiction_number::{Percent, counted, four_digits, full, quantity, short};

/// The logs that a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whose {
    /// One that is fitted.
    Fitted,
    /// So many of all that are fitted.
    Many(usize, usize),
    /// One that is validated on.
    Validated,
}

/// What a search looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sought {
    /// The steady curve.
    Curve,
    /// `sigma0` and `sigma1`.
    Bristles,
}

/// A value outside its range of the axis file.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Outside {
    pub name: String,
    pub value: Value,
    pub range: [f64; 2],
}

/// A parameter in this motion and in the static parameters.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Differs {
    pub name: String,
    pub here: f64,
    pub there: f64,
    pub unit: String,
}

/// A stretch of nearly constant velocity that is not fitted.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub struct Unsteady {
    pub log: String,
    pub seconds: [f64; 2],
    pub speed: Value,
    pub reason: &'static str,
}

/// What an axis file states and a log contradicts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // The quantity.
pub enum Stated {
    Mass,
    Delay,
    Exponent,
}

/// Where a run differs from its plan.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum OffPlan {
    /// The position goes so many times as far.
    Scale(f64),
    /// No log shows the motion.
    Absent,
    /// It ran at a part of its pace.
    Pace(f64),
    /// Pieces are missing or cut short, by their numbers; from where to run again, s.
    Pieces {
        of: usize,
        missing: Vec<usize>,
        cut: Vec<usize>,
        from: f64,
    },
}

/// Why nothing should be planned from a first model or log.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum Doubt {
    /// Its identification flagged it.
    Untrusted,
    /// A cause, with the line of the axis file and its table that takes it into the fit.
    Cause {
        text: String,
        size: String,
        cure: Option<(String, String)>,
    },
    /// A reason against it, in its own words.
    Reason(String),
}

/// What levels that follow the force of the drive take for friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // The force.
pub enum Taken {
    Inertia,
    Gravity,
    Cogging,
}

/// Why a run was not made.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum NoRun {
    Refused {
        name: String,
        value: f64,
        allowed: String,
    },
    Diverged {
        seconds: f64,
    },
}

impl fmt::Display for NoRun {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused { name, value, allowed } => write!(f, "{name} = {}; allowed: {allowed}", short(*value)),
            Self::Diverged { seconds } => write!(f, "it left its path at {} s", short(*seconds)),
        }
    }
}

/// Where exported C that gives another force comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The model of the study: the code or its arithmetic was changed.
    Model,
    /// Another model with the same law.
    SameLaw,
    /// Another law.
    AnotherLaw,
}

/// An axis that was drawn for a promise.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says, in the unit of that name.
pub struct DrawnAxis {
    pub mass: Value,
    pub stiffness: Value,
    pub coulomb: [f64; 2],
    pub force_unit: String,
    /// Forces beside the law: after reversals, by place, by themselves.
    pub beside: [f64; 3],
}

/// What else is said of a force that is late or early.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says.
pub enum Whole {
    /// Its low-pass was undone.
    Unfiltered,
    /// It comes from another file: the offset to write, whether one stands there, in which file, and the command then.
    Offset {
        in_table: bool,
        offset: f64,
        replaces: bool,
        file: String,
        command: String,
    },
    /// The delay to write, s, in which file, and the command then.
    Delay {
        in_table: bool,
        delay: f64,
        file: String,
        command: String,
    },
}

impl fmt::Display for Whole {
    #[rustfmt::skip] // One line a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let row = |in_table: bool| if in_table { "The delay in the table is the whole one. " } else { "" };
        match self {
            Self::Unfiltered => f.write_str("The delay in the table is that of the force before its low-pass; if the drive can log the force that its controller asks for, record that"),
            Self::Offset { in_table, offset, replaces, file, command } => write!(f, "{}The force comes from another file, whose clock may differ: to state that, write offset = \"{} s\" beside its file under [columns] {file}{}, then: {command}", row(*in_table), full(*offset), if *replaces { " in place of the offset there" } else { "" }),
            Self::Delay { in_table, delay, file, command } => write!(f, "{}Find its cause; to state it, write delay = \"{} ms\" under [terms] {file}, then: {command}", row(*in_table), four_digits(1e3 * delay)),
        }
    }
}

/// Something a user should know although the work went on. Parts are dimensionless, 1 is all.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // A field is what its name says; the variant says of what.
#[rustfmt::skip] // One line a kind.
pub enum Notice {
    /// Something found in a log, or in many of which it is the first.
    InLog { log: String, whose: Whose, found: Box<Found>, axis_file: String },
    /// A force that is late or early, with what states it.
    Late { found: Box<Self>, whole: Whole },
    /// Positions were sampled beside their time stamps.
    InaccurateStamps { seconds: f64, of_sample: f64 },
    /// No delay within the range fits.
    DelayOutOfRange,
    /// The delay of a step response is at the end of its range.
    DelayOfStep,
    /// The state of a search could not be kept.
    CheckpointLost { error: String },
    /// The user stopped the comparison of laws.
    ComparisonStopped,
    /// A law with fewer parameters has a smaller held-out error.
    SimplerLaw { law: String, error: f64, own: f64 },
    /// What speaks against a law and has a page of its own.
    Against(Box<Reason>),
    /// A search was not followed by least squares.
    NoIntervals,
    /// The map of the level that the axis file asks for has no part that the log supports.
    NoMap,
    /// Parameters that the data do not determine: their names and why, those of one reason together; and what motion would.
    Open { each: Vec<(Vec<String>, String)>, record: Vec<String> },
    /// Elements whose sum alone is determined.
    OpenElements { names: Vec<String> },
    /// A law with more parameters has a much smaller held-out error.
    RicherLaw { law: String, error: f64, own: f64 },
    /// Encoder, filters and noise bias parameters: each by its name, percent.
    Biased { parameters: Vec<(String, f64)> },
    /// A static law is fitted to samples near rest.
    StaticLawAtRest { part: f64, speed: f64, unit: &'static str },
    /// The residual of a simulated open loop has too few independent samples.
    CorrelatedResidual,
    /// Parameters are outside `[search.box]`.
    OutsideBox { each: Vec<Outside> },
    /// A search ended at bounds of its box, in words.
    AtBounds { each: Vec<String> },
    /// Least squares found a better optimum than the search.
    SearchMissed { sought: Sought },
    /// An identified size that no machine has; its column with its unit, and the line that gives another unit.
    NoMachine { size: &'static str, value: f64, usual: [f64; 2], unit: &'static str, role: &'static str, column: Option<(String, String)>, line: Option<String> },
    /// The motion has other friction than the static parameters.
    StaticsDiffer { each: Vec<Differs> },
    /// All constant velocities are in one direction.
    PointsOneWay { points: usize },
    /// A static map has few speeds.
    FewSpeeds { positive: usize, negative: usize, advised: usize },
    /// Stretches are not fitted: the first of them, and how many in all.
    UnsteadyStretches { first: Vec<Unsteady>, all: usize },
    /// Points of a static map lie off its curve.
    OutlyingPoints { speeds: Vec<Value> },
    /// A run shows no break-away.
    NoBreakAway { why: String },
    /// The steady curve of force steps is assumed.
    AssumedCurve,
    /// The published inversion of a step response gives no `sigma1`.
    NoOvershoot { log: String },
    /// The residual shows an effect.
    Effect(Box<Effect>),
    /// A run differs from its plan.
    OffPlan { plan: String, how: OffPlan },
    /// Logs differ in a parameter: the key of a level of its own for each log, and the commands that identify each.
    LogsDiffer { name: String, meaning: String, values: [f64; 2], unit: String, logs: [String; 2], apart: f64, of_coulomb: bool, chance: f64, key: Option<&'static str>, commands: Option<[String; 2]> },
    /// The log contradicts what the axis file states.
    Contradicted { stated: Stated, value: f64, shown: [f64; 3], unit: String, left: f64 },
    /// The mass is not that of `[limits]`.
    LimitsMass { limit: f64, shown: [f64; 3], unit: String },
    /// Something is not planned for.
    Unplanned(Unplanned),
    /// A first model or log is doubtful.
    PlannedFrom { file: String, doubt: Doubt },
    /// Levels of a compensator follow forces that are no friction; feedforward that takes them off.
    NotFriction { taken: Vec<Taken>, feedforward: Option<String>, no_mass: bool },
    /// A model is flagged.
    Untrusted,
    /// Parameters of a model are not determined.
    Undetermined { names: Vec<String> },
    /// Terms of a model that the code leaves out, and the feedforward that takes them.
    LeftToFeedforward { names: Vec<String>, feedforward: Option<String> },
    /// A constant force may be a weight.
    ConstantForce { value: f64, coulomb: f64, unit: String },
    /// Code is to be called at another rate than that of the log, s.
    AnotherRate { cycle: f64, of_log: f64 },
    /// Code has friction at a reference; lines of the model file that would change that.
    AtReference { each: Vec<String>, lines: Vec<String> },
    /// Code makes less force than was identified: name, value, unit, identified value.
    Lowered { each: Vec<(String, f64, String, f64)>, limited: bool },
    /// The position wraps.
    WrappedPosition { travel: f64, unit: &'static str, names: Vec<String>, range: [f64; 2] },
    /// No C compiler makes a binary of an FMU.
    SourceOnly,
    /// Names in code are a part of the name of the axis.
    ShortName { identifier: String, title: String },
    /// Exported C was not run.
    ExportedNotRun { path: String, controller: String, why: NoRun },
    /// Exported C gives another force.
    ExportedDiffers { folder: String, difference: f64, unit: String, seconds: f64, path: String, controller: String, part: f64, origin: Origin, again: String },
    /// The command is at its limit: each compensation with the part of the samples.
    AtForceLimit { path: String, controller: String, limits: Vec<Value>, each: Vec<(String, f64)> },
    /// The command changes from sample to sample.
    Shaking { path: String, controller: String, scheme: String, part: f64 },
    /// A load estimate had little time.
    LoadNotLearnt { path: String, controller: String, compensator: String, seconds: f64, needed: f64, acceleration: f64 },
    /// A run was not made; the value of a sweep.
    NotRun { path: String, controller: String, schemes: Vec<String>, point: Option<(String, Value)>, why: NoRun, gains: Option<String> },
    /// Something about a robot.
    Robot(OfRobot),
    /// Drawn axes give no figures.
    NotPromised { path: String, controller: String, schemes: Vec<String>, why: NoRun, axes: Vec<DrawnAxis>, modelled: bool },
}

impl Notice {
    /// What was found in a log, if it is that.
    pub fn found(&self) -> Option<&Found> {
        match self {
            Self::InLog { found, .. } => Some(found),
            Self::Late { found, .. } => found.found(),
            _ => None,
        }
    }

    /// The code that its page is named by.
    pub fn code(&self) -> Code {
        match self {
            Self::InLog { found, .. } => found.code(),
            Self::Late { found, .. } => found.code(),
            Self::InaccurateStamps { .. } => Code::Jitter,
            Self::DelayOutOfRange | Self::DelayOfStep => Code::DelayOutOfRange,
            Self::CheckpointLost { .. } => Code::BadCheckpoint,
            Self::ComparisonStopped => Code::Interrupted,
            Self::SimplerLaw { .. } => Code::SimplerLawHoldsBetter,
            Self::Against(reason) => reason.code(),
            Self::NoMap => Code::PositionDependence,
            Self::NoIntervals | Self::Open { .. } | Self::OpenElements { .. } => {
                Code::NotIdentifiable
            }
            Self::RicherLaw { .. } => Code::RicherLawHoldsBetter,
            Self::Biased { .. } => Code::LargeShift,
            Self::StaticLawAtRest { .. } => Code::StaticLawAtRest,
            Self::CorrelatedResidual => Code::CorrelatedResidual,
            Self::OutsideBox { .. } => Code::OutsideBox,
            Self::AtBounds { .. } | Self::SearchMissed { .. } => Code::NotConverged,
            Self::NoMachine { .. } => Code::UnlikelySize,
            Self::StaticsDiffer { .. } | Self::LogsDiffer { .. } => Code::LogsDisagree,
            Self::PointsOneWay { .. } => Code::OneDirection,
            Self::FewSpeeds { .. } => Code::FewSpeeds,
            Self::UnsteadyStretches { .. } => Code::UnsteadyStretches,
            Self::OutlyingPoints { .. } => Code::OutlyingPoints,
            Self::NoBreakAway { .. } => Code::NoBreakAway,
            Self::AssumedCurve => Code::StaticsAssumed,
            Self::NoOvershoot { .. } => Code::NoOvershoot,
            Self::Effect(effect) => effect.code(),
            Self::OffPlan { .. } => Code::PlanDiffers,
            Self::Contradicted { stated, .. } => match stated {
                Stated::Mass => Code::MassDisagrees,
                Stated::Delay => Code::DelayDisagrees,
                Stated::Exponent => Code::ExponentDisagrees,
            },
            Self::LimitsMass { .. } => Code::MassDisagrees,
            Self::Robot(of_robot) => of_robot.code(),
            Self::Unplanned(_) => Code::NotPlanned,
            Self::PlannedFrom { .. } => Code::ModelInDoubt,
            Self::NotFriction { .. } => Code::ExportAdaptation,
            Self::Untrusted => Code::ExportUntrusted,
            Self::Undetermined { .. } => Code::NotIdentifiable,
            Self::LeftToFeedforward { .. }
            | Self::ConstantForce { .. }
            | Self::AtReference { .. } => Code::ExportTerms,
            Self::AnotherRate { .. } => Code::ExportRate,
            Self::Lowered { .. } => Code::ExportSupported,
            Self::WrappedPosition { .. } => Code::ExportWrap,
            Self::SourceOnly => Code::ExportSource,
            Self::ShortName { .. } => Code::ExportName,
            Self::ExportedNotRun { .. } | Self::NotRun { .. } => Code::NotRun,
            Self::ExportedDiffers { .. } => Code::ExportedDiffers,
            Self::AtForceLimit { .. } => Code::AtForceLimit,
            Self::Shaking { .. } => Code::UnsteadyCommand,
            Self::LoadNotLearnt { .. } => Code::LoadNotLearnt,
            Self::NotPromised { .. } => Code::NotPromised,
        }
    }
}

fn error(percent: f64) -> String {
    Percent::error(percent).decimals(2)
}

fn part(part: f64) -> String {
    Percent::error(100.0 * part).digits(2)
}

fn list<T>(all: &[T], between: &str, one: impl Fn(&T) -> String) -> String {
    all.iter().map(one).collect::<Vec<_>>().join(between)
}

/// Most pieces of a plan that are named.
const MOST_PIECES: usize = 12;

fn pieces(numbers: &[usize], what: &str) -> Option<String> {
    let shown = list(
        &numbers[..numbers.len().min(MOST_PIECES)],
        ", ",
        ToString::to_string,
    );
    let more = match numbers.len().saturating_sub(MOST_PIECES) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    match numbers.len() {
        0 => None,
        1 => Some(format!("piece {shown} {what}")),
        _ => Some(format!("pieces {shown}{more} {what}")),
    }
}

/// How an option is written, given its name on the command line and its value.
pub type Naming = fn(&str, &str) -> String;

impl Notice {
    /// The sentence with each option as `option` writes it. Displayed, they are as typed: `--cycle-time 0.001`.
    pub fn named(&self, option: Naming) -> String {
        struct Named<'a>(&'a Notice, Naming);
        impl fmt::Display for Named<'_> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.write(f, self.1)
            }
        }
        Named(self, option).to_string()
    }
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(f, |name, value| format!("--{name} {value}"))
    }
}

impl Notice {
    #[rustfmt::skip] // One line a sentence.
    fn write(&self, f: &mut fmt::Formatter<'_>, option: Naming) -> fmt::Result {
        match self {
            Self::InLog { log, whose, found, axis_file } => {
                let found = found.words(axis_file);
                match whose {
                    Whose::Fitted => write!(f, "{log}: {found}"),
                    Whose::Many(alike, all) => write!(f, "in {alike} of {all} logs, the first {log}: {found}"),
                    Whose::Validated => write!(f, "{log}, which is not fitted: {found}"),
                }
            }
            Self::Late { found, whole } => write!(f, "{found}. {whole}"),
            Self::InaccurateStamps { seconds, of_sample } => write!(f, "time stamps are inaccurate: positions were sampled {} us rms ({:.0} % of a sample) away from their stamps. Intervals include this; a log with hardware time stamps narrows them", four_digits(1e6 * seconds), 100.0 * of_sample),
            Self::DelayOutOfRange => f.write_str("no delay of up to four samples fits and it is taken as zero: force or motion was logged late or filtered, or something acts that the law does not describe"),
            Self::DelayOfStep => f.write_str("the delay between force and position is at its search bound of two samples: it stands for something that the law does not describe, such as another force held before the step than that of the model"),
            Self::CheckpointLost { error } => write!(f, "the state of the search could not be kept: {error}"),
            Self::ComparisonStopped => f.write_str("the comparison of laws was interrupted and is left out; the fit is complete"),
            Self::Against(reason) => write!(f, "{reason}"),
            Self::NoMap => f.write_str("coulomb_position = \"map\" has no effect: the log supports no map, and the level is fitted as a constant"),
            Self::NoIntervals => f.write_str("no parameter has an interval: least squares after the search were left out"),
            Self::Open { each, record } => {
                let each = list(each, "; ", |(names, why)| format!("{}: {why}", names.join(", ")));
                write!(f, "{each}{}", record.iter().map(|motion| format!(". {motion}")).collect::<String>())
            }
            Self::OpenElements { names } => write!(f, "{}: the data determine the sum of the elements, not each of them. Record slow reversals of several amplitudes, or ask for fewer elements ([terms] gms_elements)", names.join(", ")),
            Self::SimplerLaw { law, error: least, own } => write!(f, "the law {law} has a smaller held-out error ({}) than this law ({}): the richer law is not supported by this log", error(*least), error(*own)),
            Self::RicherLaw { law, error: least, own } => write!(f, "the law {law} has a much smaller held-out error ({}) than this law ({}): this law is too simple for the axis, its parameters are biased", error(*least), error(*own)),
            Self::Biased { parameters } => write!(f, "encoder steps, filters and noise bias {}: the bias is subtracted, but one of this size is known only roughly", list(parameters, ", ", |(name, percent)| format!("{name} {}", Percent::error(*percent).signed(0)))),
            Self::StaticLawAtRest { part, speed, unit } => write!(f, "{:.0} % of the samples are slower than {} {unit}, where a static law does not hold and most of the residual is. Exclude them with [conditioning] min_speed in the axis file, or identify the law lugre", 100.0 * part, short(*speed)),
            Self::CorrelatedResidual => f.write_str("noise of the logged force drives the simulated axis and adds up to a slow position error that biases the parameters. Cut the log into shorter runs ([simulation] segment in the axis file), or record a closed loop and give its controller ([controller])"),
            Self::OutsideBox { each } => write!(f, "outside [search.box] of the axis file: {}. Least squares ignore that box, which limits searches only: correct the range, or look for an effect that this law lacks", list(each, "; ", |Outside { name, value, range: [low, high] }| format!("{name} = {value}, not {} to {}", short(*low), short(*high)))),
            Self::AtBounds { each } => write!(f, "the search ended with {} of its range (SI): the optimum may lie outside. Widen the range in [search.box] of the axis file", each.join(", ")),
            Self::SearchMissed { sought: Sought::Curve } => f.write_str("the search for the steady curve missed the optimum: least squares over all Stribeck velocities found the values given here. Check its box, [search.box] of the axis file, or raise its budget"),
            Self::SearchMissed { sought: Sought::Bristles } => f.write_str("the search for sigma0 and sigma1 missed the optimum: least squares over the whole range of sigma0 found the values given here. Check its box, [search.box] of the axis file, or raise its budget"),
            Self::NoMachine { size, value, usual: [low, high], unit, role, column, line } => {
                let column = column.as_ref().map_or(String::new(), |(column, unit)| format!(", column {column} ({unit}),"));
                let line = line.as_ref().map_or(String::new(), |line| format!("write under [columns] in axis.toml: {role} = {line}; "));
                write!(f, "the identified {size} is {} {unit}, and machines have {} to {} {unit}: the unit of the {role}{column} is probably wrong. To correct it, {line}if the axis is really like that, give its mass under [limits]", short(*value), short(*low), short(*high))
            }
            Self::StaticsDiffer { each } => write!(f, "friction in this motion differs from the static parameters: {}. None of these, nor what was found with them held, is a constant of the machine: record the static map and the motion one after the other, at the temperature and load of normal work", list(each, "; ", |Differs { name, here, there, unit }| format!("{name} is {} {unit} here and {} {unit} there, {}", short(*here), short(*there), Percent::error(100.0 * (here / there - 1.0)).signed(0)))),
            Self::PointsOneWay { points } => write!(f, "all {points} points are in one direction: friction cannot be separated from a constant force. Record the same speeds in the other direction too"),
            Self::FewSpeeds { positive, negative, advised } => write!(f, "{positive} different speeds in the positive direction and {negative} in the negative one: a static map needs {advised} each way. Space them evenly on a logarithmic scale, from well below the Stribeck velocity to the top speed"),
            Self::UnsteadyStretches { first, all } => write!(f, "{} not fitted: {}{}", if *all == 1 { "1 stretch".to_string() } else { format!("{all} stretches") }, list(first, "; ", |Unsteady { log, seconds: [from, to], speed, reason }| format!("{log} at {from:.3} to {to:.3} s, {speed}: {reason}")), match all - first.len() { 0 => String::new(), more => format!("; and {more} more") }),
            Self::OutlyingPoints { speeds } => write!(f, "{} far off the curve of the others and {} little: {}", if speeds.len() == 1 { "1 point lies".to_string() } else { format!("{} points lie", speeds.len()) }, if speeds.len() == 1 { "counts" } else { "count" }, list(speeds, ", ", ToString::to_string)),
            Self::NoBreakAway { why } => write!(f, "{why}; this run is left out"),
            Self::AssumedCurve => f.write_str("neither a model nor logs of constant velocities give the steady curve: its level is fitted as a constant, sigma2 and the constant force F₀ are taken as zero, so that the bristles carry all that is held before the step. sigma1 then stands for sigma1 + sigma2, and near the Stribeck velocity all parameters are off by more than their intervals"),
            Self::NoOvershoot { log } => write!(f, "{log}: the published inversion gives no sigma1, since the axis does not overshoot; the fit by simulation needs no overshoot"),
            Self::Effect(effect) => f.write_str(&effect.words()),
            Self::OffPlan { plan, how } => match how {
                OffPlan::Scale(times) => write!(f, "the position of the log goes {} times as far as the motion of {plan}: its unit or scale in the axis file differs from that of the set points, or another motion was run. Masses, stiffnesses and speeds are wrong by as much", short(*times)),
                OffPlan::Absent => write!(f, "no log shows the motion of {plan}: its expected intervals do not apply. Run its setpoints.csv at its pace and record the position"),
                OffPlan::Pace(pace) => write!(f, "the motion of {plan} ran at {} of its pace: its expected intervals hold for full pace only. Run it again without an override", Percent::error(100.0 * pace).short()),
                OffPlan::Pieces { of, missing, cut, from } => {
                    let lacking: Vec<String> = [pieces(missing, "missing"), pieces(cut, "cut short")].into_iter().flatten().collect();
                    write!(f, "of {} in {plan}, {}: the expected intervals need them. Run setpoints.csv again from t = {} s on, where the axis is at rest at its start, and identify that log together with this one", counted(*of, "piece"), lacking.join(", "), four_digits(*from))
                }
            },
            Self::LogsDiffer { name, meaning, values: [one, other], unit, logs: [first, second], apart, of_coulomb, chance, key, commands } => {
                let of = if *of_coulomb { " of the Coulomb level" } else { "" };
                let key = key.map_or(String::new(), |key| format!("; to give each log its own, write {key} = true under [terms] in the axis file ({name} is then that of the first log)"));
                let commands = commands.as_ref().map_or(String::new(), |[first, second]| format!(". Each alone: {first}; {second}"));
                write!(f, "the logs differ in {name} ({meaning}): {} {unit} in {first}, {} {unit} in {second}, {}{of} apart, where {} would be chance. The interval for another day includes this scatter{key}{commands}", short(*one), short(*other), part(*apart), part(*chance))
            }
            Self::Contradicted { stated, value, shown: [found, low, high], unit, left } => {
                let (value, to_do) = match stated {
                    Stated::Mass => (format!("a mass of {} {unit}", short(*value)), "Write mass = \"fit\" in its place in the axis file; if the mass is certain, the force has another scale or unit"),
                    Stated::Delay => (format!("a delay of {} ms", short(*value)), "Write delay = \"fit\" in its place under [terms] in the axis file"),
                    Stated::Exponent => (format!("a Stribeck exponent of {}", full(*value)), "Write stribeck_exponent = \"fit\" in its place under [terms] in the axis file"),
                };
                let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
                write!(f, "the axis file states {value}, but the log shows {}{unit} ({} to {}), which reduces the residual to {}. {to_do}", four_digits(*found), four_digits(*low), four_digits(*high), part(*left))
            }
            Self::LimitsMass { limit, shown: [found, low, high], unit } => write!(f, "limits.mass of the axis file is {} {unit}, within a factor of two, but the log shows {} {unit} ({} to {}). Position, time or force of the log has another unit or scale than the axis file says, and every number with it, or limits.mass is not the moving mass: correct the wrong one", four_digits(*limit), four_digits(*found), four_digits(*low), four_digits(*high)),
            Self::Unplanned(what) => write!(f, "{what}"),
            Self::PlannedFrom { file, doubt } => {
                const FIRST: &str = "The motion is planned for these values all the same: correct that first, then plan again";
                match doubt {
                    Doubt::Untrusted => write!(f, "{file}: the identification flagged it as not trustworthy: see its report. {FIRST}"),
                    Doubt::Cause { text, size, cure: Some((line, table)) } => write!(f, "{file}: {text} ({size}); write {line} under [{table}] of the axis file. {FIRST}"),
                    Doubt::Cause { text, size, cure: None } => write!(f, "{file}: {text} ({size}), which no motion removes: intervals will be wider than expected here"),
                    Doubt::Reason(reason) => write!(f, "{file}: {reason}. {FIRST}"),
                }
            }
            Self::NotFriction { taken, feedforward, no_mass } => {
                let taken = list(taken, "; ", |taken| match taken { Taken::Inertia => "the force of acceleration, since the model has no mass that the log determines".into(), Taken::Gravity => "gravity".into(), Taken::Cogging => "cogging".into() });
                let feedforward = feedforward.as_ref().map(|names| format!("export with {}, and the block subtracts it, or subtract it from drive_force", option("feedforward", names)));
                let mass = no_mass.then(|| "give the mass in the axis file, mass = \"4.6 kg\", and identify again".to_string());
                let ways: Vec<String> = feedforward.into_iter().chain(mass).chain(["or let them learn only where it is small".into()]).collect();
                write!(f, "levels that follow the force of the drive mistake these for friction: {taken}. To prevent this: {}", ways.join("; "))
            }
            Self::Untrusted => f.write_str("the identification flagged this model as not trustworthy; a compensation with it may be too strong"),
            Self::Undetermined { names } => write!(f, "the log leaves {} open: the law predicts friction on motion like that of the log, and may be wrong on any other", names.join(", ")),
            Self::LeftToFeedforward { names, feedforward } => write!(f, "{} is not friction and not in the compensator; feed it forward separately{}", names.join(", "), feedforward.as_ref().map_or(String::new(), |parts| format!(", or with it: {}", option("feedforward", parts)))),
            Self::ConstantForce { value, coulomb, unit } => write!(f, "the model has a constant force of {} {unit}, large against its Coulomb friction of {} {unit}, and the code feeds it forward with the friction: gain and ramp act on it, and when the watchdog switches off, an axis that it holds falls. If it is a weight, export with {} (targets with such a feedforward), which holds it whatever the watchdog does", short(*value), short(*coulomb), option("feedforward", "friction,mass,gravity")),
            Self::AnotherRate { cycle, of_log } => write!(f, "the code is for one call every {cycle} s, and the log has one sample every {of_log} s: called at the rate of the log its time runs {} times as fast. If the controller runs at that rate, export with {}", short(cycle / of_log), option("cycle-time", &of_log.to_string())),
            Self::AtReference { each, lines } => write!(f, "friction depends on inputs that the code does not see; it uses their reference ({}). Where the axis works elsewhere it is off by that much: identify the axis as it works{}", each.join("; "), if lines.is_empty() { String::new() } else { format!(". With the range of the log in the model file the code has it: {}", lines.join("; ")) }),
            Self::Lowered { each, limited } => write!(f, "the code gives the least force that the log supports: {}{}. A log that determines them gives more: stiction check LOG names the motion", list(each, ", ", |(name, to, unit, from)| format!("{name} = {} {unit} instead of {}", four_digits(*to), four_digits(*from))), if *limited { ", and its limit is the largest friction up to the speeds of the log" } else { "" }),
            Self::WrappedPosition { travel, unit, names, range: [low, high] } => write!(f, "the position of the log wraps after {} {unit}, and {} depend on it without that period. Feed an unwrapped position, {} to {} {unit} as identified (outside that range its end counts)", short(*travel), names.join(", "), short(*low), short(*high)),
            Self::Robot(of_robot) => write!(f, "{of_robot}"),
            Self::SourceOnly => f.write_str("no C compiler of this machine makes a binary: the FMUs have C source only. A tool that runs them has to compile it, or install gcc and export again"),
            Self::ShortName { identifier, title } => write!(f, "the names in the code begin with {identifier}, only a part of the axis name '{title}': another axis may get the same; give a name"),
            Self::ExportedNotRun { path, controller, why } => write!(f, "{path}, {controller} was not run with the exported C: {why}"),
            Self::ExportedDiffers { folder, difference, unit, seconds, path, controller, part, origin, again } => {
                let origin = match origin {
                    Origin::AnotherLaw => "it has another law than this version exports of the model of the study",
                    Origin::SameLaw => "it was exported from another model file, whose law is the same",
                    Origin::Model => "it was exported from the model of the study and has its law, so the code was changed, or the compiler does not keep to IEEE 754",
                };
                write!(f, "the C in {folder} gives another force than the compensator of the model: by up to {} on the same inputs, at {} s of {path}, {controller} ({} % of static friction); {origin}. Export again, into a new folder: {again}", quantity(*difference, unit), short(*seconds), short(100.0 * part))
            }
            Self::AtForceLimit { path, controller, limits, each } => {
                let limits = match limits.as_slice() {
                    [] => "the largest force".to_string(),
                    [one] => quantity(one.number, &one.unit),
                    [x, y, ..] => format!("{} (x) and {} (y)", quantity(x.number, &x.unit), quantity(y.number, &y.unit)),
                };
                write!(f, "{path}, {controller}: the command is at its limit of {limits} in part of the samples with {}: there the result shows the limit, not the controller or the compensation", list(each, ", ", |(scheme, part)| format!("{scheme} ({})", Percent::error(100.0 * part).decimals(0))))
            }
            Self::Shaking { path, controller, scheme, part } => write!(f, "{path}, {controller}: with {scheme} the command changes by {} of the largest force from sample to sample (rms): the loop is unstable, or its gains are too high for encoder and noise; no reduction is promised. Halve its bandwidth under [[controller]] in the study file until this is gone, or use a finer encoder", Percent::error(100.0 * part).decimals(0)),
            Self::LoadNotLearnt { path, controller, compensator, seconds, needed, acceleration } => write!(f, "{path}, {controller}: the load estimate of {compensator} had {} to learn, of {} that it needs with an acceleration above {}. It is fed forward all the same, and does not show the load", if *seconds == 0.0 { "no time".to_string() } else { quantity(*seconds, "s") }, quantity(*needed, "s"), quantity(*acceleration, "m/s^2 (rad/s^2)")),
            Self::NotRun { path, controller, schemes, point, why, gains } => {
                let with = point.as_ref().map_or(String::new(), |(key, value)| format!(" with {key} = {}", quantity(value.number, &value.unit)));
                let (schemes, gains) = (schemes.join(", "), gains.as_deref().unwrap_or_default());
                match why {
                    NoRun::Refused { .. } => write!(f, "{path}, {controller}, {schemes}{with} was not run: {why}"),
                    NoRun::Diverged { seconds } => write!(f, "{path}, {controller} ({schemes}){with} diverged: the axis left its path at {} s and did not come back, with {gains}; such a run has no figures. Allowed: smaller gains, or a bandwidth instead of them; a force limit that the drive can give", four_digits(*seconds)),
                }
            }
            Self::NotPromised { path, controller, schemes, why, axes, modelled } => {
                let why = match why {
                    NoRun::Diverged { seconds } => format!("left its path at {} s and did not come back", four_digits(*seconds)),
                    NoRun::Refused { name, value, allowed } => format!("has {name} = {}, allowed: {allowed}", four_digits(*value)),
                };
                let axes = list(axes, "; ", |DrawnAxis { mass, stiffness, coulomb: [there, back], force_unit, beside: [reversals, place, drift] }| format!("mass {mass}, sigma0 {stiffness}, coulomb {} and {} {force_unit}, and forces that the law lacks: {} {force_unit} after reversals, {} {force_unit} by position, {} {force_unit} (rms) over time", short(*there), short(*back), short(*reversals), short(*place), short(*drift)));
                let advice = if *modelled { "The axis as modelled gives none either: correct that first, see not-run" } else { "The axis as modelled keeps to its path with these gains. Allowed: the covariance and [remaining] of an identification of this axis" };
                write!(f, "{path}, {controller}: nothing is promised, as axes drawn from the covariance and [remaining] of the model give no figures ({}). The first {why}, with {axes}. {advice}", schemes.join(", "))
            }
        }
    }
}
