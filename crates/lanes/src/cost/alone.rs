//! One candidate: nodes in lanes, then the recursion.

use super::terms::{Terms, residual};
use crate::curve::{START, reversed};
use crate::exp::fma;
use crate::time_lanes::Block;
use crate::track::{BLOCK, KEPT, RESTART, REVERSE};
use crate::{Candidate, Track};
use stiction_dispatch::Kernel;

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
            for t in 0..BLOCK {
                let (g, q) = (block.g.0[t + 1], block.q.0[t + 1]);
                w = fma(block.keep.0[t], w, block.add.0[t]);
                let mark = marks[t];
                if mark & (RESTART | REVERSE | KEPT) == KEPT {
                    let e = residual(&terms, w + g, q, speed[t], force[t]);
                    cost = fma(e, e, cost);
                    continue;
                }
                if mark & RESTART != 0 {
                    w = -g;
                }
                if mark & KEPT != 0 {
                    let e = residual(&terms, w + g, q, speed[t], force[t]);
                    cost = fma(e, e, cost);
                }
                if mark & REVERSE != 0 {
                    w = reversed(w, g);
                }
            }
        }
        cost
    }
}
