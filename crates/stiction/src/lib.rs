//! Friction of servo axes: from a drive's log to a law with intervals, and on to its compensation.
//!
//! Begin with [`Identification`]. A log in, a law out, with what may be said of each number:
//!
//! ```
//! use stiction::{Identification, Input, LawKind, Log, Quantity, demo};
//!
//! # let folder = tempfile::tempdir()?;
//! # std::env::set_current_dir(&folder)?;
//! // A recording to begin with: a simulated axis, as a drive would log it. Your own file does as well.
//! demo::write_log("run.csv", 1)?;
//! demo::write_log("another.csv", 2)?;
//!
//! // Read. Columns and units are those in the file; `Axis::read("axis.toml")` states what it does not say.
//! let log = Log::open("run.csv")?;
//! println!("{} samples at {} Hz", log.samples(), log.rate_hz());
//!
//! // Identify. Without `law` the data choose it; `without_comparison` saves the time for simpler laws.
//! let fit = Identification::of(&[log]).law(LawKind::LuGre).without_comparison().run()?;
//! assert!(fit.is_trustworthy(), "{:?}", fit.reasons());
//!
//! // Friction by velocity, whatever the law, with its 95 % interval for another day.
//! let friction = fit.friction(0.1).expect("a speed that the log has seen");
//! println!("{:.1} ± {:.1} {}", friction.force, friction.repeat, fit.force_unit());
//!
//! // A parameter, where the log determines it; else why not, and what to record.
//! for p in fit.parameters() {
//!     match p.determined() {
//!         Some(own) => println!("{} = {:.3} in {:.3?} {}", p.name(), own.value, own.interval, p.unit()),
//!         None => println!("do not use {}: {} {}", p.name(), p.reason(), p.advice()),
//!     }
//! }
//! let coulomb = fit.parameter(Quantity::Coulomb).and_then(|p| p.determined()).expect("a Coulomb level");
//!
//! // Predict another log; nothing is fitted again.
//! let error = fit.predict(&Log::open("another.csv")?)?.quality.relative_error_percent;
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
//! # assert!((19.5..20.5).contains(&coulomb.value));
//! # assert!(coulomb.interval.0 < 20.0 && 20.0 < coulomb.interval.1, "{coulomb:?}");
//! # assert!((25.0..27.0).contains(&friction.force) && friction.repeat < 2.0, "{friction:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Columns in memory go the same way; here with a log to validate on, and on to files and code:
//!
//! ```
//! use stiction::{Axis, Export, Identification, LawKind, Log, Quantity, Target};
//! # let folder = tempfile::tempdir()?;
//! # let folder = folder.path();
//!
//! // An axis of 9 kg with 20 N of Coulomb and 60 N s/m of viscous friction, moved to and fro.
//! let axis = Axis::parse("name = \"X\"\nkind = \"linear\"\n")?;
//! let run = |name: &str, stroke: f64| {
//!     let time: Vec<f64> = (0..6000).map(|k| 1e-3 * f64::from(k)).collect();
//!     let motion = |t: f64| (stroke * (6.0 * t).sin(), 6.0 * stroke * (6.0 * t).cos());
//!     let force = |t: f64| 20.0 * motion(t).1.signum() + 60.0 * motion(t).1 - 9.0 * 36.0 * motion(t).0;
//!     let position = time.iter().map(|&t| 1e3 * motion(t).0).collect();
//!     let force = time.iter().map(|&t| force(t)).collect();
//!     Log::from_columns(name, [("time [s]", time), ("position [mm]", position), ("force [N]", force)], &axis)
//! };
//!
//! let (fitted, unseen) = (run("run 1", 0.05)?, run("run 2", 0.08)?);
//! let fit = Identification::of(&[fitted])
//!     .axis(&axis)
//!     .validate(&[unseen])
//!     .law(LawKind::CoulombViscous)
//!     .without_comparison()
//!     .run()?;
//! let mass = fit.parameter(Quantity::Mass).expect("a fitted mass");
//! assert!((mass.value() - 9.0).abs() < 0.1, "{}", mass.value());
//!
//! fit.write(folder.join("result"))?; // result.json, model.toml, report.html, fit.csv
//! let code = Export::new(Target::C, 1e-3).model(&fit.model())?; // called every millisecond
//! code.write(folder.join("controller"))?;
//! # assert!(code.files().any(|(path, _)| path.ends_with(".c")));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | from | to | with |
//! |---|---|---|
//! | a file or columns in memory | [`Log`] | [`Log::open`], [`Log::from_columns`] |
//! | what is known of the machine | [`Axis`] | [`Axis::read`], [`Axis::parse`] |
//! | logs | [`Fit`], [`Check`] | [`Identification::run`], [`Identification::check`] |
//! | a folder with a result | [`SavedFit`] | [`SavedFit::read`] |
//! | a fit | friction, parameters, law, prediction, compensator, files | [`Fit::friction`], [`Fit::parameter`], [`Fit::law`], [`Fit::predict`], [`Fit::compensator`], [`Fit::write`] |
//! | a [`Model`] | code for a controller, friction for a simulator | [`Export`] |
//! | logs of a robot and its URDF | its rigid body and a fit of each joint | [`robot`] |
//! | a name in the library | a machine that is identified already | [`library`] |
//! | a study file | tracking errors with and without compensation | [`Study`] |
//!
//! SI throughout; a force that the log has in A or V stays in it. Results do not depend on the number of threads. A result
//! that should not be trusted is no error: [`Fit::is_trustworthy`] says so, and [`Fit::reasons`] why.
//!
//! In a program of one's own: `cargo add stiction --no-default-features`; the feature `cli` is the command `stiction`.
//!
//! What a result has beyond these types is in [`Fit::result`], with the keys of `result.json`. The engine is no part of the interface;
//! the laws for a drive without `std` are in [`friction`].

mod axis;
mod check;
pub mod demo;
mod error;
mod export;
mod findings;
mod fit;
mod identification;
mod law;
pub mod library;
mod log;
mod model;
mod notice;
mod parameter;
mod progress;
pub mod robot;
mod saved;
mod search;
mod study;

pub use axis::Axis;
pub use check::Check;
pub use error::Error;
pub use export::{Export, Exported, Feedforward, Width};
pub use findings::Friction;
pub use fit::Fit;
pub use identification::{Identification, Method, Recording};
pub use law::{Law, SteppedLaw};
pub use log::{Log, Motion};
pub use model::Model;
pub use notice::{Notice, Prediction, Quality, Series, Severity};
pub use parameter::{Determined, HalfWidths, Parameter};
pub use progress::Progress;
pub use saved::SavedFit;
pub use search::{Search, SearchCost, SearchMethod};
pub use stiction_codes::Code;
pub use stiction_files::result::{Origin, Status};
pub use stiction_formats::allow_memory;
pub use stiction_friction as friction;
pub use stiction_friction::compensator::{Compensator, Input};
pub use stiction_identify::Stage;
pub use stiction_parameters::{LawKind, Name, Quantity, Side, Wave};
pub use stiction_workflows::export::Target;
pub use stiction_workflows::{Verdict, set_threads};
pub use study::{Metric, SimulatedRow, Simulation, Study};
