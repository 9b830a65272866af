//! The pieces of a motion.

mod bounds;
mod window;

pub use bounds::Extremes;

use stiction_friction::ParamError;
use stiction_servo::motion::{Limits, Profile};
use window::Window;

/// A piece of a motion: from rest where the axis stands, back to rest there, so that pieces join in any order.
///
/// All numbers are analytic functions of time, so that any carrier can sample them at its own rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Atom {
    /// A sine, `amplitude w(t) sin(2 pi frequency t)`, faded in and out by the quintic `w = s^3 (10 - 15 s + 6 s^2)`.
    Sine {
        /// Of the position, > 0, m (rad).
        amplitude: f64,
        /// > 0, Hz.
        frequency: f64,
        /// > 0, s.
        duration: f64,
        /// Time of the fade at the beginning, > 0, s. Near the whole duration: a sine that grows.
        fade_in: f64,
        /// Time of the fade at the end, > 0, s; both fades together at most the duration.
        fade_out: f64,
    },
    /// There and back, each way jerk-limited in seven phases, without a rest in between.
    Move {
        /// There, of either sign, not 0, m (rad).
        distance: f64,
        /// Largest speed, > 0, m/s (rad/s).
        speed: f64,
        /// Largest acceleration, > 0, m/s^2 (rad/s^2).
        acceleration: f64,
        /// > 0, m/s^3 (rad/s^3).
        jerk: f64,
    },
}

/// The reference at an instant, relative to where the motion starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instant {
    /// m (rad)
    pub position: f64,
    /// m/s (rad/s)
    pub velocity: f64,
    /// m/s^2 (rad/s^2)
    pub acceleration: f64,
    /// m/s^3 (rad/s^3); where it steps, the later value.
    pub jerk: f64,
}

impl Atom {
    /// Refuses numbers out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        match *self {
            Atom::Sine {
                amplitude,
                frequency,
                duration,
                fade_in,
                fade_out,
            } => {
                ParamError::positive("amplitude", amplitude)?;
                ParamError::positive("frequency", frequency)?;
                ParamError::positive("duration", duration)?;
                ParamError::positive("fade_in", fade_in)?;
                ParamError::positive("fade_out", fade_out)?;
                if fade_in + fade_out > duration {
                    let allowed = "both fades together at most the duration";
                    return Err(ParamError::new("fade_in", fade_in, allowed));
                }
                Ok(())
            }
            Atom::Move { distance, .. } => {
                if distance == 0.0 {
                    return Err(ParamError::new("distance", distance, "not 0"));
                }
                self.profile().map(|_| ())
            }
        }
    }

    /// Time from rest to rest, s; 0 of numbers that are out of range.
    pub fn duration(&self) -> f64 {
        match *self {
            Atom::Sine { duration, .. } => duration,
            Atom::Move { .. } => self.profile().map_or(0.0, |there| 2.0 * there.duration()),
        }
    }

    /// The reference `t` seconds after the start of the piece; at rest before and after.
    pub fn at(&self, t: f64) -> Instant {
        match *self {
            Atom::Sine { duration, .. } if !(t > 0.0 && t < duration) => Instant::default(),
            Atom::Sine {
                amplitude,
                frequency,
                duration,
                fade_in,
                fade_out,
            } => {
                let omega = std::f64::consts::TAU * frequency;
                let w = Window {
                    duration,
                    fade_in,
                    fade_out,
                }
                .at(t);
                let (s, c) = (libm::sin(omega * t), libm::cos(omega * t));
                let (o2, o3) = (omega * omega, omega * omega * omega);
                Instant {
                    position: amplitude * w[0] * s,
                    velocity: amplitude * (w[1] * s + w[0] * omega * c),
                    acceleration: amplitude * ((w[2] - w[0] * o2) * s + 2.0 * w[1] * omega * c),
                    jerk: amplitude
                        * ((w[3] - 3.0 * w[1] * o2) * s + (3.0 * w[2] * omega - w[0] * o3) * c),
                }
            }
            Atom::Move { distance, .. } => {
                let Ok(there) = self.profile() else {
                    return Instant::default();
                };
                let half = there.duration();
                let (inside, sign, origin) = match t < half {
                    true => (t, 1.0, 0.0),
                    false => (t - half, -1.0, distance),
                };
                // After the end it is where it began.
                if inside >= half {
                    return Instant::default();
                }
                let at = there.at(inside);
                Instant {
                    position: origin + sign * at.position,
                    velocity: sign * at.velocity,
                    acceleration: sign * at.acceleration,
                    jerk: sign * there.jerk_at(inside),
                }
            }
        }
    }

    /// The way there of a move.
    fn profile(&self) -> Result<Profile, ParamError> {
        match *self {
            Atom::Move {
                distance,
                speed,
                acceleration,
                jerk,
            } => Profile::new(
                distance,
                Limits {
                    velocity: speed,
                    acceleration,
                    jerk,
                },
            ),
            Atom::Sine { amplitude, .. } => Err(ParamError::new("amplitude", amplitude, "a move")),
        }
    }

    /// The same piece, smaller: the sine at a part of its amplitude, the move at a part of its distance, speed, acceleration
    /// and jerk.
    #[must_use]
    pub fn scaled(self, by: f64) -> Self {
        match self {
            Atom::Sine {
                amplitude,
                frequency,
                duration,
                fade_in,
                fade_out,
            } => Atom::Sine {
                amplitude: by * amplitude,
                frequency,
                duration,
                fade_in,
                fade_out,
            },
            Atom::Move {
                distance,
                speed,
                acceleration,
                jerk,
            } => Atom::Move {
                distance: by * distance,
                speed: by * speed,
                acceleration: by * acceleration,
                jerk: by * jerk,
            },
        }
    }
}
