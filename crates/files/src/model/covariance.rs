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
/// What is left of the correlation matrix up to which it may be rounding only, dimensionless.
const LEAST_PART: f64 = 1e-6;

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

/// A square root of a covariance, each row that of a parameter, or the row and column at which the matrix proves not to
/// be one.
///
/// Cholesky on the correlations, so that units do not matter, the parameter of the most variance left first: in any
/// other order what rounding leaves grows with the squared ratio of the standard deviations, as where a stiffness is the
/// sum of others that are a hundred times larger or smaller than each other. A parameter that is a linear function of
/// others, or that the data do not determine, adds no variance of its own.
pub fn root(matrix: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, (usize, usize)> {
    let n = matrix.len();
    let size: Vec<f64> = (0..n).map(|i| libm::sqrt(matrix[i][i])).collect();
    let mut left = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let scale = size[i] * size[j];
            let correlation = matrix[i][j] / scale;
            left[i][j] = match scale {
                0.0 if matrix[i][j] == 0.0 => 0.0,
                _ if i == j && scale > 0.0 => 1.0,
                _ if correlation.is_finite() => correlation,
                _ => return Err((i, j)),
            };
            left[j][i] = left[i][j];
        }
    }
    let mut root = vec![vec![0.0; n]; n];
    let mut open: Vec<usize> = (0..n).collect();
    let most_left = |open: &[usize], left: &[Vec<f64>]| {
        let variance = |at: usize| left[open[at]][open[at]];
        // Of equal ones the first.
        let places = (0..open.len()).rev();
        places.max_by(|&a, &b| variance(a).total_cmp(&variance(b)))
    };
    while let Some(most) = most_left(&open, &left) {
        let column = n - open.len();
        let pivot = left[open[most]][open[most]];
        if pivot <= LEAST_PART {
            break;
        }
        let own = open.remove(most);
        root[own][column] = libm::sqrt(pivot);
        for &i in &open {
            root[i][column] = left[i][own] / root[own][column];
        }
        for &i in &open {
            for &j in &open {
                left[i][j] -= root[i][column] * root[j][column];
            }
        }
    }
    for (at, &i) in open.iter().enumerate() {
        if left[i][i] < -LEAST_PART {
            return Err((i, i));
        }
        if let Some(&j) = open[..at].iter().find(|&&j| left[i][j].abs() > LEAST_PART) {
            return Err((i, j));
        }
    }
    for (row, size) in root.iter_mut().zip(&size) {
        row.iter_mut().for_each(|x| *x *= size);
    }
    Ok(root)
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

#[cfg(test)]
mod tests {
    use super::root;

    /// A total whose parts each have a tenth of the deviation of the one before: in the order of the names rounding alone
    /// would leave -1e-2 of a variance.
    #[test]
    fn a_sum_of_very_different_parts_has_a_root() {
        let parts: Vec<f64> = (0..9).map(|k| 0.1_f64.powi(k)).collect();
        // What the independent parts make of the total, and of each of them.
        let row = |i: usize| -> Vec<f64> {
            let of = |k: usize| i == 0 || i == k + 1;
            (0..parts.len())
                .map(|k| if of(k) { parts[k] } else { 0.0 })
                .collect()
        };
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let all = 0..=parts.len();
        let covariance: Vec<Vec<f64>> = all
            .clone()
            .map(|i| all.clone().map(|j| product(&row(i), &row(j))).collect())
            .collect();
        let found = root(&covariance).unwrap();
        for i in all.clone() {
            for j in all.clone() {
                let allowed = 1e-6 * (covariance[i][i] * covariance[j][j]).sqrt();
                let back = product(&found[i], &found[j]);
                assert!(
                    (back - covariance[i][j]).abs() <= allowed,
                    "{i} {j}: {back}"
                );
            }
        }
        assert_eq!(root(&[vec![-1.0]]), Err((0, 0)));
    }
}
