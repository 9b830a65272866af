//! The level of a force that is held constant, and how precisely its samples determine it.
//!
//! The identified stiffness, damping and mass are proportional to the height of the step: an error of the
//! level scales sigma0, sigma1 and the mass together, and no residual shows it.

use std::ops::Range;
use stiction_policy::procedure;
use stiction_signal::effective_sample_size;

/// Number of samples known to be at the held level, from which the extent of the level is found.
pub(super) const BLOCK: usize = 50;
/// The same for a force without noise, relative: rounding.
const ROUNDED_LEVEL: f64 = 1e-12;

/// A constant force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Mean over the samples that hold it.
    pub mean: f64,
    /// Standard error of the mean, the correlation of its samples counted.
    pub error: f64,
}

impl Level {
    /// The level of samples that are all held.
    pub(super) fn of(force: &[f64]) -> Self {
        let n = force.len() as f64;
        let mean = force.iter().sum::<f64>() / n;
        let variance = force.iter().map(|f| (f - mean) * (f - mean)).sum::<f64>() / (n - 1.0);
        let size = effective_sample_size(force, force.len() / 4).map_or(n, |e| e.size);
        Self {
            mean,
            error: (variance / size).sqrt(),
        }
    }

    /// The level that `within` holds at the block that ends at `end`: the mean over that block and all
    /// adjoining whole blocks to either side, until one differs from the level. A slow drift ends it too,
    /// after some blocks.
    pub(super) fn held(force: &[f64], within: Range<usize>, end: usize) -> Self {
        let block = BLOCK.min(end - within.start);
        let mut held = end - block..end;
        let own = Self::of(&force[held.clone()]);
        let mut sum = own.mean;
        let mut blocks = 1.0;
        let mut joins = |next: Range<usize>| {
            let mean = force[next].iter().sum::<f64>() / block as f64;
            let level = sum / blocks;
            let far = procedure::MAX_BLOCK_OFFSET * own.error * (1.0_f64 + 1.0 / blocks).sqrt();
            let joins = (mean - level).abs() <= far + ROUNDED_LEVEL * level.abs();
            if joins {
                sum += mean;
                blocks += 1.0;
            }
            joins
        };
        while held.start >= within.start + block && joins(held.start - block..held.start) {
            held.start -= block;
        }
        while held.end + block <= within.end && joins(held.end..held.end + block) {
            held.end += block;
        }
        Self::of(&force[held])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Alternating by `size` about the levels 0, 5 and 1 for 200 samples each.
    fn levels(size: f64) -> Vec<f64> {
        let level = |i: usize| [0.0, 5.0, 1.0][i / 200];
        (0..600)
            .map(|i| level(i) + if i % 2 == 0 { size } else { -size })
            .collect()
    }

    #[test]
    fn a_level_ends_where_the_force_leaves_it() {
        for size in [0.0, 0.1] {
            let force = levels(size);
            for (within, end, truth) in [
                (0..200, 200, 0.0),
                (0..400, 400, 5.0),
                // Not aligned to the blocks: a block that contains samples of another level is left out.
                (0..390, 390, 5.0),
                (200..600, 340, 5.0),
                (410..600, 520, 1.0),
            ] {
                let found = Level::held(&force, within.clone(), end);
                assert!(
                    (found.mean - truth).abs() < 1e-12,
                    "{within:?} {end} {found:?}"
                );
            }
        }
    }

    #[test]
    fn a_ramp_is_not_averaged_over() {
        let noise = |i: usize| 0.05 * libm::sin(1e4 * (i * i) as f64);
        let force: Vec<f64> = (0..2000).map(|i| 1e-3 * i as f64 + noise(i)).collect();
        let found = Level::held(&force, 0..2000, 2000);
        assert!(found.mean > 1.8, "{found:?}");
    }

    /// For n independent samples of variance 1 the standard error is `1/sqrt n`; repeating each of them
    /// four times adds no information.
    #[test]
    fn the_error_is_that_of_independent_samples() {
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            12.0_f64.sqrt() * ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
        };
        let white: Vec<f64> = (0..2000).map(|_| random()).collect();
        let error = Level::of(&white).error * 2000.0_f64.sqrt();
        assert!((0.85..1.3).contains(&error), "{error}");
        let held: Vec<f64> = white.iter().flat_map(|x| [*x; 4]).collect();
        let ratio = Level::of(&held).error / Level::of(&white).error;
        assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
    }
}
