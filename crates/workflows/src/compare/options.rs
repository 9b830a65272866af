//! What to compare, and how.

use super::excitation::Excitation;
use std::path::PathBuf;
use stiction_identify::candidates::{Candidates, Scheme};

/// What is compared on.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// Logs of one axis.
    Log {
        /// Fitted together.
        logs: Vec<PathBuf>,
    },
    /// A problem by name: C95, machine, motor, V2, V3, V5, V6, V7, V10, V16.
    Named(String),
}

/// What the methods minimise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// The six parameters of LuGre, motion in and force out.
    Six,
    /// The nonlinear unknowns of LuGre, everything linear solved.
    Separable,
    /// The six parameters of LuGre, force in and position out.
    Position,
    /// The parameters of a steady curve: of the problems that are one, and the static step of an axis.
    Curve,
    /// sigma0 and sigma1 of LuGre with the steady curve known: the dynamic step of an axis.
    Dynamic,
}

impl Cost {
    /// Name as typed and as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Cost::Six => "six",
            Cost::Separable => "separable",
            Cost::Position => "position",
            Cost::Curve => "curve",
            Cost::Dynamic => "dynamic",
        }
    }
}

/// Noise of a made record where none is stated: deviation over the largest force, dimensionless.
pub(super) const USUAL_NOISE: f64 = 0.01;
/// Sample rate of a made record where none is stated, Hz.
pub(super) const USUAL_RATE: f64 = 1000.0;
/// One start of least squares, drawn at random: what `lm` is without its many starts.
pub const ONE_START: &str = "lm-one";

/// A comparison as it is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct CompareOptions {
    /// On what.
    pub input: Input,
    /// Axis file: of the logs, `None` leaves all to detection; for a problem only its `[search]` counts.
    pub axis: Option<PathBuf>,
    /// Names of the methods; empty takes all that can work on the cost.
    pub methods: Vec<String>,
    /// Seeds of each method, from 0 on.
    pub seeds: u64,
    /// Most evaluations of a run.
    pub evaluations: u64,
    /// Noise of a made record; `None` takes 1 %.
    pub noise: Option<f64>,
    /// Motion of a made record.
    pub excitation: Option<Excitation>,
    /// Sample rate of a made record, Hz; `None` takes 1000.
    pub rate: Option<f64>,
    /// Whether a made record follows another law than the one that is fitted.
    pub other_law: bool,
    /// Decades of the box to each side of a point off the answer; `None` takes 1 for a problem, and
    /// the box of `identify` for a log.
    pub decades: Option<f64>,
    /// How the law is integrated for each candidate.
    pub integrator: Scheme,
    /// What is minimised.
    pub cost: Option<Cost>,
    /// Samples on which candidates may be computed; [`MOST_SAMPLES`](super::MOST_SAMPLES) are usual.
    pub max_samples: u64,
}

/// Name of an integrator as typed and as written to files.
pub fn integrator_name(scheme: Scheme) -> &'static str {
    match scheme {
        Scheme::Explin => "explin",
        Scheme::Euler => "euler",
        Scheme::RungeKutta => "rk4",
    }
}

/// Any problem, as the runs share it.
pub(super) type Shared<'a> = dyn Candidates + Sync + 'a;
