//! Trials in lanes.

use super::gram::{Columns, Gram, LANES};
use super::sums::{Sums, shared};
use crate::Track;
use crate::curve::{Curve, START, Speed, reversed};
use crate::exp::fma;
use crate::lane_array::{Aligned, lanes, read, write};
use crate::sensitive::{Interval, Node, OWN, UNKNOWNS, columns, intervals, nodes, slope_adds};
use crate::track::{HALF, KEPT, RESTART, REVERSE, TILE};
use stiction_dispatch::Kernel;

pub(super) struct Batch<'a, const POWER: bool> {
    track: &'a Track,
    curves: Curves,
    used: usize,
}

/// The curves of all lanes, one array for each quantity.
#[repr(C, align(64))]
pub(super) struct Curves {
    rate: [f64; LANES],
    excess: [f64; LANES],
    fall: [f64; LANES],
    exponent: [f64; LANES],
    ln_velocity: [f64; LANES],
}

impl Curves {
    /// Unused lanes repeat the last curve of the group.
    pub fn new(group: &[Curve]) -> Self {
        let all: [Curve; LANES] = lanes(group, |c| *c);
        let each = |f: fn(&Curve) -> f64| all.each_ref().map(f);
        Curves {
            rate: each(|c| c.rate),
            excess: each(|c| c.excess),
            fall: each(|c| c.fall),
            exponent: each(|c| c.exponent),
            ln_velocity: each(|c| c.ln_velocity),
        }
    }

    #[inline(always)]
    pub fn at(&self, j: usize) -> Curve {
        Curve {
            rate: self.rate[j],
            excess: self.excess[j],
            fall: self.fall[j],
            exponent: self.exponent[j],
            ln_velocity: self.ln_velocity[j],
        }
    }
}

impl<'a, const POWER: bool> Batch<'a, POWER> {
    pub fn new(track: &'a Track, group: &[Curve]) -> Self {
        Batch {
            track,
            curves: Curves::new(group),
            used: group.len(),
        }
    }
}

/// The own columns at a node, for each lane.
type Row = Aligned<[[f64; LANES]; OWN]>;

/// The own columns at the nodes that count.
struct Made<'a>(&'a [Row]);

impl Columns for Made<'_> {
    #[inline(always)]
    fn places(&self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn at(&self, place: usize, column: usize) -> [f64; LANES] {
        self.0[place].0[column]
    }
}

/// Shared columns at the nodes that count, the same in every lane.
struct Broadcast<'a> {
    columns: &'a [&'a [f64]],
    nodes: &'a [usize],
}

impl Columns for Broadcast<'_> {
    #[inline(always)]
    fn places(&self) -> usize {
        self.nodes.len()
    }

    #[inline(always)]
    fn at(&self, place: usize, column: usize) -> [f64; LANES] {
        [self.columns[column][self.nodes[place]]; LANES]
    }
}

/// Numbers of each node or interval of a tile, for each lane.
type Rows<const F: usize, const R: usize> = Aligned<[[[f64; LANES]; F]; R]>;

impl<const POWER: bool> Kernel for Batch<'_, POWER> {
    type Output = Vec<Sums>;

    #[inline(always)]
    fn run(self) -> Vec<Sums> {
        let (track, curves) = (self.track, &self.curves);
        let ln_speed = if POWER {
            track.ln_speed()
        } else {
            &track.speed
        };
        let shared = shared(track);
        let mut gram = Gram::new(shared.len());
        let mut w = Aligned([-START.g; LANES]);
        let mut w_slope = Aligned([[0.0; LANES]; UNKNOWNS]);
        let start = Node::START.map(|x| [x; LANES]);
        let mut node_rows: Rows<6, { TILE + 1 }> = Aligned([start; TILE + 1]);
        let mut interval_rows: Rows<8, TILE> = Aligned([[[0.0; LANES]; 8]; TILE]);
        let mut own: [Row; TILE] = [Aligned([[0.0; LANES]; OWN]); TILE];
        for at in (0..track.speed.len()).step_by(TILE) {
            for t in 0..HALF {
                let speed = |t: usize| Speed {
                    value: track.speed[at + t],
                    ln: ln_speed[at + t],
                };
                let v = [speed(t), speed(t + HALF)];
                for j in 0..LANES {
                    let [first, second] = nodes::<POWER>(&curves.at(j), v);
                    write(&mut node_rows.0[t + 1], j, first.to_array());
                    write(&mut node_rows.0[t + 1 + HALF], j, second.to_array());
                }
            }
            for t in 0..HALF {
                let half = [track.half_step[at + t], track.half_step[at + t + HALF]];
                for j in 0..LANES {
                    let node = |t: usize| Node::from_array(read(&node_rows.0[t], j));
                    let ends = [[node(t), node(t + 1)], [node(t + HALF), node(t + 1 + HALF)]];
                    let [first, second] = intervals(&curves.at(j), half, ends);
                    write(&mut interval_rows.0[t], j, first.to_array());
                    write(&mut interval_rows.0[t + HALF], j, second.to_array());
                }
            }
            let mut kept = [0; TILE];
            let mut count = 0;
            for t in 0..TILE {
                let marks = track.marks[at + t];
                let nodes = &node_rows.0[t + 1];
                for j in 0..LANES {
                    let step = Interval::from_array(read(&interval_rows.0[t], j));
                    let adds = slope_adds(w.0[j], &step);
                    for k in 0..UNKNOWNS {
                        w_slope.0[k][j] = fma(step.keep, w_slope.0[k][j], adds[k]);
                    }
                    w.0[j] = fma(step.keep, w.0[j], step.add);
                }
                if marks & RESTART != 0 {
                    for j in 0..LANES {
                        let node = Node::from_array(read(nodes, j));
                        w.0[j] = -node.g;
                        write(&mut w_slope.0, j, [0.0, -node.slope[0], -node.slope[1]]);
                    }
                }
                if marks & KEPT != 0 {
                    let speed = track.speed[at + t];
                    for j in 0..LANES {
                        let node = Node::from_array(read(nodes, j));
                        let made = columns(&node, speed, w.0[j], read(&w_slope.0, j));
                        write(&mut own[count].0, j, made);
                    }
                    kept[count] = at + t;
                    count += 1;
                }
                if marks & REVERSE != 0 {
                    for j in 0..LANES {
                        let node = Node::from_array(read(nodes, j));
                        w.0[j] = reversed(w.0[j], node.g);
                        let [a, b, c] = read(&w_slope.0, j);
                        let turned = [-a, reversed(b, node.slope[0]), reversed(c, node.slope[1])];
                        write(&mut w_slope.0, j, turned);
                    }
                }
            }
            let shared = Broadcast {
                columns: &shared,
                nodes: &kept[..count],
            };
            gram.add(&Made(&own[..count]), &shared);
            node_rows.0[0] = node_rows.0[TILE];
        }
        (0..self.used)
            .map(|j| gram.sums(|lanes| lanes[j]))
            .collect()
    }
}
