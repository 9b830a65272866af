//! Identification of a robot: logs of all its joints and a URDF in, the rigid body and the friction of each joint out.

mod assemble;
mod coupled;
mod filters;
mod findings;
mod load;
mod motion;
mod options;
mod outcome;
mod run;
mod verdict;

pub use load::Urdf;
pub(crate) use load::read_urdf;
pub use options::{Files, Options};
pub use outcome::{JointOutcome, RobotOutcome};
pub use run::robot;
