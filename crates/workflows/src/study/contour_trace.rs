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

    /// From its rows in `contours.csv`: time, reference and deviation. The direction of motion follows from the places before and
    /// after.
    pub fn read(
        names: [&str; 3],
        coupled: bool,
        (time, reference, deviation): (Vec<f64>, Vec<[f64; 2]>, Vec<f64>),
    ) -> Self {
        let last = reference.len().saturating_sub(1);
        let places = 0..reference.len();
        let left = places.map(|k| {
            let (from, to) = (reference[k.saturating_sub(1)], reference[(k + 1).min(last)]);
            to_the_left([to[0] - from[0], to[1] - from[1]])
        });
        ContourTrace {
            path: names[0].into(),
            controller: names[1].into(),
            compensator: names[2].into(),
            coupled,
            left: left.collect(),
            time,
            reference,
            deviation,
        }
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
            let left = to_the_left(sample.axes.map(|a| a.reference.velocity));
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

/// Unit vector to the left of a motion; zero where there is none.
fn to_the_left([x, y]: [f64; 2]) -> [f64; 2] {
    match libm::hypot(x, y) {
        0.0 => [0.0; 2],
        length => [-y / length, x / length],
    }
}
