//! The law with a steady level for each direction of motion, samples in lanes.
//!
//! Between reversals it is the law of [`curve`](crate::curve) with the level of that direction, in units of the Coulomb
//! level of the positive one. Only where the motion turns do the two meet: the deflection is kept, and what it deviates
//! from is then the level of the other direction.

use crate::curve::{self, Curve, SUBNORMAL_GUARD, Speed};
use crate::exp::{at_least, exp, fma};
use crate::lane_array::{Aligned, chunk, read, write};
use crate::normal::alone::{interval_tile, row_chunks};
use crate::sensitive::{Interval, LOWEST_STRIBECK_EXPONENT, Node, intervals, slope_adds};
use crate::time_lanes::weights;
use crate::trace::append;
use crate::track::{BLOCK, HALF, RESTART, REVERSE, TILE};
use crate::{Error, Track};
use stiction_dispatch::{InstructionSet, Kernel};
use stiction_friction::ParamError;

/// Nonlinear unknowns of a law with parameters for each direction, as logarithms.
///
/// ```text
/// eta' = kappa (v - |v| eta/g(v)),     g(v) = 1 + (r+ - 1) exp(-|v/vs+|^delta)            for v > 0
///                                      g(v) = rho (1 + (r- - 1) exp(-|v/vs-|^delta))      for v < 0
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directed {
    /// `ln kappa` with `kappa = sigma0/Fc` in 1/m (1/rad), Fc of the positive direction.
    pub ln_kappa: f64,
    /// `ln rho`, the Coulomb level of the negative direction over that of the positive one.
    pub ln_ratio: f64,
    /// `ln(r - 1)` with `r = Fs/Fc`, positive direction first.
    pub ln_excess: [f64; 2],
    /// `ln vs`, vs in m/s (rad/s), positive direction first.
    pub ln_velocity: [f64; 2],
    /// delta > 0 of both directions: given, not estimated.
    pub exponent: f64,
}

/// Unknowns of [`Directed`], in the order of [`directed_slopes`].
pub const DIRECTED: usize = 6;
const KAPPA: usize = 0;
const EXCESS: [usize; 2] = [1, 3];
const VELOCITY: [usize; 2] = [2, 4];
const RATIO: usize = 5;

/// Largest magnitude of a logarithm: products of levels stay finite.
const LARGEST_LOGARITHM: f64 = 230.0;
/// The same of the ratio of the levels, which multiplies them.
const LARGEST_RATIO_LOGARITHM: f64 = 60.0;

impl Directed {
    fn law(&self) -> Result<Law, ParamError> {
        let read = |name, ln: f64, most: f64, allowed| {
            if ln.abs() <= most {
                return Ok(libm::exp(ln));
            }
            Err(ParamError::new(name, ln, allowed))
        };
        let number = |name, ln| read(name, ln, LARGEST_LOGARITHM, "a magnitude of at most 230");
        ParamError::positive("exponent", self.exponent)?;
        let ratio = read(
            "ln_ratio",
            self.ln_ratio,
            LARGEST_RATIO_LOGARITHM,
            "a magnitude of at most 60",
        )?;
        let kappa = number("ln_kappa", self.ln_kappa)?;
        let side = |side: usize, level: f64| -> Result<Curve, ParamError> {
            let excess = level * number("ln_excess", self.ln_excess[side])?;
            let velocity = number("ln_velocity", self.ln_velocity[side])?;
            Ok(Curve::new(kappa, excess, velocity, self.exponent))
        };
        Ok(Law {
            levels: [1.0, ratio],
            curves: [side(0, 1.0)?, side(1, ratio)?],
        })
    }
}

/// Coulomb level and Stribeck curve of each direction; the excess is that over the level.
#[derive(Clone, Copy)]
struct Law {
    levels: [f64; 2],
    curves: [Curve; 2],
}

/// The second where `minus` is 1, the first where it is 0.
#[inline(always)]
fn select(minus: f64, [plus, other]: [f64; 2]) -> f64 {
    if minus > 0.5 { other } else { plus }
}

impl Law {
    /// Level and curve of a direction.
    #[inline(always)]
    fn side(&self, minus: f64) -> (f64, Curve) {
        let [a, b] = &self.curves;
        let curve = Curve {
            rate: a.rate,
            excess: select(minus, [a.excess, b.excess]),
            fall: select(minus, [a.fall, b.fall]),
            exponent: a.exponent,
            ln_velocity: select(minus, [a.ln_velocity, b.ln_velocity]),
        };
        (select(minus, self.levels), curve)
    }

    /// The node of standstill at which motion in a direction starts.
    #[inline(always)]
    fn rest(&self, minus: f64) -> Node {
        let (level, curve) = self.side(minus);
        let g = level + curve.excess;
        Node {
            g,
            q: 0.0,
            slope: [curve.excess, 0.0],
            relative: [curve.excess / g, 0.0],
        }
    }

    /// Two nodes with one division.
    #[inline(always)]
    fn nodes<const POWER: bool>(&self, minus: [f64; 2], v: [Speed; 2]) -> [Node; 2] {
        let sides = [self.side(minus[0]), self.side(minus[1])];
        let exponent = |i: usize| {
            let exponent = sides[i].1.exponent::<POWER>(v[i]);
            at_least(exponent, LOWEST_STRIBECK_EXPONENT)
        };
        let exponents = [exponent(0), exponent(1)];
        let fall = |i: usize| sides[i].1.excess * exp(exponents[i]);
        let falls = [fall(0), fall(1)];
        let levels = [sides[0].0 + falls[0], sides[1].0 + falls[1]];
        let inverse = 1.0 / (levels[0] * levels[1]);
        let node = |i: usize| {
            let over = levels[1 - i] * inverse;
            let power = -sides[i].1.exponent * exponents[i];
            let slope = [falls[i], falls[i] * power];
            Node {
                g: levels[i],
                q: v[i].value * over,
                slope,
                relative: [slope[0] * over, slope[1] * over],
            }
        };
        [node(0), node(1)]
    }
}

/// The columns `eta` and `rate` of one trial along a track, at every sample, as [`trace`](crate::trace()) writes them.
///
/// ```
/// # use stiction_lanes::{Directed, InstructionSet, Segment, Time, Track, directed_levels};
/// let velocity = vec![-0.05; 200]; // m/s
/// # let force = vec![0.0; 200];
/// # let segment = Segment { time: Time::Step(1e-3), velocity: &velocity, force: &force, keep: &[], columns: &[] };
/// # let track = Track::new(&[segment])?;
/// let trial = Directed {
///     ln_kappa: 5e3_f64.ln(),
///     ln_ratio: 1.2_f64.ln(),
///     ln_excess: [0.5_f64.ln(), 0.4_f64.ln()],
///     ln_velocity: [5e-3_f64.ln(), 6e-3_f64.ln()],
///     exponent: 2.0,
/// };
/// let [eta, _] = directed_levels(&track, &trial, InstructionSet::best())?;
/// assert!((eta[199] + 1.2).abs() < 1e-12); // far above vs: the Coulomb level of the negative direction
/// # Ok::<(), stiction_lanes::Error>(())
/// ```
pub fn directed_levels(
    track: &Track,
    trial: &Directed,
    instructions: InstructionSet,
) -> Result<[Vec<f64>; 2], Error> {
    let law = law(trial)?;
    Ok(match trial.exponent == 2.0 {
        true => instructions.run(Levels::<false>(track, law)),
        false => instructions.run(Levels::<true>(track, law)),
    })
}

/// Derivatives of `weights[0] eta + weights[1] rate` with respect to `ln kappa`, `ln(r - 1)` and `ln vs` of the positive
/// direction, the same of the negative one, and `ln rho`, at every sample; empty for those that are not `wanted`.
///
/// ```
/// # use stiction_lanes::{Directed, InstructionSet, Segment, Time, Track, directed_slopes};
/// let velocity = vec![-0.05; 200]; // m/s
/// # let force = vec![0.0; 200];
/// # let segment = Segment { time: Time::Step(1e-3), velocity: &velocity, force: &force, keep: &[], columns: &[] };
/// # let track = Track::new(&[segment])?;
/// # let trial = Directed {
/// #     ln_kappa: 5e3_f64.ln(),
/// #     ln_ratio: 1.2_f64.ln(),
/// #     ln_excess: [0.5_f64.ln(), 0.4_f64.ln()],
/// #     ln_velocity: [5e-3_f64.ln(), 6e-3_f64.ln()],
/// #     exponent: 2.0,
/// # };
/// let all = [true; 6];
/// let slopes = directed_slopes(&track, &trial, [20.0, 600.0], all, InstructionSet::best())?;
/// assert!((slopes[5][199] + 20.0 * 1.2).abs() < 1e-9); // the Coulomb level of the negative direction
/// # Ok::<(), stiction_lanes::Error>(())
/// ```
pub fn directed_slopes(
    track: &Track,
    trial: &Directed,
    weights: [f64; 2],
    wanted: [bool; DIRECTED],
    instructions: InstructionSet,
) -> Result<[Vec<f64>; DIRECTED], Error> {
    let law = law(trial)?;
    Ok(match trial.exponent == 2.0 {
        true => instructions.run(Slopes::<false>(track, law, weights, wanted)),
        false => instructions.run(Slopes::<true>(track, law, weights, wanted)),
    })
}

fn law(trial: &Directed) -> Result<Law, Error> {
    let law = trial.law();
    law.map_err(|source| Error::Candidate { index: 0, source })
}

/// The deviation after a reversal at a standstill, seen in the new direction with its own level.
#[inline(always)]
fn turned(w: f64, from: f64, to: f64) -> f64 {
    -(w + from) - to
}

/// Levels of the nodes of a block, 1 where the motion is negative.
#[inline(always)]
fn negative(sign: &[i8; BLOCK]) -> [f64; BLOCK] {
    let mut out = [0.0; BLOCK];
    for t in 0..BLOCK {
        out[t] = 0.5 - 0.5 * f64::from(sign[t]);
    }
    out
}

#[inline(always)]
fn turns(marks: &[u8; BLOCK]) -> bool {
    let mut any = 0;
    for t in 0..BLOCK {
        any |= marks[t] & (RESTART | REVERSE);
    }
    any != 0
}

#[inline(always)]
fn node_tile<const POWER: bool>(
    law: &Law,
    minus: &[f64; TILE],
    speed: &[f64; TILE],
    ln: &[f64; TILE],
) -> [[f64; TILE]; 6] {
    let mut rows = [[0.0; TILE]; 6];
    for t in 0..HALF {
        let v = |t: usize| Speed {
            value: speed[t],
            ln: ln[t],
        };
        let pair = [minus[t], minus[t + HALF]];
        let [first, second] = law.nodes::<POWER>(pair, [v(t), v(t + HALF)]);
        write(&mut rows, t, first.to_array());
        write(&mut rows, t + HALF, second.to_array());
    }
    rows
}

struct Levels<'a, const POWER: bool>(&'a Track, Law);

impl<const POWER: bool> Kernel for Levels<'_, POWER> {
    type Output = [Vec<f64>; 2];

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Levels(track, law) = self;
        let ln_speed = speeds::<POWER>(track);
        let kappa = -law.curves[0].rate;
        let mut out = [0, 1].map(|_| Vec::with_capacity(track.samples()));
        let mut w = 0.0;
        // Level, and `-kappa v/g`; the first belongs to the node before the block.
        let mut g = Aligned([1.0; BLOCK + 1]);
        let mut q = Aligned([0.0; BLOCK + 1]);
        let mut keep = Aligned([0.0; BLOCK]);
        let mut add = Aligned([0.0; BLOCK]);
        let mut eta = [0.0; BLOCK];
        let mut rate = [0.0; BLOCK];
        let mut turned_before = false;
        for at in (0..track.speed.len()).step_by(BLOCK) {
            let speed: &[f64; BLOCK] = chunk(&track.speed, at);
            let marks: &[u8; BLOCK] = chunk(&track.marks, at);
            let half: &[f64; BLOCK] = chunk(&track.half_step, at);
            let minus = negative(chunk(&track.sign, at));
            g.0[0] = g.0[BLOCK];
            q.0[0] = q.0[BLOCK];
            if turned_before {
                (g.0[0], q.0[0]) = (law.rest(minus[0]).g, 0.0);
            }
            for tile in (0..BLOCK).step_by(TILE) {
                let side = chunk(&minus, tile);
                let rows =
                    node_tile::<POWER>(&law, side, chunk(speed, tile), chunk(ln_speed, at + tile));
                for t in 0..TILE {
                    g.0[tile + 1 + t] = rows[0][t];
                    q.0[tile + 1 + t] = -kappa * rows[1][t];
                }
            }
            for tile in (0..BLOCK).step_by(TILE) {
                let (g, q) = (&g.0, &q.0);
                let found = weights(
                    chunk(half, tile),
                    [chunk(g, tile), chunk(g, tile + 1)],
                    [chunk(q, tile), chunk(q, tile + 1)],
                );
                keep.0[tile..tile + TILE].copy_from_slice(&found.0);
                add.0[tile..tile + TILE].copy_from_slice(&found.1);
            }
            let turning = turns(marks);
            for t in 0..BLOCK {
                if !turning {
                    w = fma(keep.0[t], w, add.0[t]);
                    eta[t] = w + g.0[t + 1];
                    continue;
                }
                // An interval that begins at a reversal begins at the level of its own direction.
                if t > 0 && marks[t - 1] & REVERSE != 0 {
                    let node = |g: f64, q: f64| curve::Node { g, q };
                    let from = node(law.rest(minus[t]).g, 0.0);
                    let ends = [from, node(g.0[t + 1], q.0[t + 1])];
                    let [found, _] = curve::intervals([half[t]; 2], [ends; 2]);
                    (keep.0[t], add.0[t]) = (found.keep, found.add);
                }
                w = fma(keep.0[t], w, add.0[t]);
                if marks[t] & RESTART != 0 {
                    w = -g.0[t + 1];
                }
                eta[t] = w + g.0[t + 1];
                if marks[t] & REVERSE != 0 {
                    w = turned(w, g.0[t + 1], law.rest(1.0 - minus[t]).g);
                }
            }
            turned_before = marks[BLOCK - 1] & REVERSE != 0;
            for t in 0..BLOCK {
                rate[t] = fma(q.0[t + 1] / kappa, eta[t], speed[t]);
            }
            append(track, at, &eta, &mut out[0]);
            append(track, at, &rate, &mut out[1]);
        }
        out
    }
}

#[inline(always)]
fn speeds<const POWER: bool>(track: &Track) -> &[f64] {
    match POWER {
        true => track.ln_speed(),
        false => &track.speed,
    }
}

/// Derivatives of the level of a node with respect to the unknowns.
#[inline(always)]
fn level_slopes(minus: f64, node: &Node) -> [f64; DIRECTED] {
    let plus = 1.0 - minus;
    let mut out = [0.0; DIRECTED];
    out[EXCESS[0]] = plus * node.slope[0];
    out[VELOCITY[0]] = plus * node.slope[1];
    out[EXCESS[1]] = minus * node.slope[0];
    out[VELOCITY[1]] = minus * node.slope[1];
    out[RATIO] = minus * node.g;
    out
}

struct Slopes<'a, const POWER: bool>(&'a Track, Law, [f64; 2], [bool; DIRECTED]);

impl<const POWER: bool> Kernel for Slopes<'_, POWER> {
    type Output = [Vec<f64>; DIRECTED];

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Slopes(track, law, scales, wanted) = self;
        let ln_speed = speeds::<POWER>(track);
        let mut out =
            wanted.map(|wanted| Vec::with_capacity(if wanted { track.samples() } else { 0 }));
        let mut w = 0.0;
        let mut w_slope = [0.0; DIRECTED];
        let mut node_rows = Aligned(Node::START.map(|x| [x; BLOCK + 1]));
        let mut interval_rows = Aligned([[0.0; BLOCK]; 8]);
        let mut before = Aligned([0.0; BLOCK]);
        let mut now = Aligned([0.0; BLOCK]);
        let mut slopes = Aligned([[0.0; BLOCK]; DIRECTED]);
        let mut turned_before = false;
        for at in (0..track.speed.len()).step_by(BLOCK) {
            let speed: &[f64; BLOCK] = chunk(&track.speed, at);
            let marks: &[u8; BLOCK] = chunk(&track.marks, at);
            let half: &[f64; BLOCK] = chunk(&track.half_step, at);
            let minus = negative(chunk(&track.sign, at));
            let carried = match turned_before {
                true => law.rest(minus[0]).to_array(),
                false => read(&node_rows.0, BLOCK),
            };
            write(&mut node_rows.0, 0, carried);
            for tile in (0..BLOCK).step_by(TILE) {
                let side = chunk(&minus, tile);
                let ln = chunk(ln_speed, at + tile);
                let found = node_tile::<POWER>(&law, side, chunk(speed, tile), ln);
                for (row, found) in node_rows.0.iter_mut().zip(&found) {
                    row[tile + 1..tile + 1 + TILE].copy_from_slice(found);
                }
            }
            for tile in (0..BLOCK).step_by(TILE) {
                let ends = [tile, tile + 1].map(|from| row_chunks(&node_rows.0, from));
                let found = interval_tile(&law.curves[0], chunk(half, tile), &ends);
                for (row, found) in interval_rows.0.iter_mut().zip(&found) {
                    row[tile..tile + TILE].copy_from_slice(found);
                }
            }
            let turning = turns(marks);
            // An interval that begins at a reversal begins at the level of its own direction.
            for t in 1..if turning { BLOCK } else { 0 } {
                if marks[t - 1] & REVERSE != 0 {
                    let ends = [law.rest(minus[t]), node_at(&node_rows.0, t)];
                    let [found, _] = intervals(&law.curves[0], [half[t]; 2], [ends; 2]);
                    write(&mut interval_rows.0, t, found.to_array());
                }
            }
            let [keep, add, ..] = &interval_rows.0;
            let g = &node_rows.0[0];
            for t in 0..BLOCK {
                before.0[t] = w;
                w = fma(keep[t], w, add[t]);
                if !turning {
                    now.0[t] = w;
                    continue;
                }
                if marks[t] & RESTART != 0 {
                    w = -g[t + 1];
                }
                now.0[t] = w;
                if marks[t] & REVERSE != 0 {
                    w = turned(w, g[t + 1], law.rest(1.0 - minus[t]).g);
                }
            }
            for t in 0..BLOCK {
                let step = Interval::from_array(read(&interval_rows.0, t));
                let [kappa, excess, velocity] = slope_adds(before.0[t], &step);
                let (plus, minus) = (1.0 - minus[t], minus[t]);
                let mut adds = [0.0; DIRECTED];
                adds[KAPPA] = kappa;
                adds[EXCESS[0]] = fma(plus, excess, SUBNORMAL_GUARD);
                adds[VELOCITY[0]] = fma(plus, velocity, SUBNORMAL_GUARD);
                adds[EXCESS[1]] = fma(minus, excess, SUBNORMAL_GUARD);
                adds[VELOCITY[1]] = fma(minus, velocity, SUBNORMAL_GUARD);
                // All of the level grows with the ratio, so intervals become shorter as with a smaller kappa.
                adds[RATIO] = fma(minus, step.add - kappa, SUBNORMAL_GUARD);
                write(&mut slopes.0, t, adds);
            }
            for t in 0..BLOCK {
                for k in 0..DIRECTED {
                    w_slope[k] = fma(keep[t], w_slope[k], slopes.0[k][t]);
                }
                if !turning || marks[t] & (RESTART | REVERSE) == 0 {
                    write(&mut slopes.0, t, w_slope);
                    continue;
                }
                let level = level_slopes(minus[t], &node_at(&node_rows.0, t));
                if marks[t] & RESTART != 0 {
                    w_slope = level.map(|x| -x);
                }
                write(&mut slopes.0, t, w_slope);
                if marks[t] & REVERSE != 0 {
                    let other = 1.0 - minus[t];
                    let next = level_slopes(other, &law.rest(other));
                    for k in 0..DIRECTED {
                        w_slope[k] = turned(w_slope[k], level[k], next[k]);
                    }
                }
            }
            turned_before = marks[BLOCK - 1] & REVERSE != 0;
            for t in 0..BLOCK {
                let node = node_at(&node_rows.0, t);
                let level = level_slopes(minus[t], &node);
                let eta = now.0[t] + node.g;
                let mut weighed = [0.0; DIRECTED];
                // The derivative of the rate is `q (dg eta/g - deta)`.
                let own = fma(-scales[1], node.q, scales[0]);
                let relative = scales[1] * node.q * eta;
                let over = [
                    0.0,
                    (1.0 - minus[t]) * node.relative[0],
                    (1.0 - minus[t]) * node.relative[1],
                    minus[t] * node.relative[0],
                    minus[t] * node.relative[1],
                    minus[t],
                ];
                for k in 0..DIRECTED {
                    let slope = slopes.0[k][t] + level[k];
                    weighed[k] = fma(relative, over[k], own * slope);
                }
                write(&mut slopes.0, t, weighed);
            }
            for k in 0..DIRECTED {
                if wanted[k] {
                    append(track, at, &slopes.0[k], &mut out[k]);
                }
            }
        }
        out
    }
}

/// The node at a place of a block; the rows begin with the one before it.
#[inline(always)]
fn node_at(rows: &[[f64; BLOCK + 1]; 6], t: usize) -> Node {
    Node::from_array(read(rows, t + 1))
}
