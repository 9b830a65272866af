//! The course of a run on a contour, for figures.

use serde::{Deserialize, Serialize};
use stiction_search::bits;
use stiction_servo::two_axes::PlaneSample;

/// Most points of a course that are kept: more than a figure can show.
const MOST_POINTS_KEPT: usize = 3000;

/// The course of a run on a contour with exact parameters, for figures.
#[derive(Serialize, Deserialize)]
pub struct ContourTrace {
    /// Name of the contour.
    pub path: String,
    /// Name of the controller.
    pub controller: String,
    /// Name of the compensator.
    pub compensator: String,
    /// Whether the contour error was controlled.
    pub coupled: bool,
    /// s
    #[serde(with = "bits")]
    pub time: Vec<f64>,
    /// The reference, m.
    #[serde(with = "bits")]
    pub reference: Vec<[f64; 2]>,
    /// Unit vector to the left of the motion; zero where it stands.
    #[serde(with = "bits")]
    pub left: Vec<[f64; 2]>,
    /// m, positive if the contour lies to the left.
    #[serde(with = "bits")]
    pub deviation: Vec<f64>,
}

impl ContourTrace {
    /// Whether it has a value of each signal at each time.
    pub(super) fn is_whole(&self) -> bool {
        let lengths = [self.reference.len(), self.left.len(), self.deviation.len()];
        lengths.iter().all(|n| *n == self.time.len())
    }

    /// Of each stretch the sample that deviates most.
    pub(super) fn of(names: [&str; 3], coupled: bool, samples: &[PlaneSample]) -> Self {
        let mut trace = ContourTrace {
            path: names[0].into(),
            controller: names[1].into(),
            compensator: names[2].into(),
            coupled,
            time: Vec::new(),
            reference: Vec::new(),
            left: Vec::new(),
            deviation: Vec::new(),
        };
        for stretch in samples.chunks(samples.len().div_ceil(MOST_POINTS_KEPT).max(1)) {
            let most = stretch
                .iter()
                .max_by(|a, b| a.deviation.abs().total_cmp(&b.deviation.abs()));
            let Some(sample) = most else { continue };
            let [vx, vy] = sample.axes.map(|a| a.reference.velocity);
            let speed = libm::hypot(vx, vy);
            let left = match speed {
                0.0 => [0.0; 2],
                _ => [-vy / speed, vx / speed],
            };
            trace.time.push(sample.axes[0].time);
            trace
                .reference
                .push(sample.axes.map(|a| a.reference.position));
            trace.left.push(left);
            trace.deviation.push(sample.deviation);
        }
        trace
    }
}
