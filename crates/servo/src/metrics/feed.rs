//! Errors of the feed rate.

use super::root_mean;
use crate::axis::Sample;
use crate::two_axes::PlaneSample;

/// Error of the feed rate: velocity along the motion less that of the reference, while the reference moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feed {
    /// Rms error, m/s (rad/s).
    pub rms: f64,
    /// Largest error either way, m/s (rad/s).
    pub peak: f64,
    /// That as a fraction of the fastest reference, which is the feed that was asked for.
    pub share: f64,
}

impl Feed {
    /// Of one axis; `None` where the reference does not move.
    pub fn of(samples: &[Sample]) -> Option<Self> {
        Feed::from(|| {
            samples
                .iter()
                .map(|s| ([s.reference.velocity, 0.0], [s.velocity, 0.0]))
        })
    }

    /// Of two axes, along the contour.
    pub fn along(samples: &[PlaneSample]) -> Option<Self> {
        Feed::from(|| {
            samples.iter().map(|s| {
                (
                    s.axes.map(|axis| axis.reference.velocity),
                    s.axes.map(|axis| axis.velocity),
                )
            })
        })
    }

    /// From the velocities of reference and axis.
    fn from<I: Iterator<Item = ([f64; 2], [f64; 2])>>(velocities: impl Fn() -> I) -> Option<Self> {
        // Velocity of the reference along the motion, and the error.
        let feeds = || {
            velocities().filter_map(|(wanted, is)| {
                let feed = libm::hypot(wanted[0], wanted[1]);
                let along = is[0] * (wanted[0] / feed) + is[1] * (wanted[1] / feed);
                (feed > 0.0).then_some((feed, along - feed))
            })
        };
        let fastest = feeds().map(|(feed, _)| feed).reduce(f64::max)?;
        let peak = feeds().fold(0.0_f64, |m, (_, error)| m.max(error.abs()));
        Some(Feed {
            rms: root_mean(feeds().map(|(_, error)| error * error)),
            peak,
            share: peak / fastest,
        })
    }
}
