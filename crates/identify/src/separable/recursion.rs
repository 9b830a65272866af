//! The law in units of its Coulomb level, along a recorded velocity, with its sensitivities.
//!
//! This is the scheme EXPLIN of [`stiction_friction::LuGre::step_record`] written for
//! `eta = s0 z / Fc` and differentiated by hand with respect to every nonlinear unknown; the
//! friction crate is the oracle it is tested against.

use crate::exponential::{exp, expm1};
use crate::law::{Law, LawKind, Layout};
use crate::separable::elasto_plastic;
use libm::{fabs, log, pow};

/// The nonlinear unknowns, unpacked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    pub kappa: f64,
    /// `Fc` of each direction over `Fc` of the positive one.
    scale: [f64; 2],
    /// `r - 1` of each direction.
    excess: [f64; 2],
    inverse_velocity: [f64; 2],
    exponent: f64,
}

impl Curve {
    fn new(law: &Law, layout: &Layout, p: &[f64]) -> Self {
        let read = |index: Option<usize>| index.map(|i| exp(p[i]));
        let excess = layout.excess.map(|i| read(i).unwrap_or(0.0));
        Self {
            kappa: read(layout.kappa).unwrap_or(0.0),
            scale: [1.0, read(layout.ratio).unwrap_or(1.0)],
            excess,
            inverse_velocity: layout.velocity.map(|i| read(i).map_or(0.0, |v| 1.0 / v)),
            exponent: read(layout.exponent).unwrap_or(law.exponent),
        }
    }
}

/// Friction level `gh` at one velocity, and its derivatives.
#[derive(Clone, Copy)]
pub(super) struct Level<const K: usize> {
    pub value: f64,
    pub slope: [f64; K],
}

#[inline(always)]
pub(super) fn level<const K: usize>(
    curve: &Curve,
    layout: &Layout,
    v: f64,
    side: usize,
) -> Level<K> {
    let x = fabs(v) * curve.inverse_velocity[side];
    let power = if curve.exponent == 2.0 {
        x * x
    } else {
        pow(x, curve.exponent)
    };
    let fall = curve.scale[side] * curve.excess[side] * exp(-power);
    let value = curve.scale[side] + fall;
    let mut slope = [0.0; K];
    if let Some(i) = layout.excess[side] {
        slope[i] = fall;
    }
    if let Some(i) = layout.velocity[side] {
        // 0 * inf at extreme speeds is a level that no longer depends on vs.
        slope[i] = if fall == 0.0 {
            0.0
        } else {
            fall * curve.exponent * power
        };
    }
    if let Some(i) = layout.exponent {
        // At rest and far above vs the level no longer depends on the exponent.
        slope[i] = if fall == 0.0 || power == 0.0 {
            0.0
        } else {
            -fall * curve.exponent * power * log(x)
        };
    }
    if side == 1
        && let Some(i) = layout.ratio
    {
        slope[i] = value;
    }
    Level { value, slope }
}

/// Intervals are held below this, so that their derivatives stay finite.
pub(crate) const LONGEST_DECAY: f64 = 1e150;
/// Derivatives below this are set to zero: otherwise they would decay into denormal numbers, which are slow.
const LEAST_DERIVATIVE: f64 = 1e-140;

/// `(1 - exp(-a)) / a` and its derivative.
#[inline(always)]
pub(crate) fn phi(a: f64, e: f64) -> (f64, f64) {
    if a < 1e-3 {
        let value = 1.0 - a * (0.5 - a * (1.0 / 6.0 - a * (1.0 / 24.0 - a / 120.0)));
        let slope = -0.5 + a * (1.0 / 3.0 - a * (0.125 - a / 30.0));
        (value, slope)
    } else {
        let value = -e / a;
        (value, ((1.0 + e) - value) / a)
    }
}

/// The columns that the law makes, at the full rate of a segment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trace {
    /// `eta`.
    pub eta: Vec<f64>,
    /// `v - |v| eta / gh`, which the micro-damping multiplies; empty for a static law.
    pub rate: Vec<f64>,
    /// Derivatives of `eta` with respect to each nonlinear unknown.
    pub eta_slope: Vec<Vec<f64>>,
    /// Derivatives of `rate`.
    pub rate_slope: Vec<Vec<f64>>,
    /// The elements of a Maxwell-slip law; all above is then empty.
    pub elements: Vec<crate::gms::recursion::Element>,
}

impl Trace {
    /// `eta`, its rate, and the levels of the elements.
    pub fn own(&self) -> impl Iterator<Item = &Vec<f64>> {
        let elements = self.elements.iter().map(|element| &element.level);
        [&self.eta, &self.rate].into_iter().chain(elements)
    }

    /// Splits off the samples from `at` on.
    pub fn split_off(&mut self, at: usize) -> Self {
        let cut = |columns: &mut Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            columns.iter_mut().map(|c| c.split_off(at)).collect()
        };
        Self {
            eta_slope: cut(&mut self.eta_slope),
            rate_slope: cut(&mut self.rate_slope),
            eta: self.eta.split_off(at),
            rate: self.rate.split_off(at),
            elements: Vec::new(),
        }
    }
}

/// Runs the law along a velocity; `slopes` asks for the sensitivities too.
pub(crate) fn trace(law: &Law, p: &[f64], step: f64, velocity: &[f64], slopes: bool) -> Trace {
    if law.kind.has_elements() {
        return Trace {
            elements: crate::gms::recursion::trace(law, p, step, velocity, slopes),
            ..Trace::default()
        };
    }
    let layout = law.layout();
    let curve = Curve::new(law, &layout, p);
    if let (LawKind::ElastoPlastic, Some(i)) = (law.kind, layout.breakaway) {
        let bare = without_slopes(&layout);
        return match (slopes, layout.count) {
            (true, 4) => elasto_plastic::run::<4>(&layout, &curve, p[i], step, velocity),
            // With the Stribeck exponent.
            (true, 5) => elasto_plastic::run::<5>(&layout, &curve, p[i], step, velocity),
            (true, 7) => elasto_plastic::run::<7>(&layout, &curve, p[i], step, velocity),
            (true, 8) => elasto_plastic::run::<8>(&layout, &curve, p[i], step, velocity),
            _ => elasto_plastic::run::<0>(&bare, &curve, p[i], step, velocity),
        };
    }
    macro_rules! run {
        ($($k:literal),*) => {
            match (slopes, layout.count) {
                $((true, $k) => run::<$k>(law, &layout, &curve, step, velocity),)*
                _ => run::<0>(law, &without_slopes(&layout), &curve, step, velocity),
            }
        };
    }
    run!(1, 2, 3, 4, 5, 6, 7)
}

fn without_slopes(layout: &Layout) -> Layout {
    Layout {
        kappa: None,
        excess: [None; 2],
        velocity: [None; 2],
        ratio: None,
        breakaway: None,
        exponent: None,
        ..*layout
    }
}

fn run<const K: usize>(
    law: &Law,
    layout: &Layout,
    curve: &Curve,
    step: f64,
    velocity: &[f64],
) -> Trace {
    let n = velocity.len();
    let mut out = Trace {
        eta: vec![0.0; n],
        rate: Vec::new(),
        eta_slope: vec![vec![0.0; n]; K],
        rate_slope: Vec::new(),
        elements: Vec::new(),
    };
    if law.kind.has_bristle() {
        out.rate = vec![0.0; n];
        out.rate_slope = vec![vec![0.0; n]; K];
        bristle::<K>(layout, curve, step, velocity, &mut out);
    } else {
        for (i, &v) in velocity.iter().enumerate() {
            let sign = if v > 0.0 {
                1.0
            } else if v < 0.0 {
                -1.0
            } else {
                0.0
            };
            let g = level::<K>(curve, layout, v, usize::from(v < 0.0));
            out.eta[i] = sign * g.value;
            for k in 0..K {
                out.eta_slope[k][i] = sign * g.slope[k];
            }
        }
    }
    out
}

fn bristle<const K: usize>(
    layout: &Layout,
    curve: &Curve,
    step: f64,
    velocity: &[f64],
    out: &mut Trace,
) {
    let half = 0.5 * step * curve.kappa;
    let rest = [0, 1].map(|side| level::<K>(curve, layout, 0.0, side));
    let mut eta = 0.0;
    let mut eta_slope = [0.0; K];
    let mut before: Option<(f64, Level<K>)> = None;
    for (i, &v) in velocity.iter().enumerate() {
        let side = usize::from(v < 0.0);
        let now = level::<K>(curve, layout, v, side);
        if let Some((u, old)) = before {
            if u != 0.0 && v != 0.0 && (u < 0.0) != (v < 0.0) {
                let theta = u / (u - v);
                let first = usize::from(u < 0.0);
                let mut part =
                    |fraction: f64, a: f64, ga: &Level<K>, b: f64, gb: &Level<K>, s: f64| {
                        advance(
                            layout,
                            half * fraction,
                            a,
                            ga,
                            b,
                            gb,
                            s,
                            &mut eta,
                            &mut eta_slope,
                        );
                    };
                part(
                    theta,
                    u,
                    &old,
                    0.0,
                    &rest[first],
                    if u < 0.0 { -1.0 } else { 1.0 },
                );
                part(
                    v / (v - u),
                    0.0,
                    &rest[side],
                    v,
                    &now,
                    if v < 0.0 { -1.0 } else { 1.0 },
                );
            } else if u != 0.0 || v != 0.0 {
                // A step that starts or ends at rest counts for the direction in which it moves.
                let s = if u < 0.0 || v < 0.0 { -1.0 } else { 1.0 };
                let moving = usize::from(s < 0.0);
                let ga = if u == 0.0 { rest[moving] } else { old };
                let gb = if v == 0.0 { rest[moving] } else { now };
                advance(layout, half, u, &ga, v, &gb, s, &mut eta, &mut eta_slope);
            }
        }
        let pull = fabs(v) / now.value;
        out.eta[i] = eta;
        out.rate[i] = v - pull * eta;
        for (k, d) in eta_slope.iter().enumerate() {
            out.eta_slope[k][i] = *d;
            out.rate_slope[k][i] = -pull * (d - eta * now.slope[k] / now.value);
        }
        before = Some((v, now));
    }
}

/// One EXPLIN interval of one sign; `half` is `h kappa / 2`.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn advance<const K: usize>(
    layout: &Layout,
    half: f64,
    va: f64,
    ga: &Level<K>,
    vb: f64,
    gb: &Level<K>,
    s: f64,
    eta: &mut f64,
    eta_slope: &mut [f64; K],
) {
    let (qa, qb) = (half * fabs(va) / ga.value, half * fabs(vb) / gb.value);
    let a = (qa + qb).min(LONGEST_DECAY);
    let e = expm1(-a);
    let (ph, ph_slope) = phi(a, e);
    let (ea, eb) = (s * ga.value, s * gb.value);
    let gap = *eta - ea;
    let rise = eb - ea;
    for (k, d) in eta_slope.iter_mut().enumerate() {
        let mut a_slope = -(qa * ga.slope[k] / ga.value + qb * gb.slope[k] / gb.value);
        if layout.kappa == Some(k) {
            a_slope += a;
        }
        let (da, db) = (s * ga.slope[k], s * gb.slope[k]);
        let next = db + (*d - da) * (1.0 + e)
            - gap * (1.0 + e) * a_slope
            - (db - da) * ph
            - rise * ph_slope * a_slope;
        *d = if fabs(next) < LEAST_DERIVATIVE {
            0.0
        } else {
            next
        };
    }
    *eta = eb + gap * (1.0 + e) - rise * ph;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::separable::in_lanes::InLanes;
    use stiction_friction::{Damping, Direction, Shape, Stribeck};

    /// Curve of the tests: Fc 20 N, Fs 30 N, vs 5 mm/s.
    fn law(stiffness: f64) -> stiction_friction::LuGre<f64> {
        let both = Direction {
            coulomb: 20.0,
            static_friction: 30.0,
            stribeck_velocity: 5e-3,
            viscous: 0.0,
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
        stiction_friction::LuGre::new(stiffness, Damping::Constant(0.0), curve).unwrap()
    }

    fn unknowns(stiffness: f64) -> [f64; 3] {
        [log(stiffness / 20.0), log(0.5), log(5e-3)]
    }

    /// Intervals so long that the bristle follows its steady level at once; how far it lags behind is the
    /// inverse of their length.
    #[test]
    fn a_stiff_bristle_lags_as_the_friction_crate_says() {
        let velocity: Vec<f64> = (0..50).map(|k| 1e-4 * f64::from(k)).collect();
        for stiffness in [1e8, 1e9, 1e12] {
            let law = law(stiffness);
            let ours = Law::new(LawKind::LuGre);
            let found = trace(&ours, &unknowns(stiffness), 1e-2, &velocity, false);
            let mut z = 0.0;
            for (v, eta) in velocity.windows(2).zip(&found.eta[1..]) {
                z = law.step_record(z, 1e-2, v[0], v[1]);
                let right = stiffness * z / 20.0;
                assert!((eta - right).abs() < 1e-14, "{stiffness:e} {eta} {right}");
            }
        }
    }

    /// Derivatives that decay end at zero: no denormal numbers, which would be slow.
    #[test]
    fn derivatives_that_die_away_stay_normal() {
        let velocity = vec![0.02; 4000];
        let found = trace(
            &Law::new(LawKind::LuGre),
            &unknowns(2e6),
            1e-4,
            &velocity,
            true,
        );
        for column in found.eta_slope.iter().chain(&found.rate_slope) {
            assert!(column.iter().all(|x| *x == 0.0 || x.is_normal()));
        }
    }

    /// The kernels and the recursion compute the same law.
    #[test]
    fn lanes_and_recursion_agree() {
        let velocity: Vec<f64> = (0..3000)
            .map(|k| 0.02 * libm::sin(0.01 * f64::from(k)) * libm::sin(0.0013 * f64::from(k)))
            .collect();
        let parts = [&velocity[..1000], &velocity[1000..1001], &velocity[1001..]];
        let record = crate::conditioning::record::tests::of_velocities(1e-3, &parts);
        let symmetric = [LawKind::Dahl, LawKind::LuGre].map(Law::new);
        for law in symmetric {
            let kind = law.kind;
            let p = &unknowns(1.2e5)[..law.nonlinear()];
            let lanes = InLanes::motion(&record, &law).unwrap();
            let found = lanes.traces(p, true).unwrap();
            for (found, part) in found.iter().zip(parts) {
                let right = trace(&law, p, 1e-3, part, true);
                let pairs = |a: &Trace, b: &Trace| -> Vec<(Vec<f64>, Vec<f64>)> {
                    let all = |t: &Trace| {
                        let slopes = t.eta_slope.iter().chain(&t.rate_slope);
                        [&t.eta, &t.rate]
                            .into_iter()
                            .chain(slopes)
                            .cloned()
                            .collect()
                    };
                    let (a, b): (Vec<_>, Vec<_>) = (all(a), all(b));
                    assert_eq!(a.len(), b.len());
                    a.into_iter().zip(b).collect()
                };
                for (i, (found, right)) in pairs(found, &right).iter().enumerate() {
                    assert_eq!(found.len(), right.len());
                    let size = right.iter().fold(1e-3, |m: f64, x| m.max(x.abs()));
                    for (x, y) in found.iter().zip(right) {
                        assert!((x - y).abs() <= 1e-12 * size, "{kind} {i}: {x} {y}");
                    }
                }
            }
        }
    }

    /// The same with parameters for each direction, through reversals between samples, at rest and at the ends of blocks.
    #[test]
    fn lanes_and_recursion_agree_on_each_direction() {
        let wave = |k: usize| {
            let v = 0.02 * libm::sin(0.01 * k as f64) * libm::sin(0.0013 * k as f64 + 0.3);
            if k % 700 < 20 { 0.0 } else { v }
        };
        let mut velocity: Vec<f64> = (0..3000).map(wave).collect();
        for (k, v) in velocity.iter_mut().enumerate() {
            // Reversals from sample to sample, so that some stand at the ends of blocks.
            *v = if (1900..2300).contains(&k) && k % 3 == 0 {
                -*v
            } else {
                *v
            };
        }
        let parts = [&velocity[..1000], &velocity[1000..1001], &velocity[1001..]];
        let record = crate::conditioning::record::tests::of_velocities(1e-3, &parts);
        let weights = [17.0, 230.0];
        let lugre = Law::new(LawKind::LuGre).asymmetric();
        let power = Law {
            exponent: 1.3,
            ..lugre
        };
        for law in [
            lugre,
            lugre.flat(),
            power,
            Law::new(LawKind::Dahl).asymmetric(),
        ] {
            let all = [8.7, -0.7, -5.0, 0.3, -0.2, -5.6];
            let p = match law.nonlinear() {
                2 => &[8.7, 0.3][..],
                _ => &all[..],
            };
            let lanes = InLanes::motion(&record, &law).unwrap();
            let traces = lanes.traces(p, false).unwrap();
            let slopes = lanes.slopes(p, weights).unwrap();
            for ((found, slopes), part) in traces.iter().zip(&slopes).zip(parts) {
                let right = trace(&law, p, 1e-3, part, true);
                let near = |found: &[f64], right: &[f64], what: &str| {
                    assert_eq!(found.len(), right.len());
                    let size = right.iter().fold(1e-3, |m: f64, x| m.max(x.abs()));
                    for (i, (x, y)) in found.iter().zip(right).enumerate() {
                        assert!((x - y).abs() <= 1e-11 * size, "{law:?} {what} {i}: {x} {y}");
                    }
                };
                near(&found.eta, &right.eta, "eta");
                near(&found.rate, &right.rate, "rate");
                assert_eq!(slopes.len(), law.nonlinear());
                for (k, found) in slopes.iter().enumerate() {
                    let pairs = right.eta_slope[k].iter().zip(&right.rate_slope[k]);
                    let right: Vec<f64> = pairs
                        .map(|(e, r)| weights[0] * e + weights[1] * r)
                        .collect();
                    near(found, &right, &format!("slope {k}"));
                }
            }
        }
    }
}
