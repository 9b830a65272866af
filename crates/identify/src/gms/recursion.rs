//! The generalised Maxwell-slip law along a recorded velocity, with its sensitivities.
//!
//! Al-Bender, Lampaert and Swevers 2005, doi 10.1109/TAC.2005.858676, eqs. 9-12, in units of the
//! yield force `W_k = k_k d_k` that an element holds at rest. With `w_k = sgn(v) F_k / W_k` and
//! `s(v)/s(0)` from [`super::limit`]:
//!
//! ```text
//! stick: w_k' = |v| / d_k                        until w_k reaches s(v)/s(0)
//! slip:  w_k' = a (1 - w_k s(0)/s(v))            until v passes through or rests at zero
//! ```
//!
//! Their `C` is `a s(0)`, in force per second; with their shares of the limit equal to those of the
//! yield forces, `a` is the same for every element. An element whose deflection points against the
//! motion sticks, however low the limit is. Without a Stribeck curve slip stays at the limit and `a`
//! plays no part: the Maxwell-slip law.
//!
//! The velocity is linear between samples and so is the limit, as in the scheme EXPLIN of
//! [`stiction_friction::LuGre::step_record`]: a sticking element then moves along a parabola whose
//! meeting with the limit is found exactly, a slipping one follows by an exponential step. Steps are
//! split where the velocity changes its sign. Sensitivities are those of this map, exactly.

use super::limit::{Curve, Limit, limit};
use crate::law::{Law, Layout};
use crate::separable::recursion::{LONGEST_DECAY, phi};
use libm::{expm1, fabs};

/// One element along the record.
#[derive(Clone, Debug, Default)]
pub(crate) struct Element {
    /// Force over yield force, in -1..1 for a symmetric law.
    pub level: Vec<f64>,
    /// Derivative of the level by `ln d` of this element; empty without sensitivities.
    own: Vec<f64>,
    /// Derivatives by the unknowns that all elements share; the first ones of the law.
    shared: Vec<Vec<f64>>,
    /// Which unknown `own` belongs to.
    index: usize,
}

/// `sum_k c_k d(level_k)/dp_i` at the full rate.
pub(crate) fn slope(elements: &[Element], i: usize, coefficients: &[f64]) -> Vec<f64> {
    let n = elements.first().map_or(0, |e| e.level.len());
    let mut out = vec![0.0; n];
    for (element, c) in elements.iter().zip(coefficients) {
        let column = if element.index == i {
            &element.own
        } else if let Some(column) = element.shared.get(i) {
            column
        } else {
            continue;
        };
        if *c != 0.0 {
            for (y, x) in out.iter_mut().zip(column) {
                *y += c * x;
            }
        }
    }
    out
}

/// Runs the elements along a velocity; `slopes` asks for the sensitivities too.
pub(crate) fn trace(
    law: &Law,
    p: &[f64],
    step: f64,
    velocity: &[f64],
    slopes: bool,
) -> Vec<Element> {
    // The unknowns that all elements share come first: none, the ratio of the directions, the curve of
    // one direction, or the curves of both.
    match (slopes, law.layout().yields().start) {
        (true, 1) => run::<1>(law, p, step, velocity, slopes),
        (true, 3) => run::<3>(law, p, step, velocity, slopes),
        (true, 6) => run::<6>(law, p, step, velocity, slopes),
        _ => run::<0>(law, p, step, velocity, slopes),
    }
}

/// State of one element between samples, in the direction of motion.
#[derive(Clone, Copy, Debug)]
struct State<const K: usize> {
    /// Force over yield force, positive along the motion.
    w: f64,
    slipping: bool,
    /// Derivative by `ln d`.
    own: f64,
    shared: [f64; K],
    /// `1/d`, 1/m or 1/rad.
    inverse_yield: f64,
}

fn run<const K: usize>(
    law: &Law,
    p: &[f64],
    step: f64,
    velocity: &[f64],
    slopes: bool,
) -> Vec<Element> {
    let layout = law.layout();
    let curve = Curve::new(law, &layout, p);
    let n = velocity.len();
    let mut out: Vec<Element> = layout
        .yields()
        .map(|index| Element {
            level: vec![0.0; n],
            own: vec![0.0; if slopes { n } else { 0 }],
            shared: vec![vec![0.0; n]; K],
            index,
        })
        .collect();
    let mut states: Vec<State<K>> = layout
        .yields()
        .map(|i| State {
            w: 0.0,
            slipping: false,
            own: 0.0,
            shared: [0.0; K],
            inverse_yield: libm::exp(-p[i]),
        })
        .collect();
    let rest = [0, 1].map(|side| limit::<K>(&curve, &layout, 0.0, side));
    // The direction in which `w` counts.
    let mut facing = 0;
    let mut before: Option<(f64, Limit<K>)> = None;
    for (i, &v) in velocity.iter().enumerate() {
        let side = usize::from(v < 0.0);
        let now = limit::<K>(&curve, &layout, v, side);
        if let Some((u, old)) = before {
            let first = usize::from(u < 0.0);
            if u != 0.0 && v != 0.0 && first != side {
                let theta = u / (u - v);
                let part = Part::new(
                    &layout,
                    &curve,
                    theta * step,
                    (u, &old),
                    (0.0, &rest[first]),
                );
                part.advance(&mut states);
                turn(&mut states, &mut facing, side);
                let part = Part::new(
                    &layout,
                    &curve,
                    v / (v - u) * step,
                    (0.0, &rest[side]),
                    (v, &now),
                );
                part.advance(&mut states);
            } else if u != 0.0 || v != 0.0 {
                // A step that starts or ends at rest counts for the direction in which it moves.
                let moving = usize::from(u < 0.0 || v < 0.0);
                if u == 0.0 {
                    turn(&mut states, &mut facing, moving);
                }
                let from = if u == 0.0 { &rest[moving] } else { &old };
                let to = if v == 0.0 { &rest[moving] } else { &now };
                Part::new(&layout, &curve, step, (u, from), (v, to)).advance(&mut states);
            }
        } else {
            facing = side;
        }
        let sign = if facing == 0 { 1.0 } else { -1.0 };
        for (element, state) in out.iter_mut().zip(&states) {
            element.level[i] = sign * state.w;
            if slopes {
                element.own[i] = sign * state.own;
                for (column, x) in element.shared.iter_mut().zip(&state.shared) {
                    column[i] = sign * x;
                }
            }
        }
        before = Some((v, now));
    }
    out
}

/// The velocity passes through zero, or starts from it: every element sticks.
fn turn<const K: usize>(states: &mut [State<K>], facing: &mut usize, side: usize) {
    let turned = *facing != side;
    *facing = side;
    for state in states {
        state.slipping = false;
        if turned {
            state.w = -state.w;
            state.own = -state.own;
            state.shared.iter_mut().for_each(|x| *x = -*x);
        }
    }
}

/// A part of a step with motion in one direction: the values common to all elements.
struct Part<'a, const K: usize> {
    layout: &'a Layout,
    attraction: f64,
    /// Its duration, s.
    time: f64,
    /// Speeds at both ends.
    speed: (f64, f64),
    from: &'a Limit<K>,
    to: &'a Limit<K>,
    /// `w` of a slipping element becomes `keep w + drive`.
    keep: f64,
    drive: f64,
    /// Its derivatives are `keep dw + bend w + push`.
    bend: [f64; K],
    push: [f64; K],
}

impl<'a, const K: usize> Part<'a, K> {
    #[inline(always)]
    fn new(
        layout: &'a Layout,
        curve: &Curve,
        time: f64,
        (va, from): (f64, &'a Limit<K>),
        (vb, to): (f64, &'a Limit<K>),
    ) -> Self {
        let half = 0.5 * time * curve.attraction;
        let (qa, qb) = (half / from.value, half / to.value);
        let a = (qa + qb).min(LONGEST_DECAY);
        let e = expm1(-a);
        let (ph, ph_slope) = phi(a, e);
        let keep = 1.0 + e;
        let rise = to.value - from.value;
        let mut bend = [0.0; K];
        let mut push = [0.0; K];
        for k in 0..K {
            let (da, db) = (from.slope[k], to.slope[k]);
            let mut a_slope = -(qa * da / from.value + qb * db / to.value);
            if layout.attraction == Some(k) {
                a_slope += a;
            }
            bend[k] = -keep * a_slope;
            push[k] = db - da * keep + from.value * keep * a_slope
                - (db - da) * ph
                - rise * ph_slope * a_slope;
        }
        Self {
            layout,
            attraction: curve.attraction,
            time,
            speed: (fabs(va), fabs(vb)),
            from,
            to,
            keep,
            drive: to.value - from.value * keep - rise * ph,
            bend,
            push,
        }
    }

    #[inline(always)]
    fn advance(&self, states: &mut [State<K>]) {
        let (a, b) = self.speed;
        let path = 0.5 * self.time * (a + b);
        // Below this level no element can reach the limit within this part.
        let least = self.from.value.min(self.to.value);
        for state in states {
            if state.slipping {
                self.slip(state);
                continue;
            }
            let d = path * state.inverse_yield;
            let end = state.w + d;
            if end >= least
                && let Some(at) = self.meets(state)
            {
                self.begin(state, at);
                continue;
            }
            state.w = end;
            state.own -= d;
        }
    }

    #[inline(always)]
    fn slip(&self, state: &mut State<K>) {
        for k in 0..K {
            state.shared[k] = self.keep * state.shared[k] + self.bend[k] * state.w + self.push[k];
        }
        state.own *= self.keep;
        state.w = self.keep * state.w + self.drive;
    }

    /// The part of this stretch after which a sticking element meets the limit; 0 if it stands above
    /// it already.
    fn meets(&self, state: &State<K>) -> Option<f64> {
        let (a, b) = self.speed;
        let h = self.time * state.inverse_yield;
        // gap + line t + bow t^2 = 0 for the first t in 0..1, the gap being negative before.
        let gap = state.w - self.from.value;
        if gap >= 0.0 {
            return Some(0.0);
        }
        let line = h * a - (self.to.value - self.from.value);
        let bow = 0.5 * h * (b - a);
        let root = line * line - 4.0 * bow * gap;
        if root < 0.0 {
            return None;
        }
        // This form avoids cancellation for both roots, and a curvature (`bow`) of zero gives the linear case.
        let under = line + root.sqrt();
        let first = -2.0 * gap / under;
        (under > 0.0 && first <= 1.0).then_some(first)
    }

    /// Slip from the point `t` of this stretch on.
    #[cold]
    fn begin(&self, state: &mut State<K>, t: f64) {
        state.slipping = true;
        if t == 0.0 {
            return self.slip(state);
        }
        let (a, b) = self.speed;
        let h = self.time * state.inverse_yield;
        let rise = self.to.value - self.from.value;
        let closing = h * (a + (b - a) * t) - rise;
        let path = h * (a * t + 0.5 * (b - a) * t * t);
        let level = self.from.value + rise * t;
        let left = 1.0 - t;
        let half = 0.5 * self.time * self.attraction;
        let (qa, qb) = (half / level, half / self.to.value);
        let exponent = (left * (qa + qb)).min(LONGEST_DECAY);
        let e = expm1(-exponent);
        let (ph, ph_slope) = phi(exponent, e);
        // By how much a later meeting changes the level, the exponent and therefore the level at the end.
        let per_level = ph + (self.to.value - level) * ph_slope * left * qa / level;
        let per_time = (self.to.value - level) * ph_slope * (qa + qb);
        // Where the element only touches the limit (grazing), the meeting time has no first derivative:
        // it is kept fixed.
        let inverse = if closing > 0.0 { 1.0 / closing } else { 0.0 };
        let time_own = (path - state.own) * inverse;
        for k in 0..K {
            let (da, db) = (self.from.slope[k], self.to.slope[k]);
            let line = da + (db - da) * t;
            let time = (line - state.shared[k]) * inverse;
            let mut exponent_slope = -left * qb * db / self.to.value;
            if self.layout.attraction == Some(k) {
                exponent_slope += exponent;
            }
            state.shared[k] = db * (1.0 - ph) + (line + rise * time) * per_level + time * per_time
                - (self.to.value - level) * ph_slope * exponent_slope;
        }
        state.own = rise * time_own * per_level + time_own * per_time;
        state.w = self.to.value - (self.to.value - level) * ph;
    }
}
