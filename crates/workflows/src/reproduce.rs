//! Published experiments run again, each number beside its reference.

mod canudas;
mod outcome;
mod paper;
mod watch;

pub use canudas::canudas_1995;
pub use outcome::{Body, Reproduction};
pub use paper::{
    Budget, Compensation, Control, Cornered, Crawled, Delayed, Dynamics, Hold, LeftOut, LoadFound,
    Measured, Outliers, OwnAxis, PARAMETERS, Paper, Presliding, Pull, REACHED, Rested, Searched,
    Stage, Statics, Stiffness, Tracked, Turn, Units, annealing, zhang_2025, zhang_2025_on,
};
