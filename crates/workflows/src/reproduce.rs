//! Published experiments run again, each number beside its reference.

mod canudas;
mod outcome;
mod paper;
mod watch;

pub use canudas::canudas_1995;
pub use outcome::{Body, Reproduction};
pub use paper::{
    Budget, Cornered, Dynamics, Fed, LoadFound, PARAMETERS, Paper, Presliding, Searched, Statics,
    Tracked, zhang_2025,
};
