//! What can be typed.

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

#[derive(Clone, Debug, Args)]
pub struct Common {
    /// Print the result as JSON on standard output, and nothing else there.
    #[arg(long, global = true)]
    pub json: bool,
    /// Print errors only.
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Threads to use [default: one a core]; results do not depend on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// A known axis, a realistic log, identify it, compare with the truth: no input needed.
    Demo(Demo),
    /// What was read and detected, and what this log can and cannot determine.
    Check(Check),
    /// Identify a friction law from logs of one axis.
    Identify(Identify),
    /// Write the compensator of a model as code or tables for a controller.
    Export(Export),
}

#[derive(Clone, Debug, Args)]
pub struct Demo {
    /// Folder for the log and the results.
    #[arg(long, value_name = "DIR", default_value = "stiction-demo")]
    pub out: PathBuf,
    /// Seed of the simulated noise and of the search.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Write into a folder that holds something else.
    #[arg(long)]
    pub force: bool,
    /// Write logs for every procedure instead (constant speeds, force ramps, force steps), and say
    /// how to identify them.
    #[arg(long)]
    pub procedures: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Check {
    /// Logs: text, MATLAB, HDF5, NumPy or Parquet.
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// What is known of the axis and its columns.
    #[arg(long, value_name = "AXIS.toml")]
    pub axis: Option<PathBuf>,
    /// Write an axis file to fill in, from the first log; an existing file is kept.
    #[arg(long, value_name = "AXIS.toml", num_args = 0..=1, default_missing_value = "axis.toml",
          conflicts_with = "axis")]
    pub init: Option<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub struct Identify {
    /// Logs of one axis, fitted together: text, MATLAB, HDF5, NumPy or Parquet.
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// What is known of the axis and its columns.
    #[arg(long, value_name = "AXIS.toml")]
    pub axis: Option<PathBuf>,
    /// Friction law.
    #[arg(long, value_enum, default_value_t = Law::Lugre)]
    pub law: Law,
    /// Parameters of its own for each direction of motion.
    #[arg(long)]
    pub asymmetric: bool,
    /// How the parameters are found.
    #[arg(long, value_enum, default_value_t = Method::Separable)]
    pub method: Method,
    /// Logs of constant velocities to take the steady curve from, instead of the logs themselves.
    #[arg(long = "static", value_name = "LOG", num_args = 1..)]
    pub statics: Vec<PathBuf>,
    /// Model of an earlier identification, for what is not identified here.
    #[arg(long, value_name = "MODEL.toml")]
    pub model: Option<PathBuf>,
    /// Logs of force ramps, one break-away each; reported with their rate, not fitted.
    #[arg(long, value_name = "LOG", num_args = 1..)]
    pub break_away: Vec<PathBuf>,
    /// Logs to validate on; they are not fitted.
    #[arg(long, value_name = "LOG", num_args = 1.., conflicts_with = "split")]
    pub validate: Vec<PathBuf>,
    /// Fit this first part of the samples and validate on the rest, such as 0.5.
    #[arg(long, value_name = "PART")]
    pub split: Option<f64>,
    /// Seed of the search.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Folder for result.json, model.toml, report.html and fit.csv.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Write into a folder that holds something else.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Law {
    /// Every law, symmetric and asymmetric; the one that holds on unseen samples is taken.
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
}

#[derive(Clone, Debug, Args)]
pub struct Export {
    /// Model as written by stiction identify.
    #[arg(value_name = "MODEL.toml")]
    pub model: PathBuf,
    /// What to write.
    #[arg(long, value_enum)]
    pub target: Target,
    /// Folder for the files; new or empty.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Time between two calls of the compensator, s.
    #[arg(long, value_name = "S", default_value_t = 1e-3)]
    pub cycle_time: f64,
    /// Largest force, N or N m [default: twice static friction and offset].
    #[arg(long, value_name = "N")]
    pub limit: Option<f64>,
    /// What the names in the code begin with [default: from the name of the axis].
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// C99, double and single precision.
    C,
    /// IEC 61131-3 Structured Text, LREAL and REAL.
    St,
    /// The same as TwinCAT 3 objects.
    Tcpou,
    /// The same as PLCopen TC6 XML.
    Plcopen,
    /// A no_std crate on stiction-friction.
    Rust,
    /// The friction of a joint in MuJoCo 4.
    Mujoco,
}
