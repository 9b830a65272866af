//! The inner problem: linear least squares with a few coefficients that must not be negative.

use super::nonnegative;
use nalgebra::{DMatrix, DVector};
use stiction_dispatch::{InstructionSet, Kernel};

/// Columns whose part outside the span of those before is below this (relative, squared) cannot be
/// told apart from them and are left out.
const DEPENDENT_REMAINDER: f64 = 1e-13;
/// Largest number of bounded columns for which every subset is tried.
const MOST_TRIED: usize = 6;

/// Sum of products in a fixed order: the same bits everywhere.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    InstructionSet::best().run(Product(a, b))
}

struct Product<'a>(&'a [f64], &'a [f64]);

impl Kernel for Product<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        products(self.0, [self.1])[0]
    }
}

/// Products of one column with some others.
#[inline(always)]
fn products<const N: usize>(a: &[f64], others: [&[f64]; N]) -> [f64; N] {
    let mut sums = [Dot::default(); N];
    add(&mut sums, a, others);
    let mut out = [0.0; N];
    for n in 0..N {
        out[n] = sums[n].sum();
    }
    out
}

/// Appends the products of one column with each of many: as many at a time as stay in registers.
#[inline(always)]
fn append_products(a: &[f64], others: &[&[f64]], out: &mut Vec<f64>) {
    let (fours, rest) = others.as_chunks::<4>();
    for four in fours {
        out.extend(products(a, *four));
    }
    match *rest {
        [x] => out.extend(products(a, [x])),
        [x, y] => out.extend(products(a, [x, y])),
        [x, y, z] => out.extend(products(a, [x, y, z])),
        _ => {}
    }
}

/// A sum of products that comes in parts, of which all but the last are multiples of four long: four partial sums for speed.
#[derive(Clone, Copy, Default)]
struct Dot {
    sums: [f64; 4],
    tail: f64,
}

impl Dot {
    #[inline(always)]
    fn sum(self) -> f64 {
        let [a, b, c, d] = self.sums;
        (a + b) + (c + d) + self.tail
    }
}

/// Adds the next part of the products of one column with some others.
#[inline(always)]
fn add<const N: usize>(to: &mut [Dot; N], a: &[f64], others: [&[f64]; N]) {
    let mut count = a.len();
    for other in &others {
        count = count.min(other.len());
    }
    let (wide, rest) = a[..count].as_chunks::<4>();
    let mut wide_others = [wide; N];
    let mut rest_others = [rest; N];
    let mut sums = [[0.0; 4]; N];
    for n in 0..N {
        (wide_others[n], rest_others[n]) = others[n][..count].as_chunks::<4>();
        sums[n] = to[n].sums;
    }
    for i in 0..wide.len() {
        let x = wide[i];
        for n in 0..N {
            let y = wide_others[n][i];
            for lane in 0..4 {
                sums[n][lane] += x[lane] * y[lane];
            }
        }
    }
    for n in 0..N {
        to[n].sums = sums[n];
        to[n].tail = rest.iter().zip(rest_others[n]).map(|(x, y)| x * y).sum();
    }
}

/// Takes some columns, each times its coefficient, from the samples from `start` on.
#[inline(always)]
fn take<const N: usize>(columns: [&[f64]; N], c: [f64; N], start: usize, from: &mut [f64]) {
    let count = from.len();
    let mut parts: [&[f64]; N] = [&[]; N];
    for n in 0..N {
        parts[n] = &columns[n][start..start + count];
    }
    for (i, x) in from.iter_mut().enumerate() {
        let mut left = *x;
        for n in 0..N {
            left -= c[n] * parts[n][i];
        }
        *x = left;
    }
}

/// Solution of the inner problem.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// One coefficient per column; zero where the column is not active.
    pub coefficients: Vec<f64>,
    /// Which columns take part: neither held at zero by their bound nor dependent on others.
    pub active: Vec<bool>,
    /// Columns that depend on the ones before them.
    pub dependent: Vec<bool>,
    /// `u - Phi c`.
    pub residual: Vec<f64>,
    /// Sum of squares of the residual.
    pub cost: f64,
    /// Factor of the scaled Gram matrix of the active columns.
    factor: Factor,
}

#[derive(Clone, Debug)]
pub(crate) struct Factor {
    /// Indices of the active columns.
    columns: Vec<usize>,
    scale: Vec<f64>,
    lower: DMatrix<f64>,
}

impl Factor {
    /// Cholesky of the scaled Gram matrix of `wanted`, leaving out dependent columns.
    pub fn new(gram: &DMatrix<f64>, wanted: &[usize]) -> (Self, Vec<usize>) {
        let mut columns = Vec::new();
        let mut dropped = Vec::new();
        let m = wanted.len();
        let mut lower = DMatrix::zeros(m, m);
        let mut scale = Vec::new();
        for &j in wanted {
            let norm = gram[(j, j)];
            let at = columns.len();
            if !(norm > 0.0 && norm.is_finite()) {
                dropped.push(j);
                continue;
            }
            let s = 1.0 / norm.sqrt();
            let mut pivot = 1.0;
            let mut row = vec![0.0; at];
            for (k, &i) in columns.iter().enumerate() {
                let mut x: f64 = gram[(j, i)] * s * scale[k];
                for l in 0..k {
                    x -= row[l] * lower[(k, l)];
                }
                row[k] = x / lower[(k, k)];
                pivot -= row[k] * row[k];
            }
            if pivot <= DEPENDENT_REMAINDER {
                dropped.push(j);
                continue;
            }
            for (k, x) in row.into_iter().enumerate() {
                lower[(at, k)] = x;
            }
            lower[(at, at)] = pivot.sqrt();
            columns.push(j);
            scale.push(s);
        }
        let n = columns.len();
        (
            Self {
                columns,
                scale,
                lower: lower.view((0, 0), (n, n)).into_owned(),
            },
            dropped,
        )
    }

    /// Takes `Phi c` of the active columns from the samples from `start` on.
    #[inline(always)]
    fn subtract(&self, columns: &[&[f64]], c: &[f64], start: usize, from: &mut [f64]) {
        let (places, rest) = self.columns.as_chunks::<4>();
        let (fours, tail) = c.as_chunks::<4>();
        for ([i, j, k, l], c) in places.iter().zip(fours) {
            let four = [columns[*i], columns[*j], columns[*k], columns[*l]];
            take(four, *c, start, from);
        }
        match (rest, tail) {
            ([i], [a]) => take([columns[*i]], [*a], start, from),
            ([i, j], [a, b]) => take([columns[*i], columns[*j]], [*a, *b], start, from),
            ([i, j, k], [a, b, c]) => {
                let three = [columns[*i], columns[*j], columns[*k]];
                take(three, [*a, *b, *c], start, from);
            }
            _ => {}
        }
    }

    /// The same from all samples.
    #[inline(always)]
    fn subtract_all(&self, columns: &[&[f64]], c: &[f64], from: &mut [f64]) {
        for (start, part) in (0..).step_by(CHUNK).zip(from.chunks_mut(CHUNK)) {
            self.subtract(columns, c, start, part);
        }
    }

    /// The products of the active columns with another.
    #[inline(always)]
    fn products(&self, columns: &[&[f64]], other: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.columns.len());
        let mut taken = Vec::with_capacity(self.columns.len());
        for &j in &self.columns {
            taken.push(columns[j]);
        }
        append_products(other, &taken, &mut out);
        out
    }

    /// Indices of the active columns.
    pub fn columns(&self) -> &[usize] {
        &self.columns
    }

    /// Solves the normal equations for a right-hand side given for the active columns.
    pub fn solve(&self, rhs: &[f64]) -> Vec<f64> {
        let mut b =
            DVector::from_iterator(rhs.len(), rhs.iter().zip(&self.scale).map(|(x, s)| x * s));
        self.lower.solve_lower_triangular_mut(&mut b);
        self.lower.tr_solve_lower_triangular_mut(&mut b);
        b.iter().zip(&self.scale).map(|(x, s)| x * s).collect()
    }
}

impl Solution {
    /// For each derivative of the model what a step of its unknown changes in the coefficients, to first order, the
    /// unknown itself held: `-pinv(Phi) d`.
    pub fn turned(&self, columns: &[&[f64]], slopes: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let of = |d: &Vec<f64>| {
            let taken = self.factor.columns.iter();
            let inside: Vec<f64> = taken.map(|&j| dot(columns[j], d)).collect();
            self.placed(self.factor.solve(&inside).into_iter().map(|x| -x))
        };
        slopes.iter().map(of).collect()
    }

    /// The inverse of the Gram matrix, row by row; zero where a column is not active.
    pub fn inverse(&self) -> Vec<Vec<f64>> {
        let taken = &self.factor.columns;
        let row = |i: usize| match taken.iter().position(|&j| j == i) {
            Some(at) => {
                let mut unit = vec![0.0; taken.len()];
                unit[at] = 1.0;
                self.placed(self.factor.solve(&unit).into_iter())
            }
            None => vec![0.0; self.coefficients.len()],
        };
        (0..self.coefficients.len()).map(row).collect()
    }

    /// Values of the active columns at their places among all.
    fn placed(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut out = vec![0.0; self.coefficients.len()];
        for (&j, x) in self.factor.columns.iter().zip(values) {
            out[j] = x;
        }
        out
    }

    /// `J^T J` of the reduced problem (Kaufman) for the derivatives of the model: the products of their parts that
    /// the active columns cannot express.
    pub fn curvature(&self, columns: &[&[f64]], slopes: &[Vec<f64>]) -> DMatrix<f64> {
        InstructionSet::best().run(Curvature {
            solution: self,
            columns,
            slopes,
        })
    }
}

struct Curvature<'a> {
    solution: &'a Solution,
    columns: &'a [&'a [f64]],
    slopes: &'a [Vec<f64>],
}

impl Kernel for Curvature<'_> {
    type Output = DMatrix<f64>;

    #[inline(always)]
    fn run(self) -> DMatrix<f64> {
        let Solution {
            factor, residual, ..
        } = self.solution;
        let k = self.slopes.len();
        let mut inside = Vec::with_capacity(k);
        for d in self.slopes {
            inside.push(factor.solve(&factor.products(self.columns, d)));
        }
        let mut sums = vec![[Dot::default()]; k * k];
        let mut outside = vec![[0.0; CHUNK]; k];
        for start in (0..residual.len()).step_by(CHUNK) {
            let end = residual.len().min(start + CHUNK);
            for i in 0..k {
                let part = &mut outside[i][..end - start];
                part.copy_from_slice(&self.slopes[i][start..end]);
                factor.subtract(self.columns, &inside[i], start, part);
            }
            for i in 0..k {
                for j in 0..=i {
                    let other = &outside[j][..end - start];
                    add(&mut sums[i * k + j], &outside[i][..end - start], [other]);
                }
            }
        }
        DMatrix::from_fn(k, k, |i, j| sums[i.max(j) * k + i.min(j)][0].sum())
    }
}

/// Number of samples that stay in the fastest CPU cache while every column is subtracted from them.
const CHUNK: usize = 512;

/// The factor of the columns that take part, their coefficients in its order, and the columns that depend on
/// others.
type Taken = (Factor, Vec<f64>, Vec<usize>);

/// Products of columns with each other and with the target.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    pub gram: DMatrix<f64>,
    pub rhs: Vec<f64>,
    /// Sum of squares of the target.
    pub energy: f64,
}

impl Normal {
    /// The constrained optimum. Of a handful of bounded columns every subset that a bound could hold at zero is
    /// tried in turn, the one leaving the least residual and breaking no bound wins; with more,
    /// [`nonnegative`](super::nonnegative) finds it.
    pub fn solve(&self, bounded: &[bool]) -> Taken {
        if bounded.iter().filter(|&&b| b).count() <= MOST_TRIED {
            return self.best_subset(bounded);
        }
        let held = nonnegative::held(&self.gram, &self.rhs, bounded, self.energy);
        let wanted: Vec<usize> = (0..self.rhs.len()).filter(|j| !held[*j]).collect();
        let (factor, dropped) = Factor::new(&self.gram, &wanted);
        let c = factor.solve(&self.of(&factor));
        (factor, c, dropped)
    }

    /// The right-hand side of the columns that take part.
    fn of(&self, factor: &Factor) -> Vec<f64> {
        factor.columns.iter().map(|&j| self.rhs[j]).collect()
    }

    /// Of all subsets that the bounds could leave free, the one that explains most and breaks no bound.
    fn best_subset(&self, nonnegative: &[bool]) -> Taken {
        let m = self.rhs.len();
        let bounded: Vec<usize> = (0..m).filter(|&j| nonnegative[j]).collect();
        let mut best: Option<(f64, Taken)> = None;
        for set in 0_u32..(1 << bounded.len()) {
            let mut held = vec![false; m];
            for (bit, &j) in bounded.iter().enumerate() {
                held[j] = set >> bit & 1 == 1;
            }
            let wanted: Vec<usize> = (0..m).filter(|j| !held[*j]).collect();
            let (factor, dropped) = Factor::new(&self.gram, &wanted);
            let pick = self.of(&factor);
            let c = factor.solve(&pick);
            let mut taken = factor.columns.iter().zip(&c);
            if taken.any(|(&j, &x)| nonnegative[j] && x < 0.0) {
                continue;
            }
            // Explained sum of squares; the most explained wins.
            let explained: f64 = c.iter().zip(&pick).map(|(x, b)| x * b).sum();
            if best.as_ref().is_none_or(|(most, _)| explained > *most) {
                best = Some((explained, (factor, c, dropped)));
            }
            if set == 0 {
                break; // The free solution breaks no bound: it is the constrained optimum.
            }
        }
        best.map_or_else(
            || (Factor::new(&self.gram, &[]).0, Vec::new(), Vec::new()),
            |(_, found)| found,
        )
    }
}

/// Least squares of `u` on `columns`, with the `bounded` coefficients at or above zero.
///
/// The normal equations are solved on scaled columns and refined once with the true residual, which
/// brings the accuracy of an orthogonal factorisation.
pub(crate) fn solve(columns: &[&[f64]], bounded: &[bool], u: &[f64]) -> Solution {
    InstructionSet::best().run(Inner {
        columns,
        bounded,
        u,
    })
}

struct Inner<'a> {
    columns: &'a [&'a [f64]],
    bounded: &'a [bool],
    u: &'a [f64],
}

impl Kernel for Inner<'_> {
    type Output = Solution;

    #[inline(always)]
    fn run(self) -> Solution {
        let Inner {
            columns,
            bounded,
            u,
        } = self;
        let m = columns.len();
        let mut gram = DMatrix::zeros(m, m);
        let mut row = Vec::with_capacity(m);
        for i in 0..m {
            row.clear();
            append_products(columns[i], &columns[..=i], &mut row);
            for (j, &x) in row.iter().enumerate() {
                gram[(i, j)] = x;
                gram[(j, i)] = x;
            }
        }
        let mut rhs = Vec::with_capacity(m);
        append_products(u, columns, &mut rhs);
        let normal = Normal {
            gram,
            rhs,
            energy: products(u, [u])[0],
        };
        let (factor, mut c, dropped) = normal.solve(bounded);
        let mut r = u.to_vec();
        factor.subtract_all(columns, &c, &mut r);
        let correction = factor.products(columns, &r);
        for (x, d) in c.iter_mut().zip(factor.solve(&correction)) {
            *x += d;
        }
        r.copy_from_slice(u);
        factor.subtract_all(columns, &c, &mut r);

        let mut coefficients = vec![0.0; m];
        let mut active = vec![false; m];
        for (&j, &x) in factor.columns.iter().zip(&c) {
            coefficients[j] = x;
            active[j] = true;
        }
        let mut dependent = vec![false; m];
        for j in dropped {
            dependent[j] = true;
        }
        let cost = products(&r, [&r])[0];
        Solution {
            coefficients,
            active,
            dependent,
            residual: r,
            cost,
            factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(n: usize) -> Vec<Vec<f64>> {
        (0..4)
            .map(|k| {
                (0..n)
                    .map(|i| ((i * (k + 2)) as f64 * 0.37 + k as f64).sin())
                    .collect()
            })
            .collect()
    }

    #[test]
    fn exact_data_gives_exact_coefficients() {
        let columns = waves(501);
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let truth = [1.5e3, 2e-4, 7.0, -3.0];
        let u: Vec<f64> = (0..501)
            .map(|i| (0..4).map(|k| truth[k] * columns[k][i]).sum())
            .collect();
        let found = solve(&views, &[true, true, true, false], &u);
        for (x, t) in found.coefficients.iter().zip(truth) {
            assert!((x / t - 1.0).abs() < 1e-9, "{x} instead of {t}");
        }
    }

    #[test]
    fn a_bound_that_would_be_broken_holds_and_satisfies_the_optimality_conditions() {
        let columns = waves(300);
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let u: Vec<f64> = (0..300)
            .map(|i| 2.0 * columns[0][i] - 1.0 * columns[1][i] + 0.1 * columns[2][i])
            .collect();
        let found = solve(&views, &[true; 4], &u);
        for (j, column) in columns.iter().enumerate() {
            let slope = dot(column, &found.residual);
            if found.active[j] {
                assert!(found.coefficients[j] >= 0.0);
                assert!(slope.abs() < 1e-9, "residual not orthogonal to column {j}");
            } else {
                assert!(slope <= 1e-9, "column {j} would help if it were let in");
            }
        }
        assert!(!found.active[1]);
    }

    #[test]
    fn a_column_that_repeats_another_is_left_out() {
        let columns = waves(100);
        let twice: Vec<f64> = columns[0].iter().map(|x| 3.0 * x).collect();
        let views: Vec<&[f64]> = vec![&columns[0], &twice, &columns[1]];
        let found = solve(&views, &[false; 3], &columns[0].clone());
        assert_eq!(found.dependent, [false, true, false]);
        assert!((found.coefficients[0] - 1.0).abs() < 1e-12);
    }
}
