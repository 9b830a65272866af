//! How surely the top of the likelihood is known.
//!
//! The information assumes that the filter describes every error. The jackknife does not: it leaves out each block of the
//! samples in turn and sees how far the top moves (Tukey 1958; delete-a-group form of clustered errors, "CR3": Bell and
//! McCaffrey 2002, Survey Methodology 28(2)). To first order no block is fitted again: with the score `s_b` and the
//! information `I_b` of a block, the top moves by `(I - I_b)^-1 s_b`.
//!
//! Where blocks move the top farther than the information says, there are errors that the filter does not describe, such as what
//! cleaning leaves of the noise of the force. What they have in common in all blocks no jackknife sees.

use crate::state_space::climb::{Top, part};
use crate::state_space::unknowns::{DISTURBANCE, MEMORY, WHITE};
use nalgebra::{DMatrix, DVector};

/// What all blocks have in common of the errors that the filter does not describe, in parts of what they have apart. Chosen on
/// simulated axes, seeds 1 to 40 of a ball screw and a joint, and held against others (decision 0060).
const COMMON: f64 = 0.4;

/// Two covariances of the free unknowns.
pub(super) struct Sureness {
    /// Inverse of the information.
    pub stated: DMatrix<f64>,
    /// From the jackknife.
    pub seen: DMatrix<f64>,
    /// Factor of the deviations of `seen` for what all blocks have in common, at least 1.
    pub wider: f64,
    /// How far the top moves without each block, from their mean.
    moves: Vec<DVector<f64>>,
}

impl Sureness {
    /// Degrees of freedom of the variance that the jackknife gives a sum of the unknowns with these weights: few where few
    /// blocks determine it (Johnson and Rust 1992; the constant for few blocks as in NAEP).
    pub fn freedom(&self, weights: &DVector<f64>) -> f64 {
        let many = self.moves.len() as f64;
        let squares = self.moves.iter().map(|m| m.dot(weights) * m.dot(weights));
        let squares: Vec<f64> = squares.collect();
        let sum: f64 = squares.iter().sum();
        let fourth: f64 = squares.iter().map(|s| s * s).sum();
        (3.16 - 2.77 / many.sqrt()) * sum * sum / fourth
    }
}

/// Both covariances at a top; `None` where the samples do not determine the unknowns.
pub(super) fn sureness(top: &Top, free: &[usize]) -> Option<Sureness> {
    let whole = part(&top.whole, free);
    let q = free.len();
    let scale: Vec<f64> = (0..q).map(|i| 1.0 / whole[(i, i)].sqrt()).collect();
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(q, q, |i, j| m[(i, j)] * scale[i] * scale[j]);
    let back = |m: DMatrix<f64>| DMatrix::from_fn(q, q, |i, j| m[(i, j)] * scale[i] * scale[j]);
    let full = scaled(&whole);
    let stated = full.clone().cholesky()?.inverse();
    let mut moves = Vec::new();
    for block in top.blocks.iter().filter(|b| b.samples > 0) {
        let rest = &full - scaled(&part(block, free));
        let score = DVector::from_fn(q, |i, _| block.score.0[free[i]] * scale[i]);
        moves.push(rest.cholesky()?.solve(&score));
    }
    let many = moves.len() as f64;
    let mean = moves.iter().fold(DVector::zeros(q), |sum, m| sum + m) / many;
    for m in &mut moves {
        *m -= &mean;
    }
    let mut seen = DMatrix::zeros(q, q);
    for m in &moves {
        seen += m * m.transpose();
    }
    for m in &mut moves {
        m.component_mul_assign(&DVector::from_column_slice(&scale));
    }
    seen *= (many - 1.0) / many;
    let of_the_law = (0..q).filter(|i| ![WHITE, DISTURBANCE, MEMORY].contains(&free[*i]));
    let effects: Vec<f64> = of_the_law.map(|i| seen[(i, i)] / stated[(i, i)]).collect();
    let effect = effects.iter().sum::<f64>() / effects.len() as f64;
    Some(Sureness {
        stated: back(stated),
        seen: back(seen),
        wider: wider(effect, many),
        moves,
    })
}

/// The factor of deviations that errors within blocks give, whose variance is `effect` times the stated one. The part of it that
/// is not stated is that of errors which blocks share: with an intraclass correlation the variance of a mean does not fall with
/// their number (design effect: Kish 1965, Survey Sampling, chapter 5; Moulton 1990).
fn wider(effect: f64, blocks: f64) -> f64 {
    let not_stated = 1.0 - 1.0 / effect.max(1.0);
    (1.0 + COMMON * blocks * not_stated).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state_space::filter::Sums;
    use crate::state_space::unknowns::UNKNOWNS;

    #[test]
    fn what_blocks_share_widens_only_what_is_not_described() {
        assert_eq!(wider(0.7, 20.0), 1.0);
        assert_eq!(wider(1.0, 20.0), 1.0);
        // Half of the variance is not stated: with 20 blocks 4 times as much again is not seen.
        assert!((wider(2.0, 20.0) - 5.0_f64.sqrt()).abs() < 1e-12);
        assert!(wider(1e9, 20.0) < 3.01);
    }

    /// One unknown whose blocks know equally much: the mean of numbers, whose jackknife is the variance of a mean.
    #[test]
    fn the_jackknife_of_a_mean_is_its_variance() {
        let numbers = [0.3, -1.2, 0.7, 2.0, -1.8];
        let block = |x: &f64| {
            let mut sums = Sums::NONE;
            sums.score.0[0] = *x;
            sums.information[0].0[0] = 1.0;
            sums.samples = 1;
            sums
        };
        let blocks: Vec<Sums> = numbers.iter().map(block).collect();
        let whole = blocks.iter().fold(Sums::NONE, Sums::and);
        let top = Top {
            at: [0.0; UNKNOWNS],
            blocks,
            whole,
            converged: true,
            evaluations: 0,
        };
        let found = sureness(&top, &[0]).unwrap();
        let squares: f64 = numbers.iter().map(|x| x * x).sum();
        assert!((found.stated[(0, 0)] - 0.2).abs() < 1e-12);
        assert!((found.seen[(0, 0)] - squares / (5.0 * 4.0)).abs() < 1e-12);
        // Five alike have about five, one alone hardly more than one.
        let freedom = found.freedom(&DVector::from_element(1, 1.0));
        assert!(freedom > 3.0 && freedom < 8.0, "{freedom}");
        assert!(sureness(&top, &[1]).is_none());
    }
}
