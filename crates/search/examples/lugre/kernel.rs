//! The six-parameter LuGre force along a known velocity, many candidates side by side, and its
//! derivatives: EXPLIN, as `stiction_friction::LuGre::step_record` defines it.
//!
//! Candidates are `[sigma0, sigma1, sigma2, Fc, Fs, vs]`; Fs may lie below Fc, as it does in part of a
//! box that gives each its own range.

use crate::record::Record;

const LANES: usize = 16;
type Lane = [f64; LANES];

/// `exp(x)` for `x <= 0`, to 1e-15 relative; below -300 what it is at -300, so that no product of it
/// is too small to be computed with at full speed.
#[inline(always)]
fn exp(x: f64) -> f64 {
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
    let x = if x < -300.0 { -300.0 } else { x };
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = x - n * 6.931_471_803_691_238e-1 - n * 1.908_214_929_270_587_7e-10;
    let mut p = 1.0 / 39_916_800.0;
    for c in [
        3_628_800.0,
        362_880.0,
        40_320.0,
        5_040.0,
        720.0,
        120.0,
        24.0,
        6.0,
        2.0,
        1.0,
        1.0,
    ] {
        p = p * r + 1.0 / c;
    }
    let power = shifted
        .to_bits()
        .wrapping_sub(ROUND.to_bits())
        .wrapping_add(1023)
        << 52;
    p * f64::from_bits(power)
}

/// `(1 - exp(-a)) / a` with `e = exp(-a)`.
#[inline(always)]
fn phi(a: f64, e: f64) -> f64 {
    let series = 1.0 - a * (0.5 - a * (1.0 / 6.0 - a * (1.0 / 24.0)));
    if a < 1e-3 { series } else { (1.0 - e) / a }
}

/// Mean square of measured minus model force, for each candidate.
pub fn costs(record: &Record, candidates: &[[f64; 6]], out: &mut [f64]) {
    for (some, out) in candidates.chunks(LANES).zip(out.chunks_mut(LANES)) {
        let pick = |k: usize| -> Lane { std::array::from_fn(|i| some[i.min(some.len() - 1)][k]) };
        let sums = run(record, &std::array::from_fn(pick));
        for (o, s) in out.iter_mut().zip(sums) {
            *o = s / record.counted;
        }
    }
}

#[inline(never)]
fn run(record: &Record, p: &[Lane; 6]) -> Lane {
    let [s0, s1, s2, fc, fs, vs] = p;
    let mut sums = [0.0; LANES];
    let mut eta = [0.0; LANES];
    let mut level = *fs;
    let mut pull = [0.0; LANES];
    let mut inverse = [0.0; LANES];
    for i in 0..LANES {
        inverse[i] = 1.0 / vs[i];
    }
    for point in &record.points {
        let (v, half, sign) = (point.velocity, 0.5 * point.step, point.sign);
        let (speed, weight, force) = (v.abs(), point.weight, point.force);
        for i in 0..LANES {
            let x = v * inverse[i];
            let g = fc[i] + (fs[i] - fc[i]) * exp(-x * x);
            let q = speed / g;
            let a = half * s0[i] * (pull[i] + q);
            let e = exp(-a);
            let (from, to) = (sign * level[i], sign * g);
            eta[i] = to + (eta[i] - from) * e - (to - from) * phi(a, e);
            level[i] = g;
            pull[i] = q;
            let model = eta[i] + s1[i] * (v - q * eta[i]) + s2[i] * v;
            let r = weight * (force - model);
            sums[i] += r * r;
        }
    }
    sums
}

/// Mean square, gradient and normal matrix of one candidate, with respect to the natural logarithms
/// of its parameters; the residual is model minus measured.
pub fn derivatives(record: &Record, p: &[f64; 6]) -> (f64, [f64; 6], [[f64; 6]; 6]) {
    let [s0, s1, s2, fc, fs, vs] = *p;
    // Slopes of eta with respect to ln s0, ln Fc, ln Fs, ln vs.
    const K: usize = 4;
    let mut cost = 0.0;
    let mut gradient = [0.0f64; 6];
    let mut normal = [[0.0f64; 6]; 6];
    let (mut eta, mut slopes) = (0.0, [0.0; K]);
    let (mut level, mut level_slopes) = (fs, [0.0, 0.0, fs, 0.0]);
    let mut pull = 0.0;
    for point in &record.points {
        let (v, half, sign) = (point.velocity, 0.5 * point.step, point.sign);
        let x2 = (v / vs) * (v / vs);
        let fall = exp(-x2);
        let g = fc + (fs - fc) * fall;
        let g_slopes = [
            0.0,
            fc * (1.0 - fall),
            fs * fall,
            if fall > 1e-100 {
                (fs - fc) * fall * 2.0 * x2
            } else {
                0.0
            },
        ];
        let q = v.abs() / g;
        let a = half * s0 * (pull + q);
        let e = exp(-a);
        let f = phi(a, e);
        let f_slope = if a < 1e-3 {
            -0.5 + a / 3.0
        } else {
            (e - f) / a
        };
        let (from, to) = (sign * level, sign * g);
        let (gap, rise) = (eta - from, to - from);
        for k in 0..K {
            let mut a_slope = -half * s0 * (pull * level_slopes[k] / level + q * g_slopes[k] / g);
            if k == 0 {
                a_slope += a;
            }
            let (dfrom, dto) = (sign * level_slopes[k], sign * g_slopes[k]);
            slopes[k] = dto + (slopes[k] - dfrom) * e
                - gap * e * a_slope
                - (dto - dfrom) * f
                - rise * f_slope * a_slope;
        }
        eta = to + gap * e - rise * f;
        (level, level_slopes, pull) = (g, g_slopes, q);
        if point.weight == 0.0 {
            continue;
        }
        let rate = v - q * eta;
        let r = eta + s1 * rate + s2 * v - point.force;
        let by = |k: usize| slopes[k] * (1.0 - s1 * q) + s1 * q * eta * g_slopes[k] / g;
        let j = [by(0), s1 * rate, s2 * v, by(1), by(2), by(3)];
        cost += r * r;
        for m in 0..6 {
            gradient[m] += j[m] * r;
            for n in 0..=m {
                normal[m][n] += j[m] * j[n];
            }
        }
    }
    let mean = 1.0 / record.counted;
    let whole = |m: usize, n: usize| mean * normal[m.max(n)][m.min(n)];
    let normal = std::array::from_fn(|m| std::array::from_fn(|n| whole(m, n)));
    (mean * cost, gradient.map(|g| mean * g), normal)
}
