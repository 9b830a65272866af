//! What cannot be of the covariance of a model.

use super::form::ModelFile;
use super::refusal::Fault;
use crate::result::CovarianceEntry;
use stiction_number::four_digits as short;

/// Largest difference between the halves of a covariance, as a part of the product of the standard deviations: it only has to
/// be above rounding, 1e-16 times the size of the matrix, and far below any correlation.
const LARGEST_ASYMMETRY: f64 = 1e-9;

/// What is wrong with the covariance.
pub(super) fn fault(model: &ModelFile) -> Option<Fault> {
    let CovarianceEntry { names, matrix } = &model.covariance;
    let square = matrix.len() == names.len() && matrix.iter().all(|r| r.len() == names.len());
    if !square {
        let found = "a matrix that is not square".into();
        return Some((
            "covariance.matrix".into(),
            found,
            "one row and column for each name".into(),
        ));
    }
    for (i, name) in names.iter().enumerate() {
        let short_name: String = name.chars().take(60).collect();
        if names[..i].contains(name) {
            let key = format!("covariance.names[{}]", i + 1);
            return Some((
                key,
                format!("{short_name} a second time"),
                "each name once".into(),
            ));
        }
        if model.parameter.iter().all(|p| p.name != *name) {
            let found = format!("{short_name:?} is not a parameter of this model");
            let key = format!("covariance.names[{}]", i + 1);
            return Some((key, found, "names of its parameters".into()));
        }
        let variance = matrix[i][i];
        if !(variance >= 0.0 && variance.is_finite()) {
            let found = format!("a variance of {} for {name}", short(variance));
            let allowed = "finite variances that are not negative".into();
            return Some((element(i, i), found, allowed));
        }
    }
    (0..names.len()).find_map(|i| (0..i).find_map(|j| apart(&model.covariance, i, j)))
}

/// Whether an element is no number, or not that on the other side of the diagonal.
fn apart(entry: &CovarianceEntry, i: usize, j: usize) -> Option<Fault> {
    let CovarianceEntry { names, matrix } = entry;
    let (low, high) = (matrix[i][j], matrix[j][i]);
    let pair = format!("{} and {}", names[j], names[i]);
    if !(low.is_finite() && high.is_finite()) {
        let (worse, key) = match low.is_finite() {
            true => (high, element(j, i)),
            false => (low, element(i, j)),
        };
        let found = format!("a covariance of {} for {pair}", short(worse));
        return Some((key, found, "finite numbers".into()));
    }
    let allowed = LARGEST_ASYMMETRY * libm::sqrt(matrix[i][i]) * libm::sqrt(matrix[j][j]);
    ((low - high).abs() > allowed).then(|| {
        let found = format!("{} and {} for {pair}", short(high), short(low));
        let allowed = "the same on both sides of the diagonal".into();
        (element(i, j), found, allowed)
    })
}

/// The key of an element, counted from 1.
fn element(row: usize, column: usize) -> String {
    format!("covariance.matrix[{}][{}]", row + 1, column + 1)
}
