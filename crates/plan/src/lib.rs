//! The motion to record before friction is identified, within the limits of an axis.
//!
//! Pieces from rest to rest ([`Atom`]) are simulated in closed loop, with the encoder, on axes that the nameplate allows
//! ([`Nameplate`]), or that a first identification leaves open ([`Belief`]). Each run gives sums that say how well its log would
//! determine the parameters of LuGre, the mass and the terms beside them ([`Subject`]); they add over pieces, so the best pieces of
//! a given length are found without further simulation ([`select()`]), and the whole motion is then simulated once more
//! ([`Entry::of`]).
//!
//! ```text
//! Limits, Rig --dictionary--> Atoms --Entry::of, on Nameplate::draw--> Table --select--> Motion --Entry::of--> Expected
//! ```
//!
//! # How a carrier reads a plan
//! The forms of [`carrier`] are made here.
//! A [`Motion`] is a list of [`Atom`]s, plain numbers, one after the other without a pause. [`Motion::timed`] gives each with the
//! instant at which it starts, [`Motion::at`] position, velocity, acceleration and jerk at any time, relative to where the axis
//! stands when it starts; a carrier that computes the pieces itself needs only the numbers of the two kinds of atom and the
//! formulas in [`Atom`]. It begins and ends at rest there. [`Motion::extremes`] bounds all of it between samples too.
//!
//! SI throughout; units are given for a linear axis, those of a rotary axis in brackets. Nothing here prints, sleeps or reads a
//! clock. The same settings and seed give the same bits on every machine.
#![forbid(unsafe_code)]

mod aim;
mod atom;
mod belief;
mod candidate;
pub mod carrier;
mod dictionary;
mod expected;
mod hand_made;
mod information;
mod limits;
mod motion;
mod predict;
mod prior;
mod pushed;
mod recognise;
mod rig;
mod run;
mod select;
mod slip;
mod subject;
mod table;

pub use aim::Aim;
pub use atom::{Atom, Extremes, Instant};
pub use belief::Belief;
pub use candidate::{Back, Candidate, NAMES, PARAMETERS};
pub use dictionary::{dictionary, nested, places};
pub use expected::Expected;
pub use hand_made::{HandMade, hand_made};
pub use limits::Limits;
pub use motion::Motion;
pub use predict::Deviations;
pub use prior::Nameplate;
pub use recognise::{How, Ran, Recognised, recognise};
pub use rig::{Loop, Rig};
pub use run::{Peaks, Run, run, run_finely};
pub use select::{Alone, Choice, Spread, select};
pub use slip::Slip;
pub use subject::{Along, Elements, Shape, Subject, Term};
pub use table::{Entry, Table};
