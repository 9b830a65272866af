//! One candidate: what its nodes and intervals contribute, with the nodes in lanes.

use crate::curve::{Curve, Node, START, Speed, intervals};
use crate::lane_array::{Aligned, chunk};
use crate::track::{BLOCK, HALF, TILE};

/// Levels and weights along a block of nodes; `g[0]` and `q[0]` belong to the node before it.
pub(crate) struct Block {
    pub g: Aligned<[f64; BLOCK + 1]>,
    pub q: Aligned<[f64; BLOCK + 1]>,
    pub keep: Aligned<[f64; BLOCK]>,
    pub add: Aligned<[f64; BLOCK]>,
}

impl Block {
    #[inline(always)]
    pub fn new() -> Self {
        Block {
            g: Aligned([START.g; BLOCK + 1]),
            q: Aligned([START.q; BLOCK + 1]),
            keep: Aligned([0.0; BLOCK]),
            add: Aligned([0.0; BLOCK]),
        }
    }

    /// Moves on to the next block of the track.
    #[inline(always)]
    pub fn fill<const POWER: bool>(
        &mut self,
        curve: &Curve,
        speed: &[f64; BLOCK],
        ln: &[f64; BLOCK],
        half_step: &[f64; BLOCK],
    ) {
        self.g.0[0] = self.g.0[BLOCK];
        self.q.0[0] = self.q.0[BLOCK];
        for at in (0..BLOCK).step_by(TILE) {
            let (g, q) = levels::<POWER>(curve, chunk(speed, at), chunk(ln, at));
            self.g.0[at + 1..at + 1 + TILE].copy_from_slice(&g);
            self.q.0[at + 1..at + 1 + TILE].copy_from_slice(&q);
        }
        for at in (0..BLOCK).step_by(TILE) {
            let (g, q) = (&self.g.0, &self.q.0);
            let (keep, add) = weights(
                chunk(half_step, at),
                [chunk(g, at), chunk(g, at + 1)],
                [chunk(q, at), chunk(q, at + 1)],
            );
            self.keep.0[at..at + TILE].copy_from_slice(&keep);
            self.add.0[at..at + TILE].copy_from_slice(&add);
        }
    }
}

#[inline(always)]
fn levels<const POWER: bool>(
    curve: &Curve,
    speed: &[f64; TILE],
    ln: &[f64; TILE],
) -> ([f64; TILE], [f64; TILE]) {
    let (mut g, mut q) = ([0.0; TILE], [0.0; TILE]);
    for t in 0..HALF {
        let v = |t: usize| Speed {
            value: speed[t],
            ln: ln[t],
        };
        let nodes = curve.nodes::<POWER>([v(t), v(t + HALF)]);
        g[t] = nodes[0].g;
        q[t] = nodes[0].q;
        g[t + HALF] = nodes[1].g;
        q[t + HALF] = nodes[1].q;
    }
    (g, q)
}

#[inline(always)]
pub(crate) fn weights(
    half_step: &[f64; TILE],
    g: [&[f64; TILE]; 2],
    q: [&[f64; TILE]; 2],
) -> ([f64; TILE], [f64; TILE]) {
    let (mut keep, mut add) = ([0.0; TILE], [0.0; TILE]);
    for t in 0..HALF {
        let node = |end: usize, t: usize| Node {
            g: g[end][t],
            q: q[end][t],
        };
        let ends = |t: usize| [node(0, t), node(1, t)];
        let both = intervals(
            [half_step[t], half_step[t + HALF]],
            [ends(t), ends(t + HALF)],
        );
        keep[t] = both[0].keep;
        add[t] = both[0].add;
        keep[t + HALF] = both[1].keep;
        add[t + HALF] = both[1].add;
    }
    (keep, add)
}
