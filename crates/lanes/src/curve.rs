//! The law in units of its Coulomb level, for one lane, and its interval EXPLIN.
//!
//! With `y = sigma0 |z|/Fc`, positive in the direction of motion, `g = 1 + (Fs/Fc - 1) exp(-|v/vs|^delta)`
//! and `kappa = sigma0/Fc`, the step of [`stiction_friction::LuGre::step_record`] is a linear recursion in
//! the deviation `w = y - g` from the steady deflection:
//!
//! ```text
//! A  = h kappa/2 (va/ga + vb/gb)
//! w+ = exp(-A) w - (gb - ga) (1 - exp(-A))/A
//! ```
//!
//! What a node contributes depends on its speed only, never on w: levels and decays of many nodes or many
//! candidates are computed side by side, and the recursion is left with one fused multiply-add.

use crate::exp::{LONGEST_DECAY, at_least, at_most, decays, exp, fma};

/// Nonlinear parameters of one candidate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    /// `-kappa`, < 0.
    pub rate: f64,
    /// `Fs/Fc - 1`.
    pub excess: f64,
    /// `-1/vs^2`.
    pub fall: f64,
    pub exponent: f64,
    pub ln_velocity: f64,
}

impl Curve {
    pub fn new(kappa: f64, excess: f64, velocity: f64, exponent: f64) -> Self {
        Curve {
            rate: -kappa,
            excess,
            // Limited to a finite number, so that its product with a speed of 0 is 0 and not NaN.
            fall: (-1.0 / (velocity * velocity)).max(-1e300),
            exponent,
            ln_velocity: libm::log(velocity),
        }
    }
}

/// The speed of a node, as stored in the track.
#[derive(Clone, Copy)]
pub(crate) struct Speed {
    pub value: f64,
    /// Read for exponents other than 2 only.
    pub ln: f64,
}

/// What a node contributes: its level `g`, and `q = -kappa v/g`.
#[derive(Clone, Copy)]
pub(crate) struct Node {
    pub g: f64,
    pub q: f64,
}

/// Before the first node: unloaded.
pub(crate) const START: Node = Node { g: 1.0, q: 0.0 };

/// Added wherever a deviation could decay to subnormal numbers, with which arithmetic is slow.
pub(crate) const SUBNORMAL_GUARD: f64 = 1e-140;

/// The weights of an interval: `w+ = keep w + add`.
#[derive(Clone, Copy)]
pub(crate) struct Interval {
    pub keep: f64,
    pub add: f64,
}

impl Curve {
    /// `-|v/vs|^delta`; `POWER` says whether any exponent in the batch differs from 2.
    #[inline(always)]
    pub fn exponent<const POWER: bool>(&self, v: Speed) -> f64 {
        let gaussian = v.value * v.value * self.fall;
        if !POWER {
            return gaussian;
        }
        // The power is limited to exp(7), about 1100: above 1000 the excess has vanished.
        let power = exp(at_most(self.exponent * (v.ln - self.ln_velocity), 7.0));
        if self.exponent == 2.0 {
            gaussian
        } else {
            -power
        }
    }

    #[inline(always)]
    fn level<const POWER: bool>(&self, v: Speed) -> f64 {
        fma(self.excess, exp(self.exponent::<POWER>(v)), 1.0)
    }

    /// Two nodes with one division.
    #[inline(always)]
    pub fn nodes<const POWER: bool>(&self, v: [Speed; 2]) -> [Node; 2] {
        let (g0, g1) = (self.level::<POWER>(v[0]), self.level::<POWER>(v[1]));
        let inverse = self.rate / (g0 * g1);
        [
            Node {
                g: g0,
                q: v[0].value * (g1 * inverse),
            },
            Node {
                g: g1,
                q: v[1].value * (g0 * inverse),
            },
        ]
    }
}

/// Two intervals with one division, each between two nodes; half steps in s.
#[inline(always)]
pub(crate) fn intervals(half: [f64; 2], ends: [[Node; 2]; 2]) -> [Interval; 2] {
    let x = |i: usize| at_least(half[i] * (ends[i][0].q + ends[i][1].q), LONGEST_DECAY);
    let decays = decays([x(0), x(1)]);
    let interval = |i: usize| Interval {
        keep: decays[i].keep,
        add: fma(ends[i][0].g - ends[i][1].g, decays[i].mean, SUBNORMAL_GUARD),
    };
    [interval(0), interval(1)]
}

/// The deviation seen in the other direction, at a standstill where the level is `g`.
#[inline(always)]
pub(crate) fn reversed(w: f64, g: f64) -> f64 {
    fma(-2.0, g, -w)
}
