//! What comes of a reproduction, in memory.

use super::paper::Paper;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_servo::c95::Experiment;

/// Everything that came out, in memory.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// What goes into `reproduce.json`.
    pub file: ReproduceFile,
    /// What the report draws.
    pub body: Body,
}

/// What the report draws.
#[derive(Clone, Debug)]
pub enum Body {
    /// Experiments of Canudas de Wit et al. 1995.
    Canudas1995(Vec<Experiment>),
    /// Those of Zhang et al. 2025.
    Zhang2025(Box<Paper>),
}
