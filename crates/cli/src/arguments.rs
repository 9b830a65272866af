//! What can be typed.

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// From a drive's log to friction compensation on the controller.
///
/// Exit codes: 0 done, 1 the result is not trustworthy (it says why), 2 bad input or usage, 3 internal
/// error, 130 interrupted (what was found so far is saved).
#[derive(Clone, Debug, Parser)]
#[command(name = "stiction", version, term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    #[command(flatten)]
    pub common: Common,
}

/// Options of every command, behind its own in the help.
#[derive(Clone, Debug, Args)]
pub struct Common {
    /// Print the result as JSON on standard output, and nothing else there.
    #[arg(long, global = true, display_order = 100)]
    pub json: bool,
    /// Print errors only.
    #[arg(long, global = true, display_order = 101)]
    pub quiet: bool,
    /// Print all that was found: laws side by side, warnings in full, what was left out.
    #[arg(long, global = true, display_order = 101)]
    pub verbose: bool,
    /// Threads to use [default: one a core]; results do not depend on it.
    #[arg(long, global = true, display_order = 102, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Memory that a log and its fit may take, such as 2GB or 500MiB; a log that needs more is refused before it is taken
    /// [default: a quarter of this machine].
    #[arg(long, global = true, display_order = 103, value_name = "SIZE", value_parser = memory, allow_hyphen_values = true)]
    pub max_memory: Option<u64>,
}

#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// A known axis, a realistic log, identify it, compare with the truth: no input needed.
    Demo(Demo),
    /// Record a log from a TwinCAT PLC (ADS) or a Universal Robots arm (RTDE); only reads.
    Record(Record),
    /// What was read and detected, and what this log can and cannot determine.
    Check(Check),
    /// Identify a friction law from logs of one axis.
    Identify(Identify),
    /// Identify a robot: its rigid body and the friction of every joint, from logs of all joints and a URDF.
    Robot(Robot),
    /// Identify every log of a folder or a list by itself, on all cores, into one table.
    Batch(Batch),
    /// Friction over time: what changed on which machine, from the table of a batch; exit code 1 if something did.
    Drift(Drift),
    /// The motion to record, within the limits of an axis, with the intervals to expect of its log.
    Plan(Plan),
    /// Searches beside each other, many seeds of each, on a log or a problem with a known answer.
    Compare(Compare),
    /// Simulate an axis with and without compensation, over paths, controllers and wrong parameters.
    Simulate(Simulate),
    /// Run published experiments again, each number beside its reference; exit code 1 if one is off.
    Reproduce(Reproduce),
    /// Write the compensator of a model as code or tables for a controller.
    Export(Export),
    /// Machines that are identified already: list them, or write the files of one, ready for export.
    Library(Library),
    /// Open a folder on a local page: logs, identification, studies and exports by looking.
    #[cfg(feature = "studio")]
    Studio(Studio),
    /// Print the completions for a shell.
    Completions(Completions),
    /// Print the manual page, or that of a command.
    Man(Man),
}

/// A whole number that is not negative.
fn whole(text: &str) -> Result<u64, String> {
    let number = text.parse();
    number.map_err(|_| format!("a whole number from 0 to {} is allowed", u64::MAX))
}

/// A number, of which more is asked where it is used.
fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let number = number.filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "a number is allowed, such as 0.5 or 1e-3".into())
}

/// A number of samples, which may be written with a power of ten.
fn samples(text: &str) -> Result<u64, String> {
    let number = text.parse().ok().filter(|x: &f64| *x >= 1.0);
    // What is larger than any number of samples allows all.
    number
        .map(|x| x as u64)
        .ok_or_else(|| "a number from 1 is allowed, such as 5000000000 or 5e9".into())
}

/// Least memory that may be allowed, bytes: what a log of some minutes takes.
const LEAST_MEMORY: u64 = 1_000_000;

/// A size in bytes.
fn memory(text: &str) -> Result<u64, String> {
    let size = stiction_number::parse_bytes(text);
    size.filter(|size| *size >= LEAST_MEMORY)
        .ok_or_else(|| "a size from 1MB is allowed, such as 500MB, 2GB or 1.5GiB".into())
}

/// Units of a time and what they are in seconds; the longer ones before those that they end in.
const TIMES: [(&str, f64); 6] = [
    ("us", 1e-6),
    ("ms", 1e-3),
    ("min", 60.0),
    ("s", 1.0),
    ("h", 3600.0),
    ("", 1.0),
];

/// A time with or without its unit, in seconds; what else is said otherwise.
fn time(text: &str, allowed: &str) -> Result<f64, String> {
    let text = text.trim();
    let split = TIMES
        .iter()
        .find_map(|(unit, by)| Some((text.strip_suffix(unit)?, by)));
    let parsed = split.and_then(|(text, by)| Some(by * number(text).ok()?));
    parsed.ok_or_else(|| allowed.into())
}

/// The time of a motion.
fn duration(text: &str) -> Result<f64, String> {
    time(
        text,
        "a time from 2s to 600s is allowed, such as 9s or 0.5min",
    )
}

/// A time that a search may take.
fn budget(text: &str) -> Result<f64, String> {
    time(
        text,
        "a time above 0 is allowed, in seconds or with its unit (us, ms, s, min, h), such as 30, 30s or 2min",
    )
}

/// A time to record.
fn recording_time(text: &str) -> Result<f64, String> {
    time(text, "a time above 0 is allowed, such as 30s or 2min")
}

/// A rate with or without its unit, in Hz.
fn rate(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (digits, by) = match (text.strip_suffix("kHz"), text.strip_suffix("Hz")) {
        (Some(digits), _) => (digits, 1e3),
        (None, Some(digits)) => (digits, 1.0),
        (None, None) => (text, 1.0),
    };
    let rate = number(digits).ok().map(|number| by * number);
    let rate = rate.filter(|rate| *rate > 0.0);
    rate.ok_or_else(|| "a rate above 0 is allowed, such as 500Hz or 1kHz".into())
}

/// A time of a controller.
fn seconds(text: &str) -> Result<f64, String> {
    time(
        text,
        "a time is allowed, in seconds or with its unit (us, ms, s, min, h), such as 0.001 or 1ms",
    )
}

/// The names of all commands.
pub const COMMANDS: &[&str] = &[
    "demo",
    "record",
    "check",
    "identify",
    "robot",
    "batch",
    "drift",
    "plan",
    "compare",
    "simulate",
    "reproduce",
    "export",
    "library",
    #[cfg(feature = "studio")]
    "studio",
    "completions",
    "man",
];

#[derive(Clone, Debug, Args)]
pub struct Completions {
    /// Which shell.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

#[derive(Clone, Debug, Args)]
pub struct Man {
    /// A command of stiction.
    #[arg(value_name = "COMMAND", value_parser = PossibleValuesParser::new(COMMANDS))]
    pub command: Option<String>,
}

#[derive(Clone, Debug, Args)]
pub struct Demo {
    /// Folder for the log and the results.
    #[arg(long, value_name = "DIR", default_value = "stiction-demo")]
    pub out: PathBuf,
    /// Seed of the simulated noise and of the search.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole)]
    pub seed: u64,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
    /// Write logs for every procedure instead (constant speeds, force ramps, force steps), and say
    /// how to identify them.
    #[arg(long)]
    pub procedures: bool,
    /// Run the motion of a plan on the axis of the demo instead, as if it were the machine, and write its log.
    #[arg(long, value_name = "PLAN.toml", conflicts_with = "procedures")]
    pub plan: Option<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub struct Record {
    /// ads://NETID:PORT/SYMBOL with further symbols behind it, or rtde://HOST. Where the first four numbers of the NetID are not
    /// the address of the PLC: ads://NETID:PORT@HOST/SYMBOL. A symbol may have a unit: MAIN.fPos=mm.
    #[arg(required = true, value_name = "URL")]
    pub device: Vec<String>,
    /// Samples a second, such as 500Hz or 1kHz: for ADS that of the task [default: 1kHz for ADS, 125Hz for RTDE].
    #[arg(long, value_name = "RATE", allow_negative_numbers = true, value_parser = rate)]
    pub rate: Option<f64>,
    /// Time to record, such as 30s or 2min [default: until Ctrl-C].
    #[arg(long, value_name = "TIME", allow_negative_numbers = true, value_parser = recording_time)]
    pub time: Option<f64>,
    /// The log, .csv or .parquet; a file that exists is kept.
    #[arg(long, value_name = "LOG")]
    pub out: PathBuf,
}

#[derive(Clone, Debug, Args)]
pub struct Check {
    /// Logs: text, MATLAB, HDF5, Parquet, JSON and others; with --axis by default those of its [[log]].
    #[arg(required_unless_present = "axis", value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// What is known of the axis and its columns.
    #[arg(long, value_name = "AXIS.toml")]
    pub axis: Option<PathBuf>,
    /// Write an axis file with what was found in the first log; with --axis, that file with what it lacks.
    #[arg(long, value_name = "AXIS.toml", num_args = 0..=1, default_missing_value = "axis.toml")]
    pub init: Option<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub struct Identify {
    /// Logs of one axis, fitted together: text, MATLAB, HDF5, Parquet, JSON and others; with --axis by default those of its
    /// [[log]].
    #[arg(required_unless_present_any = ["break_away", "axis"], value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// What is known of the axis and its columns.
    #[arg(long, value_name = "AXIS.toml")]
    pub axis: Option<PathBuf>,
    /// Friction law; methods other than separable take lugre for auto.
    #[arg(long, value_enum, default_value_t = Law::Auto)]
    pub law: Law,
    /// Parameters of its own for each direction of motion.
    #[arg(long)]
    pub asymmetric: bool,
    /// How the parameters are found.
    #[arg(long, value_enum, default_value_t = Method::Separable)]
    pub method: Method,
    #[command(flatten)]
    pub searching: Searching,
    /// Logs of constant velocities to take the steady curve from, instead of the logs themselves.
    #[arg(long = "static", value_name = "LOG", num_args = 1..)]
    pub statics: Vec<PathBuf>,
    /// Model of an earlier identification, for what is not identified here.
    #[arg(long, value_name = "MODEL.toml")]
    pub model: Option<PathBuf>,
    /// Logs of force ramps, one break-away each; reported with their rate, not fitted unless they are the only logs of
    /// --method output-error.
    #[arg(long, value_name = "LOG", num_args = 1..)]
    pub break_away: Vec<PathBuf>,
    /// The plan.toml that a log was recorded by: which of its pieces ran, and what was expected of each parameter beside what was found.
    #[arg(long, value_name = "PLAN.toml")]
    pub plan: Option<PathBuf>,
    /// Logs to validate on; they are not fitted.
    #[arg(long, value_name = "LOG", num_args = 1.., conflicts_with = "split")]
    pub validate: Vec<PathBuf>,
    /// Fit the first part of the samples and validate on the rest: a share between 0 and 1, such as 0.5 for the first
    /// half [default: all are fitted].
    #[arg(long, value_name = "PART", allow_negative_numbers = true, value_parser = number)]
    pub split: Option<f64>,
    /// Seed of the search.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole)]
    pub seed: u64,
    /// Folder for result.json, model.toml, report.html and fit.csv.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Robot {
    /// Logs of one robot with positions and torques or currents of its joints, fitted together: ROS 2 bags, text, MATLAB, HDF5,
    /// Parquet, JSON and others.
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// The URDF of the robot [default: that of the robot file].
    #[arg(long, value_name = "ARM.urdf", required_unless_present = "axis")]
    pub urdf: Option<PathBuf>,
    /// What is known of the robot, its joints and their columns.
    #[arg(long, value_name = "ROBOT.toml")]
    pub axis: Option<PathBuf>,
    /// Logs to validate on; they are not fitted.
    #[arg(long, value_name = "LOG", num_args = 1.., conflicts_with = "split")]
    pub validate: Vec<PathBuf>,
    /// Fit the first part of the time of each log and validate on the rest: a share between 0 and 1, such as 0.5 for the first
    /// half [default: all is fitted].
    #[arg(long, value_name = "PART", allow_negative_numbers = true, value_parser = number)]
    pub split: Option<f64>,
    /// Seed of the searches.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole)]
    pub seed: u64,
    /// Folder for robot.json, robot.toml, report.html and a folder for each joint.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Batch {
    /// Folders (with those below them), logs, patterns such as 'logs/**/*.csv', or lists: CSV with a column path, and where they
    /// are known machine, time, temperature and axis.
    #[arg(required = true, value_name = "LOGS")]
    pub inputs: Vec<PathBuf>,
    /// What is known of the axis and its columns, for logs to which a list gives no axis file.
    #[arg(long, value_name = "AXIS.toml")]
    pub axis: Option<PathBuf>,
    /// Friction law; methods other than separable take lugre for auto. Name one for results that are followed over time.
    #[arg(long, value_enum, default_value_t = Law::Auto)]
    pub law: Law,
    /// Parameters of its own for each direction of motion.
    #[arg(long)]
    pub asymmetric: bool,
    /// How the parameters are found.
    #[arg(long, value_enum, default_value_t = Method::Separable)]
    pub method: Method,
    /// Fit the first part of the samples of each log and validate on the rest: a share between 0 and 1 [default: all are
    /// fitted].
    #[arg(long, value_name = "PART", allow_negative_numbers = true, value_parser = number)]
    pub split: Option<f64>,
    /// Seed of the searches.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole)]
    pub seed: u64,
    /// Write the report and the model of each log as well, into DIR/reports.
    #[arg(long)]
    pub reports: bool,
    /// Take the logs that an earlier call has left in the folder, whether it was finished or not: those with the same bytes, axis
    /// file and options are not identified again.
    #[arg(long)]
    pub resume: bool,
    /// Folder for results.parquet and batch.json.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Library {
    /// A machine of the library [default: all are listed].
    #[arg(value_name = "MACHINE", value_parser = PossibleValuesParser::new(stiction_workflows::library::Library::names()))]
    pub machine: Option<String>,
    /// Folder for its files [default: nothing is written].
    #[arg(long, value_name = "DIR", requires = "machine")]
    pub out: Option<PathBuf>,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long, requires = "out")]
    pub force: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Drift {
    /// The table that stiction batch wrote.
    #[arg(value_name = "RESULTS.parquet")]
    pub results: PathBuf,
    /// A level that is an alarm too, such as "coulomb > 1.3" for 1.3 times the first logs, or "coulomb > 25 N"; may be given
    /// several times.
    #[arg(long, value_name = "LIMIT")]
    pub limit: Vec<String>,
    /// Times of the logs, in place of those in the table.
    #[arg(long, value_enum)]
    pub times: Option<Times>,
    /// Folder for drift.json and report.html [default: nothing is written].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long, requires = "out")]
    pub force: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Times {
    /// Dates in the names of the logs, or of the folders that they are in.
    Names,
    /// When the files were written.
    Files,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Law {
    /// Of the laws that can be exported, symmetric and asymmetric, the one that predicts unseen samples best.
    Auto,
    /// Coulomb and viscous friction, no memory.
    CoulombViscous,
    /// Static Stribeck curve, no memory.
    Stribeck,
    /// Presliding and Coulomb friction.
    Dahl,
    /// Presliding, Stribeck curve, frictional lag.
    Lugre,
    /// LuGre that does not creep below break-away.
    ElastoPlastic,
    /// Maxwell slip: presliding with memory of past reversals.
    MaxwellSlip,
    /// Generalised Maxwell slip: the same with a Stribeck curve.
    Gms,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// Motion in, force out: three nonlinear unknowns searched, everything else solved exactly.
    Separable,
    /// Steady curve from stretches of constant velocity.
    Static,
    /// Steady curve first, then stiffness and micro-damping with it held.
    StaticThenDynamic,
    /// Stiffness and micro-damping from force steps below break-away.
    PreslidingStep,
    /// Force in, position out: the axis simulated, with its controller where the axis file has one.
    OutputError,
    /// Plain genetic algorithm.
    Ga,
    /// Genetic algorithm with adaptive rates.
    AdaptiveGa,
    /// Annealing genetic algorithm of Zhang et al. 2025.
    AnnealingGa,
    /// Annealing genetic algorithm in niches, with descents that must agree.
    NichedGa,
    /// Differential evolution.
    De,
    /// Covariance matrix adaptation.
    CmaEs,
    /// Particle swarm.
    Pso,
    /// Simulated annealing.
    Annealing,
    /// Simplex method, restarted.
    NelderMead,
    /// Least squares from many starts.
    Lm,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Cost {
    /// Six parameters of the symmetric LuGre law at once, mass and offset solved.
    Six,
    /// The nonlinear unknowns of the law only, everything linear solved.
    Separable,
}

/// For the searches (ga to lm).
#[derive(Clone, Debug, Args)]
pub struct Searching {
    /// For --method static and static-then-dynamic: the search that finds the parameters of each step before least squares,
    /// one of ga to lm [default: least squares alone].
    #[arg(long, value_name = "METHOD", value_parser = PossibleValuesParser::new(stiction_workflows::identify::Method::SEARCHES))]
    pub search: Option<String>,
    /// Leave out the least squares after a search: the parameters are what it found by itself, without intervals.
    #[arg(long)]
    pub no_finish: bool,
    /// What a search evaluates [default: six for ga, adaptive-ga and annealing-ga on the symmetric
    /// LuGre law, else separable].
    #[arg(long, value_enum, value_name = "COST")]
    pub cost: Option<Cost>,
    /// End a search after N evaluations of its cost, 1 or more; evaluations with derivatives are counted apart, up to N as
    /// well [default: 20000].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub evaluations: Option<u64>,
    /// End a search when its cost is at most J, above 0: the square of the relative error, so 1e-4 is an error of 1 %
    /// [default: none].
    #[arg(long, value_name = "J", allow_negative_numbers = true, value_parser = number)]
    pub target: Option<f64>,
    /// End a search so long after it began, such as 30s or 2min, above 0; the least squares that follow it are not limited
    /// [default: no limit].
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = budget)]
    pub time: Option<f64>,
    /// Keep the state of a search here, every few seconds and at the end.
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Go on from a state that --checkpoint kept.
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub struct Compare {
    /// Logs of one axis, fitted together.
    #[arg(
        value_name = "LOG",
        required_unless_present = "problem",
        conflicts_with = "problem"
    )]
    pub logs: Vec<PathBuf>,
    /// A problem whose answer is known: C95, machine, motor, V5, V6, V10, V16 (LuGre axes), V2, V3, V7
    /// (steady curves).
    #[arg(long, value_name = "NAME")]
    pub problem: Option<String>,
    /// What is known of the axis and the columns of a log; for a problem only its [search] counts.
    #[arg(long, value_name = "AXIS.toml")]
    pub axis: Option<PathBuf>,
    /// Methods, separated by commas [default: all that the cost allows]; lm-one is least squares from
    /// one start drawn at random.
    #[arg(long, value_name = "A,B,..", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Seeds of each method.
    #[arg(long, value_name = "N", default_value_t = 30, allow_negative_numbers = true, value_parser = whole)]
    pub seeds: u64,
    /// End a run after N evaluations of its cost, 1 or more; evaluations with derivatives are counted apart, up to N as well.
    #[arg(long, value_name = "N", default_value_t = 20_000, allow_negative_numbers = true, value_parser = whole)]
    pub evaluations: u64,
    /// Noise of a problem: deviation over the largest force [default: 0.01].
    #[arg(long, value_name = "PART", allow_negative_numbers = true, value_parser = number)]
    pub noise: Option<f64>,
    /// Motion of a problem [default: sine].
    #[arg(long, value_enum)]
    pub excitation: Option<Excitation>,
    /// Sample rate of a problem, for 3 s of motion [default: 1000].
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = number)]
    pub rate: Option<f64>,
    /// Make the data of a problem by another law than the one that is fitted.
    #[arg(long)]
    pub other_law: bool,
    /// Decades of the box to each side of a point off the answer [default: 1 for a problem, the box of
    /// identify for a log].
    #[arg(long = "box", value_name = "DECADES", allow_negative_numbers = true, value_parser = number)]
    pub decades: Option<f64>,
    /// What integrates the candidates.
    #[arg(long, value_enum, default_value_t = Integrator::Explin)]
    pub integrator: Integrator,
    /// What is minimised [default: six].
    #[arg(long, value_enum)]
    pub cost: Option<CompareCost>,
    /// Samples on which candidates may be computed, such as 5e12: runs times evaluations times samples of the record; a comparison
    /// with more is refused before it begins.
    #[arg(long, value_name = "N", value_parser = samples, default_value = "1e12", allow_negative_numbers = true)]
    pub max_samples: u64,
    /// Take the runs that an earlier call for this comparison has left in the folder, where it was stopped or ended by force.
    #[arg(long)]
    pub resume: bool,
    /// Folder for compare.json and report.html.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Excitation {
    /// Velocity sine of ten times the Stribeck velocity, 1 Hz.
    Sine,
    /// Three sines together.
    MultiSine,
    /// Fast, slow, and fast with a small stroke, one after the other.
    ThreeSegments,
    /// Force ramps until the axis breaks away.
    BreakAway,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Integrator {
    /// Exact for a constant ratio of speed to level; stable for every candidate.
    Explin,
    /// Forward Euler, as the publication writes it; explodes for stiff candidates.
    Euler,
    /// Runge-Kutta of order 4; explodes for stiff candidates.
    Rk4,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CompareCost {
    /// Six parameters of LuGre at once, force out.
    Six,
    /// Its three nonlinear unknowns, everything linear solved.
    Separable,
    /// Six parameters, force in and position out.
    Position,
    /// Its steady curve from constant velocities: the static step of the 2025 paper.
    Curve,
    /// sigma0 and sigma1 with the steady curve known: its dynamic step.
    Dynamic,
}

#[derive(Clone, Debug, Args)]
pub struct Simulate {
    /// What to simulate: axis, paths, controllers, compensators.
    #[arg(
        value_name = "STUDY.toml",
        required_unless_present = "init",
        conflicts_with = "init"
    )]
    pub study: Option<PathBuf>,
    /// Folder for study.json and report.html.
    #[arg(
        long,
        value_name = "DIR",
        required_unless_present = "init",
        conflicts_with = "init"
    )]
    pub out: Option<PathBuf>,
    /// Write a study file that runs as it is, of a known axis or of that of --model.
    #[arg(long, value_name = "STUDY.toml", num_args = 0..=1, default_missing_value = "study.toml")]
    pub init: Option<PathBuf>,
    /// For --init: the model of the axis, as written by stiction identify.
    #[arg(
        long,
        value_name = "MODEL.toml",
        requires = "init",
        conflicts_with = "study"
    )]
    pub model: Option<PathBuf>,
    /// For --init: the model of a second axis, which may be the same; both then go along a circle.
    #[arg(long, value_name = "MODEL.toml", requires = "model")]
    pub second_model: Option<PathBuf>,
    /// Compiles the C in this folder, which stiction export --target c wrote, with gcc and runs it beside the compensator of the
    /// model.
    #[arg(long, value_name = "DIR", conflicts_with = "init")]
    pub exported_c: Option<PathBuf>,
    /// Samples that may be simulated, such as 5e9; a study that simulates more is refused before it begins.
    #[arg(long, value_name = "N", value_parser = samples, default_value = "2e9", conflicts_with = "init", allow_negative_numbers = true)]
    pub max_samples: u64,
    /// Take the runs that an earlier call for this study has left in the folder, where it was stopped or ended by force.
    #[arg(long, conflicts_with = "init")]
    pub resume: bool,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Reproduce {
    /// Which publication.
    #[arg(value_enum)]
    pub publication: Publication,
    /// The experiments of the paper on your own axis: its model, as stiction identify writes it.
    #[arg(long, value_name = "MODEL.toml")]
    pub model: Option<PathBuf>,
    /// What else is known of that axis: mass, encoder step, force limit, name.
    #[arg(long, value_name = "AXIS.toml", requires = "model")]
    pub axis: Option<PathBuf>,
    /// Folder for reproduce.json and report.html.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Plan {
    /// What is known of the axis, with its [limits].
    #[arg(value_name = "AXIS.toml")]
    pub axis: PathBuf,
    /// A first model of the axis: plan for what it leaves open instead of for the nameplate.
    #[arg(long, value_name = "MODEL.toml", conflicts_with = "log")]
    pub model: Option<PathBuf>,
    /// A first log, such as that of --stage probe: it is identified, and the motion is planned for what it leaves open.
    #[arg(long, value_name = "LOG")]
    pub log: Option<PathBuf>,
    /// The law that is fitted; Maxwell-slip elements need a first log or model [default: that of the model, else LuGre, or gms where the
    /// axis file has gms_elements].
    #[arg(long, value_enum)]
    pub law: Option<PlannedLaw>,
    /// Plan for parameters of each direction of motion, as identify --asymmetric finds them.
    #[arg(long)]
    pub asymmetric: bool,
    /// A first, careful motion whose log is for --log, or the whole.
    #[arg(long, value_enum, default_value_t = Stage::Whole)]
    pub stage: Stage,
    /// Longest motion, from rest to rest [default: 9s, of a probe 3s, with --want 60s].
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = duration)]
    pub time: Option<f64>,
    /// How well a parameter is to be known on nine of ten axes, such as "sigma0 < 2 %", or "all < 1 %": the shortest motion that
    /// is enough; may be given several times.
    #[arg(long = "want", value_name = "WISH")]
    pub wants: Vec<String>,
    /// Seed of the axes that it is planned for.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole)]
    pub seed: u64,
    /// Another form of the set points, for a controller; may be given several times.
    #[arg(long = "format", value_enum, value_name = "FORM")]
    pub formats: Vec<Form>,
    /// Position at which the axis stands when the motion starts, such as "120 mm": all set points but those of a block count from it [default: 0].
    #[arg(long, value_name = "POSITION", allow_hyphen_values = true)]
    pub start: Option<String>,
    /// Folder for plan.toml, setpoints.csv and report.html.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PlannedLaw {
    /// Presliding, Stribeck curve, frictional lag.
    Lugre,
    /// Maxwell slip: presliding with memory of past reversals.
    MaxwellSlip,
    /// Generalised Maxwell slip: the same with a Stribeck curve.
    Gms,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// A block of IEC 61131-3 Structured Text that computes the motion in the cycle of the PLC.
    St,
    /// A cam over time.
    Cam,
    /// CiA 402, cyclic synchronous position: whole counts for each cycle.
    Csp,
    /// Inputs of MC_ExtSetPointGenFeed of TwinCAT for each cycle.
    Feed,
    /// JointTrajectory of ROS 2.
    Ros2,
    /// Lines for halstreamer of LinuxCNC.
    Halstreamer,
    /// Strokes between the reversals: another motion, where nothing else can be run.
    Gcode,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Stage {
    /// A few seconds at half the speed and acceleration.
    Probe,
    /// All that the limits allow.
    Whole,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Publication {
    /// The LuGre paper: presliding, lag, break-away, stick-slip, hunting, drift.
    #[value(name = "1995")]
    Canudas1995,
    /// Identification by an annealing GA and feedforward on a linear motor axis, Zhang et al. 2025.
    #[value(name = "paper")]
    Zhang2025,
}

#[derive(Clone, Debug, Args)]
pub struct Export {
    /// Model as written by stiction identify, or robot.toml as written by stiction robot.
    #[arg(value_name = "MODEL.toml")]
    pub model: PathBuf,
    /// What to write.
    #[arg(long, value_enum)]
    pub target: Target,
    /// Folder for the files.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else; files of the same names are replaced.
    #[arg(long)]
    pub force: bool,
    /// Time between two calls of the compensator, s, or with its unit: 500us.
    #[arg(
        long,
        value_name = "TIME",
        default_value = "0.001",
        allow_hyphen_values = true,
        value_parser = seconds
    )]
    pub cycle_time: f64,
    /// Largest force, in the unit of the model's force [default: twice static friction and offset].
    #[arg(long, value_name = "FORCE", allow_negative_numbers = true, value_parser = number)]
    pub limit: Option<f64>,
    /// Share of the friction that is compensated, 0 to 1 [default: 0.75].
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true, value_parser = number)]
    pub gain: Option<f64>,
    /// Time in which the compensation comes in and goes, s, or with its unit [default: 0.05].
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = seconds)]
    pub ramp: Option<f64>,
    /// Speeds up to this count as standstill, m/s or rad/s [default: from the law].
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, value_parser = number)]
    pub dead_zone: Option<f64>,
    /// Fastest change of the force, in the unit of the model's force per second [default: from the law].
    #[arg(long, value_name = "RATE", allow_negative_numbers = true, value_parser = number)]
    pub slew: Option<f64>,
    /// Moving time that the watchdog compares, a cycle of the motion, s, or with its unit; 0: no watchdog [default: 2].
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = seconds)]
    pub window: Option<f64>,
    /// Levels of friction that follow the machine while it runs, from the force of the drive.
    #[arg(long)]
    pub adapt: bool,
    /// What is fed forward: friction, and of mass, gravity and cogging what the model has; of a robot friction and rigid.
    #[arg(
        long,
        value_name = "PARTS",
        value_delimiter = ',',
        default_value = "friction"
    )]
    pub feedforward: Vec<String>,
    /// Draws of what a simulator takes, 1 to 100000, beside nominal values and ranges; for domain-json, mujoco, isaaclab, newton, bam.
    #[arg(long, value_name = "N")]
    pub draws: Option<usize>,
    /// Seed of the draws: the same gives the same bytes.
    #[arg(long, value_name = "S", default_value_t = 0, requires = "draws")]
    pub seed: u64,
    /// Which intervals the draws are from: another day, or another motion.
    #[arg(long, value_enum, default_value = "transfer", requires = "draws")]
    pub width: Width,
    /// Rated force of the motor, in the unit of the model's force; for tf5200.
    #[arg(long, value_name = "FORCE", allow_negative_numbers = true, value_parser = number)]
    pub rated_force: Option<f64>,
    /// URDF in place of the one that robot.toml names.
    #[arg(long, value_name = "FILE")]
    pub urdf: Option<PathBuf>,
    /// What the names in the code begin with [default: from the name of the axis].
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Width {
    /// The same motion on another day.
    Repeatability,
    /// Another motion.
    Transfer,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// C99, double and single precision.
    C,
    /// A header-only C++11 library for Arduino, PlatformIO and others.
    Cpp,
    /// The same as a class whose settings are parameters of a node of ROS 2.
    Ros2,
    /// IEC 61131-3 Structured Text, LREAL and REAL.
    St,
    /// The same as TwinCAT 3 objects.
    Tcpou,
    /// The same as PLCopen TC6 XML.
    Plcopen,
    /// A no_std crate with the law's own source.
    Rust,
    /// The friction of a joint in MuJoCo 4.
    Mujoco,
    /// The law as a differential equation in Modelica, for simulation.
    Modelica,
    /// Coulomb and viscous friction of a joint in URDF.
    Urdf,
    /// The same in SDFormat, for Gazebo.
    Sdf,
    /// The same, and static friction, of an actuator of Isaac Lab.
    Isaaclab,
    /// Friction, damping and armature of joints in Newton.
    Newton,
    /// Parameters of BAM, Better Actuator Models.
    Bam,
    /// What simulators take with its ranges, and draws from them.
    DomainJson,
    /// A component of LinuxCNC's HAL.
    Hal,
    /// FMUs for co-simulation, FMI 2.0 and 3.0.
    Fmu,
    /// Functions of MATLAB and Octave, and an S-function of Simulink.
    Matlab,
    /// The friction table of TwinCAT CNC.
    Tf5200,
    /// Numbers for the friction compensation that drives have built in.
    DriveTable,
    /// Cogging as maps of the force, of which ODrive and moteus hold one.
    CoggingMap,
    /// Backlash as a correction of the position, for LinuxCNC and TwinCAT.
    Backlash,
}

#[cfg(feature = "studio")]
#[derive(Clone, Debug, Args)]
pub struct Studio {
    /// Folder to work in; nothing outside of it is read or written [default: the current one].
    #[arg(value_name = "FOLDER")]
    pub folder: Option<PathBuf>,
    /// Port of this machine to listen on [default: one that is free].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub port: Option<u16>,
    /// Print the address and open no browser.
    #[arg(long)]
    pub no_open: bool,
}
