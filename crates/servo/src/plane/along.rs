//! The motion along a contour.

use super::curve::{Curve, Deviation, Place};
use crate::motion::{Limits, Profile, SetPoints};
use crate::path::Reference;
use crate::trajectory::Trajectory;
use stiction_friction::ParamError;

/// Both references at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Station {
    /// The references of both axes.
    pub axes: [Reference; 2],
    /// The parameter of the curve.
    pub parameter: f64,
}

/// A contour over time.
pub trait PlaneMotion: Curve {
    /// Total length, s.
    fn duration(&self) -> f64;

    /// Both references at the time `t`, s; at rest before 0 and after the end.
    fn at(&self, t: f64) -> Station;
}

/// A curve with a jerk-limited motion along its parameter, from corner to corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Along<C> {
    curve: C,
    legs: Vec<Profile>,
}

impl<C: Curve> Along<C> {
    /// `limits` are those of the curve's parameter: m for a [`Polygon`](super::Polygon), rad for the others.
    pub fn new(curve: C, limits: Limits) -> Result<Self, ParamError> {
        let mut stops = curve.corners();
        stops.push(curve.end());
        let mut from = 0.0;
        let legs = stops.into_iter().map(|stop| {
            let leg = Profile::new(stop - from, limits);
            from = stop;
            leg
        });
        Ok(Along {
            legs: legs.collect::<Result<_, ParamError>>()?,
            curve,
        })
    }

    /// The curve.
    pub fn curve(&self) -> &C {
        &self.curve
    }

    /// The parameter with its rate and acceleration, as a reference.
    fn parameter(&self, t: f64) -> Reference {
        let (mut start, mut origin) = (0.0, 0.0);
        for leg in &self.legs {
            if t - start < leg.duration() {
                let here = leg.at(t - start);
                return Reference {
                    position: origin + here.position,
                    ..here
                };
            }
            start += leg.duration();
            origin += leg.distance();
        }
        Reference {
            position: self.curve.end(),
            ..Reference::default()
        }
    }
}

impl<C: Curve> PlaneMotion for Along<C> {
    fn duration(&self) -> f64 {
        self.legs.iter().map(Profile::duration).sum()
    }

    fn at(&self, t: f64) -> Station {
        let p = self.parameter(t);
        let place = self.curve.place(p.position);
        let axis = |i: usize| Reference {
            position: place.point[i],
            velocity: place.first[i] * p.velocity,
            acceleration: place.second[i] * p.velocity * p.velocity
                + place.first[i] * p.acceleration,
        };
        Station {
            axes: [axis(0), axis(1)],
            parameter: p.position,
        }
    }
}

impl<C: Curve> Curve for Along<C> {
    fn end(&self) -> f64 {
        self.curve.end()
    }

    fn place(&self, p: f64) -> Place {
        self.curve.place(p)
    }

    fn corners(&self) -> Vec<f64> {
        self.curve.corners()
    }

    fn deviation(&self, p: f64, error: [f64; 2]) -> Deviation {
        self.curve.deviation(p, error)
    }

    fn true_deviation(&self, position: [f64; 2], p: f64) -> Deviation {
        self.curve.true_deviation(position, p)
    }
}

/// Recorded set points of both axes; the parameter is the time.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeForm {
    axes: [SetPoints; 2],
}

impl FreeForm {
    /// Set points of x and y, m (rad), at `rate` Hz, of the same number.
    pub fn new(rate: f64, x: Vec<f64>, y: Vec<f64>) -> Result<Self, ParamError> {
        if x.len() != y.len() {
            let found = y.len() as f64;
            return Err(ParamError::new("set_points", found, "as many in y as in x"));
        }
        Ok(FreeForm {
            axes: [SetPoints::new(rate, x)?, SetPoints::new(rate, y)?],
        })
    }

    /// Set points of x and y, m (rad), at as many ascending times, s.
    pub fn timed(times: Vec<f64>, x: Vec<f64>, y: Vec<f64>) -> Result<Self, ParamError> {
        Ok(FreeForm {
            axes: [
                SetPoints::timed(times.clone(), x)?,
                SetPoints::timed(times, y)?,
            ],
        })
    }
}

impl Curve for FreeForm {
    fn end(&self) -> f64 {
        self.axes[0].duration()
    }

    fn place(&self, p: f64) -> Place {
        let [x, y] = [self.axes[0].at(p), self.axes[1].at(p)];
        Place {
            point: [x.position, y.position],
            first: [x.velocity, y.velocity],
            second: [x.acceleration, y.acceleration],
        }
    }
}

impl PlaneMotion for FreeForm {
    fn duration(&self) -> f64 {
        self.end()
    }

    fn at(&self, t: f64) -> Station {
        Station {
            axes: [self.axes[0].at(t), self.axes[1].at(t)],
            parameter: t.clamp(0.0, self.end()),
        }
    }
}
