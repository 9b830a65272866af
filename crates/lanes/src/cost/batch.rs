//! Candidates in lanes, in tiles of nodes: levels, then intervals, then the recursion, so that many
//! independent exponentials and divisions are under way at any time.

use super::terms::{Terms, residual};
use crate::curve::{Node, START, Speed, intervals, reversed};
use crate::exp::fma;
use crate::lane_array::{Aligned, lanes};
use crate::track::{HALF, KEPT, RESTART, REVERSE, TILE as T};
use crate::{Candidate, Track};
use stiction_dispatch::Kernel;

type Rows<const N: usize, const R: usize> = Aligned<[[f64; N]; R]>;

pub(super) struct Batch<'a, S, const N: usize, const POWER: bool> {
    track: &'a Track,
    terms: LaneTerms<N>,
    sink: S,
}

/// Receives the residuals of the nodes with one of some marks. Its methods must be `#[inline(always)]`.
pub(super) trait Sink<const N: usize> {
    /// The marks.
    const MARKS: u8;
    /// What is returned in the end.
    type Output;
    /// Measured minus model force of every lane, in the direction of motion, at a node.
    fn take(&mut self, node: usize, residual: &[f64; N]);
    fn end(self) -> Self::Output;
}

/// Sums of squares over the nodes that count.
pub(super) struct Squares<const N: usize>(Aligned<[f64; N]>);

impl<const N: usize> Squares<N> {
    pub fn new() -> Self {
        Squares(Aligned([0.0; N]))
    }
}

impl<const N: usize> Sink<N> for Squares<N> {
    const MARKS: u8 = KEPT;
    type Output = [f64; N];

    #[inline(always)]
    fn take(&mut self, _: usize, residual: &[f64; N]) {
        for j in 0..N {
            self.0.0[j] = fma(residual[j], residual[j], self.0.0[j]);
        }
    }

    #[inline(always)]
    fn end(self) -> [f64; N] {
        self.0.0
    }
}

/// The terms of all lanes, one array for each quantity.
#[repr(C, align(64))]
struct LaneTerms<const N: usize> {
    rate: [f64; N],
    excess: [f64; N],
    fall: [f64; N],
    exponent: [f64; N],
    ln_velocity: [f64; N],
    level: [f64; N],
    damping: [f64; N],
    speed: [f64; N],
}

impl<const N: usize> LaneTerms<N> {
    #[inline(always)]
    fn at(&self, j: usize) -> Terms {
        Terms {
            curve: crate::curve::Curve {
                rate: self.rate[j],
                excess: self.excess[j],
                fall: self.fall[j],
                exponent: self.exponent[j],
                ln_velocity: self.ln_velocity[j],
            },
            level: self.level[j],
            damping: self.damping[j],
            speed: self.speed[j],
        }
    }
}

impl<'a, S, const N: usize, const POWER: bool> Batch<'a, S, N, POWER> {
    /// Unused lanes repeat the last candidate of the group.
    pub fn new(track: &'a Track, group: &[Candidate], sink: S) -> Self {
        let all: [Terms; N] = lanes(group, Terms::new);
        let each = |f: fn(&Terms) -> f64| all.each_ref().map(f);
        Batch {
            track,
            terms: LaneTerms {
                rate: each(|t| t.curve.rate),
                excess: each(|t| t.curve.excess),
                fall: each(|t| t.curve.fall),
                exponent: each(|t| t.curve.exponent),
                ln_velocity: each(|t| t.curve.ln_velocity),
                level: each(|t| t.level),
                damping: each(|t| t.damping),
                speed: each(|t| t.speed),
            },
            sink,
        }
    }
}

impl<S: Sink<N>, const N: usize, const POWER: bool> Kernel for Batch<'_, S, N, POWER> {
    type Output = S::Output;

    #[inline(always)]
    fn run(mut self) -> S::Output {
        let (track, terms) = (self.track, &self.terms);
        let ln_speed = if POWER {
            track.ln_speed()
        } else {
            &track.speed
        };
        let mut w = Aligned([-START.g; N]);
        let mut residuals = Aligned([0.0; N]);
        let mut g: Rows<N, { T + 1 }> = Aligned([[START.g; N]; T + 1]);
        let mut q: Rows<N, { T + 1 }> = Aligned([[START.q; N]; T + 1]);
        let mut keep: Rows<N, T> = Aligned([[0.0; N]; T]);
        let mut add: Rows<N, T> = Aligned([[0.0; N]; T]);
        let tiles = track.speed.as_chunks::<T>().0.iter();
        let tiles = tiles.zip(ln_speed.as_chunks::<T>().0);
        let tiles = tiles.zip(track.half_step.as_chunks::<T>().0);
        let tiles = tiles.zip(track.force.as_chunks::<T>().0);
        let tiles = tiles.zip(track.marks.as_chunks::<T>().0);
        for (tile, ((((speed, ln), half), force), marks)) in tiles.enumerate() {
            for t in 0..HALF {
                let v = [t, t + HALF].map(|t| Speed {
                    value: speed[t],
                    ln: ln[t],
                });
                for j in 0..N {
                    let nodes = terms.at(j).curve.nodes::<POWER>(v);
                    g.0[t + 1][j] = nodes[0].g;
                    q.0[t + 1][j] = nodes[0].q;
                    g.0[t + 1 + HALF][j] = nodes[1].g;
                    q.0[t + 1 + HALF][j] = nodes[1].q;
                }
            }
            for t in 0..HALF {
                let half = [half[t], half[t + HALF]];
                for j in 0..N {
                    let node = |t: usize| Node {
                        g: g.0[t][j],
                        q: q.0[t][j],
                    };
                    let ends = [t, t + HALF].map(|t| [node(t), node(t + 1)]);
                    let both = intervals(half, ends);
                    keep.0[t][j] = both[0].keep;
                    add.0[t][j] = both[0].add;
                    keep.0[t + HALF][j] = both[1].keep;
                    add.0[t + HALF][j] = both[1].add;
                }
            }
            for t in 0..T {
                let (g, q) = (&g.0[t + 1], &q.0[t + 1]);
                for j in 0..N {
                    w.0[j] = fma(keep.0[t][j], w.0[j], add.0[t][j]);
                }
                if marks[t] & RESTART != 0 {
                    for j in 0..N {
                        w.0[j] = -g[j];
                    }
                }
                if marks[t] & S::MARKS != 0 {
                    for j in 0..N {
                        let y = w.0[j] + g[j];
                        residuals.0[j] = residual(&terms.at(j), y, q[j], speed[t], force[t]);
                    }
                    self.sink.take(T * tile + t, &residuals.0);
                }
                if marks[t] & REVERSE != 0 {
                    for j in 0..N {
                        w.0[j] = reversed(w.0[j], g[j]);
                    }
                }
            }
            g.0[0] = g.0[T];
            q.0[0] = q.0[T];
        }
        self.sink.end()
    }
}
