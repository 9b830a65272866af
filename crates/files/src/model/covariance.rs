//! What cannot be of the covariance of a model.

use super::ModelFile;
use crate::result::CovarianceEntry;
use stiction_number::four_digits as short;

/// How far apart the two halves of a matrix may be, of the product of the standard deviations: rounding.
const ROUNDING: f64 = 1e-9;

/// What was found, what is allowed.
pub(super) fn fault(model: &ModelFile) -> Option<(String, String)> {
    let CovarianceEntry { names, matrix } = &model.covariance;
    let square = matrix.len() == names.len() && matrix.iter().all(|r| r.len() == names.len());
    if !square {
        let found = "a matrix that is not square".into();
        return Some((found, "one row and column for each name".into()));
    }
    for (i, name) in names.iter().enumerate() {
        let short_name: String = name.chars().take(60).collect();
        if names[..i].contains(name) {
            return Some((format!("{short_name} twice"), "each once".into()));
        }
        if model.parameter.iter().all(|p| p.name != *name) {
            let found = format!("{short_name:?}, which is no parameter of this model");
            return Some((found, "names of its parameters".into()));
        }
        let variance = matrix[i][i];
        if !(variance >= 0.0 && variance.is_finite()) {
            let found = format!("a variance of {} for {name}", short(variance));
            return Some((found, "finite variances that are not negative".into()));
        }
    }
    (0..names.len()).find_map(|i| (0..i).find_map(|j| apart(&model.covariance, i, j)))
}

/// Whether an element is no number, or not that on the other side of the diagonal.
fn apart(entry: &CovarianceEntry, i: usize, j: usize) -> Option<(String, String)> {
    let CovarianceEntry { names, matrix } = entry;
    let (low, high) = (matrix[i][j], matrix[j][i]);
    let pair = format!("{} and {}", names[j], names[i]);
    if !(low.is_finite() && high.is_finite()) {
        let worse = if low.is_finite() { high } else { low };
        let found = format!("a covariance of {} for {pair}", short(worse));
        return Some((found, "finite numbers".into()));
    }
    let allowed = ROUNDING * libm::sqrt(matrix[i][i]) * libm::sqrt(matrix[j][j]);
    ((low - high).abs() > allowed).then(|| {
        let found = format!("{} and {} for {pair}", short(high), short(low));
        (found, "the same on both sides of the diagonal".into())
    })
}
