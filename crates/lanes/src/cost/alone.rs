//! One candidate: nodes in lanes, then the recursion.

use super::{Terms, residual};
use crate::curve::{START, reversed};
use crate::dispatch::Kernel;
use crate::exp::fma;
use crate::time_lanes::Block;
use crate::track::{BLOCK, KEPT, RESTART, REVERSE};
use crate::{Candidate, Track};

pub(super) struct Alone<'a, const POWER: bool> {
    track: &'a Track,
    terms: Terms,
}

impl<'a, const POWER: bool> Alone<'a, POWER> {
    pub fn new(track: &'a Track, candidate: &Candidate) -> Self {
        Alone {
            track,
            terms: Terms::new(candidate),
        }
    }
}

impl<const POWER: bool> Kernel for Alone<'_, POWER> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let (track, terms) = (self.track, self.terms);
        let ln_speed = if POWER {
            track.ln_speed()
        } else {
            &track.speed
        };
        let (mut w, mut cost) = (-START.g, 0.0);
        let mut block = Block::new();
        let blocks = track.speed.as_chunks::<BLOCK>().0.iter();
        let blocks = blocks.zip(ln_speed.as_chunks::<BLOCK>().0);
        let blocks = blocks.zip(track.half_step.as_chunks::<BLOCK>().0);
        let blocks = blocks.zip(track.force.as_chunks::<BLOCK>().0);
        let blocks = blocks.zip(track.marks.as_chunks::<BLOCK>().0);
        for ((((speed, ln), half), force), marks) in blocks {
            block.fill::<POWER>(&terms.curve, speed, ln, half);
            let mut y = [0.0; BLOCK];
            for t in 0..BLOCK {
                let g = block.g.0[t + 1];
                w = fma(block.keep.0[t], w, block.add.0[t]);
                if marks[t] & RESTART != 0 {
                    w = -g;
                }
                y[t] = w + g;
                if marks[t] & REVERSE != 0 {
                    w = reversed(w, g);
                }
            }
            let mut e = [0.0; BLOCK];
            for t in 0..BLOCK {
                e[t] = residual(&terms, y[t], block.q.0[t + 1], speed[t], force[t]);
            }
            for t in 0..BLOCK {
                if marks[t] & KEPT != 0 {
                    cost = fma(e[t], e[t], cost);
                }
            }
        }
        cost
    }
}
