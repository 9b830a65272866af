//! Strokes of a record: from one turning point of the position to the next.

use crate::conditioning::record::{Record, Segment};
use stiction_policy::motion;

/// Pieces of a stroke, where whole strokes are too few to tell a covariance from.
pub(crate) const PIECES: usize = 8;

/// The strokes of the kept samples of a record.
#[derive(Clone, Debug)]
pub(crate) struct Strokes {
    /// Stroke of each kept sample, counted from 0.
    pub of: Vec<usize>,
    /// Its piece of that stroke, from 0 to [`PIECES`].
    pub piece: Vec<usize>,
    /// Speed of each kept sample, m/s or rad/s.
    pub speed: Vec<f64>,
    /// Direction of its stroke: 1 or -1.
    pub sense: Vec<f64>,
    /// Way of each kept sample from the first of its stroke, m or rad.
    pub travel: Vec<f64>,
    /// Kind of each stroke: same direction, and nearly the same length and peak speed.
    pub kind: Vec<usize>,
    /// Length of each stroke, m or rad.
    pub length: Vec<f64>,
    /// Top speed, m/s or rad/s.
    pub top: f64,
    /// Halves of the samples, each by another rule: the early strokes, the fast half of each stroke, the half of each beyond its
    /// middle, what speeds up, and the long strokes where there are such.
    pub halves: Vec<Vec<bool>>,
}

/// A kept sample.
#[derive(Clone, Copy)]
struct Sample {
    stroke: usize,
    /// Way from the beginning of its segment, m or rad.
    way: f64,
    velocity: f64,
    acceleration: f64,
}

impl Strokes {
    pub fn of(record: &Record) -> Self {
        let ways: Vec<Vec<f64>> = record.segments.iter().map(way).collect();
        let logs = record.segments.iter().map(|s| s.log + 1).max();
        let mut range = vec![0.0_f64; logs.unwrap_or(0)];
        for (segment, way) in record.segments.iter().zip(&ways) {
            let low = way.iter().copied().fold(f64::INFINITY, f64::min);
            let high = way.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            range[segment.log] = range[segment.log].max(high - low);
        }
        let mut samples = Vec::with_capacity(record.kept());
        let mut first = 0;
        for (segment, way) in record.segments.iter().zip(&ways) {
            let turns = turning_points(way, motion::MIN_TURN * range[segment.log]);
            let mut stroke = 0;
            for (i, _) in segment.keep.iter().enumerate().filter(|(_, keep)| **keep) {
                let at = (i * record.decimate).min(way.len() - 1);
                while turns.get(stroke).is_some_and(|turn| *turn <= at) {
                    stroke += 1;
                }
                samples.push(Sample {
                    stroke: first + stroke,
                    way: way[at],
                    velocity: segment.velocity[at],
                    acceleration: segment.acceleration.get(at).copied().unwrap_or(0.0),
                });
            }
            first += turns.len() + 1;
        }
        Self::among(&samples)
    }

    fn among(samples: &[Sample]) -> Self {
        let runs: Vec<&[Sample]> = samples.chunk_by(|a, b| a.stroke == b.stroke).collect();
        let speed: Vec<f64> = samples.iter().map(|s| s.velocity.abs()).collect();
        let fastest = speed.iter().copied().fold(0.0, f64::max);
        let moving = speed
            .iter()
            .copied()
            .filter(|v| *v > motion::MAX_REST_SPEED * fastest);
        let top = quantile(moving.collect(), motion::TOP_SPEED_QUANTILE);
        let mut out = Self {
            of: Vec::with_capacity(samples.len()),
            piece: Vec::with_capacity(samples.len()),
            sense: Vec::with_capacity(samples.len()),
            travel: Vec::with_capacity(samples.len()),
            kind: Vec::new(),
            length: Vec::with_capacity(runs.len()),
            halves: Vec::new(),
            speed,
            top,
        };
        let mut peaks = Vec::with_capacity(runs.len());
        let mut senses = Vec::with_capacity(runs.len());
        let [mut fast, mut far] = [const { Vec::new() }; 2];
        for (k, run) in runs.iter().enumerate() {
            let travel = |s: &Sample| (s.way - run[0].way).abs();
            let above = |of: &dyn Fn(&Sample) -> f64, out: &mut Vec<bool>| {
                let middle = quantile(run.iter().map(of).collect(), 0.5);
                out.extend(run.iter().map(|s| of(s) > middle));
            };
            above(&|s| s.velocity.abs(), &mut fast);
            above(&travel, &mut far);
            let ends = run.last().map_or(0.0, |last| last.way - run[0].way);
            let sense = if ends < 0.0 { -1.0 } else { 1.0 };
            for (i, sample) in run.iter().enumerate() {
                out.of.push(k);
                out.piece.push(i * PIECES / run.len());
                out.sense.push(sense);
                out.travel.push(travel(sample));
            }
            let most = |of: &dyn Fn(&Sample) -> f64| run.iter().map(of).fold(0.0, f64::max);
            out.length.push(most(&travel));
            peaks.push(most(&|s| s.velocity.abs()));
            senses.push(sense);
        }
        let strokes = out.length.len();
        out.kind = kinds(&out.length, &peaks, &senses);
        let early = out.of.iter().map(|k| 2 * k < strokes).collect();
        let both = samples.iter().zip(&out.sense);
        let rising = both
            .map(|(s, sense)| s.acceleration * sense > 0.0)
            .collect();
        out.halves = vec![early, fast, far, rising];
        let [shortest, longest] = [0.0, 1.0].map(|at| quantile(out.length.clone(), at));
        if longest > motion::MIN_LONG_STROKE * shortest {
            let middle = quantile(out.length.clone(), 0.5);
            let long = out.of.iter().map(|k| out.length[*k] > middle);
            out.halves.push(long.collect());
        }
        out
    }

    /// The length of which half of the strokes are longer, m or rad.
    pub fn usual_length(&self) -> f64 {
        quantile(self.length.clone(), 0.5)
    }
}

/// The way along a segment at its full rate, m or rad.
fn way(segment: &Segment) -> Vec<f64> {
    let mut x = 0.0;
    let steps = segment.velocity.windows(2).map(|v| {
        x += 0.5 * (v[0] + v[1]) * segment.step;
        x
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// Indices at which the motion turns: an extreme counts once it has come back by `least`.
fn turning_points(x: &[f64], least: f64) -> Vec<usize> {
    let mut turns = Vec::new();
    let Some(&first) = x.first() else {
        return turns;
    };
    let (mut low, mut high, mut end, mut at, mut sense) = (first, first, first, 0, 0.0);
    for (i, &x) in x.iter().enumerate() {
        if sense == 0.0 {
            low = x.min(low);
            high = x.max(high);
            if x - low > least || high - x > least {
                sense = if x - low > least { 1.0 } else { -1.0 };
                (end, at) = (x, i);
            }
        } else if sense * (x - end) > 0.0 {
            (end, at) = (x, i);
        } else if sense * (end - x) > least {
            turns.push(at);
            sense = -sense;
            (end, at) = (x, i);
        }
    }
    turns
}

/// Strokes of one kind; one without a like joins the nearest of its direction.
fn kinds(length: &[f64], peak: &[f64], sense: &[f64]) -> Vec<usize> {
    let log = |x: f64| libm::log(x.max(f64::MIN_POSITIVE));
    let apart = |a: usize, b: usize| match sense[a] == sense[b] {
        true => libm::hypot(log(length[a]) - log(length[b]), log(peak[a]) - log(peak[b])),
        false => f64::INFINITY,
    };
    let n = length.len();
    let mut kind = vec![usize::MAX; n];
    for k in 0..n {
        if kind[k] == usize::MAX {
            let rest = kind.iter_mut().enumerate().skip(k);
            for (other, own) in rest.filter(|(_, own)| **own == usize::MAX) {
                if apart(k, other) < motion::MAX_STROKE_DISTANCE {
                    *own = k;
                }
            }
        }
    }
    let alone = |kind: &[usize], k: usize| kind.iter().filter(|own| **own == kind[k]).count() == 1;
    for k in 0..n {
        if alone(&kind, k) {
            let others = (0..n).filter(|other| *other != k && apart(k, *other).is_finite());
            if let Some(near) = others.min_by(|a, b| apart(k, *a).total_cmp(&apart(k, *b))) {
                kind[k] = kind[near];
            }
        }
    }
    kind
}

/// The value that a part of some values is below; 0 where there are none.
fn quantile(mut values: Vec<f64>, part: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let at = (part * (values.len() - 1) as f64).round() as usize;
    *values.select_nth_unstable_by(at, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::record::tests::of_velocities;

    /// Triangles of two lengths: strokes end where they turn, and kinds are direction and length.
    #[test]
    fn strokes_and_kinds_are_those_of_the_motion() {
        let mut velocity = Vec::new();
        for samples in [100, 100, 300, 300, 100, 100, 300, 300] {
            let last = velocity.last().map_or(-1.0, |v: &f64| v.signum());
            velocity.extend(vec![-last; samples]);
        }
        let record = of_velocities(1e-3, &[&velocity]);
        let strokes = Strokes::of(&record);
        assert_eq!(strokes.length.len(), 8);
        assert_eq!(strokes.kind, [0, 1, 2, 3, 0, 1, 2, 3]);
        assert_eq!(strokes.sense[50], 1.0);
        assert_eq!(strokes.sense[150], -1.0);
        assert_eq!(strokes.halves.len(), 5);
    }

    /// What is less than a fiftieth of the range is no turning point.
    #[test]
    fn noise_is_no_turning_point() {
        let x: Vec<f64> = (0..1000)
            .map(|i| f64::from(i) + 5.0 * f64::from(i % 2))
            .collect();
        assert!(turning_points(&x, 20.0).is_empty());
        assert_eq!(turning_points(&[0.0, 5.0, 1.0, 7.0], 2.0), [1, 2]);
    }
}
