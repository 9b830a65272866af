//! The extremes of a piece between samples too.

use super::window::LARGEST;
use super::{Atom, Instant};

/// Bounds of a piece, or of a motion: it never leaves them, at any instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extremes {
    /// Least and largest position, relative to where it starts, m (rad).
    pub position: [f64; 2],
    /// Largest speed, m/s (rad/s).
    pub speed: f64,
    /// Largest acceleration either way, m/s^2 (rad/s^2).
    pub acceleration: f64,
    /// Largest jerk either way, m/s^3 (rad/s^3).
    pub jerk: f64,
}

/// Samples of a period of a sine at which it is evaluated: the bound between them is then within 0.2 % of the extreme.
const PER_PERIOD: f64 = 64.0;
/// Fewest samples of a fade.
const PER_FADE: f64 = 64.0;
/// Rounding of the evaluation and of the sum of positions, relative.
const ROUNDING: f64 = 1e-12;

impl Extremes {
    /// Bounds of both.
    #[must_use]
    pub fn with(self, other: Extremes) -> Extremes {
        let [low, high] = self.position;
        Extremes {
            position: [low.min(other.position[0]), high.max(other.position[1])],
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
            jerk: self.jerk.max(other.jerk),
        }
    }
}

impl Atom {
    /// Bounds of the piece.
    ///
    /// A move is made of cubics whose extremes lie at their joints, so the bounds are the extremes. Of a sine, each function f of time
    /// is evaluated on a grid of step d, and `|f| <= max over the grid + d^2/8 max|f''|` in between, with the largest `|f''|` from
    /// the analytic derivatives of window and sine; its fades and the part between them are taken one by one, as the third
    /// derivative of the window steps where they meet.
    pub fn extremes(&self) -> Extremes {
        let wide = 1.0 + ROUNDING;
        match *self {
            Atom::Move { distance, jerk, .. } => {
                let Ok(there) = self.profile() else {
                    return Extremes::default();
                };
                Extremes {
                    position: [wide * distance.min(0.0), wide * distance.max(0.0)],
                    speed: wide * there.peak_speed(),
                    acceleration: wide * there.peak_acceleration(),
                    jerk,
                }
            }
            Atom::Sine {
                amplitude,
                frequency,
                duration,
                fade_in,
                fade_out,
            } => {
                let omega = std::f64::consts::TAU * frequency;
                let middle = duration - fade_in - fade_out;
                let mut bounds = [0.0; 4];
                if middle > 0.0 {
                    // The plain sine.
                    for (n, bound) in bounds.iter_mut().enumerate() {
                        *bound = amplitude * power(omega, n as i32);
                    }
                }
                let fades = [(0.0, fade_in), (duration - fade_out, fade_out)];
                for (from, fade) in fades {
                    let here = faded(self, (from, fade), amplitude, omega);
                    for (bound, here) in bounds.iter_mut().zip(here) {
                        *bound = bound.max(here);
                    }
                }
                let [position, speed, acceleration, jerk] = bounds.map(|bound| wide * bound);
                Extremes {
                    position: [-position, position],
                    speed,
                    acceleration,
                    jerk,
                }
            }
        }
    }
}

/// Bounds of position, velocity, acceleration and jerk over a fade.
fn faded(atom: &Atom, (from, fade): (f64, f64), amplitude: f64, omega: f64) -> [f64; 4] {
    let periods = fade * omega / std::f64::consts::TAU;
    let steps = libm::ceil((PER_PERIOD * periods).max(PER_FADE));
    let step = fade / steps;
    let mut largest = [0.0_f64; 4];
    for k in 0..=steps as usize {
        // A little inside: at its ends the jerk is that of the neighbour.
        let t = from + (step * k as f64).clamp(1e-12 * fade, (1.0 - 1e-12) * fade);
        let Instant {
            position,
            velocity,
            acceleration,
            jerk,
        } = atom.at(t);
        for (largest, x) in largest
            .iter_mut()
            .zip([position, velocity, acceleration, jerk])
        {
            *largest = largest.max(x.abs());
        }
    }
    std::array::from_fn(|n| {
        // |(w s)^(m)| <= sum of binomials times |w^(k)| omega^(m - k).
        let m = n + 2;
        let mut curvature = 0.0;
        let mut binomial = 1.0;
        for (k, window) in LARGEST.iter().enumerate().take(m + 1) {
            curvature += binomial * window / power(fade, k as i32) * power(omega, (m - k) as i32);
            binomial *= (m - k) as f64 / (k + 1) as f64;
        }
        largest[n] + 0.125 * step * step * amplitude * curvature
    })
}

/// `x` to a small whole power, by products: the same bits everywhere.
fn power(x: f64, n: i32) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}
