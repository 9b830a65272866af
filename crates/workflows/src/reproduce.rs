//! Published experiments run again, each number beside its reference.

mod canudas;
mod outcome;
mod paper;
mod watch;

pub use canudas::canudas_1995;
pub use outcome::{Body, Reproduction};
pub use paper::{
    Budget, Compensation, Control, Cornered, Dynamics, LoadFound, PARAMETERS, Paper, Presliding,
    Searched, Stage, Statics, Tracked, zhang_2025,
};
