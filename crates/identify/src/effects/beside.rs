//! What a column explains of a residual beyond all that the columns of a fit can take up.

use crate::separable::linear::dot;

/// Part of a column outside the others below which it is one of them but for rounding.
const ROUNDING: f64 = 1e-10;

/// A residual, and the columns that were fitted.
pub(super) struct Beside {
    residual: Vec<f64>,
    /// Sum of its squares.
    square: f64,
    /// An orthonormal basis of the columns.
    basis: Vec<Vec<f64>>,
}

/// What a column explains.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Explained {
    /// Part of the sum of squares.
    pub share: f64,
    /// Its coefficient.
    pub coefficient: f64,
}

impl Beside {
    pub fn new(columns: &[&[f64]], residual: &[f64]) -> Self {
        let mut beside = Self {
            residual: residual.to_vec(),
            square: dot(residual, residual),
            basis: Vec::with_capacity(columns.len()),
        };
        for column in columns {
            beside.add(column);
        }
        beside
    }

    /// The same with one more column fitted.
    pub fn with(&self, column: &[f64]) -> Self {
        let mut more = Self {
            residual: self.residual.clone(),
            square: self.square,
            basis: self.basis.clone(),
        };
        more.add(column);
        more
    }

    fn add(&mut self, column: &[f64]) {
        let norm = dot(column, column).sqrt();
        // Twice, since the first time leaves what rounding does of columns that are nearly alike.
        let outside = self.outside(&self.outside(column));
        let own = dot(&outside, &outside).sqrt();
        if own.is_nan() || own <= ROUNDING * norm {
            return;
        }
        let unit: Vec<f64> = outside.iter().map(|x| x / own).collect();
        let part = dot(&unit, &self.residual);
        let both = self.residual.iter_mut().zip(&unit);
        both.for_each(|(r, u)| *r -= part * u);
        self.square = dot(&self.residual, &self.residual);
        self.basis.push(unit);
    }

    /// The part of a column that the others do not have.
    pub fn outside(&self, column: &[f64]) -> Vec<f64> {
        let mut out = column.to_vec();
        for unit in &self.basis {
            let part = dot(unit, &out);
            out.iter_mut().zip(unit).for_each(|(x, u)| *x -= part * u);
        }
        out
    }

    /// Part of the squares of a column that the others do not have.
    pub fn part_outside(&self, column: &[f64]) -> f64 {
        let outside = self.outside(column);
        dot(&outside, &outside) / dot(column, column)
    }

    /// What a column explains of what is left.
    pub fn explained(&self, column: &[f64]) -> Explained {
        let outside = self.outside(column);
        let own = dot(&outside, &outside);
        let product = dot(&outside, &self.residual);
        let all = dot(column, column);
        if own.is_nan() || own <= ROUNDING * ROUNDING * all || self.square <= 0.0 {
            return Explained::default();
        }
        Explained {
            share: product * product / own / self.square,
            coefficient: product / own,
        }
    }

    /// What two columns together explain: the part of the sum of squares, and their coefficients.
    pub fn pair(&self, columns: &[Vec<f64>; 2]) -> (f64, [f64; 2]) {
        let [one, other] = [&columns[0], &columns[1]].map(|column| self.outside(column));
        let (aa, ab, bb) = (dot(&one, &one), dot(&one, &other), dot(&other, &other));
        let (ar, br) = (dot(&one, &self.residual), dot(&other, &self.residual));
        let determinant = aa * bb - ab * ab;
        let least = ROUNDING * dot(&columns[0], &columns[0]) * dot(&columns[1], &columns[1]);
        if determinant.is_nan() || determinant <= least || self.square <= 0.0 {
            return (0.0, [0.0; 2]);
        }
        let a = (bb * ar - ab * br) / determinant;
        let b = (aa * br - ab * ar) / determinant;
        ((a * ar + b * br) / self.square, [a, b])
    }

    /// What is left.
    pub fn residual(&self) -> &[f64] {
        &self.residual
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(rate: f64) -> Vec<f64> {
        (0..1000).map(|i| libm::sin(rate * f64::from(i))).collect()
    }

    #[test]
    fn a_column_explains_its_part_of_a_sum_and_not_what_the_others_have() {
        let (a, b, c) = (wave(0.1), wave(0.23), wave(0.37));
        let residual: Vec<f64> = b.iter().zip(&c).map(|(b, c)| 3.0 * b + c).collect();
        let beside = Beside::new(&[&a], &residual);
        let found = beside.explained(&b);
        assert!((found.share - 0.9).abs() < 0.01, "{found:?}");
        assert!((found.coefficient - 3.0).abs() < 0.03, "{found:?}");
        assert_eq!(beside.explained(&a).share, 0.0);
        let rest = beside.with(&b);
        assert!((rest.square / beside.square - 0.1).abs() < 0.01);
        assert!((rest.explained(&c).share - 1.0).abs() < 1e-6);
        // Hardly anything of a column that is known but for rounding.
        let twice: Vec<f64> = b.iter().map(|b| 2.0 * b).collect();
        assert_eq!(rest.explained(&twice).share, 0.0);
    }
}
