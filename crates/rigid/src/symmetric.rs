//! Eigenvalues and eigenvectors of small symmetric matrices.

/// Sweeps of rotations; five are enough for rounding.
const SWEEPS: usize = 30;

/// Eigenvalues, smallest first, and the eigenvectors as columns, by cyclic Jacobi rotations (Golub and Van Loan 2013,
/// section 8.5).
pub(crate) fn eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut v = [[0.0; N]; N];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for _ in 0..SWEEPS {
        for p in 0..N {
            for q in p + 1..N {
                rotate(&mut a, &mut v, p, q);
            }
        }
    }
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    let values = order.map(|i| a[i][i]);
    (values, v.map(|row| order.map(|i| row[i])))
}

pub(crate) fn eigenvalues<const N: usize>(a: [[f64; N]; N]) -> [f64; N] {
    eigen(a).0
}

/// Makes the element p, q zero.
fn rotate<const N: usize>(a: &mut [[f64; N]; N], v: &mut [[f64; N]; N], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = tau.signum() / (tau.abs() + libm::hypot(1.0, tau));
    let c = 1.0 / libm::sqrt(1.0 + t * t);
    let s = t * c;
    let turned = |row: &mut [f64; N]| {
        let (x, y) = (row[p], row[q]);
        (row[p], row[q]) = (c * x - s * y, s * x + c * y);
    };
    a.iter_mut().for_each(turned);
    v.iter_mut().for_each(turned);
    let (x, y) = (a[p], a[q]);
    a[p] = std::array::from_fn(|k| c * x[k] - s * y[k]);
    a[q] = std::array::from_fn(|k| s * x[k] + c * y[k]);
    (a[p][q], a[q][p]) = (0.0, 0.0);
}
