//! Independent columns of a matrix, by QR with column pivoting (Golub and Van Loan 2013, section 5.4.2), with modified
//! Gram-Schmidt steps.

/// Part of the largest column below which a column is zero.
const ZERO: f64 = 1e-12;
/// Part of its own length that a column has to have outside the span of others to be independent of them: rounding is 1e-14,
/// offsets of 0.1 mm between the axes of a robot of 1 m are 1e-8 in their squares.
const INDEPENDENT: f64 = 1e-10;
/// Columns this close to the longest one count as equally long: the first of them is taken.
const EQUAL: f64 = 1e-6;

/// A matrix by columns.
pub(crate) struct Columns {
    rows: usize,
    values: Vec<f64>,
}

/// Columns of a matrix by what they depend on.
pub(crate) struct Split {
    /// Independent ones, in order.
    pub independent: Vec<usize>,
    /// Linear combinations of them, in order.
    pub dependent: Vec<usize>,
    /// Those that are zero, in order.
    pub zero: Vec<usize>,
    /// By rows: dependent columns as combinations (columns) of independent ones (rows).
    pub coefficients: Vec<f64>,
}

impl Columns {
    pub fn new(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            values: vec![0.0; rows * columns],
        }
    }

    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.values[column * self.rows + row] += value;
    }

    pub fn split(self) -> Split {
        let rows = self.rows.max(1);
        let mut columns: Vec<Vec<f64>> = self
            .values
            .chunks_exact(rows)
            .map(<[f64]>::to_vec)
            .collect();
        let original: Vec<f64> = columns.iter().map(|column| length(column)).collect();
        let largest = original.iter().fold(0.0, |m: f64, x| m.max(*x));
        let zero = |j: &usize| original[*j] <= ZERO * largest;
        let mut rest: Vec<usize> = (0..columns.len()).filter(|j| !zero(j)).collect();
        let zero = (0..columns.len()).filter(zero).collect();
        // Pivots in the order they were taken, each with the products of its direction with the columns.
        let mut pivots: Vec<(usize, Vec<f64>)> = Vec::new();
        loop {
            let outside =
                |j: usize| Some(length(&columns[j])).filter(|l| *l > INDEPENDENT * original[j]);
            let lengths: Vec<Option<f64>> = rest.iter().map(|j| outside(*j)).collect();
            let longest = lengths.iter().flatten().fold(0.0, |m: f64, x| m.max(*x));
            let taken = lengths
                .iter()
                .position(|l| l.is_some_and(|l| l >= (1.0 - EQUAL) * longest));
            let Some(taken) = taken else {
                break;
            };
            let pivot = rest.remove(taken);
            let mut direction = std::mem::take(&mut columns[pivot]);
            let norm = length(&direction);
            direction.iter_mut().for_each(|x| *x /= norm);
            let mut products = vec![0.0; columns.len()];
            products[pivot] = norm;
            for &j in &rest {
                products[j] = dot(&direction, &columns[j]);
                for (x, d) in columns[j].iter_mut().zip(&direction) {
                    *x -= products[j] * d;
                }
            }
            pivots.push((pivot, products));
        }
        Split {
            coefficients: coefficients(&pivots, &rest),
            independent: sorted(&pivots).iter().map(|k| pivots[*k].0).collect(),
            dependent: rest,
            zero,
        }
    }
}

/// Places of the pivots in the order of their columns.
fn sorted(pivots: &[(usize, Vec<f64>)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..pivots.len()).collect();
    order.sort_by_key(|k| pivots[*k].0);
    order
}

/// Solves the triangular systems for all dependent columns; rows in the order of the independent columns.
fn coefficients(pivots: &[(usize, Vec<f64>)], dependent: &[usize]) -> Vec<f64> {
    let mut solved = vec![vec![0.0; dependent.len()]; pivots.len()];
    for (column, &j) in dependent.iter().enumerate() {
        for k in (0..pivots.len()).rev() {
            let (pivot, products) = &pivots[k];
            let later = (k + 1..pivots.len()).map(|l| products[pivots[l].0] * solved[l][column]);
            solved[k][column] = (products[j] - later.sum::<f64>()) / products[*pivot];
        }
    }
    sorted(pivots)
        .into_iter()
        .flat_map(|k| std::mem::take(&mut solved[k]))
        .collect()
}

fn length(x: &[f64]) -> f64 {
    libm::sqrt(dot(x, x))
}

/// Sum of the products, in four partial sums.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((fours, rest), (others, other_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in fours.iter().zip(others) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = rest.iter().zip(other_rest).map(|(a, b)| a * b).sum();
    sums[0] + sums[1] + sums[2] + sums[3] + rest
}
