//! Curves in the plane and the nearest point on them.

/// A point of a curve with the derivatives by the curve's parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// m (rad)
    pub point: [f64; 2],
    /// First derivative.
    pub first: [f64; 2],
    /// Second derivative.
    pub second: [f64; 2],
}

/// How far a point is from a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Distance to the curve, m; positive if the curve lies to the left of the point, seen along the motion.
    pub distance: f64,
    /// Unit vector to the left of the motion: `distance` times this leads to the curve.
    pub left: [f64; 2],
}

/// A curve `c(p)`.
pub trait Curve {
    /// Where the parameter ends; it begins at 0.
    fn end(&self) -> f64;

    /// The place at the parameter `p`, 0 to [`end`](Self::end).
    fn place(&self, p: f64) -> Place;

    /// Parameters at which the motion stops because the direction jumps, ascending, without 0 and the end.
    fn corners(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Estimate of the deviation in real time, at the reference parameter `p` with the tracking error `error` (reference
    /// less actual, m). By default that of the foot point.
    fn deviation(&self, p: f64, error: [f64; 2]) -> Deviation {
        let at = self.place(p).point;
        let position = [at[0] - error[0], at[1] - error[1]];
        foot(self, position, p).deviation
    }

    /// The deviation of a position, m, from the whole curve near the parameter `p`: for metrics.
    fn true_deviation(&self, position: [f64; 2], p: f64) -> Deviation {
        foot(self, position, p).deviation
    }
}

/// The nearest point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Its parameter.
    pub parameter: f64,
    /// How far it is.
    pub deviation: Deviation,
}

/// Most Newton steps; near the curve they converge quadratically, so a few are enough from a reference close by.
const MAX_STEPS: usize = 8;
/// Most halvings of a step: where the curve hardly moves with its parameter a full step leads far away.
const MAX_HALVINGS: usize = 40;
/// Least slope of Newton's equation, relative to the square of the curve's speed; below it, near the centre of curvature, the
/// step is that of the tangent.
const MIN_RELATIVE_SLOPE: f64 = 0.1;
/// Change of the parameter at which the search ends, relative to its range: rounding.
const PARAMETER_ROUNDING: f64 = 1e-14;

/// The foot point of `position` on a curve, by Newton's method on `(P - c(p)) c'(p) = 0` from the parameter `start`. Where
/// the curvature would lead away from a minimum the step is that of the tangent, and no step leads farther from the
/// position. Where the curve has no speed at the foot point its direction is that at `start`.
pub fn foot<C: Curve + ?Sized>(curve: &C, position: [f64; 2], start: f64) -> Foot {
    let clamped = |p: f64| p.clamp(0.0, curve.end());
    let mut p = clamped(start);
    let mut at = curve.place(p);
    let from = at.first;
    for _ in 0..MAX_STEPS {
        let away = minus(position, at.point);
        let speed = dot(at.first, at.first);
        if speed == 0.0 {
            break;
        }
        let slope = speed - dot(away, at.second);
        let slope = if slope > MIN_RELATIVE_SLOPE * speed {
            slope
        } else {
            speed
        };
        let mut step = dot(away, at.first) / slope;
        let mut next = (clamped(p + step), curve.place(clamped(p + step)));
        for _ in 0..MAX_HALVINGS {
            let left = minus(position, next.1.point);
            if dot(left, left) <= dot(away, away) {
                break;
            }
            step *= 0.5;
            next = (clamped(p + step), curve.place(clamped(p + step)));
        }
        let moved = (next.0 - p).abs();
        (p, at) = next;
        if moved <= PARAMETER_ROUNDING * (1.0 + curve.end()) {
            break;
        }
    }
    let stands = at.first == [0.0; 2];
    let direction = if stands { from } else { at.first };
    Foot {
        parameter: p,
        deviation: from_left(minus(at.point, position), direction),
    }
}

/// The part of `to_curve` across the direction of motion.
pub(super) fn from_left(to_curve: [f64; 2], direction: [f64; 2]) -> Deviation {
    let length = libm::sqrt(dot(direction, direction));
    if length == 0.0 {
        return Deviation::default();
    }
    let left = [-direction[1] / length, direction[0] / length];
    Deviation {
        distance: dot(to_curve, left),
        left,
    }
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
