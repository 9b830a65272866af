//! How well parameters would be known.

use crate::aim::Aim;
use crate::candidate::PARAMETERS;
use crate::information::{ENTRIES, Information, Sums, UNKNOWNS};

/// Part of the bias of a single pair of cut-offs that an identification leaves: it measures the bias on replicas and takes it off.
/// A guess that fits simulated logs (decision 0078).
const BIAS_LEFT: f64 = 0.2;

/// Standard deviations relative to the values, for each parameter.
pub type Deviations = [f64; PARAMETERS];

/// With the best pair of cut-offs, the relative deviations that a motion with these sums gives. What is known of a parameter before
/// any log is a deviation of 1, which is 100 %.
pub(crate) fn deviations(information: &Information, aim: &Aim) -> Deviations {
    let (power, start) = (aim.force_noise * aim.force_noise, aim.start());
    let each = information.iter().map(|sums| {
        let mut sums = *sums;
        sums.add(&start, 1.0);
        of_pair(&sums, power)
    });
    let worst = |d: &Deviations| d.iter().copied().fold(0.0, f64::max);
    let best = each.min_by(|a, b| worst(a).total_cmp(&worst(b)));
    best.unwrap_or([1.0; PARAMETERS])
}

/// The largest of them.
pub(crate) fn worst(deviations: &Deviations) -> f64 {
    deviations.iter().copied().fold(0.0, f64::max)
}

/// `C = (A + s^2)^-1`, variance `s^2 C + C cov(J^T r) C` and the square of the part of `C b` that is left.
fn of_pair(sums: &Sums, power: f64) -> Deviations {
    let Some(inverse) = inverse(&sums.gram, power) else {
        return [1.0; PARAMETERS];
    };
    let entry = |i: usize, j: usize| {
        if i >= j {
            i * (i + 1) / 2 + j
        } else {
            j * (j + 1) / 2 + i
        }
    };
    std::array::from_fn(|i| {
        let row: [f64; UNKNOWNS] = std::array::from_fn(|j| inverse[entry(i, j)]);
        let mut scatter = 0.0;
        for k in 0..UNKNOWNS {
            let mut of_row = 0.5 * sums.scatter[entry(k, k)] * row[k];
            for (l, x) in row.iter().enumerate().take(k) {
                of_row += sums.scatter[entry(k, l)] * x;
            }
            scatter += 2.0 * row[k] * of_row;
        }
        let bias: f64 = row.iter().zip(&sums.bias).map(|(c, b)| c * b).sum();
        let left = BIAS_LEFT * bias;
        // An encoder that says nothing leaves what was known before.
        let variance = power * row[i] + scatter.max(0.0) + left * left;
        libm::sqrt(variance).min(1.0)
    })
}

/// The inverse of the matrix plus `power` on its diagonal, the lower triangle by rows; `None` where rounding leaves none.
fn inverse(gram: &[f64; ENTRIES], power: f64) -> Option<[f64; ENTRIES]> {
    const N: usize = UNKNOWNS;
    let at = |i: usize, j: usize| i * (i + 1) / 2 + j;
    // Cholesky's factor L.
    let mut l = *gram;
    for i in 0..N {
        l[at(i, i)] += power;
    }
    for i in 0..N {
        for j in 0..=i {
            let mut sum = l[at(i, j)];
            for k in 0..j {
                sum -= l[at(i, k)] * l[at(j, k)];
            }
            if i == j {
                if sum.is_nan() || sum <= 0.0 {
                    return None;
                }
                l[at(i, i)] = libm::sqrt(sum);
            } else {
                l[at(i, j)] = sum / l[at(j, j)];
            }
        }
    }
    // Its inverse, in place.
    let mut m = l;
    for i in 0..N {
        m[at(i, i)] = 1.0 / l[at(i, i)];
        for j in 0..i {
            let mut sum = 0.0;
            for k in j..i {
                sum += l[at(i, k)] * m[at(k, j)];
            }
            m[at(i, j)] = -sum * m[at(i, i)];
        }
    }
    let mut out = [0.0; ENTRIES];
    for i in 0..N {
        for j in 0..=i {
            out[at(i, j)] = (i..N).map(|k| m[at(k, i)] * m[at(k, j)]).sum();
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix that is known with its inverse: second differences with ends held, whose inverse has the entries
    /// min(i, j) (N + 1 - max(i, j))/(N + 1), i and j from 1.
    #[test]
    fn the_inverse_of_second_differences_is_that_of_a_string() {
        let mut gram = [0.0; ENTRIES];
        for i in 0..UNKNOWNS {
            gram[i * (i + 1) / 2 + i] = 1.5;
            if i > 0 {
                gram[i * (i + 1) / 2 + i - 1] = -1.0;
            }
        }
        let found = inverse(&gram, 0.5).unwrap();
        for i in 0..UNKNOWNS {
            for j in 0..=i {
                let whole = (UNKNOWNS + 1) as f64;
                let right = (j + 1) as f64 * (whole - (i + 1) as f64) / whole;
                assert!((found[i * (i + 1) / 2 + j] - right).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn nothing_recorded_leaves_what_was_known_before() {
        let nothing = [Sums::ZERO; crate::information::PAIR_COUNT];
        assert_eq!(deviations(&nothing, &Aim::new(0.3)), [1.0; PARAMETERS]);
    }
}
