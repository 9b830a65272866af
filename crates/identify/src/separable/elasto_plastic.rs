//! The elasto-plastic bristle in units of the Coulomb level, along a recorded velocity, with its
//! sensitivities.
//!
//! ```text
//! eta' = kappa (v - alpha |v| eta/gh(v)),     alpha(1 - |eta|/gh) as in [`stiction_friction::ElastoPlastic`]
//! ```
//! The scheme of [`stiction_friction::ElastoPlastic::step_record`] for `eta = s0 z / Fc`, with every
//! number carried together with its derivatives; the friction crate is the oracle it is tested
//! against. Below break-away eta changes in proportion to the path; beyond it eta changes as in LuGre,
//! over a path scaled by the pull m of the bristle.

use crate::law::{Layout, share_of_odds};
use crate::separable::dual::Dual;
use crate::separable::recursion::{Curve, LONGEST_DECAY, Trace, level};
use libm::{fabs, sin, sqrt};

/// How the pull of a bristle depends on its distance from steady deflection, `e = 1 - |eta|/gh`.
#[derive(Clone, Copy)]
struct Plasticity<const K: usize> {
    /// `z_ba/z_ss`.
    breakaway: Dual<K>,
    /// One minus `breakaway`: the e below which slip begins.
    width: Dual<K>,
    /// `pi/2` over the width.
    turn: Dual<K>,
}

impl<const K: usize> Plasticity<K> {
    fn new(layout: &Layout, odds: f64) -> Self {
        let (value, slope) = share_of_odds(odds);
        let breakaway = Dual::new(value, layout.breakaway, slope);
        let width = Dual::constant(1.0) - breakaway;
        Self {
            breakaway,
            width,
            turn: Dual::constant(std::f64::consts::FRAC_PI_2) / width,
        }
    }

    /// The pull m: `1/e` while elastic, 1 from the steady deflection on, smooth between.
    fn pull(&self, e: Dual<K>) -> Dual<K> {
        if e.value >= self.width.value {
            Dual::constant(1.0) / e
        } else if e.value <= 0.0 {
            Dual::constant(1.0)
        } else {
            let s = sin(self.turn.value * e.value);
            let c = sqrt((1.0 - s * s).max(0.0));
            let rest = 1.0 - e.value;
            let r = s / e.value;
            let by_turn = 2.0 * rest * s * c;
            let by_e = r * (2.0 * self.turn.value * rest * c - r);
            e.mapped(1.0 + rest * s * r, by_e).moved(self.turn, by_turn)
        }
    }
}

/// Motion in one direction, everything counted along it.
#[derive(Clone, Copy)]
struct Way<const K: usize> {
    /// `kappa` times its length.
    path: Dual<K>,
    /// The integral of `kappa |v|/gh`.
    stretched: Dual<K>,
    /// Level at its begin and end.
    from: Dual<K>,
    to: Dual<K>,
}

impl<const K: usize> Way<K> {
    /// Change of `y` over a part of the way at the pull `m`.
    fn change(&self, y: Dual<K>, part: f64, m: Dual<K>) -> Dual<K> {
        let a = (self.stretched * m).scaled(part).limited(LONGEST_DECAY);
        let (e, follows) = a.relaxation();
        (y - self.from) * e + (self.to - self.from).scaled(part) * follows
    }

    /// `y` at its end.
    fn run(mut self, plasticity: &Plasticity<K>, start: Dual<K>) -> Dual<K> {
        let (begin, end) = (
            plasticity.breakaway * self.from,
            plasticity.breakaway * self.to,
        );
        let mut y = start;
        if y.value <= begin.value {
            let elastic = y + self.path;
            if elastic.value <= end.value {
                return elastic;
            }
            let part = (begin - y) / (self.path - (end - begin));
            self.from = self.from + part * (self.to - self.from);
            self.stretched = (Dual::constant(1.0) - part) * self.stretched;
            y = plasticity.breakaway * self.from;
        }
        if y.value >= self.from.value && self.to.value <= self.from.value {
            // Beyond the steady deflection during the whole step the pull is 1 in every stage, as in LuGre.
            return y + self.change(y, 1.0, Dual::constant(1.0));
        }
        // The pull after a part of the way, if it was `m` on that part.
        let pull = |part: f64, m: Dual<K>| {
            let level = self.from + (self.to - self.from).scaled(part);
            let moved = y + self.change(y, part, m);
            plasticity.pull((level - moved) / level)
        };
        let m1 = plasticity.pull((self.from - y) / self.from);
        let m2 = pull(0.5, m1);
        let m3 = pull(0.5, m2);
        let m4 = pull(1.0, m3);
        let mean = (m1 + (m2 + m3).scaled(2.0) + m4).scaled(1.0 / 6.0);
        y + self.change(y, 1.0, mean)
    }
}

/// Runs the law along a velocity; `K` is the number of unknowns of the layout, or 0 without
/// sensitivities. `odds` is the nonlinear unknown of the break-away part.
pub(super) fn run<const K: usize>(
    layout: &Layout,
    curve: &Curve,
    odds: f64,
    step: f64,
    velocity: &[f64],
) -> Trace {
    let n = velocity.len();
    let mut out = Trace {
        eta: vec![0.0; n],
        rate: vec![0.0; n],
        eta_slope: vec![vec![0.0; n]; K],
        rate_slope: vec![vec![0.0; n]; K],
        ..Trace::default()
    };
    let plasticity = Plasticity::<K>::new(layout, odds);
    let kappa = Dual::new(curve.kappa, layout.kappa, curve.kappa);
    let at = |v: f64, side: usize| {
        let g = level::<K>(curve, layout, v, side);
        Dual {
            value: g.value,
            slope: g.slope,
        }
    };
    let rest = [at(0.0, 0), at(0.0, 1)];
    let mut eta = Dual::constant(0.0);
    let mut before: Option<(f64, Dual<K>)> = None;
    for (i, &v) in velocity.iter().enumerate() {
        let side = usize::from(v < 0.0);
        let now = at(v, side);
        if let Some((u, old)) = before {
            // A part of the step in one direction: its share of the time, speeds and levels at its ends.
            let mut part = |time: f64, a: f64, from: Dual<K>, b: f64, to: Dual<K>, s: f64| {
                let half = kappa.scaled(0.5 * step * time);
                let (a, b) = (Dual::constant(fabs(a)), Dual::constant(fabs(b)));
                let way = Way {
                    path: half * (a + b),
                    stretched: half * (a / from + b / to),
                    from,
                    to,
                };
                eta = way.run(&plasticity, eta.scaled(s)).scaled(s);
            };
            let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
            if u != 0.0 && v != 0.0 && (u < 0.0) != (v < 0.0) {
                let theta = u / (u - v);
                part(theta, u, old, 0.0, rest[usize::from(u < 0.0)], sign(u));
                part(v / (v - u), 0.0, rest[side], v, now, sign(v));
            } else if u != 0.0 || v != 0.0 {
                // A step that starts or ends at rest counts for the direction in which it moves.
                let s = if u < 0.0 || v < 0.0 { -1.0 } else { 1.0 };
                let moving = usize::from(s < 0.0);
                let from = if u == 0.0 { rest[moving] } else { old };
                let to = if v == 0.0 { rest[moving] } else { now };
                part(1.0, u, from, v, to, s);
            }
        }
        let along = if v < 0.0 { eta.scaled(-1.0) } else { eta };
        let e = (now - along) / now;
        let rate = (plasticity.pull(e) * e).scaled(v);
        out.eta[i] = eta.value;
        out.rate[i] = rate.value;
        for k in 0..K {
            out.eta_slope[k][i] = eta.slope[k];
            out.rate_slope[k][i] = rate.slope[k];
        }
        before = Some((v, now));
    }
    out
}
