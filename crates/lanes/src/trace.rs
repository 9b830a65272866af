//! The columns of one trial, written out.

use crate::curve::{Curve, START, reversed};
use crate::exp::fma;
use crate::lane_array::chunk;
use crate::normal::alone::{Sink, along};
use crate::sensitive::{OWN, UNKNOWNS};
use crate::time_lanes::Block;
use crate::track::{BLOCK, RESTART, REVERSE, SAMPLE};
use crate::{Error, Track, Trial};
use stiction_dispatch::{InstructionSet, Kernel};

/// Columns of a trial at every sample of a track, whether it counts or not, in the order of the samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// `eta = sigma0 z/Fc`.
    pub eta: Vec<f64>,
    /// `v - |v| eta/gh`, m/s (rad/s): `sigma1` multiplies it.
    pub rate: Vec<f64>,
    /// Derivatives of eta with respect to `ln kappa`, `ln(r - 1)`, `ln vs`; empty if not asked for.
    pub eta_slope: [Vec<f64>; 3],
    /// Derivatives of rate, likewise.
    pub rate_slope: [Vec<f64>; 3],
}

/// Runs one trial along a track, with the samples in lanes; `slopes` asks for the derivatives too.
///
/// ```
/// # use stiction_lanes::{InstructionSet, Segment, Time, Track, Trial, trace};
/// let velocity = vec![0.05; 200]; // m/s
/// # let force = vec![0.0; 200];
/// # let segment = Segment { time: Time::Step(1e-3), velocity: &velocity, force: &force, keep: &[], columns: &[] };
/// # let track = Track::new(&[segment])?;
/// let trial = Trial { ln_kappa: 5e3_f64.ln(), ln_excess: 0.5_f64.ln(), ln_velocity: 5e-3_f64.ln(), exponent: 2.0 };
/// let columns = trace(&track, &trial, false, InstructionSet::best())?;
/// assert!((columns.eta[199] - 1.0).abs() < 1e-12); // far above vs: the Coulomb level
/// # Ok::<(), stiction_lanes::Error>(())
/// ```
pub fn trace(
    track: &Track,
    trial: &Trial,
    slopes: bool,
    instructions: InstructionSet,
) -> Result<Columns, Error> {
    let curve = trial
        .curve()
        .map_err(|source| Error::Candidate { index: 0, source })?;
    Ok(match (slopes, curve.exponent == 2.0) {
        (true, true) => instructions.run(Sensitive::<false>(track, curve)),
        (true, false) => instructions.run(Sensitive::<true>(track, curve)),
        (false, true) => instructions.run(Plain::<false>(track, curve)),
        (false, false) => instructions.run(Plain::<true>(track, curve)),
    })
}

/// Derivatives of `weights[0] eta + weights[1] rate` with respect to `ln kappa`, `ln(r - 1)`, `ln vs`, at every
/// sample: what a regression whose coefficients are known needs of them.
///
/// ```
/// use stiction_lanes::{InstructionSet, Segment, Time, Track, Trial, slopes};
/// let velocity = vec![0.05; 200]; // m/s
/// # let force = vec![0.0; 200];
/// # let segment = Segment { time: Time::Step(1e-3), velocity: &velocity, force: &force, keep: &[], columns: &[] };
/// # let track = Track::new(&[segment])?;
/// let trial = Trial { ln_kappa: 5e3_f64.ln(), ln_excess: 0.5_f64.ln(), ln_velocity: 5e-3_f64.ln(), exponent: 2.0 };
/// let [kappa, excess, _] = slopes(&track, &trial, [20.0, 600.0], InstructionSet::best())?;
/// // Steady and far above vs, the force knows neither stiffness nor static friction.
/// assert!(kappa[199].abs() < 1e-12 && excess[199].abs() < 1e-12);
/// # Ok::<(), stiction_lanes::Error>(())
/// ```
pub fn slopes(
    track: &Track,
    trial: &Trial,
    weights: [f64; 2],
    instructions: InstructionSet,
) -> Result<[Vec<f64>; UNKNOWNS], Error> {
    let curve = trial
        .curve()
        .map_err(|source| Error::Candidate { index: 0, source })?;
    Ok(if curve.exponent == 2.0 {
        instructions.run(Weighted::<false>(track, curve, weights))
    } else {
        instructions.run(Weighted::<true>(track, curve, weights))
    })
}

struct Weighted<'a, const POWER: bool>(&'a Track, Curve, [f64; 2]);

impl<const POWER: bool> Kernel for Weighted<'_, POWER> {
    type Output = [Vec<f64>; UNKNOWNS];

    #[inline(always)]
    fn run(self) -> [Vec<f64>; UNKNOWNS] {
        let Weighted(track, curve, weights) = self;
        let mut adding = Adding {
            track,
            weights,
            slopes: std::array::from_fn(|_| Vec::with_capacity(track.samples())),
        };
        along::<POWER>(track, &curve, &mut adding);
        adding.slopes
    }
}

/// Appends the weighted derivatives of each block.
struct Adding<'a> {
    track: &'a Track,
    weights: [f64; 2],
    slopes: [Vec<f64>; UNKNOWNS],
}

impl Sink for Adding<'_> {
    #[inline(always)]
    fn block(&mut self, at: usize, own: &[[f64; BLOCK]; OWN]) {
        for (k, out) in self.slopes.iter_mut().enumerate() {
            let mut column = [0.0; BLOCK];
            for t in 0..BLOCK {
                let eta = self.weights[0] * own[2 + k][t];
                column[t] = eta + self.weights[1] * own[2 + UNKNOWNS + k][t];
            }
            append(self.track, at, &column, out);
        }
    }
}

struct Sensitive<'a, const POWER: bool>(&'a Track, Curve);

impl<const POWER: bool> Kernel for Sensitive<'_, POWER> {
    type Output = Columns;

    #[inline(always)]
    fn run(self) -> Columns {
        let Sensitive(track, curve) = self;
        let mut writing = Writing {
            track,
            own: std::array::from_fn(|_| Vec::with_capacity(track.samples())),
        };
        along::<POWER>(track, &curve, &mut writing);
        let [eta, rate, a, b, c, d, e, f] = writing.own;
        Columns {
            eta,
            rate,
            eta_slope: [a, b, c],
            rate_slope: [d, e, f],
        }
    }
}

/// Appends the samples of each block.
struct Writing<'a> {
    track: &'a Track,
    own: [Vec<f64>; OWN],
}

impl Sink for Writing<'_> {
    #[inline(always)]
    fn block(&mut self, at: usize, own: &[[f64; BLOCK]; OWN]) {
        for (out, column) in self.own.iter_mut().zip(own) {
            append(self.track, at, column, out);
        }
    }
}

/// Appends the samples of a block, each with the sign of the motion.
#[inline(always)]
pub(crate) fn append(track: &Track, at: usize, column: &[f64; BLOCK], out: &mut Vec<f64>) {
    let sign: &[i8; BLOCK] = chunk(&track.sign, at);
    let marks: &[u8; BLOCK] = chunk(&track.marks, at);
    let mut all = SAMPLE;
    for t in 0..BLOCK {
        all &= marks[t];
    }
    if all != 0 {
        // Straight into the column: an array in between would be cleared, filled and copied.
        out.extend(sign.iter().zip(column).map(|(s, x)| f64::from(*s) * x));
        return;
    }
    let mut samples = [0.0; BLOCK];
    let mut count = 0;
    for t in 0..BLOCK {
        samples[count] = f64::from(sign[t]) * column[t];
        count += usize::from(marks[t] & SAMPLE != 0);
    }
    out.extend_from_slice(&samples[..count]);
}

struct Plain<'a, const POWER: bool>(&'a Track, Curve);

impl<const POWER: bool> Kernel for Plain<'_, POWER> {
    type Output = Columns;

    #[inline(always)]
    fn run(self) -> Columns {
        let Plain(track, curve) = self;
        let ln_speed = if POWER {
            track.ln_speed()
        } else {
            &track.speed
        };
        // The block's `q` is `-kappa v/g`.
        let length = 1.0 / curve.rate;
        let mut columns = Columns {
            eta: Vec::with_capacity(track.samples()),
            rate: Vec::with_capacity(track.samples()),
            ..Columns::default()
        };
        let mut w = -START.g;
        let mut block = Block::new();
        let (mut eta, mut rate) = ([0.0; BLOCK], [0.0; BLOCK]);
        for at in (0..track.speed.len()).step_by(BLOCK) {
            let speed: &[f64; BLOCK] = chunk(&track.speed, at);
            let marks: &[u8; BLOCK] = chunk(&track.marks, at);
            let (ln, half) = (chunk(ln_speed, at), chunk(&track.half_step, at));
            block.fill::<POWER>(&curve, speed, ln, half);
            let mut turns = 0;
            for t in 0..BLOCK {
                turns |= marks[t] & (RESTART | REVERSE);
            }
            for t in 0..BLOCK {
                let g = block.g.0[t + 1];
                w = fma(block.keep.0[t], w, block.add.0[t]);
                if turns == 0 {
                    eta[t] = w + g;
                    continue;
                }
                if marks[t] & RESTART != 0 {
                    w = -g;
                }
                eta[t] = w + g;
                if marks[t] & REVERSE != 0 {
                    w = reversed(w, g);
                }
            }
            for t in 0..BLOCK {
                rate[t] = fma(-(length * block.q.0[t + 1]), eta[t], speed[t]);
            }
            append(track, at, &eta, &mut columns.eta);
            append(track, at, &rate, &mut columns.rate);
        }
        columns
    }
}
