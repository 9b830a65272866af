//! The usual test contours, all from the origin.

use super::curve::{Curve, Deviation, Place, dot, from_left, minus};
use stiction_friction::ParamError;

/// Straight edges one after the other, by arc length; the motion stops at each corner. A line is one edge, a corner two, a
/// square four.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    points: Vec<[f64; 2]>,
    /// Arc length at each point, m.
    lengths: Vec<f64>,
}

impl Polygon {
    /// Through the points given, m (rad), from the origin; at least one, none twice in a row.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, ParamError> {
        if points.is_empty() {
            return Err(ParamError::new("points", 0.0, "at least one"));
        }
        let mut polygon = Polygon {
            points: vec![[0.0; 2]],
            lengths: vec![0.0],
        };
        for &point in points {
            let last = polygon.points.len() - 1;
            let edge = minus(point, polygon.points[last]);
            let length = libm::hypot(edge[0], edge[1]);
            ParamError::positive("edge", length)?;
            polygon.lengths.push(polygon.lengths[last] + length);
            polygon.points.push(point);
        }
        Ok(polygon)
    }

    /// A square corner: along x, then along y, `side` m (rad) each.
    pub fn corner(side: f64) -> Result<Self, ParamError> {
        Polygon::new(&[[side, 0.0], [side, side]])
    }

    /// A square, counter-clockwise.
    pub fn square(side: f64) -> Result<Self, ParamError> {
        Polygon::new(&[[side, 0.0], [side, side], [0.0, side], [0.0, 0.0]])
    }

    /// The edge that holds the arc length `p`, and its unit vector.
    fn edge(&self, p: f64) -> (usize, [f64; 2]) {
        let last = self.points.len() - 2;
        let i = self.lengths[1..].partition_point(|l| *l < p).min(last);
        let length = self.lengths[i + 1] - self.lengths[i];
        let edge = minus(self.points[i + 1], self.points[i]);
        (i, [edge[0] / length, edge[1] / length])
    }
}

impl Curve for Polygon {
    fn end(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    fn place(&self, p: f64) -> Place {
        let (i, along) = self.edge(p);
        let (from, s) = (self.points[i], p - self.lengths[i]);
        Place {
            point: [from[0] + s * along[0], from[1] + s * along[1]],
            first: along,
            second: [0.0; 2],
        }
    }

    fn corners(&self) -> Vec<f64> {
        self.lengths[1..self.lengths.len() - 1].to_vec()
    }

    /// `-ex sin a + ey cos a` on an edge at the angle a (Koren, Lo 1991, Variable-gain cross-coupling controller for contouring).
    fn deviation(&self, p: f64, error: [f64; 2]) -> Deviation {
        from_left(error, self.edge(p).1)
    }

    /// The nearest of all edges.
    fn true_deviation(&self, position: [f64; 2], _p: f64) -> Deviation {
        let mut best = Deviation::default();
        let mut least = f64::INFINITY;
        for (i, pair) in self.points.windows(2).enumerate() {
            let length = self.lengths[i + 1] - self.lengths[i];
            let edge = minus(pair[1], pair[0]);
            let along = [edge[0] / length, edge[1] / length];
            let s = dot(minus(position, pair[0]), along).clamp(0.0, length);
            let nearest = [pair[0][0] + s * along[0], pair[0][1] + s * along[1]];
            let to_curve = minus(nearest, position);
            let distance = libm::hypot(to_curve[0], to_curve[1]);
            if distance < least {
                least = distance;
                let side = from_left(to_curve, along);
                // Beyond a corner the deviation from it is not across the edge.
                best = Deviation {
                    distance: distance.copysign(side.distance),
                    ..side
                };
            }
        }
        best
    }
}

/// A circle through the origin, counter-clockwise from its right-most point, by the angle in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    radius: f64,
    turns: f64,
}

impl Circle {
    /// Radius > 0, m (rad); turns > 0.
    pub fn new(radius: f64, turns: f64) -> Result<Self, ParamError> {
        ParamError::positive("radius", radius)?;
        ParamError::positive("turns", turns)?;
        Ok(Circle { radius, turns })
    }

    /// m (rad)
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The centre, m (rad).
    pub fn centre(&self) -> [f64; 2] {
        [-self.radius, 0.0]
    }
}

impl Curve for Circle {
    fn end(&self) -> f64 {
        2.0 * std::f64::consts::PI * self.turns
    }

    fn place(&self, p: f64) -> Place {
        let (sine, cosine) = libm::sincos(p);
        let (x, y) = (self.radius * cosine, self.radius * sine);
        Place {
            point: [x - self.radius, y],
            first: [-y, x],
            second: [-x, -y],
        }
    }

    /// `-(ex cos a + ey sin a) + (ex^2 + ey^2)/(2R)` at the angle a (Koren, Lo 1991).
    fn deviation(&self, p: f64, error: [f64; 2]) -> Deviation {
        let (sine, cosine) = libm::sincos(p);
        let inward = [-cosine, -sine];
        Deviation {
            distance: dot(error, inward) + dot(error, error) / (2.0 * self.radius),
            left: inward,
        }
    }

    fn true_deviation(&self, position: [f64; 2], _p: f64) -> Deviation {
        let from_centre = minus(position, self.centre());
        let distance = libm::hypot(from_centre[0], from_centre[1]);
        Deviation {
            distance: distance - self.radius,
            left: [-from_centre[0] / distance, -from_centre[1] / distance],
        }
    }
}

/// A lying figure eight, `x = a sin p, y = b sin 2p`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigureEight {
    half_width: f64,
    half_height: f64,
    turns: f64,
}

impl FigureEight {
    /// Half width a and half height b > 0, m (rad); turns > 0.
    pub fn new(half_width: f64, half_height: f64, turns: f64) -> Result<Self, ParamError> {
        ParamError::positive("half_width", half_width)?;
        ParamError::positive("half_height", half_height)?;
        ParamError::positive("turns", turns)?;
        Ok(FigureEight {
            half_width,
            half_height,
            turns,
        })
    }
}

impl Curve for FigureEight {
    fn end(&self) -> f64 {
        2.0 * std::f64::consts::PI * self.turns
    }

    fn place(&self, p: f64) -> Place {
        let (a, b) = (self.half_width, self.half_height);
        let (s, c) = libm::sincos(p);
        let (s2, c2) = libm::sincos(2.0 * p);
        Place {
            point: [a * s, b * s2],
            first: [a * c, 2.0 * b * c2],
            second: [-a * s, -4.0 * b * s2],
        }
    }
}
