//! One trial: samples in lanes.

use super::gram::{Columns, Gram, LANES};
use super::sums::{Sums, shared};
use crate::Track;
use crate::curve::{Curve, START, Speed, reversed};
use crate::exp::fma;
use crate::lane_array::{Aligned, chunk, read, write};
use crate::sensitive::{Interval, Node, OWN, UNKNOWNS, columns, intervals, nodes, slope_adds};
use crate::track::{BLOCK, HALF, KEPT, RESTART, REVERSE, TILE};
use stiction_dispatch::Kernel;

pub(super) struct Alone<'a, const POWER: bool> {
    track: &'a Track,
    curve: Curve,
}

impl<'a, const POWER: bool> Alone<'a, POWER> {
    pub fn new(track: &'a Track, curve: Curve) -> Self {
        Alone { track, curve }
    }
}

impl<const POWER: bool> Kernel for Alone<'_, POWER> {
    type Output = Sums;

    #[inline(always)]
    fn run(self) -> Sums {
        let track = self.track;
        let shared = shared(track);
        let mut adding = Adding {
            track,
            gram: Gram::new(shared.len()),
            shared,
            left: Aligned([[0.0; BLOCK]; OWN]),
        };
        along::<POWER>(track, &self.curve, &mut adding);
        adding.gram.sums(|lanes| lanes.iter().sum())
    }
}

/// What is done with the own columns of each block of a track.
pub(crate) trait Sink {
    /// Receives the columns of the block that starts at a node. Must be `#[inline(always)]`.
    fn block(&mut self, at: usize, own: &[[f64; BLOCK]; OWN]);
}

/// Adds up products, eight samples side by side.
struct Adding<'a> {
    track: &'a Track,
    gram: Gram,
    shared: Vec<&'a [f64]>,
    /// The columns of a block at the samples that count, 0 elsewhere.
    left: Aligned<[[f64; BLOCK]; OWN]>,
}

impl Sink for Adding<'_> {
    #[inline(always)]
    fn block(&mut self, at: usize, own: &[[f64; BLOCK]; OWN]) {
        let marks: &[u8; BLOCK] = chunk(&self.track.marks, at);
        let shared = Along {
            columns: &self.shared,
            at,
        };
        let mut all = KEPT;
        for t in 0..BLOCK {
            all &= marks[t];
        }
        if all != 0 {
            self.gram.add(&Made(own), &shared);
            return;
        }
        let mut counts = [0.0; BLOCK];
        for t in 0..BLOCK {
            counts[t] = f64::from(marks[t] & KEPT) / f64::from(KEPT);
        }
        for c in 0..OWN {
            for t in 0..BLOCK {
                self.left.0[c][t] = own[c][t] * counts[t];
            }
        }
        self.gram.add(&Made(&self.left.0), &shared);
    }
}

/// The own columns of a block, eight samples at a place.
struct Made<'a>(&'a [[f64; BLOCK]; OWN]);

impl Columns for Made<'_> {
    #[inline(always)]
    fn places(&self) -> usize {
        BLOCK / LANES
    }

    #[inline(always)]
    fn at(&self, place: usize, column: usize) -> [f64; LANES] {
        *chunk(&self.0[column], LANES * place)
    }
}

/// Shared columns from a node on, eight samples at a place.
struct Along<'a> {
    columns: &'a [&'a [f64]],
    at: usize,
}

impl Columns for Along<'_> {
    #[inline(always)]
    fn places(&self) -> usize {
        BLOCK / LANES
    }

    #[inline(always)]
    fn at(&self, place: usize, column: usize) -> [f64; LANES] {
        *chunk(self.columns[column], self.at + LANES * place)
    }
}

/// Runs a trial along the track.
#[inline(always)]
pub(crate) fn along<const POWER: bool>(track: &Track, curve: &Curve, sink: &mut impl Sink) {
    let ln_speed = if POWER {
        track.ln_speed()
    } else {
        &track.speed
    };
    let mut w = -START.g;
    let mut w_slope = [0.0; UNKNOWNS];
    let mut node_rows = Aligned(Node::START.map(|x| [x; BLOCK + 1]));
    let mut interval_rows = Aligned([[0.0; BLOCK]; 8]);
    let mut before = Aligned([0.0; BLOCK]);
    let mut now = Aligned([0.0; BLOCK]);
    let mut slopes = Aligned([[0.0; BLOCK]; UNKNOWNS]);
    let mut made = Aligned([[0.0; BLOCK]; OWN]);
    for at in (0..track.speed.len()).step_by(BLOCK) {
        let speed: &[f64; BLOCK] = chunk(&track.speed, at);
        let marks: &[u8; BLOCK] = chunk(&track.marks, at);
        for row in &mut node_rows.0 {
            row[0] = row[BLOCK];
        }
        for tile in (0..BLOCK).step_by(TILE) {
            let found = node_tile::<POWER>(curve, chunk(speed, tile), chunk(ln_speed, at + tile));
            for (row, found) in node_rows.0.iter_mut().zip(&found) {
                row[tile + 1..tile + 1 + TILE].copy_from_slice(found);
            }
        }
        for tile in (0..BLOCK).step_by(TILE) {
            let ends = [tile, tile + 1].map(|from| row_chunks(&node_rows.0, from));
            let found = interval_tile(curve, chunk(&track.half_step, at + tile), &ends);
            for (row, found) in interval_rows.0.iter_mut().zip(&found) {
                row[tile..tile + TILE].copy_from_slice(found);
            }
        }
        // The recursion for the deviation first: it needs nothing else.
        let [keep, add, ..] = &interval_rows.0;
        let g = &node_rows.0[0];
        let mut turns = 0;
        for t in 0..BLOCK {
            turns |= marks[t] & (RESTART | REVERSE);
        }
        for t in 0..BLOCK {
            before.0[t] = w;
            w = fma(keep[t], w, add[t]);
            // Most blocks have no such node, and the branch alone costs as much as the step.
            if turns == 0 {
                now.0[t] = w;
                continue;
            }
            if marks[t] & RESTART != 0 {
                w = -g[t + 1];
            }
            now.0[t] = w;
            if marks[t] & REVERSE != 0 {
                w = reversed(w, g[t + 1]);
            }
        }
        for t in 0..BLOCK {
            let step = Interval::from_array(read(&interval_rows.0, t));
            write(&mut slopes.0, t, slope_adds(before.0[t], &step));
        }
        let [_, _, excess_slope, velocity_slope, ..] = &node_rows.0;
        for t in 0..BLOCK {
            for k in 0..UNKNOWNS {
                w_slope[k] = fma(keep[t], w_slope[k], slopes.0[k][t]);
            }
            if turns == 0 || marks[t] & (RESTART | REVERSE) == 0 {
                write(&mut slopes.0, t, w_slope);
                continue;
            }
            let level = [0.0, excess_slope[t + 1], velocity_slope[t + 1]];
            if marks[t] & RESTART != 0 {
                w_slope = [0.0, -level[1], -level[2]];
            }
            write(&mut slopes.0, t, w_slope);
            if marks[t] & REVERSE != 0 {
                for k in 0..UNKNOWNS {
                    w_slope[k] = reversed(w_slope[k], level[k]);
                }
            }
        }
        for t in 0..BLOCK {
            let node = Node::from_array(read(&node_rows.0, t + 1));
            let own = columns(&node, speed[t], now.0[t], read(&slopes.0, t));
            write(&mut made.0, t, own);
        }
        sink.block(at, &made.0);
    }
}

#[inline(always)]
fn node_tile<const POWER: bool>(
    curve: &Curve,
    speed: &[f64; TILE],
    ln: &[f64; TILE],
) -> [[f64; TILE]; 6] {
    let mut rows = [[0.0; TILE]; 6];
    for t in 0..HALF {
        let v = |t: usize| Speed {
            value: speed[t],
            ln: ln[t],
        };
        let [first, second] = nodes::<POWER>(curve, [v(t), v(t + HALF)]);
        write(&mut rows, t, first.to_array());
        write(&mut rows, t + HALF, second.to_array());
    }
    rows
}

/// A tile of each row, from a node on.
#[inline(always)]
pub(crate) fn row_chunks(rows: &[[f64; BLOCK + 1]; 6], from: usize) -> [&[f64; TILE]; 6] {
    rows.each_ref().map(|row| chunk(row, from))
}

#[inline(always)]
pub(crate) fn interval_tile(
    curve: &Curve,
    half_step: &[f64; TILE],
    ends: &[[&[f64; TILE]; 6]; 2],
) -> [[f64; TILE]; 8] {
    let mut rows = [[0.0; TILE]; 8];
    for t in 0..HALF {
        let half = [half_step[t], half_step[t + HALF]];
        let node = |end: usize, t: usize| Node::from_array(ends[end].map(|row| row[t]));
        let ends = [
            [node(0, t), node(1, t)],
            [node(0, t + HALF), node(1, t + HALF)],
        ];
        let [first, second] = intervals(curve, half, ends);
        write(&mut rows, t, first.to_array());
        write(&mut rows, t + HALF, second.to_array());
    }
    rows
}
