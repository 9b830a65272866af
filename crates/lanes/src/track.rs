//! A recorded motion made ready for the kernels.

use crate::Error;
use std::sync::OnceLock;

mod build;

/// Nodes in a block of a single candidate or trial; a track is padded to a multiple.
pub(crate) const BLOCK: usize = 128;
/// Nodes in a tile of a batch.
pub(crate) const TILE: usize = 32;
/// Node `t` of a tile shares its division with node `t + HALF`. Other pairs would change the last
/// bits of the result.
pub(crate) const HALF: usize = TILE / 2;

/// The node is a sample of the record, not a reversal put in.
pub(crate) const SAMPLE: u8 = 1;
/// The sample counts.
pub(crate) const KEPT: u8 = 2;
/// The bristle starts unloaded here.
pub(crate) const RESTART: u8 = 4;
/// The motion reverses here: from here on signs are those of the other direction.
pub(crate) const REVERSE: u8 = 8;

/// When the samples of a [`Segment`] were taken.
#[derive(Clone, Copy, Debug)]
pub enum Time<'a> {
    /// One time step between all, s.
    Step(f64),
    /// Instants, s, strictly increasing, one per sample.
    At(&'a [f64]),
}

/// A stretch of a recorded motion, at whose start the bristle is unloaded.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a> {
    /// When the samples were taken.
    pub time: Time<'a>,
    /// Velocity, m/s (rad/s), linear in time between the samples; finite, below 1e100.
    pub velocity: &'a [f64],
    /// Measured force, N (N m), one a sample; finite, below 1e100, where the sample counts.
    pub force: &'a [f64],
    /// Which samples count; empty means all.
    pub keep: &'a [bool],
    /// Further columns of a regression that no candidate changes (acceleration, ones, ...), one value
    /// per sample; as many in every segment. They are not used for the cost of given candidates.
    pub columns: &'a [&'a [f64]],
}

/// A recorded motion in the form that the kernels read.
///
/// Nodes are the samples, and one node of standstill wherever the velocity changes its sign between two
/// samples. All signs are taken relative to the direction of motion: so the bristle relaxes towards a
/// positive level in every interval, and at a reversal the deflection changes its sign.
#[derive(Clone, Debug)]
pub struct Track {
    pub(crate) speed: Vec<f64>,
    /// Half the time since the node before, s.
    pub(crate) half_step: Vec<f64>,
    /// Direction of motion, 1 or -1.
    pub(crate) sign: Vec<i8>,
    pub(crate) marks: Vec<u8>,
    /// Measured force in the direction of motion; 0 where nothing counts.
    pub(crate) force: Vec<f64>,
    /// Further columns, likewise.
    pub(crate) columns: Vec<Vec<f64>>,
    ln_speed: OnceLock<Vec<f64>>,
    samples: usize,
    kept: usize,
}

impl Track {
    /// A track of segments, in order.
    ///
    /// ```
    /// use stiction_lanes::{Segment, Time, Track};
    ///
    /// let track = Track::new(&[Segment {
    ///     time: Time::Step(1e-3),                    // s
    ///     velocity: &[0.0, 0.01, 0.01, -0.01, 0.0],  // m/s
    ///     force: &[0.0, 12.0, 20.0, 3.0, f64::NAN],  // N
    ///     keep: &[true, true, true, true, false],
    ///     columns: &[],
    /// }])?;
    /// assert_eq!((track.samples(), track.kept()), (5, 4));
    /// # Ok::<(), stiction_lanes::Error>(())
    /// ```
    pub fn new(segments: &[Segment]) -> Result<Self, Error> {
        build::build(segments)
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Number of samples that count.
    pub fn kept(&self) -> usize {
        self.kept
    }

    /// Number of nodes: samples, reversals put in, and the padding to whole tiles. A kernel takes one step
    /// for each.
    pub fn nodes(&self) -> usize {
        self.speed.len()
    }

    /// Number of further columns.
    pub fn columns(&self) -> usize {
        self.columns.len()
    }

    /// Logarithm of the speed, made when a law first needs it.
    pub(crate) fn ln_speed(&self) -> &[f64] {
        self.ln_speed
            .get_or_init(|| self.speed.iter().map(|&v| libm::log(v)).collect())
    }
}
