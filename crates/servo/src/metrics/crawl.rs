//! How evenly an axis goes at constant velocity.

use super::{MIN_STRETCH, root_mean, settled};
use crate::axis::Sample;
use crate::path::Reference;

/// Speed below which the axis is at rest, as a fraction of that of the reference: while it sticks, it still creeps on its
/// bristles as the force rises.
const REST_SHARE_OF_SPEED: f64 = 0.1;

/// Motion at constant velocity: the worst over all stretches of constant reference velocity of at least .1 s, each from its
/// middle on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crawl {
    /// Rms deviation of the velocity from its mean, over the speed of the reference.
    pub ripple: f64,
    /// Share of the time in which the axis goes at less than a tenth of the speed of the reference: stick-slip.
    pub rest_share: f64,
}

impl Crawl {
    /// `None` without such a stretch.
    pub fn of(samples: &[Sample]) -> Option<Self> {
        let same = |a: &Reference, b: &Reference| {
            let constant = |r: &Reference| r.acceleration == 0.0 && r.velocity != 0.0;
            constant(a) && constant(b) && a.velocity == b.velocity
        };
        settled(samples, MIN_STRETCH, same)
            .map(|stretch| {
                let n = stretch.len() as f64;
                let speed = stretch[0].reference.velocity.abs();
                let mean = stretch.iter().map(|s| s.velocity).sum::<f64>() / n;
                let off = stretch.iter().map(|s| (s.velocity - mean).powi(2));
                let rests = |s: &&Sample| s.velocity.abs() < REST_SHARE_OF_SPEED * speed;
                Crawl {
                    ripple: root_mean(off) / speed,
                    rest_share: stretch.iter().filter(rests).count() as f64 / n,
                }
            })
            .reduce(|a, b| Crawl {
                ripple: a.ripple.max(b.ripple),
                rest_share: a.rest_share.max(b.rest_share),
            })
    }
}
