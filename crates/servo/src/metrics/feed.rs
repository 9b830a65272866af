//! Errors of the feed rate.

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
        let feeds = samples.iter().map(|s| {
            let wanted = s.reference.velocity;
            (wanted.abs(), s.velocity * wanted.signum())
        });
        Feed::from(feeds)
    }

    /// Of two axes, along the contour.
    pub fn along(samples: &[PlaneSample]) -> Option<Self> {
        let feeds = samples.iter().map(|s| {
            let [x, y] = s.axes.map(|axis| axis.reference.velocity);
            let feed = libm::hypot(x, y);
            let [u, v] = s.axes.map(|axis| axis.velocity);
            (feed, u * (x / feed) + v * (y / feed))
        });
        Feed::from(feeds)
    }

    /// From the feed of the reference and the velocity along the motion.
    fn from(feeds: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let (mut squares, mut count, mut peak, mut fastest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for (feed, along) in feeds.filter(|(feed, _)| *feed > 0.0) {
            let error = along - feed;
            squares += error * error;
            count += 1.0;
            peak = peak.max(error.abs());
            fastest = fastest.max(feed);
        }
        (fastest > 0.0).then(|| Feed {
            rms: libm::sqrt(squares / count),
            peak,
            share: peak / fastest,
        })
    }
}
