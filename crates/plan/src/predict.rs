//! How well parameters would be known.

use crate::aim::Aim;
use crate::information::{Information, PAIR_COUNT, Sums, entries};

/// Part of the bias of a single pair of cut-offs that an identification leaves: it measures the bias on replicas and takes it off.
/// A guess that fits simulated logs (decision 0078).
const BIAS_LEFT: f64 = 0.2;

/// Standard deviations of the parameters, in the [units](crate::Candidate::units) of the axis: relative to the values, of the terms
/// in parts of Coulomb friction.
pub type Deviations = Vec<f64>;

/// With the best pair of cut-offs, the relative deviations that a motion with these sums gives. What is known of a parameter before
/// any log is a deviation of 1, which is 100 %.
pub(crate) fn deviations(information: &Information, aim: &Aim) -> Deviations {
    let mut scratch = Scratch::new(information);
    let each = (0..PAIR_COUNT).map(|pair| scratch.of_pair(information, pair, aim).to_vec());
    let best = each.min_by(|a, b| worst(a).total_cmp(&worst(b)));
    best.unwrap_or_else(|| vec![1.0; information.parameters])
}

/// The largest of them.
pub(crate) fn worst(deviations: &[f64]) -> f64 {
    deviations.iter().copied().fold(0.0, f64::max)
}

/// The largest deviation with the best pair of cut-offs.
pub(crate) fn least_worst(information: &Information, aim: &Aim, scratch: &mut Scratch) -> f64 {
    let each = (0..PAIR_COUNT).map(|pair| worst(scratch.of_pair(information, pair, aim)));
    each.min_by(f64::total_cmp).unwrap_or(1.0)
}

/// Room for matrices, so that a choice among thousands of motions need not ask for any.
pub(crate) struct Scratch {
    factor: Vec<f64>,
    roots: Vec<f64>,
    inverse: Vec<f64>,
    row: Vec<f64>,
    out: Vec<f64>,
}

/// Unknowns of symmetric LuGre with a mass, an offset and a delay, for which loops are made of their own.
const USUAL: usize = 9;

impl Scratch {
    pub fn new(information: &Information) -> Self {
        let (unknowns, n) = (information.unknowns, entries(information.unknowns));
        Scratch {
            factor: vec![0.0; n],
            roots: vec![0.0; n],
            inverse: vec![0.0; n],
            row: vec![0.0; unknowns],
            out: vec![1.0; information.parameters],
        }
    }

    /// The deviations with a pair of cut-offs.
    fn of_pair(&mut self, information: &Information, pair: usize, aim: &Aim) -> &[f64] {
        let Some(sums) = information.pairs().nth(pair) else {
            self.out.fill(1.0);
            return &self.out;
        };
        let power = aim.force_noise * aim.force_noise;
        match information.unknowns {
            USUAL => self.solve(USUAL, &sums, aim, power),
            unknowns => self.solve(unknowns, &sums, aim, power),
        }
        &self.out
    }

    /// `C = (A + s^2)^-1`, variance `s^2 C + C cov(J^T r) C` and the square of the part of `C b` that is left.
    #[inline(always)]
    fn solve(&mut self, unknowns: usize, sums: &Sums, aim: &Aim, power: f64) {
        self.factor.copy_from_slice(sums.gram);
        aim.start(&mut self.factor);
        for i in 0..unknowns {
            self.factor[at(i, i)] += power;
        }
        if !self.invert(unknowns) {
            self.out.fill(1.0);
            return;
        }
        let (inverse, row) = (
            &self.inverse[..entries(unknowns)],
            &mut self.row[..unknowns],
        );
        let (scatters, biases) = (&sums.scatter[..entries(unknowns)], &sums.bias[..unknowns]);
        for (i, out) in self.out.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().enumerate() {
                *x = inverse[if i >= j { at(i, j) } else { at(j, i) }];
            }
            let mut scatter = 0.0;
            for k in 0..unknowns {
                let mut of_row = 0.5 * scatters[at(k, k)] * row[k];
                for (l, x) in row.iter().enumerate().take(k) {
                    of_row += scatters[at(k, l)] * x;
                }
                scatter += 2.0 * row[k] * of_row;
            }
            let bias: f64 = row.iter().zip(biases).map(|(c, b)| c * b).sum();
            let left = BIAS_LEFT * bias;
            // An encoder that says nothing leaves what was known before.
            let variance = power * row[i] + scatter.max(0.0) + left * left;
            *out = libm::sqrt(variance).min(1.0);
        }
    }

    /// The inverse of the matrix in `factor`, the lower triangle by rows; whether rounding leaves one.
    #[inline(always)]
    fn invert(&mut self, unknowns: usize) -> bool {
        let n = entries(unknowns);
        let (l, m) = (&mut self.factor[..n], &mut self.roots[..n]);
        // Cholesky's factor, in place.
        for i in 0..unknowns {
            for j in 0..=i {
                let mut sum = l[at(i, j)];
                for k in 0..j {
                    sum -= l[at(i, k)] * l[at(j, k)];
                }
                if i == j {
                    if sum.is_nan() || sum <= 0.0 {
                        return false;
                    }
                    l[at(i, i)] = libm::sqrt(sum);
                } else {
                    l[at(i, j)] = sum / l[at(j, j)];
                }
            }
        }
        // Its inverse.
        for i in 0..unknowns {
            m[at(i, i)] = 1.0 / l[at(i, i)];
            for j in 0..i {
                let mut sum = 0.0;
                for k in j..i {
                    sum += l[at(i, k)] * m[at(k, j)];
                }
                m[at(i, j)] = -sum * m[at(i, i)];
            }
        }
        let out = &mut self.inverse[..n];
        for i in 0..unknowns {
            for j in 0..=i {
                out[at(i, j)] = (i..unknowns).map(|k| m[at(k, i)] * m[at(k, j)]).sum();
            }
        }
        true
    }
}

/// The place of an entry of a lower triangle by rows.
#[inline(always)]
fn at(i: usize, j: usize) -> usize {
    i * (i + 1) / 2 + j
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix that is known with its inverse: second differences with ends held, whose inverse has the entries
    /// min(i, j) (N + 1 - max(i, j))/(N + 1), i and j from 1.
    #[test]
    fn the_inverse_of_second_differences_is_that_of_a_string() {
        for unknowns in [1, 2, USUAL, 23] {
            let mut scratch = Scratch::new(&Information::none(unknowns, unknowns));
            for i in 0..unknowns {
                scratch.factor[at(i, i)] = 2.0;
                if i > 0 {
                    scratch.factor[at(i, i - 1)] = -1.0;
                }
            }
            assert!(scratch.invert(unknowns));
            for i in 0..unknowns {
                for j in 0..=i {
                    let whole = (unknowns + 1) as f64;
                    let right = (j + 1) as f64 * (whole - (i + 1) as f64) / whole;
                    assert!((scratch.inverse[at(i, j)] - right).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn nothing_recorded_leaves_what_was_known_before() {
        for (parameters, unknowns) in [(7, 9), (20, 22)] {
            let nothing = Information::none(parameters, unknowns);
            assert_eq!(deviations(&nothing, &Aim::new(0.3)), vec![1.0; parameters]);
        }
    }
}
