//! The course of a run on a path, for figures.

use super::changing::LoadCourse;
use serde::{Deserialize, Serialize};
use stiction_search::bits;
use stiction_servo::axis::Sample;
use stiction_servo::metrics::reversals;

/// Most points of a course that are kept: more than a figure can show.
const MOST_POINTS_KEPT: usize = 2000;

/// The course of the run with exact parameters, for figures.
#[derive(Serialize, Deserialize)]
pub struct Trace {
    /// Name of the path.
    pub path: String,
    /// Name of the controller.
    pub controller: String,
    /// Name of the compensator.
    pub compensator: String,
    /// All samples that count.
    pub whole: Course,
    /// Samples about the last reversal but one; empty where there is none.
    pub reversal: Course,
    /// The load over the whole run, where it changes or is looked for.
    pub load: Option<LoadCourse>,
}

/// Signals over time, thinned to what a figure can show.
#[derive(Default, Serialize, Deserialize)]
pub struct Course {
    /// s
    #[serde(with = "bits")]
    pub time: Vec<f64>,
    /// m (rad)
    #[serde(with = "bits")]
    pub reference: Vec<f64>,
    /// m (rad)
    #[serde(with = "bits")]
    pub error: Vec<f64>,
    /// N (N m)
    #[serde(with = "bits")]
    pub compensation: Vec<f64>,
}

impl Trace {
    /// Of the samples that count.
    pub(super) fn of([path, controller, compensator]: [&str; 3], samples: &[Sample]) -> Self {
        let instants = reversals(samples);
        let about = match instants[..] {
            [.., t, next] => {
                let way = next - t;
                let place = |time: f64| samples.partition_point(|s| s.time < time);
                &samples[place(t - 0.05 * way)..place(t + 0.4 * way)]
            }
            _ => &[],
        };
        Trace {
            path: path.into(),
            controller: controller.into(),
            compensator: compensator.into(),
            whole: Course::of(samples),
            reversal: Course::of(about),
            load: None,
        }
    }
}

impl Course {
    /// Whether it has a value of each signal at each time.
    pub(super) fn is_whole(&self) -> bool {
        let signals = [&self.reference, &self.error, &self.compensation];
        signals.iter().all(|s| s.len() == self.time.len())
    }

    /// Of each stretch the least and the largest error.
    fn of(samples: &[Sample]) -> Self {
        let mut course = Course::default();
        for stretch in samples.chunks(samples.len().div_ceil(MOST_POINTS_KEPT / 2).max(1)) {
            let (mut low, mut high) = (0, 0);
            for (i, sample) in stretch.iter().enumerate() {
                if sample.error() < stretch[low].error() {
                    low = i;
                }
                if sample.error() > stretch[high].error() {
                    high = i;
                }
            }
            let ends = [low.min(high), low.max(high)];
            for &i in &ends[usize::from(low == high)..] {
                course.time.push(stretch[i].time);
                course.reference.push(stretch[i].reference.position);
                course.error.push(stretch[i].error());
                course.compensation.push(stretch[i].compensation);
            }
        }
        course
    }
}
