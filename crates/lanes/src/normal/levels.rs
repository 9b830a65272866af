//! Trials in lanes without their derivatives.

use super::batch::Curves;
use super::gram::LANES;
use super::sums::{Sums, shared};
use crate::Track;
use crate::curve::{Curve, Node, START, Speed, intervals, reversed};
use crate::exp::fma;
use crate::lane_array::Aligned;
use crate::track::{HALF, KEPT, RESTART, REVERSE, TILE};
use stiction_dispatch::Kernel;

pub(super) struct Levels<'a, const POWER: bool> {
    track: &'a Track,
    curves: Curves,
    used: usize,
}

impl<'a, const POWER: bool> Levels<'a, POWER> {
    pub fn new(track: &'a Track, group: &[Curve]) -> Self {
        Levels {
            track,
            curves: Curves::new(group),
            used: group.len(),
        }
    }
}

type Lanes = [f64; LANES];
type Rows<const R: usize> = Aligned<[Lanes; R]>;

impl<const POWER: bool> Kernel for Levels<'_, POWER> {
    type Output = Vec<Sums<2>>;

    #[inline(always)]
    fn run(self) -> Vec<Sums<2>> {
        let (track, curves) = (self.track, &self.curves);
        let ln_speed = if POWER {
            track.ln_speed()
        } else {
            &track.speed
        };
        let shared = shared(track);
        let mut own_sums = Aligned([[0.0; LANES]; 3]);
        let mut shared_sums = vec![Aligned([[0.0; LANES]; 2]); shared.len()];
        let mut w = Aligned([-START.g; LANES]);
        let mut g: Rows<{ TILE + 1 }> = Aligned([[START.g; LANES]; TILE + 1]);
        let mut q: Rows<{ TILE + 1 }> = Aligned([[START.q; LANES]; TILE + 1]);
        let mut keep: Rows<TILE> = Aligned([[0.0; LANES]; TILE]);
        let mut add: Rows<TILE> = Aligned([[0.0; LANES]; TILE]);
        let mut eta: Rows<TILE> = Aligned([[0.0; LANES]; TILE]);
        let mut rate: Rows<TILE> = Aligned([[0.0; LANES]; TILE]);
        // `q` is `-kappa v/g`.
        let mut length = Aligned([0.0; LANES]);
        for j in 0..LANES {
            length.0[j] = 1.0 / curves.at(j).rate;
        }
        for at in (0..track.speed.len()).step_by(TILE) {
            for t in 0..HALF {
                let v = |t: usize| Speed {
                    value: track.speed[at + t],
                    ln: ln_speed[at + t],
                };
                let v = [v(t), v(t + HALF)];
                for j in 0..LANES {
                    let nodes = curves.at(j).nodes::<POWER>(v);
                    g.0[t + 1][j] = nodes[0].g;
                    q.0[t + 1][j] = nodes[0].q;
                    g.0[t + 1 + HALF][j] = nodes[1].g;
                    q.0[t + 1 + HALF][j] = nodes[1].q;
                }
            }
            for t in 0..HALF {
                let half = [track.half_step[at + t], track.half_step[at + t + HALF]];
                for j in 0..LANES {
                    let node = |t: usize| Node {
                        g: g.0[t][j],
                        q: q.0[t][j],
                    };
                    let ends = [[node(t), node(t + 1)], [node(t + HALF), node(t + 1 + HALF)]];
                    let both = intervals(half, ends);
                    keep.0[t][j] = both[0].keep;
                    add.0[t][j] = both[0].add;
                    keep.0[t + HALF][j] = both[1].keep;
                    add.0[t + HALF][j] = both[1].add;
                }
            }
            let mut kept = [0; TILE];
            let mut count = 0;
            for t in 0..TILE {
                let marks = track.marks[at + t];
                let (g, q) = (&g.0[t + 1], &q.0[t + 1]);
                for j in 0..LANES {
                    w.0[j] = fma(keep.0[t][j], w.0[j], add.0[t][j]);
                }
                if marks & RESTART != 0 {
                    for j in 0..LANES {
                        w.0[j] = -g[j];
                    }
                }
                if marks & KEPT != 0 {
                    let speed = track.speed[at + t];
                    for j in 0..LANES {
                        eta.0[count][j] = w.0[j] + g[j];
                        rate.0[count][j] = fma(-(length.0[j] * q[j]), w.0[j] + g[j], speed);
                    }
                    kept[count] = at + t;
                    count += 1;
                }
                if marks & REVERSE != 0 {
                    for j in 0..LANES {
                        w.0[j] = reversed(w.0[j], g[j]);
                    }
                }
            }
            let (eta, rate) = (&eta.0[..count], &rate.0[..count]);
            add_own(&mut own_sums.0, eta, rate);
            for (sums, column) in shared_sums.iter_mut().zip(&shared) {
                add_shared(&mut sums.0, column, &kept[..count], eta, rate);
            }
            g.0[0] = g.0[TILE];
            q.0[0] = q.0[TILE];
        }
        let of = |j: usize| {
            let [eta, mixed, rate] = own_sums.0.map(|sums| sums[j]);
            Sums {
                own: [[eta, mixed], [mixed, rate]],
                shared: shared_sums
                    .iter()
                    .map(|sums| sums.0.map(|sums| sums[j]))
                    .collect(),
            }
        };
        (0..self.used).map(of).collect()
    }
}

#[inline(always)]
fn add_own(sums: &mut [Lanes; 3], eta: &[Lanes], rate: &[Lanes]) {
    let mut local = *sums;
    for (eta, rate) in eta.iter().zip(rate) {
        for j in 0..LANES {
            local[0][j] = fma(eta[j], eta[j], local[0][j]);
            local[1][j] = fma(eta[j], rate[j], local[1][j]);
            local[2][j] = fma(rate[j], rate[j], local[2][j]);
        }
    }
    *sums = local;
}

#[inline(always)]
fn add_shared(
    sums: &mut [Lanes; 2],
    column: &[f64],
    kept: &[usize],
    eta: &[Lanes],
    rate: &[Lanes],
) {
    let mut local = *sums;
    for ((&at, eta), rate) in kept.iter().zip(eta).zip(rate) {
        let value = column[at];
        for j in 0..LANES {
            local[0][j] = fma(value, eta[j], local[0][j]);
            local[1][j] = fma(value, rate[j], local[1][j]);
        }
    }
    *sums = local;
}
