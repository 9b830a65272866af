//! Crossover of two parents, gene by gene.

use crate::random::Dice;
use serde::{Deserialize, Serialize};

/// How two parents make two children.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Crossover {
    /// Between the parents: `r a + (1 - r) b` and `(1 - r) a + r b`; Z25 eq. (18).
    Blend,
    /// Beyond the fitter parent `a`, away from the other: `a + r (a - b)`, and the blend with the
    /// same ratio; what leaves the box stops at its bound. Z25 eq. (19).
    Heuristic,
}

/// The ratio `r`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Ratio {
    /// The same for every gene, 0 to 1.
    Constant(f64),
    /// Drawn from U(0, 1) for each gene.
    Uniform,
}

/// Two children of the fitter parent `a` and of `b`, inside `low..high`.
pub(crate) fn cross(
    kind: Crossover,
    ratio: Ratio,
    [a, b]: [&[f64]; 2],
    [low, high]: [&[f64]; 2],
    dice: &mut Dice,
) -> [Vec<f64>; 2] {
    let mut children = [a.to_vec(), b.to_vec()];
    for j in 0..a.len() {
        let r = match ratio {
            Ratio::Constant(r) => r,
            Ratio::Uniform => dice.unit(),
        };
        let between = |r: f64| {
            let x = b[j] + r * (a[j] - b[j]);
            x.clamp(a[j].min(b[j]), a[j].max(b[j]))
        };
        children[0][j] = match kind {
            Crossover::Blend => between(r),
            Crossover::Heuristic => (a[j] + r * (a[j] - b[j])).clamp(low[j], high[j]),
        };
        children[1][j] = between(1.0 - r);
    }
    children
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_blend_lies_between_its_parents(
            genes in prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64), 1..8), seed: u64
        ) {
            let (a, b): (Vec<f64>, Vec<f64>) = genes.into_iter().unzip();
            let (low, high) = (vec![0.0; a.len()], vec![1.0; a.len()]);
            let mut dice = Dice::new(seed);
            let [c, d] = cross(Crossover::Blend, Ratio::Uniform, [&a, &b], [&low, &high], &mut dice);
            for j in 0..a.len() {
                for x in [c[j], d[j]] {
                    prop_assert!(x >= a[j].min(b[j]) && x <= a[j].max(b[j]));
                }
                prop_assert!((c[j] + d[j] - a[j] - b[j]).abs() < 1e-15);
            }
        }
    }

    /// Moments of U(0, 1): the child of parents 0 and 1 is the ratio itself.
    #[test]
    fn uniform_ratios() {
        let mut dice = Dice::new(1);
        let (n, mut sum, mut squares) = (20_000, 0.0, 0.0);
        for _ in 0..n {
            let bounds: [&[f64]; 2] = [&[0.0], &[1.0]];
            let [c, _] = cross(
                Crossover::Blend,
                Ratio::Uniform,
                [&[1.0], &[0.0]],
                bounds,
                &mut dice,
            );
            sum += c[0];
            squares += c[0] * c[0];
        }
        let mean = sum / f64::from(n);
        let variance = squares / f64::from(n) - mean * mean;
        // Three deviations of each.
        assert!((mean - 0.5).abs() < 3.0 * (1.0 / 12.0 / f64::from(n)).sqrt());
        assert!((variance - 1.0 / 12.0).abs() < 3.0 * (1.0 / 180.0 / f64::from(n)).sqrt());
    }

    #[test]
    fn heuristic_goes_beyond_the_fitter_and_stops_at_the_bound() {
        let mut dice = Dice::new(1);
        let (low, high) = ([0.0, 0.0], [1.0, 1.0]);
        let parents: [&[f64]; 2] = [&[0.5, 0.9], &[0.25, 0.5]];
        let half = Ratio::Constant(0.5);
        let [c, d] = cross(
            Crossover::Heuristic,
            half,
            parents,
            [&low, &high],
            &mut dice,
        );
        assert_eq!(c, [0.625, 1.0]);
        assert_eq!(d, [0.375, 0.7]);
    }
}
