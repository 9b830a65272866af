//! What to identify of a robot, and how.

use std::path::PathBuf;

/// The files of an identification of a robot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Files {
    /// Logs to fit together; all of one robot.
    pub logs: Vec<PathBuf>,
    /// The URDF; `None` takes that of the robot file.
    pub urdf: Option<PathBuf>,
    /// Robot file; `None` leaves all to the URDF and to detection.
    pub robot: Option<PathBuf>,
    /// Logs to validate on.
    pub validate: Vec<PathBuf>,
}

/// How to identify it; change what differs from the default, which is that of the command line.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Fit the first part of the time of each log (0 to 1) and validate on the rest.
    pub split: Option<f64>,
    /// Seed of the searches; the same seed gives the same bits.
    pub seed: u64,
}
