//! Friction of servo axes: from a drive's log to a law with intervals, and on to its compensation.
//!
//! Begin with [`Log::open`] and [`identify()`]. A log in, a law out, with what may be said of each number:
//!
//! ```
//! use stiction::{Axis, Input, Log, Options, demo, identify};
//!
//! # let folder = tempfile::tempdir()?;
//! # std::env::set_current_dir(&folder)?;
//! // A recording to begin with: a simulated axis, as a drive would log it. Your own file does as well.
//! demo::write_log("run.csv", 1)?;
//! demo::write_log("another.csv", 2)?;
//!
//! // Read. Columns and units are those in the file; `Axis::read("axis.toml")` states what it does not say.
//! let axis = Axis::default();
//! let log = Log::open_with("run.csv", &axis)?;
//! println!("{} samples at {} Hz", log.samples(), log.rate_hz());
//!
//! // Identify LuGre, the default law; `options.law = None` lets the data choose.
//! let fit = identify(&[log], &axis, &Options::default())?;
//!
//! // Look at an interval, and at what the log does not determine.
//! let coulomb = fit.parameter("coulomb").expect("every law has a Coulomb level");
//! println!("{} = {:.2} {}, 95 %: {:?}", coulomb.symbol(), coulomb.value(), coulomb.unit(), coulomb.interval());
//! for p in fit.parameters().filter(|p| !p.is_identifiable()) {
//!     println!("do not use {}: {} {}", p.name(), p.reason(), p.advice());
//! }
//! assert!(fit.is_trustworthy(), "{:?}", fit.reasons());
//!
//! // Predict another log; nothing is fitted again.
//! let unseen = Log::open_with("another.csv", &axis)?;
//! let error = fit.predict(&unseen)?.quality.relative_error_percent;
//! assert!(error < 1.2);
//!
//! // Compensate at 4 kHz, along a reference that goes to and fro. The force comes in once the watchdog has seen the axis
//! // reverse without it.
//! let mut compensator = fit.compensator(250e-6)?;
//! for k in 0..80_000 {
//!     let t = f64::from(k) * 250e-6; // s
//!     let reference_velocity = 0.02 * (6.0 * t).sin(); // m/s
//!     let force = compensator.step(Input { reference_velocity, enable: true, ..Input::default() });
//!     if k % 8000 == 0 {
//!         println!("{t:4.1} s: {force:6.2} N");
//!     }
//! }
//! # let share = compensator.state().share;
//! # assert!((share - compensator.settings().gain).abs() < 1e-9, "{share}");
//! # assert!((19.5..20.5).contains(&coulomb.value()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Columns in memory go the same way; here with other options, a log to validate on, and on to files and code:
//!
//! ```
//! use stiction::{Axis, Column, ExportOptions, LawKind, Log, Options, Target, export, identify_validated};
//! # let folder = tempfile::tempdir()?;
//! # let folder = folder.path();
//!
//! // An axis of 9 kg with 20 N of Coulomb and 60 N s/m of viscous friction, moved to and fro.
//! let axis = Axis::parse("name = \"X\"\nkind = \"linear\"\n")?;
//! let run = |name: &str, stroke: f64| {
//!     let time: Vec<f64> = (0..6000).map(|k| 1e-3 * f64::from(k)).collect();
//!     let motion = |t: f64| (stroke * (6.0 * t).sin(), 6.0 * stroke * (6.0 * t).cos());
//!     let force = |t: f64| 20.0 * motion(t).1.signum() + 60.0 * motion(t).1 - 9.0 * 36.0 * motion(t).0;
//!     let column = |name: &str, unit: &str, values: Vec<f64>| Column {
//!         name: name.into(),
//!         unit: Some(unit.into()),
//!         values,
//!         ..Column::default()
//!     };
//!     let position = time.iter().map(|&t| 1e3 * motion(t).0).collect();
//!     let force = time.iter().map(|&t| force(t)).collect();
//!     let columns = vec![column("time", "s", time), column("position", "mm", position), column("force", "N", force)];
//!     Log::from_columns(name, columns, &axis)
//! };
//!
//! let mut options = Options::default();
//! options.law = Some(LawKind::CoulombViscous);
//! options.compare_laws = false; // with no other law
//! let fit = identify_validated(&[run("run 1", 0.05)?], &[run("run 2", 0.08)?], &axis, &options)?;
//! let mass = fit.parameter("mass").expect("a fitted mass");
//! assert!((mass.value() - 9.0).abs() < 0.1, "{}", mass.value());
//!
//! fit.write(folder.join("result"))?; // result.json, model.toml, report.html, fit.csv
//! let code = export(&fit.model(), &ExportOptions::new(Target::C, 1e-3))?; // called every millisecond
//! code.write(folder.join("controller"), false)?; // true: over whatever is there
//! # assert!(code.written.iter().any(|name| name.ends_with(".c")), "{:?}", code.written);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | from | to | with |
//! |---|---|---|
//! | a file or columns in memory | [`Log`] | [`Log::open`], [`Log::from_columns`] |
//! | what is known of the machine | [`Axis`] | [`Axis::read`], [`Axis::parse`] |
//! | logs | [`Fit`] | [`identify()`], [`identify_validated`], [`identify_observed`] |
//! | a folder with a result | [`SavedFit`] | [`SavedFit::read`] |
//! | a fit | law, prediction, compensator, files | [`Fit::law`], [`Fit::predict`], [`Fit::compensator`], [`Fit::write`] |
//! | a model | code for a controller | [`export()`] |
//! | logs of a robot and its URDF | its rigid body and a fit of each joint | [`robot`] |
//! | a name in the library | a machine that is identified already | [`library`] |
//! | a study file | tracking errors with and without compensation | [`Study::read`], [`simulate`] |
//!
//! SI throughout; a force that the log has in A or V stays in it. Results do not depend on the number of threads. A result
//! that should not be trusted is no error: [`Fit::is_trustworthy`] says so, and [`Fit::reasons`] why.
//!
//! [`commands`] has what the command line is made of: the same work from paths to outcomes, and the texts and reports of it.

pub mod bundle;
pub mod commands;
mod fit;
mod fit_csv;
mod identify;
pub mod library;
mod log;
mod parameter;
pub mod robot;
mod saved;
mod stepped;

pub use fit::Fit;
pub use fit_csv::columns as fit_columns;
pub use identify::{
    Files, Options, check, identify, identify_files, identify_observed, identify_validated,
};
pub use log::{Column, Finding, Log, Severity};
pub use parameter::Parameter;
pub use saved::SavedFit;
pub use stepped::{SteppedLaw, forces_along};
pub use stiction_codes::Code;
pub use stiction_files::study::Study;
pub use stiction_files::{Axis, ModelFile, Warning, model, result};
pub use stiction_formats::{Reading, allow_memory, allowed_memory, watch};
pub use stiction_friction::compensator::{Compensator, Input};
pub use stiction_identify::{Control, LawKind, Observer, Progress, Silent, Stage};
pub use stiction_parameters::FrictionLaw;
pub use stiction_workflows::export::{
    Draws, ExportOptions, Exported, ExportedRobot, Feedforward, Safety, Target, Width, export,
    export_file, export_robot_file,
};
pub use stiction_workflows::identify::{CostKind, Method, Prediction, Procedures, Searching};
pub use stiction_workflows::study::{StudyOutcome, simulate};
pub use stiction_workflows::{Error, Verdict, demo, set_threads};
