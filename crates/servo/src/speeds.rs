//! A reference of constant speeds, one after the other: the motion of a static map.

use crate::path::Reference;
use stiction_friction::ParamError;

/// Constant speeds, each reached and left by a ramp, at rest in between.
#[derive(Clone, Debug, PartialEq)]
pub struct Speeds {
    runs: Vec<SpeedRun>,
}

/// One constant speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedRun {
    /// Velocity, m/s (rad/s); its sign is the direction.
    pub velocity: f64,
    /// Time at that velocity, > 0, s.
    pub hold: f64,
    /// Time from rest to it and back, > 0, s.
    pub ramp: f64,
}

impl SpeedRun {
    fn duration(&self) -> f64 {
        self.hold + 2.0 * self.ramp
    }

    /// The reference `t` seconds after the run's start, from its own origin.
    fn at(&self, t: f64) -> Reference {
        let (v, a) = (self.velocity, self.velocity / self.ramp);
        let left = self.duration() - t;
        let whole = v * (self.hold + self.ramp);
        let (position, velocity, acceleration) = if t < self.ramp {
            (0.5 * a * t * t, a * t, a)
        } else if left > self.ramp {
            (v * (t - 0.5 * self.ramp), v, 0.0)
        } else {
            (whole - 0.5 * a * left * left, a * left, -a)
        };
        Reference {
            position,
            velocity,
            acceleration,
        }
    }
}

impl Speeds {
    /// Runs one after the other; at least one.
    pub fn new(runs: Vec<SpeedRun>) -> Result<Self, ParamError> {
        if runs.is_empty() {
            return Err(ParamError::new("runs", 0.0, "at least one"));
        }
        for run in &runs {
            ParamError::finite("velocity", run.velocity)?;
            ParamError::positive("hold", run.hold)?;
            ParamError::positive("ramp", run.ramp)?;
        }
        Ok(Self { runs })
    }

    /// `count` speeds from `low` to `high` (m/s, rad/s; both > 0), spaced evenly in their logarithm,
    /// each forth and back. Each lasts `travel / speed` seconds (m, rad), within `hold` (s).
    pub fn ladder(
        (low, high): (f64, f64),
        count: usize,
        travel: f64,
        hold: (f64, f64),
        ramp: f64,
    ) -> Result<Self, ParamError> {
        ParamError::positive("low", low)?;
        ParamError::positive("high", high)?;
        ParamError::positive("travel", travel)?;
        ParamError::positive("hold", hold.0)?;
        if hold.1.is_nan() || hold.1 < hold.0 {
            return Err(ParamError::new("hold", hold.1, "not below its lower end"));
        }
        let step = libm::log(high / low) / count.saturating_sub(1).max(1) as f64;
        let runs = (0..count)
            .map(|i| low * libm::exp(step * i as f64))
            .flat_map(|v| [v, -v])
            .map(|velocity| SpeedRun {
                velocity,
                hold: (travel / velocity.abs()).clamp(hold.0, hold.1),
                ramp,
            });
        Self::new(runs.collect())
    }

    /// The runs in their order.
    pub fn runs(&self) -> &[SpeedRun] {
        &self.runs
    }

    /// Total length, s.
    pub fn duration(&self) -> f64 {
        self.runs.iter().map(SpeedRun::duration).sum()
    }

    /// The reference at time `t`, s; at rest before and after.
    pub fn at(&self, t: f64) -> Reference {
        let (mut start, mut origin) = (0.0, 0.0);
        for run in &self.runs {
            let inside = t - start;
            if inside < 0.0 {
                break;
            }
            if inside <= run.duration() {
                let here = run.at(inside);
                return Reference {
                    position: origin + here.position,
                    ..here
                };
            }
            start += run.duration();
            origin += run.velocity * (run.hold + run.ramp);
        }
        Reference {
            position: origin,
            ..Reference::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Speeds;

    #[test]
    fn position_velocity_and_acceleration_belong_together() {
        let speeds = Speeds::ladder((0.01, 1.0), 5, 0.1, (0.2, 2.0), 0.05).unwrap();
        assert_eq!(speeds.runs().len(), 10);
        let h = 1e-6;
        let mut held = 0;
        for k in 1..2000 {
            let t = speeds.duration() * f64::from(k) / 2000.0;
            let (a, b, c) = (speeds.at(t - h), speeds.at(t), speeds.at(t + h));
            let slope = (c.position - a.position) / (2.0 * h);
            assert!((slope - b.velocity).abs() < 1e-3, "{t}: {slope}");
            held += usize::from(b.acceleration == 0.0);
        }
        assert!(held > 1500);
        // Forth and back ends where it began.
        assert!(speeds.at(2.0 * speeds.duration()).position.abs() < 1e-12);
    }
}
