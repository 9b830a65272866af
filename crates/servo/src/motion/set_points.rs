//! Recorded set points as a reference.

use crate::path::Reference;
use crate::trajectory::Trajectory;
use stiction_friction::ParamError;

/// Positions at given times, and between them polynomials of fifth order that take over position, velocity and
/// acceleration at each point: those of the parabola through it and its neighbours. Acceleration is continuous, and an axis
/// at rest in the points is at rest between them. Starts and ends at rest; positions and times count from the first.
#[derive(Clone, Debug, PartialEq)]
pub struct SetPoints {
    times: Vec<f64>,
    positions: Vec<f64>,
}

impl SetPoints {
    /// At least two positions, m (rad), all finite, at `rate` > 0, Hz.
    pub fn new(rate: f64, positions: Vec<f64>) -> Result<Self, ParamError> {
        ParamError::positive("rate", rate)?;
        let times = (0..positions.len()).map(|k| k as f64 / rate).collect();
        SetPoints::timed(times, positions)
    }

    /// At least two positions, m (rad), all finite, at as many ascending times, s.
    pub fn timed(mut times: Vec<f64>, mut positions: Vec<f64>) -> Result<Self, ParamError> {
        if positions.len() < 2 {
            let found = positions.len() as f64;
            return Err(ParamError::new("set_points", found, "at least two"));
        }
        if times.len() != positions.len() {
            let found = times.len() as f64;
            return Err(ParamError::new("times", found, "as many as positions"));
        }
        for (&time, &position) in times.iter().zip(&positions) {
            ParamError::finite("time", time)?;
            ParamError::finite("set_point", position)?;
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(ParamError::new(
                "time",
                pair[1],
                "later than the one before",
            ));
        }
        let (begin, origin) = (times[0], positions[0]);
        times.iter_mut().for_each(|t| *t -= begin);
        positions.iter_mut().for_each(|x| *x -= origin);
        Ok(SetPoints { times, positions })
    }

    /// Velocity and acceleration at a point.
    fn slopes(&self, i: usize) -> (f64, f64) {
        if i == 0 || i + 1 == self.times.len() {
            return (0.0, 0.0);
        }
        let (t, x) = (&self.times, &self.positions);
        let (before, after) = (t[i] - t[i - 1], t[i + 1] - t[i]);
        let from = (x[i] - x[i - 1]) / before;
        let to = (x[i + 1] - x[i]) / after;
        let both = before + after;
        (
            (after * from + before * to) / both,
            2.0 * (to - from) / both,
        )
    }
}

impl Trajectory for SetPoints {
    fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn at(&self, t: f64) -> Reference {
        if t.is_nan() || t <= 0.0 {
            return Reference::default();
        }
        let last = self.times.len() - 1;
        if t >= self.times[last] {
            return Reference {
                position: self.positions[last],
                ..Reference::default()
            };
        }
        let i = self.times.partition_point(|time| *time <= t) - 1;
        let h = self.times[i + 1] - self.times[i];
        let s = (t - self.times[i]) / h;
        let ((v, a), (w, b)) = (self.slopes(i), self.slopes(i + 1));
        // In units of the stretch: the error of the first point's parabola at the second point.
        let (v, w, a, b) = (h * v, h * w, 0.5 * h * h * a, h * h * b);
        let position = self.positions[i + 1] - self.positions[i] - v - a;
        let velocity = w - v - 2.0 * a;
        let acceleration = b - 2.0 * a;
        let c3 = 10.0 * position - 4.0 * velocity + 0.5 * acceleration;
        let c4 = -15.0 * position + 7.0 * velocity - acceleration;
        let c5 = 6.0 * position - 3.0 * velocity + 0.5 * acceleration;
        let s2 = s * s;
        Reference {
            position: self.positions[i] + s * (v + s * (a + s * (c3 + s * (c4 + s * c5)))),
            velocity: (v + s * (2.0 * a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h,
            acceleration: (2.0 * a + s * (6.0 * c3 + s * 12.0 * c4) + 20.0 * s2 * s * c5) / (h * h),
        }
    }
}
