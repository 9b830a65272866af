//! Published experiments run again, each number beside its reference.

mod canudas;
mod outcome;
mod paper;
mod watch;

pub use canudas::canudas_1995;
pub use outcome::{Body, Reproduction};
pub use paper::{
    Budget, Compensation, Control, Cornered, Crawled, Dynamics, LoadFound, Measured, OwnAxis,
    PARAMETERS, Paper, Presliding, Pull, REACHED, Searched, Stage, Statics, Stiffness, Tracked,
    Units, zhang_2025, zhang_2025_on,
};
