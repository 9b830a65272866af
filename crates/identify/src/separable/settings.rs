//! How the separable search works.

use crate::law::Law;
use crate::separable::search_box::SearchBox;

/// How the separable search works.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Seed of the scramble of the low-discrepancy scan.
    pub seed: u64,
    /// Points of the scan. Default 64.
    pub scan: usize,
    /// Descents on the thinned record. Default 6.
    pub starts: usize,
    /// Samples of the thinned record that the scan and its descents see; of the motion, where the record has a
    /// common filter. Default 4000. Fewer do not resolve the reversals of a long log.
    pub thin: usize,
    /// Most steps of one descent. Default 200.
    pub steps: usize,
    /// Where to look; `None` takes the box that the record allows.
    pub bounds: Option<SearchBox>,
    /// A law and its nonlinear unknowns, in its order and then the delay, as an earlier fit of the same logs has found them: a search
    /// of this law that is stopped ends no worse than there. Where nothing stops it, it is not looked at.
    pub near: Option<(Law, Vec<f64>)>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            seed: 0,
            scan: 64,
            starts: 6,
            thin: 4000,
            steps: 200,
            bounds: None,
            near: None,
        }
    }
}
