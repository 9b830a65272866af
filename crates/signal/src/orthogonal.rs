//! Polynomials orthogonal on the points of a symmetric window.

/// Polynomials p_0 .. p_degree in s = i/half for i = -half .. half, with leading coefficient 1 and
/// zero sum of products over the window (Gram polynomials). A least-squares fit in them needs no
/// matrix to be solved, and stays accurate where powers of i would not.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Gram {
    half: usize,
    /// `p_{k+1} = s p_k - ratios[k] p_{k-1}`.
    ratios: Vec<f64>,
    /// Values over the window, divided by the sum of squares: projections onto the polynomials.
    projections: Vec<Vec<f64>>,
}

impl Gram {
    /// Polynomials up to `degree`, less than the `2 half + 1` points of the window.
    pub(crate) fn new(half: usize, degree: usize) -> Self {
        let width = 2 * half + 1;
        let points: Vec<f64> = (0..width)
            .map(|i| abscissa(i as f64 - half as f64, half))
            .collect();
        let mut previous = vec![0.0; width];
        let mut current = vec![1.0; width];
        let mut norm = 1.0;
        let mut gram = Self {
            half,
            ratios: Vec::new(),
            projections: Vec::new(),
        };
        for k in 0..=degree {
            let square: f64 = current.iter().map(|p| p * p).sum();
            gram.ratios.push(if k == 0 { 0.0 } else { square / norm });
            gram.projections
                .push(current.iter().map(|p| p / square).collect());
            norm = square;
            let ratio = gram.ratios[k];
            let next = |i: usize| points[i] * current[i] - ratio * previous[i];
            let next: Vec<f64> = (0..width).map(next).collect();
            previous = core::mem::replace(&mut current, next);
        }
        gram
    }

    /// Coefficients of the least-squares polynomial through one window.
    pub(crate) fn fit(&self, window: &[f64]) -> Vec<f64> {
        let dot = |p: &Vec<f64>| p.iter().zip(window).map(|(p, x)| p * x).sum();
        self.projections.iter().map(dot).collect()
    }

    /// Derivatives of the given order with respect to i of p_0 .. p_degree, `offset` samples from
    /// the middle of the window.
    pub(crate) fn derivatives(&self, order: usize, offset: f64) -> Vec<f64> {
        let s = abscissa(offset, self.half);
        // Derivatives 0 to `order` of p_{k-1} and p_k with respect to s.
        let mut previous = vec![0.0; order + 1];
        let mut current = vec![0.0; order + 1];
        current[0] = 1.0;
        let mut result = Vec::with_capacity(self.ratios.len());
        for ratio in &self.ratios {
            result.push(current[order]);
            let next = |d: usize| {
                let product = if d == 0 {
                    0.0
                } else {
                    d as f64 * current[d - 1]
                };
                s * current[d] + product - ratio * previous[d]
            };
            let next: Vec<f64> = (0..=order).map(next).collect();
            previous = core::mem::replace(&mut current, next);
        }
        let scale = libm::pow(self.half.max(1) as f64, -(order as f64));
        result.into_iter().map(|value| value * scale).collect()
    }

    /// Weights of the window's samples that give the derivative of the fit at its middle.
    pub(crate) fn central_weights(&self, order: usize) -> Vec<f64> {
        let derivatives = self.derivatives(order, 0.0);
        let weight = |i: usize| {
            let terms = derivatives.iter().zip(&self.projections);
            terms
                .map(|(derivative, projection)| derivative * projection[i])
                .sum()
        };
        (0..2 * self.half + 1).map(weight).collect()
    }
}

fn abscissa(offset: f64, half: usize) -> f64 {
    offset / half.max(1) as f64
}
