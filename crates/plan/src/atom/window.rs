//! The fade of a sine and its derivatives.

/// 0 to 1 and back, by the quintic with zero slope and curvature at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub duration: f64,
    pub fade_in: f64,
    pub fade_out: f64,
}

/// Largest absolute value of the quintic and of its first five derivatives over a fade of 1 s: those of order 1 and 2 at 1/2 and
/// (3 - sqrt 3)/6, the others at an end.
pub(super) const LARGEST: [f64; 6] = [1.0, 1.875, 5.773_502_691_896_258, 60.0, 360.0, 720.0];

impl Window {
    /// The window and its first three derivatives in time, 0 <= t <= duration.
    pub fn at(&self, t: f64) -> [f64; 4] {
        let left = self.duration - t;
        let (inside, fade, sign) = if t < self.fade_in {
            (t, self.fade_in, 1.0)
        } else if left < self.fade_out {
            (left, self.fade_out, -1.0)
        } else {
            return [1.0, 0.0, 0.0, 0.0];
        };
        let s = (inside / fade).max(0.0);
        let (r, f) = (1.0 - s, 1.0 / fade);
        [
            s * s * s * (10.0 - s * (15.0 - 6.0 * s)),
            sign * f * (30.0 * s * s * r * r),
            f * f * (60.0 * s * r * (r - s)),
            sign * f * f * f * (60.0 - 360.0 * s * r),
        ]
    }
}
