//! The sums of a trial, and what all trials of a track share.

use crate::Track;
use crate::sensitive::OWN;

/// Sums of products over the samples that count, of the columns that a trial makes with each other and with
/// those that all trials share.
///
/// A trial's own columns are, in this order, `eta`; `rate`, that is `v - |v| eta/gh`; the derivatives of eta
/// with respect to `ln kappa`, `ln(r - 1)`, `ln vs`; and those of rate. Shared are the measured force, the
/// velocity, and the further columns of the track.
///
/// With the linear coefficients c of eta and rate, column k of the Jacobian is
/// `c[0] own[2 + k] + c[1] own[5 + k]`: its products with anything are sums of rows of these arrays, and so
/// are the normal equations of the linear problem and the Jacobian of Kaufman 1975 (doi 10.1007/BF01932995).
///
/// A residual computed from these sums loses digits by cancellation: its sum of squares has an absolute
/// error of about 1e-15 of the sum of squares of the measured force.
///
/// Without the derivatives there are two own columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums<const C: usize = OWN> {
    /// `own[i][j]`: own column i times own column j; symmetric.
    pub own: [[f64; C]; C],
    /// `shared[s][i]`: shared column s times own column i.
    pub shared: Vec<[f64; C]>,
}

/// The shared columns in the direction of motion.
pub(super) fn shared(track: &Track) -> Vec<&[f64]> {
    let known: [&[f64]; 2] = [&track.force, &track.speed];
    let further = track.columns.iter().map(Vec::as_slice);
    known.into_iter().chain(further).collect()
}
