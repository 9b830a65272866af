//! Identification of friction laws from conditioned records, with uncertainty.
//!
//! Start with [`condition`] and [`identify()`].
//!
//! ```
//! use stiction_identify::{
//!     Conditioning, Cutoff, Law, LawKind, Mass, Samples, Settings, Silent, Terms, condition, identify,
//! };
//!
//! // 4 s at 1 kHz of an axis with 20 N of Coulomb and 60 N s/m of viscous friction, mass taken off.
//! let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
//! let velocity: Vec<f64> = time.iter().map(|t| 0.1 * (6.0 * t + 0.1).sin()).collect();
//! let force = velocity.iter().map(|v| 20.0 * v.signum() + 60.0 * v).collect();
//! let samples = Samples { time, velocity: Some(velocity), force, ..Samples::default() };
//!
//! // Nothing to filter: there is no noise.
//! let raw = Conditioning { source_cutoff: Cutoff::Off, common_cutoff: Cutoff::Off, ..Conditioning::default() };
//! let record = condition(&[samples], &raw)?;
//! let terms = Terms { mass: Mass::Absent, ..Terms::default() };
//! let law = Law::new(LawKind::CoulombViscous);
//! let estimate = identify(&record, law, &terms, 0.0, &Settings::default(), &mut Silent)?;
//! let coulomb = estimate.value("coulomb").expect("a parameter of the law"); // N
//! assert!((coulomb - 20.0).abs() < 0.1);
//! # Ok::<(), stiction_identify::Error>(())
//! ```
//!
//! The data flows one way:
//!
//! ```text
//! Samples --condition--> Record --separable--> Optimum --estimate--> Estimate
//!  (SI, one per log)     (what the fit sees)   (search)   (parameters, covariance, residuals)
//! ```
//!
//! The method is *separable* least squares (variable projection: Golub and Pereyra 1973,
//! doi 10.1137/0710036, with the Jacobian of Kaufman 1975, doi 10.1007/BF01932995). With the bristle
//! deflection in units of the Coulomb level, `eta = s0 z / Fc`, the LuGre force is
//!
//! ```text
//! eta' = kappa (v - |v| eta / gh(v)),     gh(v) = 1 + (r - 1) exp(-|v/vs|^delta)
//! u    = Fc eta + s1 (v - |v| eta / gh) + s2 v + M a + F0 + ...
//! ```
//!
//! with `kappa = s0/Fc` and `r = Fs/Fc`: only `ln kappa`, `ln (r - 1)` and `ln vs` enter
//! nonlinearly, all else is found exactly for each trial of those three. The static laws and Dahl are
//! the same form with fewer nonlinear unknowns, the elasto-plastic law with one more, the part of the
//! steady deflection at which it breaks away.
//!
//! Other searches see the same costs through [`candidates`], and end in [`fit_law_from`].
//!
//! Where the force is the input, or made by a known controller, [`output_error`] simulates the axis
//! instead and fits its position.
//!
//! Nothing here prints, sleeps or reads a clock; an [`Observer`] sees progress and may stop a run.

mod agreement;
mod alignment;
mod along;
#[cfg(test)]
mod answered;
pub mod candidates;
mod choice;
mod conditioning;
mod crossval;
mod drive;
mod effects;
mod error;
mod estimate;
mod exponential;
mod fit;
mod force_filter;
mod friction_curve;
mod gms;
mod held_delay;
mod identify;
mod known_force;
mod lag;
mod lateness;
mod law;
mod left_out;
mod output_error;
mod parameter;
pub mod procedure;
mod reaction;
mod refit;
mod replica;
mod rigid;
mod scatter;
mod separable;
mod shifts;
mod state_space;
mod student;
mod tune;
mod watch;

pub use agreement::Disagreement;
pub use alignment::{Alignment, alignment};
pub use along::{Along, Fall, SlipAlong, asymmetric_lugre_along, lugre_along, slip_along};
pub use choice::{Standing, choose};
pub use conditioning::accelerometer::Accelerometer;
pub use conditioning::channels::Channels;
pub use conditioning::losses::Losses;
pub use conditioning::record::{Record, Samples, Segment};
pub use conditioning::{Conditioning, Cutoff, Source, condition};
pub use crossval::{LawScore, cross_validate};
pub use effects::{Effect, Found, Wave};
pub use error::Error;
pub use estimate::fitted::FittedLaw;
pub use estimate::intervals::effects;
pub use estimate::intervals::intervals;
pub use estimate::series::Series;
pub use estimate::{Estimate, FrictionAlong, LevelAlong, estimate, friction_along, predict};
pub use fit::{Fit, low_speed_bound};
pub use force_filter::{ForceFilter, Smoothing, force_filter};
pub use friction_curve::{FrictionCurve, Level, OfDirection, friction_curve};
pub use gms::history::run_through;
pub use gms::score::ElementsScore;
pub use gms::{FEWEST as GMS_FEWEST, MOST as GMS_MOST};
pub use identify::{delay_of_another, fit_law, fit_law_from, identify};
pub use lateness::lateness;
pub use law::Law;
pub use law::dependence::Dependence;
pub use law::map::Map;
pub use law::terms::{Delay, DelayFrom, FirstDelay, Lag, Mass, Terms};
pub use law::transmitted::Transmitted;
pub use output_error::controller::Controller;
pub use output_error::outcome::{Short, SimulationFit};
pub use output_error::run::{Hold, Recording};
pub use output_error::signals::Signals;
pub use output_error::unseen::{Unseen, simulate_unseen};
pub use output_error::{Simulation, output_error};
pub use parameter::NORMAL_Q95;
pub use parameter::covariance::Covariance;
pub use parameter::{IntervalKind, Parameter};
pub use rigid::{
    Machine, Prior, RigidFit, RigidForce, RobotJoint, pseudo_inverse, rigid_fit, torque_cutoff,
};
pub use scatter::HalfWidths;
pub use separable::objective::{Evaluation, Objective};
pub use separable::optimum::Optimum;
pub use separable::search_box::SearchBox;
pub use separable::separable;
pub use separable::settings::Settings;
pub use state_space::rests_much;
pub use stiction_parameters::{
    Dimension, LawKind, Name, ParameterSet, Quantity, Side, SteadyCurve,
};
pub use stiction_search::{Control, Counts, Observer, Progress, Silent, Stage, Status};
pub use stiction_signal::SignalError;
pub use tune::{Trial, Tuned, settle, tune};
