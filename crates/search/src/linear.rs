//! Small dense linear algebra in a fixed order of operations.

/// Solves `A x = b` for a symmetric positive definite `A`, row after row; `None` if it is not.
pub(crate) fn cholesky_solve(mut a: Vec<f64>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for j in 0..n {
        for i in j..n {
            let mut s = a[i * n + j];
            for k in 0..j {
                s -= a[i * n + k] * a[j * n + k];
            }
            if i > j {
                a[i * n + j] = s / a[j * n + j];
            } else if s > 0.0 && s.is_finite() {
                a[j * n + j] = s.sqrt();
            } else {
                return None;
            }
        }
    }
    for i in 0..n {
        for k in 0..i {
            b[i] -= a[i * n + k] * b[k];
        }
        b[i] /= a[i * n + i];
    }
    let mut column = vec![0.0; n];
    for i in (0..n).rev() {
        for k in i + 1..n {
            column[k] = a[k * n + i];
        }
        b[i] = (b[i] - dot(&column[i + 1..], &b[i + 1..])) / a[i * n + i];
    }
    b.iter().all(|x| x.is_finite()).then_some(b)
}

/// Sum of products, in eight lanes and then the rest.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (wide_a, rest_a) = a.as_chunks::<8>();
    let (wide_b, rest_b) = b.as_chunks::<8>();
    let mut lanes = [0.0; 8];
    for (x, y) in wide_a.iter().zip(wide_b) {
        for lane in 0..8 {
            lanes[lane] += x[lane] * y[lane];
        }
    }
    let mut sum = 0.0;
    for lane in 0..4 {
        sum += lanes[lane] + lanes[lane + 4];
    }
    for (x, y) in rest_a.iter().zip(rest_b) {
        sum += x * y;
    }
    sum
}

/// Most sweeps of the rotations: they converge quadratically, a handful do for 64 dimensions.
const MOST_SWEEPS: usize = 40;
/// Sum of squares off the diagonal, divided by that on it, which is rounding only: the square of 1e-17.
const OFF_DIAGONAL_REST: f64 = 1e-34;

/// Eigenvalues and eigenvectors (in the columns) of a symmetric matrix, by cyclic Jacobi rotations
/// (Golub and Van Loan, Matrix Computations, 4th ed., alg. 8.5.3).
pub(crate) fn symmetric_eigen(mut a: Vec<f64>, n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut v = vec![0.0; n * n];
    for i in 0..n {
        v[i * n + i] = 1.0;
    }
    for _ in 0..MOST_SWEEPS {
        let mut off = 0.0;
        let mut on = 0.0;
        for i in 0..n {
            on += a[i * n + i] * a[i * n + i];
            for j in 0..i {
                off += a[i * n + j] * a[i * n + j];
            }
        }
        if off <= OFF_DIAGONAL_REST * on {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, &mut v, n, p, q);
            }
        }
    }
    ((0..n).map(|i| a[i * n + i]).collect(), v)
}

/// Takes the element `(p, q)` to zero.
fn rotate(a: &mut [f64], v: &mut [f64], n: usize, p: usize, q: usize) {
    let apq = a[p * n + q];
    if apq == 0.0 {
        return;
    }
    let tau = (a[q * n + q] - a[p * n + p]) / (2.0 * apq);
    let t = if tau.is_infinite() {
        0.0
    } else {
        tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt())
    };
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = t * c;
    for k in 0..n {
        let (x, y) = (a[k * n + p], a[k * n + q]);
        a[k * n + p] = c * x - s * y;
        a[k * n + q] = s * x + c * y;
    }
    for k in 0..n {
        let (x, y) = (a[p * n + k], a[q * n + k]);
        a[p * n + k] = c * x - s * y;
        a[q * n + k] = s * x + c * y;
    }
    for k in 0..n {
        let (x, y) = (v[k * n + p], v[k * n + q]);
        v[k * n + p] = c * x - s * y;
        v[k * n + q] = s * x + c * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Dice;

    fn random_positive(n: usize, dice: &mut Dice) -> Vec<f64> {
        let b: Vec<f64> = (0..n * n).map(|_| dice.normal()).collect();
        let mut a = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                a[i * n + j] = (0..n).map(|k| b[i * n + k] * b[j * n + k]).sum();
            }
        }
        a
    }

    #[test]
    fn eigenvectors_rebuild_the_matrix() {
        let mut dice = Dice::new(3);
        for n in 1..12 {
            let a = random_positive(n, &mut dice);
            let (values, v) = symmetric_eigen(a.clone(), n);
            for i in 0..n {
                for j in 0..n {
                    let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(f).sum::<f64>();
                    let back = sum(&|k| v[i * n + k] * values[k] * v[j * n + k]);
                    let unit = sum(&|k| v[k * n + i] * v[k * n + j]);
                    assert!((back - a[i * n + j]).abs() < 1e-12 * n as f64 * 10.0);
                    assert!((unit - f64::from(u8::from(i == j))).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn solves_or_refuses() {
        let mut dice = Dice::new(4);
        for n in 1..12 {
            let a = random_positive(n, &mut dice);
            let x: Vec<f64> = (0..n).map(|_| dice.normal()).collect();
            let times = |x: &[f64]| -> Vec<f64> {
                a.chunks(n)
                    .map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
                    .collect()
            };
            let b = times(&x);
            let got = cholesky_solve(a.clone(), b.clone()).expect("positive definite");
            for (r, b) in times(&got).iter().zip(&b) {
                assert!((r - b).abs() < 1e-11);
            }
        }
        assert_eq!(cholesky_solve(vec![1.0, 2.0, 2.0, 1.0], vec![1.0; 2]), None);
        assert_eq!(cholesky_solve(vec![f64::NAN], vec![1.0]), None);
    }
}
