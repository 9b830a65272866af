//! The explicit schemes of [`stiction_friction::explicit`], candidates in lanes; for comparison.

use super::terms::Scheme;
use crate::exp::{at_most, exp};
use crate::lane_array::lanes;
use crate::track::{KEPT, RESTART, SAMPLE};
use crate::{Candidate, Track};
use stiction_dispatch::Kernel;

pub(super) struct Explicit<'a, const N: usize> {
    track: &'a Track,
    lanes: [Candidate; N],
    ln_velocity: [f64; N],
    used: usize,
    scheme: Scheme,
}

impl<'a, const N: usize> Explicit<'a, N> {
    pub fn new(track: &'a Track, group: &[Candidate], scheme: Scheme) -> Self {
        Explicit {
            track,
            lanes: lanes(group, |c| *c),
            ln_velocity: lanes(group, |c| libm::log(c.stribeck_velocity)),
            used: group.len(),
            scheme,
        }
    }
}

/// `sigma0 |v|/g(v)`, 1/s.
#[inline(always)]
fn pull(c: &Candidate, ln_velocity: f64, v: f64, ln: f64) -> f64 {
    let x = v / c.stribeck_velocity;
    let power = exp(at_most(c.exponent * (ln - ln_velocity), 7.0));
    let power = if c.exponent == 2.0 { x * x } else { power };
    let g = c.coulomb + (c.static_friction - c.coulomb) * exp(-power);
    c.stiffness * (v.abs() / g)
}

impl<const N: usize> Kernel for Explicit<'_, N> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run(self) -> Vec<f64> {
        let track = self.track;
        let runge_kutta = self.scheme == Scheme::RungeKutta;
        let (mut z, mut cost) = ([0.0; N], [0.0; N]);
        let mut pull_before = [0.0; N];
        let (mut before, mut h) = (0.0, 0.0);
        for (k, marks) in track.marks.iter().enumerate() {
            // Reversals between samples are not nodes of these schemes.
            h += 2.0 * track.half_step[k];
            if marks & SAMPLE == 0 {
                continue;
            }
            let v = f64::from(track.sign[k]) * track.speed[k];
            let force = f64::from(track.sign[k]) * track.force[k];
            let middle = 0.5 * (before + v);
            let ln = libm::log(track.speed[k]);
            let ln_middle = libm::log(middle.abs());
            for j in 0..N {
                let (c, ln_velocity) = (&self.lanes[j], self.ln_velocity[j]);
                let now = pull(c, ln_velocity, v, ln);
                let a = before - pull_before[j] * z[j];
                let slope = if runge_kutta {
                    let p = pull(c, ln_velocity, middle, ln_middle);
                    let b = middle - p * (z[j] + 0.5 * h * a);
                    let d = middle - p * (z[j] + 0.5 * h * b);
                    let e = v - now * (z[j] + h * d);
                    (a + 2.0 * b + 2.0 * d + e) / 6.0
                } else {
                    a
                };
                let next = z[j] + h * slope;
                z[j] = if marks & RESTART != 0 { 0.0 } else { next };
                if marks & KEPT != 0 {
                    let rate = v - now * z[j];
                    let e = force - (c.stiffness * z[j] + c.micro_damping * rate + c.viscous * v);
                    cost[j] += e * e;
                }
                pull_before[j] = now;
            }
            before = v;
            h = 0.0;
        }
        cost[..self.used].to_vec()
    }
}
