//! Reference motions.

use stiction_friction::ParamError;

/// The reference at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference {
    /// m (rad)
    pub position: f64,
    /// m/s (rad/s)
    pub velocity: f64,
    /// m/s^2 (rad/s^2)
    pub acceleration: f64,
}

/// One sine about the origin, faded in and out so that it starts and ends at rest there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine {
    /// Velocity amplitude, >= 0, m/s (rad/s). Exceeded during a fade shorter than half a period, by up to 45 %.
    pub speed: f64,
    /// Frequency, > 0, Hz.
    pub frequency: f64,
    /// Length, > 0, s.
    pub duration: f64,
    /// Time of the fade at either end, s, at most half the duration.
    pub fade: f64,
}

impl Sine {
    /// A sine with fades of half a period, or of half the duration if that is shorter.
    pub fn new(speed: f64, frequency: f64, duration: f64) -> Self {
        let fade = (0.5 / frequency).min(0.5 * duration);
        Sine {
            speed,
            frequency,
            duration,
            fade,
        }
    }

    fn validate(&self) -> Result<(), ParamError> {
        ParamError::not_negative("speed", self.speed)?;
        ParamError::positive("frequency", self.frequency)?;
        ParamError::positive("duration", self.duration)?;
        ParamError::not_negative("fade", self.fade)?;
        if 2.0 * self.fade > self.duration {
            return Err(ParamError::new(
                "fade",
                self.fade,
                "at most half the duration",
            ));
        }
        Ok(())
    }

    /// The reference `t` seconds after the segment's start, 0 <= t <= duration.
    fn at(&self, t: f64) -> Reference {
        let omega = 2.0 * std::f64::consts::PI * self.frequency;
        let amplitude = self.speed / omega;
        let (s, c) = (libm::sin(omega * t), libm::cos(omega * t));
        let (w, dw, ddw) = self.window(t);
        Reference {
            position: amplitude * w * s,
            velocity: amplitude * (dw * s + w * omega * c),
            acceleration: amplitude * (ddw * s + 2.0 * dw * omega * c - w * omega * omega * s),
        }
    }

    /// The fade and its first two derivatives in time: the quintic with zero slope and curvature at both ends.
    fn window(&self, t: f64) -> (f64, f64, f64) {
        let left = self.duration - t;
        let (inside, sign) = if t <= left { (t, 1.0) } else { (left, -1.0) };
        if inside >= self.fade {
            return (1.0, 0.0, 0.0);
        }
        let x = (inside / self.fade).max(0.0);
        let w = x * x * x * (10.0 - x * (15.0 - 6.0 * x));
        let dw = 30.0 * x * x * (1.0 - x) * (1.0 - x);
        let ddw = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x);
        (w, sign * dw / self.fade, ddw / (self.fade * self.fade))
    }
}

/// Sines one after the other, at rest at the origin before, between and after them.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    segments: Vec<Sine>,
}

impl Path {
    /// At least one segment.
    pub fn new(segments: Vec<Sine>) -> Result<Self, ParamError> {
        if segments.is_empty() {
            return Err(ParamError::new("segments", 0.0, "at least one"));
        }
        segments.iter().try_for_each(Sine::validate)?;
        Ok(Path { segments })
    }

    /// One sine of velocity amplitude `speed` (m/s, rad/s) and `frequency` (Hz) for `duration` seconds.
    pub fn sine(speed: f64, frequency: f64, duration: f64) -> Result<Self, ParamError> {
        Path::new(vec![Sine::new(speed, frequency, duration)])
    }

    /// An excitation that determines all LuGre parameters: fast and slow for Fc, sigma2 and mass, slow around vs
    /// for the Stribeck curve, small and quick for the bristles.
    ///
    /// `speed` is the velocity amplitude of the fast part, m/s (rad/s); the others are 0.0189 and 0.128 of it, at 1, 1.2
    /// and 28 Hz: 196, 3.7 and 25 mm/s for the axis it was designed on. Each lasts a third of `duration` seconds.
    pub fn three_segments(speed: f64, duration: f64) -> Result<Self, ParamError> {
        let each = duration / 3.0;
        let part = |share: f64, frequency: f64| Sine::new(share * speed, frequency, each);
        Path::new(vec![part(1.0, 1.0), part(0.0189, 1.2), part(0.128, 28.0)])
    }

    /// The parts in their order.
    pub fn segments(&self) -> &[Sine] {
        &self.segments
    }

    /// Total length, s.
    pub fn duration(&self) -> f64 {
        self.segments.iter().map(|s| s.duration).sum()
    }

    /// The reference at time `t`, s; at rest at the origin outside 0..=duration.
    pub fn at(&self, t: f64) -> Reference {
        let mut start = 0.0;
        for segment in &self.segments {
            let inside = t - start;
            if inside < 0.0 {
                break;
            }
            if inside <= segment.duration {
                return segment.at(inside);
            }
            start += segment.duration;
        }
        Reference::default()
    }
}
