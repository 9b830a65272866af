//! Checks that the covariance of a model is one that can exist.

use super::form::ModelFile;
use super::refusal::Fault;
use crate::result::CovarianceEntry;
use stiction_number::four_digits as short;

/// Largest difference between the two triangles of a covariance, as a part of the product of the standard deviations,
/// dimensionless: it only has to be above rounding, 1e-16 times the size of the matrix, and far below any correlation.
const LARGEST_ASYMMETRY: f64 = 1e-9;

/// Largest ratio of a standard deviation and the root of its variance, either way, dimensionless: both are the same
/// number, except where a procedure widens one.
const MOST_APART: f64 = 2.0;
/// Pivot of the correlation matrix (its square root, off the diagonal) up to which it may be rounding only,
/// dimensionless.
const LEAST_PART: f64 = 1e-6;
/// Correlation that rounding may leave with a parameter that adds no variance of its own: the root of [`LEAST_PART`].
const LARGEST_REST: f64 = 1e-3;

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
    (0..names.len())
        .find_map(|i| (0..i).find_map(|j| apart(&model.covariance, i, j)))
        .or_else(|| (0..names.len()).find_map(|i| against_deviation(model, i)))
        .or_else(|| {
            let (i, j) = root(matrix).err()?;
            let found = match i == j {
                true => format!("no covariance, seen at {}", names[i]),
                false => format!("no covariance, seen at {} and {}", names[j], names[i]),
            };
            let allowed = "a matrix without negative eigenvalues".into();
            Some((element(i, j), found, allowed))
        })
}

/// Whether a variance contradicts the standard deviation of its parameter. A zero row is allowed for what the data do
/// not determine at all.
fn against_deviation(model: &ModelFile, i: usize) -> Option<Fault> {
    let CovarianceEntry { names, matrix } = &model.covariance;
    let parameter = model.parameter.iter().find(|p| p.name == names[i])?;
    let (name, variance) = (&names[i], matrix[i][i]);
    let fits = |std: f64| {
        let ratio = libm::sqrt(variance) / std;
        (1.0 / MOST_APART..=MOST_APART).contains(&ratio)
    };
    let identified = parameter.identifiable && parameter.origin == "identified";
    let found = match parameter.std {
        _ if variance == 0.0 && identified => {
            format!("a variance of 0 for {name}, which was identified")
        }
        Some(std) if variance > 0.0 && std > 0.0 && !fits(std) => {
            let (variance, std) = (short(variance), short(std));
            format!("a variance of {variance} for {name}, whose std is {std}")
        }
        _ => return None,
    };
    let allowed = "the square of its standard deviation".into();
    Some((element(i, i), found, allowed))
}

/// A lower triangular square root of a covariance, or the row and column at which the matrix proves not to be one.
///
/// Cholesky on the correlations, so that units do not matter. A parameter that is a linear function of those before
/// it, or that the data do not determine, adds no variance of its own.
pub(crate) fn root(matrix: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, (usize, usize)> {
    let n = matrix.len();
    let size: Vec<f64> = (0..n).map(|i| libm::sqrt(matrix[i][i])).collect();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let scale = size[i] * size[j];
            if scale == 0.0 {
                if matrix[i][j] != 0.0 {
                    return Err((i, j));
                }
                continue;
            }
            let sum: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let left = matrix[i][j] / scale - sum;
            let own = lower[j][j] > LEAST_PART;
            let none = match i == j {
                true => left < -LEAST_PART,
                false => !own && left.abs() > LARGEST_REST,
            };
            if none || !left.is_finite() {
                return Err((i, j));
            }
            lower[i][j] = if i == j {
                libm::sqrt(left.max(0.0))
            } else if own {
                left / lower[j][j]
            } else {
                0.0
            };
        }
    }
    for (row, size) in lower.iter_mut().zip(&size) {
        row.iter_mut().for_each(|x| *x *= size);
    }
    Ok(lower)
}

/// Whether an element is not a number, or differs from the one on the other side of the diagonal.
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
