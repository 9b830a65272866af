//! The simulated axis: how a drive with a known friction law moves, and what it would log.
//!
//! Start with [`closed_loop`] for a log with known truth (the example below), or with [`axis`] and [`run`] to compare
//! controllers and friction compensation; [`known`] has axes to begin with.
//!
//! | module | what |
//! |---|---|
//! | [`plant`] | a mass with friction, of any law, under a force or a spring |
//! | [`integrator`] | how it is advanced in time |
//! | [`cascade`], [`pid`], [`fuzzy`] | controllers: P in position and PI in speed, PID, fuzzy PID; [`controller`]: any of them |
//! | [`drive`] | amplifier, current loop, delay, limits |
//! | [`disturbance`] | cogging and other forces |
//! | [`encoder`] | the position sensor with its steps |
//! | [`path`], [`motion`] | reference motions |
//! | [`speeds`] | constant speeds one after the other |
//! | [`noise`] | white noise from a seed |
//! | [`feedforward`], [`learning`] | compensation of friction |
//! | [`axis`], [`run`] | one axis with all of it, along a [`trajectory`], or one [`sampled`] for many runs |
//! | [`two_axes`], [`cross_coupling`] | two axes along a contour in the [`plane`] |
//! | [`levelled`], [`surroundings`] | friction that depends on load, temperature and position |
//! | [`load`] | load estimation: mass and friction level while running |
//! | [`metrics`] | tracking and contour errors |
//! | [`closed_loop`] | all of them together at a control rate, recorded |
//! | [`known`] | axes with published parameters |
//! | [`c95`] | the experiments of the LuGre paper (1995) with the expected numbers |
//!
//! SI throughout; units are given for a linear axis, those of a rotary axis in brackets. The friction laws are those of
//! `stiction-friction`, none are written here. The same settings and seed give the same bits on every machine.
//!
//! ```
//! use stiction_servo::cascade::Cascade;
//! use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
//! use stiction_servo::encoder::Encoder;
//! use stiction_servo::known;
//! use stiction_servo::path::Path;
//! use stiction_servo::plant::Plant;
//!
//! let axis = known::find("machine").ok_or("no such axis")?;
//! let record = ClosedLoop {
//!     plant: Plant::new(axis.mass, axis.law)?,
//!     controller: Cascade::tuned(axis.mass, 50.0, 500.0)?, // 50 Hz, 500 N
//!     path: Path::three_segments(0.196, 3.0)?,             // m/s, s
//!     encoder: Encoder::new(50e-9)?,                       // m per count
//!     rate: 4000.0,                                        // Hz
//!     substeps: 5,
//!     force_noise: 0.2,                                    // N
//!     force_log: ForceLog::Centred,
//!     seed: 1,
//! }
//! .run()?;
//! assert_eq!(record.time.len(), 12_001);
//! assert_eq!(record.force.len(), record.position.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

pub mod axis;
pub mod c95;
pub mod cascade;
pub mod closed_loop;
pub mod controller;
pub mod cross_coupling;
pub mod disturbance;
pub mod drive;
pub mod encoder;
pub mod feedforward;
pub mod fuzzy;
pub mod integrator;
pub mod known;
pub mod law;
pub mod learning;
pub mod levelled;
pub mod load;
pub mod metrics;
pub mod motion;
pub mod noise;
pub mod path;
pub mod pid;
pub mod plane;
pub mod plant;
pub mod run;
pub mod sampled;
pub mod speeds;
pub mod surroundings;
pub mod trajectory;
pub mod two_axes;
pub mod unmodelled;
